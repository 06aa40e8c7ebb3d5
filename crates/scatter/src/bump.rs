//! Bump maps: shading normals bent by a field of heights.

use indigo_math::{Real, Vec3};

/// The normal of a surface raised by heights along its normal `n`, where `gradient` has the derivatives of the
/// height (metres) by u and v and `dp_du`, `dp_dv` those of the position (metres).
///
/// The normal is n − ∇h with the gradient ∇h along the surface: the vector that has dp_du · ∇h = h_u and
/// dp_dv · ∇h = h_v (Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU", equation 4, after Blinn
/// 1978). So the mapping may be stretched, sheared or mirrored, and a mesh scaled: the slope is height over way.
/// Where u and v do not span the surface there is no slope. The result is on the side of `n_g`, and of unit length.
#[inline]
pub fn bumped_normal(n: Vec3, n_g: Vec3, [h_u, h_v]: [Real; 2], (dp_du, dp_dv): (Vec3, Vec3)) -> Vec3 {
    let (across_u, across_v) = (dp_dv.cross(n), n.cross(dp_du));
    let area = dp_du.dot(across_u);
    if area == 0.0 {
        return n;
    }
    let bent = n - (across_u * h_u + across_v * h_v) / area;
    let Some(bent) = bent.try_normalized() else { return n };
    // A smoothed normal may lean so far that a slope takes it below the surface: mirrored there, as light is.
    let side = bent.dot(n_g);
    if side < 0.0 { bent - n_g * (2.0 * side) } else { bent }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Vec3 = Vec3 { x: 0.0, y: 0.0, z: 1.0 };

    /// A slope of heights a x + b y over the plane, by any mapping of u and v, has the normal (-a, -b, 1).
    #[test]
    fn a_slope_is_the_same_under_any_mapping() {
        let (a, b) = (0.5, -0.25);
        let expected = Vec3::new(-a, -b, 1.0).normalized();
        let plane = |x: Real, y: Real| Vec3::new(x, y, 0.0);
        for (dp_du, dp_dv) in [
            (plane(1.0, 0.0), plane(0.0, 1.0)),
            (plane(0.0, 300.0), plane(-1e-3, 0.0)),
            (plane(1.0, 1.0), plane(-0.2, 1.0)),
            // Mirrored: u and v are left-handed.
            (plane(0.0, 2.0), plane(3.0, 1.0)),
        ] {
            let gradient = [dp_du, dp_dv].map(|d| a * d.x + b * d.y);
            let n = bumped_normal(UP, UP, gradient, (dp_du, dp_dv));
            assert!((n - expected).length() < 1e-5, "{dp_du:?} {dp_dv:?}: {n:?}");
        }
    }

    #[test]
    fn what_has_no_slope_stays_and_nothing_turns_over() {
        let (x, y) = (Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0));
        assert_eq!(bumped_normal(UP, UP, [0.0, 0.0], (x, y)), UP);
        assert_eq!(bumped_normal(UP, UP, [1.0, 1.0], (x, x)), UP);
        assert_eq!(bumped_normal(UP, UP, [1.0, 1.0], (Vec3::ZERO, y)), UP);
        assert_eq!(bumped_normal(UP, UP, [Real::INFINITY, 1.0], (x, y)), UP);
        let leaning = Vec3::new(0.9, 0.0, 0.1).normalized();
        let n = bumped_normal(leaning, UP, [30.0, 0.0], (x, y));
        assert!(n.z >= 0.0 && (n.length() - 1.0).abs() < 1e-5, "{n:?}");
    }
}

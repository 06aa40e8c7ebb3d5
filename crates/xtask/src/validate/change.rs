//! Changes of a scene's text.

/// A text with one part replaced.
///
/// # Panics
/// Where the part is not there exactly once: a change that did nothing would leave another scene than the check tells of.
pub fn changed(text: &str, part: &str, by: &str) -> String {
    let count = text.matches(part).count();
    assert_eq!(count, 1, "“{part}” is to be replaced, and is there {count} times");
    text.replacen(part, by, 1)
}

/// The numbers of a camera's lens, of which scenes here have a pinhole focused at one metre.
pub fn with_lens(camera: &str, radius: f64, focus: f64) -> String {
    let wide = changed(camera, "<aperture_radius>1e-5<", &format!("<aperture_radius>{radius}<"));
    changed(&wide, "<focus_distance>1<", &format!("<focus_distance>{focus}<"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_part_is_replaced() {
        assert_eq!(changed("a <b> c", "<b>", "<d>"), "a <d> c");
    }

    #[test]
    #[should_panic(expected = "0 times")]
    fn a_change_that_finds_nothing_is_a_mistake() {
        changed("a", "b", "c");
    }
}

//! Portals change no picture but its noise.

use super::common::judge::assert_same;
use super::common::noise::{luminances, rel_mse};
use super::common::window::{room, room_in_a_wide_scene};
use super::common::{measure, scene};
use indigo_scene::Scene;
use indigo_testkit::stats::Moments;

/// Pictures, and samples of a pixel in each.
const SEEDS: std::ops::Range<u64> = 1..9;
const PASSES: u64 = 16;

#[test]
fn a_room_is_as_bright_with_portals_as_without() {
    let [with, without] = [true, false].map(|has_portal| scene(&room(has_portal)));
    let (with, without) = (measure(&with, 16, 64), measure(&without, 16, 256));
    assert_same("a room with and without a portal", with.luminance(), without.luminance());
}

/// Light that is sent in through a small portal is not lost to rounding in a wide scene, and what stands before the
/// portal, or in its plane, is in its way.
#[test]
fn light_sent_into_a_room_of_a_wide_scene_is_all_there() {
    let rendered = |scene: &Scene, passes: u64| {
        let mut means = Moments::default();
        for seed in 0..16 {
            let pixels = luminances(scene, seed, passes);
            means.add(pixels.iter().sum::<f64>() / pixels.len() as f64);
        }
        means
    };
    for is_wide in [false, true] {
        let mut room = scene(&room_in_a_wide_scene(is_wide));
        let path = rendered(&room, 256);
        room.transport.bidirectional = true;
        let sent = rendered(&room, 128);
        // A loss of 5 % shows, at 5.5 standard errors.
        assert!(path.std_error().hypot(sent.std_error()) < 0.009 * path.mean());
        assert_same("a room in a wide scene, both techniques", &path, &sent);
    }
}

/// The errors are sums over 1152 pixels with a ratio far above 4, at fixed seeds.
#[test]
fn portals_lessen_the_error_at_least_four_times() {
    let [with, without] = [true, false].map(|has_portal| scene(&room(has_portal)));
    let truth = luminances(&with, 100, 4096);
    let [with, without] = [with, without].map(|scene| rel_mse(&scene, &truth, SEEDS, PASSES));
    assert!(without > 4.0 * with, "relMSE {without} without a portal, {with} with it");
}

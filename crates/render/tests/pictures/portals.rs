//! Portals change no picture but its noise.

use super::common::judge::assert_same;
use super::common::noise::{luminances, rel_mse};
use super::common::window::room;
use super::common::{measure, scene};

/// Pictures, and samples of a pixel in each.
const SEEDS: std::ops::Range<u64> = 1..9;
const PASSES: u64 = 16;

#[test]
fn a_room_is_as_bright_with_portals_as_without() {
    let [with, without] = [true, false].map(|has_portal| scene(&room(has_portal)));
    let (with, without) = (measure(&with, 16, 64), measure(&without, 16, 256));
    assert_same("a room with and without a portal", with.luminance(), without.luminance());
}

/// The errors are sums over 1152 pixels with a ratio far above 4, at fixed seeds.
#[test]
fn portals_lessen_the_error_at_least_four_times() {
    let [with, without] = [true, false].map(|has_portal| scene(&room(has_portal)));
    let truth = luminances(&with, 100, 4096);
    let [with, without] = [with, without].map(|scene| rel_mse(&scene, &truth, SEEDS, PASSES));
    assert!(without > 4.0 * with, "relMSE {without} without a portal, {with} with it");
}

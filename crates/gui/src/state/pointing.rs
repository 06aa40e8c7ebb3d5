//! Pointing at pixels of the picture, by the pointer or by a cross that keys move.

use super::{State, Tool};
use crate::action::{Action, Ask};
use crate::comparison::Layout;
use crate::engine::Command;
use crate::log::Weight;
use crate::words;
use indigo_film::XyzImage;

/// What a key does in the picture, which alone knows where it is on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    /// Shows it larger.
    ZoomIn,
    /// Shows it smaller.
    ZoomOut,
    /// Shows one pixel of it for one of the screen.
    OneToOne,
    /// Moves the cross, where there is one or the tool wants one, or else the picture.
    Step {
        /// Columns and rows.
        to: [i32; 2],
        /// Whether the step is a large one.
        is_far: bool,
    },
    /// Shows the cross, or takes it away.
    Cross,
    /// Does at the cross what a click of the tool does.
    Take,
}

impl State {
    /// Asks the picture for something.
    pub fn gesture(&mut self, gesture: Gesture) {
        self.gestures.push(gesture);
    }

    /// The pixel that is pointed at, by the cross if there is one.
    pub fn pointed(&self) -> Option<[u32; 2]> {
        self.cross.or(self.hovered)
    }

    /// What the pointer and the cross do from now on; what they began is given up.
    pub fn set_tool(&mut self, tool: Tool) {
        (self.tool, self.drag_from, self.corner) = (tool, None, None);
    }

    /// No tool, and no cross.
    pub fn leave_tools(&mut self) {
        self.set_tool(Tool::Pan);
        self.cross = None;
    }

    /// The text that is read as a whole in the panel that is shown.
    pub fn read(&self) -> Option<&str> {
        self.reading.as_ref().filter(|(foot, _)| *foot == self.foot).map(|(_, text)| &**text)
    }

    /// Leaves what lies on top: the list of keys, a text that is read, or the tools.
    pub fn leave(&mut self) {
        if std::mem::take(&mut self.shows_keys) {
            return;
        }
        if self.read().is_some() {
            self.reading = None;
        } else {
            self.leave_tools();
        }
    }

    /// Does at the cross what a click of the tool does; for a region at one corner, and then at the other.
    pub fn take_at_cross(&mut self) {
        let Some(at) = self.cross else { return };
        match (self.tool, self.corner) {
            (Tool::Pan, _) => {}
            (Tool::Grey, _) => self.take_grey(at),
            (Tool::Region, None) => self.corner = Some(at),
            (Tool::Region, Some(corner)) => self.set_region(between(corner, at)),
        }
    }

    /// Renders only a part of the picture, if it is of a scene.
    pub fn set_region(&mut self, region: [[u32; 2]; 2]) {
        let Some(work) = self.work else { return };
        self.leave_tools();
        self.command(Command::SetRegion(Some(region), work));
    }

    /// Takes a place of the picture for grey: the mean of the pixels around, which are noisy one by one.
    pub fn take_grey(&mut self, at: [u32; 2]) {
        let (Some(picture), Some(controls)) = (&self.picture, &mut self.controls) else { return };
        if controls.take_grey(mean_around(&picture.light, at)) {
            self.leave_tools();
            self.controls_changed();
        } else {
            self.tell(Weight::Warning, words::NO_GREY);
        }
    }

    /// Shows both pictures in the next way; asks for one to compare with where there is none.
    pub fn next_layout(&mut self) {
        if self.comparison.picture.is_none() {
            return self.act(Action::Ask(Ask::Compare));
        }
        self.comparison.layout = match self.comparison.layout {
            Layout::Off => Layout::Side,
            Layout::Side => Layout::Wipe,
            Layout::Wipe => Layout::Off,
        };
    }

    /// Moves the line between two pictures by a part of the width.
    pub fn move_line(&mut self, by: f32) {
        if self.comparison.layout == Layout::Wipe {
            self.comparison.wipe = (self.comparison.wipe + by).clamp(0.0, 1.0);
        }
    }
}

/// The rectangle that holds two pixels: first column and row, and those after the last.
pub fn between(one: [u32; 2], other: [u32; 2]) -> [[u32; 2]; 2] {
    [
        [0, 1].map(|axis: usize| one[axis].min(other[axis])),
        [0, 1].map(|axis: usize| one[axis].max(other[axis]) + 1),
    ]
}

/// The mean light of the five by five pixels round one, as far as they are in the picture.
fn mean_around(light: &XyzImage, [x, y]: [u32; 2]) -> [f32; 3] {
    let (width, height) = (light.size.width(), light.size.height());
    let around = |middle: u32, end: u32| middle.saturating_sub(2)..(middle.saturating_add(3)).min(end);
    let places = around(y, height).flat_map(|y| around(x, width).map(move |x| (x, y)));
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for (x, y) in places {
        let Some(pixel) = light.pixels.get(y as usize * width as usize + x as usize) else { continue };
        for (sum, value) in sum.iter_mut().zip(pixel) {
            *sum += value;
        }
        count += 1.0;
    }
    sum.map(|sum| sum / f32::max(count, 1.0))
}

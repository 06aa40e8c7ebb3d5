//! Controls of how the picture is developed, and how they are put back.

use super::State;
use crate::controls::Controls;
use crate::engine::Command;

impl State {
    /// Sends the controls to where pictures are made.
    pub fn controls_changed(&mut self) {
        if let (Some(base), Some(controls)) = (&self.base, &self.controls) {
            let picture = controls.apply(base);
            self.command(Command::SetPicture(Box::new(picture)));
        }
    }

    /// What can be brought back: the controls before they were put back, if they were not moved since.
    pub fn undo_of_reset(&self) -> Option<&Controls> {
        let is_reset = self.base.as_ref().map(Controls::of) == self.controls;
        self.before_reset.as_ref().filter(|_| is_reset)
    }

    /// As the scene has it; or, when that was done last, as it was before.
    pub fn reset_controls(&mut self) {
        let Some(base) = self.base.as_ref().map(Controls::of) else { return };
        if let Some(before) = self.undo_of_reset().cloned() {
            (self.controls, self.before_reset) = (Some(before), None);
        } else if let Some(now) = self.controls.replace(base.clone()).filter(|now| *now != base) {
            self.before_reset = Some(now);
        }
        self.controls_changed();
    }

    /// Makes the picture brighter or darker.
    pub fn brighten(&mut self, steps: f64) {
        if let Some(controls) = &mut self.controls {
            controls.brighten(steps);
            self.controls_changed();
        }
    }
}

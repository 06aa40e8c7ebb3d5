//! Scenes that are rendered one after another.

use std::path::PathBuf;

/// How far a scene of the queue is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Its turn will come.
    Waiting,
    /// It is rendered.
    Now,
    /// It was.
    Done,
    /// It could not be loaded, rendered to its end or saved.
    Failed,
}

/// See the module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Queue {
    /// The scenes.
    pub scenes: Vec<(PathBuf, Turn)>,
    /// Samples per pixel for scenes that would never halt by themselves.
    pub halts_at: u64,
    /// Whether the next one begins when one is done.
    pub runs: bool,
}

impl Default for Queue {
    fn default() -> Self {
        Self { scenes: vec![], halts_at: 256, runs: false }
    }
}

impl Queue {
    /// Adds a scene.
    pub fn add(&mut self, path: PathBuf) {
        self.scenes.push((path, Turn::Waiting));
    }

    /// Begins the next scene that waits: its path.
    pub fn next(&mut self) -> Option<PathBuf> {
        let next = self.scenes.iter_mut().find(|scene| scene.1 == Turn::Waiting);
        self.runs = next.is_some();
        let (path, turn) = next?;
        *turn = Turn::Now;
        Some(path.clone())
    }

    /// Something else is opened: no further scene is begun, and the one whose turn it was is left as it is.
    pub fn leave(&mut self) {
        self.end(Turn::Done);
        self.runs = false;
    }

    /// The turn of the scene that was rendered has ended, well or not; whether the next is to begin.
    pub fn end(&mut self, how: Turn) -> bool {
        for scene in &mut self.scenes {
            if scene.1 == Turn::Now {
                scene.1 = how;
                return self.runs;
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_after_another() {
        let mut queue = Queue::default();
        queue.add("a".into());
        queue.add("b".into());
        assert!(!queue.end(Turn::Done), "none was begun");
        assert_eq!(queue.next(), Some("a".into()));
        assert!(queue.end(Turn::Failed), "the others can be rendered all the same");
        assert_eq!(queue.next(), Some("b".into()));
        assert!(queue.end(Turn::Done));
        assert_eq!(queue.next(), None);
        assert!(!queue.runs);
        assert_eq!(queue.scenes, [("a".into(), Turn::Failed), ("b".into(), Turn::Done)]);
    }
}

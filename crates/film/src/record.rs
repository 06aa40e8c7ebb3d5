//! What a film is a picture of, and which random numbers went into it: what must agree before two films may
//! be added, or one be gone on with.

use crate::share::Share as _;
use crate::{FilmError, FilmState, XyzImage};

/// A run of units of work under one seed. With the seed a unit fixes all its random numbers, so that two films
/// that share a unit hold the same samples twice: their sum would be no better, and its noise estimate wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// The seed.
    pub seed: u64,
    /// The first unit.
    pub first: u64,
    /// The unit after the last.
    pub end: u64,
}

/// Where a film comes from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilmRecord {
    /// Name, version and platform of the program.
    pub program: String,
    /// Path of the scene, as it was given.
    pub scene_path: String,
    /// Names all of the scene that light depends on; zero where it is not known.
    pub scene_hash: [u8; 32],
    /// The settings that decide what the film converges to and which layers it has: name and value.
    pub settings: Vec<(String, String)>,
    /// Which units of which seeds are in it.
    pub runs: Vec<Run>,
    /// Samples taken: camera samples and mutations.
    pub samples: u64,
    /// Seconds of rendering, of all runs together.
    pub elapsed_s: f64,
}

/// Why a film cannot be added to another, or gone on with.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Mismatch {
    /// A setting that decides the film's values.
    #[error("{name} is {theirs} there, and {ours} here")]
    Setting {
        /// Its name.
        name: String,
        /// Its value in the film to be added or gone on with.
        theirs: String,
        /// Its value in this one.
        ours: String,
    },
    /// Geometry, materials, lights or camera.
    #[error("the scene itself, its geometry, materials, lights or camera, is another")]
    Scene,
    /// The same random numbers.
    #[error(
        "both hold samples of seed {seed}, units {first} to {last}: these would count twice; render with \
         another -seed"
    )]
    SameSamples {
        /// The seed.
        seed: u64,
        /// First unit in both.
        first: u64,
        /// Last unit in both.
        last: u64,
    },
    /// Sizes or layers, though all settings agree.
    #[error(transparent)]
    Film(#[from] FilmError),
}

impl FilmRecord {
    /// Everything that keeps two films from being of the same picture, in the order of the settings. What only one of
    /// them says anything of goes by what both say, so it is named only where that agrees.
    pub fn differences(&self, theirs: &Self) -> Vec<Mismatch> {
        const MISSING: &str = "not said";
        let mut names: Vec<&String> = self.settings.iter().map(|(n, _)| n).collect();
        names.extend(theirs.settings.iter().map(|(n, _)| n).filter(|n| self.setting(n).is_none()));
        let pairs = names.into_iter().map(|name| (name, theirs.setting(name), self.setting(name)));
        let (in_both, in_one): (Vec<_>, Vec<_>) = pairs
            .filter(|(_, theirs, ours)| theirs != ours)
            .partition(|(_, theirs, ours)| theirs.is_some() && ours.is_some());
        let told = if in_both.is_empty() { in_one } else { in_both };
        let words = |value: Option<&str>| value.unwrap_or(MISSING).to_owned();
        let mismatch = |(name, theirs, ours): (&String, _, _)| Mismatch::Setting {
            name: name.clone(),
            theirs: words(theirs),
            ours: words(ours),
        };
        let mut found: Vec<Mismatch> = told.into_iter().map(mismatch).collect();
        if self.scene_hash != theirs.scene_hash {
            found.push(Mismatch::Scene);
        }
        found
    }

    /// The value of a setting that decided the film.
    pub fn setting(&self, name: &str) -> Option<&str> {
        self.settings.iter().find(|(n, _)| n == name).map(|(_, value)| value.as_str())
    }

    /// The unit from which a seed has not been used.
    pub fn first_fresh_unit(&self, seed: u64) -> u64 {
        self.runs.iter().filter(|r| r.seed == seed).map(|r| r.end).max().unwrap_or(0)
    }

    /// Adds a run; one that goes on where another ended lengthens it.
    pub fn add_run(&mut self, run: Run) {
        match self.runs.iter_mut().find(|r| r.seed == run.seed && r.end == run.first) {
            Some(before) => before.end = run.end,
            None if run.end > run.first => self.runs.push(run),
            None => {}
        }
    }

    fn shared_run(&self, other: &Self) -> Option<Mismatch> {
        let pairs = self.runs.iter().flat_map(|a| other.runs.iter().map(move |b| (a, b)));
        let shared = pairs.filter(|(a, b)| a.seed == b.seed);
        shared
            .map(|(a, b)| (a.seed, a.first.max(b.first), a.end.min(b.end)))
            .find(|(_, first, end)| first < end)
            .map(|(seed, first, end)| Mismatch::SameSamples { seed, first, last: end - 1 })
    }
}

/// A film with its record.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedFilm {
    /// The sums.
    pub film: FilmState,
    /// Where they come from; `None` for a file of another program, which can only be developed.
    pub record: Option<FilmRecord>,
}

/// A saved film of which only the developed image is of interest.
#[derive(Clone, Debug, PartialEq)]
pub struct DevelopedFilm {
    /// What [`FilmState::develop`] makes of the film.
    pub image: XyzImage,
    /// Where it comes from; `None` for a file of another program.
    pub record: Option<FilmRecord>,
    /// As [`FilmState::refused`]; of a file of another program pixels that hold no number, and are black.
    pub refused: u64,
}

impl SavedFilm {
    /// Adds an independent film of the same picture.
    ///
    /// # Errors
    /// All that keeps them apart; this film is untouched then.
    pub fn merge(&mut self, other: &Self) -> Result<(), Vec<Mismatch>> {
        other.add_to(self)
    }

    /// Adds what has that record by `merge`, which leaves the film untouched where it fails.
    pub(crate) fn add(
        &mut self,
        theirs: &FilmRecord,
        merge: impl FnOnce(&mut FilmState) -> Result<(), FilmError>,
    ) -> Result<(), Vec<Mismatch>> {
        let Some(mine) = &mut self.record else { return Err(vec![Mismatch::Film(FilmError::Foreign)]) };
        let mut differences = mine.differences(theirs);
        differences.extend(mine.shared_run(theirs));
        if !differences.is_empty() {
            return Err(differences);
        }
        merge(&mut self.film).map_err(|e| vec![Mismatch::Film(e)])?;
        theirs.runs.iter().for_each(|&run| mine.add_run(run));
        mine.samples = mine.samples.saturating_add(theirs.samples);
        mine.elapsed_s += theirs.elapsed_s;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(settings: &[(&str, &str)], runs: &[Run]) -> FilmRecord {
        FilmRecord {
            settings: settings.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect(),
            runs: runs.to_vec(),
            ..FilmRecord::default()
        }
    }

    #[test]
    fn differences_are_named() {
        let a = record(&[("width", "10"), ("max_depth", "3")], &[]);
        let b = record(&[("width", "20"), ("max_depth", "3"), ("new", "1")], &[]);
        let said: Vec<String> = a.differences(&b).iter().map(ToString::to_string).collect();
        assert_eq!(said, ["width is 20 there, and 10 here"], "what goes by the width need not be named");
        let longer = record(&[("width", "10"), ("max_depth", "3"), ("new", "1")], &[]);
        let said: Vec<String> = a.differences(&longer).iter().map(ToString::to_string).collect();
        assert_eq!(said, ["new is 1 there, and not said here"]);
        assert_eq!((a.setting("max_depth"), a.setting("new")), (Some("3"), None));
        let other = FilmRecord { scene_hash: [1; 32], ..a.clone() };
        assert_eq!(a.differences(&other), [Mismatch::Scene]);
        assert!(a.differences(&a).is_empty());
    }

    #[test]
    fn runs_join_and_overlaps_are_seen() {
        let run = |seed, first, end| Run { seed, first, end };
        let mut a = record(&[], &[run(1, 0, 10)]);
        a.add_run(run(1, 10, 30));
        a.add_run(run(2, 0, 5));
        a.add_run(run(3, 7, 7));
        assert_eq!(a.runs, [run(1, 0, 30), run(2, 0, 5)]);
        assert_eq!((a.first_fresh_unit(1), a.first_fresh_unit(2), a.first_fresh_unit(9)), (30, 5, 0));
        assert_eq!(a.shared_run(&record(&[], &[run(1, 30, 40), run(3, 0, 9)])), None);
        let shared = a.shared_run(&record(&[], &[run(2, 4, 40)]));
        assert_eq!(shared, Some(Mismatch::SameSamples { seed: 2, first: 4, last: 4 }));
    }
}

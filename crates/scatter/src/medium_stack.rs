//! Which media a path is inside of (Schmidt & Budge 2002, "Simple Nested Dielectrics in Ray Traced Images").
//!
//! Objects may overlap, and of the media at one place the one of highest precedence is there. So a path
//! keeps all that it has entered and not left. Numbers of media are in the order of precedence
//! ([`MediumId`]), so the largest is the one that is there.

use crate::media::MediumId;

/// Media that a path can be inside of at once. More than nested objects need; of a ninth, the lowest is
/// forgotten, which shows only where all the others are left before it.
const DEPTH: usize = 8;

/// The media that a path is inside of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MediumStack {
    /// In descending order; those past the last one are air, entered 0 times.
    entries: [Entry; DEPTH],
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Entry {
    medium: MediumId,
    /// How many surfaces of objects of this medium were entered and not left.
    count: u16,
}

impl MediumStack {
    /// Outside of everything.
    pub const AIR: Self = Self { entries: [Entry { medium: MediumId::AIR, count: 0 }; DEPTH] };

    /// The medium that is there.
    #[inline]
    pub fn current(&self) -> MediumId {
        self.entries[0].medium
    }

    /// Whether a medium was entered, whatever else displaces it.
    #[inline]
    pub fn contains(&self, medium: MediumId) -> bool {
        self.entries.iter().any(|e| e.medium == medium && e.count > 0)
    }

    /// The stack after entering an object of a medium.
    #[inline]
    #[must_use]
    pub fn entered(mut self, medium: MediumId) -> Self {
        let at = self.entries.iter().position(|e| e.medium <= medium);
        // Below all of a full stack: forgotten.
        let Some(at) = at else { return self };
        if self.entries[at].medium == medium {
            let count = &mut self.entries[at].count;
            *count = count.saturating_add(1);
        } else {
            self.entries.copy_within(at..DEPTH - 1, at + 1);
            self.entries[at] = Entry { medium, count: 1 };
        }
        self
    }

    /// The stack after leaving an object of a medium; the same where it was not inside, as happens with
    /// surfaces that are not closed.
    #[inline]
    #[must_use]
    pub fn left(mut self, medium: MediumId) -> Self {
        let Some(at) = self.entries.iter().position(|e| e.medium == medium && e.count > 0) else {
            return self;
        };
        if self.entries[at].count > 1 {
            self.entries[at].count -= 1;
        } else {
            self.entries.copy_within(at + 1.., at);
            self.entries[DEPTH - 1] = Entry::default();
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id(i: usize) -> MediumId {
        MediumId::new(i).expect("a small number")
    }

    #[test]
    fn the_highest_precedence_is_there_in_whatever_order_media_are_entered_and_left() {
        let (water, glass) = (id(1), id(2));
        let stack = MediumStack::AIR;
        assert_eq!(stack.current(), MediumId::AIR);
        for both in [stack.entered(water).entered(glass), stack.entered(glass).entered(water)] {
            assert_eq!(both.current(), glass);
            assert_eq!(both.left(glass).current(), water);
            assert_eq!(both.left(water).current(), glass);
            assert_eq!(both.left(water).left(glass), stack);
            assert_eq!(both.left(glass).left(water), stack);
        }
    }

    #[test]
    fn overlapping_objects_of_one_medium_are_counted() {
        let twice = MediumStack::AIR.entered(id(3)).entered(id(3));
        assert_eq!(twice.left(id(3)).current(), id(3));
        assert_eq!(twice.left(id(3)).left(id(3)), MediumStack::AIR);
    }

    #[test]
    fn leaving_what_was_not_entered_changes_nothing() {
        let stack = MediumStack::AIR.entered(id(2));
        assert_eq!(stack.left(id(1)), stack);
        assert_eq!(stack.left(MediumId::AIR), stack);
        assert_eq!(MediumStack::AIR.left(id(1)), MediumStack::AIR);
        assert!(!MediumStack::AIR.contains(MediumId::AIR));
    }

    #[test]
    fn a_ninth_medium_displaces_the_lowest() {
        let full = (1..=9).fold(MediumStack::AIR, |s, i| s.entered(id(i)));
        assert!(!full.contains(id(1)) && full.contains(id(2)));
        assert_eq!(full.entered(id(1)), full, "below all of a full stack");
        let empty = (1..=9).rev().fold(full, |s, i| {
            assert_eq!(s.current(), if i == 1 { MediumId::AIR } else { id(i) });
            s.left(id(i))
        });
        assert_eq!(empty, MediumStack::AIR);
        let many = (0..70_000).fold(MediumStack::AIR, |s, _| s.entered(id(1)));
        assert_eq!(many.current(), id(1));
    }
}

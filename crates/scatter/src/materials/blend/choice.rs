//! One random number for one choice after another.

use indigo_math::Real;
use indigo_math::rng::mix64;

/// A random number in [0, 1) that is spread out again after each choice, until few of its digits are left: then it is
/// scrambled for new ones.
pub(in crate::materials) struct Choice {
    number: Real,
    /// The share of all first numbers that led here.
    width: Real,
    /// The bits of the first number, and how often they were scrambled.
    seed: u64,
    scrambled: u64,
}

/// Twelve of the 24 binary digits have been used.
const LEAST_WIDTH: Real = 1.0 / 4096.0;

impl Choice {
    #[inline]
    pub(in crate::materials) fn new(number: Real) -> Self {
        Self { number, width: 1.0, seed: f64::from(number).to_bits(), scrambled: 0 }
    }

    /// True with the probability `share`, whatever was chosen before.
    #[inline]
    pub(in crate::materials) fn is_within(&mut self, share: Real) -> bool {
        if self.width < LEAST_WIDTH {
            self.scramble();
        }
        let is_within = self.number < share;
        let (start, width) = if is_within { (0.0, share) } else { (share, 1.0 - share) };
        // Rounding must not make a 1 of it, which would choose what has no share.
        self.number = ((self.number - start) / width).min(1.0 - Real::EPSILON);
        self.width *= width;
        is_within
    }

    /// Another number of the same first one. Numbers that took one way so far are scrambled differently, so that what they
    /// choose from here on is spread as if it were drawn anew.
    #[cold]
    fn scramble(&mut self) {
        self.scrambled += 1;
        let bits = mix64(self.seed ^ mix64(self.scrambled));
        self.number = (bits >> 40) as Real / (1u64 << 24) as Real;
        self.width = 1.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After any number of choices the next is as likely as its share. All 2²⁴ numbers would make a deviation of
    /// 2⁻¹² of the spread or so; of 2¹⁶ of them, five standard deviations are allowed (6·10⁻⁷ each).
    #[test]
    fn the_digits_do_not_run_out() {
        let n = 1 << 16;
        for share in [0.5, 0.1] as [Real; 2] {
            let mut counts = [0_u32; 100];
            for i in 0..n {
                let mut choice = Choice::new(i as Real / n as Real);
                for count in &mut counts {
                    *count += u32::from(choice.is_within(share));
                }
            }
            let share = f64::from(share);
            let deviation = (f64::from(n) * share * (1.0 - share)).sqrt();
            for (depth, count) in counts.into_iter().enumerate() {
                let z = (f64::from(count) - f64::from(n) * share) / deviation;
                assert!(z.abs() < 5.0, "share {share}, choice {depth}: z = {z}");
            }
        }
    }

    /// Where the share is 0 or 1 there is nothing to choose.
    #[test]
    fn what_has_no_share_is_not_chosen() {
        for number in [0.0, 0.5, 1.0 - Real::EPSILON] {
            let mut choice = Choice::new(number);
            for _ in 0..100 {
                assert!(choice.is_within(1.0) && !choice.is_within(0.0));
            }
        }
    }
}

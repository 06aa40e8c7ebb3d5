//! Deviations of many scenes taken together, each with its sign: what lies a little on one side everywhere, and in no scene by more
//! than its noise, is found by the sum alone.

use super::check::{Check, Demand, Form, Renderer};
use super::judge::Verdict;
use super::report::Checked;
use super::statistics::{Comparison, Estimate, quantile};
use super::{agreement, grid};

/// Degrees of freedom at which Student's t is the normal distribution to all digits that count.
const NORMAL: usize = 10_000_000;

/// Ways of rendering that are summed over, of these checks: one comparison each.
pub fn ways(checks: &[Check]) -> Vec<Renderer> {
    let mut ways = vec![];
    for renderer in checks.iter().filter(|check| is_summed(check)).flat_map(|check| &check.renderers[1..]) {
        if !ways.contains(renderer) {
            ways.push(*renderer);
        }
    }
    ways
}

fn is_summed(check: &Check) -> bool {
    [agreement::GROUP, grid::GROUP].contains(&check.group)
}

/// One more check, of the sums over the scenes that are rendered by all ways.
pub fn check(checked: &[Checked], ways: &[Renderer], form: Form, threshold: f64) -> Option<Checked> {
    let summed: Vec<&Checked> = checked.iter().filter(|c| is_summed(&c.check)).collect();
    let verdicts: Vec<Verdict> = ways.iter().filter_map(|way| verdict(*way, &summed, threshold)).collect();
    let about = "Of each scene the deviation of the mean from path tracing’s, as a number of standard deviations of a normal distribution \
                 with its sign; their sum over the square root of how many there are is one again (Stouffer et al. 1949). A way that \
                 gathers a little too much or too little everywhere is found so though no scene shows it.";
    let mut check = Check::new(agreement::GROUP, "all scenes together", about, String::new());
    check.renderers = verdicts.iter().map(|verdict| verdict.renderer).collect();
    let demand: Demand = form.demand(&check);
    (!verdicts.is_empty()).then_some(Checked {
        check,
        demand,
        renders: vec![],
        seconds: vec![],
        verdicts,
        broken: None,
    })
}

fn verdict(way: Renderer, summed: &[&Checked], threshold: f64) -> Option<Verdict> {
    // The first of a way is the whole picture's.
    let of_way = |c: &&Checked| {
        c.verdicts.iter().find(|verdict| verdict.renderer == way).map(|verdict| score(&verdict.comparison))
    };
    let scores: Vec<f64> = summed.iter().filter_map(of_way).collect();
    let comparison = stouffer(&scores)?;
    let verdict = Verdict {
        renderer: way,
        what: format!("sum of the signs of {} scenes", scores.len()),
        area: None,
        expected: Estimate::exact(0.0),
        is_bound: false,
        measured: of_unit_error(comparison.t),
        comparison,
        allowance: 0.0,
        resolution: 0.0,
        noise: 0.0,
        demand: 0.0,
        threshold,
        failure: None,
    };
    Some(verdict.failing())
}

/// A deviation as a normal one of the same probability and sign.
fn score(comparison: &Comparison) -> f64 {
    if comparison.t.is_nan() {
        f64::NAN
    } else {
        quantile(comparison.p, NORMAL as f64).copysign(comparison.t)
    }
}

/// The sum of normal scores over the square root of their number, and how surprising it is.
fn stouffer(scores: &[f64]) -> Option<Comparison> {
    let sum = scores.iter().sum::<f64>() / (scores.len() as f64).sqrt();
    (!scores.is_empty()).then(|| Comparison::of(&of_unit_error(sum), &Estimate::exact(0.0), 0.0))
}

fn of_unit_error(mean: f64) -> Estimate {
    Estimate { count: NORMAL + 1, mean, error: 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two standard errors in each of nine scenes are six of their sum, and nothing where they go both ways.
    #[test]
    fn what_lies_on_one_side_everywhere_is_found() {
        let one_side = stouffer(&[2.0; 9]).expect("there are scores");
        assert!((one_side.t - 6.0).abs() < 1e-9 && one_side.p < 1e-8, "{one_side:?}");
        let both = stouffer(&[2.0, -2.0, 2.0, -2.0]).expect("there are scores");
        assert!(both.p > 0.99, "{both:?}");
        assert!(stouffer(&[]).is_none());
    }

    /// Student's t of 15 degrees of freedom is beyond 2.131 as often as a normal deviation is beyond 1.96.
    #[test]
    fn scores_are_normal() {
        let of = |mean: f64| {
            let measured = Estimate { count: 16, mean, error: 1.0 };
            score(&Comparison::of(&measured, &Estimate::exact(0.0), 0.0))
        };
        assert!((of(2.131_45) - 1.959_96).abs() < 1e-4, "{}", of(2.131_45));
        assert!((of(-2.131_45) + 1.959_96).abs() < 1e-4);
        assert!(of(0.0).abs() < 1e-9);
    }
}

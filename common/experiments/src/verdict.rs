//! Whether our figure is the paper's, by one rule.
//!
//! | the paper publishes | reproduces | reproduces in size |
//! |---|---|---|
//! | a magnitude | within 2 standard deviations of the difference but not beyond a factor 2, or within 20 % | within a factor 2 |
//! | a signed value | within 2 standard deviations of the difference, or within 20 % | same sign, within a factor 2 |
//! | a mean and its spread | within one of the paper's spreads, or within 20 % | same sign, within a factor 2 |
//! | a range or a limit | in it, or outside by at most 2 standard deviations of ours but not beyond a factor 2 | outside by at most a factor 2 |
//! | a statement | it holds | never |
//! | nothing | not testable | |
//!
//! The standard deviation of the difference is `s sqrt(1/n + 1/N)` with our spread s over n trials and the paper's number of trials
//! N, mostly 1: the paper's figure is one more draw from the same spread. That of ours is `s / sqrt(n)`. A single trial has no
//! spread, and only the other limits count. A magnitude or a limit never gets by on its spread alone, which heavy tails make large. A figure
//! that is not a number, because a method gave no valid solution, does not reproduce.

use std::fmt;

/// How many standard deviations a difference may have.
const SIGNIFICANT: f64 = 2.0;
/// The relative difference that always passes.
const CLOSE: f64 = 0.2;
/// What still is the same size.
const SIZE: f64 = 2.0;

/// What a paper says about a figure, in the row's unit.
#[derive(Clone, Debug, PartialEq)]
pub enum Published {
    /// A value that cannot be negative, such as an RMSE, from so many trials.
    Magnitude(f64, usize),
    /// A value whose sign matters, such as a mean error, from so many trials.
    Signed(f64, usize),
    /// A mean with the standard deviation over the paper's trials.
    Spread(f64, f64),
    /// From, to.
    Range(f64, f64),
    /// Not above.
    AtMost(f64),
    /// Not below.
    AtLeast(f64),
    /// Words, and whether our data bear them out.
    Statement(String, bool),
    /// Why there is nothing to compare with.
    Nothing(String),
}

/// How our figure stands beside the paper's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Within the paper's statement and our spread.
    Reproduces,
    /// Not the same, but of the same size.
    InSize,
    /// Something else.
    DoesNot,
    /// The paper publishes nothing to compare with.
    NotTestable,
}

impl Verdict {
    /// The verdict on our mean with its spread over so many trials.
    pub fn of(ours: f64, spread: f64, trials: usize, published: &Published) -> Self {
        let own = if spread.is_finite() { spread / (trials as f64).sqrt() } else { 0.0 };
        match published {
            Published::Nothing(_) => Self::NotTestable,
            _ if !ours.is_finite() => Self::DoesNot,
            Published::Statement(_, holds) => Self::choose(*holds, false),
            Published::Magnitude(paper, runs) => {
                let size = is_of_size(ours, *paper);
                Self::choose(is_close(ours, *paper) || size && is_in(ours, *paper, own, spread, *runs), size)
            }
            Published::Signed(paper, runs) => Self::choose(
                is_close(ours, *paper) || is_in(ours, *paper, own, spread, *runs),
                is_of_size(ours, *paper),
            ),
            Published::Spread(paper, sd) => {
                Self::choose(is_close(ours, *paper) || (ours - paper).abs() <= *sd, is_of_size(ours, *paper))
            }
            Published::Range(low, high) => Self::within(ours, own, *low, *high),
            Published::AtMost(high) => Self::within(ours, own, f64::NEG_INFINITY, *high),
            Published::AtLeast(low) => Self::within(ours, own, *low, f64::INFINITY),
        }
    }

    fn choose(reproduces: bool, size: bool) -> Self {
        match (reproduces, size) {
            (true, _) => Self::Reproduces,
            (false, true) => Self::InSize,
            (false, false) => Self::DoesNot,
        }
    }

    fn within(ours: f64, own: f64, low: f64, high: f64) -> Self {
        let nearest = ours.clamp(low.min(high), high.max(low));
        let size = is_of_size(ours, nearest);
        Self::choose(size && (ours - nearest).abs() <= SIGNIFICANT * own, size)
    }
}

/// Whether the difference of our mean, whose standard deviation is `own`, to a figure from `runs` trials is no more than chance.
fn is_in(ours: f64, paper: f64, own: f64, spread: f64, runs: usize) -> bool {
    let theirs = if spread.is_finite() { spread / (runs.max(1) as f64).sqrt() } else { 0.0 };
    (ours - paper).abs() <= SIGNIFICANT * own.hypot(theirs)
}

fn is_close(ours: f64, paper: f64) -> bool {
    (ours - paper).abs() <= CLOSE * paper.abs()
}

fn is_of_size(ours: f64, paper: f64) -> bool {
    ours == paper || (ours / paper >= 1.0 / SIZE && ours / paper <= SIZE)
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Reproduces => "reproduces",
            Self::InSize => "reproduces in size",
            Self::DoesNot => "does not reproduce",
            Self::NotTestable => "not testable",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Published::*;
    use super::Verdict::*;
    use super::*;

    fn verdict(ours: f64, spread: f64, trials: usize, published: Published) -> Verdict {
        Verdict::of(ours, spread, trials, &published)
    }

    #[test]
    fn a_magnitude_is_judged_by_closeness_then_spread_then_size() {
        for (ours, spread, trials, expected) in [
            (1.2, 0.0, 20, Reproduces),  // within 20 %
            (1.21, 0.0, 20, InSize),     // just beyond
            (1.5, 0.25, 20, Reproduces), // 2 x 0.25 x sqrt(1 + 1/20) = 0.51
            (1.5, 0.24, 20, InSize),     // 0.49
            (1.5, 0.20, 1, Reproduces),  // 2 x 0.2 x sqrt 2 = 0.57
            (2.0, 0.0, 20, InSize),
            (2.01, 0.0, 20, DoesNot),
            (0.5, 0.0, 20, InSize),
            (0.49, 0.0, 20, DoesNot),
            (2.5, 9.0, 20, DoesNot), // a large spread excuses no other size
            (-1.0, 9.0, 20, DoesNot),
            (1.5, f64::NAN, 1, InSize), // a single trial has no spread
            (f64::NAN, 0.1, 20, DoesNot),
            (f64::INFINITY, 0.1, 20, DoesNot),
        ] {
            assert_eq!(verdict(ours, spread, trials, Magnitude(1.0, 1)), expected, "{ours} {spread} {trials}");
        }
    }

    #[test]
    fn a_mean_of_many_trials_must_be_met_more_narrowly() {
        assert_eq!(verdict(1.3, 0.2, 100, Magnitude(1.0, 1)), Reproduces);
        assert_eq!(verdict(1.3, 0.2, 100, Magnitude(1.0, 100)), InSize);
    }

    #[test]
    fn a_signed_value_near_zero_is_judged_by_the_spread() {
        assert_eq!(verdict(-0.3, 0.2, 20, Signed(0.05, 1)), Reproduces);
        assert_eq!(verdict(-0.6, 0.2, 20, Signed(0.05, 1)), DoesNot);
        assert_eq!(verdict(-8.0, 0.5, 20, Signed(-5.0, 1)), InSize);
        assert_eq!(verdict(5.0, 0.5, 20, Signed(-5.0, 1)), DoesNot);
        assert_eq!(verdict(0.0, 0.0, 20, Signed(0.0, 1)), Reproduces);
    }

    #[test]
    fn a_mean_with_the_papers_spread_counts_that_spread() {
        assert_eq!(verdict(1.4, 0.0, 100, Spread(1.0, 0.4)), Reproduces);
        assert_eq!(verdict(1.41, 0.0, 100, Spread(1.0, 0.4)), InSize);
        assert_eq!(verdict(1.1, 0.0, 100, Spread(1.0, 0.01)), Reproduces);
        assert_eq!(verdict(3.0, 0.0, 100, Spread(1.0, 0.4)), DoesNot);
    }

    #[test]
    fn a_range_or_a_limit_may_be_missed_by_the_error_of_our_mean() {
        assert_eq!(verdict(1.5, 0.0, 4, Range(1.0, 2.0)), Reproduces);
        assert_eq!(verdict(2.09, 0.1, 4, Range(1.0, 2.0)), Reproduces);
        assert_eq!(verdict(2.09, 0.1, 16, Range(1.0, 2.0)), InSize);
        assert_eq!(verdict(0.4, 0.0, 4, Range(1.0, 2.0)), DoesNot);
        assert_eq!(verdict(-7.0, 0.0, 4, AtMost(2.0)), Reproduces);
        assert_eq!(verdict(4.0, 0.0, 4, AtMost(2.0)), InSize);
        assert_eq!(verdict(4.1, 0.0, 4, AtMost(2.0)), DoesNot);
        assert_eq!(verdict(580.0, 440.0, 2, AtMost(5.0)), DoesNot);
        assert_eq!(verdict(0.96, 0.0, 4, AtLeast(0.95)), Reproduces);
        assert_eq!(verdict(0.7, 0.0, 4, AtLeast(0.95)), InSize);
        assert_eq!(verdict(0.0, 0.0, 4, AtLeast(0.95)), DoesNot);
        assert_eq!(verdict(f64::NAN, 0.0, 4, AtMost(2.0)), DoesNot);
    }

    #[test]
    fn words_hold_or_do_not_and_nothing_cannot_be_tested() {
        assert_eq!(verdict(1.0, 0.0, 4, Statement("better".into(), true)), Reproduces);
        assert_eq!(verdict(1.0, 0.0, 4, Statement("better".into(), false)), DoesNot);
        assert_eq!(verdict(f64::NAN, 0.0, 4, Statement("better".into(), true)), DoesNot);
        assert_eq!(verdict(f64::NAN, f64::NAN, 1, Nothing("a figure only".into())), NotTestable);
    }
}

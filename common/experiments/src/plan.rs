use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::num::NonZeroUsize;

/// What the user asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Trials of every study; `None` leaves it to the study.
    pub trials: Option<NonZeroUsize>,
    /// Another seed draws other trials.
    pub seed: u64,
    /// Few trials, and what else a study can shorten.
    pub quick: bool,
}

/// How many trials a study takes if the user does not say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trials {
    /// In a full run.
    pub full: usize,
    /// In a quick one.
    pub quick: usize,
}

/// One trial of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trial {
    /// 0 is the trial that figures show.
    pub index: usize,
    /// Seed of its scenario. All studies share the seed of a trial, so that they can be compared trial by trial.
    pub seed: u64,
    /// Whether the run is a quick one.
    pub quick: bool,
}

impl Plan {
    /// How many trials a study takes, at least 1.
    pub fn count(&self, trials: Trials) -> usize {
        let usual = if self.quick { trials.quick } else { trials.full };
        self.trials.map_or(usual.max(1), NonZeroUsize::get)
    }

    /// A trial by its number; its seed depends on the plan's seed and that number alone, and fits a JSON number exactly.
    pub fn trial(&self, index: usize) -> Trial {
        let mut source = Pcg64Mcg::seed_from_u64(self.seed);
        source.advance(index as u128);
        Trial { index, seed: source.next_u64() >> 11, quick: self.quick }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn no_two_trials_share_a_seed() {
        let seeds: BTreeSet<u64> = (0..20)
            .flat_map(|seed| {
                let plan = Plan { trials: None, seed, quick: false };
                (0..500).map(move |index| plan.trial(index).seed)
            })
            .collect();
        assert_eq!(seeds.len(), 20 * 500);
        assert!(seeds.iter().all(|&seed| seed < 1 << 53));
    }

    #[test]
    fn the_user_decides_then_the_study() {
        let plan = |trials: Option<usize>, quick| Plan { trials: trials.and_then(NonZeroUsize::new), seed: 1, quick };
        let trials = Trials { full: 20, quick: 4 };
        assert_eq!(plan(None, false).count(trials), 20);
        assert_eq!(plan(None, true).count(trials), 4);
        assert_eq!(plan(Some(7), true).count(trials), 7);
        assert_eq!(plan(None, true).count(Trials { full: 1, quick: 0 }), 1);
    }
}

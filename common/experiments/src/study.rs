use crate::{Fault, Figure, Plan, Row, Trial, Trials};
use rayon::prelude::*;

/// Hears how the work goes on.
pub trait Watch: Sync {
    /// So much is done since the last call.
    fn done(&self, cost: u64);
}

/// What studies find.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// In the order of the output.
    pub rows: Vec<Row>,
    /// Likewise.
    pub figures: Vec<Figure>,
}

impl Findings {
    /// These, then the others.
    pub fn and(mut self, others: Self) -> Self {
        self.rows.extend(others.rows);
        self.figures.extend(others.figures);
        self
    }
}

type Work = dyn Fn(&Plan, &dyn Watch) -> Result<Findings, Fault> + Send + Sync;

/// A measurement, how often to repeat it, and what to conclude.
pub struct Study {
    trials: Trials,
    /// Of one trial.
    cost: u64,
    work: Box<Work>,
}

impl Study {
    /// A study. `cost` is about the seconds of data of one trial times the number of methods that run on them, so that the progress bar
    /// goes evenly. `measure` handles one trial; `conclude` gets what was measured in the order of the trials, at least one.
    pub fn new<T: Send>(
        trials: Trials,
        cost: u64,
        measure: impl Fn(&Trial) -> Result<T, Fault> + Send + Sync + 'static,
        conclude: impl Fn(&[T]) -> Findings + Send + Sync + 'static,
    ) -> Self {
        let work = move |plan: &Plan, watch: &dyn Watch| {
            let trial = |index| {
                let measured = measure(&plan.trial(index));
                watch.done(cost);
                measured
            };
            // all results first, so that the fault that is told does not depend on which trial ended first
            let measured: Vec<Result<T, Fault>> = (0..plan.count(trials)).into_par_iter().map(trial).collect();
            let measured: Vec<T> = measured.into_iter().collect::<Result<_, _>>()?;
            Ok(conclude(&measured))
        };
        Self { trials, cost, work: Box::new(work) }
    }

    /// How much there is to do.
    pub fn cost(&self, plan: &Plan) -> u64 {
        self.cost * plan.count(self.trials) as u64
    }

    /// Carries out all trials on rayon's current pool.
    ///
    /// # Errors
    /// The fault of the first trial that could not be carried out.
    pub fn run(&self, plan: &Plan, watch: &dyn Watch) -> Result<Findings, Fault> {
        (self.work)(plan, watch)
    }
}

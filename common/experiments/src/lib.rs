//! The experiments of the papers, and that of the project's own estimator on all of their scenarios.
//!
//! An [`Experiment`] is a paper, or the estimator: some [`Study`]s, each a measurement that is repeated over trials and what is concluded from
//! all of them. A measurement simulates its scenario once ([`Data`]), lets several methods [`run`] over the same data, and takes
//! figures from their [`Track`]s. The conclusion are [`Row`]s, our figure beside the paper's and the bound, with a [`Verdict`] that
//! is computed, and [`Figure`]s to be drawn. Results depend on the [`Plan`] alone: neither on the number of threads nor on their pace.
//!
//! A new paper is a folder with `pub fn studies() -> Vec<Study>` and a line in [`EXPERIMENTS`]; a new configuration is a file of
//! `config/papers` and a line in [`presets`].

mod data;
mod deck;
mod error_range;
mod fault;
mod figure;
mod idam;
mod model_free;
mod plan;
pub mod presets;
mod q_nnkf;
mod row;
mod statistics;
mod study;
mod track;
mod tufts_kumaresan;
mod verdict;

pub use data::{Data, pairs, run, run_together, run_told};
pub use fault::Fault;
pub use figure::{Bars, Cloud, Ellipse, Figure, Label, Line, Plot, Series, Stroke};
pub use plan::{Plan, Trial, Trials};
pub use row::{Bound, Claim, Row};
pub use statistics::{mean, rms, spread};
pub use study::{Findings, Study, Watch};
pub use track::{Adoption, Estimated, Point, Stretch, Track};
pub use verdict::{Published, Verdict};

use rayon::prelude::*;

/// The studies of one paper, or of the project's own estimator.
pub struct Experiment {
    /// As the command line calls it.
    pub name: &'static str,
    /// What it belongs to, and the command line's name of all that belongs there.
    pub group: Option<&'static str>,
    /// Number and subject.
    pub title: &'static str,
    /// Its studies, in the order of the paper.
    pub studies: fn() -> Vec<Study>,
}

/// All of them, in the order of their output.
pub const EXPERIMENTS: [Experiment; 11] = [
    paper("idam", idam::TITLE, idam::studies),
    paper("q-nnkf", q_nnkf::TITLE, q_nnkf::studies),
    paper("model-free", model_free::TITLE, model_free::studies),
    paper("tufts-kumaresan", tufts_kumaresan::TITLE, tufts_kumaresan::studies),
    paper("error-range", error_range::TITLE, error_range::studies),
    own("deck-scenarios", deck::SCENARIOS_TITLE, deck::scenarios),
    own("deck-unseen", deck::UNSEEN_TITLE, deck::unseen),
    own("deck-troubles", deck::TROUBLES_TITLE, deck::troubles),
    own("deck-coupling", deck::COUPLING_TITLE, deck::coupling),
    own("deck-month", deck::MONTH_TITLE, deck::month),
    own("deck-parts", deck::PARTS_TITLE, deck::parts),
];

const fn paper(name: &'static str, title: &'static str, studies: fn() -> Vec<Study>) -> Experiment {
    Experiment { name, group: None, title, studies }
}

const fn own(name: &'static str, title: &'static str, studies: fn() -> Vec<Study>) -> Experiment {
    Experiment { name, group: Some("deck"), title, studies }
}

impl Experiment {
    /// How much there is to do, in the unit of [`Watch::done`].
    pub fn cost(&self, plan: &Plan) -> u64 {
        (self.studies)().iter().map(|study| study.cost(plan)).sum()
    }

    /// Carries out all studies on rayon's current pool.
    ///
    /// # Errors
    /// The fault of the first trial, in the order of studies and trials, that could not be carried out.
    pub fn run(&self, plan: &Plan, watch: &dyn Watch) -> Result<Findings, Fault> {
        let studies = (self.studies)();
        let findings: Vec<Result<Findings, Fault>> = studies.par_iter().map(|study| study.run(plan, watch)).collect();
        findings.into_iter().try_fold(Findings::default(), |all, one| Ok(all.and(one?)))
    }
}

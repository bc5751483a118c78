//! The methods by which one axis can be identified.

use super::axis::{Analysis, Identified};
use super::series::{Kind, Series};
use super::{gaussian, matrix_pencil, particle_swarm, support_vector, tufts_kumaresan, whale, whittle, yule_walker};

/// A method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Method {
    /// Relevance vector machine with damped sinusoids (000).
    #[default]
    Rvm,
    /// Relevance vector machine with a Gaussian kernel, then the model fitted (000).
    RvmGaussian,
    /// Support vector regression, then the model fitted (000's rival).
    SupportVector,
    /// Whale optimisation (000's rival).
    Whale,
    /// Particle swarm optimisation.
    ParticleSwarm,
    /// Tufts-Kumaresan at lags 0.25 s apart (003).
    TuftsKumaresan,
    /// Tufts-Kumaresan at the lags of paper 003.
    TuftsKumaresanPrinted,
    /// Modified Yule-Walker equations.
    YuleWalker,
    /// Matrix pencil.
    MatrixPencil,
    /// Whittle's maximum likelihood.
    Whittle,
}

impl Method {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Rvm,
        Self::RvmGaussian,
        Self::SupportVector,
        Self::Whale,
        Self::ParticleSwarm,
        Self::TuftsKumaresan,
        Self::TuftsKumaresanPrinted,
        Self::YuleWalker,
        Self::MatrixPencil,
        Self::Whittle,
    ];

    /// Its name in a configuration.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rvm => "rvm",
            Self::RvmGaussian => "rvm_gaussian",
            Self::SupportVector => "support_vector",
            Self::Whale => "whale",
            Self::ParticleSwarm => "particle_swarm",
            Self::TuftsKumaresan => "tufts_kumaresan",
            Self::TuftsKumaresanPrinted => "tufts_kumaresan_printed",
            Self::YuleWalker => "yule_walker",
            Self::MatrixPencil => "matrix_pencil",
            Self::Whittle => "whittle",
        }
    }

    /// The method made ready for series like this one; `dictionary` is the size of the relevance vector machine's.
    pub fn solver(self, like: &Series, dictionary: usize) -> Solver {
        let analysis = (self == Self::Rvm && like.is_usable()).then(|| {
            let (points, step_s) = thinned(like);
            Analysis::new(points, step_s, dictionary, true)
        });
        Solver { method: self, analysis }
    }
}

/// A method with what it prepares once for many series of the same length.
#[derive(Clone, Debug)]
pub struct Solver {
    method: Method,
    analysis: Option<Analysis>,
}

impl Solver {
    /// Identifies an axis from data without mean; `None` if they are too few, constant, not finite, or fit no flexure.
    pub fn solve(&self, series: &Series) -> Option<Identified> {
        if !series.is_usable() {
            return None;
        }
        match self.method {
            Method::Rvm => self.analysis.as_ref()?.identify(&rates(series)),
            Method::RvmGaussian => gaussian::identify(series),
            Method::SupportVector => support_vector::identify(series),
            Method::Whale => whale::identify(series),
            Method::ParticleSwarm => particle_swarm::identify(series),
            Method::TuftsKumaresan => tufts_kumaresan::identify(series, &tufts_kumaresan::DECIMATED),
            Method::TuftsKumaresanPrinted => tufts_kumaresan::identify(series, &tufts_kumaresan::PRINTED),
            Method::YuleWalker => yule_walker::identify(series),
            Method::MatrixPencil => matrix_pencil::identify(series),
            Method::Whittle => whittle::identify(series, &whittle::Settings::of(series)),
        }
    }
}

/// Identifies one axis from a series without mean; `None` as for [`Solver::solve`], and if the numbers describe no flexure.
pub fn identify_axis(method: Method, series: &Series) -> Option<Identified> {
    method.solver(series, 1).solve(series).filter(|found| found.flexure.is_sound())
}

/// Distance of the angles whose differences the relevance vector machine takes, s.
const SPACING_S: f64 = 0.1;

fn stride(series: &Series) -> usize {
    (SPACING_S / series.step_s).round().max(1.0) as usize
}

/// Number and distance of the rates that the relevance vector machine gets.
fn thinned(series: &Series) -> (usize, f64) {
    match series.kind {
        Kind::Rates => (series.values.len(), series.step_s),
        Kind::Angles => ((series.values.len() - 1) / stride(series), series.step_s * stride(series) as f64),
    }
}

/// The relevance vector machine's model is one of rates: of angles it gets the differences.
fn rates(series: &Series) -> Vec<f64> {
    let (count, step_s) = thinned(series);
    match series.kind {
        Kind::Rates => series.values.to_vec(),
        Kind::Angles => {
            let at = |k: usize| series.values[k * stride(series)];
            (0..count).map(|k| (at(k + 1) - at(k)) / step_s).collect()
        }
    }
}

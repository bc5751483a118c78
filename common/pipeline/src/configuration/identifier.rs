//! The settings of the slow stage of an area.

use super::{quantity, table};
use estimation::flexure::{Flexure, Hull};
use estimation::identify::Method;
use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};
use std::fmt;

/// The methods of the slow stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IdentifierMethod {
    /// The model is learnt from a window of data by this method.
    Learnt(Method),
    /// Nothing is learnt: this model.
    Fixed(Hull),
}

/// The slow stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdentifierSettings {
    /// Which method.
    pub method: IdentifierMethod,
    /// Length of the window of data, s.
    pub window_s: f64,
    /// Time from one parameter set to the next, s.
    pub period_s: f64,
    /// From the end of a window to the data time at which its parameters take effect, s.
    pub lead_s: f64,
    /// Shortest window that gives parameters, s.
    pub minimum_s: f64,
    /// Size factor of the dictionary of models, 1 to 100.
    pub dictionary: usize,
    /// Whether what is learnt is made safe for a filter, or used as the method gives it.
    pub safety: bool,
}

impl Default for IdentifierSettings {
    fn default() -> Self {
        Self {
            method: IdentifierMethod::Learnt(Method::Whittle),
            window_s: 600.0,
            period_s: 10.0,
            lead_s: 1.0,
            minimum_s: 30.0,
            dictionary: 1,
            safety: true,
        }
    }
}

/// The name of the method that learns nothing.
const FIXED: &str = "fixed";

/// What a method can be called: the methods that learn, then [`FIXED`].
const NAMES: [&str; Method::ALL.len() + 1] = {
    let mut names = [FIXED; Method::ALL.len() + 1];
    let mut i = 0;
    while i < Method::ALL.len() {
        names[i] = Method::ALL[i].name();
        i += 1;
    }
    names
};

/// A method by its name; `None` where nothing is learnt.
fn method<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Method>, D::Error> {
    struct NameVisitor;
    impl Visitor<'_> for NameVisitor {
        type Value = Option<Method>;
        fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
            f.write_str("a string")
        }
        fn visit_str<E: Error>(self, name: &str) -> Result<Option<Method>, E> {
            match Method::ALL.into_iter().find(|method| method.name() == name) {
                None if name != FIXED => Err(E::unknown_variant(name, &NAMES)),
                learnt => Ok(learnt),
            }
        }
    }
    deserializer.deserialize_str(NameVisitor)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
struct IdentifierTable {
    #[serde(deserialize_with = "method")]
    method: Option<Method>,
    #[serde(deserialize_with = "quantity::window_s")]
    window_s: f64,
    #[serde(deserialize_with = "quantity::period_s")]
    period_s: f64,
    #[serde(deserialize_with = "quantity::lead_s")]
    lead_s: f64,
    /// By default 30 s, or the whole of a shorter window.
    #[serde(deserialize_with = "minimum_s")]
    minimum_s: Option<f64>,
    #[serde(deserialize_with = "quantity::dictionary")]
    dictionary: usize,
    safety: bool,
    #[serde(deserialize_with = "table::optional")]
    flexure: Option<FlexureTable>,
}

impl Default for IdentifierTable {
    fn default() -> Self {
        let IdentifierSettings { window_s, period_s, lead_s, dictionary, safety, .. } = Default::default();
        Self {
            method: Some(Method::Whittle),
            window_s,
            period_s,
            lead_s,
            minimum_s: None,
            dictionary,
            safety,
            flexure: None,
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FlexureTable {
    #[serde(deserialize_with = "quantity::mu_per_s")]
    mu_per_s: [f64; 3],
    #[serde(deserialize_with = "quantity::b_rad_per_s")]
    b_rad_per_s: [f64; 3],
    #[serde(deserialize_with = "quantity::sigma_arcsec")]
    sigma_arcsec: [f64; 3],
}

/// Joins method and flexure.
pub(super) fn identifier<'de, D: Deserializer<'de>>(deserializer: D) -> Result<IdentifierSettings, D::Error> {
    let table: IdentifierTable = table::one(deserializer)?;
    let method = match (table.method, table.flexure) {
        (Some(method), None) => IdentifierMethod::Learnt(method),
        (Some(method), Some(_)) => {
            let name = method.name();
            let message = format!("the key `flexure` goes with method \"fixed\" only, not with \"{name}\"");
            return Err(D::Error::custom(message));
        }
        (None, None) => return Err(D::Error::custom("method \"fixed\" needs the key `flexure`")),
        (None, Some(f)) => {
            let axis = |i| Flexure { mu: f.mu_per_s[i], b: f.b_rad_per_s[i], sigma: f.sigma_arcsec[i] };
            IdentifierMethod::Fixed([0, 1, 2].map(axis).into())
        }
    };
    let IdentifierTable { window_s, period_s, lead_s, dictionary, safety, .. } = table;
    let minimum_s = table.minimum_s.unwrap_or(IdentifierSettings::default().minimum_s.min(window_s));
    Ok(IdentifierSettings { method, window_s, period_s, lead_s, minimum_s, dictionary, safety })
}

fn minimum_s<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    quantity::window_s(deserializer).map(Some)
}

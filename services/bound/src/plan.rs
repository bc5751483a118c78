//! What is run: the configuration's scenario, and the project's own estimator that is told the true flexure.

use pipeline::configuration::{
    Area, AreaSimulation, Configuration, ConfigurationError, EstimatorSettings, FilterMethod, IdentifierMethod,
    MatchingMethod, RangeMethod, RegistrationMethod, Source,
};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::path::Path;
use toml::Spanned;

/// Length of the data where neither the user nor the configuration tells one, s.
const DURATION_S: f64 = 1800.0;

/// What is run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The scenario and the told estimator.
    pub configuration: Configuration,
    /// Length of the data, s.
    pub duration_s: f64,
}

/// The tables whose defaults are a paper's ship, which a user who plans for his own must not get unasked.
#[derive(Deserialize)]
struct Stated {
    main: StatedMain,
    simulation: Option<IgnoredAny>,
    area: Vec<Spanned<StatedArea>>,
}

#[derive(Deserialize)]
struct StatedMain {
    source: Spanned<IgnoredAny>,
}

#[derive(Deserialize)]
struct StatedArea {
    simulation: Option<StatedTruth>,
}

#[derive(Deserialize)]
struct StatedTruth {
    flexure: Option<IgnoredAny>,
}

impl Plan {
    /// Reads a configuration; `duration_s` goes before the configured one, and that before half an hour.
    ///
    /// # Errors
    /// Those of [`Configuration::read`]; the source is not simulated; the ship's motion or an area's true flexure is not told.
    pub fn read(path: &Path, duration_s: Option<f64>) -> Result<Self, ConfigurationError> {
        let text = std::fs::read_to_string(path)
            .map_err(|reason| ConfigurationError::Unreadable { path: path.to_path_buf(), reason })?;
        let configuration = Configuration::parse(path, &text)?;
        require_truth(&configuration, &text)?;
        let duration_s = duration_s.or(configuration.run.duration_s).unwrap_or(DURATION_S);
        let configuration = configuration.with(|configuration| {
            configuration.run.duration_s = Some(duration_s);
            configuration.areas.iter_mut().for_each(tell);
        });
        Ok(Self { configuration, duration_s })
    }
}

/// Refuses a configuration from whose words alone nothing can be simulated.
fn require_truth(configuration: &Configuration, text: &str) -> Result<(), ConfigurationError> {
    let path = &configuration.path;
    let fault = |place: Option<usize>, message: String| {
        let line = place.map(|byte| 1 + text[..byte].matches('\n').count());
        ConfigurationError::Invalid { path: path.clone(), line, message }
    };
    let stated: Stated = toml::from_str(text).map_err(|error| fault(None, error.message().to_owned()))?;
    if configuration.main.source != Source::Simulator {
        let message = format!(
            "main.source.kind = \"{}\": a bound needs simulated motion and a true flexure: give every unit \
             source = {{ kind = \"simulator\" }}, and add [simulation] and [area.simulation] with `flexure`",
            configuration.main.source.kind()
        );
        return Err(fault(Some(stated.main.source.span().start), message));
    }
    let mut faults = Vec::new();
    if stated.simulation.is_none() {
        let message = "the required key `simulation` is missing, without which no motion is told: add [simulation] with roll, pitch and \
                       heading, such as roll = { amplitude_deg = 10, period_s = 8 }";
        faults.push(fault(None, message.to_owned()));
    }
    for (i, area) in stated.area.iter().enumerate() {
        if area.get_ref().simulation.as_ref().is_none_or(|truth| truth.flexure.is_none()) {
            let message = format!(
                "the required key `area[{i}].simulation.flexure` is missing, the true flexure: add [area.simulation] with \
                 flexure = {{ tau_s = [10, 10, 30], sigma_arcmin = [6, 6, 10] }} or the like"
            );
            faults.push(fault(Some(area.span().start), message));
        }
    }
    match faults.len() {
        0 => Ok(()),
        1 => Err(faults.remove(0)),
        _ => Err(ConfigurationError::Several(faults)),
    }
}

/// Gives an area the project's own estimator with the true flexure; what the user says of rates, delay and installation stays.
fn tell(area: &mut Area) {
    area.identifier.method = IdentifierMethod::Fixed(area.simulation.hull());
    area.estimator = EstimatorSettings {
        matching: MatchingMethod::Deck,
        registration: RegistrationMethod::Motion,
        filter: FilterMethod::Kalman,
        range: Some(RangeMethod::Normal),
        network: None,
        ..area.estimator
    };
}

/// Whether both units have accelerometers to compare.
pub fn has_accelerometers(configuration: &Configuration, area: usize) -> bool {
    configuration.main.accel.and(configuration.areas[area].accel).is_some()
}

/// Standard deviation of an area's total deformation by its survey alone, rad.
pub fn surveyed(area: &Area) -> Option<[f64; 3]> {
    let sigma = area.installation?.sigma;
    Some(area.simulation.flexure.map(|axis| axis.sigma.hypot(sigma)))
}

/// What the truth of an area has and the model of the bound has not, with its key.
pub fn left_out(configuration: &Configuration, area: usize) -> Vec<&'static str> {
    let (ship, truth) = (&configuration.simulation, &configuration.areas[area].simulation);
    let usual = AreaSimulation::default();
    let parts = [
        (truth.coupling.is_some(), "flexure in step with the ship's swing (area.simulation.coupling)"),
        (truth.impulses.is_some(), "impulsive waves (area.simulation.impulses)"),
        (!truth.flexure_changes.is_empty(), "changes of the flexure model (area.simulation.flexure_changes)"),
        (truth.second_flexure.is_some(), "a second mode of the hull (area.simulation.second_flexure)"),
        (!truth.events.is_empty(), "what goes wrong with the unit (area.simulation.events)"),
        (truth.starts_at_rest, "flexure that is zero at the start (area.simulation.starts_at_rest)"),
        (truth.outliers != usual.outliers, "samples that are far off (area.simulation.outliers)"),
        (
            truth.gyro.is_some() || truth.accel.is_some() || ship.gyro.is_some() || ship.accel.is_some(),
            "units whose true errors are not of the configured grade (simulation.gyro, simulation.accel)",
        ),
    ];
    parts.into_iter().filter(|(has, _)| *has).map(|(_, name)| name).collect()
}

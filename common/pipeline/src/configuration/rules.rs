//! Rules that more than one key takes part in.

use super::document::Document;
use super::{
    Area, Configuration, ConfigurationError, Port, RangeMethod, RecordSettings, RegistrationMethod, Source, output,
};
use std::path::Path;

/// Makes the paths of the recordings absolute and checks the whole; all faults are reported.
pub(super) fn apply(configuration: &mut Configuration, document: &Document) -> Result<(), ConfigurationError> {
    let mut faults = Vec::new();
    let folder = std::path::absolute(&configuration.path).unwrap_or_else(|_| configuration.path.clone());
    let folder = folder.parent().unwrap_or(Path::new(""));
    faults.extend(locate(&mut configuration.main.source, folder, "main", document));
    for (i, area) in configuration.areas.iter_mut().enumerate() {
        faults.extend(locate(&mut area.source, folder, &format!("area[{i}]"), document));
    }
    if !configuration.as_recorded {
        sources(configuration, document, &mut faults);
    }
    if let Some(record) = &mut configuration.record {
        record.folder = folder.join(&record.folder);
        faults.extend(budget(record, document));
    }
    names(&configuration.areas, document, &mut faults);
    times(configuration, document, &mut faults);
    methods(&configuration.areas, document, &mut faults);
    output::rules(configuration, document, &mut faults);
    match faults.len() {
        0 => Ok(()),
        1 => Err(faults.remove(0)),
        _ => Err(ConfigurationError::Several(faults)),
    }
}

fn locate(source: &mut Source, folder: &Path, unit: &str, document: &Document) -> Option<ConfigurationError> {
    let (key, path) = match source {
        Source::Simulator => return None,
        Source::Csv(path) | Source::Mcap(path) => ("path", path),
        Source::Line(line) => {
            line.raw.iter_mut().for_each(|raw| *raw = folder.join(&*raw));
            let Port::File(path) = &mut line.port else { return None };
            ("file", path)
        }
    };
    *path = folder.join(&*path);
    let reason = match std::fs::metadata(&*path) {
        Ok(data) if data.is_dir() => "it is a folder".to_string(),
        Ok(_) => return None,
        Err(error) => error.to_string(),
    };
    Some(document.fault(&format!("{unit}.source.{key}"), &format!("cannot read {}: {reason}", path.display())))
}

fn sources(configuration: &Configuration, document: &Document, faults: &mut Vec<ConfigurationError>) {
    let main = &configuration.main.source;
    let kind = main.kind();
    for (i, area) in configuration.areas.iter().enumerate() {
        if std::mem::discriminant(&area.source) != std::mem::discriminant(main) {
            let others = if main.line().is_some() { "devices on wires" } else { "of one kind" };
            let message = format!("all sources must be {others}, and [main] has \"{kind}\"");
            faults.push(document.fault(&format!("area[{i}].source.kind"), &message));
        } else if kind == "mcap" && area.source != configuration.main.source {
            let message = "all units must come of the same recorded run, and [main] names another file";
            faults.push(document.fault(&format!("area[{i}].source.path"), message));
        }
    }
    let mut useless = |key: &str| {
        if document.has(key) {
            faults.push(document.fault(key, &format!("has no effect with sources of kind \"{kind}\"")));
        }
    };
    // what is simulated can also be put on the wires
    if let Source::Csv(_) | Source::Mcap(_) = main {
        useless("simulation");
        (0..configuration.areas.len()).for_each(|i| useless(&format!("area[{i}].simulation")));
    } else {
        useless("replay");
    }
    ports(configuration, document, faults);
}

/// No two units can listen at one port.
fn ports(configuration: &Configuration, document: &Document, faults: &mut Vec<ConfigurationError>) {
    let areas = configuration.areas.iter().map(|area| &area.source);
    let ports: Vec<_> =
        std::iter::once(&configuration.main.source).chain(areas).map(|s| s.line().map(|l| &l.port)).collect();
    for (unit, port) in ports.iter().enumerate().skip(1) {
        let same = |other: &&Option<&Port>| match (port, other) {
            (Some(Port::Serial { path: a, .. }), Some(Port::Serial { path: b, .. })) => a == b,
            (Some(a), Some(b)) => a == b,
            _ => false,
        };
        if ports[..unit].iter().any(|other| same(&other)) {
            faults.push(document.fault(&format!("area[{}].source", unit - 1), "another unit has the same port"));
        }
    }
}

fn budget(record: &RecordSettings, document: &Document) -> Option<ConfigurationError> {
    let message = "must be at least twice record.rotate_mb, since the file that is being written is never removed";
    record.budget.filter(|budget| *budget < 2.0 * record.rotate).map(|_| document.fault("record.budget_mb", message))
}

fn names(areas: &[Area], document: &Document, faults: &mut Vec<ConfigurationError>) {
    if areas.is_empty() {
        faults.push(document.fault("area", "at least one [[area]] is required"));
    }
    for (i, area) in areas.iter().enumerate() {
        if let Some(first) = areas[..i].iter().position(|other| other.name == area.name) {
            faults.push(document.fault(&format!("area[{i}].name"), &format!("area[{first}] has the same name")));
        }
    }
}

fn times(configuration: &Configuration, document: &Document, faults: &mut Vec<ConfigurationError>) {
    let rate = configuration.rate_hz;
    if configuration.silence_s * rate < 2.0 {
        let message = format!("must be at least two samples, {} s at {rate} Hz", 2.0 / rate);
        faults.push(document.fault("silence_s", &message));
    }
    for (i, area) in configuration.areas.iter().enumerate() {
        if area.estimator.filter_hz > rate {
            let message = format!("must not be above rate_hz = {rate}");
            faults.push(document.fault(&format!("area[{i}].estimator.filter_hz"), &message));
        }
        let (minimum, window) = (area.identifier.minimum_s, area.identifier.window_s);
        if minimum > window {
            let message = format!("{minimum} s is longer than window_s = {window}");
            faults.push(document.fault(&format!("area[{i}].identifier.minimum_s"), &message));
        }
    }
}

/// Every part of the fast stage must have a meaning with its matching.
fn methods(areas: &[Area], document: &Document, faults: &mut Vec<ConfigurationError>) {
    for (i, area) in areas.iter().enumerate() {
        let told = &area.estimator;
        let matching = told.matching;
        let mut part = |key: &str, meant: bool, others: String| {
            if !meant {
                let message =
                    format!("has no meaning with matching = \"{}\", which goes with {others}", name(&matching));
                faults.push(document.fault(&format!("area[{i}].estimator.{key}"), &message));
            }
        };
        part("registration", matching.registrations().contains(&told.registration), names_of(matching.registrations()));
        part("filter", matching.filters().contains(&told.filter), names_of(matching.filters()));
        part("delay", told.delay.is_none() || matching.takes_delay(), "no delay".into());
        part("network", told.network.is_none() || matching.takes_network(), "no network".into());
        part("range", matching.ranges().contains(&told.range()), names_of(matching.ranges()));
        let factor = format!("area[{i}].estimator.range_factor");
        if document.has(&factor) && !matches!(told.range(), RangeMethod::ErrorRange | RangeMethod::Coherence) {
            let message = "goes with range = \"error_range\" or \"coherence\" only";
            faults.push(document.fault(&factor, message));
        }
        if told.registration == RegistrationMethod::Installation && area.installation.is_none() {
            let message = "\"installation\" needs the table `installation`";
            faults.push(document.fault(&format!("area[{i}].estimator.registration"), message));
        }
    }
}

/// The name of a method, as in the configuration.
fn name<T: std::fmt::Debug>(method: &T) -> String {
    let variant = format!("{method:?}");
    let mut name = String::new();
    for (i, letter) in variant.chars().enumerate() {
        if letter.is_ascii_uppercase() && i > 0 {
            name.push('_');
        }
        name.push(letter.to_ascii_lowercase());
    }
    name
}

fn names_of<T: std::fmt::Debug>(methods: &[T]) -> String {
    methods.iter().map(|method| format!("\"{}\"", name(method))).collect::<Vec<_>>().join(", ")
}

//! The numbers as JSON: each key carries its unit of measure, `null` stands for what is not shown.

use crate::report::{Report, Triad};
use crate::{Kind, paste};
use estimation::allan::{Analysis, Point};
use serde_json::{Map, Value, json};

/// The document, with a new line at its end.
pub fn of(report: &Report) -> serde_json::Result<String> {
    let triads: Map<String, Value> = report.triads.iter().map(|t| (name(t.kind).to_owned(), triad(t))).collect();
    let counts = report.counts;
    let document = json!({
        "file": report.path.display().to_string(),
        "samples": report.samples,
        "interval_s": report.interval,
        "stretches": report.stretches,
        "bridged": report.bridged,
        "refused": counts.refused,
        "not_finite": counts.not_finite,
        "repeated": counts.repeated,
        "back": counts.back,
        "suspicions": report.suspicions,
        "triads": triads,
    });
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

fn name(kind: Kind) -> &'static str {
    match kind {
        Kind::Gyro => "gyro",
        Kind::Accel => "accel",
    }
}

fn triad(triad: &Triad) -> Value {
    let measure = triad.kind.deviation();
    let axes: Map<String, Value> = ["x", "y", "z"]
        .iter()
        .zip(&triad.axes)
        .zip(triad.mean)
        .map(|((axis, analysis), mean)| {
            let mut told = analysis.as_ref().map_or_else(Map::new, |analysis| of_axis(triad, analysis));
            told.insert(format!("mean_{}", measure.key), json!(mean / measure.si));
            ((*axis).to_owned(), Value::Object(told))
        })
        .collect();
    json!({ "configuration": paste::line(triad), "axes": axes })
}

fn of_axis(triad: &Triad, analysis: &Analysis) -> Map<String, Value> {
    let measure = triad.kind.deviation();
    let point = |point: &Point| {
        let mut told = Map::new();
        told.insert("tau_s".to_owned(), json!(point.tau));
        for (name, value) in
            [("deviation", point.deviation), ("lower", point.lower), ("upper", point.upper), ("model", point.model)]
        {
            told.insert(format!("{name}_{}", measure.key), json!(value / measure.si));
        }
        told.insert("degrees_of_freedom".to_owned(), json!(point.freedom));
        Value::Object(told)
    };
    let mut told = Map::new();
    for (named, of) in triad.coefficients() {
        let estimate = of(&analysis.coefficients)
            .map(|e| json!({ "value": e.value / named.measure.si, "sigma": e.sigma / named.measure.si }));
        told.insert(format!("{}_{}", named.key, named.measure.key), json!(estimate));
    }
    let most = analysis.coefficients.most_instability / measure.si;
    told.insert(format!("flicker_less_than_{}", measure.key), json!(most));
    told.insert("points".to_owned(), Value::Array(analysis.points.iter().map(point).collect()));
    told
}

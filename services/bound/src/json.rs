//! The numbers of the tables as JSON: times in s, standard deviations in arcsec, `null` where there is none.

use crate::SEEDS;
use crate::report::{LIMITS_ARCSEC, Report, Row};
use frames::unit::ARCSEC;
use serde::Serialize;

#[derive(Serialize)]
struct Document<'a> {
    duration_s: f64,
    seeds: [u64; 4],
    areas: Vec<Area<'a>>,
}

#[derive(Serialize)]
struct Area<'a> {
    name: &'a str,
    accelerometers: bool,
    rows: Vec<Sigmas>,
    below: Vec<Below>,
    unobservable: bool,
    hardly_shown: Vec<char>,
    left_out: &'a [&'static str],
}

#[derive(Serialize)]
struct Sigmas {
    t_s: f64,
    sigma_arcsec: Option<[f64; 3]>,
    static_sigma_arcsec: Option<[f64; 3]>,
}

#[derive(Serialize)]
struct Below {
    limit_arcsec: f64,
    from_s: [Option<f64>; 3],
}

/// The document, with a new line at its end.
pub fn of(report: &Report) -> serde_json::Result<String> {
    let areas = report.areas.iter().map(|told| area(told, report.duration_s)).collect();
    let document = Document { duration_s: report.duration_s, seeds: SEEDS, areas };
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

fn area(told: &crate::Area, duration_s: f64) -> Area<'_> {
    let below = |limit: f64| Below { limit_arcsec: limit, from_s: told.below(limit * ARCSEC) };
    Area {
        name: &told.name,
        accelerometers: told.has_accelerometers,
        rows: told.rows(duration_s).into_iter().map(sigmas).collect(),
        below: LIMITS_ARCSEC.map(below).into(),
        unobservable: told.is_unobservable,
        hardly_shown: told.hardly_shown(),
        left_out: &told.left_out,
    }
}

fn sigmas(row: Row) -> Sigmas {
    let arcsec = |sigma: [f64; 3]| sigma.map(|sigma| sigma / ARCSEC);
    Sigmas {
        t_s: row.t_s,
        sigma_arcsec: row.point.map(|point| arcsec(point.total)),
        static_sigma_arcsec: row.point.map(|point| arcsec(point.fixed)),
    }
}

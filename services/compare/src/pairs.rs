//! Joins two files by time.

use estimation::evaluate::against::between;
use frames::{Main, Rot, Sub};
use pipeline::deformation_file::Row;

/// A solution and where the reference was at its time.
pub struct Pair {
    pub t: f64,
    pub solution: Row,
    pub reference: Rot<Main, Sub>,
}

pub struct Joined {
    pub pairs: Vec<Pair>,
    /// Solutions for which the reference has nothing near enough.
    pub unmatched: u64,
    /// Pairs whose reference stands between two of its rows.
    pub interpolated: u64,
}

/// The reference is not interpolated over more than so many of its usual intervals.
const HOLE: f64 = 2.5;
/// Times closer than this are the same, s.
const SAME: f64 = 1e-6;

/// The reference at the solution's times; both in the order of time.
pub fn join(solution: &[Row], reference: &[Row]) -> Joined {
    let longest = HOLE * usual_interval(reference);
    let mut joined = Joined { pairs: Vec::new(), unmatched: 0, interpolated: 0 };
    let mut next = 0;
    for row in solution {
        while reference.get(next).is_some_and(|candidate| candidate.t < row.t - SAME) {
            next += 1;
        }
        let found = match (next.checked_sub(1).and_then(|i| reference.get(i)), reference.get(next)) {
            (_, Some(after)) if after.t - row.t <= SAME => Some(after.rotation),
            (Some(before), Some(after)) if after.t - before.t <= longest => {
                joined.interpolated += 1;
                let share = (row.t - before.t) / (after.t - before.t);
                Some(between(before.rotation, after.rotation, share))
            }
            _ => None,
        };
        match found {
            Some(reference) => joined.pairs.push(Pair { t: row.t, solution: *row, reference }),
            None => joined.unmatched += 1,
        }
    }
    joined
}

fn usual_interval(rows: &[Row]) -> f64 {
    let mut steps: Vec<f64> = rows.windows(2).map(|pair| pair[1].t - pair[0].t).collect();
    steps.sort_unstable_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(0.0)
}

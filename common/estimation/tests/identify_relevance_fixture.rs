//! The relevance vector machine beside scikit-learn's automatic relevance determination, which climbs the same marginal likelihood by
//! another way: `fixtures/relevance.json`, made by `fixtures/relevance.py`.
#![allow(clippy::unwrap_used)]

use estimation::identify::dictionary::Atom;
use estimation::identify::relevance::{Limits, Relevance, solve};
use nalgebra::{DMatrix, DVector};
use serde_json::Value;

const DAMPINGS: [f64; 3] = [0.1, 0.3, 1.0];
const FREQUENCIES: [f64; 4] = [0.0, 0.5, 1.0, 2.0];

fn atoms() -> Vec<Atom> {
    let poles = DAMPINGS.iter().flat_map(|&damping| FREQUENCIES.map(|frequency| (damping, frequency)));
    poles
        .flat_map(|(damping, frequency)| [Atom::Cosine { damping, frequency }, Atom::Sine { damping, frequency }])
        .collect()
}

fn design() -> DMatrix<f64> {
    let atoms = atoms();
    let mut design = DMatrix::from_fn(100, atoms.len(), |row, k| atoms[k].value(0.2 * (row + 1) as f64));
    design.column_iter_mut().for_each(|mut column| column /= column.norm());
    design
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

fn cases() -> Vec<Value> {
    let fixture: Value = serde_json::from_str(include_str!("fixtures/relevance.json")).unwrap();
    fixture["cases"].as_array().unwrap().clone()
}

fn ours(case: &Value) -> Relevance {
    let limits = Limits { gain: 1e-8, rounds: 3000, noise_share: 1e-9 };
    solve(&design(), &DVector::from_vec(numbers(&case["target"])), &limits).unwrap()
}

#[test]
fn evidence_is_within_one_per_cent() {
    for case in cases() {
        let (found, wanted) = (ours(&case).evidence, case["evidence"].as_f64().unwrap());
        assert!((found / wanted - 1.0).abs() < 0.01, "seed {}: {found} {wanted}", case["seed"]);
    }
}

#[test]
fn the_same_columns_are_active_so_the_same_poles() {
    for case in cases() {
        let mut found = ours(&case).active;
        found.sort_unstable();
        let wanted: Vec<usize> = numbers(&case["active"]).into_iter().map(|i| i as usize).collect();
        assert_eq!(found, wanted, "seed {}", case["seed"]);
    }
}

//! The relevance vector machine on its own.
#![allow(clippy::unwrap_used)]

use estimation::identify::relevance::{Limits, Relevance, solve};
use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

const NOISE: f64 = 0.05;

/// A random design with three columns in the target, and more rows than columns.
fn problem(seed: u64) -> (DMatrix<f64>, DVector<f64>) {
    let mut rng = Pcg64::seed_from_u64(seed);
    let design = DMatrix::from_fn(60, 45, |_, _| StandardNormal.sample(&mut rng));
    let noise = DVector::from_fn(60, |_, _| NOISE * Distribution::<f64>::sample(&StandardNormal, &mut rng));
    let target = design.column(7) * 1.5 - design.column(40) * 0.8 + design.column(21) * 0.5 + noise;
    (design, target)
}

/// The logarithm of the marginal likelihood from its definition, with the N by N covariance.
fn evidence(design: &DMatrix<f64>, target: &DVector<f64>, active: &[usize], precisions: &[f64], noise: f64) -> f64 {
    let n = target.len();
    let mut covariance = DMatrix::identity(n, n) * noise;
    for (&i, precision) in active.iter().zip(precisions) {
        covariance += design.column(i) * design.column(i).transpose() / *precision;
    }
    let factor = covariance.cholesky().unwrap();
    let size: f64 = factor.l().diagonal().iter().map(|d| 2.0 * d.ln()).sum();
    -0.5 * (n as f64 * std::f64::consts::TAU.ln() + size + target.dot(&factor.solve(target)))
}

fn solved(seed: u64) -> (DMatrix<f64>, DVector<f64>, Relevance) {
    let (design, target) = problem(seed);
    let found = solve(&design, &target, &Limits::default()).unwrap();
    (design, target, found)
}

#[test]
fn evidence_is_that_of_the_definition() {
    for seed in 0..10 {
        let (design, target, found) = solved(seed);
        let wanted = evidence(&design, &target, &found.active, &found.precisions, found.noise);
        assert!((found.evidence - wanted).abs() < 1e-7 * wanted.abs(), "{seed}: {} {wanted}", found.evidence);
    }
}

#[test]
fn no_single_change_raises_the_evidence() {
    for seed in 0..5 {
        let (design, target, found) = solved(seed);
        let Relevance { active, precisions, noise, evidence: best, .. } = &found;
        for k in 0..active.len() {
            for factor in [0.5, 0.9, 1.1, 2.0, 1e9] {
                let mut changed = precisions.clone();
                changed[k] *= factor;
                let other = evidence(&design, &target, active, &changed, *noise);
                assert!(other < best + 1e-3, "{seed} {k} {factor}: {other} {best}");
            }
        }
        for i in (0..design.ncols()).filter(|i| !active.contains(i)) {
            let more: Vec<usize> = active.iter().copied().chain([i]).collect();
            for precision in [1.0, 1e2, 1e4, 1e6] {
                let changed: Vec<f64> = precisions.iter().copied().chain([precision]).collect();
                let other = evidence(&design, &target, &more, &changed, *noise);
                assert!(other < best + 1e-3, "{seed} {i} {precision}: {other} {best}");
            }
        }
    }
}

#[test]
fn the_columns_of_the_target_are_found() {
    let mut extra = 0;
    for seed in 0..20 {
        let (_, _, found) = solved(seed);
        for (column, weight) in [(7, 1.5), (40, -0.8), (21, 0.5)] {
            let place = found.active.iter().position(|&i| i == column).expect("a column of the target is missing");
            let sd = found.covariance[(place, place)].sqrt();
            assert!(
                (found.weights[place] - weight).abs() < 5.0 * sd.max(0.5 * NOISE / 60_f64.sqrt()),
                "{seed} {column}"
            );
        }
        extra += found.active.len() - 3;
    }
    assert!(extra < 20 * 15, "{extra} spurious columns in 20 seeds");
}

#[test]
fn what_cannot_be_solved_is_refused() {
    let (design, target) = problem(0);
    let limits = Limits::default();
    assert!(solve(&design, &(&target * 0.0), &limits).is_none());
    assert!(solve(&design, &(&target * f64::NAN), &limits).is_none());
    assert!(solve(&design, &target.rows(0, 30).into_owned(), &limits).is_none());
    assert!(solve(&DMatrix::zeros(60, 4), &target, &limits).is_none());
}

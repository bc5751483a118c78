//! Support vector regression, then the model fitted to the smooth curve: 000's rival SVRAM.
//!
//! Source: paper 000 section 5 names it without equations; this is the epsilon-insensitive regression of V. Vapnik with a Gaussian
//! kernel, whose dual is solved as the quadratic programme that it is:
//! `min beta' K beta / 2 - y' beta + epsilon |beta|_1`, `|beta_i| <= C`, `sum beta = 0`.
//!
//! | constant | ours, the paper gives none |
//! |---|---|
//! | C | 10, of values brought to the largest one |
//! | epsilon | 0.02 |
//! | width of the kernel | half the time to the first zero of the autocovariance |

use super::axis::Identified;
use super::gaussian::kernel;
use super::lagged::Lagged;
use super::poles::identified;
use super::series::Series;
use super::tied::{LONGEST_S, SPACING_S, Tied};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT};
use nalgebra::{DMatrix, DVector};

const CAPACITY: f64 = 10.0;
const INSENSITIVE: f64 = 0.02;
/// Range of the kernel's width, s.
const WIDTH_S: (f64, f64) = (0.3, 5.0);
/// At most so many lags are regressed; more cost time and say nothing new.
const MOST: usize = 100;
/// Makes the kernel's matrix definite in spite of rounding.
const RIDGE: f64 = 1e-8;

/// Identifies an axis; `None` if the programme has no solution or the curve fits no flexure.
pub fn identify(series: &Series) -> Option<Identified> {
    let spacing_s = SPACING_S.max(LONGEST_S.min(series.length_s() / 3.0) / MOST as f64);
    let lagged = Lagged::new(series, spacing_s, LONGEST_S)?;
    let curve = regress(&lagged)?;
    identified(series, Tied::new(series, &lagged).least_squares(&curve)?)
}

/// The smooth curve at the lags.
fn regress(lagged: &Lagged) -> Option<DVector<f64>> {
    let largest = lagged.values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let target = DVector::from_column_slice(&lagged.values) / largest;
    let zero = target.iter().position(|value| value * target[0] < 0.0).unwrap_or(target.len());
    let width_s = (0.5 * (zero + 1) as f64 * lagged.spacing_s).clamp(WIDTH_S.0, WIDTH_S.1);
    let kernel = kernel(&lagged.times(), width_s);
    let beta = dual(&kernel, &target)?;
    let smooth = &kernel * &beta;
    // The constant is where the middle of the residuals lies: those of the free vectors stand half above and half below.
    let mut residuals: Vec<f64> = (&target - &smooth).iter().copied().collect();
    residuals.sort_by(f64::total_cmp);
    let constant = residuals[residuals.len() / 2];
    Some(smooth.add_scalar(constant) * largest)
}

/// The differences of the multipliers.
fn dual(kernel: &DMatrix<f64>, target: &DVector<f64>) -> Option<DVector<f64>> {
    let count = target.len();
    // Unknowns: beta, then what bounds its modulus.
    let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for column in 0..count {
        for row in 0..=column {
            rows.push(row);
            columns.push(column);
            values.push(kernel[(row, column)] + if row == column { RIDGE } else { 0.0 });
        }
    }
    let quadratic = CscMatrix::new_from_triplets(2 * count, 2 * count, rows, columns, values);
    let linear: Vec<f64> = target.iter().map(|y| -y).chain(std::iter::repeat_n(INSENSITIVE, count)).collect();
    // sum beta = 0; beta - t <= 0; -beta - t <= 0; t <= C
    let (mut rows, mut columns, mut values) = (vec![0; count], (0..count).collect::<Vec<_>>(), vec![1.0; count]);
    for k in 0..count {
        let (above, below, most) = (1 + k, 1 + count + k, 1 + 2 * count + k);
        rows.extend([above, above, below, below, most]);
        columns.extend([k, count + k, k, count + k, count + k]);
        values.extend([1.0, -1.0, -1.0, -1.0, 1.0]);
    }
    let constraints = CscMatrix::new_from_triplets(1 + 3 * count, 2 * count, rows, columns, values);
    let bounds: Vec<f64> =
        std::iter::repeat_n(0.0, 1 + 2 * count).chain(std::iter::repeat_n(CAPACITY, count)).collect();
    let settings = DefaultSettingsBuilder::default().verbose(false).build().ok()?;
    let cones = [ZeroConeT(1), NonnegativeConeT(3 * count)];
    let mut solver = DefaultSolver::new(&quadratic, &linear, &constraints, &bounds, &cones, settings).ok()?;
    solver.solve();
    let solved = matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved);
    solved.then(|| DVector::from_column_slice(&solver.solution.x[..count]))
}

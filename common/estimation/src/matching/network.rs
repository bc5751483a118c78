//! A small neural network whose weights are states of a filter.
//!
//! Source: paper 001 eqs 24, 31, 32: three inputs, five hidden neurons with tanh, three outputs, 38 weights in the order
//! `W_in` (five by input 1, five by input 2, five by input 3), `b_in` (5), `W_out` (three by neuron), `b_out` (3).
//!
//! Neither the number of neurons nor their function is published; five and tanh are ours.

use nalgebra::{SMatrix, SVector, Vector3};
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64Mcg;
use serde::{Deserialize, Serialize};

/// Neurons of the hidden layer.
pub const HIDDEN: usize = 5;
/// Number of weights.
pub const WEIGHTS: usize = 3 * HIDDEN + HIDDEN + 3 * HIDDEN + 3;
/// Where the weights of the output layer begin: its factors, then its three offsets.
pub const OUT: usize = 4 * HIDDEN;
/// Where the three offsets of the output begin.
pub const OFFSET: usize = WEIGHTS - 3;

type Hidden = SVector<f64, HIDDEN>;

/// The network; inputs and outputs are numbers of about one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Network {
    /// All weights in the order of the file's head.
    pub weights: SVector<f64, WEIGHTS>,
}

impl Network {
    /// Weights of standard deviation `inner` in the hidden layer and `outer` in the output layer, without offset of the output.
    pub fn random(seed: u64, inner: f64, outer: f64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let weights = SVector::from_fn(|i, _| {
            let normal: f64 = rng.sample(StandardNormal);
            match i {
                OFFSET.. => 0.0,
                OUT.. => outer * normal,
                _ => inner * normal,
            }
        });
        Self { weights }
    }

    fn inner(&self) -> SMatrix<f64, HIDDEN, 3> {
        SMatrix::from_column_slice(&self.weights.as_slice()[..3 * HIDDEN])
    }

    fn outer(&self) -> SMatrix<f64, 3, HIDDEN> {
        SMatrix::from_column_slice(&self.weights.as_slice()[OUT..OFFSET])
    }

    fn hidden(&self, input: &Vector3<f64>) -> Hidden {
        (self.inner() * input + self.weights.fixed_rows::<HIDDEN>(3 * HIDDEN)).map(f64::tanh)
    }

    /// The output `g(input, weights)`.
    pub fn output(&self, input: &Vector3<f64>) -> Vector3<f64> {
        self.outer() * self.hidden(input) + self.weights.fixed_rows::<3>(OFFSET)
    }

    /// Derivative of the output by the weights.
    pub fn by_weights(&self, input: &Vector3<f64>) -> SMatrix<f64, 3, WEIGHTS> {
        let hidden = self.hidden(input);
        let outer = self.outer();
        let mut jacobian = SMatrix::<f64, 3, WEIGHTS>::zeros();
        for neuron in 0..HIDDEN {
            let back = outer.column(neuron) * (1.0 - hidden[neuron] * hidden[neuron]);
            for i in 0..3 {
                jacobian.set_column(i * HIDDEN + neuron, &(back * input[i]));
                jacobian[(i, OUT + 3 * neuron + i)] = hidden[neuron];
            }
            jacobian.set_column(3 * HIDDEN + neuron, &back);
        }
        jacobian.fixed_view_mut::<3, 3>(0, OFFSET).fill_with_identity();
        jacobian
    }

    /// Derivative of the output by the input.
    pub fn by_input(&self, input: &Vector3<f64>) -> SMatrix<f64, 3, 3> {
        let slope = self.hidden(input).map(|y| 1.0 - y * y);
        self.outer() * SMatrix::from_diagonal(&slope) * self.inner()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jacobians_are_the_derivatives() {
        let h = 1e-6;
        for seed in 0..5 {
            let network = Network::random(seed, 0.7, 0.9);
            let input = Vector3::new(0.3, -0.8, 1.4);
            for i in 0..WEIGHTS {
                let moved = |by: f64| {
                    let mut other = network.clone();
                    other.weights[i] += by;
                    other.output(&input)
                };
                let numeric = (moved(h) - moved(-h)) / (2.0 * h);
                assert!((numeric - network.by_weights(&input).column(i)).norm() < 1e-8, "weight {i}");
            }
            for i in 0..3 {
                let moved = |by: f64| network.output(&(input + Vector3::ith(i, by)));
                let numeric = (moved(h) - moved(-h)) / (2.0 * h);
                assert!((numeric - network.by_input(&input).column(i)).norm() < 1e-8, "input {i}");
            }
        }
    }

    #[test]
    fn without_output_weights_it_says_nothing() {
        assert_eq!(Network::random(3, 1.0, 0.0).output(&Vector3::new(1.0, 2.0, 3.0)), Vector3::zeros());
    }
}

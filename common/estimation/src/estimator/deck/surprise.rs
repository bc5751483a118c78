//! Whether the data agree with a filter: the normalised innovations squared over the last corrections.

use serde::{Deserialize, Serialize};

/// Mean of the squared innovations in terms of their variance.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Surprise {
    mean: f64,
    weight: f64,
    largest: f64,
}

impl Surprise {
    /// Of a filter whose mean reaches so many corrections back, and whose covariance is too small if it is more than `largest`: with the right model it is
    /// 1, with a cautious one less.
    pub fn new(corrections: f64, largest: f64) -> Self {
        Self { mean: 1.0, weight: corrections.max(1.0).recip(), largest }
    }

    /// Takes the mean over the values of one correction.
    pub fn take(&mut self, square: f64) {
        self.mean += (square - self.mean) * self.weight;
    }

    /// The mean.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// By how much the covariance is too small; 1 where nothing says so.
    pub fn excess(&self) -> f64 {
        if self.mean > self.largest { self.mean } else { 1.0 }
    }

    /// Whether the covariance can be believed.
    pub fn is_small(&self) -> bool {
        self.mean <= self.largest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_outlier_is_borne_and_a_wrong_model_is_not() {
        let mut surprise = Surprise::new(600.0, 3.0);
        surprise.take(900.0);
        assert!(surprise.is_small() && surprise.excess() == 1.0);
        (0..300).for_each(|_| surprise.take(9.0));
        assert!(!surprise.is_small() && surprise.excess() > 3.0);
        (0..3000).for_each(|_| surprise.take(0.8));
        assert!(surprise.is_small());
    }
}

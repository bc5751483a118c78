/// What the mean reading of a triad at rest shows of its bias, at least: by how much the length of the mean lies outside the range that
/// the true vector's length may have, as the deviation of an axis. 0 where it lies inside.
pub fn least_bias(mean: [f64; 3], true_length: [f64; 2]) -> f64 {
    let length = mean.iter().map(|v| v * v).sum::<f64>().sqrt();
    let [least, most] = true_length;
    (length - most).max(least - length).max(0.0) / 3f64.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_lies_outside_counts() {
        assert_eq!(least_bias([0.0, 3.0, 4.0], [4.0, 6.0]), 0.0);
        assert!((least_bias([0.0, 3.0, 4.0], [0.0, 4.0]) - 1.0 / 3f64.sqrt()).abs() < 1e-15);
        assert!((least_bias([0.0, 3.0, 4.0], [7.0, 8.0]) - 2.0 / 3f64.sqrt()).abs() < 1e-15);
    }
}

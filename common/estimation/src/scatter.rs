//! How far values scatter, whatever a few of them are.

/// From the median of absolute values to the standard deviation of a normal variable.
const NORMAL: f64 = 1.4826;

/// Standard deviation of normal values about 0 of whose sizes at least half are in order; 0 without a value. Sorts only as far as that needs.
pub fn deviation(sizes: &mut [f64]) -> f64 {
    let middle = sizes.len() / 2;
    if sizes.is_empty() { 0.0 } else { NORMAL * *sizes.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

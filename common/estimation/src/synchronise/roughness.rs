//! How far a channel's values lie from a smooth line by themselves: the scale of the spike test.

/// From the median of absolute values to the standard deviation of a normal variable.
const NORMAL: f64 = 1.4826;

/// Absolute second and fourth differences of a channel over a block, and the scale that the last whole block gave.
#[derive(Debug)]
pub(super) struct Roughness {
    second: Vec<f64>,
    fourth: Vec<f64>,
    scale: Option<Scale>,
}

/// Standard deviations of differences of successive values, by their medians.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    pub second: f64,
    pub fourth: f64,
}

impl Scale {
    /// Whether the motion's own bend hides more than a higher order's noise: swell sampled slowly.
    pub fn bends(&self, second: f64, fourth: f64) -> bool {
        self.fourth / fourth < self.second / second
    }
}

impl Roughness {
    /// Blocks of at most `length` values.
    pub fn new(length: usize) -> Self {
        Self { second: Vec::with_capacity(length), fourth: Vec::with_capacity(length), scale: None }
    }

    /// The scale of the last whole block; `None` where half of its values lay exactly on a line.
    pub fn scale(&self) -> Option<Scale> {
        self.scale
    }

    /// Takes the differences about one sample.
    pub fn add(&mut self, second: f64, fourth: f64) {
        if self.second.len() < self.second.capacity() {
            self.second.push(second.abs());
            self.fourth.push(fourth.abs());
        }
    }

    /// Ends a block; one with fewer than `least` values leaves the scale as it was.
    pub fn end_block(&mut self, least: usize) {
        if self.second.len() >= least {
            let scale = Scale { second: NORMAL * median(&mut self.second), fourth: NORMAL * median(&mut self.fourth) };
            self.scale = (scale.second > 0.0 && scale.fourth > 0.0).then_some(scale);
        }
        self.second.clear();
        self.fourth.clear();
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.second.clear();
        self.fourth.clear();
        self.scale = None;
    }
}

/// The upper median of at least one value; sorts only as far as that needs.
fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

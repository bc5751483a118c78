//! How far a channel's values lie from a smooth line by themselves: the scale of the spike test.

use crate::scatter::deviation;

/// Before the first block is whole, so many values give a first scale, and each doubling a better one: a spike of the first seconds stands at the beginning of
/// all that is integrated. Only of who was there from the block's beginning on, so that who joins a little later is judged as who joined before.
const FIRST: usize = 32;

/// Absolute second and fourth differences of a channel over a block, and the scale that the last whole block gave.
#[derive(Debug)]
pub(super) struct Roughness {
    second: Vec<f64>,
    fourth: Vec<f64>,
    scale: Option<Scale>,
    /// Whether no block has been whole yet.
    beginning: bool,
}

/// Standard deviations of differences of successive values, by their medians.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    pub second: f64,
    pub fourth: f64,
}

impl Scale {
    /// Standard deviation with which a spike is seen beside its neighbours.
    pub fn spike(&self) -> f64 {
        if self.bends(2.0, 6.0) { self.fourth / 6.0 } else { self.second / 2.0 }
    }

    /// Whether the motion's own bend hides more than a higher order's noise: swell sampled slowly.
    pub fn bends(&self, second: f64, fourth: f64) -> bool {
        self.fourth / fourth < self.second / second
    }
}

impl Roughness {
    /// Blocks of at most `length` values.
    pub fn new(length: usize) -> Self {
        Self { second: Vec::with_capacity(length), fourth: Vec::with_capacity(length), scale: None, beginning: true }
    }

    /// The scale of the last whole block, or of the values so far; `None` where half of its values lay exactly on a line.
    pub fn scale(&self) -> Option<Scale> {
        self.scale
    }

    /// Takes the differences about one sample of a block that is `whole` so far or not.
    pub fn add(&mut self, second: f64, fourth: f64, whole: bool) {
        if self.second.len() < self.second.capacity() {
            self.second.push(second.abs());
            self.fourth.push(fourth.abs());
            let count = self.second.len();
            if self.beginning && whole && count >= FIRST && count.is_power_of_two() {
                self.measure();
            }
        }
    }

    /// The scale of the values so far.
    fn measure(&mut self) {
        let scale = Scale { second: deviation(&mut self.second), fourth: deviation(&mut self.fourth) };
        self.scale = (scale.second > 0.0 && scale.fourth > 0.0).then_some(scale);
    }

    /// Ends a block; one with fewer than `least` values leaves the scale as it was.
    pub fn end_block(&mut self, least: usize) {
        if self.second.len() >= least {
            self.measure();
            self.beginning = false;
        }
        self.second.clear();
        self.fourth.clear();
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.second.clear();
        self.fourth.clear();
        (self.scale, self.beginning) = (None, true);
    }
}

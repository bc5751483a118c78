use nalgebra::SVector;
use serde::de::{Deserializer, Error};
use serde::{Deserialize, Serialize};

/// How far back the means reach, s.
const LENGTH_S: f64 = 3600.0;
/// The past goes out by so many blocks.
const BLOCKS: usize = 60;

/// Means over the last hour, by blocks of a minute, so that the memory is bounded.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Window<const N: usize> {
    /// [`BLOCKS`] of them.
    #[serde(deserialize_with = "blocks")]
    blocks: Box<[Block<N>]>,
    /// The block that is being filled.
    #[serde(deserialize_with = "place")]
    now: usize,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Block<const N: usize> {
    integral: SVector<f64, N>,
    length_s: f64,
}

fn blocks<'de, D: Deserializer<'de>, const N: usize>(deserializer: D) -> Result<Box<[Block<N>]>, D::Error> {
    let blocks = Box::<[Block<N>]>::deserialize(deserializer)?;
    if blocks.len() == BLOCKS { Ok(blocks) } else { Err(D::Error::invalid_length(blocks.len(), &"a block a minute")) }
}

fn place<'de, D: Deserializer<'de>>(deserializer: D) -> Result<usize, D::Error> {
    let place = usize::deserialize(deserializer)?;
    if place < BLOCKS { Ok(place) } else { Err(D::Error::custom("there is no such block")) }
}

impl<const N: usize> Block<N> {
    fn empty() -> Self {
        Self { integral: SVector::zeros(), length_s: 0.0 }
    }
}

impl<const N: usize> Window<N> {
    pub(super) fn new() -> Self {
        Self { blocks: Box::new([Block::empty(); BLOCKS]), now: 0 }
    }

    /// Takes in values that held for `interval_s`, and gives the means by now; `None` before there are any.
    pub(super) fn mean(&mut self, values: SVector<f64, N>, interval_s: f64) -> Option<SVector<f64, N>> {
        let sound = values.iter().all(|value| value.is_finite()) && interval_s > 0.0 && interval_s.is_finite();
        if sound {
            if self.blocks[self.now].length_s >= LENGTH_S / BLOCKS as f64 {
                self.now = (self.now + 1) % BLOCKS;
                self.blocks[self.now] = Block::empty();
            }
            let block = &mut self.blocks[self.now];
            block.integral += values * interval_s;
            block.length_s += interval_s;
        }
        let length_s: f64 = self.blocks.iter().map(|block| block.length_s).sum();
        let integral: SVector<f64, N> = self.blocks.iter().map(|block| block.integral).sum();
        (length_s > 0.0).then(|| integral / length_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector1;

    #[test]
    fn the_past_is_forgotten_after_an_hour() {
        let mut window = Window::new();
        for _ in 0..7200 {
            window.mean(Vector1::new(5.0), 1.0);
        }
        for _ in 0..1800 {
            window.mean(Vector1::new(1.0), 1.0);
        }
        let half = window.mean(Vector1::new(1.0), 1.0).expect("data")[0];
        assert!((half - 3.0).abs() < 0.1, "{half}");
        for _ in 0..3600 {
            window.mean(Vector1::new(1.0), 1.0);
        }
        assert!((window.mean(Vector1::new(1.0), 1.0).expect("data")[0] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn numbers_that_are_none_do_not_enter() {
        let mut window = Window::new();
        assert_eq!(window.mean(Vector1::new(f64::NAN), 1.0), None);
        window.mean(Vector1::new(2.0), 0.5);
        assert_eq!(window.mean(Vector1::new(f64::INFINITY), 1.0), Some(Vector1::new(2.0)));
        assert_eq!(window.mean(Vector1::new(9.0), 0.0), Some(Vector1::new(2.0)));
    }
}

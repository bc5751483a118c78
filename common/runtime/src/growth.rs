use crate::Throttle;

/// Tells when counters have grown, now and then.
#[derive(Debug)]
pub struct Growth<const N: usize> {
    told: [u64; N],
    throttle: Throttle,
}

impl<const N: usize> Default for Growth<N> {
    fn default() -> Self {
        Self { told: [0; N], throttle: Throttle::default() }
    }
}

impl<const N: usize> Growth<N> {
    /// What has come to each counter since it was told last; `None` if nothing has, or if that was a moment ago.
    pub fn take(&mut self, counts: [u64; N], now_ns: i64) -> Option<[Option<u64>; N]> {
        (counts != self.told && self.throttle.pass(now_ns)).then(|| self.tell(counts))
    }

    /// The same at the end, when nothing waits any more.
    pub fn end(&mut self, counts: [u64; N]) -> Option<[Option<u64>; N]> {
        (counts != self.told).then(|| self.tell(counts))
    }

    fn tell(&mut self, counts: [u64; N]) -> [Option<u64>; N] {
        let told = std::mem::replace(&mut self.told, counts);
        std::array::from_fn(|i| Some(counts[i].saturating_sub(told[i])).filter(|grown| *grown > 0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_come_is_told_once_and_nothing_is_forgotten_at_the_end() {
        let mut growth = Growth::default();
        assert_eq!(growth.take([0, 0], 0), None);
        assert_eq!(growth.take([3, 0], 1), Some([Some(3), None]));
        assert_eq!(growth.take([4, 2], 2), None, "a moment ago");
        assert_eq!(growth.end([4, 5]), Some([Some(1), Some(5)]));
        assert_eq!(growth.end([4, 5]), None);
    }
}

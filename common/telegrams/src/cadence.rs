//! Which samples are sent.

/// Takes so many samples a second out of a stream, by the samples' own times: nothing drifts against the data.
#[derive(Clone, Copy, Debug)]
pub struct Cadence {
    period_ns: f64,
    /// Half the time between samples: a sample that is nearest to the due time is the one.
    early_ns: f64,
    due_ns: Option<f64>,
}

impl Cadence {
    /// So many a second out of a stream of `samples_hz`, both above zero; never more than there are.
    pub fn new(rate_hz: f64, samples_hz: f64) -> Self {
        Self { period_ns: 1e9 / rate_hz.min(samples_hz), early_ns: 0.5e9 / samples_hz, due_ns: None }
    }

    /// Whether the sample of this time is to be sent.
    ///
    /// After a gap, and when time jumps back, the samples are taken from the present one on.
    pub fn takes(&mut self, time_ns: i64) -> bool {
        let time_ns = time_ns as f64;
        let Some(due_ns) = self.due_ns.filter(|due_ns| time_ns > due_ns - 2.0 * self.period_ns) else {
            self.due_ns = Some(time_ns + self.period_ns);
            return true;
        };
        if time_ns < due_ns - self.early_ns {
            return false;
        }
        let late = time_ns - due_ns > self.period_ns;
        self.due_ns = Some(if late { time_ns } else { due_ns } + self.period_ns);
        true
    }
}

//! Whose word counts for a sample's time: that of the clock filter, or that of a device which is told UTC.

/// Where a sample's time comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimeSource {
    /// The filter over the arrivals, less the latency that is told.
    #[default]
    Fitted,
    /// The device's UTC (disciplined by GNSS, pulses or PTP), while the host's clock is disciplined too and the filter agrees.
    Device {
        /// How far apart the two may be, ns; beyond, the filter's time is taken and the sample is counted.
        bound_ns: i64,
    },
}

/// What became of a device's word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Word {
    /// It is the sample's time, ns of the host's monotonic clock.
    Taken(i64),
    /// It is too far off what the filter says.
    Refused,
    /// It is not asked for, or not given, or the host cannot understand it.
    None,
}

impl TimeSource {
    /// `utc_ns` is the device's UTC of the sample, `offset_ns` UTC minus the host's monotonic clock, `fitted_ns` what the filter says.
    pub(super) fn word(self, utc_ns: Option<i64>, offset_ns: Option<i64>, fitted_ns: i64) -> Word {
        let (Self::Device { bound_ns }, Some(utc_ns), Some(offset_ns)) = (self, utc_ns, offset_ns) else {
            return Word::None;
        };
        let time_ns = utc_ns - offset_ns;
        if (time_ns - fitted_ns).abs() <= bound_ns { Word::Taken(time_ns) } else { Word::Refused }
    }
}

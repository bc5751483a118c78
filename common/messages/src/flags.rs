use serde::{Deserialize, Serialize};

bitflags::bitflags! {
    /// What a sample, a pair or a solution has to say about itself. The names are those of the solution files.
    #[repr(transparent)]
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
    pub struct Flags: u32 {
        /// The sub unit's attitude was interpolated onto the main unit's instant.
        const INTERPOLATED = 1 << 0;
        /// A few lost samples inside the interval were bridged by interpolation.
        const BRIDGED = 1 << 1;
        /// The data of at least one unit are missing at this instant.
        const GAP = 1 << 2;
        /// The sub unit has been silent for longer than `silence_s` of main data.
        const SILENT = 1 << 3;
        /// A channel was NaN or infinite; its sample counts as lost.
        const NOT_FINITE = 1 << 4;
        /// A channel was at the end of its measuring range.
        const SATURATED = 1 << 5;
        /// A gyro's channels have not changed by a bit for too long.
        const STUCK = 1 << 6;
        /// The unit's clock jumped back.
        const TIME_BACK = 1 << 7;
        /// The accumulated attitudes start anew with this pair.
        const NEW_EPOCH = 1 << 8;
        /// The installation is still being registered: no solution yet.
        const REGISTERING = 1 << 9;
        /// The motion does not show the installation on every axis.
        const UNOBSERVABLE = 1 << 10;
        /// The filter started from the configured installation, not from the motion.
        const INSTALLATION = 1 << 11;
        /// The flexure parameters in use are a broad guess, not identified.
        const PRIOR = 1 << 12;
        /// Parameters arrived after the time at which they should have taken effect.
        const LATE = 1 << 13;
        /// The output is a prediction: no data came in at this instant.
        const COASTING = 1 << 14;
        /// The filter met numbers that it could not use and started anew.
        const RESET = 1 << 15;
        /// A value far off for one sample only was replaced by what its neighbours say, or found too late for that.
        const SPIKE = 1 << 16;
        /// An accelerometer's value has not changed by a bit for too long: the velocity increments are of no use, the angles are.
        const ACCEL_STUCK = 1 << 17;
        /// The data disagree with the filter by more than its covariance allows; the published covariance is widened by as much.
        const INCONSISTENT = 1 << 18;
        /// The deformation and the deck's attitude are those of the sub unit's axes turned by the configured zero.
        const ZEROED = 1 << 19;
    }
}

impl Flags {
    /// What each flag says to a watch, the gravest first.
    pub const SENTENCES: [(Self, &str); 20] = [
        (Self::REGISTERING, "The installation is still being found from the ship's motion: no solution yet."),
        (Self::UNOBSERVABLE, "The motion does not show the installation on every axis; more roll or pitch is needed."),
        (Self::SILENT, "The area's unit gives no data: look at its cable, power and port."),
        (Self::GAP, "Data of a unit are missing at this instant."),
        (Self::COASTING, "The output is a prediction, because no data came."),
        (Self::STUCK, "A gyro gives the same value all the time: its unit may be broken."),
        (Self::ACCEL_STUCK, "An accelerometer gives the same value all the time; the gyros are still used."),
        (Self::SATURATED, "A sensor is at the end of its measuring range."),
        (Self::NOT_FINITE, "A unit sent values that are no numbers; they count as lost."),
        (Self::TIME_BACK, "A unit's clock jumped back."),
        (Self::INCONSISTENT, "The data disagree with the filter; the range has been widened by as much."),
        (Self::RESET, "The filter met numbers that it could not use and started anew."),
        (Self::NEW_EPOCH, "The chain of attitudes started anew."),
        (Self::SPIKE, "A value far off was replaced by what its neighbours say."),
        (Self::BRIDGED, "A few lost samples were bridged."),
        (Self::LATE, "A flexure model came later than it should have."),
        (Self::PRIOR, "The flexure model is still the first guess, not learnt from this ship."),
        (Self::INSTALLATION, "The filter started from the configured installation, not from the motion."),
        (Self::ZEROED, "A zero is in force: the deformation is told from where it was zeroed."),
        (Self::INTERPOLATED, "The area's unit is read between its samples, as its clock asks."),
    ];

    /// The names of the flags that are set, lower case, joined by `|`.
    pub fn names(self) -> String {
        let names: Vec<String> = self.iter_names().map(|(name, _)| name.to_lowercase()).collect();
        names.join("|")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_flag_has_one_sentence() {
        let all = Flags::SENTENCES.iter().fold(Flags::empty(), |all, (flag, _)| all | *flag);
        assert_eq!((all, Flags::SENTENCES.len()), (Flags::all(), Flags::all().iter().count()));
    }
}

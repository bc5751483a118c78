bitflags::bitflags! {
    /// Limits of an area that have been crossed for longer than they may be.
    #[repr(transparent)]
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Alarms: u32 {
        /// Deformation about x.
        const DEFORMATION_X = 1 << 0;
        /// Deformation about y.
        const DEFORMATION_Y = 1 << 1;
        /// Deformation about z.
        const DEFORMATION_Z = 1 << 2;
        /// Range about x.
        const RANGE_X = 1 << 3;
        /// Range about y.
        const RANGE_Y = 1 << 4;
        /// Range about z.
        const RANGE_Z = 1 << 5;
        /// No valid solution.
        const INVALID = 1 << 6;
    }
}

impl Alarms {
    /// The names of the alarms that are raised, lower case, joined by `|`.
    pub fn names(self) -> String {
        let names: Vec<String> = self.iter_names().map(|(name, _)| name.to_lowercase()).collect();
        names.join("|")
    }
}

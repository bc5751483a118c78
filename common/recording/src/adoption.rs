use messages::Header;

/// The sample at which a parameter set took effect, as the solutions tell it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Adoption {
    /// That of the first solution that the set was used for.
    pub header: Header,
    /// Identity of the set.
    pub params_id: u64,
    /// Index of the area.
    pub area: u32,
    /// 1 if the set came after the time from which it was to be in force.
    pub late: u32,
}

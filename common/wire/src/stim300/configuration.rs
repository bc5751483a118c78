//! The datagram that a STIM300 sends at its start, and when it is asked to.

/// What the gyros give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GyroUnit {
    /// Angular rate.
    Rate,
    /// Angle since the last datagram.
    Increment,
    /// Rate averaged since the last datagram.
    Average,
    /// Angle since the start.
    Integrated,
    /// A code that the data sheet does not explain.
    Unknown(u8),
}

/// What the device was told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Configuration {
    /// Letter of the revision.
    pub revision: u8,
    /// Number of the firmware.
    pub firmware: u8,
    /// Datagrams a second; `None` with an external trigger or an unknown code.
    pub rate_hz: Option<u16>,
    /// What the gyros give.
    pub gyro_unit: GyroUnit,
    /// Whether the gyros are delayed to match the accelerometers.
    pub gyro_delayed: bool,
    /// End of the range of the accelerometer along x, g; `None` for an unknown code.
    pub range_g: Option<u16>,
}

impl Configuration {
    /// `data` is the datagram without its check, 22 bytes.
    pub(super) fn decode(data: &[u8]) -> Self {
        let byte = |index: usize| data.get(index).copied().unwrap_or(0);
        let unit = byte(5) & 0x0F;
        Self {
            revision: byte(1),
            firmware: byte(2),
            rate_hz: [125, 250, 500, 1000, 2000].get(usize::from(byte(3) >> 5)).copied(),
            gyro_unit: match unit & 0x03 {
                _ if unit > 7 => GyroUnit::Unknown(unit),
                0 => GyroUnit::Rate,
                1 => GyroUnit::Increment,
                2 => GyroUnit::Average,
                _ => GyroUnit::Integrated,
            },
            gyro_delayed: (4..=7).contains(&unit),
            range_g: match byte(17) >> 4 {
                0 => Some(10),
                3 => Some(5),
                4 => Some(30),
                6 => Some(80),
                _ => None,
            },
        }
    }
}

//! The blocks of a telegram: which bit of which mask stands for how many bytes.

/// Bytes of each block of the navigation mask, by bit.
const NAVIGATION: [u16; 31] =
    [12, 12, 16, 8, 12, 12, 12, 21, 16, 12, 12, 8, 8, 4, 8, 16, 12, 4, 4, 12, 4, 12, 12, 12, 8, 12, 16, 12, 12, 12, 12];
/// Of the extended navigation mask.
const EXTENDED: [u16; 7] = [12, 12, 12, 12, 12, 21, 16];
/// Of the mask of external sensors; 0 for a bit without a meaning.
const EXTERNAL: [u16; 28] =
    [5, 46, 46, 46, 13, 13, 49, 49, 49, 12, 37, 33, 8, 8, 41, 41, 41, 41, 9, 9, 9, 37, 33, 0, 16, 17, 17, 12];

/// The three masks of a telegram, navigation, extended and external.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Masks {
    /// Navigation data.
    pub navigation: u32,
    /// More navigation data, from version 3 on.
    pub extended: u32,
    /// Data of external sensors.
    pub external: u32,
}

/// The mask that a block belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Of navigation data.
    Navigation,
    /// Of more navigation data.
    Extended,
    /// Of external sensors.
    External,
}

impl Masks {
    /// The blocks in the order of the telegram: mask, bit and number of bytes; 0 bytes for a bit without a meaning.
    pub fn blocks(self) -> impl Iterator<Item = (Group, u32, usize)> {
        let of = |mask: u32, group: Group, sizes: &'static [u16]| {
            (0..32).filter(move |bit| mask >> bit & 1 == 1).map(move |bit| {
                let size = sizes.get(bit as usize).copied().unwrap_or(0);
                (group, bit, usize::from(size))
            })
        };
        of(self.navigation, Group::Navigation, &NAVIGATION)
            .chain(of(self.extended, Group::Extended, &EXTENDED))
            .chain(of(self.external, Group::External, &EXTERNAL))
    }

    /// Bytes of all blocks; `None` if a bit has no meaning.
    pub fn size(self) -> Option<usize> {
        self.blocks().map(|(_, _, size)| (size > 0).then_some(size)).sum()
    }

    /// Bytes of the navigation and extended blocks, as versions 4 and 5 tell them.
    pub fn navigation_size(self) -> usize {
        self.blocks().filter(|(group, ..)| *group != Group::External).map(|(.., size)| size).sum()
    }
}

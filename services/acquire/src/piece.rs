/// Longer reads are cut into several pieces of one time of arrival.
pub const LENGTH: usize = 512;

/// Some bytes of a stream, without an allocation of their own.
#[derive(Clone, Copy)]
pub struct Piece {
    /// The unit's place: 0 for the main unit, otherwise 1 + the index of the area.
    pub unit: usize,
    pub arrival_ns: i64,
    length: usize,
    bytes: [u8; LENGTH],
}

impl Piece {
    /// Cuts bytes into pieces.
    pub fn all(unit: usize, arrival_ns: i64, bytes: &[u8]) -> impl Iterator<Item = Self> {
        bytes.chunks(LENGTH).map(move |chunk| {
            let mut piece = Self { unit, arrival_ns, length: chunk.len(), bytes: [0; LENGTH] };
            piece.bytes[..chunk.len()].copy_from_slice(chunk);
            piece
        })
    }

    pub fn bytes(&self) -> &[u8] {
        &self.bytes[..self.length]
    }
}

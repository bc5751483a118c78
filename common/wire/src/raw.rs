//! The bytes of a stream as they came, with the times of their arrival.
//!
//! A file begins with [`MAGIC`]; each piece is the time of its arrival (ns, 8 bytes), its length (4 bytes), both little-endian, and its bytes.
//! A file that breaks off in the middle of a piece gives all pieces before.

/// What a file begins with.
pub const MAGIC: [u8; 8] = *b"DFXRAW1\n";

/// No piece is longer, bytes.
const LONGEST: usize = 1 << 20;

/// Appends a piece.
pub fn append(out: &mut Vec<u8>, arrival_ns: i64, bytes: &[u8]) {
    out.extend_from_slice(&arrival_ns.to_le_bytes());
    out.extend_from_slice(&(bytes.len() as u32).to_le_bytes());
    out.extend_from_slice(bytes);
}

/// The pieces of a file's contents; `None` if it is not such a file.
pub fn pieces(contents: &[u8]) -> Option<impl Iterator<Item = (i64, &[u8])>> {
    let mut rest = contents.strip_prefix(&MAGIC)?;
    Some(std::iter::from_fn(move || {
        let (arrival, tail) = rest.split_first_chunk::<8>()?;
        let (length, tail) = tail.split_first_chunk::<4>()?;
        let length = u32::from_le_bytes(*length) as usize;
        let bytes = tail.get(..length).filter(|_| length <= LONGEST)?;
        rest = &tail[length..];
        Some((i64::from_le_bytes(*arrival), bytes))
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_come_back_up_to_a_cut() {
        let mut file = MAGIC.to_vec();
        append(&mut file, -5, b"abc");
        append(&mut file, i64::MAX, b"");
        append(&mut file, 7, &[9; 300]);
        let read =
            |bytes: &[u8]| pieces(bytes).map(|all| all.map(|(at, bytes)| (at, bytes.to_vec())).collect::<Vec<_>>());
        let all = read(&file).expect("it begins as it should");
        assert_eq!(all, [(-5, b"abc".to_vec()), (i64::MAX, vec![]), (7, vec![9; 300])]);
        for cut in 8..file.len() {
            let some = read(&file[..cut]).expect("it begins as it should");
            assert_eq!(some, all[..some.len()]);
        }
        assert_eq!(read(b"DFXRAW2\nabc"), None);
    }
}

//! Big-endian numbers in and out of bytes.

/// Takes numbers from the beginning of a slice that is known to be long enough.
pub(crate) struct Reader<'a> {
    rest: &'a [u8],
}

macro_rules! numbers {
    ($($name:ident: $type:ty),*) => {$(
        pub fn $name(&mut self) -> $type {
            <$type>::from_be_bytes(self.array())
        }
    )*};
}

impl<'a> Reader<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    /// Zeros where the bytes have come to their end.
    fn array<const N: usize>(&mut self) -> [u8; N] {
        let (head, rest) = self.rest.split_at(N.min(self.rest.len()));
        self.rest = rest;
        head.try_into().unwrap_or([0; N])
    }

    numbers!(u8: u8, u16: u16, i16: i16, u32: u32, f32: f32, f64: f64);

    /// Three bytes, without sign.
    pub fn u24(&mut self) -> u32 {
        let [a, b, c] = self.array();
        u32::from_be_bytes([0, a, b, c])
    }

    /// Three bytes, two's complement.
    pub fn i24(&mut self) -> i32 {
        let [a, b, c] = self.array();
        i32::from_be_bytes([a, b, c, 0]) >> 8
    }

    pub fn triad(&mut self) -> [f32; 3] {
        [self.f32(), self.f32(), self.f32()]
    }

    pub fn skip(&mut self, bytes: usize) {
        self.rest = &self.rest[bytes.min(self.rest.len())..];
    }
}

/// Appends the low three bytes of a number.
pub(crate) fn put_i24(out: &mut Vec<u8>, value: i32) {
    out.extend_from_slice(&value.to_be_bytes()[1..]);
}

/// Appends three numbers.
pub(crate) fn put_triad(out: &mut Vec<u8>, values: [f32; 3]) {
    values.iter().for_each(|v| out.extend_from_slice(&v.to_be_bytes()));
}

/// The two letters that say which kind of equipment a sentence comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Talker([u8; 2]);

impl Talker {
    /// Integrated navigation, `IN`.
    pub const INTEGRATED: Self = Self(*b"IN");

    /// Two capital letters or digits that do not begin with `P`, which is kept for makers' own sentences.
    pub fn new(text: &str) -> Option<Self> {
        let letters: [u8; 2] = text.as_bytes().try_into().ok()?;
        let allowed = letters.iter().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit());
        (allowed && letters[0] != b'P').then_some(Self(letters))
    }

    /// The two letters.
    pub fn letters(self) -> [char; 2] {
        self.0.map(char::from)
    }
}

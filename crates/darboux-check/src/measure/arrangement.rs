//! How the channels of a normal map may be arranged.

/// How the channels of a map are arranged, as far as its derivatives tell: the facets decide between two
/// arrangements, one of which has the negated x and y of the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrangement {
    /// Green up; or red and green inverted.
    Same,
    /// Green down; or green up and red inverted.
    GreenInverted,
    /// Red and green exchanged; or also both inverted.
    Exchanged,
    /// Red and green exchanged and then the second channel inverted; or the first one.
    ExchangedAndInverted,
}

/// The number of arrangements.
pub const ARRANGEMENTS: usize = 4;

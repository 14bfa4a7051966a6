//! The encodings of the picture, from left to right.

/// The width and height of a plate in pixels.
pub const SIDE: usize = 96;

/// The encoding of the frame in a vertex of the plate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Four floats.
    Floats,
    /// Four 16-bit integers, which the vertex format decodes.
    Snorm16,
    /// Integers of 10, 10, 10 and 2 bits.
    Snorm10,
    /// Four bytes, which the vertex format decodes.
    Snorm8,
    /// Two 16-bit integers each for tangent and normal.
    Octahedral,
    /// 16 bits, with an octahedral normal.
    Diamond,
    /// Four 16-bit integers for normal and tangent.
    Quaternion,
}

impl Encoding {
    /// All encodings, in the order of the picture.
    pub const ALL: [Self; 7] = [
        Self::Floats,
        Self::Snorm16,
        Self::Snorm10,
        Self::Snorm8,
        Self::Octahedral,
        Self::Diamond,
        Self::Quaternion,
    ];
}

/// The pixels of a plate, row by row from the top: red, green, blue and 255.
pub type Plate = Vec<[u8; 4]>;

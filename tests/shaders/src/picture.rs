//! A picture of a normal-mapped plate for each encoding, by the CPU and by a GPU.
//!
//! The plate is two quads, the right one with mirrored UVs, seen straight on and one texel to a pixel. Its normals lean outwards, as
//! if it bulged, so interpolated vectors are shorter than 1.

mod cpu;
mod gpu;
mod plate;

pub use cpu::draw as draw_on_cpu;
pub use gpu::draw as draw_on_gpu;

/// Pixels along each side of a plate.
pub const SIDE: usize = 96;

/// How a vertex of the plate holds its frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Four floats.
    Floats,
    /// Four 16-bit integers, decoded by the fetch.
    Snorm16,
    /// 10, 10, 10 and 2 bits.
    Snorm10,
    /// Four bytes, decoded by the fetch.
    Snorm8,
    /// Two 16-bit integers; so has the normal.
    Octahedral,
    /// 16 bits, around an octahedral normal.
    Diamond,
    /// Four 16-bit integers for normal and tangent.
    Quaternion,
}

impl Encoding {
    /// All of them, as they come in the picture from left to right.
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

/// A plate's pixels, row by row from the top: red, green, blue and 255.
pub type Plate = Vec<[u8; 4]>;

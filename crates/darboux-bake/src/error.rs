//! [`BakeError`]: why a map was not baked.

use std::fmt;

use crate::limits::{MAX_SAMPLES_PER_AXIS, MAX_SIDE, MAX_TRIANGLES};
use crate::udim::Udim;

/// The error of [`bake`](crate::bake()) and of the surfaces that it takes. Degenerate geometry is no error:
/// the report counts it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BakeError {
    /// Arrays of a surface do not fit together, or the call was cancelled.
    Mesh(darboux::Error),
    /// A surface has other faces than triangles.
    NotTriangles,
    /// A cage has another number of positions than the low surface has vertices.
    Cage {
        /// The number of vertices.
        vertices: usize,
        /// The number of positions found.
        found: usize,
    },
    /// A map on a high surface has another number of UVs than the surface has vertices.
    Uvs {
        /// The number of vertices.
        vertices: usize,
        /// The number of UVs found.
        found: usize,
    },
    /// A side of the image is 0 or too large.
    Size {
        /// Texels per row, and rows.
        size: [u32; 2],
    },
    /// The number of samples per axis is 0 or too large.
    Samples {
        /// The number found.
        found: u32,
    },
    /// A distance is negative or not finite, or both are zero.
    Distance {
        /// The distances found.
        found: [f32; 2],
    },
    /// Another number of the options is out of range.
    Option {
        /// What the number is.
        what: &'static str,
        /// What it must be.
        expected: &'static str,
        /// The number found.
        found: f32,
    },
    /// The set of maps is empty.
    NoMaps,
    /// The map texture was chosen without the place of a texture, or the place without the map.
    Texture {
        /// Whether the map was chosen.
        is_chosen: bool,
    },
    /// A map has another number of texels than its size says, or none.
    Texels {
        /// The number of texels of its size.
        expected: usize,
        /// The number found.
        found: usize,
    },
    /// Charts lie where no UDIM tile is.
    NoUdim {
        /// The tile to the right of the first and above it, in tiles.
        tile: [i32; 2],
    },
    /// The low surfaces have no triangle.
    NoLowTriangles,
    /// The high surfaces have no triangle.
    NoHighTriangles,
    /// More triangles than 32-bit numbers can count, with room for marks.
    TooManyTriangles {
        /// The number of triangles.
        found: u64,
    },
    /// The run needs more memory than the limit, or than the system has.
    Memory {
        /// The bytes that the run needs.
        needed: u64,
        /// The limit in bytes; none if the system refused the memory.
        limit: Option<u64>,
    },
}

impl From<darboux::Error> for BakeError {
    fn from(error: darboux::Error) -> Self {
        Self::Mesh(error)
    }
}

impl fmt::Display for BakeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Mesh(error) => error.fmt(f),
            Self::NotTriangles => f.write_str("the surface has faces that are not triangles; triangulate it"),
            Self::Cage { vertices, found } => write!(
                f,
                "the cage has {found} vertices but the low surface has {vertices}; make the cage by moving \
                 the vertices of the low surface only"
            ),
            Self::Uvs { vertices, found } => write!(
                f,
                "the map has {found} UVs but the high surface has {vertices} vertices; pass one per vertex"
            ),
            Self::Size { size: [width, height] } => {
                write!(
                    f,
                    "an image of {width} x {height} texels cannot be made; its sides can have 1 to {MAX_SIDE}"
                )
            }
            Self::Samples { found } => {
                write!(f, "{found} samples per axis cannot be taken; choose 1 to {MAX_SAMPLES_PER_AXIS}")
            }
            Self::Distance { found: [outwards, inwards] } => write!(
                f,
                "rays cannot begin {outwards} outside the low surface and end {inwards} inside it; give two \
                 finite distances of which none is negative and one is positive"
            ),
            Self::Option { what, expected, found } => write!(f, "{what} is {found}; it must be {expected}"),
            Self::NoMaps => f.write_str("no map was chosen; choose at least one"),
            Self::Texture { is_chosen: true } => f.write_str(
                "the map texture needs the option texture: the place of a texture in the high models' \
                 materials, such as occlusionTexture",
            ),
            Self::Texture { is_chosen: false } => f.write_str(
                "the option texture is for the map texture, which was not chosen; add it to the maps",
            ),
            Self::Texels { expected, found } => write!(
                f,
                "the map has {found} texels but its size needs {expected}; give one vector per texel, and at \
                 least one"
            ),
            Self::NoUdim { tile: [column, row] } => write!(
                f,
                "charts lie in the tile {column} to the right of the first and {row} above it, which has no \
                 UDIM number; move them to columns 0 to 9 and rows 0 to {}",
                Udim::ROWS - 1
            ),
            Self::NoLowTriangles => {
                f.write_str("the low model has no triangles; check that it was exported with its meshes")
            }
            Self::NoHighTriangles => {
                f.write_str("the high model has no triangles; check that it was exported with its meshes")
            }
            Self::TooManyTriangles { found } => {
                write!(f, "{found} triangles are too many: the limit is {MAX_TRIANGLES}; split the model")
            }
            Self::Memory { needed, limit: Some(limit) } => write!(
                f,
                "the run needs {} MiB of memory, which is more than the limit of {} MiB; choose a smaller \
                 size or fewer maps, or raise the limit",
                mebibytes(needed),
                mebibytes(limit)
            ),
            Self::Memory { needed, limit: None } => write!(
                f,
                "the run needs {} MiB of memory, which the system refuses; choose a smaller size or fewer \
                 maps",
                mebibytes(needed)
            ),
        }
    }
}

fn mebibytes(bytes: u64) -> u64 {
    bytes.div_ceil(1 << 20)
}

impl std::error::Error for BakeError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Mesh(error) => Some(error),
            _ => None,
        }
    }
}

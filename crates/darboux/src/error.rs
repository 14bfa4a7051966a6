//! [`Error`]: what was wrong with the arguments of a call, or that the call was cancelled.

use std::fmt;

/// The error of every function of this crate that can fail, but for the text of conventions
/// ([`ConventionError`](crate::ConventionError)).
///
/// Arrays do not fit together, or the call was cancelled. Degenerate or non-finite values are not errors:
/// reports count them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// Two per-vertex arrays have different lengths.
    LengthMismatch {
        /// Which array.
        what: &'static str,
        /// The number of positions.
        expected: usize,
        /// The length found.
        found: usize,
    },
    /// An index is not below the number of vertices.
    IndexOutOfRange {
        /// Its place in the index list.
        at: usize,
        /// Its value.
        index: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// The corners do not make whole faces.
    PartialFace {
        /// The number of corners.
        corners: usize,
        /// Corners per face.
        size: usize,
    },
    /// The sizes of mixed faces do not add up to the number of corners.
    FaceSizes {
        /// Their sum.
        sum: u64,
        /// The number of corners.
        corners: usize,
    },
    /// A stride is smaller than the element it steps over.
    StrideTooSmall {
        /// The stride, in floats or bytes as given.
        stride: usize,
        /// The smallest that works.
        needed: usize,
    },
    /// A packed array ends within an element.
    PartialElement {
        /// Its length, in floats or bytes as given.
        len: usize,
        /// Components per element.
        components: usize,
    },
    /// More corners than 32-bit ids can hold.
    TooManyCorners {
        /// The number of corners.
        corners: usize,
        /// The largest number that works.
        limit: usize,
    },
    /// More vertices than 32-bit ids can hold.
    TooManyVertices {
        /// The number of vertices.
        vertices: usize,
        /// The largest number that works.
        limit: usize,
    },
    /// An input array, such as tangents to split, has another length than one element per corner.
    InputLength {
        /// What the array holds: "tangents", "normals" or "frames".
        what: &'static str,
        /// The number of corners.
        expected: usize,
        /// The length found.
        found: usize,
    },
    /// An output array has another length than one element per corner.
    OutputLength {
        /// What the array receives: "tangents", "frames", "bitangents" or "magnitudes".
        what: &'static str,
        /// The number of corners.
        expected: usize,
        /// The length found.
        found: usize,
    },
    /// A plan or a splitter was made for a mesh of another size.
    OtherMesh {
        /// What is counted: "corners" or "vertices".
        what: &'static str,
        /// The number in the mesh of the plan or the splitter.
        expected: usize,
        /// The number in the mesh that was passed.
        found: usize,
    },
    /// The texels do not fill the image.
    ImageSize {
        /// The width of the image.
        width: usize,
        /// The height of the image.
        height: usize,
        /// The number of texels found.
        found: usize,
    },
    /// The token of the context was cancelled.
    Cancelled,
}

impl Error {
    /// Errors: an input array that has not one element per corner.
    pub(crate) fn check_input(what: &'static str, expected: usize, found: usize) -> Result<(), Self> {
        if expected == found { Ok(()) } else { Err(Self::InputLength { what, expected, found }) }
    }

    /// Errors: an output array that has not one element per corner.
    pub(crate) fn check_output(what: &'static str, expected: usize, found: usize) -> Result<(), Self> {
        if expected == found { Ok(()) } else { Err(Self::OutputLength { what, expected, found }) }
    }

    /// Errors: a mesh of another size than the one that a plan or a splitter was made for.
    pub(crate) fn check_mesh(what: &'static str, expected: usize, found: usize) -> Result<(), Self> {
        if expected == found { Ok(()) } else { Err(Self::OtherMesh { what, expected, found }) }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Error::LengthMismatch { what, expected, found } => write!(
                f,
                "{what} has {found} elements but there are {expected} positions; give one per vertex"
            ),
            Error::IndexOutOfRange { at, index, vertices } => {
                write!(f, "index {index} at place {at} is out of range: there are {vertices} vertices")
            }
            Error::PartialFace { corners, size } => {
                write!(f, "{corners} corners do not make whole faces of {size}")
            }
            Error::FaceSizes { sum, corners } => {
                write!(f, "the face sizes add up to {sum} but there are {corners} corners")
            }
            Error::StrideTooSmall { stride, needed } => {
                write!(f, "a stride of {stride} is too small: an element needs {needed}")
            }
            Error::PartialElement { len, components } => {
                write!(f, "a length of {len} is not a whole number of {components}-component elements")
            }
            Error::TooManyCorners { corners, limit } => {
                write!(f, "{corners} corners are too many: the limit is {limit}; split the mesh")
            }
            Error::TooManyVertices { vertices, limit } => {
                write!(f, "{vertices} vertices are too many: the limit is {limit}; split the mesh")
            }
            Error::InputLength { what, expected, found } => {
                write!(
                    f,
                    "{found} {what} were passed but the mesh has {expected} corners; pass one per corner"
                )
            }
            Error::OutputLength { what, expected, found } => write!(
                f,
                "the output array of {what} has {found} elements but the mesh has {expected} corners; make \
                 it as long as the corners"
            ),
            Error::OtherMesh { what, expected, found } => write!(
                f,
                "the mesh has {found} {what} but this plan or splitter was made for {expected}; make a new \
                 one for this mesh"
            ),
            Error::ImageSize { width, height, found } => {
                write!(f, "{found} texels were passed but the image has {width} x {height}; pass all of them")
            }
            Error::Cancelled => f.write_str("the call was cancelled; its output is incomplete"),
        }
    }
}

impl std::error::Error for Error {}

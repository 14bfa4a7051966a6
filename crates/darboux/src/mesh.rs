//! The borrowed mesh: strided vertex data, indices, faces. The constructors validate a mesh; all other code
//! relies on that.

use std::ops::Range;

use crate::Error;

/// `N` floats per vertex, borrowed from any layout: packed arrays, an interleaved vertex buffer, raw bytes.
///
/// Any `&[[f32; N]]`, `&[[f32; N]; M]` or `&Vec<[f32; N]>` converts into it. Values may be anything, NaN and
/// infinity included.
#[derive(Clone, Copy, Debug)]
pub struct Strided<'a, const N: usize> {
    source: Source<'a>,
    len: usize,
    stride: usize,
    offset: usize,
}

#[derive(Clone, Copy, Debug)]
enum Source<'a> {
    Floats(&'a [f32]),
    Bytes(&'a [u8]),
}

impl<'a, const N: usize> Strided<'a, N> {
    /// Reads `N` floats from every `stride` floats of `data`, the first at `offset`.
    ///
    /// `stride` and `offset` count floats. The length is the number of whole elements that fit. Errors: a
    /// stride below `N`; for packed data (`stride == N`), floats left over at the end.
    pub fn from_floats(data: &'a [f32], stride: usize, offset: usize) -> Result<Self, Error> {
        let len = count(data.len(), stride, offset, N, N)?;
        Ok(Self { source: Source::Floats(data), len, stride, offset })
    }

    /// Reads `N` floats in native byte order from every `stride` bytes of `data`, the first at `offset`.
    ///
    /// `stride` and `offset` count bytes and need no alignment. Errors as for [`Strided::from_floats`].
    pub fn from_bytes(data: &'a [u8], stride: usize, offset: usize) -> Result<Self, Error> {
        let len = count(data.len(), stride, offset, N * 4, N)?;
        Ok(Self { source: Source::Bytes(data), len, stride, offset })
    }

    /// `element` for each of `len` vertices: normals of a mesh that has none are zeros.
    pub fn repeated(element: &'a [f32; N], len: usize) -> Self {
        Self { source: Source::Floats(element), len, stride: 0, offset: 0 }
    }

    /// The number of elements.
    pub fn len(&self) -> usize {
        self.len
    }

    /// True when there are no elements.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The elements, where they lie one after the other.
    #[inline]
    pub(crate) fn packed(&self) -> Option<&'a [[f32; N]]> {
        match self.source {
            Source::Floats(data) if self.stride == N && self.len > 0 => {
                Some(data[self.offset..].as_chunks().0)
            }
            _ => None,
        }
    }

    /// The element at `index`. Panics when `index` is not below [`Strided::len`].
    #[inline]
    pub fn get(&self, index: usize) -> [f32; N] {
        let start = self.offset + index * self.stride;
        match self.source {
            Source::Floats(data) => {
                let element = &data[start..start + N];
                std::array::from_fn(|i| element[i])
            }
            Source::Bytes(data) => {
                let element = &data[start..start + 4 * N];
                std::array::from_fn(|i| {
                    let bytes = &element[4 * i..4 * i + 4];
                    f32::from_ne_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
                })
            }
        }
    }
}

/// How many elements of `size` units fit, `stride` units apart, from `offset` on.
fn count(len: usize, stride: usize, offset: usize, size: usize, components: usize) -> Result<usize, Error> {
    if stride < size {
        return Err(Error::StrideTooSmall { stride, needed: size });
    }
    let room = len.saturating_sub(offset);
    if stride == size && !room.is_multiple_of(size) {
        return Err(Error::PartialElement { len: room, components });
    }
    Ok(if room < size { 0 } else { (room - size) / stride + 1 })
}

impl<'a, const N: usize> From<&'a [[f32; N]]> for Strided<'a, N> {
    fn from(data: &'a [[f32; N]]) -> Self {
        Self { source: Source::Floats(data.as_flattened()), len: data.len(), stride: N, offset: 0 }
    }
}

impl<'a, const N: usize, const M: usize> From<&'a [[f32; N]; M]> for Strided<'a, N> {
    fn from(data: &'a [[f32; N]; M]) -> Self {
        data.as_slice().into()
    }
}

impl<'a, const N: usize> From<&'a Vec<[f32; N]>> for Strided<'a, N> {
    fn from(data: &'a Vec<[f32; N]>) -> Self {
        data.as_slice().into()
    }
}

/// Which vertex each corner uses.
#[derive(Clone, Copy, Debug, Default)]
pub enum Indices<'a> {
    /// Corner i is vertex i.
    #[default]
    Unindexed,
    /// 16-bit indices.
    U16(&'a [u16]),
    /// 32-bit indices.
    U32(&'a [u32]),
}

impl Indices<'_> {
    /// The number of corners of a mesh with `vertex_count` vertices.
    pub(crate) fn corner_count(&self, vertex_count: usize) -> usize {
        match self {
            Self::Unindexed => vertex_count,
            Self::U16(list) => list.len(),
            Self::U32(list) => list.len(),
        }
    }
}

macro_rules! indices_from {
    ($($source:ty, $variant:ident, $index:ty, [$($generic:tt)*]);* $(;)?) => {$(
        impl<'a, $($generic)*> From<$source> for Indices<'a> {
            fn from(data: $source) -> Self {
                Indices::$variant(data as &'a [$index])
            }
        }
    )*};
}

indices_from! {
    &'a [u16], U16, u16, [];
    &'a [u32], U32, u32, [];
    &'a [u16; M], U16, u16, [const M: usize];
    &'a [u32; M], U32, u32, [const M: usize];
    &'a Vec<u16>, U16, u16, [];
    &'a Vec<u32>, U32, u32, [];
}

/// How corners make faces.
#[derive(Clone, Copy, Debug)]
pub enum Faces<'a> {
    /// Three corners each.
    Triangles,
    /// Four corners each.
    Quads,
    /// The corner count of each face. Faces of other than 3 or 4 corners are allowed, but MikkTSpace does not
    /// define them: they are counted as unsupported.
    Mixed(&'a [u32]),
}

/// A mesh, borrowed: positions, normals and UVs per vertex, indices and faces over them.
///
/// A *corner* is a vertex of one face; corners are numbered face after face, in the order of the index list.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    positions: Strided<'a, 3>,
    normals: Strided<'a, 3>,
    uvs: Strided<'a, 2>,
    indices: Indices<'a>,
    faces: Faces<'a>,
    corner_count: usize,
}

/// The largest number of corners, and of vertices: ids of corners, half-edges and vertices stay within 32
/// bits, with room for marks.
pub(crate) const MAX_CORNERS: usize = (1 << 30) - 1;
const MAX_VERTICES: usize = MAX_CORNERS;

impl<'a> Mesh<'a> {
    /// A triangle mesh.
    ///
    /// `positions`, `normals`: V by 3; `uvs`: V by 2, any values; `indices`: 3 per triangle, or
    /// [`Indices::Unindexed`] where every three vertices are a triangle. Normals are used as given
    /// (MikkTSpace expects unit length). Errors: lengths that differ, an index out of range, corners that
    /// are not whole triangles, more than 2^30 - 1 corners.
    pub fn triangles(
        positions: impl Into<Strided<'a, 3>>,
        normals: impl Into<Strided<'a, 3>>,
        uvs: impl Into<Strided<'a, 2>>,
        indices: impl Into<Indices<'a>>,
    ) -> Result<Self, Error> {
        Self::new(positions.into(), normals.into(), uvs.into(), indices.into(), Faces::Triangles)
    }

    /// A mesh of quads, or of mixed faces. As [`Mesh::triangles`], with the corners per face given by
    /// `faces`.
    ///
    /// Further error: face sizes whose sum is not the number of corners.
    pub fn with_faces(
        positions: impl Into<Strided<'a, 3>>,
        normals: impl Into<Strided<'a, 3>>,
        uvs: impl Into<Strided<'a, 2>>,
        indices: impl Into<Indices<'a>>,
        faces: Faces<'a>,
    ) -> Result<Self, Error> {
        Self::new(positions.into(), normals.into(), uvs.into(), indices.into(), faces)
    }

    fn new(
        positions: Strided<'a, 3>,
        normals: Strided<'a, 3>,
        uvs: Strided<'a, 2>,
        indices: Indices<'a>,
        faces: Faces<'a>,
    ) -> Result<Self, Error> {
        let vertices = positions.len();
        for (what, found) in [("normals", normals.len()), ("uvs", uvs.len())] {
            if found != vertices {
                return Err(Error::LengthMismatch { what, expected: vertices, found });
            }
        }
        let corner_count = indices.corner_count(vertices);
        if corner_count > MAX_CORNERS {
            return Err(Error::TooManyCorners { corners: corner_count, limit: MAX_CORNERS });
        }
        if vertices > MAX_VERTICES {
            return Err(Error::TooManyVertices { vertices, limit: MAX_VERTICES });
        }
        // Only now, so that no list beyond the limit is read.
        match indices {
            Indices::Unindexed => {}
            Indices::U16(list) => check_range(list, vertices)?,
            Indices::U32(list) => check_range(list, vertices)?,
        }
        let mesh = Self { positions, normals, uvs, indices, faces, corner_count };
        mesh.check_faces()?;
        Ok(mesh)
    }

    /// Other faces over the same vertices. The caller guarantees that `indices` are in range and make whole
    /// faces.
    pub(crate) fn with_other_faces<'b>(&self, indices: Indices<'b>, faces: Faces<'b>) -> Mesh<'b>
    where
        'a: 'b,
    {
        Mesh { indices, faces, corner_count: indices.corner_count(self.vertex_count()), ..*self }
    }

    fn check_faces(&self) -> Result<(), Error> {
        let corners = self.corner_count;
        let size = match self.faces {
            Faces::Triangles => 3,
            Faces::Quads => 4,
            Faces::Mixed(sizes) => {
                let sum: u64 = sizes.iter().map(|&size| u64::from(size)).sum();
                return if sum == corners as u64 { Ok(()) } else { Err(Error::FaceSizes { sum, corners }) };
            }
        };
        if corners.is_multiple_of(size) { Ok(()) } else { Err(Error::PartialFace { corners, size }) }
    }

    /// The number of vertices, used or not.
    pub fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// The number of corners: the length of the index list.
    pub fn corner_count(&self) -> usize {
        self.corner_count
    }

    /// The number of faces.
    pub fn face_count(&self) -> usize {
        match self.faces {
            Faces::Triangles => self.corner_count / 3,
            Faces::Quads => self.corner_count / 4,
            Faces::Mixed(sizes) => sizes.len(),
        }
    }

    /// The corners of every face, in order.
    pub(crate) fn face_ranges(&self) -> impl Iterator<Item = Range<usize>> + use<'a> {
        let (faces, mut end) = (self.faces, 0);
        (0..self.face_count()).map(move |face| {
            let start = end;
            end += match faces {
                Faces::Triangles => 3,
                Faces::Quads => 4,
                Faces::Mixed(sizes) => sizes[face] as usize,
            };
            start..end
        })
    }

    /// How corners make faces.
    pub fn faces(&self) -> Faces<'a> {
        self.faces
    }

    /// Which vertex each corner uses.
    pub fn indices(&self) -> Indices<'a> {
        self.indices
    }

    /// The vertex that `corner` uses. Panics when `corner` is out of range.
    #[inline]
    pub fn vertex_of_corner(&self, corner: usize) -> usize {
        match self.indices {
            Indices::Unindexed => corner,
            Indices::U16(list) => list[corner] as usize,
            Indices::U32(list) => list[corner] as usize,
        }
    }

    /// Positions, V by 3.
    pub fn positions(&self) -> Strided<'a, 3> {
        self.positions
    }

    /// Normals, V by 3.
    pub fn normals(&self) -> Strided<'a, 3> {
        self.normals
    }

    /// UVs, V by 2.
    pub fn uvs(&self) -> Strided<'a, 2> {
        self.uvs
    }
}

/// Errors: an index that is not below `vertices`.
fn check_range<I: Copy + Into<u32>>(list: &[I], vertices: usize) -> Result<(), Error> {
    // The largest index is found without a branch per index.
    let largest = list.iter().fold(0, |largest, &index| index.into().max(largest));
    if list.is_empty() || (largest as usize) < vertices {
        return Ok(());
    }
    let is_outside = |&&index: &&I| index.into() as usize >= vertices;
    let (at, &index) = list.iter().enumerate().find(|(_, index)| is_outside(index)).expect("the largest");
    Err(Error::IndexOutOfRange { at, index: index.into(), vertices })
}

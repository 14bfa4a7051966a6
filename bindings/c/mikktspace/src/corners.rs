//! Reads the mesh of the callbacks into arrays, and merges most corners with equal bits into one vertex.

use std::ffi::c_int;

use darboux::{Faces, Indices, Mesh, Strided};

use crate::callbacks::Caller;

/// The corners of all faces with 3 or 4 corners, in order, as an indexed mesh.
pub(crate) struct Corners {
    /// The position, normal and UV of each vertex.
    vertices: Vec<[f32; 8]>,
    vertex_of_corner: Vec<u32>,
    /// The corner count of each face; 0 for faces with other than 3 or 4 corners.
    size_of_face: Vec<u8>,
    kind: Kind,
    /// The number of extra corners at the start of the mesh: 1 where face 0 has other than 3 or 4 corners,
    /// else 0.
    skipped: usize,
}

/// The kind of the mesh's faces.
enum Kind {
    Triangles,
    Quads,
    /// The corner count of each face of the mesh.
    Mixed(Vec<u32>),
}

impl Corners {
    /// Reads the mesh. `None` where no face has 3 or 4 corners, or memory runs out.
    pub fn read(caller: &Caller) -> Option<Self> {
        let size_of_face = read_sizes(caller)?;
        let is_first_undefined = *size_of_face.first()? == 0;
        let kind = Kind::new(&size_of_face, is_first_undefined)?;
        let skipped = usize::from(is_first_undefined);
        let count = skipped + size_of_face.iter().map(|&size| usize::from(size)).sum::<usize>();
        let mut reader = Reader::new(count)?;
        if is_first_undefined {
            // The reference's bounding box starts at corner 0 of face 0, even where the face is skipped.
            reader.add(&[caller.first_vertex()]);
        }
        reader.read(caller, &size_of_face);
        let Reader { vertices, vertex_of_corner, .. } = reader;
        Some(Self { vertices, vertex_of_corner, size_of_face, kind, skipped })
    }

    /// The mesh of these corners. `None` where there are too many.
    pub fn mesh(&self) -> Option<Mesh<'_>> {
        let faces = match &self.kind {
            Kind::Triangles => Faces::Triangles,
            Kind::Quads => Faces::Quads,
            Kind::Mixed(sizes) => Faces::Mixed(sizes),
        };
        let floats = self.vertices.as_flattened();
        let positions = Strided::from_floats(floats, 8, 0).ok()?;
        let normals = Strided::from_floats(floats, 8, 3).ok()?;
        let uvs = Strided::from_floats(floats, 8, 6).ok()?;
        Mesh::with_faces(positions, normals, uvs, Indices::U32(&self.vertex_of_corner), faces).ok()
    }

    /// Passes the result of every corner to `write`, with the face and the corner's number in the face.
    ///
    /// `read(first, block)` fills `block` with the results of consecutive corners of the mesh, the first of
    /// them `first`. `None` where `read` returns `None`.
    pub fn hand_out<T: Copy + Default>(
        &self,
        read: impl Fn(usize, &mut [T]) -> Option<()>,
        write: impl Fn(c_int, c_int, &T),
    ) -> Option<()> {
        let mut block = [T::default(); BLOCK];
        let mut at = 0;
        for (face, &size) in (0..).zip(&self.size_of_face) {
            for corner in 0..c_int::from(size) {
                if at % BLOCK == 0 {
                    let first = self.skipped + at;
                    let count = (self.vertex_of_corner.len() - first).min(BLOCK);
                    read(first, &mut block[..count])?;
                }
                write(face, corner, &block[at % BLOCK]);
                at += 1;
            }
        }
        Some(())
    }
}

/// Reads the corner count of every face. `None` where memory runs out.
fn read_sizes(caller: &Caller) -> Option<Vec<u8>> {
    let faces = caller.face_count();
    let mut sizes = Vec::new();
    sizes.try_reserve_exact(usize::try_from(faces).ok()?).ok()?;
    let size = |face| match caller.face_size(face) {
        size @ 3..=4 => size as u8,
        _ => 0,
    };
    sizes.extend((0..faces).map(size));
    Some(sizes)
}

impl Kind {
    /// `None` where no face has 3 or 4 corners, or memory runs out.
    fn new(size_of_face: &[u8], is_first_undefined: bool) -> Option<Self> {
        match (size_of_face.contains(&3), size_of_face.contains(&4)) {
            (false, false) => None,
            (true, false) if !is_first_undefined => Some(Self::Triangles),
            (false, true) if !is_first_undefined => Some(Self::Quads),
            _ => {
                let mut sizes = Vec::new();
                sizes.try_reserve_exact(size_of_face.len()).ok()?;
                sizes.extend(is_first_undefined.then_some(1));
                sizes.extend(size_of_face.iter().filter(|&&size| size > 0).map(|&size| u32::from(size)));
                Some(Self::Mixed(sizes))
            }
        }
    }
}

/// The number of corners per block: blocks are read before they are merged, and computed before they are
/// written.
const BLOCK: usize = 64;

/// Merges most corners with equal bits into one vertex. The core needs more time for separate vertices than
/// the merging takes.
struct Reader {
    vertices: Vec<[f32; 8]>,
    vertex_of_corner: Vec<u32>,
    /// A cache of the last two vertices per hash slot, the last one first. An entry is the upper half of the
    /// hash and the vertex, so that a vertex is compared only where the upper halves match. A corner
    /// whose vertex was evicted becomes a new vertex.
    pairs: Vec<[u64; 2]>,
}

impl Reader {
    /// `None` where there is no memory for `count` corners.
    fn new(count: usize) -> Option<Self> {
        let pair_count = (count / 8).next_power_of_two().clamp(1 << 3, 1 << 14);
        let (mut vertices, mut vertex_of_corner, mut pairs) = (Vec::new(), Vec::new(), Vec::new());
        // Reserved for the worst case, in which every corner is a vertex of its own. Unused pages cost
        // nothing.
        vertices.try_reserve_exact(count).ok()?;
        vertex_of_corner.try_reserve_exact(count).ok()?;
        pairs.try_reserve_exact(pair_count).ok()?;
        pairs.resize(pair_count, [u64::MAX; 2]);
        Some(Self { vertices, vertex_of_corner, pairs })
    }

    /// Reads all corners in blocks: loading bytes in wide parts stalls directly after a callback has stored
    /// them in narrow parts.
    fn read(&mut self, caller: &Caller, size_of_face: &[u8]) {
        let mut block = [[0.0; 8]; BLOCK + 3];
        let mut filled = 0;
        for (face, &size) in (0..).zip(size_of_face) {
            for corner in 0..size {
                caller.read_vertex(face, c_int::from(corner), &mut block[filled]);
                filled += 1;
            }
            if filled >= BLOCK {
                self.add(&block[..filled]);
                filled = 0;
            }
        }
        self.add(&block[..filled]);
    }

    /// Appends corners to the index list, and new vertices to the vertices.
    fn add(&mut self, corners: &[[f32; 8]]) {
        let mask = self.pairs.len() - 1;
        let vertex = |corner: &[f32; 8]| {
            let bits = corner.map(f32::to_bits);
            let hash = hash(bits);
            let pair = &mut self.pairs[hash as usize & mask];
            let is_it = |entry: u64| {
                let known = || self.vertices.get(entry as u32 as usize);
                (entry ^ hash) >> 32 == 0 && known().is_some_and(|known| known.map(f32::to_bits) == bits)
            };
            if let Some(&entry) = pair.iter().find(|&&entry| is_it(entry)) {
                return entry as u32;
            }
            let vertex = self.vertices.len() as u32;
            *pair = [hash >> 32 << 32 | u64::from(vertex), pair[0]];
            self.vertices.push(*corner);
            vertex
        };
        self.vertex_of_corner.extend(corners.iter().map(vertex));
    }
}

/// Hashes the bits of a corner: two 128-bit products, whose halves are combined by exclusive or.
fn hash([x, y, z, nx, ny, nz, u, v]: [u32; 8]) -> u64 {
    let pair = |low, high, seed| (u64::from(high) << 32 | u64::from(low)) ^ seed;
    let product = |a, b| u128::from(a) * u128::from(b);
    let products = product(pair(x, y, 0x9e37_79b9_7f4a_7c15), pair(z, nx, 0xbf58_476d_1ce4_e5b9))
        ^ product(pair(ny, nz, 0x94d0_49bb_1331_11eb), pair(u, v, 0xd6e8_feb8_6659_fd93));
    (products >> 64) as u64 ^ products as u64
}

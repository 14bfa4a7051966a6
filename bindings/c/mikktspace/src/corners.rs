//! What the callbacks know of the mesh, in arrays.

use std::ffi::c_int;

use darboux::{Faces, Indices, Mesh};

use crate::callbacks::Caller;

/// The corners of the faces of 3 or 4, in order, each a vertex of its own.
#[derive(Default)]
pub(crate) struct Corners {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    /// How many corners each face has, 0 for those that MikkTSpace does not define.
    size_of_face: Vec<u8>,
    kind: Kind,
    /// 1 where a vertex without an answer comes first.
    pub skipped: usize,
}

/// Which faces there are.
#[derive(Default)]
enum Kind {
    #[default]
    Triangles,
    Quads,
    /// The sizes of the faces that the mesh has.
    Mixed(Vec<u32>),
}

impl Corners {
    /// None without a face of 3 or 4 corners, or without memory.
    pub fn read(caller: &Caller) -> Option<Self> {
        let mut corners = Self::default();
        corners.read_sizes(caller)?;
        corners.choose_kind()?;
        let count = corners.size_of_face.iter().map(|&size| usize::from(size)).sum::<usize>() + 1;
        corners.positions.try_reserve_exact(count).ok()?;
        corners.normals.try_reserve_exact(count).ok()?;
        corners.uvs.try_reserve_exact(count).ok()?;
        corners.read_corners(caller);
        Some(corners)
    }

    fn read_sizes(&mut self, caller: &Caller) -> Option<()> {
        let faces = caller.face_count();
        self.size_of_face.try_reserve_exact(usize::try_from(faces).ok()?).ok()?;
        let size = |face| match caller.face_size(face) {
            size @ 3..=4 => size as u8,
            _ => 0,
        };
        self.size_of_face.extend((0..faces).map(size));
        Some(())
    }

    fn choose_kind(&mut self) -> Option<()> {
        let has = |size| self.size_of_face.contains(&size);
        let (is_first_undefined, has_triangles, has_quads) = (!self.has_first_face(), has(3), has(4));
        self.kind = match (has_triangles, has_quads) {
            (false, false) => return None,
            (true, false) if !is_first_undefined => Kind::Triangles,
            (false, true) if !is_first_undefined => Kind::Quads,
            _ => {
                let mut sizes = Vec::new();
                sizes.try_reserve_exact(self.size_of_face.len()).ok()?;
                sizes.extend(is_first_undefined.then_some(1));
                sizes.extend(self.size_of_face.iter().filter(|&&size| size > 0).map(|&size| u32::from(size)));
                Kind::Mixed(sizes)
            }
        };
        Some(())
    }

    /// Whether MikkTSpace defines face 0.
    fn has_first_face(&self) -> bool {
        self.size_of_face.first().is_some_and(|&size| size > 0)
    }

    /// Reads every corner that counts, and the position of the very first even if it does not: the reference's bounds begin there.
    fn read_corners(&mut self, caller: &Caller) {
        if !self.has_first_face() {
            self.skipped = 1;
            self.positions.push(caller.position(0, 0));
            self.normals.push([0.0; 3]);
            self.uvs.push([0.0; 2]);
        }
        for (face, &size) in (0..).zip(&self.size_of_face) {
            for corner in 0..c_int::from(size) {
                self.positions.push(caller.position(face, corner));
                self.normals.push(caller.normal(face, corner));
                self.uvs.push(caller.uv(face, corner));
            }
        }
    }

    /// The mesh of these corners; none where it has too many.
    pub fn mesh(&self) -> Option<Mesh<'_>> {
        let faces = match &self.kind {
            Kind::Triangles => Faces::Triangles,
            Kind::Quads => Faces::Quads,
            Kind::Mixed(sizes) => Faces::Mixed(sizes),
        };
        Mesh::with_faces(&self.positions, &self.normals, &self.uvs, Indices::Unindexed, faces).ok()
    }

    /// The face and the place in it of every corner but those skipped, in order.
    pub fn places(&self) -> impl Iterator<Item = (c_int, c_int)> {
        let faces = (0..).zip(&self.size_of_face);
        faces.flat_map(|(face, &size)| (0..c_int::from(size)).map(move |corner| (face, corner)))
    }
}

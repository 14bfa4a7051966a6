//! The faces of a primitive that was cut from quads: MikkTSpace takes quads as they were, and its tangents go
//! to the corners of their halves.

use crate::gltf::{Document, IndexList, PrimitiveName};

/// Triangles and quads, and where the corners of the triangles are among theirs.
#[derive(Debug)]
pub struct QuadFaces {
    /// The vertices of all corners, face after face.
    pub vertices: Vec<u32>,
    /// The number of corners of each face.
    pub sizes: Vec<u32>,
    /// The corner of a face for each corner of a triangle.
    corners: Vec<u32>,
}

impl QuadFaces {
    /// The faces of a primitive. `triangles`: the vertices of its triangles now. None: no face was a quad, or
    /// the triangles are others than when the document was read.
    pub fn of(document: &Document, name: &PrimitiveName, triangles: &IndexList<'_>) -> Option<Self> {
        let source = document.provenance()?.primitive(name.mesh, name.primitive)?;
        if source.quads.is_empty() || 3 * source.triangles != triangles.len() {
            return None;
        }
        let list: Vec<u32> = triangles.iter().collect();
        let triangles = list.as_chunks::<3>().0;
        let mut faces = Self {
            vertices: Vec::with_capacity(list.len()),
            sizes: Vec::with_capacity(triangles.len()),
            corners: Vec::with_capacity(list.len()),
        };
        let mut quads = source.quads.iter().peekable();
        let mut at = 0;
        while let Some(&first) = triangles.get(at) {
            if quads.next_if(|&&quad| quad as usize == at).is_some() {
                faces.add_quad(first, *triangles.get(at + 1)?)?;
                at += 2;
            } else {
                faces.add(&first, &[0, 1, 2]);
                at += 1;
            }
        }
        Some(faces)
    }

    /// Adds the quad of two halves, in the order in which MikkTSpace has them. None: they are no halves in
    /// that order.
    fn add_quad(&mut self, [a, b, c]: [u32; 3], [d, e, f]: [u32; 3]) -> Option<()> {
        if (a, c) == (d, e) {
            self.add(&[a, b, c, f], &[0, 1, 2, 0, 2, 3]);
        } else if (b, c) == (d, f) {
            self.add(&[a, b, e, c], &[0, 1, 3, 1, 2, 3]);
        } else {
            return None;
        }
        Some(())
    }

    fn add(&mut self, vertices: &[u32], corners: &[u32]) {
        let first = self.vertices.len() as u32;
        self.corners.extend(corners.iter().map(|corner| first + corner));
        self.vertices.extend_from_slice(vertices);
        self.sizes.push(vertices.len() as u32);
    }

    /// The values of the corners of triangles, from the values of the corners of faces.
    pub fn of_triangles<T: Copy>(&self, of_faces: &[T]) -> Vec<T> {
        self.corners.iter().map(|&corner| of_faces[corner as usize]).collect()
    }
}

//! A mesh that owns its arrays, and its text form.

use darboux::{Faces, Indices, Mesh};

/// The corner counts of the faces of an [`OwnedMesh`].
#[derive(Clone, Debug, Default, PartialEq)]
pub enum FaceSizes {
    /// Three corners each.
    #[default]
    Triangles,
    /// Four corners each.
    Quads,
    /// The corner count of each face.
    Mixed(Vec<u32>),
}

impl FaceSizes {
    /// The simplest form of a list of corner counts.
    pub fn from_list(sizes: &[u32]) -> Self {
        if sizes.iter().all(|&size| size == 3) {
            Self::Triangles
        } else if sizes.iter().all(|&size| size == 4) {
            Self::Quads
        } else {
            Self::Mixed(sizes.to_vec())
        }
    }
}

/// A mesh that owns its arrays. [`OwnedMesh::view`] panics if they are not valid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OwnedMesh {
    /// V by 3.
    pub positions: Vec<[f32; 3]>,
    /// V by 3.
    pub normals: Vec<[f32; 3]>,
    /// V by 2.
    pub uvs: Vec<[f32; 2]>,
    /// The vertex of each corner; `None` if corner i is vertex i.
    pub indices: Option<Vec<u32>>,
    /// The corner counts of faces.
    pub faces: FaceSizes,
}

/// One vertex's data: position, normal, UV.
pub type Vertex = ([f32; 3], [f32; 3], [f32; 2]);

impl OwnedMesh {
    /// The mesh as a view for the library.
    pub fn view(&self) -> Mesh<'_> {
        let indices = self.indices.as_ref().map_or(Indices::Unindexed, Indices::from);
        let faces = match &self.faces {
            FaceSizes::Triangles => Faces::Triangles,
            FaceSizes::Quads => Faces::Quads,
            FaceSizes::Mixed(sizes) => Faces::Mixed(sizes),
        };
        Mesh::with_faces(&self.positions, &self.normals, &self.uvs, indices, faces).expect("a valid mesh")
    }

    /// Adds a vertex and returns its number.
    pub fn push(&mut self, (position, normal, uv): Vertex) -> u32 {
        self.positions.push(position);
        self.normals.push(normal);
        self.uvs.push(uv);
        self.positions.len() as u32 - 1
    }

    /// The data of vertex `v`.
    pub fn vertex(&self, v: usize) -> Vertex {
        (self.positions[v], self.normals[v], self.uvs[v])
    }

    /// The number of corners.
    pub fn corner_count(&self) -> usize {
        self.indices.as_ref().map_or(self.positions.len(), Vec::len)
    }

    /// The vertex that `corner` uses.
    pub fn vertex_of_corner(&self, corner: usize) -> usize {
        self.indices.as_ref().map_or(corner, |list| list[corner] as usize)
    }

    /// The corner count of each face.
    pub fn face_sizes(&self) -> Vec<u32> {
        match &self.faces {
            FaceSizes::Triangles => vec![3; self.corner_count() / 3],
            FaceSizes::Quads => vec![4; self.corner_count() / 4],
            FaceSizes::Mixed(sizes) => sizes.clone(),
        }
    }

    /// The vertices of each face.
    pub fn face_list(&self) -> Vec<Vec<u32>> {
        let mut corner = 0;
        let face = |size: u32| {
            let vertices =
                (corner..corner + size as usize).map(|c| self.vertex_of_corner(c) as u32).collect();
            corner += size as usize;
            vertices
        };
        self.face_sizes().into_iter().map(face).collect()
    }

    /// A mesh with the same vertices and other faces.
    pub fn with_face_list(mut self, faces: &[Vec<u32>]) -> Self {
        self.indices = Some(faces.concat());
        self.faces = FaceSizes::from_list(&faces.iter().map(|face| face.len() as u32).collect::<Vec<_>>());
        self
    }

    /// The mesh without indices: every corner gets a vertex of its own.
    pub fn unindexed(&self) -> Self {
        let mut mesh = Self { faces: self.faces.clone(), ..Self::default() };
        for corner in 0..self.corner_count() {
            mesh.push(self.vertex(self.vertex_of_corner(corner)));
        }
        mesh
    }

    /// True for each corner whose face MikkTSpace defines: one of 3 or 4 corners.
    pub fn supported_corners(&self) -> Vec<bool> {
        let supported = |size: u32| std::iter::repeat_n(size == 3 || size == 4, size as usize);
        self.face_sizes().into_iter().flat_map(supported).collect()
    }

    /// The mesh with moved vertices: some move a little, some onto others, some become non-finite.
    pub fn moved(&self, seed: usize) -> Self {
        let mut moved = self.clone();
        let count = self.positions.len();
        for vertex in 0..count {
            let place = (seed + vertex) * 7919;
            match place % 23 {
                0 => moved.positions[vertex] = self.positions[place % count],
                1 if seed.is_multiple_of(3) => moved.positions[vertex][place % 3] = f32::NAN,
                2 if seed.is_multiple_of(4) => moved.normals[vertex] = [0.0; 3],
                3..10 if seed.is_multiple_of(2) => moved.positions[vertex][place % 3] += 0.125,
                10..15 => moved.normals[vertex][place % 3] *= -0.5,
                _ => {}
            }
        }
        moved
    }

    /// The mesh as text: `v` lines (position, normal, UV), then `f` lines (vertices from 0). Reads back to
    /// the same bits.
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        for v in 0..self.positions.len() {
            let (p, n, t) = self.vertex(v);
            let line = [join(&p), join(&n), join(&t)].join("   ");
            text += &format!("v {line}\n");
        }
        for face in self.face_list() {
            let vertices: Vec<String> = face.iter().map(u32::to_string).collect();
            text += &format!("f {}\n", vertices.join(" "));
        }
        text
    }

    /// Reads what [`OwnedMesh::to_text`] writes; `#` starts a comment. The mesh comes out indexed.
    pub fn from_text(text: &str) -> Result<Self, String> {
        let mut mesh = Self::default();
        let mut faces = Vec::new();
        for (number, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or_default();
            let mut words = line.split_whitespace();
            let complain = |what: &str| format!("line {}: {what}: {line}", number + 1);
            match words.next() {
                None => {}
                Some("v") => {
                    let numbers: Vec<f32> = words
                        .map(|word| word.parse().map_err(|_| complain("not a number")))
                        .collect::<Result<_, _>>()?;
                    let &[x, y, z, nx, ny, nz, u, v] = numbers.as_slice() else {
                        return Err(complain("a vertex has 8 numbers"));
                    };
                    mesh.push(([x, y, z], [nx, ny, nz], [u, v]));
                }
                Some("f") => faces.push(
                    words
                        .map(|word| word.parse().map_err(|_| complain("not a vertex number")))
                        .collect::<Result<Vec<u32>, _>>()?,
                ),
                Some(_) => return Err(complain("a line starts with v or f")),
            }
        }
        Ok(mesh.with_face_list(&faces))
    }
}

fn join(numbers: &[f32]) -> String {
    let words: Vec<String> = numbers.iter().map(|number| format!("{number:?}")).collect();
    words.join(" ")
}

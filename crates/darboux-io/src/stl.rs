//! STL, ASCII and binary: triangles without UVs. The normals of facets are left out: they are those of the winding, which glTF computes.

use std::collections::HashMap;

use crate::error::ContentError;
use crate::source::{SourceFormat, SourceMesh, SourceScene};

/// The length of a binary header, and of a facet.
const HEADER: usize = 84;
const FACET: usize = 50;

/// Reads an STL. Errors: it is cut off; a number is none; no facets.
pub fn read(bytes: &[u8]) -> Result<SourceScene, ContentError> {
    let mut scene = SourceScene::new(SourceFormat::Stl);
    let is_binary = bytes.get(80..HEADER).and_then(|count| count.first_chunk()).is_some_and(|count| {
        HEADER as u64 + FACET as u64 * u64::from(u32::from_le_bytes(*count)) == bytes.len() as u64
    });
    let meshes = if is_binary { vec![binary(bytes, &mut scene)] } else { ascii(bytes)? };
    if meshes.iter().all(|mesh| mesh.corners.is_empty()) {
        return Err(ContentError::invalid("", "is an STL without facets; export it again"));
    }
    scene.meshes = meshes;
    Ok(scene)
}

/// The facets of a binary STL, whose length was checked.
fn binary(bytes: &[u8], scene: &mut SourceScene) -> SourceMesh {
    let facets = bytes[HEADER..].as_chunks::<FACET>().0;
    let mut corners = Corners::with_capacity(3 * facets.len());
    let mut has_colors = false;
    for facet in facets {
        for corner in facet[12..48].as_chunks::<12>().0 {
            corners.push(
                [0, 4, 8].map(|at| {
                    f32::from_le_bytes([corner[at], corner[at + 1], corner[at + 2], corner[at + 3]])
                }),
            );
        }
        has_colors |= facet[48..] != [0, 0];
    }
    if has_colors {
        scene.not_carried.push("the attributes of facets, such as colours".to_owned());
    }
    let header = bytes[..80].split(|byte| !(b' '..=b'~').contains(byte)).next().unwrap_or_default();
    scene.generator = Some(String::from_utf8_lossy(header).trim().to_owned()).filter(|text| !text.is_empty());
    corners.into_mesh(String::new())
}

/// The solids of an ASCII STL.
fn ascii(bytes: &[u8]) -> Result<Vec<SourceMesh>, ContentError> {
    let mut meshes = Vec::new();
    let (mut name, mut corners) = (String::new(), Corners::default());
    for (number, line) in bytes.split(|&byte| byte == b'\n' || byte == b'\r').enumerate() {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next().unwrap_or_default().to_ascii_lowercase().as_slice() {
            b"vertex" => {
                let mut next =
                    || words.next().and_then(|word| str::from_utf8(word).ok()?.parse::<f32>().ok());
                let (Some(x), Some(y), Some(z)) = (next(), next(), next()) else {
                    let problem = "is no vertex with three numbers; export the file again";
                    return Err(ContentError::invalid(format!("line {}", number + 1), problem));
                };
                corners.push([x, y, z]);
            }
            b"solid" => {
                let rest = line.trim_ascii_start().get(5..).unwrap_or_default();
                name = String::from_utf8_lossy(rest).trim().to_owned();
            }
            b"endsolid" => meshes.push(std::mem::take(&mut corners).into_mesh(std::mem::take(&mut name))),
            _ => {}
        }
    }
    if !corners.corners.is_empty() {
        return Err(ContentError::invalid(
            "",
            "is an STL that is cut off before endsolid; export or download it again",
        ));
    }
    meshes.retain(|mesh| !mesh.corners.is_empty());
    Ok(meshes)
}

/// Corners of triangles. Equal positions are stored once.
#[derive(Debug, Default)]
struct Corners {
    positions: Vec<[f32; 3]>,
    corners: Vec<u32>,
    index: HashMap<[u32; 3], u32>,
}

impl Corners {
    fn with_capacity(corners: usize) -> Self {
        Self {
            positions: Vec::with_capacity(corners / 6),
            corners: Vec::with_capacity(corners),
            index: HashMap::with_capacity(corners / 6),
        }
    }

    fn push(&mut self, position: [f32; 3]) {
        let new = self.positions.len() as u32;
        let index = *self.index.entry(position.map(f32::to_bits)).or_insert(new);
        if index == new {
            self.positions.push(position);
        }
        self.corners.push(index);
    }

    fn into_mesh(mut self, name: String) -> SourceMesh {
        self.corners.truncate(self.corners.len() / 3 * 3);
        let path = format!("solid {name}").trim_end().to_owned();
        SourceMesh { name, path, positions: self.positions, corners: self.corners, ..SourceMesh::default() }
    }
}

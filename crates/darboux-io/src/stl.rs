//! STL, ASCII and binary: triangles without UVs. The normals of facets are left out: they follow from the
//! winding, and glTF computes them. Where they do not, and where facets have colours, the summary says so.

use std::collections::HashMap;

use darboux::internal::vectors::double::{cross, dot, sub};

use crate::error::ContentError;
use crate::source::{SourceFormat, SourceMesh, SourceScene, program_of_comment};
use crate::words::counted;

/// The length of a binary header, and of a facet.
const HEADER: usize = 84;
const FACET: usize = 50;

/// Reads an STL. Errors: it is cut off; a number is none; no facets.
pub fn read(bytes: &[u8]) -> Result<SourceScene, ContentError> {
    let mut scene = SourceScene::new(SourceFormat::Stl);
    let is_binary = bytes.get(80..HEADER).and_then(|count| count.first_chunk()).is_some_and(|count| {
        HEADER as u64 + FACET as u64 * u64::from(u32::from_le_bytes(*count)) == bytes.len() as u64
    });
    let mut losses = Losses::default();
    let meshes =
        if is_binary { vec![binary(bytes, &mut scene, &mut losses)] } else { ascii(bytes, &mut losses)? };
    losses.say(&mut scene);
    if meshes.iter().all(|mesh| mesh.corners.is_empty()) {
        return Err(ContentError::invalid("", "is an STL without facets; export it again"));
    }
    scene.meshes = meshes;
    Ok(scene)
}

/// The numbers of facets that lose something.
#[derive(Debug, Default)]
struct Losses {
    /// Facets with a normal that points against the winding.
    against: usize,
    /// Facets with a normal of another direction.
    slanted: usize,
    /// Facets with attribute bytes, in which some programs write colours.
    attributes: usize,
    has_color: bool,
}

/// The least cosine between a normal and the normal of the winding: 2.6 degrees, more than the digits of any
/// writer explain.
const SAME_DIRECTION: f64 = 0.999;

impl Losses {
    /// Compares a facet's normal with its winding. Normals without a length, as many programs write them, and
    /// facets without an area say nothing.
    fn add_normal(&mut self, normal: [f32; 3], corners: [[f32; 3]; 3]) {
        let [a, b, c] = corners.map(|corner| corner.map(f64::from));
        let winding = cross(sub(b, a), sub(c, a));
        let normal = normal.map(f64::from);
        let lengths = (dot(winding, winding) * dot(normal, normal)).sqrt();
        let cosine = dot(winding, normal) / lengths;
        // NaN, for facets without an area, is in neither range.
        self.against += usize::from(cosine < -SAME_DIRECTION);
        self.slanted += usize::from((-SAME_DIRECTION..SAME_DIRECTION).contains(&cosine));
    }

    fn say(&self, scene: &mut SourceScene) {
        let facets = |count: usize| counted(count, "facet", "facets");
        match self.against {
            0 => {}
            count => {
                let normals = counted(count, "facet's normal points", "facets' normals point");
                scene.warnings.push(format!(
                    "{normals} against the winding, which decides; if the model looks inside out, turn its \
                     faces over"
                ));
            }
        }
        if self.slanted > 0 {
            let facets = facets(self.slanted);
            scene.not_carried.push(format!("the normals of {facets}, which are not those of the winding"));
        }
        if self.attributes > 0 {
            scene.not_carried.push(format!("the attributes of {}, such as colours", facets(self.attributes)));
        }
        if self.has_color {
            scene.not_carried.push("the colour of all facets in the header".to_owned());
        }
    }
}

/// The facets of a binary STL, whose length was checked.
fn binary(bytes: &[u8], scene: &mut SourceScene, losses: &mut Losses) -> SourceMesh {
    let facets = bytes[HEADER..].as_chunks::<FACET>().0;
    let mut corners = Corners::with_capacity(3 * facets.len());
    for facet in facets {
        let vector = |at: usize| {
            [0, 4, 8]
                .map(|i| f32::from_le_bytes(*facet[at + i..].first_chunk().expect("a facet has 50 bytes")))
        };
        let positions = [12, 24, 36].map(vector);
        positions.into_iter().for_each(|position| corners.push(position));
        losses.add_normal(vector(0), positions);
        losses.attributes += usize::from(facet[48..] != [0, 0]);
    }
    losses.has_color = bytes[..80].windows(6).any(|window| window == b"COLOR=");
    let header = bytes[..80].split(|byte| !(b' '..=b'~').contains(byte)).next().unwrap_or_default();
    scene.generator = program_of_comment(&String::from_utf8_lossy(header));
    corners.into_mesh(String::new())
}

/// The solids of an ASCII STL.
fn ascii(bytes: &[u8], losses: &mut Losses) -> Result<Vec<SourceMesh>, ContentError> {
    let mut meshes = Vec::new();
    let (mut name, mut corners) = (String::new(), Corners::default());
    let (mut normal, mut facet) = ([0.0; 3], Vec::new());
    for (number, line) in bytes.split(|&byte| byte == b'\n' || byte == b'\r').enumerate() {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next().unwrap_or_default().to_ascii_lowercase().as_slice() {
            b"vertex" => {
                let Some(position) = numbers(&mut words) else {
                    let problem = "is no vertex with three numbers; export the file again";
                    return Err(ContentError::invalid(format!("line {}", number + 1), problem));
                };
                corners.push(position);
                facet.push(position);
            }
            b"facet" => {
                // Some writers leave the normal out.
                normal = words.next().and_then(|_| numbers(&mut words)).unwrap_or_default();
                facet.clear();
            }
            b"endfacet" => {
                if let [a, b, c] = facet[..] {
                    losses.add_normal(normal, [a, b, c]);
                }
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

/// The next three numbers; none if there are not as many.
fn numbers<'a>(words: &mut impl Iterator<Item = &'a [u8]>) -> Option<[f32; 3]> {
    let mut next = || words.next().and_then(|word| str::from_utf8(word).ok()?.parse::<f32>().ok());
    Some([next()?, next()?, next()?])
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

//! Reads the faces of a PLY, and strips of triangles, with the UVs and textures of their corners.

use super::header::{Element, Encoding, NumberType, Property};
use super::property::{cut_off, next, properties};
use super::values::Values;
use crate::error::ContentError;
use crate::source::{CornerValues, FaceSizes, SourceMesh, SourceScene, SourceUvSet};
use crate::words::counted_if_any;

/// A corner without UVs.
const NONE: u32 = u32::MAX;

/// The faces while they are read.
#[derive(Debug, Default)]
pub struct FaceReader {
    pub corners: Vec<u32>,
    /// The triangles before the first face that has an entry in the lists below.
    first_triangles: usize,
    sizes: Vec<u32>,
    /// UVs of corners, which MeshLab writes as `texcoord`, and the place of each corner's.
    uvs: Vec<[f32; 2]>,
    uv_of_corner: Vec<u32>,
    /// The texture of each face, which MeshLab writes as `texnumber`; none for -1.
    textures: Vec<Option<u32>>,
    has_larger: bool,
    has_textures: bool,
}

/// What a property of a face is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum FaceProperty {
    Indices,
    Uvs,
    Texture,
    Other,
}

fn face_property(property: &Property) -> FaceProperty {
    match (&*property.name, property.length.is_some()) {
        ("vertex_indices" | "vertex_index", true) => FaceProperty::Indices,
        ("texcoord", true) => FaceProperty::Uvs,
        ("texnumber", false) => FaceProperty::Texture,
        _ => FaceProperty::Other,
    }
}

impl FaceReader {
    /// Whether there is a face of three or more corners.
    pub fn has_surface(&self) -> bool {
        self.first_triangles > 0 || self.sizes.iter().any(|&size| size >= 3)
    }

    /// Reads an element of faces or strips.
    pub fn read(
        &mut self,
        element: &Element,
        values: &mut Values<'_>,
        scene: &mut SourceScene,
    ) -> Result<(), ContentError> {
        let is_strip = element.name == "tristrips";
        let kinds: Vec<FaceProperty> = element.properties.iter().map(face_property).collect();
        let (mut indices, mut uvs) = (Vec::new(), Vec::new());
        let read = if is_strip || !self.sizes.is_empty() {
            0
        } else {
            self.read_triangles(element, &kinds, values)?
        };
        if read < element.count {
            self.list_first_triangles();
        }
        for face in read..element.count {
            indices.clear();
            uvs.clear();
            let mut texture = None;
            values.begin_record();
            for (property, kind) in element.properties.iter().zip(&kinds) {
                let read = match kind {
                    FaceProperty::Indices => read_list(property, values, &mut indices),
                    FaceProperty::Uvs => read_list(property, values, &mut uvs),
                    FaceProperty::Texture => next(property, values).map(|number| texture = Some(number)),
                    FaceProperty::Other => next(property, values).map(|_| ()),
                };
                read.ok_or_else(|| cut_off(element, face, values))?;
            }
            values.end_record();
            if is_strip {
                self.add_strips(&indices)
            } else {
                if let Some(&index) = indices.iter().find(|&&index| index < 0.0) {
                    return Err(wrong_index(face, index));
                }
                self.add_face(&indices)
            }
            self.add_uvs(&uvs);
            self.has_textures |= texture.is_some();
            self.textures.resize(self.sizes.len(), texture.and_then(texture_number));
        }
        let others = element.properties.iter().zip(kinds).filter(|(_, kind)| *kind == FaceProperty::Other);
        scene.not_carried.extend(properties("face", others.map(|(property, _)| &*property.name)));
        Ok(())
    }

    /// Reads triangles of a binary file whose faces have nothing but indices of 32 bits, as most have, up to
    /// the first larger face. Returns how many. Errors: an index is negative.
    fn read_triangles(
        &mut self,
        element: &Element,
        kinds: &[FaceProperty],
        values: &mut Values<'_>,
    ) -> Result<usize, ContentError> {
        const ROW: usize = 13;
        let ([property], [FaceProperty::Indices]) = (&element.properties[..], kinds) else { return Ok(0) };
        let is_signed = match (property.length, property.number) {
            (Some(NumberType::U8 | NumberType::I8), NumberType::I32) => true,
            (Some(NumberType::U8 | NumberType::I8), NumberType::U32) => false,
            _ => return Ok(0),
        };
        if values.encoding() != Encoding::LittleEndian {
            return Ok(0);
        }
        let rows = values.rest().as_chunks::<ROW>().0;
        let rows = &rows[..rows.len().min(element.count)];
        let count = rows.iter().position(|row| row[0] != 3).unwrap_or(rows.len());
        let index =
            |row: &[u8; ROW], at: usize| u32::from_le_bytes([row[at], row[at + 1], row[at + 2], row[at + 3]]);
        // The sign bits of all indices.
        let mut signs = 0;
        let corners = rows[..count].iter().map(|row| {
            let triangle = [index(row, 1), index(row, 5), index(row, 9)];
            signs |= triangle[0] | triangle[1] | triangle[2];
            triangle
        });
        let triangles: Vec<[u32; 3]> = corners.collect();
        if is_signed && signs > i32::MAX as u32 {
            let indices = triangles.as_flattened().iter().map(|&index| f64::from(index.cast_signed()));
            if let Some((corner, index)) = indices.enumerate().find(|(_, index)| *index < 0.0) {
                return Err(wrong_index(corner / 3, index));
            }
        }
        if self.corners.is_empty() {
            self.corners = triangles.into_flattened();
        } else {
            self.corners.extend_from_slice(triangles.as_flattened());
        }
        self.first_triangles += count;
        _ = values.bytes(ROW * count);
        Ok(count)
    }

    /// Makes the lists of faces as long as if the first triangles had been added one by one.
    fn list_first_triangles(&mut self) {
        let count = std::mem::take(&mut self.first_triangles);
        self.sizes.resize(self.sizes.len() + count, 3);
        self.textures.resize(self.sizes.len(), None);
        self.uv_of_corner.resize(self.corners.len(), NONE);
    }

    fn add_face(&mut self, list: &[f64]) {
        self.corners.extend(list.iter().map(|&index| index_of(index)));
        self.has_larger |= list.len() != 3;
        self.sizes.push(list.len() as u32);
    }

    /// Adds strips of triangles, which -1 separates. Every second triangle is reversed.
    fn add_strips(&mut self, list: &[f64]) {
        for strip in list.split(|&index| index < 0.0) {
            for (at, window) in strip.windows(3).enumerate() {
                let [a, b, c] = [0, 1 + at % 2, 2 - at % 2].map(|i| index_of(window[i]));
                if a != b && b != c && a != c {
                    self.corners.extend([a, b, c]);
                    self.sizes.push(3);
                }
            }
        }
    }

    /// Adds the UVs of the last face's corners; corners without any have none.
    fn add_uvs(&mut self, list: &[f64]) {
        let first = self.uvs.len();
        let room = self.corners.len() - self.uv_of_corner.len();
        self.uvs.extend(list.as_chunks().0.iter().take(room).map(|&[u, v]| [u as f32, v as f32]));
        self.uv_of_corner.extend((first..self.uvs.len()).map(|uv| uv as u32));
        self.uv_of_corner.resize(self.corners.len(), NONE);
    }

    /// Moves everything into the mesh. `textures`: how many materials the file has, one per texture.
    pub fn finish(self, textures: usize, mesh: &mut SourceMesh, scene: &mut SourceScene) {
        let few = self.sizes.iter().filter(|size| (1..3).contains(*size)).count();
        scene.not_carried.extend(counted_if_any(
            few,
            "face of one or two corners",
            "faces of one or two corners",
        ));
        mesh.corners = self.corners;
        mesh.faces = if self.has_larger { FaceSizes::Sizes(self.sizes) } else { FaceSizes::Triangles };
        if !self.uvs.is_empty() {
            if !mesh.uv_sets.is_empty() {
                scene.not_carried.push("the UVs of vertices, which those of the faces replace".to_owned());
            }
            let uvs = CornerValues::indexed(self.uvs, self.uv_of_corner);
            mesh.uv_sets = vec![SourceUvSet { name: "texcoord".to_owned(), uvs }];
        }
        if self.has_textures && textures > 1 {
            let known = |texture: Option<u32>| texture.filter(|&texture| (texture as usize) < textures);
            mesh.material_of_face = self.textures.into_iter().map(known).collect();
        } else if textures > 0 {
            mesh.material = Some(0);
        }
        match textures {
            0 | 1 => {}
            _ if self.has_textures => {}
            2 => scene.not_carried.push("1 texture after the first, which no face names".to_owned()),
            _ => {
                let others = textures - 1;
                scene.not_carried.push(format!("{others} textures after the first, which no face names"));
            }
        }
    }
}

/// The number of a texture. Numbers that are none are none.
fn texture_number(number: f64) -> Option<u32> {
    (0.0..f64::from(u32::MAX)).contains(&number).then_some(number as u32)
}

/// A face with a negative index.
fn wrong_index(face: usize, index: f64) -> ContentError {
    let problem = format!("has the index {index}, but indices begin at 0; export the file again");
    ContentError::invalid(format!("face {face}"), problem)
}

/// A vertex's index. Numbers that are none become an index that does not exist, which the builder refuses.
fn index_of(index: f64) -> u32 {
    if (0.0..f64::from(u32::MAX)).contains(&index) { index as u32 } else { u32::MAX }
}

/// Reads a list into `list`. None: it is cut off.
fn read_list(property: &Property, values: &mut Values<'_>, list: &mut Vec<f64>) -> Option<()> {
    list.clear();
    let count = values.next(property.length?)?;
    for _ in 0..count as usize {
        list.push(values.next(property.number)?);
    }
    Some(())
}

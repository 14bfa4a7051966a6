//! Makes a mesh of each object and group: its positions, UVs and normals are those that its faces use, in the
//! order of use.

use super::text::{KINDS, NONE, ObjText, Run};
use crate::source::{CornerValues, FaceSizes, SourceMesh, SourceUvSet};

/// A corner that refers to an element that does not exist.
#[derive(Debug)]
pub struct MissingElement {
    /// The corner's place in the text.
    pub corner: usize,
    /// A clause whose subject is the line.
    pub problem: String,
}

/// The meshes of all objects and groups. Errors: a corner refers to an element that does not exist.
pub fn build(text: &ObjText) -> Result<Vec<SourceMesh>, MissingElement> {
    let counts = [text.positions.len(), text.uvs.len(), text.normals.len()];
    let mut numberings = counts.map(Numbering::new);
    text.runs.iter().map(|run| mesh(text, run, &mut numberings)).collect()
}

fn mesh(text: &ObjText, run: &Run, numberings: &mut [Numbering; 3]) -> Result<SourceMesh, MissingElement> {
    let corners = &text.corners[run.corners.clone()];
    let path = format!("{} {}", run.kind, run.name).trim().to_owned();
    let mut lists: [Vec<u32>; 3] = Default::default();
    for (kind, (list, numbering)) in lists.iter_mut().zip(numberings.iter_mut()).enumerate() {
        numbering.clear();
        list.reserve(corners.len());
        for (at, corner) in corners.iter().enumerate() {
            let index = corner[kind];
            let new =
                numbering.of(index).ok_or_else(|| missing(kind, index, numbering, run.corners.start + at))?;
            list.push(new);
        }
    }
    let [positions, uvs, normals] = numberings;
    let [corners, uv_of_corner, normal_of_corner] = lists;
    let faces = run.faces.clone();
    let sizes = &text.sizes[faces.clone()];
    let materials = &text.materials[faces.clone()];
    let mut mesh = SourceMesh {
        name: run.name.clone(),
        path,
        positions: positions.used(&text.positions),
        corners,
        faces: if sizes.iter().all(|&size| size == 3) {
            FaceSizes::Triangles
        } else {
            FaceSizes::Sizes(sizes.to_vec())
        },
        material: materials[0],
        ..SourceMesh::default()
    };
    if materials.iter().any(|material| *material != materials[0]) {
        mesh.material_of_face = materials.to_vec();
    }
    if text.has_smoothing {
        mesh.smoothing_of_face = text.smoothing[faces].to_vec();
    }
    if !uvs.order.is_empty() {
        let uvs = CornerValues::indexed(uvs.used(&text.uvs), uv_of_corner);
        mesh.uv_sets.push(SourceUvSet { name: String::new(), uvs });
    }
    if !normals.order.is_empty() {
        mesh.normals = Some(CornerValues::indexed(normals.used(&text.normals), normal_of_corner));
    }
    if text.colors.len() == text.positions.len() {
        mesh.colors.push(CornerValues::of_positions(positions.used(&text.colors)));
    }
    Ok(mesh)
}

fn missing(kind: usize, index: u32, numbering: &Numbering, corner: usize) -> MissingElement {
    let what = KINDS[kind];
    let count = numbering.new.len();
    let index = u64::from(index) + 1;
    MissingElement { corner, problem: format!("refers to {what} {index}, but there are {count}") }
}

/// Numbers the elements of a list in the order of their use, for one mesh after the other.
#[derive(Debug)]
struct Numbering {
    /// The new number of each element.
    new: Vec<u32>,
    /// The elements in the order of their use.
    order: Vec<u32>,
}

impl Numbering {
    fn new(count: usize) -> Self {
        Self { new: vec![NONE; count], order: Vec::new() }
    }

    fn clear(&mut self) {
        self.order.drain(..).for_each(|old| self.new[old as usize] = NONE);
    }

    /// The new number of an element; `NONE` for itself. None: it does not exist.
    fn of(&mut self, old: u32) -> Option<u32> {
        if old == NONE {
            return Some(NONE);
        }
        let new = self.new.get_mut(old as usize)?;
        if *new == NONE {
            *new = self.order.len() as u32;
            self.order.push(old);
        }
        Some(*new)
    }

    fn used<T: Copy>(&self, elements: &[T]) -> Vec<T> {
        self.order.iter().map(|&old| elements[old as usize]).collect()
    }
}

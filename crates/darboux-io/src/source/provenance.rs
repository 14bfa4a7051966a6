//! Where a document came from: its format, the places of its primitives in that file, and the faces before
//! they were cut.

use std::collections::HashMap;
use std::path::PathBuf;

use serde::Serialize;

use super::format::SourceFormat;
use super::polygons::PolygonRule;

/// Where a document came from that was read from another format than glTF.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Provenance {
    /// The format of the file.
    pub format: SourceFormat,
    /// The program that wrote the file, where the file says so.
    pub generator: Option<String>,
    /// The faces of the whole file.
    pub faces: FaceCounts,
    /// How faces of five and more corners were cut.
    pub polygon_rule: PolygonRule,
    /// What was not carried over: a noun phrase each, such as `2 cameras`.
    pub not_carried: Vec<String>,
    /// The normal maps of materials that are not in the document, because glTF cannot hold their images or
    /// their files are not there.
    pub unread_maps: Vec<UnreadMap>,
    /// The files beside it that were read, links resolved: material libraries, textures.
    pub(crate) companions: Vec<PathBuf>,
    pub(crate) primitives: HashMap<(usize, usize), PrimitiveSource>,
}

impl Provenance {
    /// The normal maps of a material that are not in the document.
    pub fn unread_maps_of(&self, material: usize) -> impl Iterator<Item = &UnreadMap> {
        self.unread_maps.iter().filter(move |map| map.material == material)
    }

    /// Where a primitive of a mesh came from.
    pub fn primitive(&self, mesh: usize, primitive: usize) -> Option<&PrimitiveSource> {
        self.primitives.get(&(mesh, primitive))
    }

    /// The same in words: `Armature/Body in your FBX`.
    pub fn place(&self, mesh: usize, primitive: usize) -> Option<String> {
        let PrimitiveSource { path, .. } = self.primitive(mesh, primitive)?;
        let format = self.format.name();
        // A PLY is one mesh without a name.
        Some(if path.is_empty() { format!("your {format}") } else { format!("{path} in your {format}") })
    }
}

/// A normal map that is not in the document.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct UnreadMap {
    /// The index of the material.
    pub material: usize,
    /// The UV set n of `TEXCOORD_n` that it uses.
    pub uv_set: usize,
    /// The name of the image's file.
    pub file: String,
    /// What is wrong with the file: a clause whose subject it is, with what to do.
    pub problem: String,
    /// Whether the file is not where the model refers to it, or the system refuses it. Others are in formats
    /// that are not read.
    pub is_absent: bool,
}

/// Where a primitive came from.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct PrimitiveSource {
    /// The place in the source file, in its own words: a node's path in FBX, `o Body` in OBJ; empty in PLY,
    /// which has one mesh.
    pub path: String,
    /// The triangles that are the first half of a quad, ascending; the next triangle is the other half.
    pub quads: Vec<u32>,
    /// The number of triangles.
    pub triangles: usize,
}

/// Numbers of faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct FaceCounts {
    /// Faces of three corners.
    pub triangles: usize,
    /// Faces of four corners, which MikkTSpace takes as they are.
    pub quads: usize,
    /// Faces of five and more corners, which are cut before tangents are computed.
    pub polygons: usize,
    /// Concave quads that are not cut along the diagonal of MikkTSpace, because it lies outside them.
    pub outside_diagonals: usize,
    /// Faces whose triangles fold over: they cross themselves, are not flat, or are too large to cut.
    pub folded: usize,
}

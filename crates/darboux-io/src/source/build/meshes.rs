//! Meshes of a document: each mesh of polygons becomes one mesh with a primitive per material.

use std::borrow::Cow;
use std::collections::HashMap;

use darboux::UvOrigin;
use serde_json::{Value, json};

use super::data::DataBuilder;
use crate::error::{ContentError, shortened};
use crate::memory_limit::Budget;
use crate::source::polygons::{Cutter, Triangle};
use crate::source::provenance::{FaceCounts, PrimitiveSource};
use crate::source::scene::{CornerValues, FaceSizes, SourceMesh, SourceScene};
use crate::source::vertices::{FoundVertices, Used, VertexFinder};
use crate::words::counted;

/// The estimate for a primitive: its part of a mesh and a node, and up to four accessors and buffer views.
const BYTES_PER_PRIMITIVE: usize = 16 << 10;

/// The meshes of a document.
#[derive(Debug, Default)]
pub struct Meshes {
    pub json: Vec<Value>,
    /// The index of each mesh of the scene; none for those without faces.
    pub of_source: Vec<Option<usize>>,
    pub sources: HashMap<(usize, usize), PrimitiveSource>,
    pub faces: FaceCounts,
    pub warnings: Vec<String>,
}

/// Builds all meshes of a scene.
pub fn build(
    scene: &SourceScene,
    cutter: &mut Cutter,
    data: &mut DataBuilder,
    limit: Budget,
) -> Result<Meshes, ContentError> {
    let mut meshes = Meshes::default();
    let mut incomplete = Incomplete::default();
    if scene.meshes.len().saturating_mul(BYTES_PER_PRIMITIVE) > limit.bytes {
        let what = format!("has {} objects and groups, which need", scene.meshes.len());
        return Err(ContentError::unsupported("", limit.exceeded(&what)));
    }
    let (mut primitives, mut folded) = (0, SomeFaces::default());
    for mesh in &scene.meshes {
        check(mesh)?;
        let parts = parts(mesh);
        primitives += parts.len();
        if primitives.saturating_mul(BYTES_PER_PRIMITIVE) > limit.bytes {
            let what = format!("has {primitives} or more objects with materials of their own, which need");
            return Err(ContentError::unsupported("", limit.exceeded(&what)));
        }
        if parts.is_empty() {
            meshes.of_source.push(None);
            continue;
        }
        let index = meshes.json.len();
        meshes.of_source.push(Some(index));
        let mut finder = VertexFinder::new(mesh);
        // Each primitive has a copy of it.
        let path = shortened(&mesh.path);
        let mut builder = PrimitiveBuilder { scene, mesh, path, cutter: &mut *cutter, data: &mut *data };
        let folded_before = builder.cutter.folded;
        let mut list = Vec::with_capacity(parts.len());
        let is_single = parts.len() == 1;
        for part in parts {
            let used = part.used(index, mesh, &mut incomplete);
            let (json, source) = builder.primitive(&part, &used, is_single, &mut finder, &mut meshes.faces);
            meshes.sources.insert((index, list.len()), source);
            list.push(json);
        }
        folded.add(builder.cutter.folded - folded_before, index, mesh);
        let mut json = json!({"name": mesh.name, "primitives": list});
        if !mesh.morphs.is_empty() {
            let names: Vec<&str> = mesh.morphs.iter().map(|morph| &*morph.name).collect();
            let weights: Vec<f32> = mesh.morphs.iter().map(|morph| morph.weight).collect();
            json["extras"]["targetNames"] = json!(names);
            json["weights"] = json!(weights);
        }
        if mesh.uv_sets.iter().any(|set| !set.name.is_empty()) {
            let names: Vec<&str> = mesh.uv_sets.iter().map(|set| &*set.name).collect();
            json["extras"]["uvSetNames"] = json!(names);
        }
        meshes.json.push(json);
    }
    meshes.warnings.extend(incomplete.warnings());
    meshes.warnings.extend(folded_warning(&folded));
    Ok(meshes)
}

/// A sentence if there are faces whose triangles fold over.
fn folded_warning(folded: &SomeFaces) -> Option<String> {
    let faces = match folded.count {
        0 => return None,
        1 => "1 face crosses itself, is not flat or is too large to cut, and its".to_owned(),
        count => format!("{count} faces cross themselves, are not flat or are too large to cut, and their"),
    };
    let place = folded.place();
    Some(format!("{place}{faces} triangles overlap; split such faces in a modelling program"))
}

/// Some meshes of the file.
#[derive(Debug, Default)]
struct SomeMeshes {
    count: usize,
    /// The path of the first one in the file, or its name.
    first: String,
    /// The index of the last one: a mesh may have several primitives.
    last: Option<usize>,
}

impl SomeMeshes {
    fn add(&mut self, index: usize, mesh: &SourceMesh) {
        if self.last == Some(index) {
            return;
        }
        if self.count == 0 {
            self.first = shortened(if mesh.path.is_empty() { &mesh.name } else { &mesh.path });
        }
        self.count += 1;
        self.last = Some(index);
    }

    /// The subject of a sentence.
    fn names(&self) -> String {
        match (&*self.first, self.count) {
            ("", count) => counted(count, "mesh", "meshes"),
            (first, 1) => first.to_owned(),
            (first, count) => format!("{first} and {}", counted(count - 1, "other mesh", "other meshes")),
        }
    }
}

/// Some faces, and the meshes that they are in.
#[derive(Debug, Default)]
struct SomeFaces {
    count: usize,
    meshes: SomeMeshes,
}

impl SomeFaces {
    fn add(&mut self, count: usize, index: usize, mesh: &SourceMesh) {
        if count > 0 {
            self.count += count;
            self.meshes.add(index, mesh);
        }
    }

    /// The beginning of a sentence that says where they are; empty for one mesh without a name.
    fn place(&self) -> String {
        let is_unnamed = self.meshes.count == 1 && self.meshes.first.is_empty();
        if is_unnamed { String::new() } else { format!("{}: ", self.meshes.names()) }
    }
}

/// Errors: a face refers to a position that does not exist; the faces have more corners than there are.
fn check(mesh: &SourceMesh) -> Result<(), ContentError> {
    let invalid =
        |problem: String| ContentError::invalid(&*mesh.path, format!("{problem}; export the file again"));
    let positions = mesh.positions.len();
    if let Some(corner) = mesh.corners.iter().find(|&&corner| corner as usize >= positions) {
        return Err(invalid(format!("a face refers to position {corner}, but there are {positions}")));
    }
    let corners = match &mesh.faces {
        FaceSizes::Triangles => mesh.corners.len().next_multiple_of(3),
        FaceSizes::Sizes(sizes) => sizes.iter().map(|&size| size as usize).sum(),
    };
    if corners != mesh.corners.len() {
        return Err(invalid(format!(
            "the faces have {corners} corners, but there are {}",
            mesh.corners.len()
        )));
    }
    let of_positions = mesh.weights.iter().flat_map(|set| [set.joints.len(), set.weights.len()]);
    let of_positions = of_positions.chain(mesh.morphs.iter().map(|morph| morph.positions.len()));
    if let Some(count) = of_positions.into_iter().find(|&count| count != positions) {
        return Err(invalid(format!("has {count} weights or offsets for {positions} positions")));
    }
    Ok(())
}

/// The faces of one material.
struct Part {
    material: Option<u32>,
    faces: PartFaces,
}

enum PartFaces {
    /// All triangles of a mesh of triangles.
    Triangles,
    /// The first corner and the number of corners of each face.
    Listed(Vec<(u32, u32)>),
}

/// The faces of at least three corners by material, in the order of their first faces.
fn parts(mesh: &SourceMesh) -> Vec<Part> {
    if mesh.material_of_face.is_empty() && matches!(mesh.faces, FaceSizes::Triangles) {
        let part = Part { material: mesh.material, faces: PartFaces::Triangles };
        return if mesh.corners.is_empty() { Vec::new() } else { vec![part] };
    }
    let triangles = vec![3; mesh.corners.len() / 3];
    let sizes = match &mesh.faces {
        FaceSizes::Triangles => &triangles,
        FaceSizes::Sizes(sizes) => sizes,
    };
    let (mut of_material, mut parts) = (HashMap::new(), Vec::<(Option<u32>, Vec<(u32, u32)>)>::new());
    let mut last: Option<(Option<u32>, usize)> = None;
    let mut first = 0;
    for (face, &size) in sizes.iter().enumerate() {
        let start = first;
        first += size;
        if size < 3 {
            continue;
        }
        let material = mesh.material_of_face.get(face).copied().unwrap_or(mesh.material);
        let place = match last {
            Some((of, place)) if of == material => place,
            _ => *of_material.entry(material).or_insert_with(|| {
                parts.push((material, Vec::new()));
                parts.len() - 1
            }),
        };
        last = Some((material, place));
        parts[place].1.push((start, size));
    }
    parts.into_iter().map(|(material, faces)| Part { material, faces: PartFaces::Listed(faces) }).collect()
}

/// The attributes that some corners of a primitive lack: the faces whose UVs are filled, and the meshes that
/// lose others.
#[derive(Debug, Default)]
struct Incomplete {
    uvs: SomeFaces,
    normals: SomeMeshes,
    colors: SomeMeshes,
}

impl Incomplete {
    fn warnings(&self) -> impl Iterator<Item = String> + use<> {
        let uvs = (self.uvs.count > 0).then(|| {
            let faces = match self.uvs.count {
                1 => "1 face lacks UVs; its corners without them have".to_owned(),
                faces => format!("{faces} faces lack UVs; their corners without them have"),
            };
            let meaning = "a face with one UV at all corners has no area in UV space";
            format!("{}{faces} the UV (0, 0), and {meaning}", self.uvs.place())
        });
        let lost = |meshes: &SomeMeshes, attribute: &str| {
            let have = if meshes.count == 1 { "has" } else { "have" };
            (meshes.count > 0).then(|| {
                format!(
                    "{} {have} {attribute} at some corners only; these {attribute} are left out",
                    meshes.names()
                )
            })
        };
        [uvs, lost(&self.normals, "normals"), lost(&self.colors, "colours")].into_iter().flatten()
    }
}

impl Part {
    /// The corners of all faces.
    fn corners(&self, mesh: &SourceMesh) -> Box<dyn Iterator<Item = u32> + '_> {
        match &self.faces {
            PartFaces::Triangles => Box::new(0..mesh.corners.len() as u32),
            PartFaces::Listed(faces) => Box::new(faces.iter().flat_map(|&(first, size)| first..first + size)),
        }
    }

    /// How many corners have a value.
    fn count<const N: usize>(&self, mesh: &SourceMesh, values: &CornerValues<N>) -> Coverage {
        if values.is_by_position() && values.values.len() == mesh.positions.len() {
            return Coverage::All;
        }
        let (mut some, mut all) = (false, true);
        for corner in self.corners(mesh) {
            let has = values.get(corner as usize, mesh.corners[corner as usize]).is_some();
            (some, all) = (some | has, all & has);
        }
        match (some, all) {
            (_, true) => Coverage::All,
            (true, false) => Coverage::Some,
            (false, false) => Coverage::None,
        }
    }

    /// How many faces have a corner without a value.
    fn faces_without<const N: usize>(&self, mesh: &SourceMesh, values: &CornerValues<N>) -> usize {
        let has = |corner: u32| values.get(corner as usize, mesh.corners[corner as usize]).is_some();
        match &self.faces {
            PartFaces::Triangles => {
                let triangles = (0..mesh.corners.len() as u32).step_by(3);
                triangles.filter(|&first| !(first..first + 3).all(has)).count()
            }
            PartFaces::Listed(faces) => {
                faces.iter().filter(|&&(first, size)| !(first..first + size).all(has)).count()
            }
        }
    }

    /// The values that all corners have, and the UVs that some have. `index`: of the mesh. `incomplete`
    /// counts what corners lack.
    fn used(&self, index: usize, mesh: &SourceMesh, incomplete: &mut Incomplete) -> Used {
        let mut used = Used::default();
        if let Some(normals) = &mesh.normals {
            let coverage = self.count(mesh, normals);
            used.normals = coverage == Coverage::All;
            if coverage == Coverage::Some {
                incomplete.normals.add(index, mesh);
            }
        }
        if let Some(tangents) = mesh.tangents.as_ref().filter(|_| used.normals) {
            used.tangents = self.count(mesh, tangents) == Coverage::All;
        }
        let mut without_uvs = 0;
        for (set, uvs) in mesh.uv_sets.iter().enumerate() {
            let coverage = self.count(mesh, &uvs.uvs);
            if coverage == Coverage::Some {
                without_uvs = without_uvs.max(self.faces_without(mesh, &uvs.uvs));
            }
            if coverage != Coverage::None {
                used.uv_sets.push(set);
            }
        }
        incomplete.uvs.add(without_uvs, index, mesh);
        for (set, colors) in mesh.colors.iter().enumerate() {
            let coverage = self.count(mesh, colors);
            match coverage {
                Coverage::All => used.colors.push(set),
                Coverage::Some => incomplete.colors.add(index, mesh),
                Coverage::None => {}
            }
        }
        used
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Coverage {
    None,
    Some,
    All,
}

struct PrimitiveBuilder<'a> {
    scene: &'a SourceScene,
    mesh: &'a SourceMesh,
    path: String,
    cutter: &'a mut Cutter,
    data: &'a mut DataBuilder,
}

impl<'a> PrimitiveBuilder<'a> {
    /// The JSON of a primitive, and where it came from. `is_single`: all faces of the mesh belong to it.
    fn primitive(
        &mut self,
        part: &Part,
        used: &Used,
        is_single: bool,
        finder: &mut VertexFinder<'a>,
        counts: &mut FaceCounts,
    ) -> (Value, PrimitiveSource) {
        let mesh = self.mesh;
        let mut source = PrimitiveSource { path: self.path.clone(), ..PrimitiveSource::default() };
        let found = if is_single && used.is_by_position(mesh) {
            None
        } else {
            Some(finder.find(used, part.corners(mesh)))
        };
        let indices = match (&part.faces, &found) {
            (PartFaces::Triangles, None) => self.data.indices(&mesh.corners),
            (PartFaces::Triangles, Some(found)) => self.data.indices(&found.of_corner),
            (PartFaces::Listed(faces), _) => {
                let triangles = self.cut(faces, used, found.as_ref(), &mut source, counts);
                self.data.indices(&triangles)
            }
        };
        if let PartFaces::Triangles = part.faces {
            source.triangles = mesh.corners.len() / 3;
            counts.triangles += source.triangles;
        }
        let mut json = json!({"attributes": self.attributes(used, found.as_ref()), "indices": indices});
        if !mesh.morphs.is_empty() {
            json["targets"] = self.targets(found.as_ref());
        }
        if let Some(material) =
            part.material.filter(|&material| (material as usize) < self.scene.materials.len())
        {
            json["material"] = material.into();
        }
        (json, source)
    }

    /// Cuts faces into triangles of vertices.
    fn cut(
        &mut self,
        faces: &[(u32, u32)],
        used: &Used,
        found: Option<&FoundVertices>,
        source: &mut PrimitiveSource,
        counts: &mut FaceCounts,
    ) -> Vec<u32> {
        let mesh = self.mesh;
        let uvs = used.uv_sets.first().map(|&set| &mesh.uv_sets[set].uvs);
        let flips_v = self.scene.uv_origin == UvOrigin::BottomLeft;
        let mut indices = Vec::with_capacity(3 * faces.len());
        let (mut listed, mut positions) = (0, Vec::new());
        for &(first, size) in faces {
            let (first, size) = (first as usize, size as usize);
            let corners = &mesh.corners[first..first + size];
            let vertices = match found {
                Some(found) => &found.of_corner[listed..listed + size],
                None => corners,
            };
            listed += size;
            let position = |corner: usize| mesh.positions[corners[corner] as usize];
            let mut push = |triangles: &[Triangle]| {
                indices.extend(triangles.iter().flatten().map(|&corner| vertices[corner]));
            };
            match size {
                3 => {
                    counts.triangles += 1;
                    push(&[[0, 1, 2]]);
                }
                4 => {
                    counts.quads += 1;
                    source.quads.push(source.triangles as u32);
                    let uv = |corner: usize| {
                        let uv = uvs?.get(first + corner, corners[corner]).unwrap_or_default();
                        Some(if flips_v { flipped(uv) } else { uv })
                    };
                    let uvs = uv(0).zip(uv(1)).zip(uv(2)).zip(uv(3)).map(|(((a, b), c), d)| [a, b, c, d]);
                    push(&self.cutter.quad(&[0, 1, 2, 3].map(position), uvs));
                }
                _ => {
                    counts.polygons += 1;
                    positions.clear();
                    positions.extend((0..size).map(position));
                    push(&self.cutter.polygon(&positions));
                }
            }
            source.triangles += size - 2;
        }
        indices
    }

    fn attributes(&mut self, used: &Used, found: Option<&FoundVertices>) -> Value {
        let mesh = self.mesh;
        let positions = self.of_positions(&mesh.positions, found);
        let mut attributes = json!({"POSITION": self.data.positions(&positions)});
        if let Some(normals) = mesh.normals.as_ref().filter(|_| used.normals) {
            attributes["NORMAL"] = self.push(normals, found, None).into();
        }
        if let Some(tangents) = mesh.tangents.as_ref().filter(|_| used.tangents) {
            attributes["TANGENT"] = self.push(tangents, found, None).into();
        }
        let flips_v = self.scene.uv_origin == UvOrigin::BottomLeft;
        for (place, &set) in used.uv_sets.iter().enumerate() {
            let flip: Option<Change<2>> = flips_v.then_some(flipped);
            attributes[format!("TEXCOORD_{place}")] = self.push(&mesh.uv_sets[set].uvs, found, flip).into();
        }
        for (place, &set) in used.colors.iter().enumerate() {
            attributes[format!("COLOR_{place}")] = self.push(&mesh.colors[set], found, None).into();
        }
        for (place, set) in mesh.weights.iter().enumerate() {
            let joints = self.of_positions(&set.joints, found);
            attributes[format!("JOINTS_{place}")] = self.data.joints(&joints).into();
            let weights = self.of_positions(&set.weights, found);
            attributes[format!("WEIGHTS_{place}")] = self.data.vectors(&weights).into();
        }
        attributes
    }

    fn targets(&mut self, found: Option<&FoundVertices>) -> Value {
        let mesh = self.mesh;
        let mut targets = Vec::with_capacity(mesh.morphs.len());
        for morph in &mesh.morphs {
            let offsets = self.of_positions(&morph.positions, found);
            let mut target = json!({"POSITION": self.data.positions(&offsets)});
            if let Some(normals) = &morph.normals {
                target["NORMAL"] = self.push(normals, found, None).into();
            }
            targets.push(target);
        }
        targets.into()
    }

    /// Adds the values of all vertices. Returns the accessor.
    fn push<const N: usize>(
        &mut self,
        values: &CornerValues<N>,
        found: Option<&FoundVertices>,
        change: Option<Change<N>>,
    ) -> usize {
        let mesh = self.mesh;
        let mut of_vertex: Cow<'_, [[f32; N]]> = match found {
            None => values.values.as_slice().into(),
            Some(found) => {
                let value = |&corner: &u32| values.get(corner as usize, mesh.corners[corner as usize]);
                found.corners.iter().map(|corner| value(corner).unwrap_or([0.0; N])).collect()
            }
        };
        if let Some(change) = change {
            of_vertex = of_vertex.iter().map(|&value| change(value)).collect();
        }
        self.data.vectors(&of_vertex)
    }

    /// The values of all vertices, from the values of positions.
    fn of_positions<T: Copy + Default>(
        &self,
        values: &'a [T],
        found: Option<&FoundVertices>,
    ) -> Cow<'a, [T]> {
        let Some(found) = found else { return values.into() };
        let position = |&corner: &u32| self.mesh.corners[corner as usize] as usize;
        let value = |corner: &u32| values.get(position(corner)).copied().unwrap_or_default();
        found.corners.iter().map(value).collect::<Vec<T>>().into()
    }
}

/// What is done to each value of an attribute.
type Change<const N: usize> = fn([f32; N]) -> [f32; N];

/// UVs whose v points up, as glTF has them.
fn flipped([u, v]: [f32; 2]) -> [f32; 2] {
    [u, 1.0 - v]
}

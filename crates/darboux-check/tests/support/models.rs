//! Healthy models as glTF documents, with one normal map each, that can be damaged.

use darboux::{
    Convention, Faces, Method, NormalOptions, TangentOptions, generate_normals, generate_tangents,
    split_vertices,
};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use darboux_tests::{OwnedMesh, families};
use serde_json::{Value, json};

use super::container::{Writer, container};
use super::maps::{Map, dents, healthy_map};

/// Positions, normals, UVs, tangents and indices.
pub type Arrays = (Vec<[f32; 3]>, Vec<[f32; 3]>, Vec<Vec<[f32; 2]>>, Vec<[f32; 4]>, Vec<u32>);

/// A model that can be changed and written as a document.
#[derive(Clone)]
pub struct Model {
    pub name: String,
    pub positions: Vec<[f32; 3]>,
    pub normals: Option<Vec<[f32; 3]>>,
    pub uvs: Vec<Vec<[f32; 2]>>,
    pub tangents: Option<Vec<[f32; 4]>>,
    pub indices: Vec<u32>,
    /// Where the model has mirrored seams: the vertices before the split, with the tangents of their last
    /// corners.
    pub unsplit: Option<Arrays>,
    pub uv_set: usize,
    pub has_normal_map: bool,
    /// The scale of the normal texture.
    pub normal_scale: f32,
    /// The scale of the texture transform.
    pub transform: Option<[f32; 2]>,
    /// The rotation of the texture transform.
    pub rotation: f32,
    /// The number of primitives with the same data.
    pub copies: usize,
    pub is_skinned: bool,
    pub map: Map,
}

/// Plain, mirrored and closed models, ten or more of each: curved and flat, skinned, with one to three UV
/// sets. Each has a map of its own.
pub fn healthy_models() -> Vec<Model> {
    let plain = [
        ("grid", families::grid(9, 7, false, false)),
        ("large wavy grid", wavy(families::grid(20, 14, false, false))),
        ("unindexed grid", families::grid(12, 9, false, false).unindexed()),
        ("strip", families::strip(20)),
        ("fan", families::fan(16, false)),
        ("cube", families::cube(false)),
        ("sphere", families::sphere(10, 14, false)),
        ("sheared wavy grid", sheared(wavy(families::grid(10, 10, false, false)))),
        ("scaled grid", scaled(families::grid(14, 6, false, false), 250.0)),
        ("wavy grid", wavy(families::grid(16, 16, false, false))),
        ("small wavy grid", scaled(wavy(families::grid(9, 12, false, false)), 0.01)),
        ("wavy sphere", wavy(families::sphere(12, 12, false))),
    ];
    let mirrored = [
        ("mirrored grid", families::grid(16, 7, false, true)),
        ("wide mirrored grid", families::grid(24, 5, false, true)),
        ("tall mirrored grid", families::grid(10, 16, false, true)),
        ("mirrored unindexed grid", families::grid(10, 6, false, true).unindexed()),
        ("mirrored sheared wavy grid", sheared(wavy(families::grid(10, 10, false, true)))),
        ("mirrored scaled grid", scaled(families::grid(14, 6, false, true), 250.0)),
        ("mirrored wavy grid", wavy(families::grid(16, 16, false, true))),
        ("mirrored small wavy grid", scaled(wavy(families::grid(8, 12, false, true)), 0.01)),
        ("mirrored fine wavy grid", wavy(families::grid(16, 12, false, true))),
        ("mirrored flat grid", flat(families::grid(12, 8, false, true))),
        ("mirrored wide wavy grid", wavy(families::grid(20, 6, false, true))),
    ];
    let closed = [
        ("coarse sphere", families::sphere(7, 9, false)),
        ("fine sphere", families::sphere(16, 20, false)),
        ("scaled sphere", scaled(families::sphere(9, 12, false), 250.0)),
        ("small wavy sphere", scaled(wavy(families::sphere(10, 15, false)), 0.01)),
        ("sheared sphere", sheared(families::sphere(8, 24, false))),
        ("large wavy sphere", scaled(wavy(families::sphere(14, 10, false)), 40.0)),
        ("scaled cube", scaled(families::cube(false), 3.0)),
    ];
    let models = plain.into_iter().chain(mirrored).chain(closed).enumerate();
    models.map(|(number, (name, mesh))| Model::new(number, name, mesh)).collect()
}

/// The name of the model of pictures.
const SHOWN: &str = "shown";

/// A curved, mirrored sheet with a map of dents, for pictures.
pub fn shown_model() -> Model {
    let mut mesh = families::grid(24, 24, false, true);
    for (position, uv) in mesh.positions.iter_mut().zip(&mut mesh.uvs) {
        let [x, y, _] = *position;
        *position =
            [x - 0.5, y - 0.5, 0.25 * (1.0 - (2.0 * x - 1.0).powi(2)) * (1.0 - (2.0 * y - 1.0).powi(2))];
        *uv = [2.0 * uv[0], uv[1]];
    }
    let mut model = Model::new(0, SHOWN, mesh);
    model.map = dents();
    model
}

fn sheared(mut mesh: OwnedMesh) -> OwnedMesh {
    mesh.uvs.iter_mut().for_each(|uv| uv[0] += 0.4 * uv[1]);
    mesh
}

fn scaled(mut mesh: OwnedMesh, scale: f32) -> OwnedMesh {
    mesh.positions.iter_mut().for_each(|position| *position = position.map(|x| scale * x));
    mesh
}

fn flat(mut mesh: OwnedMesh) -> OwnedMesh {
    mesh.positions.iter_mut().for_each(|position| position[2] = 0.0);
    mesh.normals.fill([0.0, 0.0, 1.0]);
    mesh
}

/// Bumps along all axes and UVs that are stretched unevenly, so that every method gives other tangents.
fn wavy(mut mesh: OwnedMesh) -> OwnedMesh {
    for (position, uv) in mesh.positions.iter_mut().zip(&mut mesh.uvs) {
        let [x, y, z] = *position;
        *position = [x + 0.03 * (5.0 * y + z).sin(), y, z + 0.06 * (6.0 * x + 3.0 * y).sin()];
        uv[1] += 0.08 * (4.0 * x + 2.0 * z).sin();
    }
    mesh
}

impl Model {
    /// The mesh with smooth normals, MikkTSpace's tangents and split vertices.
    pub fn new(number: usize, name: &str, mut mesh: OwnedMesh) -> Self {
        let corners = 0..mesh.corner_count();
        mesh.indices = Some(corners.map(|corner| mesh.vertex_of_corner(corner) as u32).collect());
        // glTF's v points down.
        mesh.uvs.iter_mut().for_each(|uv| uv[1] = 1.0 - uv[1]);
        face_outwards(&mut mesh);
        smooth(&mut mesh);
        // Every second model has more UV sets, and its normal map uses the last one.
        let sets: Vec<Vec<[f32; 2]>> = (1..=number % 3).map(|set| turned(&mesh.uvs, set)).collect();
        let corners = generate_tangents(&mesh.view(), &TangentOptions::default()).corners;
        let corners = corners.converted(Convention::GLTF.generated(), Convention::GLTF);
        let split = split_vertices(&mesh.view(), &corners).expect("one tangent per corner");
        let indices = mesh.indices.clone().unwrap_or_default();
        let all_sets = || sets.iter().cloned().chain([mesh.uvs.clone()]);
        let signs: Vec<bool> = corners.per_corner().iter().map(|tangent| tangent[3] < 0.0).collect();
        let unsplit =
            (split.indices != indices && signs.contains(&true) && signs.contains(&false)).then(|| {
                let mut tangents = vec![[1.0, 0.0, 0.0, 1.0]; mesh.positions.len()];
                for (corner, &vertex) in indices.iter().enumerate() {
                    tangents[vertex as usize] = corners.per_corner()[corner];
                }
                (
                    mesh.positions.clone(),
                    mesh.normals.clone(),
                    all_sets().collect(),
                    tangents,
                    indices.clone(),
                )
            });
        let at = |vertex: &u32| *vertex as usize;
        let gathered =
            |set: Vec<[f32; 2]>| split.source_of_vertex.iter().map(|vertex| set[at(vertex)]).collect();
        Self {
            name: name.to_owned(),
            positions: split.source_of_vertex.iter().map(|vertex| mesh.positions[at(vertex)]).collect(),
            normals: Some(split.source_of_vertex.iter().map(|vertex| mesh.normals[at(vertex)]).collect()),
            uvs: all_sets().map(gathered).collect(),
            tangents: Some(split.tangent_of_vertex),
            indices: split.indices,
            unsplit,
            uv_set: sets.len(),
            has_normal_map: true,
            normal_scale: 1.0,
            transform: None,
            rotation: 0.0,
            copies: 1,
            is_skinned: number % 4 == 1,
            map: healthy_map(number),
        }
    }

    /// Whether its faces enclose a volume, up to rounding.
    pub fn is_closed(&self) -> bool {
        ["cube", "sphere"].iter().any(|solid| self.name.contains(solid))
    }

    /// The tangents.
    pub fn tangents(&mut self) -> &mut [[f32; 4]] {
        self.tangents.as_mut().expect("a healthy model has tangents")
    }

    /// The tangents of vertices that a method gives for a UV set, each from one of its corners.
    pub fn computed(&self, method: Method, set: usize) -> Vec<[f32; 4]> {
        let normals = self.normals.as_ref().expect("a healthy model has normals");
        let mesh = darboux::Mesh::triangles(&self.positions, normals, &self.uvs[set], &self.indices);
        let tangents = generate_tangents(&mesh.expect("a valid mesh"), &TangentOptions::from(method)).corners;
        let tangents = tangents.converted(Convention::GLTF.generated(), Convention::GLTF);
        let mut of_vertex = vec![[1.0, 0.0, 0.0, 1.0]; self.positions.len()];
        for (&vertex, tangent) in self.indices.iter().zip(tangents.per_corner()) {
            of_vertex[vertex as usize] = *tangent;
        }
        of_vertex
    }

    /// MikkTSpace's tangents of a grid's quads, two triangles each, which follow each other in the indices.
    pub fn computed_on_quads(&self) -> Vec<[f32; 4]> {
        let normals = self.normals.as_ref().expect("a healthy model has normals");
        let mut quads = Vec::new();
        for six in self.indices.as_chunks::<6>().0 {
            let (first, second) = (&six[..3], &six[3..]);
            let is_first = |vertex: &u32| first.contains(vertex);
            let at = (0..3).find(|&i| !second.contains(&first[i])).expect("two triangles of a quad");
            let apex = second.iter().find(|vertex| !is_first(vertex)).expect("two triangles of a quad");
            quads.push([first[at], first[(at + 1) % 3], *apex, first[(at + 2) % 3]]);
        }
        let corners = quads.as_flattened();
        let mesh = darboux::Mesh::with_faces(
            &self.positions,
            normals,
            &self.uvs[self.uv_set],
            corners,
            Faces::Quads,
        );
        let tangents = generate_tangents(&mesh.expect("a valid mesh"), &TangentOptions::default()).corners;
        let tangents = tangents.converted(Convention::GLTF.generated(), Convention::GLTF);
        let mut of_vertex = vec![[1.0, 0.0, 0.0, 1.0]; self.positions.len()];
        for (&vertex, tangent) in corners.iter().zip(tangents.per_corner()) {
            of_vertex[vertex as usize] = *tangent;
        }
        of_vertex
    }

    /// Gives the first face vertices of its own, copies of the old ones, and returns them.
    pub fn detach_first_face(&mut self) -> [usize; 3] {
        fn copy<T: Clone>(array: &mut Vec<T>, vertices: [usize; 3]) {
            vertices.into_iter().for_each(|vertex| array.push(array[vertex].clone()));
        }
        let old = [0, 1, 2].map(|corner| self.indices[corner] as usize);
        let first = self.positions.len();
        copy(&mut self.positions, old);
        self.normals.iter_mut().for_each(|normals| copy(normals, old));
        self.tangents.iter_mut().for_each(|tangents| copy(tangents, old));
        self.uvs.iter_mut().for_each(|uvs| copy(uvs, old));
        let new = [first, first + 1, first + 2];
        self.indices[..3].copy_from_slice(&new.map(|vertex| vertex as u32));
        new
    }

    /// Turns the normals over.
    pub fn negate_normals(&mut self) {
        self.normals.iter_mut().flatten().for_each(|normal| *normal = normal.map(|x| -x));
    }

    /// Negates the signs w.
    pub fn negate_signs(&mut self) {
        self.tangents().iter_mut().for_each(|tangent| tangent[3] = -tangent[3]);
    }

    /// Turns the faces over.
    pub fn turn_faces(&mut self) {
        self.indices.as_chunks_mut::<3>().0.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }

    /// Adds a copy of the surface beside it whose faces are flipped, as when a mirrored part was joined.
    pub fn add_reversed_copy(&mut self) {
        let count = self.positions.len();
        let width = self.positions.iter().fold(0.0f32, |width, position| width.max(position[0].abs()));
        self.positions.extend_from_within(..);
        self.positions[count..].iter_mut().for_each(|position| position[0] += 4.0 * width);
        self.normals.iter_mut().for_each(|normals| normals.extend_from_within(..));
        self.tangents.iter_mut().for_each(|tangents| tangents.extend_from_within(..));
        self.uvs.iter_mut().for_each(|uvs| uvs.extend_from_within(..));
        let turned = self.indices.as_chunks::<3>().0.iter().flat_map(|[a, b, c]| [a, c, b]);
        let turned: Vec<u32> = turned.map(|vertex| vertex + count as u32).collect();
        self.indices.extend(turned);
    }

    /// The model as a GLB, read.
    pub fn document(&self) -> Document {
        Document::from_bytes(&self.name, self.glb(), None, &LoadOptions::default()).expect("a valid GLB")
    }

    pub fn glb(&self) -> Vec<u8> {
        let mut writer = Writer::default();
        let mut attributes = json!({"POSITION": writer.vectors(&self.positions, "VEC3")});
        if let Some(normals) = &self.normals {
            attributes["NORMAL"] = writer.vectors(normals, "VEC3");
        }
        if let Some(tangents) = &self.tangents {
            attributes["TANGENT"] = writer.vectors(tangents, "VEC4");
        }
        for (set, uvs) in self.uvs.iter().enumerate() {
            attributes[format!("TEXCOORD_{set}")] = writer.vectors(uvs, "VEC2");
        }
        if self.is_skinned {
            let along = |position: &[f32; 3]| (position[0].abs() % 1.0).clamp(0.0, 1.0);
            let weights: Vec<[f32; 4]> =
                self.positions.iter().map(|at| [along(at), 1.0 - along(at), 0.0, 0.0]).collect();
            let joints: Vec<u8> = self.positions.iter().flat_map(|_| [0, 1, 0, 0]).collect();
            attributes["WEIGHTS_0"] = writer.vectors(&weights, "VEC4");
            attributes["JOINTS_0"] = writer.accessor(&joints, self.positions.len(), 5121, "VEC4");
        }
        let bytes: Vec<u8> = self.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let indices = writer.accessor(&bytes, self.indices.len(), 5125, "SCALAR");
        let image = writer.view(&self.map.file);
        let mut texture = json!({"index": 0, "texCoord": self.uv_set, "scale": self.normal_scale});
        if let Some(scale) = self.transform {
            texture["extensions"] =
                json!({"KHR_texture_transform": {"scale": scale, "rotation": self.rotation}});
        }
        let mut material = if self.has_normal_map { json!({"normalTexture": texture}) } else { json!({}) };
        if self.name.contains(SHOWN) {
            // Clay, on which anyone tells bumps from dents.
            let clay = json!({"baseColorFactor": [0.45, 0.31, 0.23, 1], "metallicFactor": 0, "roughnessFactor": 0.6});
            material["pbrMetallicRoughness"] = clay;
        }
        let primitive = json!({"attributes": attributes, "indices": indices, "material": 0});
        let meshes: Vec<Value> = (0..self.copies).map(|_| json!({"primitives": [primitive]})).collect();
        let mut json = json!({
            "asset": {"version": "2.0"},
            "meshes": meshes,
            "nodes": [{"mesh": 0}],
            "materials": [material],
            "textures": [{"source": 0}],
            "images": [{"bufferView": image, "mimeType": "image/png"}],
            "accessors": writer.accessors,
            "bufferViews": writer.views,
            "buffers": [{"byteLength": writer.bytes.len()}],
        });
        if self.is_skinned {
            json["nodes"] = json!([{"mesh": 0, "skin": 0}, {"translation": [0.0, 0.0, 0.1]}, {}]);
            json["skins"] = json!([{"joints": [1, 2]}]);
        }
        container(json.to_string().into_bytes(), writer.bytes)
    }
}

/// A further UV set: the first one turned and enlarged.
fn turned(uvs: &[[f32; 2]], set: usize) -> Vec<[f32; 2]> {
    let (sin, cos) = (0.7 * set as f32).sin_cos();
    let size = 1.0 + 0.2 * set as f32;
    uvs.iter().map(|[u, v]| [size * (cos * u - sin * v), size * (sin * u + cos * v)]).collect()
}

/// Turns the triangles so that they face along their normals.
fn face_outwards(mesh: &mut OwnedMesh) {
    let (positions, normals) = (&mesh.positions, &mesh.normals);
    for triangle in mesh.indices.iter_mut().flat_map(|indices| indices.as_chunks_mut::<3>().0) {
        let [a, b, c] = triangle.map(|vertex| positions[vertex as usize]);
        let [e, f] = [b, c].map(|end| [end[0] - a[0], end[1] - a[1], end[2] - a[2]]);
        let front = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
        let normal = normals[triangle[0] as usize];
        if (0..3).map(|i| front[i] * normal[i]).sum::<f32>() < 0.0 {
            triangle.swap(1, 2);
        }
    }
}

/// Gives the mesh the normals that a repair makes.
fn smooth(mesh: &mut OwnedMesh) {
    let indices = mesh.indices.clone().unwrap_or_default();
    let made = generate_normals(&mesh.positions, &indices, Faces::Triangles, &NormalOptions::default());
    let made = made.expect("a valid mesh").corners;
    for (&vertex, normal) in indices.iter().zip(made.per_corner()) {
        mesh.normals[vertex as usize] = *normal;
    }
}

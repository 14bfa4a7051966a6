//! Healthy models as glTF documents, with one normal map each.

use darboux::{Convention, TangentOptions, generate_tangents, split_vertices};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use darboux_io::image::PngImage;
use darboux_tests::maps::damage::Storage;
use darboux_tests::maps::{Background, MapCase};
use darboux_tests::{OwnedMesh, families};
use serde_json::{Value, json};

/// Positions, normals, UVs, tangents and indices.
pub type Arrays = (Vec<[f32; 3]>, Vec<[f32; 3]>, Vec<[f32; 2]>, Vec<[f32; 4]>, Vec<u32>);

/// A model that can be changed and written as a document.
#[derive(Clone)]
pub struct Model {
    pub name: &'static str,
    pub positions: Vec<[f32; 3]>,
    pub normals: Option<Vec<[f32; 3]>>,
    pub uvs: Vec<Vec<[f32; 2]>>,
    pub tangents: Option<Vec<[f32; 4]>>,
    pub indices: Vec<u32>,
    /// Where the model has mirrored seams: the vertices before the split, with the tangents of their last corners.
    pub unsplit: Option<Arrays>,
    pub uv_set: usize,
    pub has_normal_map: bool,
    /// The scale of the texture transform.
    pub transform: Option<[f32; 2]>,
    /// The number of primitives with the same data.
    pub copies: usize,
}

/// Eleven models: plain and mirrored, curved and flat, closed and open.
pub fn healthy_models() -> Vec<Model> {
    vec![
        Model::new("grid", families::grid(9, 7, false, false)),
        Model::new("large grid", families::grid(30, 20, false, false)),
        Model::new("unindexed grid", families::grid(12, 9, false, false).unindexed()),
        Model::new("mirrored grid", families::grid(16, 7, false, true)),
        Model::new("wide mirrored grid", families::grid(40, 5, false, true)),
        Model::new("tall mirrored grid", families::grid(12, 30, false, true)),
        Model::new("strip", families::strip(20)),
        Model::new("fan", families::fan(16, false)),
        Model::new("cube", families::cube(false)),
        Model::new("sheared grid", sheared(families::grid(10, 10, false, false))),
        Model::new("scaled grid", scaled(families::grid(14, 6, false, false))),
    ]
}

fn sheared(mut mesh: OwnedMesh) -> OwnedMesh {
    mesh.uvs.iter_mut().for_each(|uv| uv[0] += 0.4 * uv[1]);
    mesh
}

fn scaled(mut mesh: OwnedMesh) -> OwnedMesh {
    mesh.positions.iter_mut().for_each(|position| *position = position.map(|x| 250.0 * x));
    mesh
}

/// A plain map of bumps, half of it flat.
pub fn healthy_map() -> (MapCase, Vec<[u8; 3]>) {
    let mut case = MapCase::new(0, 256);
    case.storage = Storage::Rounded;
    case.background = Background::Padded;
    (case.charts, case.noise, case.slope, case.stretch) = (1, 0.0, 0.3, 1.0);
    let mut texels = case.texels(false);
    texels[..128 * 256].fill([128, 128, 255]);
    (case, texels)
}

/// A square PNG.
pub fn png(side: u32, texels: &[[u8; 3]]) -> Vec<u8> {
    let image = PngImage::from_rgb("map.png", [side, side], texels).expect("a square");
    image.to_bytes().expect("an image can be encoded")
}

impl Model {
    /// The mesh with MikkTSpace's tangents and split vertices.
    fn new(name: &'static str, mesh: OwnedMesh) -> Self {
        let mut mesh = OwnedMesh {
            indices: Some(
                (0..mesh.corner_count()).map(|corner| mesh.vertex_of_corner(corner) as u32).collect(),
            ),
            ..mesh
        };
        // glTF's v points down.
        mesh.uvs.iter_mut().for_each(|uv| uv[1] = 1.0 - uv[1]);
        face_outwards(&mut mesh);
        let corners = generate_tangents(&mesh.view(), &TangentOptions::default()).corners;
        let corners = corners.converted(Convention::GLTF.generated(), Convention::GLTF);
        let split = split_vertices(&mesh.view(), &corners).expect("one tangent per corner");
        let indices = mesh.indices.clone().unwrap_or_default();
        let is_mirrored = {
            let signs: Vec<bool> = corners.per_corner().iter().map(|tangent| tangent[3] < 0.0).collect();
            signs.contains(&true) && signs.contains(&false)
        };
        let unsplit = is_mirrored.then(|| {
            let mut tangents = vec![[1.0, 0.0, 0.0, 1.0]; mesh.positions.len()];
            for (corner, &vertex) in indices.iter().enumerate() {
                tangents[vertex as usize] = corners.per_corner()[corner];
            }
            (mesh.positions.clone(), mesh.normals.clone(), mesh.uvs.clone(), tangents, indices.clone())
        });
        let source = |vertex: &u32| *vertex as usize;
        Self {
            name,
            positions: split.source_of_vertex.iter().map(|vertex| mesh.positions[source(vertex)]).collect(),
            normals: Some(split.source_of_vertex.iter().map(|vertex| mesh.normals[source(vertex)]).collect()),
            uvs: vec![split.source_of_vertex.iter().map(|vertex| mesh.uvs[source(vertex)]).collect()],
            tangents: Some(split.tangent_of_vertex),
            indices: split.indices,
            unsplit,
            uv_set: 0,
            has_normal_map: true,
            transform: None,
            copies: 1,
        }
    }

    /// The tangents.
    pub fn tangents(&mut self) -> &mut [[f32; 4]] {
        self.tangents.as_mut().expect("a healthy model has tangents")
    }

    /// The model as a GLB, read.
    pub fn document(&self) -> Document {
        Document::from_bytes(self.name, self.glb(), None, &LoadOptions::default()).expect("a valid GLB")
    }

    fn glb(&self) -> Vec<u8> {
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
        let bytes: Vec<u8> = self.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let indices = writer.accessor(&bytes, self.indices.len(), 5125, "SCALAR");
        let (case, texels) = healthy_map();
        let image = writer.view(&png(case.side as u32, &texels));
        let mut texture = json!({"index": 0, "texCoord": self.uv_set});
        if let Some(scale) = self.transform {
            texture["extensions"] = json!({"KHR_texture_transform": {"scale": scale}});
        }
        let material = if self.has_normal_map { json!({"normalTexture": texture}) } else { json!({}) };
        let primitive = json!({"attributes": attributes, "indices": indices, "material": 0});
        let meshes: Vec<Value> = (0..self.copies).map(|_| json!({"primitives": [primitive]})).collect();
        let json = json!({
            "asset": {"version": "2.0"},
            "meshes": meshes,
            "materials": [material],
            "textures": [{"source": 0}],
            "images": [{"bufferView": image, "mimeType": "image/png"}],
            "accessors": writer.accessors,
            "bufferViews": writer.views,
            "buffers": [{"byteLength": writer.bytes.len()}],
        });
        container(json.to_string().into_bytes(), writer.bytes)
    }
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

/// The buffer of a document, and what lies in it.
#[derive(Default)]
struct Writer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Writer {
    fn view(&mut self, bytes: &[u8]) -> Value {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend(bytes);
        json!(self.views.len() - 1)
    }

    fn accessor(&mut self, bytes: &[u8], count: usize, component: u32, element: &str) -> Value {
        let view = self.view(bytes);
        self.accessors
            .push(json!({"bufferView": view, "componentType": component, "count": count, "type": element}));
        json!(self.accessors.len() - 1)
    }

    fn vectors<const N: usize>(&mut self, vectors: &[[f32; N]], element: &str) -> Value {
        let bytes: Vec<u8> = vectors.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(&bytes, vectors.len(), 5126, element)
    }
}

/// A GLB (glTF 2.0, 4.4).
fn container(mut json: Vec<u8>, mut bytes: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let word = |number: usize| (number as u32).to_le_bytes();
    let total = 12 + 8 + json.len() + 8 + bytes.len();
    let header = [b"glTF".as_slice(), &word(2), &word(total)].concat();
    let chunks = [&word(json.len()), b"JSON".as_slice(), &json, &word(bytes.len()), b"BIN\0", &bytes];
    [header, chunks.concat()].concat()
}

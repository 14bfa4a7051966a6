//! Builds tiny documents, and reads results with an independent crate.
#![allow(dead_code, reason = "every test binary uses its own part")]

use darboux::{Convention, Mesh, TangentOptions, generate_tangents};
use darboux_io::gltf::{
    AddTangentsOptions, Document, TangentsOutcome, TangentsSummary, WrittenTangents, add_tangents,
};
use darboux_io::{Error, LoadOptions};
use serde_json::{Value, json};

/// A document in the making: one buffer, a buffer view per accessor.
pub struct Builder {
    json: Value,
    bytes: Vec<u8>,
}

impl Builder {
    pub fn new() -> Self {
        let json = json!({
            "asset": {"version": "2.0"},
            "buffers": [], "bufferViews": [], "accessors": [], "materials": [], "meshes": [],
            "textures": [{"source": 0}], "images": [{"uri": "data:image/png;base64,AAAA"}],
        });
        Self { json, bytes: Vec::new() }
    }

    fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    /// An accessor with `more` members over tightly packed `bytes`.
    pub fn accessor(&mut self, bytes: &[u8], count: usize, component: u32, kind: &str, more: Value) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        self.bytes.extend(bytes);
        let view = self.push("bufferViews", view);
        let mut accessor =
            json!({"bufferView": view, "componentType": component, "count": count, "type": kind});
        accessor.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        self.push("accessors", accessor)
    }

    /// A copy of an accessor, over the same bytes, with other members.
    pub fn alias(&mut self, accessor: usize, members: Value) -> usize {
        let mut alias = self.json["accessors"][accessor].clone();
        alias.as_object_mut().unwrap().extend(members.as_object().unwrap().clone());
        self.push("accessors", alias)
    }

    /// An accessor of floats without a buffer view, with `more` members.
    pub fn zeros(&mut self, count: usize, kind: &str, more: Value) -> usize {
        let mut accessor = json!({"componentType": 5126, "count": count, "type": kind});
        accessor.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        self.push("accessors", accessor)
    }

    pub fn vectors<const N: usize>(&mut self, vectors: &[[f32; N]]) -> usize {
        let bytes: Vec<_> = vectors.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        let bound = |f: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..N).map(|i| vectors.iter().map(|v| v[i]).reduce(f).unwrap()).collect()
        };
        self.accessor(
            &bytes,
            vectors.len(),
            5126,
            kind,
            json!({"min": bound(f32::min), "max": bound(f32::max)}),
        )
    }

    pub fn indices(&mut self, indices: &[u16]) -> usize {
        let bytes: Vec<_> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        self.accessor(&bytes, indices.len(), 5123, "SCALAR", json!({}))
    }

    pub fn material(&mut self, material: Value) -> usize {
        self.push("materials", material)
    }

    /// A mesh with these primitives.
    pub fn mesh(&mut self, primitives: &[Value]) -> usize {
        self.push("meshes", json!({"primitives": primitives}))
    }

    /// Sets a member at the top.
    pub fn set(&mut self, key: &str, value: Value) {
        self.json[key] = value;
    }

    pub fn build(self) -> Document {
        self.read(&LoadOptions::default()).unwrap()
    }

    /// Reads the document.
    pub fn read(mut self, options: &LoadOptions) -> Result<Document, Error> {
        use base64::Engine;
        let data = base64::engine::general_purpose::STANDARD.encode(&self.bytes);
        let uri = format!("data:application/octet-stream;base64,{data}");
        self.json["buffers"] = json!([{"byteLength": self.bytes.len(), "uri": uri}]);
        let text = self.json.to_string().into_bytes();
        Document::from_bytes("test.gltf", text, None, options)
    }
}

/// Vertices of a test mesh.
#[derive(Clone)]
pub struct Vertices {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub uvs: Vec<[f32; 2]>,
}

impl Vertices {
    /// Adds accessors for them. Returns the attributes.
    pub fn attributes(&self, builder: &mut Builder) -> Value {
        json!({
            "POSITION": builder.vectors(&self.positions),
            "NORMAL": builder.vectors(&self.normals),
            "TEXCOORD_0": builder.vectors(&self.uvs),
        })
    }

    /// What glTF's tangents of these corners must be.
    pub fn expected(&self, corners: &[u32]) -> Vec<[f32; 4]> {
        let mesh =
            Mesh::triangles(&self.positions, &self.normals, &self.uvs, &corners.to_vec()).map(|mesh| {
                let tangents = generate_tangents(&mesh, &TangentOptions::default());
                tangents.corners.converted(Convention::GLTF.generated(), Convention::GLTF).into_per_corner()
            });
        mesh.unwrap()
    }
}

/// A square in the plane of x and y, its texture upright: u to the right, v down.
pub fn square() -> Vertices {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let uvs = positions.iter().map(|p: &[f32; 3]| [p[0], 1.0 - p[1]]).collect();
    Vertices { normals: vec![[0.0, 0.0, 1.0]; 4], positions, uvs }
}

pub const SQUARE: [u16; 6] = [0, 1, 2, 0, 2, 3];

/// Two squares side by side whose textures mirror each other: the vertices 1 and 4 of the seam must be split.
pub fn butterfly() -> Vertices {
    let positions: Vec<_> = [0.0, 1.0].iter().flat_map(|&y| [-1.0, 0.0, 1.0].map(|x| [x, y, 0.0])).collect();
    let uvs = positions.iter().map(|p: &[f32; 3]| [p[0].abs(), 1.0 - p[1]]).collect();
    Vertices { normals: vec![[0.0, 0.0, 1.0]; 6], positions, uvs }
}

pub const LEFT: [u16; 6] = [0, 1, 4, 0, 4, 3];
pub const RIGHT: [u16; 6] = [1, 2, 5, 1, 5, 4];
pub const BOTH: [u16; 12] = [0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4];

/// A GLB (glTF 2.0, 4.4).
pub fn glb(json: &str, data: &[u8]) -> Vec<u8> {
    let pad = |bytes: &[u8], padding: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), padding);
        bytes
    };
    let (json, data) = (pad(json.as_bytes(), b' '), pad(data, 0));
    let word = |number: usize| (number as u32).to_le_bytes();
    let header = [b"glTF".as_slice(), &word(2), &word(28 + json.len() + data.len())].concat();
    let chunks = [&word(json.len()), b"JSON".as_slice(), &json, &word(data.len()), b"BIN\0", &data];
    [header, chunks.concat()].concat()
}

pub fn wide(indices: &[u16]) -> Vec<u32> {
    indices.iter().map(|&index| index.into()).collect()
}

/// Adds tangents with the default options.
pub fn run(document: &mut Document) -> TangentsSummary {
    run_with(document, &AddTangentsOptions::default())
}

pub fn run_with(document: &mut Document, options: &AddTangentsOptions) -> TangentsSummary {
    add_tangents(document, options, &mut |_| {}).unwrap()
}

/// What was written for the primitive at `place`.
pub fn written(summary: &TangentsSummary, place: usize) -> &WrittenTangents {
    match &summary.primitives[place].outcome {
        TangentsOutcome::Written(written) => written,
        other => panic!("not written: {other:?}"),
    }
}

/// Why the primitive at `place` was not written.
pub fn reason(summary: &TangentsSummary, place: usize) -> &str {
    match &summary.primitives[place].outcome {
        TangentsOutcome::Kept { reason } | TangentsOutcome::Skipped { reason } => reason,
        other => panic!("written: {other:?}"),
    }
}

/// A document as the `gltf` crate reads it: validated, and with every byte in reach.
pub struct Reread {
    pub gltf: gltf::Gltf,
    blob: Vec<u8>,
}

/// Writes a document as GLB and reads that with the `gltf` crate.
pub fn reread(document: &Document) -> Reread {
    let gltf = gltf::Gltf::from_slice(&document.to_glb().unwrap()).unwrap();
    assert_eq!(gltf.buffers().len(), 1, "a GLB has one buffer");
    Reread { blob: gltf.blob.clone().unwrap(), gltf }
}

impl Reread {
    pub fn primitive(&self, mesh: usize, place: usize) -> gltf::Primitive<'_> {
        self.gltf.meshes().nth(mesh).unwrap().primitives().nth(place).unwrap()
    }

    pub fn reader<'a, 's>(
        &'s self,
        primitive: &'a gltf::Primitive<'a>,
    ) -> gltf::mesh::Reader<'a, 's, impl Clone + Fn(gltf::Buffer<'a>) -> Option<&'s [u8]>> {
        primitive.reader(|_| Some(self.blob.as_slice()))
    }

    /// The vertex of every corner, in the order of the file.
    pub fn indices(&self, mesh: usize, place: usize) -> Vec<u32> {
        let primitive = self.primitive(mesh, place);
        let reader = self.reader(&primitive);
        match reader.read_indices() {
            Some(indices) => indices.into_u32().collect(),
            None => (0..reader.read_positions().unwrap().len() as u32).collect(),
        }
    }

    pub fn tangents(&self, mesh: usize, place: usize) -> Vec<[f32; 4]> {
        let primitive = self.primitive(mesh, place);
        self.reader(&primitive).read_tangents().unwrap().collect()
    }

    /// The tangent of every corner, in the order of the file.
    pub fn corner_tangents(&self, mesh: usize, place: usize) -> Vec<[f32; 4]> {
        let tangents = self.tangents(mesh, place);
        self.indices(mesh, place).iter().map(|&vertex| tangents[vertex as usize]).collect()
    }

    /// The bytes of every element of an attribute, strides resolved, as sparse accessors never occur here.
    pub fn elements(&self, accessor: &gltf::Accessor<'_>) -> Vec<Vec<u8>> {
        let view = accessor.view().unwrap();
        let (size, start) = (accessor.size(), view.offset() + accessor.offset());
        let stride = view.stride().unwrap_or(size);
        (0..accessor.count())
            .map(|i| self.blob[start + i * stride..start + i * stride + size].to_vec())
            .collect()
    }
}

//! Small models, built part by part.

use serde_json::{Value, json};

use super::glb;

/// The buffer of a model and what describes it.
#[derive(Default)]
pub struct Builder {
    pub data: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl Builder {
    /// Adds a buffer view. Returns its index, as the others do.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.data.len(), "byteLength": bytes.len() }));
        self.data.extend(bytes);
        self.views.len() - 1
    }

    pub fn floats(&mut self, values: &[f32], kind: &str, count: usize) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessor(json!({ "bufferView": view, "componentType": 5126, "count": count, "type": kind }))
    }

    pub fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// A square with tangents whose signs are flipped.
    pub fn square(&mut self) -> Value {
        let corners = [[0.0f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let of =
            |vector: fn([f32; 2]) -> Vec<f32>| corners.into_iter().flat_map(vector).collect::<Vec<f32>>();
        let attributes = json!({
            "POSITION": self.floats(&of(|[x, y]| vec![x, y, 0.0]), "VEC3", 4),
            "NORMAL": self.floats(&of(|_| vec![0.0, 0.0, 1.0]), "VEC3", 4),
            "TEXCOORD_0": self.floats(&of(|[x, y]| vec![x, 1.0 - y]), "VEC2", 4),
            "TANGENT": self.floats(&of(|_| vec![1.0, 0.0, 0.0, -1.0]), "VEC4", 4),
        });
        json!({ "attributes": attributes, "indices": self.indices(&[0, 1, 2, 0, 2, 3]) })
    }

    pub fn indices(&mut self, indices: &[u32]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessor(
            json!({ "bufferView": view, "componentType": 5125, "count": indices.len(), "type": "SCALAR" }),
        )
    }

    /// The file with these members.
    pub fn glb(self, members: Value) -> Vec<u8> {
        let mut json = json!({
            "asset": { "version": "2.0" },
            "buffers": [{ "byteLength": self.data.len() }],
            "bufferViews": self.views,
            "accessors": self.accessors,
        });
        let members = members.as_object().expect("members").clone();
        json.as_object_mut().expect("an object").extend(members);
        glb(&json, &self.data)
    }
}

/// Vertices in four bytes each, which are position, normal, tangent and UV, and triangles of a primitive
/// each.
pub struct SharedBytes {
    pub vertices: usize,
    pub primitives: usize,
    /// Whether each primitive has UVs of its own, which begin one vertex later.
    pub own_uvs: bool,
    /// Whether positions are stored apart for one vertex.
    pub is_sparse: bool,
    pub nodes: usize,
    /// Whether each primitive is in a mesh of its own.
    pub own_meshes: bool,
}

impl SharedBytes {
    pub fn file(&self) -> Vec<u8> {
        let Self { vertices, primitives, .. } = *self;
        let mut builder = Builder::default();
        let mut random = 1u32;
        let mut byte = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 24) as u8
        };
        let bytes: Vec<u8> = (0..4 * (vertices + primitives)).map(|_| byte()).collect();
        let view = builder.view(&bytes);
        builder.views[view]["byteStride"] = json!(4);
        let (one, other) = (builder.view(&7u32.to_le_bytes()), builder.view(&[9, 9, 9, 0]));
        let mut accessor = |kind: &str, component: u32, first: usize| {
            let mut accessor = json!({ "bufferView": view, "byteOffset": 4 * first, "componentType": component,
                "normalized": true, "count": vertices, "type": kind });
            if self.is_sparse && kind == "VEC3" && component == 5121 {
                accessor["sparse"] = json!({ "count": 1, "indices": { "bufferView": one, "componentType": 5125 },
                    "values": { "bufferView": other } });
            }
            builder.accessor(accessor)
        };
        let (position, normal) = (accessor("VEC3", 5121, 0), accessor("VEC3", 5120, 0));
        let tangent = accessor("VEC4", 5120, 0);
        let sets = if self.own_uvs { primitives } else { 1 };
        let uvs: Vec<usize> = (0..sets).map(|first| accessor("VEC2", 5121, first)).collect();
        let primitive = |i: usize| {
            let first = (5 * i) as u32;
            json!({
                "attributes": { "POSITION": position, "NORMAL": normal, "TANGENT": tangent, "TEXCOORD_0": uvs[i % sets] },
                "indices": builder.indices(&[first, first + 1, vertices as u32 - 1]),
            })
        };
        let primitives: Vec<Value> = (0..primitives).map(primitive).collect();
        let meshes = if self.own_meshes { primitives.chunks(1).collect() } else { vec![&primitives[..]] };
        let meshes: Vec<Value> = meshes.into_iter().map(|mesh| json!({ "primitives": mesh })).collect();
        builder.glb(json!({
            "extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"],
            "meshes": meshes,
            "nodes": vec![json!({ "mesh": 0 }); self.nodes],
        }))
    }
}

//! Builds small glTF models, and puts JSON and binary data into a GLB.

use serde_json::{Map, Value, json};

/// The buffer of a model and what describes it.
#[derive(Default)]
pub struct Builder {
    pub data: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

/// The arrays of a mesh of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub uvs: Vec<[f32; 2]>,
    pub indices: Vec<u32>,
}

impl Builder {
    /// Adds bytes as a buffer view and returns its index.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.data.resize(self.data.len().next_multiple_of(4), 0);
        self.views.push(json!({ "buffer": 0, "byteOffset": self.data.len(), "byteLength": bytes.len() }));
        self.data.extend_from_slice(bytes);
        self.views.len() - 1
    }

    /// Adds an accessor of vectors with `N` floats.
    pub fn vectors<const N: usize>(&mut self, vectors: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = vectors.as_flattened().iter().flat_map(|float| float.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        self.accessor(
            json!({ "bufferView": view, "componentType": 5126, "count": vectors.len(), "type": kind }),
        )
    }

    /// Adds an accessor of indices with 32 bits.
    pub fn indices(&mut self, indices: &[u32]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessor(
            json!({ "bufferView": view, "componentType": 5125, "count": indices.len(), "type": "SCALAR" }),
        )
    }

    /// Adds any accessor and returns its index.
    pub fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds a mesh's arrays and returns a primitive.
    pub fn primitive(&mut self, mesh: &Mesh) -> Value {
        let attributes = json!({
            "POSITION": self.vectors(&mesh.positions),
            "NORMAL": self.vectors(&mesh.normals),
            "TEXCOORD_0": self.vectors(&mesh.uvs),
        });
        json!({ "attributes": attributes, "indices": self.indices(&mesh.indices) })
    }

    /// The document with these primitives as one mesh in one node.
    pub fn document(&self, primitives: Vec<Value>) -> Value {
        json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0 }],
            "meshes": [{ "name": "made", "primitives": primitives }],
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.data.len() }],
        })
    }

    /// The document as a GLB, with further members.
    pub fn glb(&self, primitives: Vec<Value>, members: Value) -> Vec<u8> {
        let mut document = self.document(primitives);
        if let (Some(document), Value::Object(members)) = (document.as_object_mut(), members) {
            document.extend(members);
        }
        glb(document.to_string().as_bytes(), &self.data)
    }
}

impl Mesh {
    /// A square of two triangles with UVs from 0 to `uv_size`.
    pub fn square(uv_size: f32) -> Self {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        Self {
            positions: corners.map(|[x, y]| [x, y, 0.0]).into(),
            normals: vec![[0.0, 0.0, 1.0]; 4],
            uvs: corners.map(|[u, v]| [u * uv_size, v * uv_size]).into(),
            indices: vec![0, 1, 2, 0, 2, 3],
        }
    }

    /// A grid of `side` by `side` squares.
    pub fn grid(side: u32) -> Self {
        let at = |index: u32| index as f32 / side as f32;
        let places: Vec<_> = (0..=side).flat_map(|y| (0..=side).map(move |x| (x, y))).collect();
        let squares = (0..side).flat_map(|y| (0..side).map(move |x| y * (side + 1) + x));
        Self {
            positions: places.iter().map(|&(x, y)| [at(x), at(y), 0.02 * ((x + 3 * y) % 5) as f32]).collect(),
            normals: vec![[0.0, 0.0, 1.0]; places.len()],
            uvs: places.iter().map(|&(x, y)| [at(x), at(y)]).collect(),
            indices: squares.flat_map(|a| [a, a + 1, a + side + 2, a, a + side + 2, a + side + 1]).collect(),
        }
    }

    /// The model of this mesh alone.
    pub fn glb(&self) -> Vec<u8> {
        let mut builder = Builder::default();
        let primitive = builder.primitive(self);
        builder.glb(vec![primitive], Value::Null)
    }
}

/// Puts JSON and binary data into a GLB.
pub fn glb(json: &[u8], data: &[u8]) -> Vec<u8> {
    let mut chunks = chunk(b"JSON", json, b' ');
    if !data.is_empty() {
        chunks.extend(chunk(b"BIN\0", data, 0));
    }
    [b"glTF", &2u32.to_le_bytes()[..], &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat()
}

fn chunk(kind: &[u8; 4], content: &[u8], padding: u8) -> Vec<u8> {
    let length = content.len().next_multiple_of(4);
    let mut bytes = [&(length as u32).to_le_bytes()[..], kind, content].concat();
    bytes.resize(8 + length, padding);
    bytes
}

/// The JSON and the binary data of a GLB; `None` for other files.
pub fn split_glb(bytes: &[u8]) -> Option<(Map<String, Value>, Vec<u8>)> {
    let length = u32::from_le_bytes(bytes.get(12..16)?.try_into().ok()?) as usize;
    let json = serde_json::from_slice(bytes.get(20..20 + length)?).ok()?;
    Some((json, bytes.get(28 + length..).unwrap_or_default().to_vec()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_glb_is_split_into_what_it_was_made_of() {
        let mut builder = Builder::default();
        let primitive = builder.primitive(&Mesh::square(1.0));
        let bytes = builder.glb(vec![primitive], json!({ "materials": [] }));
        assert_eq!(bytes.len() as u32, u32::from_le_bytes(bytes[8..12].try_into().expect("four bytes")));
        let (json, data) = split_glb(&bytes).expect("a GLB");
        assert_eq!((data, json["materials"].clone()), (builder.data, json!([])));
        assert_eq!(json["accessors"][3]["count"], 6);
    }
}

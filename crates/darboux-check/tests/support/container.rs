//! Writes GLB files.

use serde_json::{Value, json};

/// The buffer of a document, and what lies in it.
#[derive(Default)]
pub struct Writer {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl Writer {
    pub fn view(&mut self, bytes: &[u8]) -> Value {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend(bytes);
        json!(self.views.len() - 1)
    }

    pub fn accessor(&mut self, bytes: &[u8], count: usize, component: u32, element: &str) -> Value {
        let view = self.view(bytes);
        self.accessors
            .push(json!({"bufferView": view, "componentType": component, "count": count, "type": element}));
        json!(self.accessors.len() - 1)
    }

    pub fn vectors<const N: usize>(&mut self, vectors: &[[f32; N]], element: &str) -> Value {
        let bytes: Vec<u8> = vectors.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(&bytes, vectors.len(), 5126, element)
    }
}

/// A GLB (glTF 2.0, 4.4).
pub fn container(mut json: Vec<u8>, mut bytes: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let word = |number: usize| (number as u32).to_le_bytes();
    let total = 12 + 8 + json.len() + 8 + bytes.len();
    let header = [b"glTF".as_slice(), &word(2), &word(total)].concat();
    let chunks = [&word(json.len()), b"JSON".as_slice(), &json, &word(bytes.len()), b"BIN\0", &bytes];
    [header, chunks.concat()].concat()
}

/// A GLB with a further accessor of vectors; its index is returned.
pub fn with_vectors<const N: usize>(glb: &[u8], vectors: &[[f32; N]], element: &str) -> (Vec<u8>, usize) {
    with_more(glb, |writer| writer.vectors(vectors, element))
}

/// A GLB with further bytes; the index of their buffer view is returned.
pub fn with_view(glb: &[u8], bytes: &[u8]) -> (Vec<u8>, usize) {
    with_more(glb, |writer| writer.view(bytes))
}

/// A GLB with more in its buffer; the index of that is returned.
fn with_more(glb: &[u8], write: impl FnOnce(&mut Writer) -> Value) -> (Vec<u8>, usize) {
    let length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
    let mut json: Value = serde_json::from_slice(&glb[20..20 + length]).expect("JSON");
    let list = |name: &str| json[name].as_array().cloned().unwrap_or_default();
    let mut writer = Writer {
        bytes: glb[28 + length..].to_vec(),
        views: list("bufferViews"),
        accessors: list("accessors"),
    };
    let index = write(&mut writer).as_u64().expect("an index") as usize;
    json["bufferViews"] = Value::Array(writer.views);
    json["accessors"] = Value::Array(writer.accessors);
    json["buffers"] = json!([{"byteLength": writer.bytes.len()}]);
    (container(serde_json::to_vec(&json).expect("JSON"), writer.bytes), index)
}

/// A GLB with another JSON.
pub fn with_json(glb: &[u8], edit: impl FnOnce(&mut Value)) -> Vec<u8> {
    let length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
    let mut json = serde_json::from_slice(&glb[20..20 + length]).expect("JSON");
    edit(&mut json);
    container(serde_json::to_vec(&json).expect("JSON"), glb[28 + length..].to_vec())
}

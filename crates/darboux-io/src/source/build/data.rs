//! The binary chunk of a document, its buffer views and accessors.

use serde_json::{Value, json};

use crate::error::ContentError;
use crate::gltf::segments::{self, Segment};
use crate::gltf::{ComponentType, ElementType, container};

/// Room for the head of the GLB before the binary chunk, so that the chunk need not be copied behind it. The
/// JSON of most models is shorter.
const ROOM: usize = 1 << 16;

/// The binary chunk while it grows.
#[derive(Debug)]
pub struct DataBuilder {
    /// The room, then the chunk.
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Default for DataBuilder {
    fn default() -> Self {
        Self { bytes: vec![0; ROOM], views: Vec::new(), accessors: Vec::new() }
    }
}

impl DataBuilder {
    /// Adds an accessor of vectors. Returns its index.
    pub fn vectors<const N: usize>(&mut self, vectors: &[[f32; N]]) -> usize {
        const KINDS: [ElementType; 3] = [ElementType::Vec2, ElementType::Vec3, ElementType::Vec4];
        self.accessor(
            bytemuck::cast_slice(vectors.as_flattened()),
            ComponentType::F32,
            vectors.len(),
            KINDS[N - 2],
        )
    }

    /// Adds an accessor of positions, with the bounds that glTF requires.
    pub fn positions(&mut self, positions: &[[f32; 3]]) -> usize {
        let accessor = self.vectors(positions);
        let (mut least, mut greatest) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for position in positions {
            for axis in 0..3 {
                least[axis] = position[axis].min(least[axis]);
                greatest[axis] = position[axis].max(greatest[axis]);
            }
        }
        if least.iter().chain(&greatest).all(|x| x.is_finite()) {
            self.accessors[accessor]["min"] = json!(least);
            self.accessors[accessor]["max"] = json!(greatest);
        }
        accessor
    }

    /// Adds an accessor of matrices.
    pub fn matrices(&mut self, matrices: &[[[f32; 4]; 4]]) -> usize {
        let floats = matrices.as_flattened().as_flattened();
        self.accessor(bytemuck::cast_slice(floats), ComponentType::F32, matrices.len(), ElementType::Mat4)
    }

    /// Adds an accessor of joints.
    pub fn joints(&mut self, joints: &[[u16; 4]]) -> usize {
        self.accessor(
            bytemuck::cast_slice(joints.as_flattened()),
            ComponentType::U16,
            joints.len(),
            ElementType::Vec4,
        )
    }

    /// Adds an index list.
    pub fn indices(&mut self, indices: &[u32]) -> usize {
        self.accessor(bytemuck::cast_slice(indices), ComponentType::U32, indices.len(), ElementType::Scalar)
    }

    /// Adds an accessor. The numbers of this machine are little-endian, or are turned here.
    fn accessor(&mut self, bytes: &[u8], component: ComponentType, count: usize, kind: ElementType) -> usize {
        let view = self.view(bytes);
        if cfg!(target_endian = "big") {
            let start = self.bytes.len() - bytes.len();
            self.bytes[start..].chunks_exact_mut(component.size()).for_each(<[u8]>::reverse);
        }
        let (component, kind) = (component.code(), kind.name());
        self.accessors
            .push(json!({"bufferView": view, "componentType": component, "count": count, "type": kind}));
        self.accessors.len() - 1
    }

    /// Adds a buffer view.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views
            .push(json!({"buffer": 0, "byteOffset": self.bytes.len() - ROOM, "byteLength": bytes.len()}));
        self.bytes.extend_from_slice(bytes);
        self.views.len() - 1
    }

    /// Adds the lists to the JSON and makes the GLB. Returns its bytes and where in them it begins.
    ///
    /// Errors: more than the 4 GiB that a GLB can hold.
    pub fn finish(mut self, mut root: Value) -> Result<(Vec<u8>, usize), ContentError> {
        // glTF has no empty lists and no empty buffers.
        if self.bytes.len() > ROOM {
            root["accessors"] = self.accessors.into();
            root["bufferViews"] = self.views.into();
            root["buffers"] = json!([{"byteLength": self.bytes.len() - ROOM}]);
        }
        let chunk = vec![Segment::Borrowed(&self.bytes[ROOM..])];
        let parts = container::glb(root.to_string().into_bytes(), Some(chunk), Vec::new())?;
        // The last two are the chunk and its padding.
        let head = segments::joined(&parts[..parts.len() - 2]);
        let Some(start) = ROOM.checked_sub(head.len()) else { return Ok((segments::joined(&parts), 0)) };
        let padding = parts[parts.len() - 1].len();
        drop(parts);
        self.bytes[start..ROOM].copy_from_slice(&head);
        self.bytes.resize(self.bytes.len() + padding, 0);
        Ok((self.bytes, start))
    }
}

//! `--write-cage`: the cage as a GLB with the vertices and triangles of the low model, which `--cage` and
//! modelling programs read.

use std::path::Path;

use darboux_bake::LowSurface;
use darboux_io::Outputs;
use serde_json::{Value, json};

use super::arguments::BakeArguments;

/// Stages the cage and returns its path; none if it was not asked for. `names`: of the surfaces. Errors are
/// one sentence each.
pub fn stage_cage<'n>(
    arguments: &BakeArguments,
    low: &[LowSurface<'_>],
    names: impl Iterator<Item = &'n str>,
    cages: &[Vec<[f32; 3]>],
    outputs: &mut Outputs,
) -> Result<Option<String>, String> {
    let Some(path) = &arguments.write_cage else { return Ok(None) };
    let bytes = glb(low, names, cages);
    outputs.stage_bytes(path, &bytes, &arguments.save_options(path)).map_err(|error| error.to_string())?;
    Ok(Some(path.display().to_string()))
}

/// Whether a path can be a cage's.
pub fn is_glb(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb"))
}

fn glb<'n>(low: &[LowSurface<'_>], names: impl Iterator<Item = &'n str>, cages: &[Vec<[f32; 3]>]) -> Vec<u8> {
    let mut file = File::default();
    for ((surface, name), cage) in low.iter().zip(names).zip(cages) {
        file.add(surface, name, cage);
    }
    file.into_bytes()
}

/// The parts of a GLB with one node, one mesh and one primitive per surface.
#[derive(Default)]
struct File {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
}

impl File {
    fn add(&mut self, surface: &LowSurface<'_>, name: &str, cage: &[[f32; 3]]) {
        let extreme = |pick: fn(f32, f32) -> f32, start: f32| {
            [0, 1, 2].map(|axis| cage.iter().map(|place| place[axis]).fold(start, pick))
        };
        let (least, most) = (extreme(f32::min, f32::INFINITY), extreme(f32::max, f32::NEG_INFINITY));
        let positions = cage.as_flattened().iter().flat_map(|x| x.to_le_bytes());
        let positions = self.view(positions.collect());
        let mesh = surface.mesh();
        let corners = (0..mesh.corner_count()).map(|corner| mesh.vertex_of_corner(corner) as u32);
        let indices = self.view(corners.flat_map(u32::to_le_bytes).collect());
        let first = self.accessors.len();
        self.accessors.push(json!({
            "bufferView": positions, "componentType": 5126, "count": cage.len(), "type": "VEC3", "min": least, "max": most,
        }));
        self.accessors.push(json!({
            "bufferView": indices, "componentType": 5125, "count": mesh.corner_count(), "type": "SCALAR",
        }));
        let primitive = json!({"attributes": {"POSITION": first}, "indices": first + 1});
        let name = format!("{name}_cage");
        self.meshes.push(json!({"name": name, "primitives": [primitive]}));
        self.nodes.push(json!({"name": name, "mesh": self.nodes.len()}));
    }

    fn view(&mut self, bytes: Vec<u8>) -> usize {
        self.views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend(bytes);
        self.views.len() - 1
    }

    fn into_bytes(self) -> Vec<u8> {
        let Self { bytes, views, accessors, meshes, nodes } = self;
        let json = json!({
            "asset": {"version": "2.0", "generator": "Darboux"},
            "scene": 0,
            "scenes": [{"nodes": (0..nodes.len()).collect::<Vec<_>>()}],
            "nodes": nodes,
            "meshes": meshes,
            "accessors": accessors,
            "bufferViews": views,
            "buffers": [{"byteLength": bytes.len()}],
        });
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut file = b"glTF\x02\0\0\0".to_vec();
        file.extend(((28 + text.len() + bytes.len()) as u32).to_le_bytes());
        for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &bytes)] {
            file.extend((chunk.len() as u32).to_le_bytes());
            file.extend(kind);
            file.extend(chunk);
        }
        file
    }
}

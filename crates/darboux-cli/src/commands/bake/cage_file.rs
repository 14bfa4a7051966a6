//! `--write-cage`: the cage as a GLB with the vertices and triangles of the low model, which `--cage` and
//! modelling programs read.

use std::path::Path;

use darboux_bake::LowSurface;
use darboux_io::gltf::{ComponentType, Document, ElementType, Elements, NewAccessor, Target};
use darboux_io::{Error, LoadOptions, Outputs};
use serde_json::json;

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
    let staged = document(low, names, cages)
        .and_then(|document| document.stage(path, &arguments.save_options(path), outputs));
    staged.map_err(|error| error.to_string())?;
    Ok(Some(path.display().to_string()))
}

/// Whether a path can be a cage's.
pub fn is_glb(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb"))
}

/// A document with one node, one mesh and one primitive per surface.
fn document<'n>(
    low: &[LowSurface<'_>],
    names: impl Iterator<Item = &'n str>,
    cages: &[Vec<[f32; 3]>],
) -> Result<Document, Error> {
    let names: Vec<String> = names.take(low.len()).map(|name| format!("{name}_cage")).collect();
    let node = |(mesh, name)| json!({"name": name, "mesh": mesh});
    let json = json!({
        "asset": {"version": "2.0", "generator": "Darboux"},
        "scene": 0,
        "scenes": [{"nodes": (0..names.len()).collect::<Vec<_>>()}],
        "nodes": names.iter().enumerate().map(node).collect::<Vec<_>>(),
        "meshes": names.iter().map(|name| json!({"name": name, "primitives": [{"attributes": {}}]})).collect::<Vec<_>>(),
    });
    let options = LoadOptions::default();
    let mut document = Document::from_bytes("the cage", json.to_string().into_bytes(), None, &options)?;
    for (index, (surface, cage)) in low.iter().zip(cages).enumerate() {
        let elements = Elements {
            bytes: cage.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect(),
            count: cage.len(),
            component_type: ComponentType::F32,
            element_type: ElementType::Vec3,
            normalized: false,
        };
        let positions = NewAccessor::new(elements, Target::Vertices).with_bounds(true);
        let positions = document.push_accessor(positions);
        document.edit_primitive(index, 0, |json| json["attributes"]["POSITION"] = positions.into())?;
        let mesh = surface.mesh();
        let corners = (0..mesh.corner_count()).map(|corner| mesh.vertex_of_corner(corner) as u32);
        document.set_triangles(index, 0, corners.collect())?;
    }
    Ok(document)
}

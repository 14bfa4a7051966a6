//! Bevy's own function, which keeps one tangent per vertex of the index list.

#[path = "../../../readers/case.rs"]
mod case;

use asset::RenderAssetUsages;
use case::{Case, Found, run};
use mesh::{Indices, Mesh, PrimitiveTopology, VertexAttributeValues};

fn compute(case: &Case) -> Result<Found, String> {
    if !case.is_triangles() {
        return Err("triangles only".into());
    }
    if case.threshold != 180.0 {
        return Err("no angular threshold".into());
    }
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, case.positions.clone());
    mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, case.normals.clone());
    mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, case.uvs.clone());
    mesh.insert_indices(Indices::U32(case.indices.clone()));
    let failed = || Found::PerCorner(vec![[f32::NAN; 4]; case.indices.len()]);
    if mesh.generate_tangents().is_err() {
        return Ok(failed());
    }
    let Some(VertexAttributeValues::Float32x4(tangents)) = mesh.attribute(Mesh::ATTRIBUTE_TANGENT) else {
        return Ok(failed());
    };
    // Bevy negates the sign, as for glTF.
    let tangents = tangents.iter().map(|&[x, y, z, w]| [x, y, z, -w]).collect();
    Ok(Found::PerVertex(tangents, case.indices.clone()))
}

fn main() {
    run(compute);
}

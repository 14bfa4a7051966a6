//! Reads the cases of `conformance/cases` as models: each breaks a rule of geometry that simple meshes keep.

use serde_json::Value;

use super::model::Mesh;

/// The mesh of a case; none if the case is generated or has no triangle. Faces become fans of triangles.
pub fn mesh(text: &str) -> Option<Mesh> {
    let case: Value = serde_json::from_str(text).ok()?;
    let mut mesh = Mesh {
        positions: vectors(&case["positions"])?,
        normals: vectors(&case["normals"])?,
        uvs: vectors(&case["uvs"])?,
        ..Mesh::default()
    };
    let mut corners = case["indices"].as_array()?.iter();
    for size in case["faces"].as_array()? {
        let size = usize::try_from(size.as_u64()?).ok()?;
        let face: Vec<u32> = corners.by_ref().take(size).map(index).collect::<Option<_>>()?;
        let triangles = (2..face.len()).flat_map(|last| [face[0], face[last - 1], face[last]]);
        mesh.indices.extend(triangles);
    }
    (!mesh.indices.is_empty()).then_some(mesh)
}

fn index(value: &Value) -> Option<u32> {
    u32::try_from(value.as_u64()?).ok()
}

/// Lists of N numbers each.
fn vectors<const N: usize>(lists: &Value) -> Option<Vec<[f32; N]>> {
    let vector = |list: &Value| {
        let numbers: Vec<f32> = list.as_array()?.iter().map(number).collect::<Option<_>>()?;
        numbers.try_into().ok()
    };
    lists.as_array()?.iter().map(vector).collect()
}

/// A number, or one of the strings for those that JSON lacks.
fn number(value: &Value) -> Option<f32> {
    match value {
        Value::String(name) => name.parse().ok(),
        other => other.as_f64().map(|number| number as f32),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_become_triangles() {
        let case = r#"{"positions": [[0, 0, "nan"], [1, 0, 0], [1, 1, 0], [0, "-inf", 0]], "normals": [[0, 0, 1], [0, 0, 1], [0, 0, 1], [0, 0, 1]],
            "uvs": [[0, 0], [1, 0], [1, 1], [0, -0.0]], "faces": [4], "indices": [0, 1, 2, 3]}"#;
        let read = mesh(case).expect("a mesh");
        assert_eq!(read.indices, [0, 1, 2, 0, 2, 3]);
        assert!(read.positions[0][2].is_nan() && read.positions[3][1] == f32::NEG_INFINITY);
        assert!(mesh("{\"positions\": [[0, 0]]}").is_none());
    }
}

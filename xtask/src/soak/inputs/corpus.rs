//! Reads the meshes of `tests/corpus` as models: each breaks a rule of geometry that simple meshes keep.

use super::model::Mesh;

/// Reads the lines of a mesh: `v` with position, normal and UV, `f` with the indices of a face. Faces become fans of triangles.
pub fn mesh(text: &str) -> Option<Mesh> {
    let mut mesh = Mesh::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let floats: Vec<f32> = words.map(str::parse).collect::<Result<_, _>>().ok()?;
                let &[x, y, z, a, b, c, u, v] = &floats[..] else { return None };
                mesh.positions.push([x, y, z]);
                mesh.normals.push([a, b, c]);
                mesh.uvs.push([u, v]);
            }
            Some("f") => {
                let face: Vec<u32> = words.map(str::parse).collect::<Result<_, _>>().ok()?;
                let triangles = (2..face.len()).flat_map(|last| [face[0], face[last - 1], face[last]]);
                mesh.indices.extend(triangles);
            }
            _ => {}
        }
    }
    (!mesh.indices.is_empty()).then_some(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_become_triangles() {
        let vertex = "v 0 0 nan 0 0 1 -inf 0\n".repeat(4);
        let read = mesh(&format!("# title\nthresholds 180\n{vertex}f 0 1 2 3\n")).expect("a mesh");
        assert_eq!(read.indices, [0, 1, 2, 0, 2, 3]);
        assert!(read.positions[3][2].is_nan() && mesh("v 0 0\n").is_none());
    }
}

//! What `KHR_texture_transform` does to the axes of a texture, and whether the tangents of a surface follow
//! the UVs before it or after it.
//!
//! Where the transform mirrors the image or turns it, both differ in what red and green of a normal map mean:
//! a map with green up looks as if it were inverted on tangents that follow the mirrored UVs before the
//! transform, and is right on those that follow the UVs after it.

use darboux_io::gltf::TextureUse;

use crate::surface::{Surface, cross, dot, length, sub, uv_area, xyz};

/// Where u and v go. Plain axes are (1, 0) and (0, 1).
pub type Axes = [[f64; 2]; 2];

/// The axes of a texture in the UVs of its image.
pub fn axes(texture: &TextureUse) -> Axes {
    let origin = texture.transform_uv([0.0, 0.0]);
    [[1.0, 0.0], [0.0, 1.0]].map(|uv| {
        let placed = texture.transform_uv(uv);
        [0, 1].map(|i| f64::from(placed[i]) - f64::from(origin[i]))
    })
}

/// Whether red or green of a map point another way before the transform than after it: it mirrors an axis or
/// turns it by a right angle or more.
pub fn turns_channels([u, v]: Axes) -> bool {
    // Rounding leaves a little of the cosine of a right angle.
    let is_turned = |along: f64, across: f64| along <= 1e-3 * across.abs();
    is_turned(u[0], u[1]) || is_turned(v[1], v[0])
}

/// The share of corners whose tangents follow UVs, from which on a surface follows them, and up to which it
/// does not.
const FOLLOWS: f64 = 0.9;
const FOLLOWS_NOT: f64 = 0.5;

/// The UVs after a transform that turns channels, where the tangents of the surface follow these, and not the
/// ones before it.
pub fn followed(surface: &Surface, texture: &TextureUse) -> Option<Vec<[f32; 2]>> {
    if texture.uv_set != surface.uv_set || !turns_channels(axes(texture)) {
        return None;
    }
    let before = surface.uv_sets.get(&surface.uv_set)?;
    let after: Vec<[f32; 2]> = before.iter().map(|uv| texture.transform_uv(*uv)).collect();
    let shares = [before, &after].map(|uvs| share_that_follows(surface, uvs));
    let [before, transformed] = [shares[0]?, shares[1]?];
    (transformed >= FOLLOWS && before <= FOLLOWS_NOT).then_some(after)
}

/// The share of corners whose tangents point along u, and whose bitangents point along v of the image,
/// upwards; none without tangents.
fn share_that_follows(surface: &Surface, uvs: &[[f32; 2]]) -> Option<f64> {
    let (normals, tangents) = (surface.normals.as_ref()?, surface.tangents.as_ref()?);
    let (mut all, mut following) = (0usize, 0usize);
    for triangle in surface.triangles() {
        let area = uv_area(uvs, triangle);
        let [a, b, c] = triangle.map(|vertex| surface.positions[vertex]);
        let edges = [sub(b, a), sub(c, a)];
        let [origin, p, q] = triangle.map(|vertex| uvs[vertex]);
        let [[u1, v1], [u2, v2]] = [p, q].map(|end| [end[0] - origin[0], end[1] - origin[1]]);
        let combine =
            |p: f32, q: f32| [0, 1, 2].map(|i| (p * edges[0][i] + q * edges[1][i]) * area.signum() as f32);
        // glTF's v points down.
        let (along_u, along_v) = (combine(v2, -v1), combine(u2, -u1));
        if !(area != 0.0 && length(along_u) > 0.0 && length(along_v) > 0.0) {
            continue;
        }
        for vertex in triangle {
            let (tangent, w) = (xyz(tangents[vertex]), tangents[vertex][3]);
            let bitangent = cross(normals[vertex], tangent).map(|x| w * x);
            let is_along = |a: [f32; 3], b: [f32; 3]| dot(a, b) > 0.5 * length(a) * length(b);
            all += 1;
            following += usize::from(is_along(tangent, along_u) && dot(bitangent, along_v) > 0.0);
        }
    }
    (all > 0).then(|| following as f64 / all as f64)
}

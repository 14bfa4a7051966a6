//! Whether a map flattens the faces that the normals of a mesh round, or has a relief of its own on every
//! face.
//!
//! A dome on every convex face leans away from the middle of the face, and the face's normal leans towards
//! it: such a map leans against all faces, wherever it is right. Moving the map does not tell that from a
//! bake with red and green inverted, because it does belong to this mesh. The means do: a relief in the
//! middle of a face leans to all sides alike, so that its mean is zero, and what flattens a face leans on
//! average as the smoothed normals do, which are skewed wherever the face's neighbours differ. So only the
//! means of whole faces decide: triangles in one plane are one face, and so are two that share their longest
//! edge. The null is a permutation: the leans of the faces against the leans of other faces, which correlate
//! by chance only.

use std::collections::BTreeMap;

use darboux::internal::DisjointSets;
use darboux_io::image::RgbaImage;

use crate::measure::arrangement::ARRANGEMENTS;
use crate::measure::facet::{Facet, Facets, MapUse, Means, means};
use crate::surface::{dot, length, sub};

/// More triangles of a surface are not asked.
const TRIANGLES: usize = 200_000;

/// The smallest correlation of the mean leans of the texels with the leans of the faces, and by how many
/// standard deviations of its permutations the correlation differs from zero at least, where every block of
/// the map counts once.
///
/// Real maps that were baked for their meshes have 0.19 to 0.74; domes, cushions and studs on boxes, balls,
/// lenses and rings 0.02 at most.
const CORRELATION: f64 = 0.2;
const DEVIATIONS: f64 = 3.5;

/// The smallest mean tilt of a face that votes: two codes of 8 bits.
const SMALLEST: f64 = 4.0 / 255.0;

/// The cosine of the angle up to which neighbours lie in one plane: two degrees.
const ONE_PLANE: f64 = 0.9994;

/// By arrangement: 1 where the texels flatten the faces, -1 where they do so once red and green are both
/// inverted, 0 where neither is shown.
pub fn flattening(uses: &[MapUse<'_>], image: &RgbaImage) -> [f64; ARRANGEMENTS] {
    let mut faces: Vec<Means> = Vec::new();
    for facets in uses.iter().filter_map(|map_use| Facets::new(*map_use)) {
        if facets.surface.vertex_of_corner.len() / 3 <= TRIANGLES {
            add_faces(&facets, image, &mut faces);
        }
    }
    faces.retain(|face| face.tilt[0].hypot(face.tilt[1]) >= SMALLEST * face.count);
    let mut blocks: Vec<usize> = faces.iter().map(|face| face.block).collect();
    blocks.sort_unstable();
    blocks.dedup();
    let squares = |of: fn(&Means) -> [f64; 2]| faces.iter().map(of).map(|[x, y]| x * x + y * y).sum::<f64>();
    let size = (squares(Means::mean_tilt) * squares(Means::mean_texel)).sqrt();
    std::array::from_fn(|index| {
        let products = faces.iter().map(|face| {
            let ([tx, ty], [x, y]) = (face.mean_tilt(), face.mean_texel());
            [tx * x + ty * y, tx * x - ty * y, tx * y + ty * x, ty * x - tx * y][index]
        });
        let correlation = products.sum::<f64>() / size;
        // The correlation of n independent pairs of vectors has a standard deviation of 1 / sqrt(2 n) over
        // their permutations.
        let deviations = correlation * (2.0 * blocks.len() as f64).sqrt();
        let is_shown = correlation.abs() >= CORRELATION && deviations.abs() >= DEVIATIONS;
        if is_shown { correlation.signum() } else { 0.0 }
    })
}

/// Adds the faces of a surface.
fn add_faces(facets: &Facets<'_>, image: &RgbaImage, faces: &mut Vec<Means>) {
    let face_of_triangle = facets.face_of_triangle(|| face_of_triangle(facets));
    let mut of_face = vec![Means::default(); face_of_triangle.len()];
    for (number, uv_area, tilts) in facets.tilts(usize::MAX).iter() {
        let face = face_of_triangle[number as usize];
        of_face[face as usize].add(&means(uv_area, tilts, facets.wrap(), image));
    }
    faces.extend(of_face.into_iter().filter(|face| face.count > 0.0));
}

/// The face of each triangle, named by the number of its first one: connected triangles in one plane are one
/// face, and so are pairs that share their longest edge.
fn face_of_triangle(facets: &Facets<'_>) -> Vec<u32> {
    let (numbers, all): (Vec<u32>, Vec<Facet>) = facets.numbered().unzip();
    let mut edges: BTreeMap<[[u32; 5]; 2], Vec<(usize, usize)>> = BTreeMap::new();
    for (number, facet) in all.iter().enumerate() {
        for corner in 0..3 {
            let ends = [corner, (corner + 1) % 3].map(|end| {
                let ([x, y, z], [u, v]) = (facet.corners[end].position, facet.corners[end].uv);
                // Adding 0.0 makes both zeros one.
                [x, y, z, u, v].map(|x| (x + 0.0).to_bits())
            });
            let key = if ends[0] <= ends[1] { ends } else { [ends[1], ends[0]] };
            edges.entry(key).or_default().push((number, corner));
        }
    }
    let longest: Vec<usize> = all.iter().map(longest_edge).collect();
    let mut sets = DisjointSets::new(all.len());
    for sides in edges.values() {
        let [(first, a), (second, b)] = sides[..] else { continue };
        let is_one_plane = dot(all[first].normal, all[second].normal) >= ONE_PLANE;
        if is_one_plane || longest[first] == a && longest[second] == b {
            sets.join(first, second);
        }
    }
    // Triangles without an area have no face.
    let mut faces = vec![u32::MAX; facets.surface.vertex_of_corner.len() / 3];
    for (&number, first) in numbers.iter().zip(sets.into_names()) {
        faces[number as usize] = numbers[first as usize];
    }
    faces
}

/// The corner at which the longest edge begins.
fn longest_edge(facet: &Facet) -> usize {
    let along =
        |corner: usize| length(sub(facet.corners[(corner + 1) % 3].position, facet.corners[corner].position));
    (0..3).max_by(|a, b| along(*a).total_cmp(&along(*b))).unwrap_or(0)
}

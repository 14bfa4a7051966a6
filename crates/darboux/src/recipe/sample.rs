//! A small part of a large mesh, on which most recipes are excluded.
//!
//! The part consists of the triangles in some cells of a grid in space, chosen by a hash, so that it has
//! connected pieces from all over the mesh. Only corners are compared whose tangents cannot depend on the
//! rest: those of vertices whose triangles lie in chosen cells with all three vertices. Their triangles are
//! complete, and so are those of the neighbouring vertices, which the method angle-area reads.

use crate::Mesh;
use crate::mesh::Faces;

/// Smaller meshes have no sample: all recipes are computed for them.
pub const LARGE: usize = 250_000;

/// The triangles that are wanted in a sample, and vertices per cell.
const TRIANGLES: usize = 32_000;
const VERTICES_PER_CELL: usize = 256;

/// The fewest corners that are compared.
const MIN_CORNERS: usize = 3_000;

/// A part of a mesh, with its own vertices.
pub struct Sample {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    indices: Vec<u32>,
    /// The corners of this part whose tangents are compared.
    pub measured: Vec<u32>,
    /// Their tangents.
    pub tangents: Vec<[f32; 4]>,
}

impl Sample {
    /// None for small meshes, for other faces than triangles, and where no fitting part was found.
    /// `tangents`: one per corner of the mesh.
    pub fn new(mesh: &Mesh<'_>, tangents: &[[f32; 4]]) -> Option<Self> {
        let triangles = mesh.corner_count() / 3;
        if triangles < LARGE || !matches!(mesh.faces(), Faces::Triangles) {
            return None;
        }
        let is_chosen = chosen_vertices(mesh, (triangles / TRIANGLES) as u64)?;
        let at = |triangle: usize| [0, 1, 2].map(|corner| mesh.vertex_of_corner(3 * triangle + corner));
        let chosen_of = |triangle: &usize| at(*triangle).map(|vertex| is_chosen[vertex]);
        let inside: Vec<usize> =
            (0..triangles).filter(|triangle| chosen_of(triangle).contains(&true)).collect();
        if inside.len() > 4 * TRIANGLES {
            return None;
        }
        let mut is_complete = is_chosen.clone();
        for triangle in inside.iter().filter(|triangle| chosen_of(triangle).contains(&false)) {
            at(*triangle).into_iter().for_each(|vertex| is_complete[vertex] = false);
        }
        let mut sample = Self {
            positions: Vec::new(),
            normals: Vec::new(),
            uvs: Vec::new(),
            indices: Vec::with_capacity(3 * inside.len()),
            measured: Vec::new(),
            tangents: Vec::new(),
        };
        let mut new_of_vertex = vec![u32::MAX; mesh.vertex_count()];
        for (corner, triangle) in inside.iter().flat_map(|triangle| (0..3).map(move |i| (i, *triangle))) {
            let vertex = at(triangle)[corner];
            if is_complete[vertex] {
                sample.measured.push(sample.indices.len() as u32);
                sample.tangents.push(tangents[3 * triangle + corner]);
            }
            if new_of_vertex[vertex] == u32::MAX {
                new_of_vertex[vertex] = sample.positions.len() as u32;
                sample.positions.push(mesh.positions().get(vertex));
                sample.normals.push(mesh.normals().get(vertex));
                sample.uvs.push(mesh.uvs().get(vertex));
            }
            sample.indices.push(new_of_vertex[vertex]);
        }
        (sample.measured.len() >= MIN_CORNERS).then_some(sample)
    }

    /// The part as a mesh.
    pub fn mesh(&self) -> Option<Mesh<'_>> {
        Mesh::triangles(&self.positions, &self.normals, &self.uvs, &self.indices).ok()
    }
}

/// Per vertex whether its cell is chosen, one cell of `every`; none where positions span no space.
fn chosen_vertices(mesh: &Mesh<'_>, every: u64) -> Option<Vec<bool>> {
    let positions = || (0..mesh.vertex_count()).map(|vertex| mesh.positions().get(vertex));
    let finite = || positions().filter(|position| position.iter().all(|x| x.is_finite()));
    let bound = |least: f32, choose: fn(f32, f32) -> f32| {
        finite().fold([least; 3], |bound, position| [0, 1, 2].map(|i| choose(bound[i], position[i])))
    };
    let (low, high) = (bound(f32::INFINITY, f32::min), bound(f32::NEG_INFINITY, f32::max));
    let size = (0..3).map(|i| f64::from(high[i]) - f64::from(low[i])).fold(0.0, f64::max);
    // The vertices lie on a surface, so that their number per cell falls with the square of the cells per
    // axis.
    let cells = ((mesh.vertex_count() / VERTICES_PER_CELL) as f64).sqrt().max(1.0);
    let scale = cells / size;
    let cell =
        |position: [f32; 3]| [0, 1, 2].map(|i| ((f64::from(position[i]) - f64::from(low[i])) * scale) as u64);
    (size > 0.0 && scale.is_finite())
        .then(|| positions().map(|position| hash(cell(position)).is_multiple_of(every)).collect())
}

/// Mixes three coordinates (the finaliser of MurmurHash3 after every one).
fn hash(cell: [u64; 3]) -> u64 {
    cell.into_iter().fold(0, |hash: u64, coordinate| {
        let mut x = hash.wrapping_add(coordinate).wrapping_add(0x9e37_79b9_7f4a_7c15);
        for multiplier in [0xff51_afd7_ed55_8ccd, 0xc4ce_b9fe_1a85_ec53] {
            x = (x ^ x >> 33).wrapping_mul(multiplier);
        }
        x ^ x >> 33
    })
}

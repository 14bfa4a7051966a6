//! Which triangles meet where: degenerate ones set aside, the triangles of each vertex, neighbours over edges, groups around vertices.

use wgpu::{Buffer, CommandEncoder, ComputePipeline, Device};

use crate::GpuError;
use crate::adjacency::{Adjacency, AdjacencyKernels};
use crate::buffers::{Description, check_size};
use crate::kernel::{Step, buffer, module, pipeline};

const MESH: &str = include_str!("../shaders/mesh.wgsl");
const COMMON: &str = include_str!("../shaders/common.wgsl");
const AROUND: &str = include_str!("../shaders/around.wgsl");
/// The files of the shaders.
pub(crate) const TRIANGULATE: &[&str] =
    &[MESH, include_str!("../shaders/words.wgsl"), COMMON, include_str!("../shaders/triangulate.wgsl")];
pub(crate) const NEIGHBOURS: &[&str] = &[MESH, COMMON, AROUND, include_str!("../shaders/neighbours.wgsl")];
pub(crate) const GROUPS: &[&str] = &[MESH, COMMON, AROUND, include_str!("../shaders/groups.wgsl")];

/// What [`Topology::new`] needs, compiled once.
#[derive(Clone, Debug)]
pub(crate) struct TopologyKernels {
    triangulate: ComputePipeline,
    adjacency: AdjacencyKernels,
    find_neighbours: ComputePipeline,
    leave_vertices: ComputePipeline,
    find_groups: ComputePipeline,
}

impl TopologyKernels {
    pub fn new(device: &Device) -> Self {
        let groups = module(device, GROUPS);
        Self {
            triangulate: pipeline(device, &module(device, TRIANGULATE), "triangulate"),
            adjacency: AdjacencyKernels::new(device),
            find_neighbours: pipeline(device, &module(device, NEIGHBOURS), "find_neighbours"),
            leave_vertices: pipeline(device, &groups, "leave_vertices"),
            find_groups: pipeline(device, &groups, "find_groups"),
        }
    }
}

/// A welded mesh on the device, as stages find it.
pub(crate) struct WeldedMesh<'a> {
    pub description: Description,
    pub words: &'a Buffer,
    pub vertices: &'a Buffer,
    pub indices: &'a Buffer,
    pub welded: &'a Buffer,
    /// Of every vertex: 1 where the CPU has to decide. Steps add to them.
    pub is_left: &'a Buffer,
}

/// Triangles, neighbours and groups of one mesh, and the steps that find them.
#[derive(Clone, Debug)]
pub(crate) struct Topology {
    /// The welded vertex of every corner; none at degenerate triangles.
    pub welded_corners: Buffer,
    pub adjacency: Adjacency,
    /// Of every triangle across its edges 0-1, 1-2, 2-0.
    pub neighbours: Buffer,
    /// What derivatives say of every triangle; written between the steps before groups and those of groups.
    pub marks: Buffer,
    /// The first corner of every corner's group.
    pub seed_of_corner: Buffer,
    triangulate: Step,
    find_neighbours: Step,
    find_groups: [Step; 2],
}

impl Topology {
    /// Errors: the device binds no buffer of that size.
    pub fn new(device: &Device, kernels: &TopologyKernels, mesh: &WeldedMesh<'_>) -> Result<Self, GpuError> {
        let WeldedMesh { description, words, vertices, indices, welded, is_left } = *mesh;
        let triangles = description.triangle_count;
        let corners = 3 * triangles;
        check_size(device, "the welded corners", 4 * u64::from(corners))?;
        let welded_corners = buffer(device, "welded_corners", corners);
        let [neighbours, seed_of_corner] =
            ["neighbours", "seed_of_corner"].map(|label| buffer(device, label, corners));
        let marks = buffer(device, "marks", triangles);
        let description = description.of_welded_corners();
        let welded_words = &description.uniform(device);
        let adjacency =
            Adjacency::new(device, &kernels.adjacency, &description, welded_words, &welded_corners)?;
        let step = |kernel: &ComputePipeline, buffers: &[(u32, &Buffer)], threads| {
            Step::new(device, kernel, buffers, threads)
        };
        let triangulate = step(
            &kernels.triangulate,
            &[(0, words), (1, indices), (2, vertices), (3, welded), (4, &welded_corners), (5, is_left)],
            triangles,
        );
        let of_corners = [(0, welded_words), (1, &welded_corners)];
        let of_edges =
            [(2, &adjacency.ends), (3, &adjacency.triangle_of_entry), (4, &neighbours), (5, is_left)];
        let leaving = [(3, &marks), (6, is_left)];
        let of_groups = [(2, &adjacency.ends), (4, &neighbours), (5, &seed_of_corner)];
        let find_neighbours = step(&kernels.find_neighbours, &[&of_corners[..], &of_edges].concat(), corners);
        let find_groups = [
            step(&kernels.leave_vertices, &[&of_corners[..], &leaving].concat(), corners),
            step(&kernels.find_groups, &[&of_corners[..], &of_groups, &leaving].concat(), corners),
        ];
        Ok(Self {
            welded_corners,
            adjacency,
            neighbours,
            marks,
            seed_of_corner,
            triangulate,
            find_neighbours,
            find_groups,
        })
    }

    /// Records what comes before derivatives are known.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.triangulate.record(encoder);
        self.adjacency.record(encoder);
        self.find_neighbours.record(encoder);
    }

    /// Records groups, once `marks` are written.
    pub fn record_groups(&self, encoder: &mut CommandEncoder) {
        self.find_groups.iter().for_each(|step| step.record(encoder));
    }
}

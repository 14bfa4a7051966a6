//! What a plan keeps of a mesh, by method.

use std::sync::OnceLock;

use crate::CornerTangents;
use crate::Frame;
use crate::Mesh;

use crate::exec::limits::RunLimits;
use crate::tangents::Method;
use crate::tangents::MikkTSpaceOptions;
use crate::tangents::TangentOptions;
use crate::tangents::fast::{FastPath, FastPlan};
use crate::tangents::generate::{Tangents, generate, run};
use crate::tangents::memory::TangentMemory;
use crate::tangents::methods::angle_area;
use crate::tangents::methods::angle_area::group_sums::GroupWeight;
use crate::tangents::mikktspace::{GroupedMesh, default_frames};
use crate::tangents::submesh::{UndecidedFaces, complete_for_plan};

/// The part of a plan that does not depend on positions and normals.
#[derive(Debug)]
pub(crate) enum MethodPlan {
    /// MikkTSpace where the fast path applies: it has decided nearly all vertices.
    Fast(Box<FastMethodPlan>),
    /// MikkTSpace where the fast path does not apply: the general path has grouped the mesh.
    Stages(Box<GroupedMesh>),
    /// The methods angle-area and angle-edge, on the groups of MikkTSpace.
    Groups(Box<angle_area::AngleAreaPlan>),
    /// The other methods run again for every evaluation, because they have no groups.
    Nothing,
}

/// The vertices that the fast path decided, the groups and the submesh of the others, and a copy of the
/// mesh's vertices, from which the general path groups the mesh when a moved mesh invalidates the decisions.
#[derive(Debug)]
pub(crate) struct FastMethodPlan {
    options: MikkTSpaceOptions,
    fast: FastPlan,
    /// All faces with corners that the first pass leaves undecided.
    undecided: Option<UndecidedFaces>,
    /// The faces with corners that the groups of `fast` leave undecided.
    left: Option<UndecidedFaces>,
    base: Vertices,
    stages: OnceLock<GroupedMesh>,
}

impl MethodPlan {
    /// Computes the tangents of the base mesh, and keeps what does not depend on positions and normals.
    pub fn new(mesh: &Mesh<'_>, options: &TangentOptions, limits: RunLimits<'_>) -> (Self, Tangents) {
        let options = match &options.method {
            Method::MikkTSpace(options) => options,
            Method::AngleArea => return Self::groups(mesh, GroupWeight::Area, limits),
            Method::AngleEdge => return Self::groups(mesh, GroupWeight::Edges, limits),
            _ => return (Self::Nothing, generate(mesh, options, limits, &mut TangentMemory::default())),
        };
        let mut base = Tangents::default();
        base.corners.0.resize(mesh.corner_count(), [0.0; 4]);
        let mut fast = FastPath::default();
        if !fast.run_for_plan(mesh, options, limits, &mut base.corners.0) {
            let Some(topology) = GroupedMesh::new(mesh, options, limits) else {
                return (Self::Nothing, base);
            };
            let (frames, report) = topology.frames(mesh, limits);
            write(&frames, &mut base.corners.0);
            return (Self::Stages(Box::new(topology)), Tangents { report, ..base });
        }
        if limits.is_cancelled() {
            return (Self::Nothing, base);
        }
        let undecided = UndecidedFaces::new(mesh, options, &fast, limits, &base.corners.0);
        let signs = fast.signs(mesh, &base.corners.0);
        let left;
        (base.report, left) = complete_for_plan(mesh, options, &mut fast, limits, &mut base.corners.0);
        if limits.is_cancelled() {
            return (Self::Nothing, base);
        }
        let groups = undecided.is_some().then(|| fast.planned_groups(options.mode));
        let fast = FastPlan::new(mesh, fast, signs, groups);
        let vertices = Vertices::new(mesh);
        (
            Self::Fast(Box::new(FastMethodPlan {
                options: *options,
                fast,
                undecided,
                left,
                base: vertices,
                stages: OnceLock::new(),
            })),
            base,
        )
    }

    fn groups(mesh: &Mesh<'_>, weight: GroupWeight, limits: RunLimits<'_>) -> (Self, Tangents) {
        let Some((plan, tangents, report)) = angle_area::plan(mesh, weight, limits) else {
            return (Self::Nothing, Tangents::default());
        };
        (Self::Groups(Box::new(plan)), Tangents { corners: CornerTangents(tangents), report })
    }

    /// Writes the tangents of the moved mesh with the signs of the base's. `base`: what it was planned with,
    /// and its tangents.
    pub fn evaluate(
        &self,
        mesh: &Mesh<'_>,
        base: (&TangentOptions, &[[f32; 4]]),
        limits: RunLimits<'_>,
        memory: &mut TangentMemory,
        out: &mut [[f32; 4]],
    ) {
        let (options, signs) = base;
        match self {
            Self::Fast(decided) => return decided.evaluate(mesh, signs, limits, memory, out),
            Self::Stages(topology) => {
                write(&topology.frames_of_moved(mesh, default_frames(mesh), limits).0, out)
            }
            Self::Groups(plan) => {
                plan.frames_of_moved(mesh, limits, &mut memory.sums.of_groups, out);
            }
            Self::Nothing => {
                run(mesh, options, limits, memory, out);
            }
        }
        take_signs(signs, out);
    }
}

impl FastMethodPlan {
    fn evaluate(
        &self,
        mesh: &Mesh<'_>,
        base: &[[f32; 4]],
        limits: RunLimits<'_>,
        memory: &mut TangentMemory,
        out: &mut [[f32; 4]],
    ) {
        if memory.fast.run_planned(&self.fast, mesh, limits, out) {
            let groups_suffice = memory.fast.run_planned_groups(&self.fast, mesh, base, limits, out);
            if let Some(part) = if groups_suffice { &self.left } else { &self.undecided } {
                part.decide_moved(mesh, base, limits, out);
            }
            return;
        }
        let Some(stages) = self.stages(mesh, limits) else { return };
        write(&stages.frames_of_moved(mesh, default_frames(mesh), limits).0, out);
        take_signs(base, out);
    }

    /// The stages of the mesh that was planned, which are made when they are first asked for; `None` after
    /// cancellation.
    fn stages(&self, moved: &Mesh<'_>, limits: RunLimits<'_>) -> Option<&GroupedMesh> {
        if self.stages.get().is_none() {
            let made = GroupedMesh::new(&self.base.of(moved), &self.options, limits)?;
            // Another thread may have been quicker, with the same.
            _ = self.stages.set(made);
        }
        self.stages.get()
    }
}

fn write(frames: &[Frame], out: &mut [[f32; 4]]) {
    for (tangent, frame) in out.iter_mut().zip(frames) {
        *tangent = frame.tangent_and_sign();
    }
}

fn take_signs(others: &[[f32; 4]], out: &mut [[f32; 4]]) {
    for (tangent, other) in out.iter_mut().zip(others) {
        tangent[3] = other[3];
    }
}

/// The vertices of a mesh.
#[derive(Debug)]
struct Vertices {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
}

impl Vertices {
    fn new(mesh: &Mesh<'_>) -> Self {
        let vertices = 0..mesh.vertex_count();
        Self {
            positions: vertices.clone().map(|vertex| mesh.positions().get(vertex)).collect(),
            normals: vertices.clone().map(|vertex| mesh.normals().get(vertex)).collect(),
            uvs: vertices.map(|vertex| mesh.uvs().get(vertex)).collect(),
        }
    }

    /// A mesh of these vertices with the faces of `mesh`.
    fn of<'a>(&'a self, mesh: &Mesh<'a>) -> Mesh<'a> {
        let (indices, faces) = (mesh.indices(), mesh.faces());
        let mesh = Mesh::with_faces(&self.positions, &self.normals, &self.uvs, indices, faces);
        mesh.expect("a copy of a mesh is one")
    }
}

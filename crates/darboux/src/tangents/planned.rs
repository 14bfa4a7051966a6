//! What a plan keeps of a mesh, by method.

use std::sync::OnceLock;

use crate::math::cosine_of_degrees;
use crate::{CornerTangents, Frame, Mesh};

use super::fans::{Fans, PlannedFans, Width};
use super::local::UndecidedPart;
use super::mikktspace::{Topology, unknown};
use super::{Method, Scratch, TangentOptions, Tangents, generate_tangents, generate_tangents_into};

/// What is known beforehand.
#[derive(Debug)]
pub(crate) enum Planned {
    /// MikkTSpace on triangles at 180 degrees: nearly all vertices are decided.
    Fans(Box<Decided>),
    /// MikkTSpace elsewhere.
    Stages(Box<Topology>),
    /// Other methods run afresh.
    Nothing,
}

/// Decided vertices, the stages for the others, and the mesh, for when vertices that were decided need the stages after all.
#[derive(Debug)]
pub(crate) struct Decided {
    fans: PlannedFans,
    undecided: Option<UndecidedPart>,
    mesh: MeshCopy,
    stages: OnceLock<Topology>,
}

impl Planned {
    /// Runs on the base, and keeps what does not depend on where vertices are.
    pub fn new(mesh: &Mesh<'_>, options: &TangentOptions) -> (Self, Tangents) {
        if options.method != Method::MikkTSpace {
            return (Self::Nothing, generate_tangents(mesh, options));
        }
        let mut base = Tangents::default();
        base.corners.0.resize(mesh.corner_count(), [0.0; 4]);
        let (mut fans, width) = (Fans::default(), Width::widest(Default::default()));
        let applies = cosine_of_degrees(options.threshold) == -1.0;
        if !applies || !fans.run(mesh, options.mode, width, &mut base.corners.0) {
            let topology = Topology::new(mesh, options);
            let (frames, report) = topology.frames(mesh);
            write(&frames, &mut base.corners);
            return (Self::Stages(Box::new(topology)), Tangents { report, ..base });
        }
        let undecided = UndecidedPart::new(mesh, options, &fans, &base.corners);
        let fans = PlannedFans::new(mesh, fans, &base.corners);
        if let Some(part) = &undecided {
            base.report = part.decide(mesh, &mut base.corners);
        }
        base.report.triangles = mesh.face_count();
        let mesh = MeshCopy::new(mesh);
        (Self::Fans(Box::new(Decided { fans, undecided, mesh, stages: OnceLock::new() })), base)
    }

    /// Writes the tangents of the moved mesh with the signs of the base's. `base`: what it was planned with, and its tangents.
    pub fn evaluate(
        &self,
        mesh: &Mesh<'_>,
        base: (&TangentOptions, &CornerTangents),
        scratch: &mut Scratch,
        out: &mut CornerTangents,
    ) {
        let (options, signs) = base;
        match self {
            Self::Fans(decided) => return decided.evaluate(mesh, base, scratch, out),
            Self::Stages(topology) => write(&topology.frames_of_moved(mesh, unknown(mesh)).0, out),
            Self::Nothing => {
                let mut tangents = Tangents { corners: std::mem::take(out), ..Tangents::default() };
                generate_tangents_into(mesh, options, scratch, &mut tangents);
                *out = tangents.corners;
            }
        }
        out.take_signs(signs);
    }
}

impl Decided {
    fn evaluate(
        &self,
        mesh: &Mesh<'_>,
        (options, base): (&TangentOptions, &CornerTangents),
        scratch: &mut Scratch,
        out: &mut CornerTangents,
    ) {
        let width = Width::widest(scratch.width_limit);
        if scratch.fans.run_planned(&self.fans, mesh, width, &mut out.0) {
            if let Some(part) = &self.undecided {
                part.decide_moved(mesh, base, out);
            }
            return;
        }
        let stages = self.stages.get_or_init(|| Topology::new(&self.mesh.view(), options));
        write(&stages.frames_of_moved(mesh, unknown(mesh)).0, out);
        out.take_signs(base);
    }
}

fn write(frames: &[Frame], out: &mut CornerTangents) {
    for (tangent, frame) in out.0.iter_mut().zip(frames) {
        *tangent = frame.tangent_and_sign();
    }
}

/// A mesh of triangles.
#[derive(Debug)]
struct MeshCopy {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    indices: Vec<u32>,
}

impl MeshCopy {
    fn new(mesh: &Mesh<'_>) -> Self {
        let vertices = 0..mesh.vertex_count();
        let corners = 0..mesh.corner_count();
        Self {
            positions: vertices.clone().map(|vertex| mesh.positions().get(vertex)).collect(),
            normals: vertices.clone().map(|vertex| mesh.normals().get(vertex)).collect(),
            uvs: vertices.map(|vertex| mesh.uvs().get(vertex)).collect(),
            indices: corners.map(|corner| mesh.vertex_of_corner(corner) as u32).collect(),
        }
    }

    fn view(&self) -> Mesh<'_> {
        let mesh = Mesh::triangles(&self.positions, &self.normals, &self.uvs, &self.indices);
        mesh.expect("a copy of a mesh is one")
    }
}

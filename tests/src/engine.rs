//! A common interface to all implementations: a mesh, a threshold and a mode in, one frame per corner out.

use darboux::internal::stage_arrays;
use darboux::internal::width_limit::{self, WidthLimit};
use darboux::{
    Frame, Frames, Mesh, MikkTSpaceOptions, Mode, TangentOptions, generate_frames, generate_tangents_with,
};
use mikktspace_sys::{MikkTSpaceInterface, gen_tang_space};

use crate::OwnedMesh;

/// An implementation of MikkTSpace.
pub trait Engine: Sync {
    /// Its name in messages.
    fn name(&self) -> &'static str;

    /// One frame per corner, `None` for the corners of unsupported faces. The whole result is `None` if the
    /// engine does not have `mode`.
    fn run(&self, mesh: &OwnedMesh, threshold: f32, mode: Mode) -> Option<Vec<Option<Frame>>>;
}

/// Every engine, the reference first.
pub fn engines() -> Vec<Box<dyn Engine>> {
    vec![
        Box::new(Reference),
        Box::new(DARBOUX),
        Box::new(Darboux("darboux stages", stage_arrays::frames)),
        Box::new(DarbouxTangents("darboux tangents, compiled width", WidthLimit::Compiled)),
        Box::new(DarbouxTangents("darboux tangents, at most 256 bits", WidthLimit::Bits256)),
        Box::new(DarbouxTangents("darboux tangents, at most 512 bits", WidthLimit::Bits512)),
    ]
}

/// mikktspace.c itself, as the registry crate `mikktspace-sys` compiles it.
pub struct Reference;

impl Engine for Reference {
    fn name(&self) -> &'static str {
        "reference"
    }

    fn run(&self, mesh: &OwnedMesh, threshold: f32, mode: Mode) -> Option<Vec<Option<Frame>>> {
        (mode == Mode::Reference).then(|| reference(mesh, threshold))
    }
}

/// The library, through one of its functions that return whole frames.
pub struct Darboux(&'static str, fn(&Mesh<'_>, &MikkTSpaceOptions) -> Frames);

/// The public entry point.
pub const DARBOUX: Darboux = Darboux("darboux", |mesh, options| generate_frames(mesh, &(*options).into()));

impl Engine for Darboux {
    fn name(&self) -> &'static str {
        self.0
    }

    fn run(&self, mesh: &OwnedMesh, threshold: f32, mode: Mode) -> Option<Vec<Option<Frame>>> {
        let options = MikkTSpaceOptions::new().with_mode(mode).with_threshold(threshold);
        let frames = (self.1)(&mesh.view(), &options).corners.into_per_corner();
        let supported = mesh.supported_corners();
        Some(frames.into_iter().zip(supported).map(|(frame, supported)| supported.then_some(frame)).collect())
    }
}

/// The library's fast path, which gives tangents and signs only: the other numbers are [`DARBOUX`]'s.
pub struct DarbouxTangents(&'static str, WidthLimit);

impl Engine for DarbouxTangents {
    fn name(&self) -> &'static str {
        self.0
    }

    fn run(&self, mesh: &OwnedMesh, threshold: f32, mode: Mode) -> Option<Vec<Option<Frame>>> {
        let mut frames = DARBOUX.run(mesh, threshold, mode)?;
        let options =
            TangentOptions::from(MikkTSpaceOptions::new().with_mode(mode).with_threshold(threshold));
        let context = &mut width_limit::context(self.1);
        let tangents = generate_tangents_with(&mesh.view(), &options, context).ok()?;
        for (frame, [x, y, z, sign]) in frames.iter_mut().zip(tangents.corners.into_per_corner()) {
            if let Some(frame) = frame {
                (frame.tangent, frame.sign) = ([x, y, z], sign);
            }
        }
        Some(frames)
    }
}

/// The result of mikktspace.c; `None` for corners that it does not write.
///
/// mikktspace.c recurses over the faces of a vertex and in its sorts, so large meshes need a thread with a
/// large stack.
pub fn reference(mesh: &OwnedMesh, threshold: f32) -> Vec<Option<Frame>> {
    const SMALL: usize = 1 << 12;
    if mesh.corner_count() <= SMALL {
        return run_reference(mesh, threshold);
    }
    std::thread::scope(|scope| {
        let deep = std::thread::Builder::new().stack_size(1 << 30);
        let thread = deep.spawn_scoped(scope, || run_reference(mesh, threshold));
        thread.expect("a thread starts").join().expect("the reference does not panic")
    })
}

fn run_reference(mesh: &OwnedMesh, threshold: f32) -> Vec<Option<Frame>> {
    let sizes = mesh.face_sizes();
    let first_corner = sizes
        .iter()
        .scan(0, |corner, &size| Some(std::mem::replace(corner, *corner + size as usize)))
        .collect();
    let count = mesh.corner_count();
    let mut context =
        Context { mesh, sizes, first_corner, frames: vec![None; count], basics: vec![None; count] };
    gen_tang_space(&mut context, threshold);
    for (frame, basic) in context.frames.iter().zip(&context.basics) {
        let same = frame.map(|frame| frame.tangent_and_sign().map(f32::to_bits))
            == basic.map(|basic| basic.map(f32::to_bits));
        assert!(same, "the reference's two outputs differ");
    }
    context.frames
}

struct Context<'a> {
    mesh: &'a OwnedMesh,
    sizes: Vec<u32>,
    first_corner: Vec<usize>,
    frames: Vec<Option<Frame>>,
    basics: Vec<Option<[f32; 4]>>,
}

impl Context<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.vertex_of_corner(self.first_corner[face] + corner)
    }
}

impl MikkTSpaceInterface for Context<'_> {
    fn get_num_faces(&self) -> usize {
        self.sizes.len()
    }

    fn get_num_vertices_of_face(&self, face: usize) -> usize {
        self.sizes[face] as usize
    }

    fn get_position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)]
    }

    fn get_normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)]
    }

    fn get_tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.mesh.uvs[self.vertex(face, corner)]
    }

    fn set_tspace_basic(&mut self, tangent: [f32; 3], sign: f32, face: usize, corner: usize) {
        let [x, y, z] = tangent;
        self.basics[self.first_corner[face] + corner] = Some([x, y, z, sign]);
    }

    fn set_tspace(
        &mut self,
        tangent: [f32; 3],
        bitangent: [f32; 3],
        mag_s: f32,
        mag_t: f32,
        is_orientation_preserving: bool,
        face: usize,
        corner: usize,
    ) {
        let sign = if is_orientation_preserving { 1.0 } else { -1.0 };
        self.frames[self.first_corner[face] + corner] =
            Some(Frame { tangent, bitangent, magnitude: [mag_s, mag_t], sign });
    }
}

//! The list of engines: how each is called, its version, threads and claim.

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use cpu_time::ProcessTime;
use darboux::internal::width_limit::{self, WidthLimit};
use darboux::{Context, MikkTSpaceOptions, Mode, TangentOptions, generate_tangents_with, write_tangents};
use darboux_tests::{FaceSizes, OwnedMesh};

use crate::callbacks::Callbacks;
use crate::lengyel::lengyel;
use crate::node;
use crate::run::{Run, Tangent, Time};

/// What an engine claims to compute. Its result is checked accordingly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// MikkTSpace, exactly or approximately; the table shows the differences.
    MikkTSpace,
    /// Another method, whose tangents have similar directions.
    Other,
    /// No tangents: a lower bound for the time.
    Copy,
}

/// An implementation that can be started on a mesh.
pub struct Engine {
    /// Its name in the table.
    pub name: &'static str,
    /// The version that Cargo.toml or node/package.json pins.
    pub version: &'static str,
    /// The number of threads that it uses.
    pub threads: usize,
    /// What it computes.
    pub method: Method,
    /// True if it accepts quads.
    quads: bool,
    start: Start,
}

enum Start {
    Native(for<'a> fn(&'a OwnedMesh) -> Box<dyn Run + 'a>),
    Node,
}

/// The engine that every other is compared with.
pub const REFERENCE: &str = "mikktspace.c";

/// meshoptimizer in its default mode, the second engine that ratios are computed for.
pub const MESHOPT: &str = "meshopt";

/// The engines in the table's order, the reference first.
pub fn all() -> Vec<Engine> {
    use Method::{Copy, MikkTSpace, Other};
    let mut engines = vec![
        native(REFERENCE, "mikktspace-sys 0.1.1", MikkTSpace, |mesh| {
            per_corner(mesh, |out| _ = mikktspace_sys::gen_tang_space_default(&mut Callbacks::new(mesh, out)))
        }),
        native("mikktspace", "0.3.0", MikkTSpace, |mesh| {
            per_corner(mesh, |out| _ = mikktspace::generate_tangents(&mut Callbacks::new(mesh, out)))
        }),
        native("bevy_mikktspace", "1.0.0", MikkTSpace, |mesh| {
            per_corner(mesh, |out| _ = bevy_mikktspace::generate_tangents(&mut Callbacks::new(mesh, out)))
        }),
        triangles_only(native(MESHOPT, "0.7.0", MikkTSpace, |mesh| {
            per_corner(mesh, |out| *out = meshopt(mesh, meshopt::TangentOptions::None))
        })),
        triangles_only(native("meshopt-compatible", "0.7.0", MikkTSpace, |mesh| {
            per_corner(mesh, |out| *out = meshopt(mesh, meshopt::TangentOptions::Compatible))
        })),
        triangles_only(native("lengyel-loop", "", Other, |mesh| per_vertex(mesh, |out| lengyel(mesh, out)))),
        native("memcpy", "", Copy, |mesh| {
            let (mut input, mut from) = (mesh.clone(), Vec::new());
            per_corner(mesh, move |out| copy(mesh, &mut input, &mut from, out))
        }),
        in_node("three.js port", "three 0.187.0", MikkTSpace),
        in_node("npm mikktspace", "1.1.1", MikkTSpace),
        in_node("npm meshoptimizer", "1.3.0", MikkTSpace),
    ];
    engines.extend(ours());
    engines
}

/// The configurations of Darboux. Each returns the bits of the reference.
fn ours() -> Vec<Engine> {
    let version = env!("CARGO_PKG_VERSION");
    let threads = available_threads();
    vec![
        native("darboux", version, Method::MikkTSpace, |mesh| {
            let view = mesh.view();
            per_corner(mesh, move |out| {
                let tangents =
                    generate_tangents_with(&view, &exact(), &mut Context::new().with_max_threads(1));
                *out = tangents.expect("not cancelled").corners.into_per_corner();
            })
        }),
        native("darboux-kept", version, Method::MikkTSpace, |mesh| {
            kept(mesh, Context::new().with_max_threads(1))
        }),
        native("darboux-kept-256", version, Method::MikkTSpace, |mesh| {
            kept(mesh, width_limit::context(WidthLimit::Bits256).with_max_threads(1))
        }),
        native("darboux-kept-128", version, Method::MikkTSpace, |mesh| {
            kept(mesh, width_limit::context(WidthLimit::Compiled).with_max_threads(1))
        }),
        Engine {
            threads,
            ..native("darboux-threads", version, Method::MikkTSpace, |mesh| kept(mesh, Context::new()))
        },
    ]
}

/// The number of hardware threads.
fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Options that give the reference's result, without repairs.
fn exact() -> TangentOptions {
    MikkTSpaceOptions::new().with_mode(Mode::Reference).into()
}

/// Darboux with memory that is reused between calls.
fn kept(mesh: &OwnedMesh, mut context: Context) -> Box<dyn Run + '_> {
    let view = mesh.view();
    per_corner(mesh, move |out| {
        out.resize(view.corner_count(), [0.0; 4]);
        _ = write_tangents(&view, &exact(), &mut context, out).expect("one tangent per corner");
    })
}

impl Engine {
    /// Starts the engine on a mesh. `node`: the folder with the packages for engines that run in node.
    /// Errors: it cannot run on this machine.
    pub fn start<'a>(&self, mesh: &'a OwnedMesh, node: Option<&Path>) -> Result<Box<dyn Run + 'a>, String> {
        match (&self.start, node) {
            (Start::Native(start), _) => Ok(start(mesh)),
            (Start::Node, Some(folder)) => Ok(Box::new(node::Child::start(self.name, mesh, folder)?)),
            (Start::Node, None) => Err("node and npm are absent".into()),
        }
    }

    /// True where the engine can be started on a mesh with these faces.
    pub fn takes(&self, mesh: &OwnedMesh) -> bool {
        self.quads || mesh.faces == FaceSizes::Triangles
    }

    /// True where the engine runs in this process, so that its memory and instructions can be counted.
    pub fn is_native(&self) -> bool {
        matches!(self.start, Start::Native(_))
    }
}

fn native(
    name: &'static str,
    version: &'static str,
    method: Method,
    start: for<'a> fn(&'a OwnedMesh) -> Box<dyn Run + 'a>,
) -> Engine {
    Engine { name, version, threads: 1, method, quads: true, start: Start::Native(start) }
}

fn triangles_only(engine: Engine) -> Engine {
    Engine { quads: false, ..engine }
}

fn in_node(name: &'static str, version: &'static str, method: Method) -> Engine {
    Engine { name, version, threads: 1, method, quads: false, start: Start::Node }
}

/// An engine that fills an output array, which is reused between calls.
struct Native<'a, O, F> {
    mesh: &'a OwnedMesh,
    per_vertex: bool,
    output: O,
    read: fn(&O) -> &[Tangent],
    call: F,
}

fn per_corner<'a, F: FnMut(&mut Vec<Tangent>) + 'a>(mesh: &'a OwnedMesh, call: F) -> Box<dyn Run + 'a> {
    Box::new(Native { mesh, per_vertex: false, output: Vec::new(), read: Vec::as_slice, call })
}

fn per_vertex<'a, F: FnMut(&mut Vec<Tangent>) + 'a>(mesh: &'a OwnedMesh, call: F) -> Box<dyn Run + 'a> {
    Box::new(Native { mesh, per_vertex: true, output: Vec::new(), read: Vec::as_slice, call })
}

impl<O, F: FnMut(&mut O)> Run for Native<'_, O, F> {
    fn run(&mut self, count: usize) -> Result<Time, String> {
        let (wall, cpu) = (Instant::now(), ProcessTime::now());
        for _ in 0..count {
            (self.call)(black_box(&mut self.output));
        }
        let (wall, cpu) = (wall.elapsed(), cpu.elapsed());
        Ok(Time { wall: wall.as_nanos() as f64, cpu: cpu.as_nanos() as f64 })
    }

    fn tangents(&mut self) -> Result<Vec<Tangent>, String> {
        let output = (self.read)(&self.output);
        if !self.per_vertex {
            return Ok(output.to_vec());
        }
        let corners = 0..self.mesh.corner_count();
        Ok(corners.map(|corner| output[self.mesh.vertex_of_corner(corner)]).collect())
    }

    fn output_len(&self) -> usize {
        (self.read)(&self.output).len()
    }
}

/// The crate's interface returns a new list at each call.
fn meshopt(mesh: &OwnedMesh, options: meshopt::TangentOptions) -> Vec<Tangent> {
    meshopt::generate_tangents(mesh.indices.as_deref(), &mesh.positions, &mesh.normals, &mesh.uvs, options)
}

/// Copies as many bytes as an engine must read and write.
fn copy(mesh: &OwnedMesh, input: &mut OwnedMesh, from: &mut Vec<Tangent>, out: &mut Vec<Tangent>) {
    from.resize(mesh.corner_count(), [0.0; 4]);
    out.resize(mesh.corner_count(), [0.0; 4]);
    input.positions.copy_from_slice(&mesh.positions);
    input.normals.copy_from_slice(&mesh.normals);
    input.uvs.copy_from_slice(&mesh.uvs);
    if let (Some(to), Some(from)) = (&mut input.indices, &mesh.indices) {
        to.copy_from_slice(from);
    }
    black_box(input);
    out.copy_from_slice(black_box(from));
}

#[cfg(test)]
mod tests {
    /// The versions in the table match the built ones.
    #[test]
    fn versions_are_those_of_the_lock_files() {
        let cargo = include_str!("../../Cargo.lock");
        let node = include_str!("../node/package.json");
        for engine in super::all() {
            let name = engine.name.strip_prefix("npm ").unwrap_or(engine.name);
            let (package, _form) = name.split_once('-').unwrap_or((name, ""));
            let (package, version) = engine.version.split_once(' ').unwrap_or((package, engine.version));
            let locked = cargo.contains(&format!("name = \"{package}\"\nversion = \"{version}\""));
            let pinned = node.contains(&format!("\"{package}\": \"{version}\""));
            let found = if engine.is_native() { locked } else { pinned };
            assert!(found || version.is_empty(), "{}: {package} {version}", engine.name);
        }
    }
}

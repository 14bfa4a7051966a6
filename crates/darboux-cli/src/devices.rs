//! `darboux devices`, and which device computes the tangents of a file.

use std::fmt::Write as _;
use std::sync::atomic::Ordering;

use darboux::{Mesh, Scratch, TangentOptions, Tangents, generate_tangents_into};
use indicatif::{HumanBytes, HumanCount};
use serde::Serialize;

use crate::arguments::{Device, DevicesArguments};
use crate::exit;
use crate::gpu::{self, Opened};
use crate::messages::{Messages, write_stdout};
use crate::report::{VERSION, to_json};

/// What `darboux devices` says of an adapter.
#[derive(Serialize)]
pub struct Adapter {
    pub name: String,
    pub kind: String,
    pub backend: String,
    pub driver: String,
    /// In bytes.
    pub largest_binding: u64,
    pub triangle_limit: u64,
    /// Why it cannot be used, if it cannot.
    pub problem: Option<String>,
}

/// What `darboux devices --json` prints.
#[derive(Serialize)]
struct DevicesReport {
    command: &'static str,
    version: &'static str,
    adapters: Vec<Adapter>,
}

/// Runs the command; gives its exit code.
pub fn run(arguments: &DevicesArguments) -> u8 {
    let adapters = gpu::adapters();
    let text = if arguments.json {
        to_json(&DevicesReport { command: "devices", version: VERSION, adapters })
    } else {
        Ok(described(&adapters).into_bytes())
    };
    if let Err(error) = text.map_err(std::io::Error::from).and_then(|text| write_stdout(&text)) {
        Messages::new(false).error(&format!("the list cannot be written: {error}"));
        return exit::FAILED;
    }
    exit::DONE
}

fn described(adapters: &[Adapter]) -> String {
    if adapters.is_empty() {
        return format!("{}; tangents are computed on the CPU\n", gpu::NO_ADAPTERS);
    }
    adapters.iter().fold(String::new(), |mut text, adapter| {
        let Adapter { name, kind, backend, driver, largest_binding, triangle_limit, problem } = adapter;
        let use_of_it = match problem {
            None => format!("usable, {} triangles at once", HumanCount(*triangle_limit)),
            Some(problem) => format!("not usable: {problem}"),
        };
        let binding = HumanBytes(*largest_binding);
        let _never_fails = writeln!(
            text,
            "{name}\n  {kind}, {backend}, driver {driver}\n  {use_of_it} (buffers of {binding})"
        );
        text
    })
}

/// What computes the tangents of one file.
pub struct Computer {
    device: Device,
    /// The GPU, once it is wanted.
    opened: Option<Result<&'static Opened, String>>,
    /// From this many triangles on [`Device::Auto`] wants it.
    least_for_gpu: usize,
    corners_of_gpu: usize,
    /// Why the CPU did what the GPU was to do.
    fault: Option<String>,
}

/// Set by those who have measured from how many triangles on their GPU is the quicker one.
const LEAST_FOR_GPU: &str = "DARBOUX_GPU_TRIANGLES";

/// What the report says of a file's device.
#[derive(Serialize)]
pub struct DeviceReport {
    pub kind: &'static str,
    pub adapter: Option<String>,
    pub corners: usize,
    pub corners_of_cpu: usize,
}

impl Computer {
    /// Errors: there is no GPU, and one is asked for; the environment has no number where there is to be one.
    pub fn new(device: Device) -> Result<Self, String> {
        let opened = (device == Device::Gpu).then(gpu::open);
        if let Some(Err(why)) = opened {
            return Err(why);
        }
        Ok(Self { device, opened, least_for_gpu: least_for_gpu()?, corners_of_gpu: 0, fault: None })
    }

    /// As [`generate_tangents_into`]. Errors: what stops the GPU, where that is asked for; else the CPU does the work.
    pub fn generate(
        &mut self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        scratch: &mut Scratch,
        out: &mut Tangents,
    ) -> Result<(), String> {
        if self.wants_gpu(mesh, options) {
            match self.generate_on_gpu(mesh, options, out) {
                Err(why) if self.device == Device::Auto => self.fault = Some(why),
                done => return done,
            }
        }
        generate_tangents_into(mesh, options, scratch, out);
        Ok(())
    }

    fn wants_gpu(&self, mesh: &Mesh<'_>, options: &TangentOptions) -> bool {
        let is_mikktspace = options.method == darboux::Method::MikkTSpace;
        let is_large = mesh.face_count() >= self.least_for_gpu;
        match self.device {
            Device::Cpu => false,
            Device::Gpu => true,
            Device::Auto => is_mikktspace && is_large && self.fault.is_none(),
        }
    }

    fn generate_on_gpu(
        &mut self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        out: &mut Tangents,
    ) -> Result<(), String> {
        let opened = self.opened.get_or_insert_with(gpu::open).as_ref().map_err(Clone::clone)?;
        self.corners_of_gpu += mesh.corner_count() - opened.generate(mesh, options, out)?;
        Ok(())
    }

    /// What a user should know of it, in a sentence: why the CPU did the GPU's work; that the GPU is software, once for all files.
    pub fn warning(&self) -> Option<String> {
        if let Some(why) = &self.fault {
            return Some(format!("the CPU computed what the GPU was to compute: {why}"));
        }
        let Some(Ok(Opened { name, is_secretly_software, .. })) = &self.opened else { return None };
        is_secretly_software
            .swap(false, Ordering::Relaxed)
            .then(|| format!("{name} is software: --device cpu gives the same bits sooner"))
    }

    /// `corners`: all that were computed, those of morphed meshes, which the CPU does, included.
    pub fn report(&self, corners: usize) -> DeviceReport {
        match &self.opened {
            Some(Ok(opened)) => DeviceReport {
                kind: "gpu",
                adapter: Some(opened.name.clone()),
                corners,
                corners_of_cpu: corners - self.corners_of_gpu,
            },
            _ => DeviceReport { kind: "cpu", adapter: None, corners, corners_of_cpu: corners },
        }
    }
}

/// Errors: the environment has something else than a number.
fn least_for_gpu() -> Result<usize, String> {
    let Some(given) = std::env::var_os(LEAST_FOR_GPU) else { return Ok(usize::MAX) };
    let number = given.to_str().and_then(|text| text.parse().ok());
    number.ok_or_else(|| {
        let given = given.display();
        format!("{LEAST_FOR_GPU} is {given}: set it to a number of triangles, or to nothing")
    })
}

impl DeviceReport {
    /// A line for people, where there is something to say.
    pub fn line(&self) -> Option<String> {
        let (of_cpu, all) = (HumanCount(self.corners_of_cpu as u64), HumanCount(self.corners as u64));
        (self.corners > 0).then_some(())?;
        Some(format!("on {}; {of_cpu} of {all} corners on the CPU", self.adapter.as_ref()?))
    }
}

#[cfg(all(test, feature = "gpu"))]
mod tests {
    use super::*;

    /// A GPU that has just been lost; none without an adapter.
    fn lost() -> Option<&'static Opened> {
        Some(Box::leak(Box::new(Opened::lost()?)))
    }

    fn computer(device: Device, opened: &'static Opened) -> Computer {
        Computer { device, opened: Some(Ok(opened)), least_for_gpu: 1, corners_of_gpu: 0, fault: None }
    }

    #[test]
    fn where_a_gpu_is_lost_auto_takes_the_cpu_and_says_so() {
        let Some(opened) = lost() else { return };
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let uvs = positions.map(|[x, y, _]| [x, y]);
        let mesh = Mesh::triangles(&positions, &[[0.0, 0.0, 1.0]; 3], &uvs, &[0u32, 1, 2]).expect("a mesh");
        let options = TangentOptions::default();
        let run = |computer: &mut Computer| {
            let mut out = Tangents::default();
            computer.generate(&mesh, &options, &mut Scratch::default(), &mut out).map(|()| out)
        };
        let mut auto = computer(Device::Auto, opened);
        let made = run(&mut auto).expect("tangents of the CPU");
        assert_eq!(made.corners.per_corner(), [[1.0, 0.0, 0.0, 1.0]; 3]);
        let warning = auto.warning().expect("a sentence");
        assert!(
            warning.starts_with("the CPU computed what the GPU was to compute: the GPU was lost"),
            "{warning}"
        );
        assert_eq!(auto.report(3).corners_of_cpu, 3);
        let asked = run(&mut computer(Device::Gpu, opened)).err();
        assert!(asked.is_some_and(|why| why.starts_with("the GPU was lost")));
    }
}

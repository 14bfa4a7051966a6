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
pub enum Computer {
    Cpu,
    /// And how many corners it did.
    Gpu(&'static Opened, usize),
}

/// What the report says of a file's device.
#[derive(Serialize)]
pub struct DeviceReport {
    pub kind: &'static str,
    pub adapter: Option<String>,
    pub corners: usize,
    pub corners_of_cpu: usize,
}

impl Computer {
    /// Errors: there is no GPU, and one is asked for.
    pub fn new(device: Device) -> Result<Self, String> {
        match device {
            Device::Auto | Device::Cpu => Ok(Self::Cpu),
            Device::Gpu => Ok(Self::Gpu(gpu::open()?, 0)),
        }
    }

    /// As [`generate_tangents_into`]. Errors: what stops the adapter.
    pub fn generate(
        &mut self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        scratch: &mut Scratch,
        out: &mut Tangents,
    ) -> Result<(), String> {
        match self {
            Self::Cpu => generate_tangents_into(mesh, options, scratch, out),
            Self::Gpu(opened, corners_of_gpu) => {
                *corners_of_gpu += mesh.corner_count() - opened.generate(mesh, options, out)?;
            }
        }
        Ok(())
    }

    /// What a user should know of it, in a sentence; once, however many files there are.
    pub fn warning(&self) -> Option<String> {
        let Self::Gpu(Opened { name, is_secretly_software, .. }, _) = self else { return None };
        is_secretly_software
            .swap(false, Ordering::Relaxed)
            .then(|| format!("{name} is software: --device cpu gives the same bits sooner"))
    }

    /// `corners`: all that were computed, those of morphed meshes, which the CPU does, included.
    pub fn report(&self, corners: usize) -> DeviceReport {
        match self {
            Self::Cpu => DeviceReport { kind: "cpu", adapter: None, corners, corners_of_cpu: corners },
            Self::Gpu(opened, corners_of_gpu) => DeviceReport {
                kind: "gpu",
                adapter: Some(opened.name.clone()),
                corners,
                corners_of_cpu: corners - corners_of_gpu,
            },
        }
    }
}

impl DeviceReport {
    /// A line for people, where there is something to say.
    pub fn line(&self) -> Option<String> {
        let (of_cpu, all) = (HumanCount(self.corners_of_cpu as u64), HumanCount(self.corners as u64));
        (self.corners > 0).then_some(())?;
        Some(format!("on {}; {of_cpu} of {all} corners on the CPU", self.adapter.as_ref()?))
    }
}

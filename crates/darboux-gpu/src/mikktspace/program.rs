//! Runs lists of passes ([`crate::mikktspace::passes`]).

use std::collections::HashMap;

use wgpu::{Buffer, CommandEncoder, ComputePipeline, Device, ShaderModule};

use crate::GpuError;
use crate::device::kernel::{Step, buffer, module, pipeline};
use crate::device::mesh_buffers::check_size;
use crate::device::precision::{Arithmetic, RealKernel, RealStep};
use crate::device::prefix_sum::ScanKernels;
use crate::mikktspace::passes::{BUFFERS, Each, Pass, Run};

/// What passes run, compiled once.
#[derive(Clone, Debug)]
pub(crate) struct Program {
    passes: Vec<Pass>,
    entries: HashMap<(&'static str, &'static str), ComputePipeline>,
    reals: HashMap<&'static str, RealKernel>,
    scan: Option<ScanKernels>,
    leaves: bool,
}

impl Program {
    pub fn new(device: &Device, arithmetic: Arithmetic, passes: &[Pass]) -> Self {
        let mut modules = HashMap::new();
        let mut made = Self {
            passes: passes.to_vec(),
            entries: HashMap::new(),
            reals: HashMap::new(),
            scan: None,
            leaves: arithmetic == Arithmetic::Leaving,
        };
        for pass in passes {
            match pass {
                Pass::Clear(_) => {}
                Pass::Scan(..) => made.scan = Some(ScanKernels::new(device)),
                Pass::Run(run) => made.compile(device, &mut modules, run),
                Pass::Real(first, leaving) => {
                    let (own, leaving) = (first.kernel.files, leaving.kernel.files);
                    let kernel = match arithmetic {
                        Arithmetic::Leaving => RealKernel::with_second(device, own, leaving),
                        _ => RealKernel::new(device, arithmetic, own),
                    };
                    made.reals.insert(first.kernel.name, kernel);
                }
            }
        }
        made
    }

    fn compile(&mut self, device: &Device, modules: &mut HashMap<&str, ShaderModule>, run: &Run) {
        let of_kernel = modules.entry(run.kernel.name).or_insert_with(|| module(device, run.kernel.files));
        self.entries.insert((run.kernel.name, run.entry), pipeline(device, of_kernel, run.entry));
    }

    /// Makes the buffers that `buffers` lacks, and what recording needs. Errors: the device binds no buffer of that size.
    pub fn on(
        &self,
        device: &Device,
        [vertices, triangles]: [u32; 2],
        buffers: &mut Buffers,
    ) -> Result<Recording, GpuError> {
        let sizes = Sizes { vertices, triangles };
        let mut steps = Vec::new();
        for pass in &self.passes {
            match *pass {
                Pass::Clear(name) => {
                    buffers.make(device, sizes, &[(0, name)])?;
                    steps.push(Recorded::Clear(buffers.of(name).clone()));
                }
                Pass::Scan(name, each) => {
                    let (values, count) = (buffers.of(name), sizes.count(each));
                    let scans = self.scan.iter().flat_map(|scan| scan.steps(device, values, count));
                    steps.extend(scans.map(Recorded::Step));
                }
                Pass::Run(run) => {
                    buffers.make(device, sizes, run.buffers)?;
                    let bound = buffers.bound(run.buffers);
                    let pipeline = &self.entries[&(run.kernel.name, run.entry)];
                    steps.push(Recorded::Step(Step::new(device, pipeline, &bound, sizes.count(run.each))));
                }
                Pass::Real(first, leaving) => {
                    let second = if self.leaves { leaving } else { first };
                    buffers.make(device, sizes, &[first.buffers, second.buffers].concat())?;
                    let [bound, of_second] = [first, second].map(|run| buffers.bound(run.buffers));
                    let kernel = &self.reals[first.kernel.name];
                    let items = sizes.count(first.each);
                    let step = RealStep::with_second(device, kernel, &bound, &of_second, items);
                    steps.push(Recorded::Real(step));
                }
            }
        }
        Ok(Recording(steps))
    }
}

#[derive(Clone, Copy)]
struct Sizes {
    vertices: u32,
    triangles: u32,
}

impl Sizes {
    fn count(self, each: Each) -> u32 {
        match each {
            Each::Mesh => 1,
            Each::Vertex => self.vertices,
            Each::Slot => slot_count(self.vertices),
            Each::Triangle => self.triangles,
            Each::Corner => 3 * self.triangles,
        }
    }
}

/// The slots of a hash table: a power of two, at least twice what it holds, so that the way to a slot is short; in the stress build hardly
/// more.
pub(crate) fn slot_count(held: u32) -> u32 {
    let least = if cfg!(small_limits) { held + 1 } else { 2 * held };
    least.next_power_of_two()
}

/// Buffers by the names that passes know them by.
#[derive(Clone, Debug, Default)]
pub(crate) struct Buffers(HashMap<&'static str, Buffer>);

impl Buffers {
    /// Those that the caller brings.
    pub fn given<const N: usize>(buffers: [(&'static str, &Buffer); N]) -> Self {
        Self(buffers.map(|(name, buffer)| (name, buffer.clone())).into())
    }

    /// One that passes have been put on.
    pub fn of(&self, name: &str) -> &Buffer {
        &self.0[name]
    }

    /// Makes those that are not there. Errors: the device binds no buffer of that size.
    fn make(&mut self, device: &Device, sizes: Sizes, names: &[(u32, &'static str)]) -> Result<(), GpuError> {
        for &(_, name) in names {
            if !self.0.contains_key(name) {
                let (_, each, words) =
                    BUFFERS.iter().find(|(known, ..)| *known == name).expect("in the list");
                let count = sizes.count(*each);
                check_size(device, name, 4 * u64::from(*words) * u64::from(count))?;
                self.0.insert(name, buffer(device, name, words * count));
            }
        }
        Ok(())
    }

    fn bound(&self, names: &[(u32, &'static str)]) -> Vec<(u32, &Buffer)> {
        names.iter().map(|&(binding, name)| (binding, self.of(name))).collect()
    }
}

/// Passes with their buffers.
#[derive(Clone, Debug)]
pub(crate) struct Recording(Vec<Recorded>);

#[derive(Clone, Debug)]
enum Recorded {
    Clear(Buffer),
    Step(Step),
    Real(RealStep),
}

impl Recording {
    pub fn record(&self, encoder: &mut CommandEncoder) {
        for recorded in &self.0 {
            match recorded {
                Recorded::Clear(buffer) => encoder.clear_buffer(buffer, 0, None),
                Recorded::Step(step) => step.record(encoder),
                Recorded::Real(step) => step.record(encoder),
            }
        }
    }

    /// Kernels of exact arithmetic, in turn.
    pub fn reals(&self) -> impl Iterator<Item = &RealStep> {
        self.0.iter().filter_map(|recorded| match recorded {
            Recorded::Real(step) => Some(step),
            _ => None,
        })
    }
}

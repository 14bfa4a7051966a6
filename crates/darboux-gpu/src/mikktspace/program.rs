//! Compiles a list of [passes](crate::mikktspace::passes), creates its buffers, and records it.

use std::collections::HashMap;

use wgpu::{Buffer, CommandEncoder, ComputePipeline, Device, ShaderModule};

use crate::device::buffers::{check_size, storage_buffer};
use crate::device::kernel::{Dispatch, compute_pipeline, shader_module};
use crate::device::precision::{Arithmetic, PrecisionDispatch, PrecisionKernel};
use crate::device::prefix_sum::PrefixSumKernels;
use crate::error::GpuError;
use crate::mikktspace::passes::{BUFFERS, Domain, Pass, Run};

/// The compiled pipelines of a list of passes.
#[derive(Clone, Debug)]
pub(crate) struct Program {
    passes: Vec<Pass>,
    /// By the names of kernel and entry point.
    pipelines: HashMap<(&'static str, &'static str), ComputePipeline>,
    /// By the name of the kernel.
    precision_kernels: HashMap<&'static str, PrecisionKernel>,
    prefix_sum: Option<PrefixSumKernels>,
    /// Whether items that exact arithmetic is unsure of are deferred to the CPU.
    defers: bool,
}

impl Program {
    pub fn new(device: &Device, arithmetic: Arithmetic, passes: &[Pass]) -> Self {
        let mut modules = HashMap::new();
        let mut program = Self {
            passes: passes.to_vec(),
            pipelines: HashMap::new(),
            precision_kernels: HashMap::new(),
            prefix_sum: None,
            defers: arithmetic == Arithmetic::CpuFallback,
        };
        for pass in passes {
            match pass {
                Pass::Clear(_) => {}
                Pass::Scan(..) => program.prefix_sum = Some(PrefixSumKernels::new(device)),
                Pass::Run(run) => program.compile(device, &mut modules, run),
                Pass::RunExact(first, deferring) => {
                    let (own, deferring) = (first.kernel.files, deferring.kernel.files);
                    let kernel = match arithmetic {
                        Arithmetic::CpuFallback => PrecisionKernel::with_second(device, own, deferring),
                        _ => PrecisionKernel::new(device, arithmetic, own),
                    };
                    program.precision_kernels.insert(first.kernel.name, kernel);
                }
            }
        }
        program
    }

    fn compile(&mut self, device: &Device, modules: &mut HashMap<&str, ShaderModule>, run: &Run) {
        let module =
            modules.entry(run.kernel.name).or_insert_with(|| shader_module(device, run.kernel.files));
        self.pipelines.insert((run.kernel.name, run.entry), compute_pipeline(device, module, run.entry));
    }

    /// Creates the buffers that `buffers` lacks, and binds them. Errors: a buffer is larger than the device
    /// can bind.
    pub fn bind(
        &self,
        device: &Device,
        [vertices, triangles]: [u32; 2],
        buffers: &mut NamedBuffers,
    ) -> Result<BoundProgram, GpuError> {
        let sizes = MeshSizes { vertices, triangles };
        let mut bound = Vec::new();
        for pass in &self.passes {
            match *pass {
                Pass::Clear(name) => {
                    buffers.create(device, sizes, &[(0, name)])?;
                    bound.push(BoundPass::Clear(buffers.get(name).clone()));
                }
                Pass::Scan(name, domain) => {
                    let (values, count) = (buffers.get(name), sizes.count(domain));
                    let dispatches = self.prefix_sum.iter().flat_map(|k| k.dispatches(device, values, count));
                    bound.extend(dispatches.map(BoundPass::Dispatch));
                }
                Pass::Run(run) => {
                    buffers.create(device, sizes, run.buffers)?;
                    let bindings = buffers.bindings(run.buffers);
                    let pipeline = &self.pipelines[&(run.kernel.name, run.entry)];
                    let dispatch = Dispatch::new(device, pipeline, &bindings, sizes.count(run.domain));
                    bound.push(BoundPass::Dispatch(dispatch));
                }
                Pass::RunExact(first, deferring) => {
                    let second = if self.defers { deferring } else { first };
                    buffers.create(device, sizes, &[first.buffers, second.buffers].concat())?;
                    let [bindings, second_bindings] =
                        [first, second].map(|run| buffers.bindings(run.buffers));
                    let kernel = &self.precision_kernels[first.kernel.name];
                    let items = sizes.count(first.domain);
                    let dispatch =
                        PrecisionDispatch::with_second(device, kernel, &bindings, &second_bindings, items);
                    bound.push(BoundPass::Precision(dispatch));
                }
            }
        }
        Ok(BoundProgram(bound))
    }
}

#[derive(Clone, Copy)]
struct MeshSizes {
    vertices: u32,
    triangles: u32,
}

impl MeshSizes {
    fn count(self, domain: Domain) -> u32 {
        match domain {
            Domain::Mesh => 1,
            Domain::Vertex => self.vertices,
            Domain::Slot => slot_count(self.vertices),
            Domain::Triangle => self.triangles,
            Domain::Corner => 3 * self.triangles,
        }
    }
}

/// The number of slots of a hash table: a power of two, at least twice the number of entries, so that probe
/// sequences are short. The stress build fills its tables nearly completely.
pub(crate) fn slot_count(entries: u32) -> u32 {
    let least = if cfg!(small_limits) { entries + 1 } else { 2 * entries };
    least.next_power_of_two()
}

/// Buffers by the names that passes use for them.
#[derive(Clone, Debug, Default)]
pub(crate) struct NamedBuffers(HashMap<&'static str, Buffer>);

impl NamedBuffers {
    /// The buffers that the caller provides.
    pub fn new<const N: usize>(buffers: [(&'static str, &Buffer); N]) -> Self {
        Self(buffers.map(|(name, buffer)| (name, buffer.clone())).into())
    }

    /// A buffer that the caller has provided or a program has created.
    pub fn get(&self, name: &str) -> &Buffer {
        &self.0[name]
    }

    /// Creates the missing ones of `names`. Errors: a buffer is larger than the device can bind.
    fn create(
        &mut self,
        device: &Device,
        sizes: MeshSizes,
        names: &[(u32, &'static str)],
    ) -> Result<(), GpuError> {
        for &(_, name) in names {
            if !self.0.contains_key(name) {
                let entry = BUFFERS.iter().find(|(listed, ..)| *listed == name);
                let (_, domain, words) = entry.expect("a buffer of the list");
                let count = sizes.count(*domain);
                check_size(device, name, 4 * u64::from(*words) * u64::from(count))?;
                self.0.insert(name, storage_buffer(device, name, words * count));
            }
        }
        Ok(())
    }

    fn bindings(&self, names: &[(u32, &'static str)]) -> Vec<(u32, &Buffer)> {
        names.iter().map(|&(binding, name)| (binding, self.get(name))).collect()
    }
}

/// Passes with their buffers.
#[derive(Clone, Debug)]
pub(crate) struct BoundProgram(Vec<BoundPass>);

#[derive(Clone, Debug)]
enum BoundPass {
    Clear(Buffer),
    Dispatch(Dispatch),
    Precision(PrecisionDispatch),
}

impl BoundProgram {
    pub fn record(&self, encoder: &mut CommandEncoder) {
        for pass in &self.0 {
            match pass {
                BoundPass::Clear(buffer) => encoder.clear_buffer(buffer, 0, None),
                BoundPass::Dispatch(dispatch) => dispatch.record(encoder),
                BoundPass::Precision(dispatch) => dispatch.record(encoder),
            }
        }
    }

    /// The dispatches of exact arithmetic, in order.
    pub fn precision_dispatches(&self) -> impl Iterator<Item = &PrecisionDispatch> {
        self.0.iter().filter_map(|pass| match pass {
            BoundPass::Precision(dispatch) => Some(dispatch),
            _ => None,
        })
    }
}

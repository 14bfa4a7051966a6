//! MikkTSpace on the GPU, bit for bit: what is plain there, what is rare on the CPU.

use bytemuck::cast_slice;
use darboux::{Faces, Indices, Mesh, Method, Report, TangentOptions, Tangents, elsewhere, generate_tangents};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Buffer, BufferUsages, ComputePipeline, Device, Queue};

use crate::buffers::{Description, check_size};
use crate::device::{Copy, guarded};
use crate::evaluation::{Evaluation, EvaluationKernels, Grouped};
use crate::kernel::{Step, buffer, module, pipeline};
use crate::reals::Arithmetic;
use crate::topology::{Topology, TopologyKernels, WeldedMesh};
use crate::weld::{Weld, WeldKernels};
use crate::{Gpu, GpuError};

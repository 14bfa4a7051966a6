//! Turns tangents per corner into an indexed mesh with tangents per vertex, as `darboux::split_vertices`
//! does, on the GPU.
//!
//! The head of `shaders/split.wgsl` has the algorithm: a hash table finds equal corners, a prefix sum numbers
//! the new vertices.

use bytemuck::cast_slice;
use darboux::{Context, CornerTangents, Mesh, VertexSplit, split_vertices_with};
use wgpu::{Buffer, BufferUsages, CommandEncoder, ComputePipeline, Device, Queue};

use crate::device::adapters::Gpu;
use crate::device::buffers::{buffer_with_contents, check_size, corner_indices, storage_buffer, upload};
use crate::device::kernel::{Dispatch, compute_pipeline, shader_module};
use crate::device::prefix_sum::PrefixSumKernels;
use crate::device::readback::{submit, with_error_scopes};
use crate::error::GpuError;
use crate::mikktspace::program::slot_count;

/// The files of the shader.
pub(crate) const SPLIT_FILES: &[&str] =
    &[include_str!("../shaders/mikktspace/common.wgsl"), include_str!("../shaders/split.wgsl")];

/// `darboux::split_vertices`, compiled for a device.
#[derive(Clone, Debug)]
pub struct Splitter {
    device: Device,
    queue: Queue,
    claim: ComputePipeline,
    find: ComputePipeline,
    prefix_sum: PrefixSumKernels,
    keep: ComputePipeline,
    assign: ComputePipeline,
}

/// The buffers per corner.
struct CornerBuffers {
    uniform: Buffer,
    indices: Buffer,
    tangents: Buffer,
    hash_slots: Buffer,
    first_of_vertex: Buffer,
    first_of_corner: Buffer,
    /// The number of new vertices before each corner, and in the last element their total.
    number_of_corner: Buffer,
    failure_count: Buffer,
}

impl Splitter {
    /// Compiles the shaders. Errors: the device rejects them.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let Gpu { device, queue, .. } = gpu;
        with_error_scopes(device, || {
            let module = shader_module(device, SPLIT_FILES);
            let compile = |entry_point| compute_pipeline(device, &module, entry_point);
            Ok(Self {
                device: device.clone(),
                queue: queue.clone(),
                claim: compile("claim"),
                find: compile("find"),
                prefix_sum: PrefixSumKernels::new(device),
                keep: compile("keep"),
                assign: compile("assign"),
            })
        })
    }

    /// Splits the vertices whose corners have different tangents. Returns the arrays of
    /// `darboux::split_vertices`. Blocks until the device has finished.
    ///
    /// Errors: the tangents are of another number of corners; a buffer is past a limit of the device; the
    /// device is out of memory or lost.
    pub fn split_vertices(&self, mesh: &Mesh<'_>, corners: &CornerTangents) -> Result<VertexSplit, GpuError> {
        self.split_vertices_with(mesh, corners, &mut Context::new())
    }

    /// As [`Splitter::split_vertices`], with a context. Further error: the context's token was cancelled; the
    /// device still finishes the commands that it has.
    pub fn split_vertices_with(
        &self,
        mesh: &Mesh<'_>,
        corners: &CornerTangents,
        context: &mut Context,
    ) -> Result<VertexSplit, GpuError> {
        if corners.len() != mesh.corner_count() || corners.is_empty() {
            return Ok(split_vertices_with(mesh, corners, context)?);
        }
        match with_error_scopes(&self.device, || self.run(mesh, corners, context))? {
            Some(split) => Ok(split),
            None => Ok(split_vertices_with(mesh, corners, context)?),
        }
    }

    /// None if a probe sequence of the hash table was too long; the CPU has no such limit.
    fn run(
        &self,
        mesh: &Mesh<'_>,
        tangents: &CornerTangents,
        context: &Context,
    ) -> Result<Option<VertexSplit>, GpuError> {
        let (device, queue) = (&self.device, &self.queue);
        let (vertex_count, corner_count) = (mesh.vertex_count() as u32, mesh.corner_count() as u32);
        let corners = CornerBuffers::new(device, mesh, tangents)?;
        let dispatches = self.number_new_vertices(&corners, corner_count);
        let record = |encoder: &mut CommandEncoder| dispatches.iter().for_each(|d| d.record(encoder));
        let sources = [&corners.failure_count, &corners.number_of_corner];
        let [failures, numbers] = submit(device, queue, record, sources, context)?;
        let new_vertices = numbers.read::<u32>(device, context)?[corner_count as usize];
        if failures.read::<u32>(device, context)? != [0] {
            return Ok(None);
        }
        let split_count = vertex_count + new_vertices;
        check_size(device, "the tangents of split vertices", 16 * u64::from(split_count))?;
        let [indices, sources, tangents] =
            [("indices", corner_count), ("sources", split_count), ("tangents", 4 * split_count)]
                .map(|(label, words)| storage_buffer(device, label, words));
        let vertex_buffers = [(0, &corners.uniform), (9, &sources), (10, &tangents)];
        let corner_buffers = [
            (1, &corners.indices),
            (2, &corners.tangents),
            (4, &corners.first_of_vertex),
            (5, &corners.first_of_corner),
            (6, &corners.number_of_corner),
            (8, &indices),
        ];
        let all_buffers = [&vertex_buffers[..], &corner_buffers].concat();
        let dispatches = [
            Dispatch::new(device, &self.keep, &vertex_buffers, vertex_count),
            Dispatch::new(device, &self.assign, &all_buffers, corner_count),
        ];
        let record = |encoder: &mut CommandEncoder| dispatches.iter().for_each(|d| d.record(encoder));
        let [indices, sources, tangents] =
            submit(device, queue, record, [&indices, &sources, &tangents], context)?;
        Ok(Some(VertexSplit {
            tangent_of_vertex: tangents.read(device, context)?,
            indices: indices.read(device, context)?,
            source_of_vertex: sources.read(device, context)?,
        }))
    }

    /// Finds the first corner of each vertex and tangent, and numbers the corners that need new vertices.
    fn number_new_vertices(&self, corners: &CornerBuffers, count: u32) -> Vec<Dispatch> {
        let device = &self.device;
        let shared = [
            (0, &corners.uniform),
            (1, &corners.indices),
            (2, &corners.tangents),
            (3, &corners.hash_slots),
            (4, &corners.first_of_vertex),
        ];
        let claim = [&shared[..], &[(7, &corners.failure_count)]].concat();
        let find = [&shared[..], &[(5, &corners.first_of_corner), (6, &corners.number_of_corner)]].concat();
        let mut dispatches = vec![
            Dispatch::new(device, &self.claim, &claim, count),
            Dispatch::new(device, &self.find, &find, count),
        ];
        dispatches.extend(self.prefix_sum.dispatches(device, &corners.number_of_corner, count + 1));
        dispatches
    }
}

impl CornerBuffers {
    /// Uploads the corners. Errors: a buffer is larger than the device can bind.
    fn new(device: &Device, mesh: &Mesh<'_>, tangents: &CornerTangents) -> Result<Self, GpuError> {
        let (vertex_count, corner_count) = (mesh.vertex_count() as u32, mesh.corner_count() as u32);
        let slot_count = slot_count(corner_count);
        check_size(device, "the tangents", 16 * u64::from(corner_count))?;
        check_size(device, "the hash table of corners", 4 * u64::from(slot_count))?;
        check_size(device, "the first corners of vertices", 4 * u64::from(vertex_count))?;
        let words = [corner_count, vertex_count, 0, 0];
        let uniform = buffer_with_contents(device, "split", cast_slice(&words), BufferUsages::UNIFORM);
        // New buffers are filled with zeros, which means an empty slot and no corner.
        Ok(Self {
            uniform,
            indices: upload(device, "old indices", cast_slice(&corner_indices(mesh))),
            tangents: upload(device, "tangents of corners", cast_slice(tangents.per_corner())),
            hash_slots: storage_buffer(device, "hash_slots", slot_count),
            first_of_vertex: storage_buffer(device, "first_of_vertex", vertex_count),
            first_of_corner: storage_buffer(device, "first_of_corner", corner_count),
            number_of_corner: storage_buffer(device, "number_of_corner", corner_count + 1),
            failure_count: storage_buffer(device, "failure_count", 1),
        })
    }
}

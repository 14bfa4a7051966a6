//! Corner tangents to an indexed mesh, on the GPU.

use bytemuck::cast_slice;
use darboux::{CornerTangents, Mesh, VertexSplit, split_vertices};
use wgpu::{Buffer, BufferUsages, CommandEncoder, ComputePipeline, Device, Queue};

use crate::device::kernel::{Step, buffer, filled, module, pipeline};
use crate::device::mesh_buffers::check_size;
use crate::device::prefix_sum::ScanKernels;
use crate::device::readback::{guarded, submit};
use crate::mikktspace::generate::indices;
use crate::mikktspace::program::slot_count;
use crate::mikktspace::tiles::upload;
use crate::{Gpu, GpuError};

/// The files of the shader.
pub(crate) const SPLIT: &[&str] =
    &[include_str!("../shaders/mikktspace/common.wgsl"), include_str!("../shaders/split.wgsl")];

/// `darboux::split_vertices`, compiled for a device.
#[derive(Clone, Debug)]
pub struct Splitter {
    device: Device,
    queue: Queue,
    claim: ComputePipeline,
    find: ComputePipeline,
    scan: ScanKernels,
    keep: ComputePipeline,
    assign: ComputePipeline,
}

/// Corners on the device, and which of them ask for a new vertex.
struct Corners {
    words: Buffer,
    indices: Buffer,
    tangents: Buffer,
    slots: Buffer,
    first_of_vertex: Buffer,
    first_of_corner: Buffer,
    /// With the number of new vertices behind the last.
    number_of_corner: Buffer,
    refused: Buffer,
}

impl Splitter {
    /// Compiles the shaders. Errors: the device refuses them.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let Gpu { device, queue, .. } = gpu;
        guarded(device, || {
            let split = module(device, SPLIT);
            let compile = |entry_point| pipeline(device, &split, entry_point);
            Ok(Self {
                device: device.clone(),
                queue: queue.clone(),
                claim: compile("claim"),
                find: compile("find"),
                scan: ScanKernels::new(device),
                keep: compile("keep"),
                assign: compile("assign"),
            })
        })
    }

    /// Splits the vertices whose corners need different tangents: the arrays of `darboux::split_vertices`. Waits for the device.
    ///
    /// Errors: tangents of another number of corners; a buffer is past a limit of the device, or all are past its memory; it is lost.
    pub fn split_vertices(&self, mesh: &Mesh<'_>, corners: &CornerTangents) -> Result<VertexSplit, GpuError> {
        if corners.len() != mesh.corner_count() || corners.is_empty() {
            return Ok(split_vertices(mesh, corners)?);
        }
        match guarded(&self.device, || self.run(mesh, corners))? {
            Some(split) => Ok(split),
            None => Ok(split_vertices(mesh, corners)?),
        }
    }

    /// None where the hash table is crowded: the CPU's has no such limit.
    fn run(&self, mesh: &Mesh<'_>, tangents: &CornerTangents) -> Result<Option<VertexSplit>, GpuError> {
        let (device, queue) = (&self.device, &self.queue);
        let (vertex_count, corner_count) = (mesh.vertex_count() as u32, mesh.corner_count() as u32);
        let corners = Corners::new(device, mesh, tangents)?;
        let first = self.find_firsts(&corners, corner_count);
        let record = |encoder: &mut CommandEncoder| first.iter().for_each(|step| step.record(encoder));
        let [refused, numbers] = submit(device, queue, record, [&corners.refused, &corners.number_of_corner]);
        let new_vertices = numbers.read::<u32>(device)?[corner_count as usize];
        if refused.read::<u32>(device)? != [0] {
            return Ok(None);
        }
        let all = vertex_count + new_vertices;
        check_size(device, "the tangents of split vertices", 16 * u64::from(all))?;
        let [indices, sources, tangents] =
            [("indices", corner_count), ("sources", all), ("tangents", 4 * all)]
                .map(|(label, words)| buffer(device, label, words));
        let of_vertices = [(0, &corners.words), (9, &sources), (10, &tangents)];
        let of_corners = [
            (1, &corners.indices),
            (2, &corners.tangents),
            (4, &corners.first_of_vertex),
            (5, &corners.first_of_corner),
            (6, &corners.number_of_corner),
            (8, &indices),
        ];
        let steps = [
            Step::new(device, &self.keep, &of_vertices, vertex_count),
            Step::new(device, &self.assign, &[&of_vertices[..], &of_corners].concat(), corner_count),
        ];
        let record = |encoder: &mut CommandEncoder| steps.iter().for_each(|step| step.record(encoder));
        let [indices, sources, tangents] = submit(device, queue, record, [&indices, &sources, &tangents]);
        Ok(Some(VertexSplit {
            tangent_of_vertex: tangents.read(device)?,
            indices: indices.read(device)?,
            source_of_vertex: sources.read(device)?,
        }))
    }

    /// Steps that find the first corner of each vertex and tangent, and number those that ask for new vertices.
    fn find_firsts(&self, corners: &Corners, count: u32) -> Vec<Step> {
        let device = &self.device;
        let both = [
            (0, &corners.words),
            (1, &corners.indices),
            (2, &corners.tangents),
            (3, &corners.slots),
            (4, &corners.first_of_vertex),
        ];
        let claiming = [&both[..], &[(7, &corners.refused)]].concat();
        let finding = [&both[..], &[(5, &corners.first_of_corner), (6, &corners.number_of_corner)]].concat();
        let mut steps = vec![
            Step::new(device, &self.claim, &claiming, count),
            Step::new(device, &self.find, &finding, count),
        ];
        steps.extend(self.scan.steps(device, &corners.number_of_corner, count + 1));
        steps
    }
}

impl Corners {
    /// Uploads them. Errors: the device binds no buffer of that size.
    fn new(device: &Device, mesh: &Mesh<'_>, tangents: &CornerTangents) -> Result<Self, GpuError> {
        let (vertex_count, corner_count) = (mesh.vertex_count() as u32, mesh.corner_count() as u32);
        let slot_count = slot_count(corner_count);
        check_size(device, "the tangents", 16 * u64::from(corner_count))?;
        check_size(device, "the hash table of corners", 4 * u64::from(slot_count))?;
        check_size(device, "the first corners of vertices", 4 * u64::from(vertex_count))?;
        let words =
            filled(device, "split", cast_slice(&[corner_count, vertex_count, 0, 0]), BufferUsages::UNIFORM);
        // Fresh buffers hold zeros: no corner, no vertex.
        Ok(Self {
            words,
            indices: upload(device, "old indices", cast_slice(&indices(mesh))),
            tangents: upload(device, "tangents of corners", cast_slice(tangents.per_corner())),
            slots: buffer(device, "slots", slot_count),
            first_of_vertex: buffer(device, "first_of_vertex", vertex_count),
            first_of_corner: buffer(device, "first_of_corner", corner_count),
            number_of_corner: buffer(device, "number_of_corner", corner_count + 1),
            refused: buffer(device, "refused", 1),
        })
    }
}

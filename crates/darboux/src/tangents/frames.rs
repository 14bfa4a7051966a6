//! Full frames: computes the tangents, then bitangents and magnitudes per vertex, and combines them per
//! corner when frames are read.

use crate::Context;
use crate::CornerFrames;
use crate::Error;
use crate::Frame;
use crate::Mesh;

use crate::exec::limits::RunLimits;
use crate::exec::threads::{self, split_range, split_slice};
use crate::tangents::Method;
use crate::tangents::Report;
use crate::tangents::TangentOptions;
use crate::tangents::fast::{FastPath, UNDECIDED, triangle_count};
use crate::tangents::memory::{FrameMemory, TangentMemory};
use crate::tangents::methods;
use crate::tangents::methods::buffers::MethodBuffers;
use crate::tangents::mikktspace;
use crate::tangents::output::{Output, fill};
use crate::tangents::submesh;

/// The frames of corners and the report of the run.
#[derive(Clone, Debug, Default)]
pub struct Frames {
    /// One frame per corner.
    pub corners: CornerFrames,
    /// Counts of unusual geometry in the mesh.
    pub report: Report,
}

/// Computes the frame of every corner: tangent, bitangent, magnitudes, sign.
pub fn generate_frames(mesh: &Mesh<'_>, options: &TangentOptions) -> Frames {
    generate(mesh, options, &mut Context::new())
}

/// As [`generate_frames`], with a context. Errors: the context's token was cancelled.
pub fn generate_frames_with(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    context: &mut Context,
) -> Result<Frames, Error> {
    let frames = generate(mesh, options, context);
    context.limits().check().map(|()| frames)
}

/// The frames are unspecified after cancellation.
fn generate(mesh: &Mesh<'_>, options: &TangentOptions, context: &mut Context) -> Frames {
    let mut corners = vec![Frame::EMPTY; mesh.corner_count()];
    let (limits, memory) = context.limits_and_memory();
    let report = run(mesh, options, limits, memory, &mut corners);
    Frames { corners: CornerFrames(corners), report }
}

/// As [`generate_frames_with`], into the caller's array.
///
/// `corners`: receives one frame per corner, in corner order, which is not vertex order; unspecified after
/// cancellation. Errors: an array of another length; the context's token was cancelled.
pub fn write_frames(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    context: &mut Context,
    corners: &mut [Frame],
) -> Result<Report, Error> {
    Error::check_output("frames", mesh.corner_count(), corners.len())?;
    let (limits, memory) = context.limits_and_memory();
    let report = run(mesh, options, limits, memory, corners);
    limits.check().map(|()| report)
}

/// As [`generate_frames_with`], but the frames stay in the context's memory, in a compact form, until they
/// are read.
///
/// It is for output arrays of other layouts than [`Frame`], which [`CompactFrames::read`] fills block by
/// block. Errors: the context's token was cancelled.
pub fn generate_compact_frames<'a>(
    mesh: &'a Mesh<'a>,
    options: &TangentOptions,
    context: &'a mut Context,
) -> Result<CompactFrames<'a>, Error> {
    let (limits, memory) = context.limits_and_memory();
    let report = if let Some(report) = run_fast(mesh, options, limits, memory) {
        report
    } else {
        let frames = &mut memory.frames.frames;
        frames.resize(mesh.corner_count(), Frame::EMPTY);
        memory.frames.tangents.clear();
        run_without_fast(mesh, options, limits, &mut memory.sums, frames)
    };
    limits.check()?;
    Ok(CompactFrames { mesh, fast: &memory.fast, memory: &memory.frames, limits, report })
}

/// Frames of corners, one per corner, in corner order, which is not vertex order. They borrow the memory of a
/// [`Context`].
#[derive(Clone, Copy, Debug)]
pub struct CompactFrames<'a> {
    mesh: &'a Mesh<'a>,
    fast: &'a FastPath,
    memory: &'a FrameMemory,
    limits: RunLimits<'a>,
    report: Report,
}

impl CompactFrames<'_> {
    /// Counts of unusual geometry in the mesh.
    pub fn report(&self) -> Report {
        self.report
    }

    /// The number of corners.
    pub fn len(&self) -> usize {
        self.mesh.corner_count()
    }

    /// True when there are no corners.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Reads the frames of consecutive corners into `out`, which sets their number. `first`: the first of
    /// these corners. Panics where `first + out.len()` exceeds the number of corners.
    pub fn read(&self, first: usize, out: &mut [Frame]) {
        assert!(
            first.checked_add(out.len()).is_some_and(|end| end <= self.len()),
            "{} frames from corner {first} on were requested, but there are {} corners",
            out.len(),
            self.len()
        );
        let Self { mesh, fast, memory: FrameMemory { tangents, decided, frames }, .. } = self;
        if let Some(frames) = frames.get(first..) {
            fill(out, frames.iter().copied());
        }
        let Some(tangents) = tangents.get(first..) else { return };
        if tangents.is_empty() || out.is_empty() {
            return;
        }
        fast.write_bitangents(mesh, first, out);
        let mut decided = &decided[decided.partition_point(|&(corner, _)| (corner as usize) < first)..];
        for (&[x, y, z, sign], out) in tangents.iter().zip(out) {
            if sign != UNDECIDED {
                (out.tangent, out.sign) = ([x, y, z], sign);
            } else if let Some((&(_, frame), others)) = decided.split_first() {
                (*out, decided) = (frame, others);
            }
        }
    }

    /// Reads all frames into three arrays: tangents with their signs, bitangents, magnitudes. Errors: an
    /// array of another length than one per corner.
    pub fn read_apart(
        &self,
        tangents: &mut [[f32; 4]],
        bitangents: &mut [[f32; 3]],
        magnitudes: &mut [[f32; 2]],
    ) -> Result<(), Error> {
        for (what, len) in
            [("tangents", tangents.len()), ("bitangents", bitangents.len()), ("magnitudes", magnitudes.len())]
        {
            Error::check_output(what, self.len(), len)?;
        }
        let threads = self.limits.thread_count(triangle_count(self.mesh));
        let ranges = split_range(0..self.len(), threads, 1);
        let (tangents, bitangents) =
            (split_slice(tangents, 0, ranges.clone()), split_slice(bitangents, 0, ranges.clone()));
        let magnitudes = split_slice(magnitudes, 0, ranges.clone());
        let jobs = ranges.zip(tangents.zip(bitangents).zip(magnitudes));
        threads::run(&mut vec![(); threads], jobs, |(), (range, ((tangents, bitangents), magnitudes))| {
            let mut block = [Frame::default(); BLOCK];
            let out = tangents
                .chunks_mut(BLOCK)
                .zip(bitangents.chunks_mut(BLOCK))
                .zip(magnitudes.chunks_mut(BLOCK));
            for (first, ((tangents, bitangents), magnitudes)) in range.step_by(BLOCK).zip(out) {
                self.read(first, &mut block[..tangents.len()]);
                for (at, frame) in block[..tangents.len()].iter().enumerate() {
                    tangents[at] = frame.tangent_and_sign();
                    bitangents[at] = frame.bitangent;
                    magnitudes[at] = frame.magnitude;
                }
            }
        });
        Ok(())
    }
}

/// Frames per block of [`CompactFrames::read_apart`].
const BLOCK: usize = 64;

fn run(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    limits: RunLimits<'_>,
    memory: &mut TangentMemory,
    out: &mut [Frame],
) -> Report {
    let Some(report) = run_fast(mesh, options, limits, memory) else {
        return run_without_fast(mesh, options, limits, &mut memory.sums, out);
    };
    if limits.is_cancelled() {
        return report;
    }
    let frames = CompactFrames { mesh, fast: &memory.fast, memory: &memory.frames, limits, report };
    let threads = limits.thread_count(triangle_count(mesh));
    let ranges = split_range(0..out.len(), threads, 1);
    threads::run(
        &mut vec![(); threads],
        ranges.clone().zip(split_slice(out, 0, ranges)),
        |(), (range, out)| {
            frames.read(range.start, out);
        },
    );
    report
}

/// Runs the method that the options name; MikkTSpace by its exact stages.
fn run_without_fast(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    limits: RunLimits<'_>,
    buffers: &mut MethodBuffers,
    out: &mut [Frame],
) -> Report {
    methods::run(mesh, options.method, limits, buffers, out, |options, out| {
        mikktspace::run(mesh, options, limits, out)
    })
}

/// Leaves the frames in `memory` where the fast path applies; else returns `None`.
fn run_fast(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    limits: RunLimits<'_>,
    memory: &mut TangentMemory,
) -> Option<Report> {
    let Method::MikkTSpace(options) = &options.method else { return None };
    let TangentMemory { fast, frames: FrameMemory { tangents, decided, frames }, .. } = memory;
    frames.clear();
    tangents.resize(mesh.corner_count(), [0.0; 4]);
    fast.run_with_bitangents(mesh, options, limits, tangents).then_some(())?;
    decided.clear();
    if limits.is_cancelled() {
        return Some(Report::default());
    }
    Some(submesh::complete_frames(mesh, options, fast, limits, tangents, decided))
}

//! Whole frames: tangents first, then what goes with them, and last each corner's from these.

use crate::CornerFrames;
use crate::Frame;
use crate::Mesh;
use crate::MeshError;
use crate::cancel::Stop;
use crate::split::expect;

use crate::exec::simd::Width;
use crate::exec::threads::{self, parts, split};
use crate::tangents::Frames;
use crate::tangents::Report;
use crate::tangents::Scratch;
use crate::tangents::TangentOptions;
use crate::tangents::fast::{Fans, UNDECIDED, triangle_count};
use crate::tangents::has_whole_fans;
use crate::tangents::method;
use crate::tangents::output::{Output, fill};
use crate::tangents::submesh;

/// The frames of a run, or what they are made of.
#[derive(Debug, Default)]
pub(crate) struct FrameMemory {
    /// Of each corner, for a run of whole fans.
    tangents: Vec<[f32; 4]>,
    /// The frames of the corners that are undecided in `tangents`, ascending.
    decided: Vec<(u32, Frame)>,
    /// Of each corner, for other runs.
    frames: Vec<Frame>,
}

/// Computes the whole frame of every corner: tangent, bitangent, magnitudes, sign.
pub fn generate_frames(mesh: &Mesh<'_>, options: &TangentOptions) -> Frames {
    let mut corners = vec![Frame::EMPTY; mesh.corner_count()];
    let report = run(mesh, options, &Stop::heard(), &mut Scratch::new(), &mut corners);
    Frames { corners: CornerFrames(corners), report }
}

/// As [`generate_frames`], into an array of the caller's, with the memory of earlier runs.
///
/// `corners`: receives one frame per corner, in corner order, which is not vertex order. Errors: an array of another length; a run that
/// was [cancelled](crate::Cancel::run), which leaves anything in `corners`.
pub fn write_frames(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    scratch: &mut Scratch,
    corners: &mut [Frame],
) -> Result<Report, MeshError> {
    expect("corners", mesh.corner_count(), corners.len())?;
    let stop = Stop::heard();
    let report = run(mesh, options, &stop, scratch, corners);
    stop.check().map(|()| report)
}

/// As [`write_frames`], left in the scratch for arrays of any other form: frames are made from what is smaller, as they are read.
pub fn lend_frames<'a>(
    mesh: &'a Mesh<'a>,
    options: &TangentOptions,
    scratch: &'a mut Scratch,
) -> Result<LentFrames<'a>, MeshError> {
    let stop = Stop::heard();
    let report = if let Some(report) = run_fans(mesh, options, &stop, scratch) {
        report
    } else {
        let mut frames = std::mem::take(&mut scratch.frames.frames);
        frames.resize(mesh.corner_count(), Frame::EMPTY);
        scratch.frames.tangents.clear();
        let width = Width::widest(scratch.width_limit);
        let report = method::run(mesh, options, &stop, width, &mut scratch.sums, &mut frames);
        scratch.frames.frames = frames;
        report
    };
    stop.check()?;
    Ok(LentFrames { mesh, fans: &scratch.fans, memory: &scratch.frames, report })
}

/// Frames of corners, one per corner, in corner order, which lie in a [`Scratch`]. Not in vertex order.
#[derive(Clone, Copy, Debug)]
pub struct LentFrames<'a> {
    mesh: &'a Mesh<'a>,
    fans: &'a Fans,
    memory: &'a FrameMemory,
    report: Report,
}

impl LentFrames<'_> {
    /// What was met on the way.
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

    /// Writes the frames of corners from number `first` on, as many as `out` has or there are.
    pub fn write(&self, first: usize, out: &mut [Frame]) {
        let Self { mesh, fans, memory: FrameMemory { tangents, decided, frames }, .. } = self;
        if let Some(frames) = frames.get(first..) {
            fill(out, frames.iter().copied());
        }
        let tangents = tangents.get(first..).unwrap_or_default();
        let count = tangents.len().min(out.len());
        if count == 0 {
            return;
        }
        let out = &mut out[..count];
        fans.write_rest(mesh, first, out);
        let mut decided = &decided[decided.partition_point(|&(corner, _)| (corner as usize) < first)..];
        for (&[x, y, z, sign], out) in tangents.iter().zip(out) {
            if sign != UNDECIDED {
                (out.tangent, out.sign) = ([x, y, z], sign);
            } else if let Some((&(_, frame), others)) = decided.split_first() {
                (*out, decided) = (frame, others);
            }
        }
    }

    /// Writes all of them, the parts apart: tangents with their signs, bitangents, magnitudes. Errors: an array of another length than one
    /// per corner.
    pub fn write_apart(
        &self,
        tangents: &mut [[f32; 4]],
        bitangents: &mut [[f32; 3]],
        magnitudes: &mut [[f32; 2]],
    ) -> Result<(), MeshError> {
        for len in [tangents.len(), bitangents.len(), magnitudes.len()] {
            expect("corners", self.len(), len)?;
        }
        let threads = threads::count(triangle_count(self.mesh));
        let ranges = split(0..self.len(), threads, 1);
        let (tangents, bitangents) =
            (parts(tangents, 0, ranges.clone()), parts(bitangents, 0, ranges.clone()));
        let magnitudes = parts(magnitudes, 0, ranges.clone());
        let jobs = ranges.zip(tangents.zip(bitangents).zip(magnitudes));
        threads::run(&mut vec![(); threads], jobs, |(), (range, ((tangents, bitangents), magnitudes))| {
            let mut block = [Frame::default(); BLOCK];
            let out = tangents
                .chunks_mut(BLOCK)
                .zip(bitangents.chunks_mut(BLOCK))
                .zip(magnitudes.chunks_mut(BLOCK));
            for (first, ((tangents, bitangents), magnitudes)) in range.step_by(BLOCK).zip(out) {
                self.write(first, &mut block[..tangents.len()]);
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

/// Frames that are made at once, on their way into arrays of other forms.
const BLOCK: usize = 64;

fn run(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    stop: &Stop,
    scratch: &mut Scratch,
    out: &mut [Frame],
) -> Report {
    let Some(report) = run_fans(mesh, options, stop, scratch) else {
        let width = Width::widest(scratch.width_limit);
        return method::run(mesh, options, stop, width, &mut scratch.sums, out);
    };
    if stop.is_asked() {
        return report;
    }
    let frames = LentFrames { mesh, fans: &scratch.fans, memory: &scratch.frames, report };
    let threads = threads::count(triangle_count(mesh));
    let ranges = split(0..out.len(), threads, 1);
    threads::run(&mut vec![(); threads], ranges.clone().zip(parts(out, 0, ranges)), |(), (range, out)| {
        frames.write(range.start, out);
    });
    report
}

/// Leaves the frames of a mesh that whole fans suffice for in the scratch; else nothing.
fn run_fans(mesh: &Mesh<'_>, options: &TangentOptions, stop: &Stop, scratch: &mut Scratch) -> Option<Report> {
    if !has_whole_fans(options) {
        return None;
    }
    let width = Width::widest(scratch.width_limit);
    let Scratch { fans, frames: FrameMemory { tangents, decided, frames }, .. } = scratch;
    frames.clear();
    tangents.resize(mesh.corner_count(), [0.0; 4]);
    threads::on_pool(threads::count(triangle_count(mesh)), || {
        fans.run(mesh, options, width, stop, tangents).then(|| fans.add_frames(mesh, width, stop))
    })?;
    decided.clear();
    if stop.is_asked() {
        return Some(Report::default());
    }
    Some(submesh::decide_frames(mesh, options, fans, stop, tangents, decided))
}

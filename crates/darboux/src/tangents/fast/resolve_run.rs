//! Runs the resolution of undecided vertices after the first pass (see `resolve.rs`).

use crate::Frame;
use crate::Indices;
use crate::Mesh;
use crate::exec::limits::RunLimits;
use crate::math::cosine_of_degrees;
use crate::tangents::options::MikkTSpaceOptions;
use crate::tangents::report::Report;

use crate::tangents::fast::resolve::Resolution;
use crate::tangents::fast::state::{FastPath, triangle_list};

impl FastPath {
    /// Writes the tangents of undecided vertices, but for those that the general path has to compute:
    /// `exceptions.undecided` then lists the faces of these. Returns the counts of what was resolved;
    /// `None` where nothing was tried.
    ///
    /// `frames`: where given, receives the corners that were resolved and their full frames.
    pub fn resolve(
        &mut self,
        mesh: &Mesh<'_>,
        options: &MikkTSpaceOptions,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
        frames: Option<&mut Vec<(u32, Frame)>>,
    ) -> Option<Report> {
        let Self { weld, split, exceptions, tail_runs, workers, resolution, .. } = self;
        let list = triangle_list(mesh, weld, split);
        let faces = &mut exceptions.undecided;
        if faces.is_empty() || limits.is_cancelled() {
            return None;
        }
        let Resolution { triangles, fans, .. } = resolution;
        let block = &mut workers[0].block;
        triangles.collect(&list, (faces, weld.count), out, block, frames.is_some(), limits);
        let place = |&edge: &u32| triangles.entry_of(edge);
        let tail_runs: Vec<Vec<u32>> = tail_runs.iter().map(|run| run.iter().map(place).collect()).collect();
        if limits.is_cancelled() {
            return None;
        }
        fans.find(triangles, &tail_runs);
        resolution.find_tangents(cosine_of_degrees(options.threshold));
        resolution.find_left(options.mode, out);
        let report = resolution.write(out);
        if let Some(frames) = frames {
            resolution.list_frames(frames);
        }
        if resolution.leaves_any() {
            let mut is_complete = resolution.triangles.faces().map(|face| resolution.is_complete(face));
            faces.retain(|_| !is_complete.next().unwrap_or(false));
        } else {
            faces.clear();
        }
        Some(report)
    }

    /// The number of vertices of the mesh whose corners have different tangents. `out`: the tangents of all
    /// corners.
    pub fn count_split_vertices(&self, mesh: &Mesh<'_>, out: &[[f32; 4]]) -> usize {
        if matches!(mesh.indices(), Indices::Unindexed) { 0 } else { self.resolution.count_split(mesh, out) }
    }
}

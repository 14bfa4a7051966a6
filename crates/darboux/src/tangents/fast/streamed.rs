//! One thread's way through its windows.

use std::ops::Range;

use crate::exec::limits::RunLimits;
use crate::exec::windows::{Share, WINDOW, Window};
use crate::tangents::fast::accumulator::Vertex;
use crate::tangents::fast::edge_tail::TailCells;
use crate::tangents::fast::input::Source;
use crate::tangents::fast::passes::{Add, AddTerms, Finish, FinishPlanned, Read, Special, Write};
use crate::tangents::fast::quads::mark_doubtful;
use crate::tangents::fast::worker::Worker;

/// What all shares have in common.
#[derive(Clone, Copy)]
pub(crate) struct Stream<'a, S = Unknown> {
    pub source: Source<'a>,
    pub windows: &'a [Window],
    pub tail: &'a TailCells,
    pub signs: S,
    pub limits: RunLimits<'a>,
}

/// The signs of the vertices, where they are known: of those that are decided. Two types, so that a program without plans has no code
/// of theirs.
pub(crate) trait Signs: Copy + Sync {
    fn known(&self) -> Option<&[f32]>;
}

/// Signs that are still to be found.
#[derive(Clone, Copy)]
pub(crate) struct Unknown;

impl Signs for Unknown {
    fn known(&self) -> Option<&[f32]> {
        None
    }
}

impl Signs for &[f32] {
    fn known(&self) -> Option<&[f32]> {
        Some(self)
    }
}

impl<S: Signs> Stream<'_, S> {
    /// Goes through the windows of a share: reads the vertices that each needs first, adds its triangles, finishes vertices that
    /// none needs any more, writes windows whose vertices are finished. Windows with vertices of other shares are left pending.
    pub fn run(&self, share: &Share, worker: &mut Worker, out: &mut [[f32; 4]]) {
        let first_window = share.windows.start;
        let corner = |window: usize| self.source.corners_of(first_window..window).len();
        worker.begin(self.span(share));
        let (mut finished, mut written) = (share.vertices.start.max(worker.first), first_window);
        worker.unused.unseen = finished - share.vertices.start;
        for at in first_window..share.until {
            if self.limits.is_cancelled() {
                break;
            }
            self.read(worker, self.windows[at].end as usize);
            self.add(worker, at);
            let unfinished = match self.windows.get(at + 1) {
                Some(next) if at + 1 < share.until => next.lowest_from_here as usize,
                _ => share.vertices.end,
            };
            let end = unfinished.min(share.vertices.end).min(worker.end()).max(finished);
            self.finish(worker, finished..end);
            finished = end;
            while written <= at && written < share.windows.end {
                let Window { lowest, end, .. } = self.windows[written];
                if (lowest as usize) < share.vertices.start || end as usize > share.vertices.end {
                    worker.pending.push(written);
                } else if end as usize <= finished {
                    let Worker { vertices, first, special, corners, .. } = &mut *worker;
                    let out = &mut out[corner(written)..corner(written + 1)];
                    self.write(written, (vertices, *first as u32), corners, special, out);
                } else {
                    break;
                }
                written += 1;
            }
        }
        worker.unused.unseen += share.vertices.end.saturating_sub(finished);
    }

    /// The vertices of all windows that a share adds.
    fn span(&self, share: &Share) -> Range<usize> {
        let windows = &self.windows[share.windows.start..share.until];
        let lowest = windows.iter().map(|window| window.lowest).min().unwrap_or(0);
        let end = windows.iter().map(|window| window.end).max().unwrap_or(0);
        lowest as usize..end as usize
    }

    /// Makes vertices of the mesh's, up to `end`.
    fn read(&self, worker: &mut Worker, end: usize) {
        let mut start = worker.end();
        while start < end {
            let range = start..(start + WINDOW).min(end);
            let place = range.start - worker.first..range.end - worker.first;
            let (vertices, marks) = (&mut worker.vertices[place.clone()], &mut worker.marks[place]);
            start = range.end;
            worker.read = start - worker.first;
            let rows = self.source.rows(range, &mut worker.rows);
            self.limits.width.run(Read { rows, tail: self.tail, vertices, marks });
        }
    }

    /// Adds a window to its vertices.
    fn add(&self, worker: &mut Worker, at: usize) {
        let range = self.source.window(at);
        let triangles = self.source.triangles(range.clone(), &mut worker.triangles);
        let Worker { block, vertices, marks, first, .. } = worker;
        let first_vertex = *first as u32;
        match self.signs.known() {
            None => {
                self.limits.width.run(Add { triangles, first: first_vertex, block, vertices, marks });
                mark_doubtful(&self.source, range, *first, marks);
            }
            Some(_) => self.limits.width.run(AddTerms { triangles, first: first_vertex, block, vertices }),
        }
    }

    /// Finishes vertices that no later triangle uses.
    fn finish(&self, worker: &mut Worker, range: Range<usize>) {
        if range.is_empty() {
            // A share without vertices of its own can end below the place where its own would start.
            return;
        }
        let place = range.start - worker.first..range.end - worker.first;
        let (vertices, marks) = (&mut worker.vertices[place.clone()], &worker.marks[place]);
        match self.signs.known() {
            None => self.limits.width.run(Finish { vertices, marks, unused: &mut worker.unused }),
            Some(signs) => {
                let signs = &signs[range];
                self.limits.width.run(FinishPlanned { vertices, signs, all_usable: &mut worker.all_usable });
            }
        }
    }

    /// Writes the corners of a window. `vertices`: consecutive ones, and the number of the first.
    pub fn write(
        &self,
        at: usize,
        vertices: (&[Vertex], u32),
        corners: &mut Vec<u32>,
        special: &mut Special,
        out: &mut [[f32; 4]],
    ) {
        let range = self.source.corners_of(at..at + 1);
        let corners = self.source.vertices(range.clone(), corners);
        if self.source.is_cut() {
            self.write_faces::<1>(corners, range.start, vertices, special, out);
        } else {
            self.write_faces::<3>(corners, range.start, vertices, special, out);
        }
    }

    fn write_faces<const N: usize>(
        &self,
        corners: &[u32],
        first_corner: usize,
        (vertices, first_vertex): (&[Vertex], u32),
        special: &mut Special,
        out: &mut [[f32; 4]],
    ) {
        let (faces, out) = (corners.as_chunks::<N>().0, out.as_chunks_mut().0);
        let first = first_corner / N;
        self.limits.width.run(Write { faces, first, vertices, first_vertex, out, special });
    }
}

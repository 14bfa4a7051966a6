//! The faces and corners that need further work after a pass: faces with undecided vertices, for the general
//! path, and corners in the cells of the triangle tail, for the search for the last edges. They are listed
//! when the corners of vertices with [`flags`] are written.

use crate::topology::weld::Point;
use crate::util::radix_sort::{sort, sort_by_key};

use crate::tangents::fast::accumulator::{VertexAccumulator, flags};
use crate::tangents::fast::proof::UNDECIDED;
use crate::tangents::fast::triangle_list::TriangleList;

/// The lists of one thread, or of all threads together.
#[derive(Debug, Default)]
pub(crate) struct Exceptions {
    /// Faces with an undecided vertex, in the numbering of [`Exceptions::note`]. After [`Exceptions::sort`]:
    /// their first triangles.
    pub undecided: Vec<u32>,
    /// Corners in the cells of the triangle tail. After [`Exceptions::sort`]: entries of the triangle list.
    pub in_tail: Vec<Point>,
    sort_buffer: Vec<Point>,
}

impl Exceptions {
    pub fn clear(&mut self) {
        self.undecided.clear();
        self.in_tail.clear();
    }

    /// Lists a face with flagged vertices. `face`: the number of the face; where faces were split, the number
    /// of one corner.
    #[cold]
    pub fn note<const N: usize>(&mut self, face: u32, vertices: [&VertexAccumulator; N]) {
        for (entry, vertex) in (N as u32 * face..).zip(vertices) {
            if vertex.flags() & flags::IN_TAIL != 0 {
                self.in_tail.push(Point { position: vertex.position(), entry });
            }
        }
        if vertices.iter().any(|vertex| vertex.flags() & flags::IS_UNDECIDED != 0) {
            self.undecided.push(face);
        }
    }

    /// Moves the lists of another thread to the end of these.
    pub fn append(&mut self, other: &mut Self) {
        if self.undecided.is_empty() && self.in_tail.is_empty() {
            return std::mem::swap(self, other);
        }
        self.undecided.append(&mut other.undecided);
        self.in_tail.append(&mut other.in_tail);
    }

    /// Sorts both lists. Where faces were split, corners become triangles and entries of the triangle list.
    pub fn sort(&mut self, list: &TriangleList<'_>) {
        sort(&mut self.undecided);
        sort_by_key(&mut self.in_tail, |point| point.entry.into(), &mut self.sort_buffer);
        if !list.is_split() {
            return;
        }
        let mut end = 0;
        self.undecided.retain_mut(|corner| {
            let is_new = *corner >= end;
            if is_new {
                *corner = list.triangles_at(*corner).start;
                end = list.corners_of_face(*corner).end;
            }
            is_new
        });
        for at in 0..self.in_tail.len() {
            let Point { position, entry: corner } = self.in_tail[at];
            let mut points = list.entries(corner).map(|entry| Point { position, entry });
            self.in_tail[at] = points.next().expect("a triangle has the corner");
            self.in_tail.extend(points);
        }
        sort_by_key(&mut self.in_tail, |point| point.entry.into(), &mut self.sort_buffer);
    }

    /// Makes the corners at `entries` undecided, which are all entries of their vertices.
    #[cold]
    pub fn undecide(
        &mut self,
        list: &TriangleList<'_>,
        entries: impl Iterator<Item = u32>,
        out: &mut [[f32; 4]],
    ) {
        for entry in entries {
            out[list.corner(entry) as usize][3] = UNDECIDED;
            let face = list.face_of(entry / 3).start;
            if self.undecided.last() != Some(&face) {
                self.undecided.push(face);
            }
        }
        sort(&mut self.undecided);
        self.undecided.dedup();
    }
}

//! Lookup table from a corner to its welded vertex and its first triangle.

use crate::topology::triangles::{NONE, Triangulation};

/// A corner's welded vertex, and the corners of the first triangle that uses the corner.
pub(crate) struct CornerOrigin {
    pub vertex: u32,
    pub triangle: [u32; 3],
}

/// The lookup table. Good triangles come before degenerate ones.
pub(crate) struct CornerLookup<'a> {
    triangulation: &'a Triangulation,
    /// The first entry of each corner in `good.corners` and `degenerate.corners`, flattened and
    /// concatenated, or [`NONE`].
    entry_of_corner: Vec<u32>,
}

impl<'a> CornerLookup<'a> {
    pub fn new(triangulation: &'a Triangulation, corner_count: usize) -> Self {
        let Triangulation { good, degenerate, .. } = triangulation;
        let mut entry_of_corner = vec![NONE; corner_count];
        let all = good.corners.as_flattened().iter().chain(degenerate.corners.as_flattened());
        for (&corner, entry) in all.zip(0..) {
            let first = &mut entry_of_corner[corner as usize];
            *first = entry.min(*first);
        }
        Self { triangulation, entry_of_corner }
    }

    /// `None` for the corners of unsupported faces.
    pub fn get(&self, corner: u32) -> Option<CornerOrigin> {
        let entry = self.entry_of_corner[corner as usize] as usize;
        let Triangulation { good, degenerate, .. } = self.triangulation;
        let (list, entry) = match entry.checked_sub(3 * good.len()) {
            None => (good, entry),
            Some(entry) => (degenerate, entry),
        };
        let vertex = *list.vertices.as_flattened().get(entry)?;
        Some(CornerOrigin { vertex, triangle: list.corners[entry / 3] })
    }
}

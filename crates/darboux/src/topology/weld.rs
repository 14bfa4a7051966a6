//! Welding: merges corners with equal position, normal and UV into one vertex.
//!
//! Values compare as floats: -0 equals +0, and NaN equals nothing. A welded vertex is named by the corner
//! that represents it. The choice of the representative can change which triangles share a tangent, because
//! edges are sorted by names. So the representative is the reference's, the first corner in this order:
//!
//! ```text
//! sort the corners into 2048 cells along the longest axis of the bounding box (stable)
//! for each cell, recursively:
//!     if the middle of the corners' longest axis is not finite: weld nothing
//!     if no float lies strictly between the ends of that axis:
//!         this is a final range: weld its corners, each to the first equal one
//!     else:
//!         partition the corners at the middle, exchanging from both ends as quicksort does
//!         continue with both parts
//! ```
//!
//! Source: mikktspace.c, `GenerateSharedVerticesIndexList`. We deviate: the reference compares all pairs of a
//! final range; here large ranges go through a hash map.

use crate::Mesh;
use crate::exec::limits::RunLimits;
use crate::math::{V3, equal, sub};
use crate::util::hash_map::InsertionMap;
use crate::util::radix_sort::{MAX_INSERTION_SORT, sort_by_key};

/// The number of cells along the longest axis.
pub(crate) const CELL_COUNT: usize = 2048;

/// Final ranges up to this size are compared pairwise.
const SMALL_RANGE: usize = 24;

/// Returns the welded vertex of every entry of `corners`, named by the corner that represents it.
///
/// `corners`: corner numbers in the order of the triangle list, three per triangle. After cancellation some
/// corners are not merged.
pub(crate) fn weld(mesh: &Mesh<'_>, corners: &[u32], limits: RunLimits<'_>) -> Vec<u32> {
    let mut vertex_of_entry = corners.to_vec();
    if corners.is_empty() {
        return vertex_of_entry;
    }
    let mut buckets = points_by_cell(mesh, corners);
    let mut welder = Welder { mesh, corners, vertex_of_entry: &mut vertex_of_entry };
    for points in buckets.iter_mut().take_while(|_| !limits.is_cancelled()) {
        for_each_final_range(points, &|_| !limits.is_cancelled(), &mut |points| welder.weld_all(points));
    }
    vertex_of_entry
}

/// A corner's position and its entry in the triangle list.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Point {
    pub position: V3,
    pub entry: u32,
}

/// Sorts all corners into cells along the longest axis, in list order within a cell.
fn points_by_cell(mesh: &Mesh<'_>, corners: &[u32]) -> CellBuckets {
    let position = |corner: u32| mesh.positions().get(mesh.vertex_of_corner(corner as usize));
    // The reference starts the box with corner 0, whether or not the list contains that corner, and skips the
    // list's first entry.
    let cells = Cells::of(&Bounds::of(position(0), corners[1..].iter().map(|&corner| position(corner))));
    let point = |(entry, &corner)| Point { position: position(corner), entry };
    let points: Vec<Point> = (0..).zip(corners).map(point).collect();
    let mut buckets = CellBuckets::default();
    buckets.sort(&cells, &points);
    buckets
}

/// The cells along the longest axis of a box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cells {
    pub axis: usize,
    low: f32,
    extent: f32,
}

impl Cells {
    pub fn of(bounds: &Bounds) -> Self {
        let axis = bounds.longest_axis();
        Self { axis, low: bounds.min[axis], extent: bounds.max[axis] - bounds.min[axis] }
    }

    /// The length of a cell along the axis.
    pub fn thickness(&self) -> f32 {
        self.extent / CELL_COUNT as f32
    }

    /// The cell of a position. Quotients that are NaN or exceed 32 bits go to cell 0, as the reference's cast
    /// does on x86-64.
    #[inline]
    pub fn at(&self, position: V3) -> usize {
        let place = CELL_COUNT as f32 * ((position[self.axis] - self.low) / self.extent);
        // The cast turns negative numbers and NaN into 0.
        if place < 2_147_483_648.0 { (place as u32).min(CELL_COUNT as u32 - 1) as usize } else { 0 }
    }
}

/// A set of cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellSet([u64; CELL_COUNT / 64]);

impl Default for CellSet {
    fn default() -> Self {
        Self([0; CELL_COUNT / 64])
    }
}

impl CellSet {
    /// Returns true if the set did not have the cell.
    pub fn insert(&mut self, cell: usize) -> bool {
        let is_new = !self.contains(cell);
        self.0[cell / 64] |= 1 << (cell % 64);
        is_new
    }

    pub fn contains(&self, cell: usize) -> bool {
        self.0[cell / 64] >> (cell % 64) & 1 != 0
    }
}

/// Points sorted into cells (stable). The buffers are reused.
#[derive(Debug, Default)]
pub(crate) struct CellBuckets {
    points: Vec<Point>,
    /// The end of each cell's points. Empty cells may be absent.
    ends: Vec<u32>,
    /// The cell of each point before sorting.
    cells: Vec<u16>,
}

impl CellBuckets {
    /// Replaces the content by `points`, whose entries ascend.
    pub fn sort(&mut self, cells: &Cells, points: &[Point]) {
        // For few points, visiting every cell costs more than comparing.
        if points.len() > MAX_INSERTION_SORT {
            return self.sort_by_counting(cells, points);
        }
        self.points.clear();
        self.points.extend_from_slice(points);
        sort_by_key(&mut self.points, |point| cells.at(point.position) as u64, &mut Vec::new());
        self.ends.clear();
        for same in self.points.chunk_by(|a, b| cells.at(a.position) == cells.at(b.position)) {
            let start = self.ends.last().copied().unwrap_or(0);
            self.ends.push(start + same.len() as u32);
        }
    }

    fn sort_by_counting(&mut self, cells: &Cells, points: &[Point]) {
        self.cells.clear();
        self.cells.extend(points.iter().map(|point| cells.at(point.position) as u16));
        // While filling, each entry of `ends` is the next free slot of its cell, and so grows from the cell's
        // start to its end.
        self.ends.clear();
        self.ends.resize(CELL_COUNT + 1, 0);
        for &cell in &self.cells {
            self.ends[usize::from(cell) + 1] += 1;
        }
        for cell in 0..CELL_COUNT {
            self.ends[cell + 1] += self.ends[cell];
        }
        self.points.resize(points.len(), Point::default());
        for (&point, &cell) in points.iter().zip(&self.cells) {
            let next = &mut self.ends[usize::from(cell)];
            self.points[*next as usize] = point;
            *next += 1;
        }
        self.ends.truncate(CELL_COUNT);
    }

    /// The points of each cell that has some, cell after cell.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut [Point]> {
        let (mut rest, mut start) = (&mut self.points[..], 0);
        let cells = self.ends.iter().map(move |&end| {
            let (cell, later) = std::mem::take(&mut rest).split_at_mut((end - start) as usize);
            (rest, start) = (later, end);
            cell
        });
        cells.filter(|points| !points.is_empty())
    }
}

/// A bounding box. NaN is ignored, except in the first point.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bounds {
    pub min: V3,
    pub max: V3,
}

impl Bounds {
    pub fn of(first: V3, others: impl Iterator<Item = V3>) -> Self {
        let mut bounds = Self { min: first, max: first };
        for position in others {
            for (axis, &value) in position.iter().enumerate() {
                bounds.min[axis] = if value < bounds.min[axis] { value } else { bounds.min[axis] };
                bounds.max[axis] = if value > bounds.max[axis] { value } else { bounds.max[axis] };
            }
        }
        bounds
    }

    /// The axis x, unless another is longer; y only if it is longer than both others.
    fn longest_axis(&self) -> usize {
        let [x, y, z] = sub(self.max, self.min);
        match (y > x && y > z, z > x) {
            (true, _) => 1,
            (_, true) => 2,
            _ => 0,
        }
    }
}

/// Partitions the points of a cell down to final ranges, and calls `visit` with each that the reference
/// welds.
///
/// `wanted`: ranges for which it returns false are skipped.
pub(crate) fn for_each_final_range(
    points: &mut [Point],
    wanted: &impl Fn(&[Point]) -> bool,
    visit: &mut impl FnMut(&[Point]),
) {
    if !wanted(points) {
        return;
    }
    match cut(points) {
        Cut::Final => visit(points),
        Cut::NotFinite => {}
        Cut::At(axis, middle) => {
            let below = partition(points, axis, middle);
            let (below, above) = points.split_at_mut(below);
            for_each_final_range(below, wanted, visit);
            for_each_final_range(above, wanted, visit);
        }
    }
}

/// Where the reference divides some points of a cell.
pub(crate) enum Cut {
    /// It does not, and welds them.
    Final,
    /// It does not, and welds nothing.
    NotFinite,
    /// Along an axis, at a coordinate.
    At(usize, f32),
}

/// The longest axis of the box of some points, and the least and largest coordinate along it.
///
/// As [`Bounds::of`]. Each point is read as a vector of four lanes; the last lane is not used.
fn longest_axis(first: &Point, others: &[Point]) -> (usize, f32, f32) {
    let lanes = |point: &Point| {
        let [x, y, z] = point.position;
        [x, y, z, f32::from_bits(point.entry)]
    };
    let (mut min, mut max) = (lanes(first), lanes(first));
    for point in others {
        let values = lanes(point);
        min = std::array::from_fn(|lane| if values[lane] < min[lane] { values[lane] } else { min[lane] });
        max = std::array::from_fn(|lane| if values[lane] > max[lane] { values[lane] } else { max[lane] });
    }
    let ([x, y, z, _], [a, b, c, _]) = (min, max);
    let axis = Bounds { min: [x, y, z], max: [a, b, c] }.longest_axis();
    (axis, min[axis], max[axis])
}

/// Where the reference divides some points of a cell.
pub(crate) fn cut(points: &[Point]) -> Cut {
    let [first, others @ ..] = points else { return Cut::Final };
    if others.is_empty() {
        return Cut::Final;
    }
    let (axis, low, high) = longest_axis(first, others);
    let middle = 0.5 * (high + low);
    if !middle.is_finite() {
        Cut::NotFinite
    } else if middle >= high || middle <= low {
        Cut::Final
    } else {
        Cut::At(axis, middle)
    }
}

struct Welder<'a, 'm> {
    mesh: &'a Mesh<'m>,
    corners: &'a [u32],
    vertex_of_entry: &'a mut [u32],
}

impl Welder<'_, '_> {
    /// Names every corner of a final range after the first corner that equals it.
    fn weld_all(&mut self, points: &[Point]) {
        if points.len() > SMALL_RANGE {
            return self.weld_hashed(points);
        }
        for (at, point) in points.iter().enumerate() {
            let found = points[..at].iter().find(|earlier| self.equal(earlier.entry, point.entry));
            if let Some(earlier) = found {
                self.vertex_of_entry[point.entry as usize] = self.vertex_of_entry[earlier.entry as usize];
            }
        }
    }

    fn weld_hashed(&mut self, points: &[Point]) {
        let mut first = InsertionMap::new();
        for point in points {
            let (position, normal, uv) = self.values(point.entry);
            let ([x, y, z], [a, b, c], [u, v]) = (position, normal, uv);
            let values = [x, y, z, a, b, c, u, v];
            if values.iter().all(|x| !x.is_nan()) {
                let own = self.corners[point.entry as usize];
                // Adding zero turns -0 into +0, so that equal floats have equal bits.
                let key = values.map(|x| (x + 0.0).to_bits());
                self.vertex_of_entry[point.entry as usize] = *first.get_or_insert_with(&key, || own);
            }
        }
    }

    fn equal(&self, a: u32, b: u32) -> bool {
        let (a, b) = (self.values(a), self.values(b));
        equal(a.0, b.0) && equal(a.1, b.1) && equal(a.2, b.2)
    }

    fn values(&self, entry: u32) -> (V3, V3, [f32; 2]) {
        let vertex = self.mesh.vertex_of_corner(self.corners[entry as usize] as usize);
        (self.mesh.positions().get(vertex), self.mesh.normals().get(vertex), self.mesh.uvs().get(vertex))
    }
}

/// Moves the points below `middle` to the front, exchanging from both ends. Returns their number.
pub(crate) fn partition(points: &mut [Point], axis: usize, middle: f32) -> usize {
    let (mut left, mut right) = (0, points.len());
    loop {
        while left < right && points[left].position[axis] < middle {
            left += 1;
        }
        // NaN is not below `middle`, so it stays on the right.
        while left < right && !(points[right - 1].position[axis] < middle) {
            right -= 1;
        }
        if left == right {
            return left;
        }
        points.swap(left, right - 1);
        left += 1;
        right -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn partition_exchanges_from_both_ends() {
        let mut points: Vec<Point> = [5.0, 1.0, 7.0, f32::NAN, 2.0, 0.0]
            .iter()
            .zip(0..)
            .map(|(&x, entry)| Point { position: [x, 0.0, 0.0], entry })
            .collect();
        assert_eq!(partition(&mut points, 0, 3.0), 3);
        assert_eq!(points.iter().map(|point| point.entry).collect::<Vec<_>>(), [5, 1, 4, 3, 2, 0]);
    }
}

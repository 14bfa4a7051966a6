//! Welding: which corners are one vertex.
//!
//! Corners with equal position, normal and UV (as floats: -0 equals +0, NaN equals nothing) are one vertex. Its name is the
//! corner that represents it, and which one that is can show in the last bits of a tangent: copies may differ in the sign of
//! a zero, and edges are ordered by these names. So the representative is the reference's: the first corner in an order
//! made by
//! 1. sorting the corners into 2048 cells along the longest axis of the bounding box, keeping their order in a cell;
//! 2. in every cell, cutting the box of the corners in half along its longest axis, again and again, with an exchange of
//!    corners from both ends as in quicksort, until a range has no float strictly between its ends.
//!
//! Source: mikktspace.c (M. S. Mikkelsen, 2011), `GenerateSharedVerticesIndexList`; there every final range is compared
//! pairwise, here large ones go through a hash table.

use crate::Mesh;
use crate::math::{V3, equal, sub};
use crate::util::hash_map::InsertionMap;
use crate::util::radix_sort::{FEW, sort_by_key};

pub(crate) const CELLS: usize = 2048;

/// Final ranges up to this size are compared pairwise.
const SMALL_RANGE: usize = 24;

/// The vertex of every entry of `corners`, named by the corner that represents it.
///
/// `corners`: corner ids in the order of the triangle list, three per triangle.
pub(crate) fn weld(mesh: &Mesh<'_>, corners: &[u32]) -> Vec<u32> {
    let mut vertex_of_entry = corners.to_vec();
    if corners.is_empty() {
        return vertex_of_entry;
    }
    let mut by_cell = points_by_cell(mesh, corners);
    let mut welder = Welder { mesh, corners, vertex_of_entry: &mut vertex_of_entry };
    for points in by_cell.each() {
        for_each_final_range(points, &|_| true, &mut |points| welder.weld_all(points));
    }
    vertex_of_entry
}

/// A corner's position and its place in the triangle list.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Point {
    pub position: V3,
    pub entry: u32,
}

/// All corners sorted into cells along the longest axis, in list order within a cell.
fn points_by_cell(mesh: &Mesh<'_>, corners: &[u32]) -> CellBuckets {
    let position = |corner: u32| mesh.positions().get(mesh.vertex_of_corner(corner as usize));
    // The reference seeds the box with its corner id 0, whether or not that is in the list, and leaves out the list's first.
    let cells = Cells::of(&Bounds::of(position(0), corners[1..].iter().map(|&corner| position(corner))));
    let point = |(entry, &corner)| Point { position: position(corner), entry };
    let points: Vec<Point> = (0..).zip(corners).map(point).collect();
    let mut by_cell = CellBuckets::default();
    by_cell.sort(&cells, &points);
    by_cell
}

/// The cells along the longest axis of a box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cells {
    pub axis: usize,
    low: f32,
    pub extent: f32,
}

impl Cells {
    pub fn of(bounds: &Bounds) -> Self {
        let axis = bounds.longest_axis();
        Self { axis, low: bounds.min[axis], extent: bounds.max[axis] - bounds.min[axis] }
    }

    /// The cell of a position. A quotient that is NaN or beyond 32 bits goes to cell 0, as the reference's cast does on x86-64.
    #[inline]
    pub fn at(&self, position: V3) -> usize {
        let place = CELLS as f32 * ((position[self.axis] - self.low) / self.extent);
        if (0.0..2_147_483_648.0).contains(&place) { (place as usize).min(CELLS - 1) } else { 0 }
    }
}

/// Points sorted into cells, in their order within a cell.
#[derive(Debug, Default)]
pub(crate) struct CellBuckets {
    points: Vec<Point>,
    /// Where each cell ends; empty cells may be left out.
    ends: Vec<u32>,
    cells: Vec<u16>,
}

impl CellBuckets {
    /// Sorts points anew, whose entries ascend.
    pub fn sort(&mut self, cells: &Cells, points: &[Point]) {
        // Few are not worth a look at every cell.
        if points.len() > FEW {
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
        // Each cell's entry is the end of the one before, which grows to be its own.
        self.ends.clear();
        self.ends.resize(CELLS + 1, 0);
        for &cell in &self.cells {
            self.ends[usize::from(cell) + 1] += 1;
        }
        for cell in 0..CELLS {
            self.ends[cell + 1] += self.ends[cell];
        }
        self.points.resize(points.len(), Point::default());
        for (&point, &cell) in points.iter().zip(&self.cells) {
            let next = &mut self.ends[usize::from(cell)];
            self.points[*next as usize] = point;
            *next += 1;
        }
        self.ends.truncate(CELLS);
    }

    /// The points of each cell.
    pub fn each(&mut self) -> impl Iterator<Item = &mut [Point]> {
        let (mut rest, mut start) = (&mut self.points[..], 0);
        self.ends.iter().map(move |&end| {
            let (cell, later) = std::mem::take(&mut rest).split_at_mut((end - start) as usize);
            (rest, start) = (later, end);
            cell
        })
    }
}

/// A bounding box in which NaN never counts, unless it is the first.
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

    /// x unless another is longer; y only when it beats both others.
    fn longest_axis(&self) -> usize {
        let [x, y, z] = sub(self.max, self.min);
        match (y > x && y > z, z > x) {
            (true, _) => 1,
            (_, true) => 2,
            _ => 0,
        }
    }
}

/// Cuts the points of a cell in halves down to final ranges, and takes each that the reference welds. Ranges of which nothing is
/// `wanted` are left out.
pub(crate) fn for_each_final_range(
    points: &mut [Point],
    wanted: &impl Fn(&[Point]) -> bool,
    take: &mut impl FnMut(&[Point]),
) {
    if !wanted(points) {
        return;
    }
    if points.len() < 2 {
        return take(points);
    }
    let bounds = Bounds::of(points[0].position, points[1..].iter().map(|point| point.position));
    let axis = bounds.longest_axis();
    let (low, high) = (bounds.min[axis], bounds.max[axis]);
    let middle = 0.5 * (high + low);
    if !middle.is_finite() {
        return;
    }
    if middle >= high || middle <= low {
        return take(points);
    }
    let below = partition(points, axis, middle);
    let (below, above) = points.split_at_mut(below);
    for_each_final_range(below, wanted, take);
    for_each_final_range(above, wanted, take);
}

struct Welder<'a, 'm> {
    mesh: &'a Mesh<'m>,
    corners: &'a [u32],
    vertex_of_entry: &'a mut [u32],
}

impl Welder<'_, '_> {
    /// Gives every corner of a final range the name of the first one that equals it.
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
                // Adding zero turns -0 into +0, so that bits are equal where floats are.
                let key = values.map(|x| (x + 0.0).to_bits());
                self.vertex_of_entry[point.entry as usize] = *first.first(&key, || own);
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

/// Moves the points below `middle` to the front, exchanging from both ends, and returns how many they are.
fn partition(points: &mut [Point], axis: usize, middle: f32) -> usize {
    let (mut left, mut right) = (0, points.len());
    loop {
        while left < right && points[left].position[axis] < middle {
            left += 1;
        }
        // NaN is not below either: it stays on the right.
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

//! The reference's names of the vertices of the triangle tail, as far as the search for the last edges needs
//! them.
//!
//! The reference names a welded vertex after the first of its corners once it has divided the points of the
//! vertex's cell into ranges. So a name lies between the vertex's first and last corner, and these bounds
//! often suffice. Where they do not, the points of the cell are divided, but only down to the range of the
//! vertex that is asked for. The ranges of a cell are a tree, which later searches divide further, so no
//! range is divided twice.

use std::ops::Range;

use crate::math::V3;
use crate::topology::weld::{CELL_COUNT, Cells, Cut, Point, cut, partition};

use crate::tangents::fast::triangle_list::TriangleList;

/// The names of vertices, as far as they are known. The memory is reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct TailNames {
    /// The bounds of the name of each welded vertex with a corner in the tail.
    bounds: Vec<NameBounds>,
    /// The vertices that have bounds.
    bounded: Vec<u32>,
    /// The cell of each point, where the caller does not know it.
    cell_of_point: Vec<u16>,
    /// The points in the order of their cells, by entry within a cell, once a cell was searched. Then
    /// divided as far as the searches needed.
    points: Vec<Point>,
    /// The ranges of points: those of whole cells, then those into which searches have divided them.
    ranges: Vec<PointRange>,
    /// The range of each cell, or [`NO_POINTS`].
    range_of_cell: Vec<u16>,
}

/// Marks cells without points.
const NO_POINTS: u16 = u16::MAX;

/// A range of points.
#[derive(Clone, Copy, Debug, Default)]
struct PointRange {
    start: u32,
    end: u32,
    division: Division,
}

/// How a range of points is divided.
#[derive(Clone, Copy, Debug, Default)]
enum Division {
    /// No search has asked for it yet.
    #[default]
    Unknown,
    /// Not at all, and the vertices of the points have names.
    Undivided,
    /// Along an axis, at a coordinate. The number of the range below it; the range above it is the next.
    At(usize, f32, u32),
}

/// All entries of the vertices in some cells.
#[derive(Clone, Copy)]
pub(crate) struct TailEntries<'a> {
    pub list: TriangleList<'a>,
    pub cells: &'a Cells,
    /// Ascending.
    pub points: &'a [Point],
    /// The cell of each point, if it is known.
    pub cell_of_point: Option<&'a [u16]>,
}

/// The lowest and the highest name that a vertex can have. All bits are zero for a vertex without corners, so
/// that the operating system clears the memory of a large mesh, and only where it is used.
#[derive(Clone, Copy, Debug, Default)]
struct NameBounds {
    not_low: u32,
    after_high: u32,
}

impl NameBounds {
    fn exactly(name: u32) -> Self {
        Self { not_low: !name, after_high: name + 1 }
    }

    fn add(&mut self, corner: u32) {
        self.not_low = self.not_low.max(!corner);
        self.after_high = self.after_high.max(corner + 1);
    }

    fn low(self) -> u32 {
        if self.after_high == 0 { 0 } else { !self.not_low }
    }

    fn high(self) -> u32 {
        self.after_high.saturating_sub(1)
    }
}

impl TailNames {
    /// Forgets all names. Gives bounds to the vertices of the triangles from `start` on; their earlier
    /// corners are not yet counted.
    pub fn start(&mut self, list: &TriangleList<'_>, vertex_count: usize, start: usize) {
        self.points.clear();
        self.bounded.drain(..).for_each(|vertex| self.bounds[vertex as usize] = NameBounds::default());
        if self.bounds.len() < vertex_count {
            self.bounds = vec![NameBounds::default(); vertex_count];
        }
        for corner in (start as u32..list.count() as u32).flat_map(|triangle| list.corners(triangle)) {
            let vertex = list.vertex(corner);
            let bounds = &mut self.bounds[vertex as usize];
            if bounds.after_high == 0 {
                self.bounded.push(vertex);
            }
            bounds.add(corner);
        }
    }

    /// True where some of the vertices of a triangle have bounds.
    #[inline(always)]
    pub fn has_bounded(&self, vertices: [u32; 3]) -> bool {
        let [a, b, c] = vertices.map(|vertex| self.bounds[vertex as usize].after_high);
        a | b | c != 0
    }

    /// Adds the corners of a triangle to the bounds of those of its vertices that have bounds. Returns the
    /// number of these.
    pub fn add_to_bounded(&mut self, vertices: [u32; 3], corners: [u32; 3]) -> u32 {
        let mut bounded = 0;
        for (vertex, corner) in vertices.into_iter().zip(corners) {
            let bounds = &mut self.bounds[vertex as usize];
            if bounds.after_high != 0 {
                bounds.add(corner);
                bounded += 1;
            }
        }
        bounded
    }

    /// True for vertices whose names are not known and may be `least` or more.
    pub fn is_unclear(&self, vertex: u32, least: u32) -> bool {
        let bounds = self.bounds[vertex as usize];
        bounds.high() >= least && bounds.low() < bounds.high()
    }

    /// The two vertices of a triangle whose names can be largest, and the largest names that they can have,
    /// the lower first.
    pub fn largest(&self, vertices: [u32; 3]) -> [(u32, u32); 2] {
        let [a, b, c] = vertices.map(|vertex| (self.bounds[vertex as usize].high(), vertex));
        let (low, high) = if b < a { (b, a) } else { (a, b) };
        if c < low {
            [low, high]
        } else if c < high {
            [c, high]
        } else {
            [high, c]
        }
    }

    /// The least lower name that the edge between the two vertices of a triangle with the largest names can
    /// have.
    pub fn least_lower(&self, vertices: [u32; 3]) -> u32 {
        let [a, b, c] = vertices.map(|vertex| self.bounds[vertex as usize].low());
        let (low, high) = if b < a { (b, a) } else { (a, b) };
        low.max(high.min(c))
    }

    /// Finds the names of those of `vertices` whose names may be `least` or more.
    pub fn resolve(&mut self, entries: &TailEntries<'_>, vertices: [u32; 3], least: u32) {
        for vertex in vertices {
            if self.is_unclear(vertex, least) {
                self.search_cell_of(entries, vertex);
            }
        }
    }

    /// Finds the names of all vertices at the position of one.
    fn search_cell_of(&mut self, entries: &TailEntries<'_>, vertex: u32) {
        let position = entries.list.position(vertex);
        if self.points.is_empty() {
            self.group_by_cell(entries);
        }
        let cell = self.range_of_cell[entries.cells.at(position)];
        for point in self.points_at(usize::from(cell), position).rev() {
            // The points are visited from the last to the first, so that the corner at the first entry of
            // each vertex remains its name.
            let Point { entry, .. } = self.points[point];
            let corner = entries.list.corner(entry);
            let bounds = &mut self.bounds[entries.list.vertex(corner) as usize];
            if bounds.after_high != 0 {
                *bounds = NameBounds::exactly(corner);
            }
        }
    }

    /// The points at a position within a range, divided from the others as far as the reference divides them.
    /// None at the second search, because they have names then.
    fn points_at(&mut self, mut range: usize, position: V3) -> Range<usize> {
        loop {
            let PointRange { start, end, division } = self.ranges[range];
            let found = start as usize..end as usize;
            match division {
                Division::At(axis, middle, below) => {
                    range = below as usize + usize::from(position[axis] >= middle);
                }
                Division::Undivided => return 0..0,
                Division::Unknown => match cut(&self.points[found.clone()]) {
                    Cut::At(axis, middle) => {
                        let above = start + partition(&mut self.points[found], axis, middle) as u32;
                        self.ranges[range].division = Division::At(axis, middle, self.ranges.len() as u32);
                        for (start, end) in [(start, above), (above, end)] {
                            self.ranges.push(PointRange { start, end, division: Division::Unknown });
                        }
                    }
                    Cut::Final => {
                        self.ranges[range].division = Division::Undivided;
                        return found;
                    }
                    Cut::NotFinite => return 0..0,
                },
            }
        }
    }

    /// Groups the points by their cells, by counting.
    fn group_by_cell(&mut self, entries: &TailEntries<'_>) {
        let Self { cell_of_point, points, ranges, range_of_cell, .. } = self;
        let cell_of_point = entries.cell_of_point.unwrap_or_else(|| {
            cell_of_point.clear();
            let cells = entries.points.iter().map(|point| entries.cells.at(point.position) as u16);
            cell_of_point.extend(cells);
            cell_of_point
        });
        range_of_cell.clear();
        range_of_cell.resize(CELL_COUNT, NO_POINTS);
        ranges.clear();
        for &cell in cell_of_point {
            let range = &mut range_of_cell[usize::from(cell)];
            if *range == NO_POINTS {
                *range = ranges.len() as u16;
                ranges.push(PointRange::default());
            }
            ranges[usize::from(*range)].end += 1;
        }
        // While filling, each end is the next free slot of its cell, and so grows from the cell's start to
        // its end.
        let mut start = 0;
        for range in &mut *ranges {
            let len = range.end;
            (range.start, range.end) = (start, start);
            start += len;
        }
        points.resize(entries.points.len(), Point::default());
        for (&cell, &point) in cell_of_point.iter().zip(entries.points) {
            let next = &mut ranges[usize::from(range_of_cell[usize::from(cell)])].end;
            points[*next as usize] = point;
            *next += 1;
        }
    }
}

//! The reference's names of the vertices of the triangle tail, as far as the search for the last edges needs them.
//!
//! The reference names a welded vertex after the first of its corners once it has divided the points of the vertex's cell into ranges. So
//! a name lies between the vertex's first and last corner, and these bounds often suffice. Where they do not, the points of the cell are
//! divided, but only down to the range of the vertex that is asked for. After some searches in one cell it is divided completely, so that
//! the time does not grow with the number of vertices times the size of the cell.

use crate::topology::weld::{CELL_COUNT, Cells, Point, final_range_at, for_each_final_range};

use crate::tangents::fast::triangle_list::TriangleList;

/// After so many searches for single vertices, all vertices of a cell are named.
const SINGLE_SEARCHES: u32 = if cfg!(small_limits) { 1 } else { 16 };

/// The names of vertices, as far as they are known. The memory is reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct TailNames {
    /// The bounds of the name of each welded vertex with a corner in the tail.
    bounds: Vec<NameBounds>,
    /// The vertices that have bounds.
    bounded: Vec<u32>,
    /// The cell of each point, where the caller does not know it.
    cell_of_point: Vec<u16>,
    /// The points in the order of their cells, by entry within a cell, once a cell was searched. Then divided as far as the searches needed;
    /// to divide points again changes nothing.
    points: Vec<Point>,
    /// What was searched of each cell. All values are zero but those of cells with points.
    searched: Vec<Searched>,
    /// The cells with points, in the order of their points.
    cells_with_points: Vec<u16>,
}

/// A cell: the range of its points, and the number of searches.
#[derive(Clone, Copy, Debug, Default)]
struct Searched {
    start: u32,
    end: u32,
    count: u32,
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

/// The lowest and the highest name that a vertex can have. All bits are zero for a vertex without corners, so that the operating system
/// clears the memory of a large mesh, and only where it is used.
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
    /// Forgets all names. Gives bounds to the vertices of the triangles from `start` on; their earlier corners are not yet counted.
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

    /// Adds the corners of a triangle to the bounds of those of its vertices that have bounds. Returns the number of these.
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

    /// The two vertices of a triangle whose names can be largest, and the largest names that they can have, the lower first.
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

    /// The least lower name that the edge between the two vertices of a triangle with the largest names can have.
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

    /// Finds the name of a vertex; after some searches in its cell, the names of all vertices of the cell.
    fn search_cell_of(&mut self, entries: &TailEntries<'_>, vertex: u32) {
        let position = entries.list.position(vertex);
        let cell = entries.cells.at(position);
        if self.points.is_empty() {
            self.group_by_cell(entries);
        }
        let Searched { start, end, count } = &mut self.searched[cell];
        *count += 1;
        let (points, bounds) = (&mut self.points[*start as usize..*end as usize], &mut self.bounds);
        if *count <= SINGLE_SEARCHES {
            let range = final_range_at(points, position);
            let mut entries_of_range = range.iter().map(|point| point.entry);
            if let Some(first) =
                entries_of_range.find(|&entry| entries.list.vertex(entries.list.corner(entry)) == vertex)
            {
                bounds[vertex as usize] = NameBounds::exactly(entries.list.corner(first));
            }
            return;
        }
        for_each_final_range(points, &|_| true, &mut |points| {
            // From the last point to the first, so that the corner at the first entry of each vertex remains its name.
            for corner in points.iter().rev().map(|point| entries.list.corner(point.entry)) {
                let bounds = &mut bounds[entries.list.vertex(corner) as usize];
                if bounds.after_high != 0 {
                    *bounds = NameBounds::exactly(corner);
                }
            }
        });
    }

    /// Groups the points by their cells, by counting. The time depends on the number of points alone, not on that of the cells.
    fn group_by_cell(&mut self, entries: &TailEntries<'_>) {
        let cell_of_point = entries.cell_of_point.unwrap_or_else(|| {
            self.cell_of_point.clear();
            let cells = entries.points.iter().map(|point| entries.cells.at(point.position) as u16);
            self.cell_of_point.extend(cells);
            &self.cell_of_point
        });
        let used = self.cells_with_points.drain(..).map(usize::from);
        used.for_each(|cell| self.searched[cell] = Searched::default());
        self.searched.resize(CELL_COUNT, Searched::default());
        for &cell in cell_of_point {
            let end = &mut self.searched[usize::from(cell)].end;
            if *end == 0 {
                self.cells_with_points.push(cell);
            }
            *end += 1;
        }
        // While filling, each end is the next free slot of its cell, and so grows from the cell's start to its end.
        let mut start = 0;
        for cell in self.cells_with_points.iter().map(|&cell| usize::from(cell)) {
            let len = self.searched[cell].end;
            self.searched[cell] = Searched { start, end: start, count: 0 };
            start += len;
        }
        self.points.resize(entries.points.len(), Point::default());
        for (&cell, &point) in cell_of_point.iter().zip(entries.points) {
            let next = &mut self.searched[usize::from(cell)].end;
            self.points[*next as usize] = point;
            *next += 1;
        }
    }
}

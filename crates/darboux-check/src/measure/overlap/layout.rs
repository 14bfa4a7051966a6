//! [`Layout`]: the triangles of a surface in UV space.

/// A triangle in UV space.
pub type Triangle = [[f64; 2]; 3];

/// The triangles of a surface in UV space.
pub struct Layout<'a> {
    pub uvs: &'a [[f32; 2]],
    /// Three per triangle.
    pub vertex_of_corner: &'a [u32],
}

impl Layout<'_> {
    /// The number of triangles.
    pub fn len(&self) -> usize {
        self.vertex_of_corner.len() / 3
    }

    /// The vertices of a triangle.
    pub fn vertices(&self, number: usize) -> [u32; 3] {
        let first = 3 * number;
        [self.vertex_of_corner[first], self.vertex_of_corner[first + 1], self.vertex_of_corner[first + 2]]
    }

    pub fn uv(&self, vertex: u32) -> [f64; 2] {
        let [u, v] = self.uvs[vertex as usize];
        [f64::from(u), f64::from(v)]
    }

    pub fn triangle(&self, number: usize) -> Triangle {
        let [a, b, c] = self.vertices(number);
        [self.uv(a), self.uv(b), self.uv(c)]
    }
}

/// Twice the signed area.
pub fn doubled_area([a, b, c]: &Triangle) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The lowest and the highest coordinates.
pub fn bounds([a, b, c]: &Triangle) -> [[f64; 2]; 2] {
    let bound =
        |choose: fn(f64, f64) -> f64| [choose(choose(a[0], b[0]), c[0]), choose(choose(a[1], b[1]), c[1])];
    [bound(f64::min), bound(f64::max)]
}

//! [`Tilts`]: how the faces of a surface lean at some points.

/// A point of a triangle: x and y of the face normal in the tangent space of the smoothed one, and where maps
/// are read.
#[derive(Clone, Copy, Debug)]
pub struct Tilt {
    pub tilt: [f64; 2],
    pub uv: [f32; 2],
}

/// Points of some triangles.
#[derive(Debug, Default)]
pub struct Tilts {
    triangles: Vec<TiltedTriangle>,
    points: Vec<Tilt>,
}

/// A triangle with a tangent space.
#[derive(Clone, Copy, Debug)]
struct TiltedTriangle {
    number: u32,
    /// Of the parallelogram in UV space.
    uv_area: f64,
    /// The end of its points.
    end: usize,
}

impl Tilts {
    /// Adds a triangle, by its number and twice its area in UV space.
    pub fn add(&mut self, number: u32, uv_area: f64, points: impl Iterator<Item = Tilt>) {
        self.points.extend(points);
        self.triangles.push(TiltedTriangle { number, uv_area, end: self.points.len() });
    }

    /// The triangles: their numbers, twice their areas in UV space, and their points.
    pub fn iter(&self) -> impl Iterator<Item = (u32, f64, &[Tilt])> {
        let mut first = 0;
        self.triangles.iter().map(move |&TiltedTriangle { number, uv_area, end }| {
            let points = &self.points[first..end];
            first = end;
            (number, uv_area, points)
        })
    }
}

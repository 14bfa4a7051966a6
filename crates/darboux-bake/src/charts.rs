//! The charts of the low surfaces: triangles that are connected in the image.

use std::collections::HashMap;

use crate::LowSurface;
use crate::layout::Placed;

/// The chart of every triangle.
#[derive(Clone, Debug, Default)]
pub struct Charts {
    /// By surface and triangle.
    chart_of_triangle: Vec<Vec<u32>>,
}

impl Charts {
    /// Finds the charts: triangles of a surface belong together where corners have the same position and the
    /// same UV, bit for bit. Charts are numbered in the order of surfaces and of their first triangles.
    pub fn of(low: &[LowSurface<'_>]) -> Self {
        let mut next = 0;
        let chart_of_triangle = low.iter().map(|surface| number(surface, &mut next)).collect();
        Self { chart_of_triangle }
    }

    /// The chart of a triangle.
    pub fn of_triangle(&self, placed: &Placed) -> u32 {
        self.chart_of_triangle[placed.surface as usize][placed.triangle as usize]
    }
}

fn number(surface: &LowSurface<'_>, next: &mut u32) -> Vec<u32> {
    let mesh = &surface.mesh;
    let mut first_of_place: HashMap<[u32; 5], u32> = HashMap::new();
    let mut parents: Vec<u32> = (0..surface.triangle_count() as u32).collect();
    for corner in 0..mesh.corner_count() {
        let vertex = mesh.vertex_of_corner(corner);
        let ([x, y, z], [u, v]) = (mesh.positions().get(vertex), mesh.uvs().get(vertex));
        let triangle = (corner / 3) as u32;
        let first = *first_of_place.entry([x, y, z, u, v].map(f32::to_bits)).or_insert(triangle);
        let (a, b) = (root(&mut parents, first), root(&mut parents, triangle));
        parents[a.max(b) as usize] = a.min(b);
    }
    // Roots are the first triangles of their charts, so that their numbers are known before those of the
    // others.
    let mut charts = Vec::with_capacity(parents.len());
    for triangle in 0..parents.len() as u32 {
        let root = root(&mut parents, triangle);
        let chart = if root == triangle { std::mem::replace(next, *next + 1) } else { charts[root as usize] };
        charts.push(chart);
    }
    charts
}

/// The first triangle of the set that has a triangle. Paths are halved on the way.
fn root(parents: &mut [u32], mut triangle: u32) -> u32 {
    while parents[triangle as usize] != triangle {
        let parent = parents[triangle as usize];
        parents[triangle as usize] = parents[parent as usize];
        triangle = parents[triangle as usize];
    }
    triangle
}

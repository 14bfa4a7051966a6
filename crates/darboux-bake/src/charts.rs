//! The charts of the low surfaces: triangles that are connected in the image.

use std::collections::HashMap;

use darboux::internal::DisjointSets;

use crate::LowSurface;
use crate::layout::TileTriangle;

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
    pub fn of_triangle(&self, triangle: &TileTriangle) -> u32 {
        self.chart_of_triangle[triangle.surface as usize][triangle.index as usize]
    }
}

fn number(surface: &LowSurface<'_>, next: &mut u32) -> Vec<u32> {
    let mesh = &surface.mesh;
    let mut first_of_place: HashMap<[u32; 5], usize> = HashMap::new();
    let mut sets = DisjointSets::new(surface.triangle_count());
    for corner in 0..mesh.corner_count() {
        let vertex = mesh.vertex_of_corner(corner);
        let ([x, y, z], [u, v]) = (mesh.positions().get(vertex), mesh.uvs().get(vertex));
        let triangle = corner / 3;
        let first = *first_of_place.entry([x, y, z, u, v].map(f32::to_bits)).or_insert(triangle);
        sets.join(first, triangle);
    }
    // A chart is named by its first triangle, so that its number is known before its other triangles are
    // visited.
    let mut charts = Vec::with_capacity(surface.triangle_count());
    for (triangle, first) in (0..).zip(sets.into_names()) {
        let chart =
            if first == triangle { std::mem::replace(next, *next + 1) } else { charts[first as usize] };
        charts.push(chart);
    }
    charts
}

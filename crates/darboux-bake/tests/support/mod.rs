//! Surfaces that are known in closed form, as low and high meshes.

#![allow(dead_code, reason = "every test file uses a part")]

pub mod shading;

use std::f64::consts::{PI, TAU};

pub use darboux::internal::vectors::double::{cross, dot};
use darboux::{Context, Mesh, TangentOptions, generate_tangents};
use darboux_bake::{BakeOptions, Baked, HighSurface, LowSurface, bake};

pub type Vector = [f64; 3];

/// A mesh with its own arrays.
#[derive(Clone, Default)]
pub struct Shape {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub uvs: Vec<[f32; 2]>,
    pub indices: Vec<u32>,
}

/// A surface over the unit square, with detail along its normals.
#[derive(Clone, Copy)]
pub struct Pair {
    pub name: &'static str,
    pub base: fn(f64, f64) -> Vector,
    /// The height of the detail above the base.
    pub detail: fn(f64, f64) -> f64,
    /// Whether both halves share one half of the image.
    pub is_mirrored: bool,
}

pub const PAIRS: [Pair; 4] = [
    Pair { name: "plane with a height field", base: plane, detail: waves, is_mirrored: false },
    Pair { name: "sphere with waves", base: sphere, detail: waves, is_mirrored: false },
    Pair { name: "torus with bumps", base: torus, detail: bumps, is_mirrored: false },
    Pair { name: "rounded box, mirrored", base: rounded_box, detail: symmetric_bumps, is_mirrored: true },
];

fn plane(u: f64, v: f64) -> Vector {
    [2.0 * u - 1.0, 1.0 - 2.0 * v, 0.0]
}

/// Without its poles.
fn sphere(u: f64, v: f64) -> Vector {
    let (a, b) = (TAU * u, PI * (0.1 + 0.8 * v));
    [b.sin() * a.sin(), b.cos(), b.sin() * a.cos()]
}

fn torus(u: f64, v: f64) -> Vector {
    let (a, b) = (TAU * u, -TAU * v);
    let radius = 1.0 + 0.4 * b.cos();
    [radius * a.sin(), 0.4 * b.sin(), radius * a.cos()]
}

/// A superellipsoid of exponent 4, without its poles.
fn rounded_box(u: f64, v: f64) -> Vector {
    let [x, y, z] = sphere(u, v);
    let size = (x.powi(4) + y.powi(4) + z.powi(4)).powf(0.25);
    [x / size, y / size, z / size]
}

fn waves(u: f64, v: f64) -> f64 {
    0.01 * (TAU * 4.0 * u).sin() * (TAU * 3.0 * v).cos()
}

fn bumps(u: f64, v: f64) -> f64 {
    0.02 * (TAU * 3.0 * u).sin().powi(2) * (TAU * 2.0 * v).sin().powi(2)
}

/// The same in both halves.
fn symmetric_bumps(u: f64, v: f64) -> f64 {
    0.01 * (TAU * 5.0 * u).cos() * (TAU * 4.0 * v).sin()
}

impl Pair {
    /// The base, coarsely.
    pub fn low(&self, cells: usize) -> Shape {
        Shape::grid(cells, self.is_mirrored, |u, v| (self.base)(u, v))
    }

    /// The base with the detail, finely. It is a little longer than the low mesh, so that the rays at the
    /// ends of that hit.
    pub fn high(&self, cells: usize) -> Shape {
        Shape::grid(cells, false, |u, v| self.point(u, 1.02 * v - 0.01))
    }

    /// A point of the surface with the detail.
    pub fn point(&self, u: f64, v: f64) -> Vector {
        let (position, normal) = ((self.base)(u, v), normal(self.base, u, v));
        let height = (self.detail)(u, v);
        [0, 1, 2].map(|i| position[i] + height * normal[i])
    }
}

/// The unit normal of a surface, from central differences; error below 1e-8.
pub fn normal(at: impl Fn(f64, f64) -> Vector, u: f64, v: f64) -> Vector {
    const STEP: f64 = 1e-5;
    let sub = |a: Vector, b: Vector| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let along_u = sub(at(u + STEP, v), at(u - STEP, v));
    let along_v = sub(at(u, v + STEP), at(u, v - STEP));
    unit(cross(along_v, along_u))
}

pub fn unit(v: Vector) -> Vector {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

/// The angle between two unit vectors in degrees, exact also for small angles.
pub fn degrees(a: Vector, b: Vector) -> f64 {
    let sine = cross(a, b);
    dot(sine, sine).sqrt().atan2(dot(a, b)).to_degrees()
}

impl Shape {
    /// A surface over the unit square, in `cells` by `cells` cells, counter-clockwise as seen from the side
    /// of its normals. The UVs are inset, so that the chart has a border; with `mirrored` both halves
    /// share the left half of the image.
    pub fn grid(cells: usize, mirrored: bool, at: impl Fn(f64, f64) -> Vector) -> Self {
        let mut shape = Self::default();
        let side = cells + 1;
        for index in 0..side * side {
            let [u, v] = [index % side, index / side].map(|i| i as f64 / cells as f64);
            shape.positions.push(at(u, v).map(|x| x as f32));
            shape.normals.push(normal(&at, u, v).map(|x| x as f32));
            let u = if mirrored { (2.0 * u - 1.0).abs() } else { u };
            shape.uvs.push([u, v].map(|x| (0.03 + 0.94 * x) as f32));
        }
        for cell in 0..cells * cells {
            let corner = (cell / cells * side + cell % cells) as u32;
            let below = corner + side as u32;
            shape.indices.extend(match mirrored && is_in_second_half(cell % cells, cells) {
                false => [corner, below, below + 1, corner, below + 1, corner + 1],
                true => [corner, below, corner + 1, corner + 1, below, below + 1],
            });
        }
        shape
    }

    pub fn mesh(&self) -> Mesh<'_> {
        Mesh::triangles(&self.positions, &self.normals, &self.uvs, &self.indices).expect("a valid mesh")
    }

    pub fn tangents(&self) -> Vec<[f32; 4]> {
        generate_tangents(&self.mesh(), &TangentOptions::default()).corners.into_per_corner()
    }

    pub fn high(&self) -> HighSurface<'_> {
        HighSurface::new(&self.positions, Some((&self.normals).into()), &self.indices).expect("a valid mesh")
    }
}

/// Whether a column of cells lies in the half of a mirrored shape whose diagonals are mirrored, too:
/// otherwise the halves are different meshes, and one map cannot be right for both.
pub fn is_in_second_half(column: usize, cells: usize) -> bool {
    2 * column >= cells
}

/// Bakes one shape onto another.
pub fn baked(low: &Shape, high: &Shape, options: &BakeOptions) -> Baked {
    let tangents = low.tangents();
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    bake(&[surface], &[high.high()], options, &mut Context::new(), &mut |_| {}).expect("valid input")
}

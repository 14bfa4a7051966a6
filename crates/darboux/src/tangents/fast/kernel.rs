//! A block of triangles, evaluated lane by lane.
//!
//! Every quantity is an array with one entry per triangle, and every stage one loop over them without branches, so that compilers
//! turn it into vector code of whatever width the machine has. Each lane rounds every operation as the scalar code does.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use std::sync::OnceLock;

use crate::math::{V3, acos, add, direction_in_plane, dot, length, not_zero, scale, sub};
use crate::util::hash_map::random_seed;

/// Triangles per block.
pub(crate) const BLOCK: usize = if cfg!(small_limits) { 2 } else { 64 };

type Lane<T> = [T; BLOCK];

/// What is known of one vertex: position, normal, UV.
pub(crate) type Record = [f32; 8];

/// One block's arrays; reused from block to block.
#[derive(Debug)]
pub(crate) struct Block {
    /// The vertices of each triangle.
    pub vertex: [Lane<u32>; 3],
    /// Their records, one component after the other.
    record: [[Lane<f32>; 8]; 3],
    /// Cosines, then angles, of the corners.
    angle: [Lane<f32>; 3],
    /// Unit derivatives.
    s: [Lane<f32>; 3],
    t: [Lane<f32>; 3],
    /// [`marks`] that hold for all three corners.
    face_marks: Lane<u32>,
    /// What each corner adds to its vertex.
    term: [[Lane<f32>; 3]; 3],
    /// What each corner says of its vertex.
    pub marks: [Lane<u32>; 3],
    /// Terms, one corner after the other, and a fourth number (see [`Fourth`]).
    pub sum: [Lane<[f32; 4]>; 3],
    /// What each corner adds to its vertex's fingerprint.
    pub print: [Lane<[u32; 4]>; 3],
    /// The lengths of dP/du and dP/dv, for whole frames,
    magnitude: [Lane<f32>; 2],
    /// and what each corner adds to its vertex's.
    pub magnitude_sum: [Lane<[f32; 2]>; 3],
    /// The records as they lie in vertices, in halves.
    pub packed: [[Lane<[f32; 4]>; 2]; 3],
    key: [u32; 2],
}

/// What goes with a term: 0, 1 where the wedge holds the first ray and else 0, or the marks as bits.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Fourth {
    Nothing,
    Turns,
    Marks,
}

/// 1 where the wedge holds the first ray, else 0.
#[inline(always)]
pub(crate) fn turns(marks: u32) -> f32 {
    if marks & marks::FIRST_RAY == 0 { 0.0 } else { 1.0 }
}

/// What corners say of their vertices, as bits that are OR-ed together.
pub(crate) mod marks {
    /// The directions +u, -u, +v, -v that the corner's wedge in UV space holds.
    pub const RAYS: u32 = 0xf;
    /// The first of them.
    pub const FIRST_RAY: u32 = 1;
    /// Not clearly positive, x y z, then not clearly negative: the tangent's direction in the vertex's plane.
    pub const TANGENT: u32 = 8;
    /// Likewise the bitangent's.
    pub const BITANGENT: u32 = 14;
    pub const ALL_AXES: u32 = 0x3f;
    /// The triangle's UV orientation.
    pub const PRESERVES: u32 = 1 << 20;
    pub const MIRRORS: u32 = 1 << 21;
    /// Something that only the general path decides.
    pub const TROUBLE: u32 = 1 << 22;
    /// The vertex, not the corner, lies in the cells of the list's tail.
    pub const IN_TAIL: u32 = 1 << 23;
}

impl Block {
    /// Takes the vertices of up to [`BLOCK`] triangles, counted from `first`; the lanes beyond them keep what they had.
    #[inline(always)]
    pub fn set(&mut self, triangles: &[[u32; 3]], first: u32) {
        for (i, triangle) in triangles.iter().take(BLOCK).enumerate() {
            for k in 0..3 {
                self.vertex[k][i] = triangle[k].wrapping_sub(first);
            }
        }
    }
}

impl Default for Block {
    fn default() -> Self {
        Self {
            vertex: [[0; BLOCK]; 3],
            record: [[[0.0; BLOCK]; 8]; 3],
            angle: [[0.0; BLOCK]; 3],
            s: [[0.0; BLOCK]; 3],
            t: [[0.0; BLOCK]; 3],
            face_marks: [0; BLOCK],
            term: [[[0.0; BLOCK]; 3]; 3],
            marks: [[0; BLOCK]; 3],
            sum: [[[0.0; 4]; BLOCK]; 3],
            print: [[[0; 4]; BLOCK]; 3],
            magnitude: [[0.0; BLOCK]; 2],
            magnitude_sum: [[[0.0; 2]; BLOCK]; 3],
            packed: [[[[0.0; 4]; BLOCK]; 2]; 3],
            key: key(),
        }
    }
}

impl Block {
    /// From vertices and records to terms, marks and fingerprints.
    #[inline(always)]
    pub fn evaluate(&mut self, fourth: Fourth) {
        self.unpack();
        self.derivatives();
        self.angles();
        self.terms::<true>();
        self.bitangent_marks();
        self.ray_marks();
        self.pack(fourth);
        self.prints();
    }

    /// From records to terms alone. They are NaN where a triangle has no direction.
    #[inline(always)]
    pub fn evaluate_terms(&mut self) {
        self.unpack();
        self.tangent_derivatives();
        self.angles();
        self.terms::<false>();
        self.pack(Fourth::Nothing);
    }

    /// From records to what corners add to bitangents and magnitudes. Anything where a triangle is not good.
    #[inline(always)]
    pub fn evaluate_bitangents(&mut self) {
        self.unpack();
        self.bitangent_derivatives();
        self.angles();
        self.bitangent_terms();
    }

    /// From records to the directions of tangents and bitangents in the planes of the corners' vertices: six numbers in `sum` and
    /// `magnitude_sum`. Anything where a triangle is not good.
    #[inline(always)]
    pub fn evaluate_directions(&mut self) {
        self.unpack();
        self.derivatives();
        for k in 0..3 {
            for i in 0..BLOCK {
                let normal = self.normal(k, i);
                let s = direction_in_plane(normal, [self.s[0][i], self.s[1][i], self.s[2][i]]);
                let t = direction_in_plane(normal, [self.t[0][i], self.t[1][i], self.t[2][i]]);
                self.sum[k][i] = [s[0], s[1], s[2], t[0]];
                self.magnitude_sum[k][i] = [t[1], t[2]];
            }
        }
    }

    #[inline(always)]
    fn unpack(&mut self) {
        for k in 0..3 {
            for half in 0..2 {
                for i in 0..BLOCK {
                    let [a, b, c, d] = self.packed[k][half][i];
                    self.record[k][4 * half][i] = a;
                    self.record[k][4 * half + 1][i] = b;
                    self.record[k][4 * half + 2][i] = c;
                    self.record[k][4 * half + 3][i] = d;
                }
            }
        }
    }

    #[inline(always)]
    fn pack(&mut self, fourth: Fourth) {
        for k in 0..3 {
            for i in 0..BLOCK {
                let [x, y, z] = [0, 1, 2].map(|axis| self.term[k][axis][i]);
                let marks = self.marks[k][i];
                let last = match fourth {
                    Fourth::Nothing => 0.0,
                    Fourth::Turns => turns(marks),
                    Fourth::Marks => f32::from_bits(marks),
                };
                self.sum[k][i] = [x, y, z, last];
            }
        }
    }

    #[inline(always)]
    fn position(&self, k: usize, i: usize) -> V3 {
        [self.record[k][0][i], self.record[k][1][i], self.record[k][2][i]]
    }

    #[inline(always)]
    fn normal(&self, k: usize, i: usize) -> V3 {
        [self.record[k][3][i], self.record[k][4][i], self.record[k][5][i]]
    }

    #[inline(always)]
    fn uv(&self, k: usize, i: usize) -> [f32; 2] {
        [self.record[k][6][i], self.record[k][7][i]]
    }

    /// A triangle's two edges, its UV differences (du1, dv1, du2, dv2), and the products whose difference is twice its UV area.
    #[inline(always)]
    fn edges(&self, i: usize) -> ([V3; 2], [f32; 4], [f32; 2]) {
        let [p0, p1, p2] = [0, 1, 2].map(|k| self.position(k, i));
        let [t0, t1, t2] = [0, 1, 2].map(|k| self.uv(k, i));
        let [du1, dv1] = [t1[0] - t0[0], t1[1] - t0[1]];
        let [du2, dv2] = [t2[0] - t0[0], t2[1] - t0[1]];
        ([sub(p1, p0), sub(p2, p0)], [du1, dv1, du2, dv2], [du1 * dv2, dv1 * du2])
    }

    #[inline(always)]
    fn derivatives(&mut self) {
        for i in 0..BLOCK {
            let ([e1, e2], [du1, dv1, du2, dv2], [left, right]) = self.edges(i);
            let s = sub(scale(dv2, e1), scale(dv1, e2));
            let t = add(scale(-du2, e1), scale(du1, e2));
            let area = left - right;
            let sign = if area > 0.0 { 1.0 } else { -1.0 };
            let (s_length, t_length) = (length(s), length(t));
            let (s, t) = (scale(sign / s_length, s), scale(sign / t_length, t));
            for axis in 0..3 {
                self.s[axis][i] = s[axis];
                self.t[axis][i] = t[axis];
            }
            let size = area.abs();
            let [p0, p1, p2] = [0, 1, 2].map(|k| self.position(k, i));
            let is_good = (size > f32::MIN_POSITIVE)
                & (s_length > f32::MIN_POSITIVE)
                & (t_length > f32::MIN_POSITIVE)
                & (s_length / size > f32::MIN_POSITIVE)
                & (t_length / size > f32::MIN_POSITIVE)
                & (size > AREA_DOUBT * (left.abs() + right.abs()))
                & !(same(p0, p1) | same(p1, p2) | same(p2, p0));
            let orientation = if area > 0.0 { marks::PRESERVES } else { marks::MIRRORS };
            self.face_marks[i] = orientation | if is_good { 0 } else { marks::TROUBLE };
        }
    }

    /// The derivatives by u alone.
    #[inline(always)]
    fn tangent_derivatives(&mut self) {
        for i in 0..BLOCK {
            let ([e1, e2], [_, dv1, _, dv2], [left, right]) = self.edges(i);
            let s = sub(scale(dv2, e1), scale(dv1, e2));
            let sign = if left - right > 0.0 { 1.0 } else { -1.0 };
            let s_length = length(s);
            let sign = if s_length > f32::MIN_POSITIVE { sign } else { f32::NAN };
            let s = scale(sign / s_length, s);
            for axis in 0..3 {
                self.s[axis][i] = s[axis];
            }
        }
    }

    /// The derivatives by v, and the lengths of both.
    #[inline(always)]
    fn bitangent_derivatives(&mut self) {
        for i in 0..BLOCK {
            let ([e1, e2], [du1, dv1, du2, dv2], [left, right]) = self.edges(i);
            let s = sub(scale(dv2, e1), scale(dv1, e2));
            let t = add(scale(-du2, e1), scale(du1, e2));
            let area = left - right;
            let sign = if area > 0.0 { 1.0 } else { -1.0 };
            let t_length = length(t);
            let direction = scale(sign / t_length, t);
            for axis in 0..3 {
                self.t[axis][i] = direction[axis];
            }
            self.magnitude[0][i] = length(s) / area.abs();
            self.magnitude[1][i] = t_length / area.abs();
        }
    }

    #[inline(always)]
    fn bitangent_terms(&mut self) {
        for k in 0..3 {
            for i in 0..BLOCK {
                let t = [self.t[0][i], self.t[1][i], self.t[2][i]];
                let weight = self.angle[k][i];
                let [x, y, z] = scale(weight, direction_in_plane(self.normal(k, i), t));
                self.sum[k][i] = [x, y, z, weight];
                self.magnitude_sum[k][i] = [weight * self.magnitude[0][i], weight * self.magnitude[1][i]];
            }
        }
    }

    #[inline(always)]
    fn angles(&mut self) {
        self.cosines();
        for k in 0..3 {
            for i in 0..BLOCK {
                self.angle[k][i] = acos(self.angle[k][i]);
            }
        }
    }

    #[inline(always)]
    fn cosines(&mut self) {
        for k in 0..3 {
            let [before, after] = [(k + 2) % 3, (k + 1) % 3];
            for i in 0..BLOCK {
                let normal = self.normal(k, i);
                let here = self.position(k, i);
                let to_before = direction_in_plane(normal, sub(self.position(before, i), here));
                let to_after = direction_in_plane(normal, sub(self.position(after, i), here));
                let cosine = dot(to_before, to_after);
                let above = if cosine > 1.0 { 1.0 } else { cosine };
                self.angle[k][i] = if above < -1.0 { -1.0 } else { above };
            }
        }
    }

    /// The terms, and with `MARKS` what they say of the tangents' directions.
    #[inline(always)]
    fn terms<const MARKS: bool>(&mut self) {
        for k in 0..3 {
            for i in 0..BLOCK {
                let s = in_plane(self.normal(k, i), [self.s[0][i], self.s[1][i], self.s[2][i]]);
                let squared = dot(s, s);
                let is_zero = !(not_zero(s[0]) | not_zero(s[1]) | not_zero(s[2]));
                let factor = if is_zero { 1.0 } else { 1.0 / squared.sqrt() };
                let s = scale(factor, s);
                let term = scale(self.angle[k][i], s);
                for axis in 0..3 {
                    self.term[k][axis][i] = term[axis];
                }
                if MARKS {
                    let is_unit = (squared > 1e-30) & (squared < 1e30);
                    let trouble = if is_unit { 0 } else { marks::TROUBLE };
                    self.marks[k][i] = self.face_marks[i] | trouble | axes(s, CLEAR) << marks::TANGENT;
                }
            }
        }
    }

    #[inline(always)]
    fn bitangent_marks(&mut self) {
        for k in 0..3 {
            for i in 0..BLOCK {
                let t = in_plane(self.normal(k, i), [self.t[0][i], self.t[1][i], self.t[2][i]]);
                let size = t[0].abs() + t[1].abs() + t[2].abs();
                let is_sized = (size > 1e-14) & (size < 1e14);
                let trouble = if is_sized { 0 } else { marks::TROUBLE };
                self.marks[k][i] |= trouble | axes(t, CLEAR * size) << marks::BITANGENT;
            }
        }
    }

    #[inline(always)]
    fn ray_marks(&mut self) {
        for i in 0..BLOCK {
            let [t0, t1, t2] = [0, 1, 2].map(|k| self.uv(k, i));
            let flip = if self.face_marks[i] & marks::MIRRORS == 0 { 0 } else { u32::MAX };
            let edges = [edge(t0, t1), edge(t1, t2), edge(t2, t0)];
            for k in 0..3 {
                let (out, back) = (edges[k], edges[(k + 2) % 3]);
                // `back` is seen from its other end.
                let (after, before) = (out & 0xff, back >> 8);
                let (entered, left) = (after & !before, before & !after);
                let (up, down) = ((entered & !flip) | (left & flip), (left & !flip) | (entered & flip));
                self.marks[k][i] |= (up & 5) | (down & 5) << 1;
            }
        }
    }

    /// From vertices to fingerprints.
    #[inline(always)]
    pub fn prints(&mut self) {
        let key = self.key;
        for i in 0..BLOCK {
            let [f0, f1, f2] = [0, 1, 2].map(|k| fingerprint(self.vertex[k][i], key));
            let less = |a: [u32; 4], b: [u32; 4]| [0, 1, 2, 3].map(|lane| a[lane].wrapping_sub(b[lane]));
            self.print[0][i] = less(f1, f2);
            self.print[1][i] = less(f2, f0);
            self.print[2][i] = less(f0, f1);
        }
    }
}

/// Where twice the UV area is below this part of its two products, rounding could have turned its sign.
///
/// Differences and products are right to 2^-24 each, three roundings per product and one for the sum: 2^-21 is twice that.
const AREA_DOUBT: f32 = 1.0 / 2_097_152.0;

/// How large a direction's component must be, against the direction's length, to count as clearly of its sign.
const CLEAR: f32 = 1.0 / 16.0;

#[inline(always)]
fn same(a: V3, b: V3) -> bool {
    (a[0] == b[0]) & (a[1] == b[1]) & (a[2] == b[2])
}

#[inline(always)]
fn in_plane(normal: V3, v: V3) -> V3 {
    sub(v, scale(dot(normal, v), normal))
}

/// Which components are not above `clear`, and which not below `-clear`.
#[inline(always)]
fn axes(v: V3, clear: f32) -> u32 {
    let above = |x: f32, bit: u32| if x > clear { 0 } else { bit };
    let below = |x: f32, bit: u32| if x < -clear { 0 } else { bit };
    (above(v[0], 1) | above(v[1], 2) | above(v[2], 4)) | (below(v[0], 8) | below(v[1], 16) | below(v[2], 32))
}

/// Where `to` is seen from `from`: bit 0 below, bit 2 to the right; and in bits 8 and 10 where `from` is seen from `to`.
#[inline(always)]
fn edge(from: [f32; 2], to: [f32; 2]) -> u32 {
    let bit = |is: bool, bit: u32| if is { bit } else { 0 };
    (bit(to[1] < from[1], 1) | bit(to[0] > from[0], 4))
        | (bit(from[1] < to[1], 0x100) | bit(from[0] > to[0], 0x400))
}

/// What fingerprints are mixed with: chosen by chance when the program runs, so that no mesh can be made to mislead them.
pub(crate) fn key() -> [u32; 2] {
    static KEY: OnceLock<[u32; 2]> = OnceLock::new();
    *KEY.get_or_init(|| {
        let bits = random_seed();
        [bits as u32, (bits >> 32) as u32]
    })
}

/// A vertex's number, its square, and two mixtures of its bits.
#[inline(always)]
pub(crate) fn fingerprint(vertex: u32, key: [u32; 2]) -> [u32; 4] {
    let first = (vertex ^ key[0]).wrapping_mul(0x85eb_ca6b);
    let first = (first ^ first >> 15).wrapping_mul(0xc2b2_ae35);
    let second = (vertex ^ key[1]).wrapping_mul(0x27d4_eb2f);
    let second = (second ^ second >> 13).wrapping_mul(0x1656_67b1);
    [vertex, vertex.wrapping_mul(vertex), first ^ first >> 16, second ^ second >> 16]
}

//! A block of triangles, evaluated lane by lane: from the vertices' values to what each corner adds to its
//! vertex.
//!
//! Every quantity is an array with one element per triangle, and every stage is one loop over these arrays
//! without branches, which compilers turn into vector code of any width. Each lane rounds every operation as
//! scalar code does, in the reference's order.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use crate::math::{V3, acos, add, direction_in_plane, dot, length, not_zero, scale, sub};

use crate::tangents::fast::proof::{
    CLEAR_COMPONENT, MIN_AREA_RATIO, difference, direction_marks, fingerprint, fingerprint_key,
    first_ray_count, marks, ray_marks,
};

/// Triangles per block.
pub(crate) const BLOCK_SIZE: usize = if cfg!(small_limits) { 2 } else { 64 };

/// The vertex of a corner of a triangle, the next vertex of the triangle, and the one before.
pub(crate) type CornerVertices = [u32; 3];

/// The arrays of one block, with one element per triangle. The outer arrays of three have one element per
/// corner or per coordinate.
#[derive(Debug)]
pub(crate) struct TriangleBlock {
    /// The vertices of each triangle, counted from `first` on.
    pub vertex: [[u32; BLOCK_SIZE]; 3],
    first: u32,
    /// The records of these vertices as they lie in memory, in two halves.
    pub packed: [[[[f32; 4]; BLOCK_SIZE]; 2]; 3],
    /// The records, one array per component.
    record: [[[f32; BLOCK_SIZE]; 8]; 3],
    /// First the cosines, then the angles of the corners.
    angle: [[f32; BLOCK_SIZE]; 3],
    /// The unit vector along dP/du.
    s: [[f32; BLOCK_SIZE]; 3],
    /// The unit vector along dP/dv.
    t: [[f32; BLOCK_SIZE]; 3],
    /// The lengths of dP/du and dP/dv.
    magnitude: [[f32; BLOCK_SIZE]; 2],
    /// [`marks`] that all three corners have.
    face_marks: [u32; BLOCK_SIZE],
    /// The weighted tangent of each corner.
    term: [[[f32; BLOCK_SIZE]; 3]; 3],
    /// The marks of each corner.
    pub marks: [[u32; BLOCK_SIZE]; 3],
    /// The weighted tangent as it is added to the vertex, and whether the corner's wedge holds the ray +u (0
    /// or 1).
    pub sum: [[[f32; 4]; BLOCK_SIZE]; 3],
    /// What each corner adds to the lengths of its vertex's derivatives.
    pub magnitude_sum: [[[f32; 2]; BLOCK_SIZE]; 3],
    /// What each corner adds to its vertex's fingerprint.
    pub fingerprint: [[[u32; 4]; BLOCK_SIZE]; 3],
    /// How many triangles without UV area have been counted.
    pub flat_triangles: usize,
    /// True where no triangle is one that the fast path decides. Then all vertices are undecided, and only
    /// marks were computed.
    pub has_marks_only: bool,
}

impl TriangleBlock {
    /// All zeros.
    const EMPTY: Self = Self {
        vertex: [[0; BLOCK_SIZE]; 3],
        first: 0,
        packed: [[[[0.0; 4]; BLOCK_SIZE]; 2]; 3],
        record: [[[0.0; BLOCK_SIZE]; 8]; 3],
        angle: [[0.0; BLOCK_SIZE]; 3],
        s: [[0.0; BLOCK_SIZE]; 3],
        t: [[0.0; BLOCK_SIZE]; 3],
        magnitude: [[0.0; BLOCK_SIZE]; 2],
        face_marks: [0; BLOCK_SIZE],
        term: [[[0.0; BLOCK_SIZE]; 3]; 3],
        marks: [[0; BLOCK_SIZE]; 3],
        sum: [[[0.0; 4]; BLOCK_SIZE]; 3],
        magnitude_sum: [[[0.0; 2]; BLOCK_SIZE]; 3],
        fingerprint: [[[0; 4]; BLOCK_SIZE]; 3],
        flat_triangles: 0,
        has_marks_only: false,
    };
}

impl Default for TriangleBlock {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl TriangleBlock {
    /// Sets the vertices of up to [`BLOCK_SIZE`] triangles, numbered from `first` on. Lanes beyond them keep
    /// their values.
    #[inline(always)]
    pub fn set(&mut self, triangles: &[[u32; 3]], first: u32) {
        self.first = first;
        for (i, triangle) in triangles.iter().take(BLOCK_SIZE).enumerate() {
            for k in 0..3 {
                self.vertex[k][i] = triangle[k].wrapping_sub(first);
            }
        }
    }

    /// Computes terms, marks and fingerprints from vertices and records; of a block that the fast path does
    /// not decide, marks alone.
    #[inline(always)]
    pub fn evaluate(&mut self) {
        self.unpack();
        self.derivatives();
        let all = self.face_marks.iter().fold(u32::MAX, |all, marks| all & marks);
        self.has_marks_only = all & marks::NEEDS_GENERAL_PATH != 0;
        if self.has_marks_only {
            self.marks = [self.face_marks; 3];
            return;
        }
        self.angles();
        self.terms::<true>();
        self.bitangent_marks();
        self.ray_marks();
        self.pack::<true>();
        self.fingerprints();
    }

    /// Counts those of the first `count` triangles that have no UV area.
    #[inline(always)]
    pub fn count_flat(&mut self, count: usize) {
        let mut flat = 0;
        for i in 0..count.min(BLOCK_SIZE) {
            flat += u32::from(self.face_marks[i] & marks::FLAT != 0);
        }
        self.flat_triangles += flat as usize;
    }

    /// Computes terms and marks from records; the marks of rays are absent.
    #[inline(always)]
    pub fn evaluate_marked_terms(&mut self) {
        self.unpack();
        self.derivatives();
        self.angles();
        self.terms::<true>();
        self.bitangent_marks();
        self.pack::<false>();
    }

    /// Computes terms alone from records. They are NaN where a triangle has no direction.
    #[inline(always)]
    pub fn evaluate_terms(&mut self) {
        self.unpack();
        self.tangent_derivatives();
        self.angles();
        self.terms::<false>();
        self.pack::<false>();
    }

    /// As [`Self::evaluate_terms`], for halves of quads. NaN, too, where a bitangent may not be finite: the
    /// reference averages the frames of both halves unless they are equal, and NaN is not equal to
    /// itself.
    #[inline(always)]
    pub fn evaluate_terms_of_quads(&mut self) {
        self.unpack();
        self.derivatives();
        self.angles();
        self.terms::<true>();
        self.bitangent_marks();
        for k in 0..3 {
            for i in 0..BLOCK_SIZE {
                let is_exact = self.marks[k][i] & marks::NEEDS_GENERAL_PATH == 0;
                self.term[k][0][i] = if is_exact { self.term[k][0][i] } else { f32::NAN };
            }
        }
        self.pack::<false>();
    }

    /// Computes derivatives alone from records.
    #[inline(always)]
    pub fn evaluate_derivatives(&mut self) {
        self.unpack();
        self.derivatives();
    }

    /// As [`Self::evaluate_derivatives`], and the angles of the corners.
    #[inline(always)]
    pub fn evaluate_derivatives_and_angles(&mut self) {
        self.evaluate_derivatives();
        self.angles();
    }

    /// Computes from derivatives the directions of tangents and bitangents in the planes of the corners'
    /// normals: six numbers in `sum` and `magnitude_sum`. The result is unspecified for triangles with
    /// [`marks::NEEDS_GENERAL_PATH`].
    #[inline(always)]
    pub fn directions(&mut self) {
        for k in 0..3 {
            for i in 0..BLOCK_SIZE {
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
                for i in 0..BLOCK_SIZE {
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
    fn pack<const MARKS: bool>(&mut self) {
        for k in 0..3 {
            for i in 0..BLOCK_SIZE {
                let [x, y, z] = [0, 1, 2].map(|axis| self.term[k][axis][i]);
                let first_ray_count = if MARKS { first_ray_count(self.marks[k][i]) } else { 0.0 };
                self.sum[k][i] = [x, y, z, first_ray_count];
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

    /// A triangle's two edges, its UV differences (du1, dv1, du2, dv2), and the products whose difference is
    /// twice its UV area.
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
        for i in 0..BLOCK_SIZE {
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
            let (s_magnitude, t_magnitude) = (s_length / size, t_length / size);
            (self.magnitude[0][i], self.magnitude[1][i]) = (s_magnitude, t_magnitude);
            let [p0, p1, p2] = [0, 1, 2].map(|k| self.position(k, i));
            let has_area = (size > f32::MIN_POSITIVE)
                & (s_magnitude > f32::MIN_POSITIVE)
                & (t_magnitude > f32::MIN_POSITIVE);
            let is_degenerate = same(p0, p1) | same(p1, p2) | same(p2, p0);
            let is_good = has_area
                & (s_length > f32::MIN_POSITIVE)
                & (t_length > f32::MIN_POSITIVE)
                & (size > MIN_AREA_RATIO * (left.abs() + right.abs()))
                & !is_degenerate;
            let orientation = if area > 0.0 { marks::PRESERVES } else { marks::MIRRORS };
            let kind = if has_area | is_degenerate { orientation } else { marks::FLAT };
            self.face_marks[i] = kind | if is_good { 0 } else { marks::NEEDS_GENERAL_PATH };
        }
    }

    /// The unit vector along dP/du alone.
    #[inline(always)]
    fn tangent_derivatives(&mut self) {
        for i in 0..BLOCK_SIZE {
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

    /// Computes from derivatives and angles what corners add to bitangents and magnitudes: in `sum` and
    /// `magnitude_sum`. The result is unspecified for triangles with [`marks::NEEDS_GENERAL_PATH`].
    #[inline(always)]
    pub fn bitangent_terms(&mut self) {
        for k in 0..3 {
            for i in 0..BLOCK_SIZE {
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
            for i in 0..BLOCK_SIZE {
                self.angle[k][i] = acos(self.angle[k][i]);
            }
        }
    }

    #[inline(always)]
    fn cosines(&mut self) {
        for k in 0..3 {
            let [before, after] = [(k + 2) % 3, (k + 1) % 3];
            for i in 0..BLOCK_SIZE {
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

    /// The weighted tangents, and with `MARKS` the marks of their directions.
    #[inline(always)]
    fn terms<const MARKS: bool>(&mut self) {
        for k in 0..3 {
            for i in 0..BLOCK_SIZE {
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
                    let unit_mark = if is_unit { 0 } else { marks::NEEDS_GENERAL_PATH };
                    self.marks[k][i] = self.face_marks[i]
                        | unit_mark
                        | direction_marks(s, CLEAR_COMPONENT) << marks::TANGENT;
                }
            }
        }
    }

    #[inline(always)]
    fn bitangent_marks(&mut self) {
        for k in 0..3 {
            for i in 0..BLOCK_SIZE {
                let t = in_plane(self.normal(k, i), [self.t[0][i], self.t[1][i], self.t[2][i]]);
                let size = t[0].abs() + t[1].abs() + t[2].abs();
                let is_sized = (size > 1e-14) & (size < 1e14);
                let size_mark = if is_sized { 0 } else { marks::NEEDS_GENERAL_PATH };
                self.marks[k][i] |=
                    size_mark | direction_marks(t, CLEAR_COMPONENT * size) << marks::BITANGENT;
            }
        }
    }

    #[inline(always)]
    fn ray_marks(&mut self) {
        for i in 0..BLOCK_SIZE {
            let uvs = [0, 1, 2].map(|k| self.uv(k, i));
            let rays = ray_marks(uvs, self.face_marks[i] & marks::MIRRORS != 0);
            for k in 0..3 {
                self.marks[k][i] |= rays[k];
            }
        }
    }

    /// Computes what each corner adds to its vertex's fingerprint: that of the next vertex of the triangle
    /// minus that of the one before.
    #[inline(always)]
    pub fn fingerprints(&mut self) {
        let (key, first) = (fingerprint_key(), self.first);
        for i in 0..BLOCK_SIZE {
            // Written out, since the compiler does not inline a closure of this size into `map`.
            let [v0, v1, v2] = [self.vertex[0][i], self.vertex[1][i], self.vertex[2][i]];
            let f0 = fingerprint(v0.wrapping_add(first), key);
            let f1 = fingerprint(v1.wrapping_add(first), key);
            let f2 = fingerprint(v2.wrapping_add(first), key);
            self.fingerprint[0][i] = difference(f1, f2);
            self.fingerprint[1][i] = difference(f2, f0);
            self.fingerprint[2][i] = difference(f0, f1);
        }
    }

    /// As [`Self::fingerprints`], of single corners: what corner number `i` adds is then `fingerprint[0][i]`.
    #[inline(always)]
    pub fn corner_fingerprints(&mut self, corners: &[CornerVertices]) {
        let key = fingerprint_key();
        self.set(corners, 0);
        for i in 0..BLOCK_SIZE {
            let (next, before) = (fingerprint(self.vertex[1][i], key), fingerprint(self.vertex[2][i], key));
            self.fingerprint[0][i] = difference(next, before);
        }
    }
}

#[inline(always)]
fn same(a: V3, b: V3) -> bool {
    (a[0] == b[0]) & (a[1] == b[1]) & (a[2] == b[2])
}

#[inline(always)]
fn in_plane(normal: V3, v: V3) -> V3 {
    sub(v, scale(dot(normal, v), normal))
}

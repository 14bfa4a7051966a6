//! Numbers to try, and the distance that arithmetic of a GPU may keep.

/// One unit in the last place of 1. Bounds count in it: WGSL and Vulkan let a sum or product be off by 1, a quotient by 2.5, a root by
/// 4.5 of them; contracting a product and a sum into one operation only takes from that.
pub const ULP: f64 = f32::EPSILON as f64;

/// A repeatable sequence of numbers.
pub struct Random(u64);

impl Random {
    /// The sequence of this number.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Any word.
    pub fn word(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as u32
    }

    /// In [-1, 1).
    pub fn number(&mut self) -> f32 {
        self.word() as i32 as f32 / 2f32.powi(31)
    }

    /// In [0, 1).
    pub fn fraction(&mut self) -> f32 {
        0.5 + 0.5 * self.number()
    }

    /// Any direction.
    pub fn direction(&mut self) -> [f32; 3] {
        loop {
            let v = [self.number(), self.number(), self.number()];
            let square = dot(v, v);
            if (1e-4..=1.0).contains(&square) {
                return v.map(|x| (f64::from(x) / square.sqrt()) as f32);
            }
        }
    }

    /// A unit normal and a tangent, unit and perpendicular to it, with a sign.
    pub fn frame(&mut self) -> ([f32; 3], [f32; 4]) {
        let normal = self.direction();
        let [x, y, z] = loop {
            let across = cross(normal, self.direction());
            let size = dot(across, across).sqrt();
            if size > 0.1 {
                break across.map(|x| (f64::from(x) / size) as f32);
            }
        };
        (normal, [x, y, z, if self.word() & 1 == 0 { 1.0 } else { -1.0 }])
    }
}

/// The dot product, in double precision.
pub fn dot(a: [f32; 3], b: [f32; 3]) -> f64 {
    a.into_iter().zip(b).map(|(a, b)| f64::from(a) * f64::from(b)).sum()
}

/// The cross product, each component rounded once.
pub fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    let [a, b] = [a, b].map(|v| v.map(f64::from));
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]].map(|x| x as f32)
}

/// Floats as the words of a sample.
pub fn bits<const N: usize>(floats: [f32; N]) -> [u32; N] {
    floats.map(f32::to_bits)
}

/// `N` floats of a sample, from the word at `start` on.
pub fn floats<const N: usize>(sample: &[u32], start: usize) -> [f32; N] {
    std::array::from_fn(|k| f32::from_bits(sample[start + k]))
}

/// One array out of two.
pub fn joined<T: Copy, const N: usize>(first: &[T], second: &[T]) -> [T; N] {
    std::array::from_fn(|k| if k < first.len() { first[k] } else { second[k - first.len()] })
}

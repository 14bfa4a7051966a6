//! Hashes of vertices, and the range of their values.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use crate::topology::weld::Bounds;

use crate::exec::simd::Task;
use crate::tangents::fast::vertex_record::VertexSlices;

/// Hashes vertices: vertices that are equal as floats have equal hashes. Extends the range of values.
pub(crate) struct HashVertices<'a> {
    pub slices: VertexSlices<'a>,
    pub hashes: &'a mut [u32],
    pub value_range: &'a mut ValueRange,
}

/// Vertices whose components are multiplied together, in lanes.
const HASH_LANES: usize = 16;

/// How many times [`HASH_LANES`] vertices are multiplied before the products are added up.
const HASH_CHUNK: usize = 8;

/// The factor of each component. The hash is the sum of the products, mixed.
const POSITION_FACTORS: [u32; 3] = [0x9e37_79b1, 0x85eb_ca77, 0xc2b2_ae3d];
const NORMAL_FACTORS: [u32; 3] = [0x27d4_eb2f, 0x1656_67b1, 0xd35a_2d97];
const UV_FACTORS: [u32; 2] = [0xb55a_4f09, 0xa3b1_95c5];

impl Task for HashVertices<'_> {
    #[inline(always)]
    fn run(self) {
        let VertexSlices { positions, normals, uvs } = self.slices;
        self.hashes.fill(0);
        self.value_range.add_positions(positions);
        // A loop, so that both share one copy of the code.
        for (values, factors) in [(positions, POSITION_FACTORS), (normals, NORMAL_FACTORS)] {
            add_products::<3, { 3 * HASH_LANES }>(
                values,
                factors,
                self.hashes,
                &mut self.value_range.largest,
            );
        }
        add_products::<2, { 2 * HASH_LANES }>(uvs, UV_FACTORS, self.hashes, &mut self.value_range.largest);
        for hash in self.hashes {
            let mixed = (*hash ^ *hash >> 15).wrapping_mul(0x2c1b_3c6d);
            *hash = mixed ^ mixed >> 14;
        }
    }
}

/// Adds the products of one attribute to the sums, and finds the largest magnitude of its components, as bits
/// without the sign.
///
/// `L` is `N * HASH_LANES`: components lie one after the other, so that one loop over all of them is vector
/// code for any `N`.
#[inline(always)]
fn add_products<const N: usize, const L: usize>(
    values: &[[f32; N]],
    factors: [u32; N],
    sums: &mut [u32],
    largest: &mut u32,
) {
    let factors: [u32; L] = std::array::from_fn(|j| factors[j % N]);
    let mut magnitudes = [0; L];
    let mut products = [[0; L]; HASH_CHUNK];
    for (values, sums) in values.chunks(HASH_CHUNK * HASH_LANES).zip(sums.chunks_mut(HASH_CHUNK * HASH_LANES))
    {
        let (whole, rest) = values.as_flattened().as_chunks();
        let mut padded = [0.0; L];
        padded[..rest.len()].copy_from_slice(rest);
        let last = if rest.is_empty() { None } else { Some(&padded) };
        for (components, products) in whole.iter().chain(last).zip(&mut products) {
            multiply(components, &factors, products, &mut magnitudes);
        }
        // A separate loop: the compiler would split a common one into scalar code.
        for (sum, products) in sums.iter_mut().zip(products.as_flattened().as_chunks::<N>().0) {
            for k in 0..N {
                *sum = sum.wrapping_add(products[k]);
            }
        }
    }
    *largest = magnitudes.into_iter().fold(*largest, u32::max);
}

#[inline(always)]
fn multiply<const L: usize>(
    components: &[f32; L],
    factors: &[u32; L],
    products: &mut [u32; L],
    magnitudes: &mut [u32; L],
) {
    for j in 0..L {
        // Adding zero turns -0 into +0. The bits of short fractions are the highest; the shift moves them
        // down.
        let bits = (components[j] + 0.0).to_bits();
        products[j] = (bits ^ bits >> 15).wrapping_mul(factors[j]);
        let magnitude = bits & !(1 << 31);
        magnitudes[j] = if magnitude > magnitudes[j] { magnitude } else { magnitudes[j] };
    }
}

/// The range of a mesh's values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ValueRange {
    /// The lowest coordinates, as [`ordered`] integers.
    low: [i32; 3],
    /// The highest coordinates, as [`ordered`] integers.
    high: [i32; 3],
    /// The largest magnitude of any component, as bits.
    largest: u32,
}

/// The largest magnitude of a value that is welded here. The reference does not weld values above half the
/// largest float.
const LARGEST_VALUE: f32 = 1e38;

impl Default for ValueRange {
    fn default() -> Self {
        Self { low: [i32::MAX; 3], high: [i32::MIN; 3], largest: 0 }
    }
}

impl ValueRange {
    #[inline(always)]
    fn add_positions(&mut self, positions: &[[f32; 3]]) {
        let mut low = [i32::MAX; 3 * HASH_LANES];
        let mut high = [i32::MIN; 3 * HASH_LANES];
        let (whole, rest) = positions.as_flattened().as_chunks::<{ 3 * HASH_LANES }>();
        for components in whole {
            for j in 0..3 * HASH_LANES {
                let x = ordered(components[j]);
                low[j] = x.min(low[j]);
                high[j] = x.max(high[j]);
            }
        }
        for j in 0..3 * HASH_LANES {
            self.low[j % 3] = low[j].min(self.low[j % 3]);
            self.high[j % 3] = high[j].max(self.high[j % 3]);
        }
        for (j, &component) in rest.iter().enumerate() {
            self.low[j % 3] = ordered(component).min(self.low[j % 3]);
            self.high[j % 3] = ordered(component).max(self.high[j % 3]);
        }
    }

    /// The bounds of all positions. None where a value is too large or not finite.
    pub fn bounds<'a>(ranges: impl Iterator<Item = &'a Self> + Clone) -> Option<Bounds> {
        let low = |axis: usize| ranges.clone().map(|range| range.low[axis]).min();
        let high = |axis: usize| ranges.clone().map(|range| range.high[axis]).max();
        let largest = ranges.clone().map(|range| range.largest).max();
        if largest > Some(LARGEST_VALUE.to_bits()) {
            return None;
        }
        let min = [0, 1, 2].map(|axis| float(low(axis).unwrap_or_default()));
        let max = [0, 1, 2].map(|axis| float(high(axis).unwrap_or_default()));
        Some(Bounds { min, max })
    }
}

/// An integer in the order of floats, -0 below +0. All processors have an instruction for the minimum of
/// integers.
#[inline(always)]
fn ordered(x: f32) -> i32 {
    let bits = x.to_bits() as i32;
    bits ^ ((bits >> 31) as u32 >> 1) as i32
}

/// The float of an [`ordered`] integer.
fn float(ordered: i32) -> f32 {
    f32::from_bits((ordered ^ ((ordered >> 31) as u32 >> 1) as i32) as u32)
}

//! Hashes of vertices, and what values they have.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use crate::topology::weld::Bounds;

use crate::exec::simd::Task;
use crate::tangents::fast::rows::Rows;
use crate::tangents::fast::weld_vertices::Refused;

/// Hashes vertices: equal for those that are equal as floats. Notes what values they have.
pub(crate) struct Hash<'a> {
    pub rows: Rows<'a>,
    pub hashes: &'a mut [u32],
    pub span: &'a mut Span,
}

/// Vertices whose components are taken at once.
const LANES: usize = 16;

/// So many times these are multiplied before they are added up.
const CHUNK: usize = 8;

/// What each component is multiplied with; the hash is the sum, mixed.
const OF_POSITION: [u32; 3] = [0x9e37_79b1, 0x85eb_ca77, 0xc2b2_ae3d];
const OF_NORMAL: [u32; 3] = [0x27d4_eb2f, 0x1656_67b1, 0xd35a_2d97];
const OF_UV: [u32; 2] = [0xb55a_4f09, 0xa3b1_95c5];

impl Task for Hash<'_> {
    #[inline(always)]
    fn run(self) {
        let Rows { positions, normals, uvs } = self.rows;
        self.hashes.fill(0);
        self.span.take_positions(positions);
        // A loop, so that both have one copy of the code.
        for (rows, factors) in [(positions, OF_POSITION), (normals, OF_NORMAL)] {
            add_products::<3, { 3 * LANES }>(rows, factors, self.hashes, &mut self.span.largest);
        }
        add_products::<2, { 2 * LANES }>(uvs, OF_UV, self.hashes, &mut self.span.largest);
        for hash in self.hashes {
            let mixed = (*hash ^ *hash >> 15).wrapping_mul(0x2c1b_3c6d);
            *hash = mixed ^ mixed >> 14;
        }
    }
}

/// Adds the products of one attribute to the sums, and takes the largest size of its components, as bits without the sign.
///
/// `L` is `N * LANES`: components lie one after the other, so that one loop over them all is vector code for any `N`.
#[inline(always)]
fn add_products<const N: usize, const L: usize>(
    rows: &[[f32; N]],
    factors: [u32; N],
    sums: &mut [u32],
    largest: &mut u32,
) {
    let factors: [u32; L] = std::array::from_fn(|j| factors[j % N]);
    let mut sizes = [0; L];
    let mut products = [[0; L]; CHUNK];
    for (rows, sums) in rows.chunks(CHUNK * LANES).zip(sums.chunks_mut(CHUNK * LANES)) {
        let (whole, rest) = rows.as_flattened().as_chunks();
        let mut padded = [0.0; L];
        padded[..rest.len()].copy_from_slice(rest);
        let last = if rest.is_empty() { None } else { Some(&padded) };
        for (components, products) in whole.iter().chain(last).zip(&mut products) {
            multiply(components, &factors, products, &mut sizes);
        }
        // A loop of its own: mixed with the one above it would be taken apart lane by lane.
        for (sum, products) in sums.iter_mut().zip(products.as_flattened().as_chunks::<N>().0) {
            for k in 0..N {
                *sum = sum.wrapping_add(products[k]);
            }
        }
    }
    *largest = sizes.into_iter().fold(*largest, u32::max);
}

#[inline(always)]
fn multiply<const L: usize>(
    components: &[f32; L],
    factors: &[u32; L],
    products: &mut [u32; L],
    sizes: &mut [u32; L],
) {
    for j in 0..L {
        // Adding zero turns -0 into +0. Short fractions have their bits at the top: the shift brings them down.
        let bits = (components[j] + 0.0).to_bits();
        products[j] = (bits ^ bits >> 15).wrapping_mul(factors[j]);
        let size = bits & !(1 << 31);
        sizes[j] = if size > sizes[j] { size } else { sizes[j] };
    }
}

/// What values a mesh has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    /// Of positions, as [`ordered`] numbers.
    low: [i32; 3],
    high: [i32; 3],
    /// The largest size of any component, as bits.
    largest: u32,
}

/// The largest size of a coordinate that is welded here; the reference stops welding at half the largest float.
const LARGEST: f32 = 1e38;

impl Default for Span {
    fn default() -> Self {
        Self { low: [i32::MAX; 3], high: [i32::MIN; 3], largest: 0 }
    }
}

impl Span {
    #[inline(always)]
    fn take_positions(&mut self, positions: &[[f32; 3]]) {
        let mut low = [i32::MAX; 3 * LANES];
        let mut high = [i32::MIN; 3 * LANES];
        let (whole, rest) = positions.as_flattened().as_chunks::<{ 3 * LANES }>();
        for components in whole {
            for j in 0..3 * LANES {
                let x = ordered(components[j]);
                low[j] = x.min(low[j]);
                high[j] = x.max(high[j]);
            }
        }
        for j in 0..3 * LANES {
            self.low[j % 3] = low[j].min(self.low[j % 3]);
            self.high[j % 3] = high[j].max(self.high[j % 3]);
        }
        for (j, &component) in rest.iter().enumerate() {
            self.low[j % 3] = ordered(component).min(self.low[j % 3]);
            self.high[j % 3] = ordered(component).max(self.high[j % 3]);
        }
    }

    /// The bounds of all positions. Refuses values that are too large or not finite.
    pub fn check<'a>(spans: impl Iterator<Item = &'a Self> + Clone) -> Result<Bounds, Refused> {
        let low = |axis: usize| spans.clone().map(|span| span.low[axis]).min();
        let high = |axis: usize| spans.clone().map(|span| span.high[axis]).max();
        let largest = spans.clone().map(|span| span.largest).max();
        if largest > Some(LARGEST.to_bits()) {
            return Err(Refused);
        }
        let min = [0, 1, 2].map(|axis| float(low(axis).unwrap_or_default()));
        let max = [0, 1, 2].map(|axis| float(high(axis).unwrap_or_default()));
        Ok(Bounds { min, max })
    }
}

/// A number in the order of floats (-0 below +0), which has an instruction for the lesser of two everywhere.
#[inline(always)]
fn ordered(x: f32) -> i32 {
    let bits = x.to_bits() as i32;
    bits ^ ((bits >> 31) as u32 >> 1) as i32
}

/// The float of an [`ordered`] number.
fn float(ordered: i32) -> f32 {
    f32::from_bits((ordered ^ ((ordered >> 31) as u32 >> 1) as i32) as u32)
}

//! Compares a normal map with the facets of the mesh that it was baked for. This tells inverted red from
//! inverted green, and bumps from dents.
//!
//! A baker writes the difference between the smoothed normals of the mesh and the normals of the detailed
//! model. Where the detailed model has flat parts, or hard edges with bevels, that difference points to the
//! normal of the mesh's face. So the x and y of the texels correlate with the x and y of the face normals in
//! tangent space, and never with their negation. A map that tiles, or that was made for another mesh, shows
//! no correlation.
//!
//! Every triangle votes with the correlation over a few of its texels. The z score is the sum of the votes
//! over the root of the sum of their squares. That is right for independent votes only. Faces that share
//! their UVs, texels that repeat, and neighbours vote alike, and bumps that all have one shape agree a little
//! with convex faces wherever they lie. So a map of any other mesh may get a large score. Therefore a
//! decision is tested again: from each vote, the vote of the same triangle on the map at another offset is
//! subtracted, and the differences are summed in blocks of the map, which count once each, however many
//! triangles show them (the standard error of clustered data). That shows that the map belongs to the mesh,
//! and not that it was baked from it: studs or domes on the faces lean against all of them. So a decision
//! also needs a map that [flattens](crate::measure::flattening) the faces.

use darboux::TexelLayout;
use darboux_io::image::RgbaImage;

use crate::measure::arrangement::{ARRANGEMENTS, Arrangement};
use crate::measure::facet::{BLOCKS, Facets, MapUse, Sample, samples};
use crate::measure::flattening::flattening;

/// The smallest z score of a decision. Neighbouring triangles are not independent, so it is larger than that
/// of a normal distribution.
const DECIDED: f64 = 6.0;

/// More triangles of a surface are not asked.
const TRIANGLES: usize = 50_000;

/// The smallest root of the mean squared tilt that votes, of face normals and of texels: two codes of 8 bits.
const SMALLEST: f64 = 4.0 / 255.0;

/// The votes of triangles on the arrangements, in the order of their declaration.
#[derive(Clone, Copy, Debug, Default)]
pub struct FacetVotes {
    sums: Sums,
    /// Where the votes alone decide an arrangement: what other tests say.
    tested: Option<Tested>,
}

/// The tests of a decision, per arrangement.
#[derive(Clone, Copy, Debug)]
struct Tested {
    /// The z scores of the blocks.
    registered: [f64; ARRANGEMENTS],
    /// 1 where the texels flatten the faces, -1 where they do so once red and green are both inverted, 0
    /// where neither is shown.
    flattening: [f64; ARRANGEMENTS],
}

impl FacetVotes {
    /// The votes of all surfaces that use a map. A surface that is wound against its normals, or whose
    /// normals are in other axes, has none.
    pub fn of(uses: &[MapUse<'_>], image: &RgbaImage) -> Self {
        let mut sums = Sums::default();
        for facets in uses.iter().filter_map(|map_use| Facets::new(*map_use)) {
            for (.., tilts) in facets.tilts(TRIANGLES).iter() {
                let products = Products::of(samples(tilts, facets.wrap(), image), image, [0; 2]);
                products.votes().into_iter().for_each(|votes| sums.add(votes));
            }
        }
        let is_decided = (0..ARRANGEMENTS).any(|index| sums.z_score(index).abs() >= DECIDED);
        let tested = || Tested { registered: registered(uses, image), flattening: flattening(uses, image) };
        Self { sums, tested: is_decided.then(tested) }
    }

    /// True where the first of the two possibilities of an arrangement is decided, false for the second one;
    /// none without a decision.
    pub fn decide(&self, arrangement: Arrangement) -> Option<bool> {
        let z_score = self.z_score(arrangement);
        let is_baked =
            self.tested.is_some_and(|tested| tested.flattening[arrangement as usize] * z_score > 0.0);
        (z_score.abs() >= DECIDED && is_baked).then_some(z_score > 0.0)
    }

    /// The z score of an arrangement: the smaller one of the votes' and the blocks' z scores.
    pub fn z_score(&self, arrangement: Arrangement) -> f64 {
        let index = arrangement as usize;
        let independent = self.sums.z_score(index);
        match self.tested {
            Some(Tested { registered, .. }) if registered[index] * independent <= 0.0 => 0.0,
            Some(Tested { registered, .. }) => {
                independent.abs().min(registered[index].abs()).copysign(independent)
            }
            None => independent,
        }
    }

    /// The number of triangles that voted.
    pub fn count(&self) -> usize {
        self.sums.count
    }

    /// Votes with this z score of one arrangement, and none of the others, on faces that the map flattens.
    #[cfg(test)]
    pub fn only(arrangement: Arrangement, z_score: f64) -> Self {
        let mut sums = Sums::default();
        (sums.sums[arrangement as usize], sums.squares[arrangement as usize]) = (z_score, 1.0);
        let tested =
            Tested { registered: [z_score; ARRANGEMENTS], flattening: [z_score.signum(); ARRANGEMENTS] };
        Self { sums, tested: Some(tested) }
    }
}

/// The number of offsets.
const OFFSETS: usize = 12;

/// More triangles of a surface are not compared with the map at other offsets.
const OFFSET_TRIANGLES: usize = 10_000;

/// The z scores of the blocks: how much better the triangles agree with the map at its place than at other
/// offsets; 0 where the sum of all votes at one of these is nearly as large.
fn registered(uses: &[MapUse<'_>], image: &RgbaImage) -> [f64; ARRANGEMENTS] {
    let size = [image.width, image.height].map(|side| side as usize);
    // The additive sequence of the plastic number spreads points evenly over a square (Roberts 2018).
    let offset = |number: usize| {
        let number = number as f64;
        let place = [0.754_877_666_246_693 * number, 0.569_840_290_998_053_3 * number];
        [0, 1].map(|i| (place[i].fract() * size[i] as f64) as usize)
    };
    let mut blocks = vec![[0.0; ARRANGEMENTS]; BLOCKS * BLOCKS];
    // At its own place, and at the offsets.
    let mut totals = [[0.0; ARRANGEMENTS]; OFFSETS + 1];
    for facets in uses.iter().filter_map(|map_use| Facets::new(*map_use)) {
        for (.., tilts) in facets.tilts(OFFSET_TRIANGLES).iter() {
            let samples: Vec<Sample> = samples(tilts, facets.wrap(), image).collect();
            let Some(Sample { texel, .. }) = samples.get(samples.len() / 2) else { continue };
            let [column, row] = [0, 1].map(|i| texel[i] * BLOCKS / size[i]);
            let block = &mut blocks[row * BLOCKS + column];
            for (number, total) in totals.iter_mut().enumerate() {
                let weight = if number == 0 { 1.0 } else { -1.0 / OFFSETS as f64 };
                let votes =
                    Products::of(samples.iter().copied(), image, offset(number)).votes().unwrap_or_default();
                block.iter_mut().zip(votes).for_each(|(sum, vote)| *sum += weight * vote);
                total.iter_mut().zip(votes).for_each(|(sum, vote)| *sum += vote);
            }
        }
    }
    std::array::from_fn(|index| {
        let sums = || blocks.iter().map(|block| block[index]);
        let squares = sums().map(|sum| sum * sum).sum::<f64>();
        let of_blocks = if squares > 0.0 { sums().sum::<f64>() / squares.sqrt() } else { 0.0 };
        if stands_out(totals.map(|total| total[index])) { of_blocks } else { 0.0 }
    })
}

/// How many times the votes on a map at its place are at least those at any other offset. Maps that were
/// baked for regular grids, whose facets agree at other offsets, too, have 1.24 and more; a map that a mesh
/// with repeated parts decided by chance had 0.97.
const STANDS_OUT: f64 = 1.2;

/// Whether the first of some values is larger than all others, whatever their signs.
fn stands_out(values: [f64; OFFSETS + 1]) -> bool {
    let largest = values[1..].iter().fold(0.0, |largest: f64, other| largest.max(other.abs()));
    values[0].abs() > STANDS_OUT * largest
}

/// Sums of the votes on the arrangements, and of their squares.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    sums: [f64; ARRANGEMENTS],
    squares: [f64; ARRANGEMENTS],
    count: usize,
}

impl Sums {
    fn z_score(&self, index: usize) -> f64 {
        if self.squares[index] > 0.0 { self.sums[index] / self.squares[index].sqrt() } else { 0.0 }
    }

    /// Adds the votes of a triangle.
    fn add(&mut self, votes: [f64; ARRANGEMENTS]) {
        self.count += 1;
        for (index, vote) in votes.into_iter().enumerate() {
            self.sums[index] += vote;
            self.squares[index] += vote * vote;
        }
    }
}

/// Sums over the samples of a triangle.
#[derive(Default)]
struct Products {
    /// The squares of x and y of the face normal.
    facet: f64,
    /// The squares of x and y of the texels.
    texel: f64,
    /// x and y of the face normal times x and y of the texels.
    products: [[f64; 2]; 2],
    count: u32,
}

impl Products {
    /// `offset`: by how many texels the map is moved.
    fn of(samples: impl Iterator<Item = Sample>, image: &RgbaImage, offset: [usize; 2]) -> Self {
        let mut products = Self::default();
        let size = [image.width, image.height].map(|side| side as usize);
        for Sample { tilt, texel } in samples {
            let [column, row] = [0, 1].map(|i| (texel[i] + offset[i]) % size[i]);
            let texel = image.texels[row * size[0] + column];
            if !TexelLayout::RGBA.holds_normal(texel) {
                continue;
            }
            let [x, y, _] = TexelLayout::RGBA.vector(texel).map(f64::from);
            products.count += 1;
            products.facet += tilt[0] * tilt[0] + tilt[1] * tilt[1];
            products.texel += x * x + y * y;
            products.products[0][0] += tilt[0] * x;
            products.products[0][1] += tilt[0] * y;
            products.products[1][0] += tilt[1] * x;
            products.products[1][1] += tilt[1] * y;
        }
        products
    }

    /// The votes of the triangle; none where it or its texels do not lean.
    fn votes(&self) -> Option<[f64; ARRANGEMENTS]> {
        let least = SMALLEST * SMALLEST * f64::from(self.count);
        let [[xx, xy], [yx, yy]] = self.products;
        let scale = 1.0 / (self.facet * self.texel).sqrt();
        let votes = [xx + yy, xx - yy, yx + xy, yx - xy].map(|product| product * scale);
        (self.facet >= least && self.texel >= least && self.count > 0).then_some(votes)
    }
}

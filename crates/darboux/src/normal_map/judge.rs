//! Judges a normal map by its texels: whether it is the slope of a surface, which way its green points, and
//! what else is odd about it.
//!
//! The slopes p along u and q along v of a surface are derivatives of one height, so dp/dv = dq/du. A map
//! whose green is inverted stores -q, and then the two mixed derivatives have opposite signs. The statistic
//! is their correlation c = sum(dp/dv dq/du) / sqrt(sum (dp/dv)^2 sum (dq/du)^2), which does not depend on
//! the scales of u and v: it is positive for OpenGL's maps (green up) and negative for DirectX's.
//!
//! Every tile of 16 x 16 texels has a correlation of its own, on the map and on the map halved again and
//! again, because noise and rounding hide a gentle surface at full size. The x and y of the vectors stand for
//! the slopes: they are bounded, so a step at the border of a chart cannot outvote a surface. Three numbers
//! sum the evidence up, and `score.rs` weighs them:
//!
//! - the plain votes: the mean over the tiles divided by its standard error, the z score of a level. Each
//!   tile counts alike, so that faint noise of many tiles can outvote the relief of a few;
//! - the relief: the mean of the correlations, each weighted by the energy of the tile's slopes above that of
//!   rounding;
//! - the second witness (`spectrum.rs`), which fails on other maps: how much more of the slopes' energy a
//!   height field explains in one convention than in the other, against the same map with its green shifted
//!   by every offset.
//!
//! Where the plain votes contradict the other two, the relief is in one convention and the fine detail in the
//! other, as in a map that was overlaid with a detail map. The verdict is that of the relief.
//!
//! Exchanged channels keep the sign of c, and show in the energies: for every gradient, dp/du dq/dv and dp/dv
//! dq/du have the same mean (integrate by parts twice), while the Cauchy-Schwarz inequality bounds that mean
//! by the unmixed derivatives. Mixed derivatives that are larger than the unmixed ones therefore belong to
//! exchanged channels.
//!
//! What the texels cannot show: green and red inverted together, or a map turned by 180 degrees, is the map
//! of the surface with bumps for dents. Red inverted alone looks as green inverted alone.

mod fourier;
mod judgement;
mod level;
mod octaves;
mod score;
mod spectrum;
mod texel_counts;

pub use self::judgement::{MapJudgement, MapTiles, MapVerdict, SrgbMistake};
use self::level::Level;
use self::spectrum::Spectrum;
use self::texel_counts::TexelCounts;
use super::texels::{Channel, TexelLayout};
use crate::Error;
use crate::exec::simd::{Task, Width, WidthLimit};

/// Judges a normal map.
///
/// `texels`: row after row, the top row first. `size`: width and height. `layout`: the channels of the
/// vector. Errors: the number of texels is not width times height.
///
/// ```
/// use darboux::{MapVerdict, TexelLayout, judge_normal_map};
///
/// // A field of bumps: the height is sin(x / 5) sin(y / 5), and rows count downwards.
/// let texel = |i: usize| {
///     let (x, y) = ((i % 128) as f32 / 5.0, (i / 128) as f32 / 5.0);
///     let normal = [-x.cos() * y.sin() / 5.0, x.sin() * y.cos() / 5.0, 1.0];
///     normal.map(|x| (127.5 + 127.5 * x / 1.1) as u8)
/// };
/// let texels: Vec<[u8; 3]> = (0..128 * 128).map(texel).collect();
/// let judgement = judge_normal_map(&texels, [128, 128], TexelLayout::RGB)?;
/// assert_eq!(judgement.verdict, MapVerdict::OpenGl);
/// # Ok::<(), darboux::Error>(())
/// ```
pub fn judge_normal_map<C: Channel, const N: usize>(
    texels: &[[C; N]],
    size: [usize; 2],
    layout: TexelLayout<N>,
) -> Result<MapJudgement, Error> {
    let [width, height] = size;
    if width.checked_mul(height) != Some(texels.len()) {
        return Err(Error::ImageSize { width, height, found: texels.len() });
    }
    let mut judge = NormalMapJudge::new(width, layout);
    texels.chunks_exact(width.max(1)).try_for_each(|row| judge.push_row(row))?;
    Ok(judge.judgement())
}

/// Judges a normal map whose rows arrive one after the other, in memory for a few rows.
#[derive(Debug)]
pub struct NormalMapJudge<const N: usize> {
    layout: TexelLayout<N>,
    width: usize,
    evidence: RowEvidence,
}

impl<const N: usize> NormalMapJudge<N> {
    /// A judge of a map of this width.
    pub fn new(width: usize, layout: TexelLayout<N>) -> Self {
        let widths = std::iter::successors(Some(width), |width| Some(width / 2));
        let levels = widths.take_while(|&width| width >= level::TILE);
        let block = Spectrum::new(width).map(|spectrum| spectrum.side());
        let levels = levels.enumerate().map(|(index, width)| Level::new(index, width, block)).collect();
        let texel_counts = TexelCounts::new(layout.z.is_some());
        Self { layout, width, evidence: RowEvidence { texel_counts, levels, row: [const { Vec::new() }; 3] } }
    }

    /// Takes the next row. Texels beyond the width are ignored. Errors: fewer texels than the width; then
    /// nothing is taken.
    pub fn push_row<C: Channel>(&mut self, texels: &[[C; N]]) -> Result<(), Error> {
        let row = texels.get(..self.width);
        let texels = row.ok_or(Error::ImageSize { width: self.width, height: 1, found: texels.len() })?;
        let simd_width = Width::widest(WidthLimit::default());
        simd_width.run(DecodeTask { layout: self.layout, evidence: &mut self.evidence, texels });
        self.evidence.add_row(simd_width);
        Ok(())
    }

    /// The judgement on the rows so far.
    pub fn judgement(&self) -> MapJudgement {
        let evidence = score::combine_levels(&self.evidence.levels);
        let mut judgement = self.evidence.texel_counts.judgement();
        evidence.write(&mut judgement);
        // Values that went through the transfer function of sRGB are too long for normals, and their slopes
        // are still those of a surface.
        let is_gradient = evidence.is_clear_gradient()
            || judgement.srgb_mistake().is_some() && evidence.verdict().is_direction();
        let holds_no_normals = judgement.holds_no_normals() && !is_gradient;
        let (verdict, confidence) = if self.evidence.texel_counts.is_flat() {
            (MapVerdict::Flat, 1.0)
        } else if judgement.is_grey() || judgement.is_object_space() || holds_no_normals {
            (MapVerdict::NoGradient, score::CONFIDENCE_OF_COUNTS)
        } else {
            (evidence.verdict(), evidence.confidence())
        };
        (judgement.verdict, judgement.confidence) = (verdict, confidence as f32);
        judgement
    }

    /// The tiles of the rows so far and their votes.
    pub fn tiles(&self) -> MapTiles {
        let index = score::combine_levels(&self.evidence.levels).level;
        let correlations = self.evidence.levels.get(index).map_or(&[][..], |level| &level.correlations);
        MapTiles {
            side: level::TILE << index,
            columns: (self.width >> index) / level::TILE,
            correlations: correlations.iter().map(|&vote| (!vote.is_nan()).then_some(vote)).collect(),
        }
    }
}

/// Decodes one row, compiled once per vector width.
struct DecodeTask<'a, C, const N: usize> {
    layout: TexelLayout<N>,
    evidence: &'a mut RowEvidence,
    texels: &'a [[C; N]],
}

impl<C: Channel, const N: usize> Task for DecodeTask<'_, C, N> {
    #[inline(always)]
    fn run(self) {
        let Self { layout, evidence, texels } = self;
        layout.decode_row(texels, &mut evidence.row);
        evidence.texel_counts.count_codes(texels, layout);
    }
}

/// What rows of vectors add up to. Not generic, so that it is compiled here, with this crate's optimisations.
#[derive(Debug)]
struct RowEvidence {
    texel_counts: TexelCounts,
    levels: Vec<Level>,
    /// x, y and z of the current row.
    row: [Vec<f32>; 3],
}

impl RowEvidence {
    /// Adds the current row.
    fn add_row(&mut self, width: Width) {
        width.run(AddTask(self));
    }
}

/// Adds the current row, compiled once per vector width.
struct AddTask<'a>(&'a mut RowEvidence);

impl Task for AddTask<'_> {
    #[inline(always)]
    fn run(self) {
        let RowEvidence { texel_counts, levels, row: [x, y, z] } = self.0;
        texel_counts.count_vectors([x, y, z]);
        level::set_invalid_to_nan(x, y);
        level::push(levels, x, y);
    }
}

impl<const N: usize> TexelLayout<N> {
    /// Decodes a row to one array per component.
    #[inline(always)]
    fn decode_row<C: Channel>(&self, texels: &[[C; N]], row: &mut [Vec<f32>; 3]) {
        let [x, y, z] = row;
        for (out, channel) in [(&mut *x, self.x), (&mut *y, self.y)] {
            out.clear();
            out.extend(texels.iter().map(|texel| texel[channel].component_f32()));
        }
        z.clear();
        match self.z {
            Some(channel) => z.extend(texels.iter().map(|texel| texel[channel].component_f32())),
            None => {
                z.extend(x.iter().zip(y).map(|(x, y)| (1.0 - *x * *x - *y * *y).max(0.0).sqrt()));
            }
        }
    }
}

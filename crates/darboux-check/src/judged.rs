//! The core's judgements of maps and tangents with the fields that Python and npm give alike.

use darboux::{Channel, Choice, Error, MapJudgement, MapTiles, NormalMapJudge, RecipeMatch, TexelLayout};
use serde::Serialize;

/// A [`MapJudgement`] with the names of its values, and its tiles.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the core documents the fields")]
#[non_exhaustive]
pub struct ReportedJudgement {
    pub verdict: &'static str,
    pub confidence: f32,
    pub correlation: f32,
    pub z_score: f32,
    pub log_energy_ratio: f32,
    pub texels: usize,
    pub background: usize,
    pub not_unit: usize,
    pub negative_z: usize,
    pub grey: usize,
    pub not_normal: usize,
    pub tiles: ReportedTiles,
}

/// The [`MapTiles`] of a map.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the core documents the fields")]
#[non_exhaustive]
pub struct ReportedTiles {
    pub side: usize,
    pub columns: usize,
    pub correlations: Vec<Option<f32>>,
}

impl ReportedJudgement {
    /// Judges a normal map.
    ///
    /// `texels`: row after row, the top row first, with 2 to 4 `channels` each, of which x, y and, if stored,
    /// z are the first. `size`: width and height. Errors: the number of texels is not width times height.
    ///
    /// # Panics
    /// For another number of channels.
    pub fn of_texels<C: Channel>(texels: &[C], size: [usize; 2], channels: usize) -> Result<Self, Error> {
        match channels {
            2 => Self::of_rows(texels.as_chunks().0, size, TexelLayout::RG),
            3 => Self::of_rows(texels.as_chunks().0, size, TexelLayout::RGB),
            4 => Self::of_rows(texels.as_chunks().0, size, TexelLayout::RGBA),
            _ => panic!("{channels} is not a number of channels"),
        }
    }

    fn of_rows<C: Channel, const N: usize>(
        texels: &[[C; N]],
        [width, height]: [usize; 2],
        layout: TexelLayout<N>,
    ) -> Result<Self, Error> {
        if width.checked_mul(height) != Some(texels.len()) {
            return Err(Error::ImageSize { width, height, found: texels.len() });
        }
        let mut judge = NormalMapJudge::new(width, layout);
        texels.chunks_exact(width.max(1)).try_for_each(|row| judge.push_row(row))?;
        Ok(Self::new(&judge.judgement(), judge.tiles()))
    }

    fn new(judgement: &MapJudgement, tiles: MapTiles) -> Self {
        Self {
            verdict: judgement.verdict.name(),
            confidence: judgement.confidence,
            correlation: judgement.correlation,
            z_score: judgement.z_score,
            log_energy_ratio: judgement.log_energy_ratio,
            texels: judgement.texels,
            background: judgement.background,
            not_unit: judgement.not_unit,
            negative_z: judgement.negative_z,
            grey: judgement.grey,
            not_normal: judgement.not_normal,
            tiles: ReportedTiles {
                side: tiles.side,
                columns: tiles.columns,
                correlations: tiles.correlations,
            },
        }
    }
}

/// A [`RecipeMatch`] with the names of its values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the core documents the fields")]
#[non_exhaustive]
pub struct ReportedRecipe {
    pub method: &'static str,
    pub mode: Option<&'static str>,
    pub flips_v: bool,
    pub from_quads: bool,
    pub writing: &'static str,
    pub bits: u32,
    pub corners: usize,
    pub identical: usize,
    pub close: usize,
    pub sign_flips: usize,
    pub worst: f64,
}

impl From<&RecipeMatch> for ReportedRecipe {
    fn from(found: &RecipeMatch) -> Self {
        Self {
            method: found.recipe.method.name(),
            mode: found.recipe.mode().map(Choice::name),
            flips_v: found.recipe.flips_v,
            from_quads: found.recipe.from_quads,
            writing: found.recipe.writing.name(),
            bits: found.recipe.rounding.bits(),
            corners: found.corners,
            identical: found.identical,
            close: found.close,
            sign_flips: found.sign_flips,
            worst: found.worst,
        }
    }
}

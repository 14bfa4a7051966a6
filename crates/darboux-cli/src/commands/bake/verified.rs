//! `--verify`: the error of the map that was written, in degrees.

use darboux::{Context, Convention};
use darboux_bake::{
    BakeOptions, BakeProgress, ErrorStatistics, Images, LowModel, Mistake, NormalTexture, PreparedSurfaces,
    Verification, VerifiedPlace,
};
use darboux_io::Outputs;
use darboux_io::image::{Channels, PngImage, normal_vectors};
use darboux_io::words::Count;
use serde::Serialize;

use super::arguments::BakeArguments;
use super::failure::BakeFailure;
use super::model::stage_painted;
use super::outputs::scale_of;
use super::pictures;
use super::write::stage;
use crate::heat_scale::HeatRange;
use crate::html_page::raster::Raster;
use crate::terminal::Messages;

/// The share of the progress bar that comparing has, and so has baking.
pub const PROGRESS_UNITS: u64 = 1 << 20;

/// The part of the report about errors. json.txt documents its fields.
#[derive(Debug, Serialize)]
pub struct Verified {
    #[serde(flatten)]
    pub errors: Verification,
    /// By part of the low model.
    pub parts: Vec<PartErrors>,
    #[serde(skip)]
    range: HeatRange,
    heat_map: Option<String>,
    heat_model: Option<String>,
}

/// The errors of a part of the low model.
#[derive(Debug, Serialize)]
pub struct PartErrors {
    /// Of its node or mesh; empty where neither has one.
    pub name: String,
    #[serde(flatten)]
    pub errors: ErrorStatistics,
}

/// The longest side of the picture of errors in a page.
const PAGE_SIDE: u32 = 512;

impl Verified {
    /// Verifies a map and draws its errors.
    #[expect(clippy::too_many_arguments, reason = "each is another part of the run")]
    pub fn new(
        arguments: &BakeArguments,
        surfaces: &PreparedSurfaces<'_>,
        names: &[&str],
        baked: &Images,
        map: &PngImage,
        options: &BakeOptions,
        context: &mut Context,
        messages: &Messages,
        outputs: &mut Outputs,
    ) -> Result<Self, BakeFailure> {
        let texels = normal_vectors(map, Channels::RGB).map_err(|error| error.to_string())?;
        let written = NormalTexture::new(map.size(), texels, options.map_convention, Convention::GLTF)
            .map_err(|error| error.to_string())?;
        let progress = messages.file(&format!("comparing {}", arguments.output.display()), PROGRESS_UNITS);
        let mut tell = move |BakeProgress { done, total }: BakeProgress| progress.set(done, total);
        let errors = surfaces.verify(baked, &written, options, context, &mut tell)?;
        let fitting = || HeatRange::fitting(errors.heat.iter().map(|&degrees| f64::from(degrees)));
        let range = arguments.heat_range.unwrap_or_else(fitting);
        let draw = |path: &std::path::PathBuf| {
            let Raster { size, pixels } = pictures::heat_map(&errors, range, u32::MAX);
            let picture = PngImage::from_rgb(&path.display().to_string(), size, &pixels);
            stage(&picture.map_err(|error| error.to_string())?, path, arguments, outputs)
        };
        let heat_map = arguments.heat_map.as_ref().map(draw).transpose()?;
        let part = |(&name, &errors): (&&str, &ErrorStatistics)| PartErrors { name: name.to_owned(), errors };
        let parts = names.iter().zip(&errors.surfaces).map(part).collect();
        Ok(Self { errors, parts, range, heat_map, heat_model: None })
    }

    /// Stages the low model with these errors as its colours, if that was asked for. Errors are one sentence
    /// each.
    pub fn stage_model(
        &mut self,
        arguments: &BakeArguments,
        low: &LowModel<'_>,
        outputs: &mut Outputs,
    ) -> Result<(), String> {
        let Some(path) = &arguments.heat_model else { return Ok(()) };
        let texture = pictures::heat_texture(&path.display().to_string(), &self.errors, self.range)?;
        let scale = scale_of(path);
        stage(&pictures::scale(&scale.display().to_string(), self.range)?, &scale, arguments, outputs)?;
        self.heat_model = Some(stage_painted(arguments, low, &texture, path, outputs)?);
        Ok(())
    }

    /// The errors over the UV layout, for a page.
    pub fn picture(&self) -> Raster {
        pictures::heat_map(&self.errors, self.range, PAGE_SIDE)
    }

    /// The pictures and models that were written.
    pub fn files(&self) -> impl Iterator<Item = &String> {
        self.heat_map.iter().chain(&self.heat_model)
    }

    /// The statistics with their names, indented below the first one where they are a part of it.
    pub fn rows(&self) -> impl Iterator<Item = (&'static str, &ErrorStatistics)> {
        let Verification { all, rounding, places, mistakes, .. } = &self.errors;
        let found = places.iter().filter(|(_, errors)| errors.points > 0);
        let of_places = found.map(|(place, errors)| (name_of_place(*place), errors));
        let of_mistakes = mistakes.iter().map(|(mistake, errors)| (name_of_mistake(*mistake), errors));
        [("the written map", all), ("  by rounding to its bits", rounding)]
            .into_iter()
            .chain(of_places)
            .chain(of_mistakes)
    }

    /// The statistics as a table.
    pub fn lines(&self) -> Vec<String> {
        let Verification { all, points_without_hit, points_without_frame, .. } = &self.errors;
        let mut lines =
            vec![format!("{:44}{:>9}{:>9}{:>9}{:>9}", "error in degrees", "median", "mean", "95 %", "worst")];
        lines.extend(self.rows().map(|(what, errors)| line(what, errors)));
        for (count, what) in [
            (points_without_hit, "points have no high surface to compare with"),
            (points_without_frame, "points have no tangent frame"),
        ] {
            if *count > 0 {
                lines.push(format!(
                    "{} of {} {what}",
                    Count(count),
                    Count(all.points + points_without_hit + points_without_frame)
                ));
            }
        }
        lines.extend(
            self.heat_map
                .iter()
                .map(|path| format!("{path}: these errors over the UV layout, from {}", self.range)),
        );
        lines.extend(self.heat_model.iter().map(|path| {
            format!(
                "{path}: these errors on the low model, from \
             {}; their scale is in the file of that name that ends in .scale.png",
                self.range
            )
        }));
        lines
    }
}

fn line(what: &str, errors: &ErrorStatistics) -> String {
    let ErrorStatistics { median, mean, p95, worst, .. } = errors;
    format!("{what:44}{median:>9.4}{mean:>9.4}{p95:>9.4}{worst:>9.4}")
}

fn name_of_place(place: VerifiedPlace) -> &'static str {
    match place {
        VerifiedPlace::Inside => "  inside charts",
        VerifiedPlace::Border => "  at the borders of charts",
        VerifiedPlace::Missed => "  beside texels without a hit",
        VerifiedPlace::Overlap => "  where another triangle owns the texels",
        _ => "  elsewhere",
    }
}

fn name_of_mistake(mistake: Mistake) -> &'static str {
    match mistake {
        Mistake::OtherBitangent => "in a renderer with the other --bitangent",
        Mistake::OtherGreen => "in a renderer with the other green",
        Mistake::NormalisedFrame => "in a renderer that normalises N and T",
        _ => "in another renderer",
    }
}

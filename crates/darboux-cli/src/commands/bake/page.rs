//! `--report`: one HTML page beside the maps, which loads nothing.

mod counts;
mod errors;
mod maps;
#[cfg(not(feature = "gpu"))]
mod no_views;
mod shared;
#[cfg(feature = "gpu")]
mod views;

use std::path::Path;

use darboux::Convention;
use darboux_bake::{Baked, Models};
use darboux_io::gltf::Document;
use darboux_io::image::{Channels, PngImage, convert_normal_map};
use darboux_io::{Error, LoadOptions, Outputs};

use super::arguments::BakeArguments;
use super::legend::Legend;
use super::model::{baked_model, has_mixed_tangents};
use super::outputs::is_of_gltf;
use super::pictures::of_misses;
use super::report::BakeReport;
use super::write::WrittenMaps;
use crate::html_page::raster::Raster;
use crate::html_page::{HtmlPage, escaped, with_code};
#[cfg(not(feature = "gpu"))]
use no_views::draw;
use shared::{View, figure};
#[cfg(feature = "gpu")]
use views::draw;

const STYLE: &str = include_str!("page/page.css");

/// The longest side of the picture of texels without a hit.
const MISSES_SIDE: u32 = 512;

/// What the page shows beside the report.
#[derive(Default)]
pub struct PageContent {
    tiles: Vec<TileContent>,
    /// The low model with its maps, or why there is none.
    low: Option<Result<Document, String>>,
}

/// What the page shows of a tile.
struct TileContent {
    /// One picture per map, in the order of the report.
    maps: Vec<Raster>,
    misses: Option<Raster>,
    legends: Vec<Legend>,
}

impl PageContent {
    /// Keeps what the page shows of a tile. The pictures of `written` move to the page.
    pub fn add(
        &mut self,
        arguments: &BakeArguments,
        models: &Models<'_>,
        baked: &Baked,
        written: &mut WrittenMaps,
        legends: Vec<Legend>,
        is_tile: bool,
    ) {
        if arguments.report.is_none() {
            return;
        }
        let misses = (baked.report.missed_texels > 0).then(|| of_misses(&baked.images).at_most(MISSES_SIDE));
        self.tiles.push(TileContent { maps: std::mem::take(&mut written.pictures), misses, legends });
        self.low = Some(match is_tile {
            true => Err("materials of glTF cannot have UDIM tiles".to_owned()),
            false => shown_model(arguments, models, baked, written),
        });
    }

    /// Stages the page and returns its path; none if it was not asked for. Errors are one sentence each.
    pub fn stage(
        self,
        arguments: &BakeArguments,
        report: &BakeReport,
        outputs: &mut Outputs,
    ) -> Result<Option<String>, String> {
        let Some(path) = &arguments.report else { return Ok(None) };
        let html = self.html(arguments, report)?;
        let options = arguments.save_options(path);
        outputs.stage_bytes(path, html.as_bytes(), &options).map_err(|error| error.to_string())?;
        Ok(Some(path.display().to_string()))
    }

    fn html(self, arguments: &BakeArguments, report: &BakeReport) -> Result<String, String> {
        let low = self.low.unwrap_or_else(|| Err("nothing was baked".to_owned()));
        let views = low.and_then(|low| draw(arguments, &low, report.counts.high_triangles));
        let mut main = warnings(&report.warnings) + &section("Low and high", &of_views(views)?);
        let mut written = report.maps.iter();
        for (number, tile) in self.tiles.iter().enumerate() {
            let of_tile = report.tiles.get(number);
            let suffix = of_tile.map(|tile| format!(", tile {}", tile.udim)).unwrap_or_default();
            let maps: Vec<_> = written.by_ref().take(tile.maps.len()).zip(&tile.maps).collect();
            let figures = maps::figures(&maps, &tile.legends)?;
            main += &section(&format!("Maps{suffix}"), &figures);
            let verified = of_tile.map_or(&report.verification, |tile| &tile.verification);
            if let Some(verified) = verified {
                main += &section(&format!("Error of the normal map{suffix}"), &errors::tables(verified)?);
            }
            if let Some(misses) = &tile.misses {
                let counts = of_tile.map_or(&report.counts, |tile| &tile.counts);
                main += &section(&format!("Rays that hit nothing{suffix}"), &counts::misses(counts, misses)?);
            }
        }
        main += &section("Settings, counts and times", &counts::tables(arguments, report));
        let name = |path: &Path| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        let highs: Vec<String> = arguments.high.iter().map(|path| name(path)).collect();
        let page = HtmlPage {
            title: &format!("Bake of {}", name(&arguments.low)),
            summary: &format!("From {}, with {}.", highs.join(", "), report.rays.describe()),
            contents: String::new(),
            main,
            style: STYLE,
            script: "",
        };
        Ok(page.text())
    }
}

/// The low model with the maps that materials of glTF have. Errors: a clause why there is none.
fn shown_model(
    arguments: &BakeArguments,
    models: &Models<'_>,
    baked: &Baked,
    written: &WrittenMaps,
) -> Result<Document, String> {
    if !arguments.baked_maps().kinds().any(is_of_gltf) {
        return Err(
            "none of the maps is one that materials of glTF have, such as normal or base-color".to_owned()
        );
    }
    if has_mixed_tangents(&models.low) {
        return Err(
            "some primitives were baked with their own tangents and others with computed ones".to_owned()
        );
    }
    let normal = written.normal.as_ref().map(|map| in_gltf_convention(arguments, map)).transpose();
    let normal = normal.map_err(|error| error.to_string())?;
    baked_model(arguments, models, &baked.images, normal.as_ref(), "baked", &mut Vec::new())
}

/// A copy of a normal map as materials of glTF have it.
fn in_gltf_convention(arguments: &BakeArguments, map: &PngImage) -> Result<PngImage, Error> {
    let mut copy = PngImage::from_bytes(map.name(), map.to_bytes()?, &LoadOptions::default())?;
    let conversion = arguments.map_convention().to(Convention::GLTF);
    convert_normal_map(&mut copy, &conversion, Channels::RGB, Channels::RGB)?;
    Ok(copy)
}

fn section(title: &str, content: &str) -> String {
    format!("<section>\n<h2>{}</h2>\n{content}</section>\n", escaped(title))
}

fn warnings(warnings: &[String]) -> String {
    let article = |warning: &String| {
        format!(
            "<article class=\"warning\">\n<h3><span class=\"severity\">△ \
             Warning</span></h3>\n<p>{}</p>\n</article>\n",
            with_code(warning)
        )
    };
    warnings.iter().map(article).collect()
}

/// The models from four sides, or why there are no pictures.
fn of_views(views: Result<Vec<View>, String>) -> Result<String, String> {
    let views = match views {
        Ok(views) => views,
        Err(reason) => {
            return Ok(format!("<p class=\"faint\">There is no picture: {}.</p>\n", escaped(&reason)));
        }
    };
    let mut html = "<div class=\"views\">\n".to_owned();
    for View { side, high, low } in &views {
        html += &figure(high, &format!("High, {side}"), "")?;
        html += &figure(low, &format!("Low with its maps, {side}"), "")?;
    }
    Ok(html + "</div>\n")
}

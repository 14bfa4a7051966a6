//! The report of `darboux bake`, and what it advises.

pub mod advice;

use darboux_io::words::Count;
use serde::Serialize;

use super::cage::Rays;
use super::seconds::Seconds;
use super::verified::Verified;
use super::write::WrittenMap;
use crate::text::{counted, nonzero_counts};

/// The JSON report. json.txt documents its fields.
#[derive(Debug, Serialize)]
pub struct BakeReport {
    pub command: &'static str,
    pub version: &'static str,
    pub low: String,
    pub high: Vec<String>,
    pub size: [u32; 2],
    pub samples: u32,
    pub rays: Rays,
    pub maps: Vec<WrittenMap>,
    /// The files that name the colours of maps.
    pub legends: Vec<String>,
    /// The model that was written.
    pub model: Option<String>,
    /// The picture of texels without a hit.
    pub misses: Option<String>,
    /// The cage that was written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cage: Option<String>,
    /// Of all tiles together.
    pub counts: darboux_bake::BakeReport,
    pub verification: Option<Verified>,
    pub seconds: Seconds,
    /// The page.
    pub report: Option<String>,
    /// One for each tile, where the output's name has `%UDIM%`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tiles: Vec<TileReport>,
    pub warnings: Vec<String>,
}

/// What a tile has for itself. json.txt documents the fields.
#[derive(Debug, Serialize)]
pub struct TileReport {
    pub udim: u32,
    pub misses: Option<String>,
    pub counts: darboux_bake::BakeReport,
    pub verification: Option<Verified>,
}

impl BakeReport {
    /// All files that were written.
    pub fn files(&self) -> Vec<String> {
        let maps = self.maps.iter().map(|map| &map.file);
        let pictures = self.verifications().flat_map(Verified::files);
        let misses = self.misses.iter().chain(self.tiles.iter().filter_map(|tile| tile.misses.as_ref()));
        let models = self.model.iter().chain(&self.cage).chain(&self.report);
        maps.chain(&self.legends).chain(models).chain(misses).chain(pictures).cloned().collect()
    }

    /// Of the whole, or of each tile.
    fn verifications(&self) -> impl Iterator<Item = &Verified> {
        self.verification.iter().chain(self.tiles.iter().filter_map(|tile| tile.verification.as_ref()))
    }
}

/// What was done, one line per map, and one for the run.
pub fn summary(report: &BakeReport) -> Vec<String> {
    let [width, height] = report.size;
    let map = |map: &WrittenMap| {
        let bits = map.bits;
        let range = map
            .range
            .iter()
            .filter(|range| **range != [0.0, 1.0])
            .map(|[from, to]| format!(", black is {from}, white {to}"));
        let range: String = range.collect();
        format!("{}: {}, {width} x {height}, {bits} bits{range}", map.file, map.map)
    };
    let counts = &report.counts;
    let as_count = |count: u64| usize::try_from(count).unwrap_or(usize::MAX);
    let share = 100.0 * counts.charted_texels as f64 / counts.texels.max(1) as f64;
    let of_run = format!(
        "{} onto {}, {}; charts cover {share:.1} % of the image{}",
        counted(as_count(counts.high_triangles), "triangle", "triangles"),
        Count(counts.low_triangles),
        report.rays.describe(),
        nonzero_counts([
            (as_count(counts.missed_texels), "texel without a hit", "texels without a hit"),
            (
                as_count(counts.overlapping_texels),
                "texel of several triangles",
                "texels of several triangles"
            ),
            (as_count(counts.degenerate_triangles), "triangle without UV area", "triangles without UV area"),
            (as_count(counts.frameless_texels), "texel without a frame", "texels without a frame"),
            (as_count(counts.below_horizon_texels), "normal below the surface", "normals below the surface"),
        ])
    );
    let model = report.model.iter().map(|path| format!("{path}: the low model with its maps and tangents"));
    let verified = report.verification.iter().flat_map(Verified::lines);
    let tiles = report.tiles.iter().filter_map(|tile| Some((tile.udim, tile.verification.as_ref()?)));
    let of_tiles =
        tiles.flat_map(|(udim, verified)| [format!("tile {udim}:")].into_iter().chain(verified.lines()));
    let cage = report.cage.iter().map(|path| format!("{path}: the cage"));
    let page = report.report.iter().map(|path| format!("{path}: the report"));
    let legends = report.legends.iter().map(|path| format!("{path}: what the colours stand for"));
    report
        .maps
        .iter()
        .map(map)
        .chain(legends)
        .chain(model)
        .chain(cage)
        .chain(page)
        .chain([of_run])
        .chain(verified)
        .chain(of_tiles)
        .collect()
}

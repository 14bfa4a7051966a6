//! `darboux/check`: what is wrong with models and normal maps, and how tangents were computed.

use darboux::{
    BitangentDirection, Channel, Choice, MapJudgement, MapTiles, NormalMapJudge, RecipeMatch, TexelLayout,
};
use darboux_check::{
    AssumedMap, CheckOptions, FixOptions, ReportedFinding, check_document, check_map, diagnosis,
    fix_document, importer_note,
};
use darboux_io::gltf::Document;
use serde::Serialize;

use crate::arena::with_arena;
use crate::mesh_arrays::rows;
use crate::reading::load_options;

/// The bytes of a file, or texels.
#[unsafe(no_mangle)]
pub extern "C" fn file_bytes(bytes: usize) -> *mut u8 {
    with_arena(|arena| crate::inputs::resized(&mut arena.check.bytes, bytes))
}

/// The tangents whose recipe is asked for: four floats per corner.
#[unsafe(no_mangle)]
pub extern "C" fn tangents_to_recognise(corners: usize) -> *mut f32 {
    with_arena(|arena| crate::inputs::resized(&mut arena.check.tangents, 4 * corners))
}

/// The number of bytes of the last result.
#[unsafe(no_mangle)]
pub extern "C" fn json_length() -> usize {
    with_arena(|arena| arena.check.json.len())
}

/// The address of the repaired file.
#[unsafe(no_mangle)]
pub extern "C" fn repaired_file() -> *const u8 {
    with_arena(|arena| arena.check.repaired.as_ptr())
}

/// The number of bytes of the repaired file; 0 where nothing was repaired.
#[unsafe(no_mangle)]
pub extern "C" fn repaired_length() -> usize {
    with_arena(|arena| arena.check.repaired.len())
}

/// The result of a check: findings, or why the file cannot be read.
#[derive(Serialize)]
#[serde(untagged)]
enum Checked {
    Findings {
        findings: Vec<NamedFinding>,
        diagnosis: String,
        /// What importers of a format other than glTF make of the mistakes.
        importer_note: Option<&'static str>,
        /// What a model of another format than glTF lost.
        warnings: Vec<String>,
    },
    Error {
        error: String,
    },
}

/// A finding, and its place in the words of a file of another format than glTF.
#[derive(Serialize)]
struct NamedFinding {
    #[serde(flatten)]
    finding: ReportedFinding,
    #[serde(skip_serializing_if = "Option::is_none")]
    source: Option<String>,
}

impl Checked {
    /// `document`: the model, as it was read; none for a map.
    fn of(findings: Vec<ReportedFinding>, document: Option<&Document>) -> Self {
        let source = document.and_then(|document| Some((document.provenance()?, document.warnings())));
        let named = |mut finding: ReportedFinding| {
            let source = source.and_then(|(provenance, _)| finding.name_place(provenance));
            (finding, source)
        };
        let (findings, places): (Vec<_>, Vec<_>) = findings.into_iter().map(named).unzip();
        Self::Findings {
            diagnosis: diagnosis(&findings),
            importer_note: source.and_then(|(provenance, _)| importer_note(provenance, &findings)),
            warnings: source.map_or(Vec::new(), |(_, warnings)| warnings.to_vec()),
            findings: findings
                .into_iter()
                .zip(places)
                .map(|(finding, source)| NamedFinding { finding, source })
                .collect(),
        }
    }
}

/// Checks the file of a model or, with `is_map`, of a normal map; with `repairs`, repairs the model.
/// `assumed_map`: 0 for no assumption, otherwise 1 more than its index among all. Returns the address of the
/// JSON.
#[unsafe(no_mangle)]
pub extern "C" fn check_file(
    is_map: bool,
    is_green_down: bool,
    judges_maps: bool,
    assumed_map: usize,
    repairs: bool,
) -> *const u8 {
    let green = if is_green_down { BitangentDirection::Down } else { BitangentDirection::Up };
    let assumed = assumed_map.checked_sub(1).and_then(|index| AssumedMap::ALL.get(index));
    let options = CheckOptions::default()
        .with_green(green)
        .with_maps(judges_maps)
        .with_assumed_map(assumed.map(|(_, map)| *map));
    with_arena(|arena| {
        let arrays = &mut arena.check;
        arrays.repaired.clear();
        let checked = if is_map {
            let findings = check_map(&arrays.bytes, &options).findings;
            Ok(Checked::of(findings.into_iter().map(Into::into).collect(), None))
        } else {
            check_model(&arrays.bytes, options, repairs, &mut arrays.repaired)
        };
        let checked = checked.unwrap_or_else(|error| Checked::Error { error: error.to_string() });
        arrays.put_json(&checked)
    })
}

fn check_model(
    file: &[u8],
    options: CheckOptions,
    repairs: bool,
    repaired: &mut Vec<u8>,
) -> Result<Checked, darboux_io::Error> {
    let mut document = Document::from_bytes("the model", file.to_vec(), None, &load_options())?;
    let findings = check_document(&document, &options)?;
    if !repairs {
        return Ok(Checked::of(findings.into_iter().map(Into::into).collect(), Some(&document)));
    }
    let fixed = fix_document(&mut document, findings, &FixOptions::default().with_check(options))?;
    if fixed.is_changed {
        *repaired = document.to_glb()?;
    }
    Ok(Checked::of(fixed.findings.into_iter().map(Into::into).collect(), Some(&document)))
}

/// The verdict on a normal map.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Judged {
    verdict: &'static str,
    confidence: f32,
    correlation: f32,
    z_score: f32,
    log_energy_ratio: f32,
    texels: usize,
    background: usize,
    not_unit: usize,
    negative_z: usize,
    grey: usize,
    not_normal: usize,
    tiles: Tiles,
}

/// The tiles of a normal map.
#[derive(Serialize)]
struct Tiles {
    side: usize,
    columns: usize,
    correlations: Vec<Option<f32>>,
}

/// Judges the texels in the bytes: `channels` channels of 8 bits or, with `is_wide`, of 16. Returns the
/// address of the JSON, or null for another number of texels than width times height.
#[unsafe(no_mangle)]
pub extern "C" fn judge_normal_map(is_wide: bool, channels: usize, width: usize, height: usize) -> *const u8 {
    with_arena(|arena| {
        let (bytes, size) = (&arena.check.bytes, [width, height]);
        let judged = if is_wide {
            let words: Vec<u16> = bytes.as_chunks().0.iter().map(|&word| u16::from_le_bytes(word)).collect();
            judge(&words, size, channels)
        } else {
            judge(bytes, size, channels)
        };
        let Some((judgement, tiles)) = judged else { return std::ptr::null() };
        arena.check.put_json(&Judged::new(judgement, tiles))
    })
}

fn judge<C: Channel>(texels: &[C], size: [usize; 2], channels: usize) -> Option<(MapJudgement, MapTiles)> {
    match channels {
        2 => judge_rows(texels.as_chunks().0, size, TexelLayout::RG),
        3 => judge_rows(texels.as_chunks().0, size, TexelLayout::RGB),
        4 => judge_rows(texels.as_chunks().0, size, TexelLayout::RGBA),
        _ => panic!("{channels} is not a number of channels"),
    }
}

/// None for another number of texels than width times height.
fn judge_rows<C: Channel, const N: usize>(
    texels: &[[C; N]],
    [width, height]: [usize; 2],
    layout: TexelLayout<N>,
) -> Option<(MapJudgement, MapTiles)> {
    if width.checked_mul(height) != Some(texels.len()) {
        return None;
    }
    let mut judge = NormalMapJudge::new(width, layout);
    texels.chunks_exact(width.max(1)).try_for_each(|row| judge.push_row(row)).ok()?;
    Some((judge.judgement(), judge.tiles()))
}

impl Judged {
    fn new(judgement: MapJudgement, tiles: MapTiles) -> Self {
        let verdict = judgement.verdict.name();
        let MapJudgement { confidence, correlation, z_score, log_energy_ratio, texels, background, .. } =
            judgement;
        let MapJudgement { not_unit, negative_z, grey, not_normal, .. } = judgement;
        Self {
            verdict,
            confidence,
            correlation,
            z_score,
            log_energy_ratio,
            texels,
            background,
            not_unit,
            negative_z,
            grey,
            not_normal,
            tiles: Tiles { side: tiles.side, columns: tiles.columns, correlations: tiles.correlations },
        }
    }
}

/// A recipe and how well it explains the tangents.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Recognised {
    method: &'static str,
    mode: Option<&'static str>,
    flips_v: bool,
    from_quads: bool,
    writing: &'static str,
    bits: u32,
    corners: usize,
    identical: usize,
    close: usize,
    sign_flips: usize,
    worst: f64,
}

/// Ranks the recipes of the tangents. Returns the address of the JSON, or null where an index is out of
/// range.
#[unsafe(no_mangle)]
pub extern "C" fn recognise_recipe() -> *const u8 {
    with_arena(|arena| {
        let Some(mesh) = arena.vertices.mesh(&arena.surface) else { return std::ptr::null() };
        let Ok(found) = darboux::recognise_recipe(&mesh, rows(&arena.check.tangents)) else {
            return std::ptr::null();
        };
        let recognised: Vec<Recognised> = found.iter().map(Recognised::from).collect();
        arena.check.put_json(&recognised)
    })
}

impl From<&RecipeMatch> for Recognised {
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

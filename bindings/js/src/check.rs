//! `darboux/check`: what is wrong with models and normal maps, and how tangents were computed.

use darboux::BitangentDirection;
use darboux_check::{
    CheckOptions, Code, FixOptions, ReportedFindings, ReportedJudgement, ReportedRecipe, check_document,
    check_map, fix_document, statements,
};
use darboux_io::gltf::Document;
use darboux_io::image::RgbaImage;
use serde::Serialize;

use crate::arena::with_arena;
use crate::check_arrays::CheckArrays;
use crate::mesh_arrays::rows;
use crate::options::choice;
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

/// The names of the codes that a repair is limited to, one per line; no bytes: all.
#[unsafe(no_mangle)]
pub extern "C" fn codes_to_repair(bytes: usize) -> *mut u8 {
    with_arena(|arena| crate::inputs::resized(&mut arena.check.codes_to_repair, bytes))
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

/// The result of a check: findings and which of them say the same, or why the file cannot be read.
#[derive(Serialize)]
#[serde(untagged)]
enum Checked {
    Findings {
        #[serde(flatten)]
        reported: ReportedFindings,
        statements: Vec<Vec<usize>>,
    },
    Error {
        error: String,
    },
}

impl From<ReportedFindings> for Checked {
    fn from(reported: ReportedFindings) -> Self {
        Self::Findings { statements: statements(&reported.findings), reported }
    }
}

/// Checks the file of a model or of a normal map; with `repairs`, repairs the model.
/// `assumed_map`: 0 for no assumption, otherwise 1 more than its code. Returns the address of the JSON.
#[unsafe(no_mangle)]
pub extern "C" fn check_file(
    is_green_down: bool,
    judges_maps: bool,
    assumed_map: u32,
    repairs: bool,
) -> *const u8 {
    let green = if is_green_down { BitangentDirection::Down } else { BitangentDirection::Up };
    let options = CheckOptions::default()
        .with_green(green)
        .with_maps(judges_maps)
        .with_assumed_map(assumed_map.checked_sub(1).map(choice));
    with_arena(|arena| {
        let arrays = &mut arena.check;
        arrays.repaired.clear();
        let checked = if repairs {
            fix_model(arrays, options)
        } else if RgbaImage::is_format_known(&arrays.bytes) {
            let findings = check_map(&arrays.bytes, &options).findings;
            Ok(ReportedFindings::new(findings, None, &options))
        } else {
            check_model(&arrays.bytes, &options).map_err(|error| error.to_string())
        };
        let checked = checked.map_or_else(|error| Checked::Error { error }, Checked::from);
        arrays.put_json(&checked)
    })
}

fn check_model(file: &[u8], options: &CheckOptions) -> Result<ReportedFindings, darboux_io::Error> {
    let document = Document::from_bytes("the model", file.to_vec(), None, &load_options())?;
    let findings = check_document(&document, options)?;
    Ok(ReportedFindings::new(findings, Some(&document), options))
}

/// Repairs the codes that are asked for.
fn fix_model(arrays: &mut CheckArrays, options: CheckOptions) -> Result<ReportedFindings, String> {
    let fixing = FixOptions::default().with_check(options);
    let names = String::from_utf8_lossy(&arrays.codes_to_repair);
    let codes: Vec<Code> = names.split_terminator('\n').map(str::parse).collect::<Result<_, String>>()?;
    let fixing = if codes.is_empty() { fixing } else { fixing.with_codes(codes) };
    let sentence = |error: darboux_io::Error| error.to_string();
    let mut document =
        Document::from_bytes("the model", arrays.bytes.clone(), None, &load_options()).map_err(sentence)?;
    let findings = check_document(&document, &options).map_err(sentence)?;
    let fixed = fix_document(&mut document, findings, &fixing).map_err(sentence)?;
    if fixed.is_changed {
        arrays.repaired = document.to_glb().map_err(sentence)?;
    }
    Ok(ReportedFindings::new(fixed.findings, Some(&document), &options))
}

/// Judges the texels in the bytes: `channels` channels of 8 bits or, with `is_wide`, of 16. Returns the
/// address of the JSON, or null for another number of texels than width times height.
#[unsafe(no_mangle)]
pub extern "C" fn judge_normal_map(is_wide: bool, channels: usize, width: usize, height: usize) -> *const u8 {
    with_arena(|arena| {
        let (bytes, size) = (&arena.check.bytes, [width, height]);
        let judged = if is_wide {
            let words: Vec<u16> = bytes.as_chunks().0.iter().map(|&word| u16::from_le_bytes(word)).collect();
            ReportedJudgement::of_texels(&words, size, channels)
        } else {
            ReportedJudgement::of_texels(bytes, size, channels)
        };
        let Ok(judged) = judged else { return std::ptr::null() };
        arena.check.put_json(&judged)
    })
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
        let recognised: Vec<ReportedRecipe> = found.iter().map(Into::into).collect();
        arena.check.put_json(&recognised)
    })
}

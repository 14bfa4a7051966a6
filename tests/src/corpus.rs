//! Reads the cases of the conformance suite: small meshes for one behaviour each, with what mikktspace.c
//! gives for them.
//!
//! `conformance/FORMAT.md` describes the files. Numbers are read from their bits.

use std::{fs, path::Path};

use serde_json::Value;

use crate::{FaceSizes, OwnedMesh};

/// One case.
#[derive(Clone, Debug)]
pub struct CorpusCase {
    /// The file's name without extension.
    pub name: String,
    /// The class: core, seams, quads, thresholds, degenerate, hostile or large.
    pub class: String,
    /// The behaviour that it shows, as a sentence.
    pub shows: String,
    /// The angular threshold in degrees.
    pub threshold: f32,
    /// The mesh, indexed.
    pub mesh: OwnedMesh,
    /// What mikktspace.c gives; `None` where the file has no expected values, or only their hash.
    pub expected: Option<Expected>,
}

/// The results of mikktspace.c, one entry per corner.
#[derive(Clone, Debug)]
pub struct Expected {
    /// Tangent and sign.
    pub tangents: Vec<[f32; 4]>,
    /// Bitangent.
    pub bitangents: Vec<[f32; 3]>,
    /// The lengths of both before normalisation.
    pub magnitudes: Vec<[f32; 2]>,
}

impl CorpusCase {
    /// Reads one file's text. `None` for a large case, which has a generator instead of vertices. The message
    /// of an error names the case and the member.
    pub fn from_text(name: &str, text: &str) -> Result<Option<Self>, String> {
        let case: Value = serde_json::from_str(text).map_err(|error| format!("{name}: {error}"))?;
        if case.get("positions").is_none() {
            return Ok(None);
        }
        Self::read(&case).map(Some).ok_or_else(|| format!("{name} is not a case"))
    }

    fn read(case: &Value) -> Option<Self> {
        let text = |key: &str| case[key].as_str().map(str::to_owned);
        let bits = &case["bits"];
        let mesh = OwnedMesh {
            positions: rows(&bits["positions"])?,
            normals: rows(&bits["normals"])?,
            uvs: rows(&bits["uvs"])?,
            indices: Some(integers(&case["indices"])?),
            faces: FaceSizes::from_list(&integers(&case["faces"])?),
        };
        let expected = || {
            Some(Expected {
                tangents: rows(&bits["tangents"])?,
                bitangents: rows(&bits["bitangents"])?,
                magnitudes: rows(&bits["magnitudes"])?,
            })
        };
        Some(Self {
            name: text("name")?,
            class: text("class")?,
            shows: text("shows")?,
            threshold: float(&bits["threshold"])?,
            mesh,
            expected: expected(),
        })
    }
}

fn float(word: &Value) -> Option<f32> {
    u32::from_str_radix(word.as_str()?, 16).ok().map(f32::from_bits)
}

fn rows<const N: usize>(list: &Value) -> Option<Vec<[f32; N]>> {
    let row = |words: &Value| {
        let numbers: Option<Vec<f32>> = words.as_array()?.iter().map(float).collect();
        numbers?.try_into().ok()
    };
    list.as_array()?.iter().map(row).collect()
}

fn integers(list: &Value) -> Option<Vec<u32>> {
    list.as_array()?.iter().map(|number| u32::try_from(number.as_u64()?).ok()).collect()
}

/// The cases of `conformance/cases` that have faces and vertices, sorted by name: what every engine can take,
/// GPUs included. Panics on an unreadable file, because the cases are part of the tests.
pub fn corpus() -> Vec<CorpusCase> {
    let mut cases = all_cases();
    cases.retain(|corpus_case| corpus_case.mesh.corner_count() > 0);
    cases
}

/// As [`corpus`], with the meshes that have no faces.
pub fn all_cases() -> Vec<CorpusCase> {
    read_folder(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../conformance/cases"))
}

/// The cases of a folder that have vertices, sorted by name. Panics on an unreadable file.
pub fn read_folder(folder: &Path) -> Vec<CorpusCase> {
    let mut cases: Vec<CorpusCase> = fs::read_dir(folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .filter_map(|entry| {
            let path = entry.expect("a readable folder").path();
            let name = path.file_stem().expect("a file name").to_string_lossy().into_owned();
            let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
            CorpusCase::from_text(&name, &text).unwrap_or_else(|error| panic!("{error}"))
        })
        .collect();
    cases.sort_by(|a, b| a.name.cmp(&b.name));
    cases
}

/// A result file of the suite: seconds, and tangent and sign per corner.
pub fn result_text(seconds: f64, tangents: &[[f32; 4]]) -> String {
    format!("{{\"seconds\": {seconds:?},\n\"tangents\": {}}}\n", rows_text(tangents.iter().copied()))
}

/// Rows of numbers as JSON; NaN and infinities as strings.
pub fn rows_text<const N: usize>(rows: impl Iterator<Item = [f32; N]>) -> String {
    let number = |x: &f32| if x.is_finite() { format!("{x:?}") } else { format!("\"{x}\"").to_lowercase() };
    let row = |row: [f32; N]| format!("[{}]", row.iter().map(number).collect::<Vec<_>>().join(", "));
    format!("[{}]", rows.map(row).collect::<Vec<_>>().join(",\n"))
}

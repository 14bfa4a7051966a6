//! Reads the corpus: small meshes for one behaviour each, with a title that says which.
//!
//! A file of `corpus/` starts with its title in a comment, then `thresholds` and a list of degrees, then the mesh in the form
//! of [`OwnedMesh::from_text`].

use std::{fs, path::Path};

use crate::OwnedMesh;

/// One collected mesh.
#[derive(Clone, Debug)]
pub struct Specimen {
    /// The file's name without extension.
    pub name: String,
    /// Its title: the behaviour that it shows.
    pub title: String,
    /// The thresholds to run it with, in degrees.
    pub thresholds: Vec<f32>,
    /// The mesh.
    pub mesh: OwnedMesh,
}

impl Specimen {
    /// Reads one file's text. The message of an error names the line.
    pub fn from_text(name: &str, text: &str) -> Result<Self, String> {
        let title = text.lines().next().and_then(|line| line.strip_prefix("# "));
        let title = title.ok_or_else(|| format!("{name}: the first line is not a title"))?;
        let (settings, mesh): (Vec<&str>, Vec<&str>) =
            text.lines().partition(|line| line.starts_with("thresholds"));
        let words = settings.iter().flat_map(|line| line.split_whitespace().skip(1));
        let thresholds: Vec<f32> = words
            .map(|word| word.parse().map_err(|_| format!("{name}: not a threshold: {word}")))
            .collect::<Result<_, _>>()?;
        if thresholds.is_empty() {
            return Err(format!("{name}: no thresholds"));
        }
        let mesh = OwnedMesh::from_text(&mesh.join("\n")).map_err(|error| format!("{name}: {error}"))?;
        Ok(Self { name: name.into(), title: title.into(), thresholds, mesh })
    }
}

/// All meshes of `corpus/`, sorted by name. Panics on an unreadable file, because the corpus is part of the tests.
pub fn corpus() -> Vec<Specimen> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let mut specimens: Vec<Specimen> = fs::read_dir(&folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .map(|entry| {
            let path = entry.expect("a readable folder").path();
            let name = path.file_stem().expect("a file name").to_string_lossy().into_owned();
            let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
            Specimen::from_text(&name, &text).unwrap_or_else(|error| panic!("{error}"))
        })
        .collect();
    specimens.sort_by(|a, b| a.name.cmp(&b.name));
    specimens
}

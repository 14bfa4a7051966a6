//! The part of a file's report that only `darboux tangents` has. json.txt documents its fields.

use darboux::Choice;
use darboux_io::gltf::{Document, PrimitiveNormals, TangentsSummary};
use darboux_io::source::{FaceCounts, Provenance};
use darboux_io::words::Count;
use serde::Serialize;

use crate::text::{counted, printable};

/// The report of a file.
#[derive(Default, Serialize)]
pub struct TangentsFileSummary {
    #[serde(flatten)]
    pub tangents: TangentsSummary,
    /// What `--normals` did; `None` for `--normals keep`.
    pub normals: Option<Vec<PrimitiveNormals>>,
    /// Which device computed the tangents.
    pub device: Option<DeviceReport>,
    /// The file that the model was read from; `None` for glTF.
    pub source: Option<SourceReport>,
}

/// A file of another format than glTF, and the faces that it has.
#[derive(Serialize)]
pub struct SourceReport {
    pub format: &'static str,
    pub generator: Option<String>,
    pub faces: FaceCounts,
    pub polygon_rule: &'static str,
    pub not_carried: Vec<String>,
}

impl SourceReport {
    /// The report of a document; none for glTF.
    pub fn of(document: &Document) -> Option<Self> {
        let Provenance { format, generator, faces, polygon_rule, not_carried, .. } = document.provenance()?;
        Some(Self {
            format: format.name(),
            generator: generator.clone(),
            faces: *faces,
            polygon_rule: polygon_rule.name(),
            not_carried: not_carried.clone(),
        })
    }

    /// One line for a terminal.
    pub fn line(&self) -> String {
        let FaceCounts { triangles, quads, polygons, outside_diagonals, .. } = self.faces;
        let by = self
            .generator
            .as_ref()
            .map_or(String::new(), |generator| format!(" by {}", printable(generator)));
        let mut text = format!("{}{by}: {}", self.format, counted(triangles, "triangle", "triangles"));
        if quads > 0 {
            text += &format!(", {} as MikkTSpace takes them", counted(quads, "quad", "quads"));
        }
        if polygons > 0 {
            let faces = counted(polygons, "face", "faces");
            text += &format!(", {faces} of five and more corners cut by the rule {}", self.polygon_rule);
        }
        if outside_diagonals > 0 {
            let quads = counted(outside_diagonals, "concave quad", "concave quads");
            text +=
                &format!("; {quads} drawn along the other diagonal than MikkTSpace's, which lies outside");
        }
        text
    }
}

/// Which device computed how many corners of a file.
#[derive(Serialize)]
pub struct DeviceReport {
    pub kind: &'static str,
    pub adapter: Option<String>,
    pub corners: usize,
    pub cpu_corners: usize,
}

impl DeviceReport {
    /// One line for a terminal; `None` if the CPU computed everything.
    pub fn line(&self) -> Option<String> {
        let (of_cpu, all) = (Count(self.cpu_corners), Count(self.corners));
        (self.corners > 0).then_some(())?;
        Some(format!("on {}; {of_cpu} of {all} corners on the CPU", self.adapter.as_ref()?))
    }
}

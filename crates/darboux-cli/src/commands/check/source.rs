//! Findings about models of other formats than glTF, in the words of their files.

use darboux_check::{ReportedFinding, Severity};
use darboux_io::gltf::Document;
use darboux_io::source::SourceFormat;

/// Names each place as the source file does: `Armature/Body in your FBX, meshes[1].primitives[0] "Body"`.
pub fn name_places(document: &Document, findings: &mut [ReportedFinding]) {
    let Some(provenance) = document.provenance() else { return };
    for finding in findings {
        let source = match (finding.mesh, finding.primitive) {
            (Some(mesh), Some(primitive)) => provenance.primitive(mesh, primitive),
            _ => None,
        };
        let Some(source) = source else { continue };
        let format = provenance.format.name();
        // A PLY is one mesh without a name.
        let part = if source.path.is_empty() { String::new() } else { format!("{} in ", source.path) };
        finding.place = format!("{part}your {format}, {}", finding.place);
    }
}

/// What importers of the format make of the mistakes, where there are any.
pub fn importer_note(document: &Document, findings: &[ReportedFinding]) -> Option<&'static str> {
    let format = document.provenance()?.format;
    let is_mistake = |finding: &ReportedFinding| finding.severity >= Severity::Warning;
    findings.iter().any(is_mistake).then_some(())?;
    match format {
        SourceFormat::Fbx => Some(
            "An importer of FBX that computes tangents itself, as Unreal and Unity do by default, meets what is wrong with positions, normals and UVs, but not what is wrong with tangents.",
        ),
        SourceFormat::Obj => Some(
            "OBJ has no tangents: every importer computes its own from these positions, normals and UVs.",
        ),
        _ => None,
    }
}

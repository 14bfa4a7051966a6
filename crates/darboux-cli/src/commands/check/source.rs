//! Findings about models of other formats than glTF, in the words of their files.

use darboux_check::{ReportedFinding, Severity};
use darboux_io::gltf::Document;

/// Names each place as the source file does: `Armature/Body in your FBX, meshes[1].primitives[0] "Body"`.
pub fn name_places(document: &Document, findings: &mut [ReportedFinding]) {
    let Some(provenance) = document.provenance() else { return };
    for finding in findings {
        finding.name_place(provenance);
    }
}

/// What importers of the format make of the mistakes, where there are any.
pub fn importer_note(document: &Document, findings: &[ReportedFinding]) -> Option<&'static str> {
    let is_mistake = |finding: &ReportedFinding| finding.severity >= Severity::Warning;
    findings.iter().any(is_mistake).then_some(())?;
    document.provenance()?.format.importer_note()
}

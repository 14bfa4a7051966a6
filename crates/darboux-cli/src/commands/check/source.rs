//! Findings about models of other formats than glTF, in the words of their files.

use darboux_check::ReportedFinding;
use darboux_io::gltf::Document;

/// Names each place as the source file does: `Armature/Body in your FBX, meshes[1].primitives[0] "Body"`.
pub fn name_places(document: &Document, findings: &mut [ReportedFinding]) {
    let Some(provenance) = document.provenance() else { return };
    for finding in findings {
        finding.name_place(provenance);
    }
}

//! Cures of defects that a repair leaves: what else the reader can do.

use darboux::BitangentDirection;

use crate::code::Code;
use crate::defect::{Defect, Fault, MapFault};

/// What a cure says that sends the reader to the repair.
const REPAIR: &str = "--fix";

/// The cure of a defect that a repair leaves whatever its options are, where the usual one names the repair.
pub fn without_repair(defect: &Defect, usual: &str) -> Option<&'static str> {
    let is_left = defect.obstacle.as_ref().is_some_and(|obstacle| !obstacle.depends_on_options());
    if is_left && usual.contains(REPAIR) { other_cure(&defect.fault) } else { None }
}

/// The cure of two conventions that cancel and are left.
pub const OF_PAIR: &str = "None needed where renderers read the tangents of the file. For those that compute \
     them, export the model with the settings for glTF (OpenGL).";

fn other_cure(fault: &Fault) -> Option<&'static str> {
    if let Fault::Map(MapFault::GreenFlipped { wanted: BitangentDirection::Down, .. }) = fault {
        return Some("Export or bake the map with green down (DirectX, -Y).");
    }
    Some(match fault.code() {
        Code::MapGreenFlipped => "Export or bake the map with green up (OpenGL, +Y).",
        Code::MapRedFlipped => "Bake the map again with +X.",
        Code::MapChannelsSwapped => "Export or bake the map again with x in red and y in green.",
        Code::MapNotUnit => "Normalise the map in the program that made it.",
        Code::NormalOtherAxes => {
            "Apply the rotation and the scale of the object in the modelling program and export again; or \
             `darboux normals --overwrite`, which makes smooth normals for all parts of the model, also for \
             those whose normals are right."
        }
        Code::TangentOtherRecipe => "Export the model again with tangents.",
        _ => return None,
    })
}

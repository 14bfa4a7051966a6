//! Cures of defects that a repair leaves: what else the reader can do.

use darboux::BitangentDirection;

use crate::code::Code;
use crate::defect::{Assumption, Defect, Fault, MapFault, NormalFault, Obstacle, TangentFault};

/// The cure of a defect that a repair leaves; none where the usual one fits.
pub fn of_left(defect: &Defect) -> Option<&'static str> {
    let is_recipe = matches!(defect.fault, Fault::Tangent(TangentFault::OtherRecipe { .. }));
    match defect.obstacle.as_ref()? {
        Obstacle::InTheModel => Some("Repair the model by itself: `darboux check MODEL --fix`."),
        Obstacle::DifferenceIsInvisible => Some("None needed."),
        Obstacle::MapMayCancel { assumption: Assumption::GreenInverted, .. } => {
            Some("None needed if the map is as was assumed: bumps look right.")
        }
        Obstacle::MapMayCancel { wanted: BitangentDirection::Up, .. } => Some(
            "Look at a bump with a light above it; if it looks inverted: `darboux check FILE --fix --assume \
             map=opengl`.",
        ),
        Obstacle::MapMayCancel { wanted: BitangentDirection::Down, .. } => Some(
            "Look at a bump with a light above it; if it looks inverted: `darboux check FILE --convention \
             directx --fix --assume map=directx`.",
        ),
        Obstacle::MapHasOtherLayout { .. } => {
            Some("Put back the UVs that the map was made for, and check again.")
        }
        obstacle if is_recipe && obstacle.yields_to_choice() => Some(Code::TangentOtherRecipe.cure()),
        _ if is_recipe => {
            Some("Keep them if the map was baked with them; otherwise `darboux tangents --overwrite`.")
        }
        obstacle if obstacle.depends_on_options() => None,
        _ => other_cure(&defect.fault),
    }
}

/// The cure of two conventions that cancel and are left.
pub const OF_PAIR: &str = "None needed where renderers read the tangents of the file. For those that compute \
     them, export the model with the settings for glTF (OpenGL).";

/// Another cure for a fault whose usual one names the repair.
fn other_cure(fault: &Fault) -> Option<&'static str> {
    Some(match fault {
        Fault::Map(MapFault::GreenFlipped { wanted: BitangentDirection::Up, .. }) => {
            "Export or bake the map with green up (OpenGL, +Y)."
        }
        Fault::Map(MapFault::GreenFlipped { wanted: BitangentDirection::Down, .. }) => {
            "Export or bake the map with green down (DirectX, -Y)."
        }
        Fault::Map(MapFault::RedFlipped(_)) => "Bake the map again with +X.",
        Fault::Map(MapFault::ChannelsSwapped { .. }) => {
            "Export or bake the map again with x in red and y in green."
        }
        Fault::Map(MapFault::NotUnit { doubt: None, .. }) => "Normalise the map in the program that made it.",
        Fault::Normal(NormalFault::OtherAxes { .. }) => {
            "Apply the rotation and the scale of the object in the modelling program and export again; or \
             `darboux normals --overwrite`, which makes smooth normals for all parts of the model, also for \
             those whose normals are right."
        }
        Fault::Tangent(TangentFault::Outliers { .. }) => "Export the model again with tangents.",
        _ => return None,
    })
}

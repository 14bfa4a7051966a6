//! Progress inside a call: for the command's progress bar.

use crate::Context;

pub use crate::exec::vertex_progress::VertexProgress;

/// Calls with `context` write their progress to a clone of `progress`.
pub fn set_vertex_progress(context: &mut Context, progress: &VertexProgress) {
    context.set_vertex_progress(progress);
}

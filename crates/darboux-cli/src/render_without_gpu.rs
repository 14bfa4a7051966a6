//! In place of render.rs: a build that knows no GPU.

use crate::arguments::RenderArguments;
use crate::exit;
use crate::messages::Messages;

/// Says so.
pub fn run(_: &RenderArguments) -> u8 {
    Messages::new(false)
        .error("this darboux was built without GPUs, which draw: build it with the feature gpu");
    exit::FAILED
}

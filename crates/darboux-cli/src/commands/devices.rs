//! `darboux devices`: lists the adapters that can compute tangents.

pub mod arguments;

use std::fmt::Write as _;

use darboux_io::system_reason;
use darboux_io::words::Count;
use indicatif::HumanBytes;
use serde::Serialize;

use crate::exit;
use crate::gpu::adapter::Adapter;
use crate::gpu::adapters;
use crate::json::{VERSION, to_json};
use crate::terminal::{Messages, write_stdout};
use arguments::DevicesArguments;

/// The JSON report. json.txt documents its fields.
#[derive(Serialize)]
struct DevicesReport {
    command: &'static str,
    version: &'static str,
    adapters: Vec<Adapter>,
}

/// Runs the command and returns its exit code.
pub fn run(arguments: &DevicesArguments) -> u8 {
    let adapters = adapters();
    let text = if arguments.json {
        to_json(&DevicesReport { command: "devices", version: VERSION, adapters })
    } else {
        Ok(describe(&adapters).into_bytes())
    };
    if let Err(error) = text.map_err(std::io::Error::from).and_then(|text| write_stdout(&text)) {
        Messages::new(false).error(&format!("the list cannot be written: {}", system_reason(&error)));
        return exit::FAILED;
    }
    exit::DONE
}

fn describe(adapters: &[Adapter]) -> String {
    if adapters.is_empty() {
        return "no GPU adapter was found; tangents are computed on the CPU\n".to_owned();
    }
    adapters.iter().fold(String::new(), |mut text, adapter| {
        let Adapter { name, kind, backend, driver, largest_binding, triangle_limit, problem } = adapter;
        let usability = match problem {
            None => format!("usable, {} triangles per dispatch", Count(triangle_limit)),
            Some(problem) => format!("not usable: {problem}"),
        };
        let binding = HumanBytes(*largest_binding);
        let _never_fails = writeln!(
            text,
            "{name}\n  {kind}, {backend}, driver {driver}\n  {usability} (buffers of {binding})"
        );
        text
    })
}

//! Generates the lists of choices of the bindings, below the folder of its argument: the names for
//! TypeScript, whose positions are the codes that WebAssembly takes, and the literals for Python. The
//! viewer's page has the list of methods alone: importing the npm package's list would load its module first.
//!
//! `cargo xtask gen` runs it with the repository's root.

use std::error::Error;
use std::fs::{create_dir_all, write};
use std::path::Path;

use darboux::encode::Encoding;
use darboux::{Choice, Convention, Method, Mode, NormalWeight, Shading, SmoothingSeams};
use darboux_bake::{Bitangent, IdSource, MapKind, OcclusionFalloff, OcclusionWeights, PartMatch};
use darboux_check::{AssumedMap, MapConvention};
use darboux_io::gltf::TangentEncoding;

/// A list: the name of its type, that of its constant, and the names of its values.
struct List {
    singular: &'static str,
    plural: &'static str,
    names: Vec<&'static str>,
}

impl List {
    fn of<T: Choice>(singular: &'static str, plural: &'static str) -> Self {
        Self { singular, plural, names: T::ALL.iter().map(|value| value.name()).collect() }
    }

    fn quoted(&self, quote: char) -> String {
        let names: Vec<String> = self.names.iter().map(|name| format!("{quote}{name}{quote}")).collect();
        names.join(", ")
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let root = std::env::args_os().nth(1).ok_or("usage: choices FOLDER")?;
    let lists = [
        List::of::<Method>("Method", "METHODS"),
        List::of::<Mode>("Mode", "MODES"),
        List::of::<Shading>("Shading", "SHADINGS"),
        List::of::<NormalWeight>("NormalWeight", "NORMAL_WEIGHTS"),
        List::of::<SmoothingSeams>("SmoothingSeams", "SMOOTHING_SEAMS"),
        List::of::<Encoding>("Encoding", "ENCODINGS"),
        List::of::<TangentEncoding>("TangentEncoding", "TANGENT_ENCODINGS"),
        List::of::<AssumedMap>("AssumedMap", "ASSUMED_MAPS"),
        List::of::<MapConvention>("MapConvention", "MAP_CONVENTIONS"),
        List::of::<MapKind>("MapKind", "MAP_KINDS"),
        List::of::<Bitangent>("Bitangent", "BITANGENTS"),
        List::of::<OcclusionFalloff>("OcclusionFalloff", "OCCLUSION_FALLOFFS"),
        List::of::<OcclusionWeights>("OcclusionWeights", "OCCLUSION_WEIGHTS"),
        List::of::<IdSource>("IdSource", "ID_SOURCES"),
        List::of::<PartMatch>("PartMatch", "PART_MATCHES"),
        List {
            singular: "ConventionName",
            plural: "CONVENTIONS",
            names: Convention::PRESETS.iter().map(|(name, _)| *name).collect(),
        },
    ];
    let write_below = |path: &str, text: String| -> Result<(), Box<dyn Error>> {
        let path = Path::new(&root).join(path);
        path.parent().map(create_dir_all).transpose()?;
        Ok(write(path, text)?)
    };
    write_below("bindings/js/lib/core/choices.ts", typescript(&lists))?;
    write_below("viewer/src/surface/methods.ts", format!("// Generated from Rust.\n\n{}", line(&lists[0])))?;
    write_below("bindings/python/python/darboux/_choices.py", python(&lists))
}

/// The names of a list, for TypeScript.
fn line(list: &List) -> String {
    format!("export const {} = [{}] as const;\n", list.plural, list.quoted('\''))
}

fn typescript(lists: &[List]) -> String {
    let lines: String = lists.iter().map(line).collect();
    let channels: Vec<String> = MapKind::ALL.iter().map(|kind| kind.channels().to_string()).collect();
    format!(
        "// Generated from Rust. The position of a name in its list is the code that WebAssembly \
         takes.\n\n{lines}\n/** Numbers per texel of each of {{@link MAP_KINDS}}. */\nexport const \
         MAP_CHANNELS = [{}] as const;\n",
        channels.join(", ")
    )
}

fn python(lists: &[List]) -> String {
    let list = |list: &List| format!("{} = Literal[{}]\n", list.singular, list.quoted('"'));
    let lines: String = lists.iter().map(list).collect();
    format!("\"\"\"The names of choices. Generated from Rust.\"\"\"\n\nfrom typing import Literal\n\n{lines}")
}

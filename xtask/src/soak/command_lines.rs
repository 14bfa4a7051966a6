//! Random command lines, made from the command's own description of its options: a new subcommand or option
//! is in the soak at once.

use serde_json::Value;

use super::program::Program;
use super::random::Random;
use crate::run::root;

/// The arguments of all subcommands, which `cargo xtask gen` writes.
const DESCRIPTION: &str = "crates/darboux-cli/generated/options.json";

/// The subcommands that read files, as [`DESCRIPTION`] has them.
pub struct Commands(Vec<(String, Vec<Argument>)>);

/// An argument of a subcommand.
struct Argument {
    /// `--name`; `None` for one that stands alone.
    option: Option<String>,
    /// What its values are; `None` for a flag.
    kind: Option<String>,
    /// The values that it can have, if they are listed.
    values: Vec<String>,
    is_required: bool,
}

/// The words of a command line.
pub struct Line {
    pub words: Vec<String>,
    /// Whether the input is standard input.
    pub reads_stdin: bool,
}

/// What a command line reads.
pub struct Files<'a> {
    /// The file that may be damaged, and its extension.
    pub file: &'a str,
    pub extension: &'a str,
    /// A good model.
    pub other: &'a str,
    pub renders: bool,
}

/// Conventions with a part replaced, and shadings, which are not listed.
const CONVENTIONS: &[&str] = &["gltf,green=down", "unity,axes=x/y/-z", "gltf,axes=1/2/3"];
const SHADINGS: &[&str] = &["keep", "flat", "smooth", "crease=1", "crease=60", "crease=nan"];
const SOURCES: &[&str] = &["file", "derivatives", "mikktspace", "lengyel", "none"];
const NUMBERS: &[&str] = &["1", "2", "7", "16", "60"];
/// Numbers that most options refuse.
const WRONG_NUMBERS: &[&str] = &["0", "0.5", "-1", "1000", "nan", "1e39"];

/// Options that go without an input, and those that [`Line::add_files`] adds.
const LEFT_OUT: [&str; 6] = ["--explain", "--output", "--out-dir", "--in-place", "--resume", "--high"];

/// Whether files with this extension are images.
pub fn is_image(extension: &str) -> bool {
    ["png", "jpg", "jpeg", "webp", "tga", "ktx2"].contains(&extension)
}

impl Commands {
    /// Reads [`DESCRIPTION`]. Errors: it is missing or has another form.
    pub fn read() -> Result<Self, String> {
        let text = std::fs::read_to_string(root().join(DESCRIPTION))
            .map_err(|error| format!("{DESCRIPTION} cannot be read: {error}"))?;
        Self::parse(&text).ok_or_else(|| format!("{DESCRIPTION} is not what `cargo xtask gen` writes"))
    }

    fn parse(text: &str) -> Option<Self> {
        let described: Value = serde_json::from_str(text).ok()?;
        let mut commands = Vec::new();
        for (name, arguments) in described.as_object()? {
            let arguments: Vec<Argument> =
                arguments.as_array()?.iter().map(Argument::new).collect::<Option<_>>()?;
            let reads_files =
                arguments.iter().any(|argument| argument.option.is_none() && argument.values.is_empty());
            // The server does not end by itself: it has cases of its own.
            if reads_files && name != "view" {
                commands.push((name.clone(), arguments));
            }
        }
        (!commands.is_empty()).then_some(Self(commands))
    }

    /// The names of the subcommands.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|(name, _)| name.as_str())
    }

    /// A line that reads the files.
    pub fn any(&self, random: &mut Random, program: &Program, files: &Files) -> Line {
        // The other subcommands test models more than pictures of them do.
        let is_gltf = ["glb", "gltf", "vrm"].contains(&files.extension);
        let draws = files.renders && (!is_gltf || random.one_in(4));
        let can_run = |name: &str| program.has(name, "") && (name != "render" || draws);
        let known: Vec<_> = self.0.iter().filter(|(name, _)| can_run(name)).collect();
        let maps: Vec<_> =
            known.iter().filter(|(name, _)| name == "convert" || name == "check").copied().collect();
        let is_map = is_image(files.extension);
        let choices = if is_map && !maps.is_empty() && !random.one_in(10) { maps } else { known };
        let (name, arguments) = random.pick(&choices);
        let mut line = Line { words: vec![name.clone()], reads_stdin: false };
        let mut rare = 5;
        for argument in arguments {
            let option = argument.option.as_deref().unwrap_or_default();
            let is_wanted = argument.is_required || (!option.is_empty() && random.one_in(rare));
            if is_wanted && !LEFT_OUT.contains(&option) && !option.is_empty() && program.has(name, option) {
                line.words.push(option.to_owned());
                line.words.extend(argument.value(random, files));
                // Most options exclude few others, but every further one makes a contradiction more likely.
                rare += 3;
            }
        }
        line.add_files(random, arguments, files);
        line
    }
}

impl Argument {
    fn new(described: &Value) -> Option<Self> {
        let text = |name: &str| described[name].as_str().map(str::to_owned);
        let values = described["values"].as_array()?.iter();
        Some(Self {
            option: text("option"),
            kind: text("kind"),
            values: values.map(|value| value.as_str().map(str::to_owned)).collect::<Option<_>>()?,
            is_required: described["required"].as_bool()?,
        })
    }

    /// A value; `None` for a flag.
    fn value(&self, random: &mut Random, files: &Files) -> Option<String> {
        let kind = self.kind.as_deref()?;
        let is_listed = !self.values.is_empty() && (kind != "CONVENTION" || !random.one_in(5));
        if is_listed {
            return Some(self.values[random.below(self.values.len())].clone());
        }
        let value = match kind {
            "LOW" | "HIGH" | "MODEL" | "CAGE" => random.pick(&[files.other, files.other, files.file]),
            "PNG" => random.pick(&["map.png", "second.png"]),
            "GLB" => "second.glb",
            "CONVENTION" => random.pick(CONVENTIONS),
            "SHADING" => random.pick(SHADINGS),
            "SOURCE" => random.pick(SOURCES),
            "LETTERS" => random.pick(&["rgb", "rg", "ag", "la", "gr", "bgr", "x"]),
            "N|WxH" | "WxH" => random.pick(&["64x48", "1x1", "33x200"]),
            "8|16" => random.pick(&["8", "16"]),
            "8|16|32" => random.pick(&["8", "16", "32"]),
            "NAME=MAPS" => {
                random.pick(&["orm=ao,roughness,metalness", "x=height", "../x=ao", "=", "x=normal,ao"])
            }
            "X,Y,Z" => random.pick(&["0,1,0", "0,0,0", "1e30,-1e30,1", "nan,0,0"]),
            "MIN,MAX" => random.pick(&["0,10", "10,0", "0,0", "-1,inf"]),
            "PLACE" => random.pick(&[
                "emissiveTexture",
                "normalTexture",
                "pbrMetallicRoughness/baseColorTexture",
                "/",
            ]),
            "X,Y,Z,X,Y,Z" => random.pick(&["0,0,2,0,0,0", "0,0,0,0,0,0", "1e30,0,0,0,nan,0"]),
            "OUT,IN" => random.pick(&["0.1,0.1", "0,0", "1e30,1e30"]),
            "YAW,PITCH[,ZOOM]" => random.pick(&["0,0", "180,-90,0.01", "30,20,1000"]),
            "RRGGBB" => random.pick(&["ff8000", "x"]),
            "MESH" => random.pick(&["0", "no such mesh"]),
            _ if random.one_in(8) => random.pick(WRONG_NUMBERS),
            _ => random.pick(NUMBERS),
        };
        Some(value.to_owned())
    }
}

impl Line {
    fn has(&self, word: &str) -> bool {
        self.words.iter().any(|other| other == word)
    }

    fn extend(&mut self, words: &[&str]) {
        self.words.extend(words.iter().map(|&word| word.to_owned()));
    }

    /// Adds the inputs, and one of the ways to name an output.
    fn add_files(&mut self, random: &mut Random, arguments: &[Argument], files: &Files) {
        let has = |option: &str| arguments.iter().any(|argument| argument.option.as_deref() == Some(option));
        let lone = arguments.iter().filter(|argument| argument.option.is_none()).count();
        // An image and a picture must not take long.
        if has("--size") && !self.has("--size") {
            self.extend(&["--size", "64x48"]);
        }
        if has("--high") {
            let (high, low) = random.pick(&[(files.other, files.file), (files.file, files.other)]);
            let output = random.pick(&["out.png", "out.png", "out.%UDIM%.png", "out.exr", "out.tif", "out"]);
            self.extend(&[low, "--high", high, "-o", output]);
            if random.one_in(4) {
                self.extend(&["--resume"]);
            }
        } else if has("--in-place") {
            // Most options of a check, and its outputs, need a repair.
            if has("--fix") && !self.has("--fix") && self.words.len() > 1 {
                self.extend(&["--fix"]);
            }
            self.write(random, files);
        } else if has("--output") {
            self.extend(&[files.file, "-o", "out.png"]);
        } else if lone > 1 && !self.has("--method") {
            self.extend(&[files.file, files.other]);
        } else {
            self.extend(&[files.file]);
        }
    }

    fn write(&mut self, random: &mut Random, files: &Files) {
        let output = if is_image(files.extension) {
            "out.png"
        } else {
            random.pick(&["out.glb", "out.gltf", "out.vrm", "out.obj", "out.ply"])
        };
        let words: &[&str] = match random.below(8) {
            _ if self.words == ["check"] => &[files.file],
            0 => &[files.file, "--in-place"],
            1 => &[files.file, "--out-dir", "out"],
            2 => &[files.file, "--out-dir", "out", "--resume"],
            3 => &[files.file],
            4 => &["-"],
            5 => &["-", "-o", output],
            6 => &[files.file, "-o", "-"],
            _ => &[files.file, "-o", output],
        };
        self.reads_stdin = words[0] == "-";
        self.extend(words);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_subcommand_that_reads_files_is_described() {
        let commands = Commands::read().expect("the description");
        let names: Vec<&str> = commands.names().collect();
        for name in ["tangents", "normals", "convert", "check", "bake", "compare", "inspect", "render"] {
            assert!(names.contains(&name), "{name} in {names:?}");
        }
        assert!(!names.contains(&"view") && !names.contains(&"completions"));
        let check = &commands.0.iter().find(|(name, _)| name == "check").expect("check").1;
        assert!(
            check
                .iter()
                .any(|argument| argument.option.as_deref() == Some("--fix") && argument.kind.is_none())
        );
    }
}

//! Random command lines: every subcommand that reads files, with most of its options.

use super::program::Program;
use super::random::Random;

/// The words of a command line.
pub struct Line {
    pub words: Vec<String>,
    /// Whether the input is standard input.
    pub reads_stdin: bool,
}

/// An option, and its values; none for a flag.
type Choice = (&'static str, &'static [&'static str]);

const METHODS: &[&str] =
    &["mikktspace", "angle-area", "lengyel", "lengyel-per-vertex", "average", "area", "face", "from-normal"];

const CONVENTIONS: &[&str] = &[
    "gltf",
    "opengl",
    "directx",
    "blender",
    "unity",
    "unreal",
    "godot",
    "threejs",
    "maya",
    "3dsmax",
    "gltf,green=down",
];

const READING: &[Choice] = &[("--allow-outside", &[]), ("--memory-limit", &["0", "1", "16", "200"])];

const TANGENTS: &[Choice] = &[
    ("--method", METHODS),
    ("--mode", &["reference", "repaired", "corrected"]),
    ("--threshold", &["180", "90", "1", "0"]),
    ("--normals", &["keep", "flat", "smooth", "crease=30"]),
    ("--encoding", &["f32x4", "snorm16x4", "snorm8x4"]),
    ("--overwrite", &[]),
    ("--only-needed", &[]),
    ("--apply-texture-transform", &[]),
    ("--strict", &[]),
    ("--jobs", &["1", "2", "7"]),
];

const NORMALS: &[Choice] = &[
    ("--normals", &["flat", "smooth", "crease=1", "crease=60"]),
    ("--weight", &["angle", "area", "angle-area"]),
    ("--respect-seams", &[]),
    ("--overwrite", &[]),
];

const CONVERT: &[Choice] = &[
    ("--layout", &["rgb", "rg", "ag", "la", "gr"]),
    ("--to-layout", &["rgb", "rg", "ag", "bgr"]),
    ("--raw", &[]),
];

const COMPARE: &[Choice] =
    &[("--worst", &["0", "3", "100000"]), ("--tolerance", &["0", "1"]), ("--heat-map", &["map.png"])];

const RENDER: &[Choice] = &[
    ("--view", &["shaded", "tangent", "bitangent", "normal", "sign"]),
    ("--tangents", &["file", "derivatives", "mikktspace", "lengyel"]),
    ("--lines", &["tangent", "normal,bitangent"]),
    ("--seams", &[]),
    ("--layout", &["corner", "alone"]),
    ("--mistakes", &["green", "w", "v"]),
    ("--mesh", &["0", "no such mesh"]),
    ("--camera", &["0,0", "180,-90,0.01", "30,20,1000"]),
    ("--no-legend", &[]),
];

const MESSAGES: &[Choice] = &[("--json", &[]), ("--quiet", &[])];

/// A line that reads `file`, or `file` and `other` where two files are compared. `extension` is the extension of `file`.
pub fn any(
    random: &mut Random,
    program: &Program,
    file: &str,
    other: &str,
    extension: &str,
    renders: bool,
) -> Line {
    let subcommand = match extension {
        "png" => "convert",
        "obj" if renders => "render",
        "obj" => random.pick(&["tangents", "inspect"]),
        _ if renders && random.one_in(25) => "render",
        _ => random.pick(&["tangents", "tangents", "normals", "convert", "compare", "inspect"]),
    };
    let mut line = Line { words: vec![subcommand.to_owned()], reads_stdin: false };
    let choices: &[&[Choice]] = match subcommand {
        "tangents" => &[TANGENTS, READING, MESSAGES],
        "normals" => &[NORMALS, READING, MESSAGES],
        "convert" => &[CONVERT, READING, MESSAGES],
        "compare" => &[COMPARE, READING, MESSAGES],
        "render" => &[RENDER, READING],
        _ => &[READING, MESSAGES],
    };
    for &choice in choices.iter().copied().flatten() {
        line.add(random, program, subcommand, choice);
    }
    line.remove_contradictions();
    match subcommand {
        "compare" if random.one_in(2) => {
            line.words.retain(|word| word != "--method");
            line.words.extend([file, "--method", random.pick(METHODS)].map(str::to_owned));
        }
        "compare" => line.words.extend([file, other].map(str::to_owned)),
        "render" => line.words.extend([file, "--size", "64x48", "-o", "picture.png"].map(str::to_owned)),
        "inspect" => line.words.push(file.to_owned()),
        _ => line.write(random, file, extension),
    }
    if subcommand == "convert" {
        let to = if extension == "png" || line.has("--raw") { random.pick(CONVENTIONS) } else { "gltf" };
        line.words.extend(["--from", random.pick(CONVENTIONS), "--to", to].map(str::to_owned));
    }
    line
}

impl Line {
    fn has(&self, word: &str) -> bool {
        self.words.iter().any(|other| other == word)
    }

    /// Adds an option one time in five, if the program has it.
    fn add(&mut self, random: &mut Random, program: &Program, subcommand: &str, (option, values): Choice) {
        if !random.one_in(5) || !program.has(subcommand, option) {
            return;
        }
        self.words.push(option.to_owned());
        if !values.is_empty() {
            self.words.push(random.pick(values).to_owned());
        }
    }

    /// Only MikkTSpace has a mode and a threshold.
    fn remove_contradictions(&mut self) {
        if self.has("--method") && !self.has("mikktspace") {
            for option in ["--mode", "--threshold"] {
                if let Some(at) = self.words.iter().position(|word| word == option) {
                    self.words.drain(at..at + 2);
                }
            }
        }
    }

    /// Adds the input and one of the ways to name an output.
    fn write(&mut self, random: &mut Random, file: &str, extension: &str) {
        let is_image = extension == "png";
        let output = if is_image { "out.png" } else { random.pick(&["out.glb", "out.gltf", "out.vrm"]) };
        let words: &[&str] = match random.below(8) {
            0 => &[file, "--in-place"],
            1 => &[file, "--out-dir", "out"],
            2 => &[file, "--out-dir", "out", "--resume"],
            3 => &[file],
            4 if !self.has("--json") => {
                self.reads_stdin = true;
                &["-"]
            }
            5 => {
                self.reads_stdin = true;
                &["-", "-o", output]
            }
            6 if !self.has("--json") => &[file, "-o", "-"],
            _ => &[file, "-o", output],
        };
        self.words.extend(words.iter().map(|&word| word.to_owned()));
    }
}

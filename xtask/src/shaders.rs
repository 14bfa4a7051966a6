//! The shader library in GLSL and HLSL, from its WGSL.
//!
//! The WGSL keeps to what all three languages share: functions, structures, `if`, arithmetic and vectors;
//! every `let`, `var` and `const` names its type; no matrices, whose rows and columns differ, and no
//! samplers. So translating is spelling, word by word, and line n of each file is line n of the other two,
//! but for a head of its own. What the tables here do not know is an error.

use std::fs;
use std::path::Path;

use crate::run::{Outcome, files_below, root};

/// A language that is written.
#[derive(Clone, Copy, PartialEq)]
enum Language {
    Glsl,
    Hlsl,
}

/// Each as WGSL, GLSL and HLSL spell it.
const TYPES: &[[&str; 3]] = &[
    ["bool", "bool", "bool"],
    ["f32", "float", "float"],
    ["i32", "int", "int"],
    ["u32", "uint", "uint"],
    ["vec2f", "vec2", "float2"],
    ["vec3f", "vec3", "float3"],
    ["vec4f", "vec4", "float4"],
    ["vec2i", "ivec2", "int2"],
    ["vec3i", "ivec3", "int3"],
    ["vec4i", "ivec4", "int4"],
];

/// Functions that all three languages have, as WGSL, GLSL and HLSL spell them.
const BUILT_IN: &[[&str; 3]] = &[
    ["abs", "abs", "abs"],
    ["clamp", "clamp", "clamp"],
    ["cross", "cross", "cross"],
    ["dot", "dot", "dot"],
    ["dpdx", "dFdx", "ddx"],
    ["dpdy", "dFdy", "ddy"],
    ["max", "max", "max"],
    ["min", "min", "min"],
    ["mix", "mix", "lerp"],
    ["pow", "pow", "pow"],
    ["sqrt", "sqrt", "sqrt"],
];

/// Copies of WGSL files for darboux-render, because a package on crates.io holds no files from outside of its
/// folder.
pub const RENDER_COPIES: &str = "crates/darboux-render/shader_library";

/// The files that darboux-render includes.
const COPIED: &[&str] = &["derivatives", "frame", "normal_map", "transform"];

/// Writes `shaders/glsl`, `shaders/hlsl` and the copies for darboux-render below `base`.
pub fn write(base: &Path) -> Outcome {
    let mut names = Vec::new();
    let mut sources = Vec::new();
    for path in files_below(&root().join("shaders/wgsl"))? {
        let text = fs::read_to_string(&path)
            .map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
        names.extend(names_of(&text));
        let theme = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        sources.push((theme, text));
    }
    for (theme, text) in &sources {
        for (language, name) in [(Language::Glsl, "glsl"), (Language::Hlsl, "hlsl")] {
            let translated = translate(text, language, &names)
                .map_err(|error| format!("shaders/wgsl/{theme}.wgsl: {error}"))?;
            let text = format!("{}\n{translated}", head(theme, language));
            write_file(&base.join("shaders").join(name).join(format!("{theme}.{name}")), &text)?;
        }
        if COPIED.contains(&theme.as_str()) {
            let origin = format!("// Generated from shaders/wgsl/{theme}.wgsl by `cargo xtask gen`.\n\n");
            write_file(&base.join(RENDER_COPIES).join(theme).with_extension("wgsl"), &(origin + text))?;
        }
    }
    Ok(())
}

fn write_file(path: &Path, text: &str) -> Outcome {
    let written = path.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| fs::write(path, text));
    written.map_err(|error| format!("{} cannot be written: {error}", path.display()))
}

/// What stands before the first line. GLSL ES has no precision of its own for `float`, and too little for
/// `int`, in fragment shaders.
fn head(theme: &str, language: Language) -> String {
    let origin = format!("// Generated from shaders/wgsl/{theme}.wgsl by `cargo xtask gen`.\n");
    match language {
        Language::Glsl => origin + "precision highp float;\nprecision highp int;\n",
        Language::Hlsl => origin,
    }
}

/// The names of the functions and structures that a WGSL text defines.
fn names_of(text: &str) -> Vec<String> {
    let tokens: Vec<&str> = tokens(text).into_iter().filter(|token| !is_blank(token)).collect();
    let definitions = tokens.windows(2).filter(|pair| ["fn", "struct"].contains(&pair[0]));
    definitions.map(|pair| pair[1].to_owned()).collect()
}

/// A WGSL text in another language, line by line. `names`: those that the whole library defines.
fn translate(text: &str, language: Language, names: &[String]) -> Result<String, String> {
    let mut reader = Reader { tokens: tokens(text), next: 0, line: 1, language, names };
    let mut out = String::new();
    while let Some(token) = reader.take() {
        out += &reader.piece(token).map_err(|error| format!("line {}: {error}", reader.line))?;
    }
    Ok(out)
}

/// The text in pieces: comments, blanks, words (names and numbers), and single signs, but `->` in one.
fn tokens(text: &str) -> Vec<&str> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if is_word(first) {
            rest.find(|c| !is_word(c)).unwrap_or(rest.len())
        } else if first.is_whitespace() {
            rest.find(|c: char| !c.is_whitespace()).unwrap_or(rest.len())
        } else if rest.starts_with("->") {
            2
        } else {
            first.len_utf8()
        };
        let (token, after) = rest.split_at(length);
        tokens.push(token);
        rest = after;
    }
    tokens
}

fn is_blank(token: &str) -> bool {
    token.starts_with("//") || token.trim().is_empty()
}

struct Reader<'a> {
    tokens: Vec<&'a str>,
    next: usize,
    line: usize,
    language: Language,
    names: &'a [String],
}

impl<'a> Reader<'a> {
    fn take(&mut self) -> Option<&'a str> {
        let token = *self.tokens.get(self.next)?;
        self.next += 1;
        self.line += token.matches('\n').count();
        Some(token)
    }

    /// The next token that is neither blank nor a comment, left where it is.
    fn peek(&self) -> &'a str {
        self.tokens[self.next..].iter().copied().find(|token| !is_blank(token)).unwrap_or_default()
    }

    /// As [`Reader::peek`], taken.
    fn word(&mut self) -> Result<&'a str, String> {
        while let Some(token) = self.take() {
            if !is_blank(token) {
                return Ok(token);
            }
        }
        Err("the text ends early".into())
    }

    fn expect(&mut self, sign: &str) -> Outcome {
        let found = self.word()?;
        if found == sign { Ok(()) } else { Err(format!("`{sign}` expected, found `{found}`")) }
    }

    /// What a token, and those that belong to it, become.
    fn piece(&mut self, token: &'a str) -> Result<String, String> {
        match token {
            "fn" => self.function(),
            "struct" => self.structure(),
            "let" | "var" => self.declaration(),
            "const" if self.language == Language::Hlsl => Ok(format!("static const {}", self.declaration()?)),
            "const" => Ok(format!("const {}", self.declaration()?)),
            "," if self.peek() == ")" => Ok(String::new()),
            word if self.peek() == "(" && word.starts_with(char::is_alphabetic) => self.called(word),
            other => Ok(other.to_owned()),
        }
    }

    /// `name: type` as `type name`.
    fn declaration(&mut self) -> Result<String, String> {
        let name = self.word()?;
        self.expect(":")?;
        let of = self.word()?;
        Ok(format!("{} {name}", self.spelled(of)?))
    }

    /// `fn name(a: type, ...) -> type` as `type name(type a, ...)`.
    fn function(&mut self) -> Result<String, String> {
        let name = self.word()?;
        self.expect("(")?;
        let mut parameters = Vec::new();
        while self.peek() != ")" {
            parameters.push(self.declaration()?);
            if self.peek() == "," {
                self.expect(",")?;
            }
        }
        self.expect(")")?;
        self.expect("->")?;
        let result = self.word()?;
        Ok(format!("{} {name}({})", self.spelled(result)?, parameters.join(", ")))
    }

    /// `struct Name { field: type, ... }` as `struct Name { type field; ... };`, comments kept.
    fn structure(&mut self) -> Result<String, String> {
        let mut out = format!("struct {} {{", self.word()?);
        self.expect("{")?;
        while let Some(token) = self.take() {
            match token {
                "}" => return Ok(out + "};"),
                "," => out += ";",
                blank if is_blank(blank) => out += blank,
                name => {
                    self.expect(":")?;
                    let of = self.word()?;
                    out += &format!("{} {name}", self.spelled(of)?);
                }
            }
        }
        Err("a structure without an end".into())
    }

    /// A word before a parenthesis: a type, a function, `if` or `return`.
    fn called(&self, word: &str) -> Result<String, String> {
        match BUILT_IN.iter().find(|row| row[0] == word) {
            Some(row) => Ok(self.column(row).to_owned()),
            None if ["if", "return"].contains(&word) => Ok(word.to_owned()),
            None => self.spelled(word),
        }
    }

    /// A type's name, or what the library defines.
    fn spelled(&self, name: &str) -> Result<String, String> {
        match TYPES.iter().find(|row| row[0] == name) {
            Some(row) => Ok(self.column(row).to_owned()),
            None if self.names.iter().any(|known| known == name) => Ok(name.to_owned()),
            None => Err(format!("`{name}` is not in the subset that all three languages share")),
        }
    }

    fn column(&self, row: &[&'static str; 3]) -> &'static str {
        row[match self.language {
            Language::Glsl => 1,
            Language::Hlsl => 2,
        }]
    }
}

#[cfg(test)]
mod tests {
    use super::{Language, names_of, translate};

    fn hlsl(text: &str) -> Result<String, String> {
        translate(text, Language::Hlsl, &names_of(text))
    }

    #[test]
    fn definitions_are_spelled_anew_line_by_line() {
        let wgsl = "// a + b\nstruct Pair {\n    a: vec3f, // x: f32\n    b: i32,\n}\n\nfn sum(p: Pair, k: u32) -> f32 {\n    \
                    let x: f32 = mix(p.a.x, f32(p.b), 0.5);\n    return max(\n        x,\n        1.0,\n    );\n}\n";
        let expected = "// a + b\nstruct Pair {\n    float3 a; // x: f32\n    int b;\n};\n\nfloat sum(Pair p, uint k) {\n    \
                        float x = lerp(p.a.x, float(p.b), 0.5);\n    return max(\n        x,\n        1.0\n    );\n}\n";
        assert_eq!(hlsl(wgsl).as_deref(), Ok(expected));
    }

    #[test]
    fn what_is_outside_the_subset_is_an_error() {
        for (text, problem) in [
            ("fn f() -> f32 {\n    return fma(1.0, 2.0, 3.0);\n}", "line 2: `fma` is not in the subset"),
            ("fn f() -> f32 {\n    let x = 1.0;\n}", "line 2: `:` expected, found `=`"),
            ("fn f(m: mat3x3f) -> f32 {}", "line 1: `mat3x3f` is not in the subset"),
            ("fn f() {}", "line 1: `->` expected, found `{`"),
            ("struct S { a: f32", "a structure without an end"),
        ] {
            let error = hlsl(text).expect_err("an error");
            assert!(error.contains(problem), "{error}");
        }
    }
}

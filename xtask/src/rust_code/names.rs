//! Paths and `use` declarations in a stream of tokens.
//!
//! Tokens are read instead of expressions, so that the arguments of macros are searched like other code.

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// The segments of a path such as `super::mesh::Mesh`.
pub type Path = Vec<String>;

/// What a piece of code names.
#[derive(Debug, Default, PartialEq)]
pub struct Names {
    /// Imported paths, and the names that they have here.
    pub imports: Vec<(String, Path)>,
    /// The paths before `::*`.
    pub globs: Vec<Path>,
    /// Paths in other code, single identifiers included.
    pub paths: Vec<Path>,
    /// Names before `!`.
    pub macros: Vec<String>,
}

impl Names {
    /// The names in a piece of code.
    pub fn of(code: TokenStream) -> Self {
        let mut tokens = Vec::new();
        flatten(code, &mut tokens);
        let mut reader = Reader { tokens: &tokens, next: 0, names: Self::default() };
        while reader.next < reader.tokens.len() {
            reader.step();
        }
        reader.names
    }
}

/// Appends identifiers and signs; `::` is one token, and a literal is `0`.
fn flatten(code: TokenStream, tokens: &mut Vec<String>) {
    for token in code {
        match token {
            TokenTree::Ident(ident) => tokens.push(ident.to_string().trim_start_matches("r#").to_owned()),
            TokenTree::Literal(_) => tokens.push("0".to_owned()),
            TokenTree::Punct(sign)
                if sign.as_char() == ':' && tokens.last().is_some_and(|last| last == ":") =>
            {
                tokens.pop();
                tokens.push("::".to_owned());
            }
            TokenTree::Punct(sign) => tokens.push(sign.to_string()),
            TokenTree::Group(group) => {
                let [open, close] = match group.delimiter() {
                    Delimiter::Brace => ["{", "}"],
                    Delimiter::Bracket => ["[", "]"],
                    Delimiter::Parenthesis => ["(", ")"],
                    Delimiter::None => ["", ""],
                };
                tokens.push(open.to_owned());
                flatten(group.stream(), tokens);
                tokens.push(close.to_owned());
            }
        }
    }
}

struct Reader<'a> {
    tokens: &'a [String],
    next: usize,
    names: Names,
}

impl Reader<'_> {
    fn peek(&self) -> &str {
        self.tokens.get(self.next).map_or("", String::as_str)
    }

    fn is_word(&self) -> bool {
        self.peek().starts_with(|c: char| c.is_alphabetic() || c == '_')
    }

    /// Takes the next token if it is `sign`.
    fn takes(&mut self, sign: &str) -> bool {
        let found = self.peek() == sign;
        self.next += usize::from(found);
        found
    }

    /// Reads a `use` declaration, a path, or one token that is neither.
    fn step(&mut self) {
        if self.takes("use") {
            // `use<'a>` in a bound is not an import.
            if self.peek() != "<" {
                self.import(&mut Path::new());
            }
        } else if [".", "'", "::"].contains(&self.peek()) {
            // A method, a lifetime, or what stands after the type of a path.
            self.next += 1;
            if self.is_word() {
                self.path();
            }
        } else if self.is_word() {
            match (self.path(), self.peek()) {
                // Not `a != b`.
                (path, "!")
                    if path.len() == 1 && self.tokens.get(self.next + 1).is_none_or(|it| *it != "=") =>
                {
                    self.names.macros.extend(path)
                }
                (path, _) => self.names.paths.push(path),
            }
        } else {
            self.next += 1;
        }
    }

    /// Reads `a::b::c`. A generic argument ends it.
    fn path(&mut self) -> Path {
        let mut path = Path::new();
        loop {
            path.push(self.peek().to_owned());
            self.next += 1;
            let after = self.tokens.get(self.next + 1);
            let goes_on = after.is_some_and(|word| word.starts_with(|c: char| c.is_alphabetic() || c == '_'));
            if !(goes_on && self.takes("::")) {
                return path;
            }
        }
    }

    /// Reads what follows `use`, or one branch of its tree after `prefix`.
    fn import(&mut self, prefix: &mut Path) {
        let length = prefix.len();
        let leading = self.takes("::");
        loop {
            if self.takes("*") {
                self.names.globs.push(prefix.clone());
                break;
            }
            if self.takes("{") {
                while !self.takes("}") && !self.peek().is_empty() {
                    self.import(prefix);
                    self.takes(",");
                }
                break;
            }
            if !self.is_word() {
                break;
            }
            prefix.push(self.peek().to_owned());
            self.next += 1;
            if !self.takes("::") {
                let path = if prefix.last().is_some_and(|word| word == "self") && prefix.len() > 1 {
                    prefix[..prefix.len() - 1].to_vec()
                } else {
                    prefix.clone()
                };
                let own_name = path.last().cloned().unwrap_or_default();
                let name = if self.takes("as") {
                    self.next += 1;
                    self.tokens[self.next - 1].clone()
                } else {
                    own_name
                };
                if !leading {
                    self.names.imports.push((name, path));
                }
                break;
            }
        }
        prefix.truncate(length);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(code: &str) -> Names {
        Names::of(code.parse().expect("tokens"))
    }

    fn path(text: &str) -> Path {
        text.split("::").map(str::to_owned).collect()
    }

    #[test]
    fn declarations_are_read() {
        let found = names("pub(crate) use super::{a, b::{self, c as d}, e::*}; use ::std::fmt;");
        let imports = [("a", "super::a"), ("b", "super::b"), ("d", "super::b::c")];
        assert_eq!(found.imports, imports.map(|(name, of)| (name.to_owned(), path(of))));
        assert_eq!(found.globs, [path("super::e")]);
    }

    #[test]
    fn paths_are_found_in_code_and_macros() {
        let found =
            names("fn f<'a>(x: &'a T) { x.len::<U>(); vec![crate::a::B::new(1)]; read!(c::d); x != y }");
        assert_eq!(found.macros, ["vec", "read"]);
        for wanted in ["T", "U", "crate::a::B::new", "c::d"] {
            assert!(found.paths.contains(&path(wanted)), "{wanted} is not among {:?}", found.paths);
        }
        assert!(!found.paths.contains(&path("len")) && !found.paths.contains(&path("a")));
    }
}

//! Tokens as one line of Rust with the usual spaces.

use proc_macro2::{Delimiter, Spacing, TokenStream, TokenTree};
use quote::ToTokens;

/// Words that are followed by a space even before a bracket.
const KEYWORDS: &[&str] = &["as", "const", "dyn", "for", "impl", "in", "mut", "where"];

/// One line of Rust. Paths of the standard library, `::core::fmt::Debug`, are shortened to their last segment.
pub fn line(code: &impl ToTokens) -> String {
    let mut tokens = Vec::new();
    flatten(code.to_token_stream(), &mut tokens);
    let tokens = without_std_paths(tokens);
    let mut line = String::new();
    for (index, token) in tokens.iter().enumerate() {
        if index > 0 && has_space(&tokens[index - 1], token) {
            line.push(' ');
        }
        line += token;
    }
    line
}

/// Joins signs that belong together, such as `->` and `'a`.
fn flatten(code: TokenStream, tokens: &mut Vec<String>) {
    let mut joint = false;
    for token in code {
        let text = match &token {
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
                joint = false;
                continue;
            }
            other => other.to_string(),
        };
        match tokens.last_mut() {
            Some(last) if joint => *last += &text,
            _ => tokens.push(text),
        }
        let joins = |sign: char| [':', '-', '=', '.', '\''].contains(&sign);
        joint = matches!(&token, TokenTree::Punct(sign) if sign.spacing() == Spacing::Joint && joins(sign.as_char()));
    }
    tokens.retain(|token| !token.is_empty());
}

/// Drops what precedes the last `::` of a path that begins with `::core`, `::std` or `::alloc`.
fn without_std_paths(tokens: Vec<String>) -> Vec<String> {
    let mut short: Vec<String> = Vec::new();
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        let is_std = tokens.peek().is_some_and(|next| ["core", "std", "alloc"].contains(&next.as_str()));
        if token == "::" && is_std {
            let mut last = tokens.next().unwrap_or_default();
            while tokens.next_if(|next| next == "::").is_some() {
                last = tokens.next().unwrap_or_default();
            }
            short.push(last);
        } else {
            short.push(token);
        }
    }
    short
}

fn has_space(before: &str, after: &str) -> bool {
    let is_lifetime = before.starts_with('\'');
    let ends_word = !is_lifetime && before.ends_with(|c: char| c.is_alphanumeric() || c == '_');
    match (before, after) {
        (_, "," | ";" | ")" | "]" | ">" | "::" | ":" | ".") => false,
        ("(" | "[" | "<" | "::" | "&" | "." | "#" | "!" | "?" | "*", _) => false,
        (word, "(" | "[") => !ends_word && word != ">" || KEYWORDS.contains(&word),
        (_, "<") => !ends_word,
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::line;

    #[test]
    fn spaces_are_usual() {
        for text in [
            "pub fn f<'a>(x: &'a mut [T; 3], y: impl Fn(&str) -> u32) -> Option<Box<dyn Run + 'a>>",
            "for<'a> fn(*const T, [(u8, u16); 4]) where T: ?Sized + Into<Vec<u8>>",
            "impl<'a, T> From<&'a [T]> for Indices<'_>",
        ] {
            let tokens: proc_macro2::TokenStream = text.parse().expect("tokens");
            assert_eq!(line(&tokens), text);
        }
        let path: proc_macro2::TokenStream =
            "impl ::core::fmt::Debug for A<::std::vec::Vec<u8>>".parse().expect("tokens");
        assert_eq!(line(&path), "impl Debug for A<Vec<u8>>");
    }
}

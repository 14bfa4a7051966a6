//! docs/check-mistakes.md.

use std::fmt::Write;

use darboux_check::Code;

use super::flips::FLIPS;
use super::table::{PairRow, Row};

/// The page of these results.
pub fn page(rows: &[Row], pairs: &[PairRow]) -> String {
    let mut text = include_str!("page.md").to_owned();
    text += "| mistake | how it was made | models | named | with other errors | equal after `--fix` |\n|---|---|---|---|---|---|\n";
    for Row { code, how, models, named, with_other_errors, repaired, .. } in rows {
        let repaired = repaired.map_or_else(|| "left".to_owned(), |repaired| repaired.to_string());
        let link = link(*code);
        writeln!(text, "| {link} | {how} | {models} | {named} | {with_other_errors} | {repaired} |")
            .expect("text");
    }
    text += include_str!("flips.md");
    text += "| flip | how it was made | what names it |\n|---|---|---|\n";
    for flip in FLIPS {
        let codes: Vec<String> = flip.codes.iter().map(|code| link(*code)).collect();
        writeln!(text, "| {} | {} | {} |", flip.name, flip.how, codes.join(" and ")).expect("text");
    }
    text += include_str!("pairs.md");
    let both = pairs.iter().filter(|pair| pair.named == [true; 2]).count();
    writeln!(text, "Of {} pairs, both mistakes of {both} are named. The other pairs:\n", pairs.len())
        .expect("text");
    text += "| first | second | named | also |\n|---|---|---|---|\n";
    for PairRow { codes, named, instead } in pairs.iter().filter(|pair| pair.named != [true; 2]) {
        let which = match named {
            [true, false] => "first",
            [false, true] => "second",
            _ => "neither",
        };
        let instead: Vec<&str> = instead.iter().map(|code| code.name()).collect();
        writeln!(text, "| {} | {} | {which} | {} |", codes[0], codes[1], instead.join(", ")).expect("text");
    }
    text
}

fn link(code: Code) -> String {
    format!("[`{code}`](check.md#{code})")
}

//! docs/check-mistakes.md.

use std::fmt::Write;

use darboux_check::Code;

use super::flips::FLIPS;
use super::pairs::{Made, Outcome, PairRow};
use super::table::Row;

/// The page of these results, up to the part about pairs.
pub fn page(rows: &[Row]) -> String {
    let mut text = include_str!("page.txt").to_owned();
    text += "| mistake | how it was made | models | named | with other errors | equal after `--fix` |\n|---|---|---|---|---|---|\n";
    for Row { code, how, models, named, with_other_errors, repaired, .. } in rows {
        let repaired = repaired.map_or_else(|| "left".to_owned(), |repaired| repaired.to_string());
        let link = link(*code);
        writeln!(text, "| {link} | {how} | {models} | {named} | {with_other_errors} | {repaired} |")
            .expect("text");
    }
    text += include_str!("flips.txt");
    text += "| flip | how it was made | what names it |\n|---|---|---|\n";
    for flip in FLIPS {
        let codes: Vec<String> = flip.codes.iter().map(|code| link(*code)).collect();
        writeln!(text, "| {} | {} | {} |", flip.name, flip.how, codes.join(" and ")).expect("text");
    }
    text += include_str!("flips_after.txt");
    text
}

/// What the part of the page about pairs begins with.
pub const PAIRS: &str = "\n## Pairs of mistakes\n";

/// What follows it.
pub fn pairs_section(pairs: &[PairRow]) -> String {
    let mut text = include_str!("pairs.txt").to_owned();
    let count = |is_it: fn(&Outcome) -> bool| pairs.iter().filter(|pair| is_it(&pair.outcome)).count();
    let both = count(|outcome| matches!(outcome, Outcome::BothNamed));
    let same = count(|outcome| matches!(outcome, Outcome::SameFile(_)));
    let (all, missed) = (pairs.len(), pairs.len() - both - same);
    writeln!(text, "Of {all} pairs, {same} leave the same bytes as one of the mistakes alone or as the healthy model. Of the other {}, both mistakes of {both} are named, and {missed} are these:\n", all - same)
        .expect("text");
    text += "| first | second | named | also | why |\n|---|---|---|---|---|\n";
    let missed = pairs.iter().filter(|pair| matches!(pair.outcome, Outcome::Missed { .. }));
    missed.for_each(|pair| text += &pair_line(pair));
    text
}

/// The line of a pair in the table of those that are not both named.
pub fn pair_line(pair: &PairRow) -> String {
    let (which, instead) = match &pair.outcome {
        Outcome::Missed { named, instead } => {
            let which = ["first", "second"].into_iter().zip(named).find(|(_, named)| **named);
            (which.map_or("neither", |(which, _)| which), instead.iter().map(|code| code.name()).collect())
        }
        _ => ("both", Vec::new()),
    };
    let [first, second] = pair.made.map(|made| format!("{}: {}", made.code(), made.how()));
    let why = why_missed(pair.made.map(Made::code));
    format!("| {first} | {second} | {which} | {} | {why} |\n", instead.join(", "))
}

/// Why two mistakes are not both named. Empty for pairs without a known reason.
pub fn why_missed(pair: [Code; 2]) -> &'static str {
    let has = |code| pair.contains(&code);
    if has(Code::MapGreenFlipped) && (has(Code::TangentSignFlipped) || has(Code::NormalAgainstWinding)) {
        "the two cancel, and are one finding"
    } else if has(Code::TangentZero) {
        "the second mistake gives the tangent that was zero another value"
    } else if has(Code::TangentNotPerpendicular) && has(Code::TangentRotated) {
        "the cross product with the normal is perpendicular again, and too short"
    } else if pair == [Code::TangentSignFlippedWhereMirrored, Code::TangentSignFlipped] {
        "the file is the one of w set to -1, one mistake"
    } else if has(Code::TangentOtherUvSet) {
        "tangents that are turned further are compared with those of the material's UV set alone"
    } else if has(Code::TangentRotated) && has(Code::TangentNegated) {
        "tangents against v can also be bitangents of the other direction; a single tangent is not judged among turned ones"
    } else if has(Code::TangentRotated) && has(Code::TangentOtherRecipe) {
        "methods are compared with tangents along u only"
    } else if pair == [Code::NormalAgainstWinding; 2] {
        "faces and normals agree again; what is left is the sign w, which follows the order of the corners"
    } else if has(Code::NormalAgainstWinding) {
        "on an open surface, reversed normals and reversed signs w are the same as reversed faces"
    } else {
        ""
    }
}

fn link(code: Code) -> String {
    format!("[`{code}`](check.md#{code})")
}

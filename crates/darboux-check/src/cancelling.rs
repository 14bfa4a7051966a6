//! Mistakes in a map and in the tangents of a surface that cancel each other: bumps look right, and would be inverted if one were repaired alone.

use crate::code::Code;
use crate::finding::Finding;

/// What is wrong with a map, and what is wrong with tangents so that it cancels.
struct Pair {
    on_map: &'static [Code],
    on_surface: &'static [Code],
    /// What cancels, of the map and of the tangents.
    names: [&'static str; 2],
}

/// Negated tangents with their old sign w negate the bitangents, too.
const PAIRS: &[Pair] = &[
    Pair {
        on_map: &[Code::MapGreenFlipped],
        on_surface: &[Code::TangentSignFlipped],
        names: ["inverted green", "flipped signs w"],
    },
    Pair {
        on_map: &[Code::MapRedFlipped],
        on_surface: &[Code::TangentNegated, Code::TangentSignFlipped],
        names: ["inverted red", "negated tangents and signs w"],
    },
    Pair {
        on_map: &[Code::MapRedFlipped, Code::MapGreenFlipped],
        on_surface: &[Code::TangentNegated],
        names: ["inverted red and green", "negated tangents"],
    },
];

/// All codes of the pairs.
const CODES: [Code; 4] =
    [Code::MapGreenFlipped, Code::MapRedFlipped, Code::TangentSignFlipped, Code::TangentNegated];

/// Says in the findings on a map and on a surface that uses it which of them cancel, and returns the codes of those on the map.
pub fn mark(on_map: &mut [Finding], on_surface: &mut [&mut Finding]) -> &'static [Code] {
    let of_map: Vec<Code> = on_map.iter().map(|finding| finding.code).collect();
    // A finding that lists vertices or triangles is about a part of the surface.
    let on_whole = on_surface.iter().filter(|finding| finding.first.is_empty());
    let of_surface: Vec<Code> = on_whole.map(|finding| finding.code).collect();
    let cancels =
        |pair: &&Pair| are_exactly(&of_map, pair.on_map) && are_exactly(&of_surface, pair.on_surface);
    let Some(pair) = PAIRS.iter().find(cancels) else { return &[] };
    let place = on_surface.first().map_or(String::new(), |finding| finding.place.to_string());
    let [map_mistake, surface_mistake] = pair.names;
    for finding in on_map.iter_mut().filter(|finding| pair.on_map.contains(&finding.code)) {
        add(finding, &format!("the {surface_mistake} of {place} cancel it"));
    }
    for finding in on_surface.iter_mut().filter(|finding| pair.on_surface.contains(&finding.code)) {
        add(finding, &format!("the {map_mistake} of the normal map cancels it"));
    }
    pair.on_map
}

/// Adds who cancels a finding, the first one of several.
fn add(finding: &mut Finding, clause: &str) {
    if !finding.text.contains(BOTH_OR_NONE) {
        finding.text += &format!("; {clause}{BOTH_OR_NONE}");
    }
}

const BOTH_OR_NONE: &str = ", so that bumps look right now: repair both or none";

/// Whether these codes of the pairs are among others, and no other ones of the pairs.
fn are_exactly(found: &[Code], codes: &[Code]) -> bool {
    CODES.iter().all(|code| found.contains(code) == codes.contains(code))
}

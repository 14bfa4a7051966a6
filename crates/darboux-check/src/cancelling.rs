//! Mistakes in a map and in the tangents of a surface that cancel each other: bumps look right, and would be inverted if one were repaired alone.

use crate::code::Code;
use crate::finding::Finding;

/// What is wrong with a map, and what is wrong with tangents so that it cancels.
#[derive(PartialEq)]
pub struct Pair {
    on_map: &'static [Code],
    on_surface: &'static [Code],
    /// What cancels, of the map and of the tangents.
    pub names: [&'static str; 2],
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

impl Pair {
    /// The pair that the findings on a map and those on a surface that uses it make; none where they do not cancel.
    pub fn of<'a>(
        on_map: impl IntoIterator<Item = &'a Finding>,
        on_surface: impl IntoIterator<Item = &'a Finding>,
    ) -> Option<&'static Self> {
        let on_whole_map = on_map.into_iter().filter(|finding| !finding.is_on_part_of_image);
        let of_map: Vec<Code> = on_whole_map.map(|finding| finding.code).collect();
        // A finding that lists vertices or triangles is about a part of the surface.
        let on_whole = on_surface.into_iter().filter(|finding| !finding.lists_items());
        let of_surface: Vec<Code> = on_whole.map(|finding| finding.code).collect();
        PAIRS
            .iter()
            .find(|pair| are_exactly(&of_map, pair.on_map) && are_exactly(&of_surface, pair.on_surface))
    }

    /// Whether a finding on the map or on the surface is a part of the pair.
    pub fn contains(&self, finding: &Finding) -> bool {
        self.on_map.contains(&finding.code) || self.on_surface.contains(&finding.code)
    }
}

/// Says in the findings on a map and on the surfaces that use it which of them cancel. The map's are marked where they cancel on all surfaces, and
/// their codes are returned.
pub fn mark(on_map: &mut [Finding], surfaces: &mut [Vec<&mut Finding>]) -> &'static [Code] {
    let pairs: Vec<Option<&Pair>> =
        surfaces.iter().map(|surface| Pair::of(&*on_map, surface.iter().map(|finding| &**finding))).collect();
    for (pair, surface) in pairs.iter().zip(&mut *surfaces) {
        let Some(pair) = pair else { continue };
        for finding in surface.iter_mut().filter(|finding| pair.contains(finding)) {
            add(finding, &format!("the {} of the normal map cancels it", pair.names[0]));
        }
    }
    let Some(pair) =
        pairs.first().copied().flatten().filter(|first| pairs.iter().all(|pair| *pair == Some(*first)))
    else {
        return &[];
    };
    let place = surfaces.iter().flatten().next().map_or(String::new(), |finding| finding.place.to_string());
    let further = if surfaces.len() > 1 { " and of all others that use the map" } else { "" };
    for finding in on_map.iter_mut().filter(|finding| pair.contains(finding)) {
        add(finding, &format!("the {} of {place}{further} cancel it", pair.names[1]));
    }
    pair.on_map
}

/// Adds who cancels a finding, the first one of several.
fn add(finding: &mut Finding, clause: &str) {
    if !finding.is_cancelled {
        finding.text += &format!("; {clause}, so that bumps look right now: repair both or none");
        finding.is_cancelled = true;
    }
}

/// Whether these codes of the pairs are among others, and no other ones of the pairs.
fn are_exactly(found: &[Code], codes: &[Code]) -> bool {
    CODES.iter().all(|code| found.contains(code) == codes.contains(code))
}

//! [`group_by_name`]: rays of a part hit the parts of the same name only.

use std::collections::HashSet;

use super::{HighModel, LowModel};
use crate::text::listed;
use crate::{HighSurface, LowSurface, match_names};

/// The parts that no part of the other side belongs to, by their names, each once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UnpairedParts {
    /// Parts of the low model; their rays hit nothing.
    pub low: Vec<String>,
    /// Parts of the high models; no ray hits them.
    pub high: Vec<String>,
}

impl UnpairedParts {
    /// A sentence about the low parts, and one about the high ones, if there are any.
    pub fn warnings(&self) -> Vec<String> {
        let named = |parts: &[String]| {
            let name = |name: &String| {
                if name.is_empty() { "a part without a name".to_owned() } else { name.clone() }
            };
            listed(parts.iter().map(name))
        };
        let mut warnings = Vec::new();
        if !self.low.is_empty() {
            let names = named(&self.low);
            warnings.push(format!(
                "no part of the high models belongs to {names}; name it as the low part with _high in place \
                 of _low (or _hp of _lp), or do not match names"
            ));
        }
        if !self.high.is_empty() {
            let names = named(&self.high);
            warnings.push(format!("no part of the low model belongs to {names}, which is left out"));
        }
        warnings
    }
}

/// Puts surfaces into groups by the names of their parts, which [`match_names`] pairs, and removes high
/// surfaces that belong to no low part.
///
/// `low`: the model and its surfaces; `high`: all models and their surfaces, as of
/// [`HighModel::surfaces_of_all`].
pub fn group_by_name(
    low: (&LowModel<'_>, &mut [LowSurface<'_>]),
    high: (&[HighModel<'_>], &mut Vec<HighSurface<'_>>),
) -> UnpairedParts {
    let low_names: Vec<&str> = low.0.names().collect();
    let high_names: Vec<&str> = high.0.iter().flat_map(HighModel::names).collect();
    let found = match_names(&low_names, &high_names);
    for (surface, &group) in low.1.iter_mut().zip(&found.group_of_low) {
        *surface = surface.with_group(group);
    }
    let mut groups = found.group_of_high.iter();
    high.1.retain_mut(|surface| {
        let group = groups.next().copied().flatten();
        *surface = surface.with_group(group.unwrap_or_default());
        group.is_some()
    });
    let without_low = high_names.iter().zip(&found.group_of_high).filter(|(_, group)| group.is_none());
    UnpairedParts {
        low: distinct(found.low_without_high.iter().map(|&part| low_names[part])),
        high: distinct(without_low.map(|(&name, _)| name)),
    }
}

/// Names in their order, each once.
fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut seen = HashSet::new();
    names.filter(|&name| seen.insert(name)).map(str::to_owned).collect()
}

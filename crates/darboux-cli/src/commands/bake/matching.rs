//! `--match name`: parts see parts of the same name only.

use darboux_bake::{HighModel, HighSurface, LowModel, LowSurface, match_names};

/// Puts surfaces into groups by the names of their parts. High parts that belong to no low part are left out. Returns a warning about low
/// parts without a high one. Errors: no low part has one.
pub fn group_by_name<'a>(
    low: (&LowModel<'_>, &mut Vec<LowSurface<'a>>),
    high: (&[HighModel<'_>], &mut Vec<HighSurface<'a>>),
) -> Result<Option<String>, String> {
    let low_names: Vec<&str> = low.0.names().collect();
    let high_names: Vec<&str> = high.0.iter().flat_map(HighModel::names).collect();
    let found = match_names(&low_names, &high_names);
    for (surface, &group) in low.1.iter_mut().zip(&found.group_of_low) {
        *surface = surface.with_group(group);
    }
    let grouped = high.1.drain(..).zip(&found.group_of_high);
    let grouped: Vec<_> =
        grouped.filter_map(|(surface, group)| group.map(|group| surface.with_group(group))).collect();
    *high.1 = grouped;
    let mut alone: Vec<&str> = found.low_without_high.iter().map(|&part| low_names[part]).collect();
    alone.dedup();
    let names = alone.join(", ");
    let sentence =
        format!("no part of the high models belongs to {names}; name it as NAME_high, or leave --match out");
    match found.low_without_high.len() {
        0 => Ok(None),
        alone if alone == low_names.len() => Err(sentence),
        _ => Ok(Some(sentence)),
    }
}

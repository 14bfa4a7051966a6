//! Pairs parts of the low and the high models by their names.

/// What ends the names of low models. [`suffix_start`] says where.
pub const LOW_SUFFIXES: [&str; 3] = ["_low", "_lowpoly", "_lp"];

/// What ends the names of high models, or is followed by the name of a detail.
pub const HIGH_SUFFIXES: [&str; 3] = ["_high", "_highpoly", "_hp"];

/// Which parts belong together.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct NameMatch {
    /// The group of each low part, from 0.
    pub group_of_low: Vec<usize>,
    /// The group of each high part; none for parts that belong to no low part.
    pub group_of_high: Vec<Option<usize>>,
    /// The low parts to which no high part belongs, by their places.
    pub low_without_high: Vec<usize>,
}

/// Pairs parts by their names: `crate_low` with `crate_high`, `crate_high_bolts` and so on.
///
/// What precedes the last of [`LOW_SUFFIXES`] or [`HIGH_SUFFIXES`] counts, in upper or lower case; of other
/// names all but a number after a point, as in `crate.001`. Low parts of the same name share a group.
pub fn match_names(low: &[&str], high: &[&str]) -> NameMatch {
    let mut bases: Vec<String> = Vec::new();
    let mut group = |name: &&str| {
        let base = base_name(name);
        bases.iter().position(|other| *other == base).unwrap_or_else(|| {
            bases.push(base);
            bases.len() - 1
        })
    };
    let group_of_low: Vec<usize> = low.iter().map(&mut group).collect();
    let find = |name: &&str| {
        let base = base_name(name);
        bases.iter().position(|other| *other == base)
    };
    let group_of_high: Vec<Option<usize>> = high.iter().map(find).collect();
    let is_alone = |&part: &usize| !group_of_high.contains(&Some(group_of_low[part]));
    let low_without_high = (0..low.len()).filter(is_alone).collect();
    NameMatch { group_of_low, group_of_high, low_without_high }
}

/// Where the last suffix in a name starts, of the given ones. What follows a suffix is nothing, a digit, or
/// one of `_`, `.`, `-` and a space: `lamp_high_bolts` and `lamp_high2` have `_high`, `lamp_highlight` does
/// not. `name`, `suffixes`: in lower case.
pub fn suffix_start(name: &str, suffixes: &[&str]) -> Option<usize> {
    let ends_word = |next: char| next.is_ascii_digit() || "_.- ".contains(next);
    let start_of = |suffix: &&str| {
        let is_suffix =
            |&(start, _): &(usize, &str)| name[start + suffix.len()..].chars().next().is_none_or(ends_word);
        name.rmatch_indices(*suffix).find(is_suffix).map(|(start, _)| start)
    };
    suffixes.iter().filter_map(start_of).max()
}

/// What of a name counts.
fn base_name(name: &str) -> String {
    let name = name.to_lowercase();
    let end = suffix_start(&name, &[LOW_SUFFIXES, HIGH_SUFFIXES].concat());
    match (end, name.rsplit_once('.')) {
        (Some(end), _) => name[..end].to_owned(),
        (None, Some((base, number))) if number.bytes().all(|digit| digit.is_ascii_digit()) => base.to_owned(),
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_paired_by_what_precedes_low_and_high() {
        let low = ["Crate_low", "lid_LOW.001", "handle", "wheel_low"];
        let high = ["crate_high", "crate_high_bolts", "Lid_High", "handle.002", "axle_high"];
        let found = match_names(&low, &high);
        assert_eq!(found.group_of_low, [0, 1, 2, 3]);
        assert_eq!(found.group_of_high, [Some(0), Some(0), Some(1), Some(2), None]);
        assert_eq!(found.low_without_high, [3]);
    }

    #[test]
    fn short_and_long_suffixes_are_known() {
        let low = ["crate_LP", "lid_lowpoly", "bolt_low", "alp"];
        let high = ["crate_hp", "Crate_HP_nails", "lid_HighPoly", "bolt_hp.001", "chp"];
        let found = match_names(&low, &high);
        assert_eq!(found.group_of_high, [Some(0), Some(0), Some(1), Some(2), None]);
    }

    #[test]
    fn a_suffix_is_a_word() {
        let low = ["lamp_low", "lamp_highlight_low", "lamp_lower"];
        let high =
            ["lamp_high2", "lamp_highlight", "Lamp_High-bolts", "lamp_high_highlight", "lamp_lower_high"];
        let found = match_names(&low, &high);
        assert_eq!(found.group_of_low, [0, 1, 2]);
        assert_eq!(found.group_of_high, [Some(0), Some(1), Some(0), Some(0), Some(2)]);
    }

    #[test]
    fn parts_of_one_name_share_a_group() {
        let found = match_names(&["a_low", "b", "A_Low.001"], &[]);
        assert_eq!(found.group_of_low, [0, 1, 0]);
        assert_eq!(found.low_without_high, [0, 1, 2]);
    }
}

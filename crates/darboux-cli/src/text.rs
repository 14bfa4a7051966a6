//! Counts with their nouns, for messages.

use indicatif::HumanCount;

/// Formats a number with its noun.
pub fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{} {}", HumanCount(count as u64), if count == 1 { one } else { many })
}

/// Formats ", 3 nouns" for each count that is not zero.
pub fn nonzero_counts<'a>(counts: impl IntoIterator<Item = (usize, &'a str, &'a str)>) -> String {
    let counts = counts.into_iter().filter(|count| count.0 > 0);
    counts.map(|(count, one, many)| format!(", {}", counted(count, one, many))).collect()
}

//! Words of sentences.

/// A number with what is said of one thing, or of several.
pub fn counted(count: usize, one: &str, several: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { several })
}

/// As [`counted`]; none for none.
pub fn counted_if_any(count: usize, one: &str, several: &str) -> Option<String> {
    (count > 0).then(|| counted(count, one, several))
}

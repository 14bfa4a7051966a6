//! Counts with their nouns.

/// A number with what is said of one thing, or of several.
pub fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

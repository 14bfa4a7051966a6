//! Parts of sentences.

/// The names that a sentence shows.
const SHOWN: usize = 8;

/// The first names, separated by commas, and the number of the others.
pub fn listed(names: impl IntoIterator<Item = String>) -> String {
    let mut names = names.into_iter();
    let shown: Vec<String> = names.by_ref().take(SHOWN).collect();
    match names.count() {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

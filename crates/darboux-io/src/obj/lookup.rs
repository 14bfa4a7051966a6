//! Finds the files that lines of OBJ and MTL name. Names may contain spaces, and stand in quotes.

use super::texture_map::MtlMap;
use crate::code_page::decoded;
use crate::source::{FoundFile, LONGEST_PATH, ModelFiles};

/// A reference, and the file that it names.
pub type Found = (String, FoundFile);

/// The libraries that a `mtllib` line names: one whose name may contain spaces, or several. Errors: names
/// without a file.
pub fn libraries(files: &ModelFiles, line: &[u8]) -> Vec<Result<Found, String>> {
    if line.len() > LONGEST_PATH {
        return Vec::new();
    }
    let text = decoded(line);
    files.begin_reference();
    match find(files, "", &text) {
        Some(found) => vec![Ok(found)],
        None => {
            let of_word = |word: &str| find(files, "", word).ok_or_else(|| word.to_owned());
            text.split_ascii_whitespace().map(of_word).collect()
        }
    }
}

/// The file of a texture in the library named `library`.
///
/// Options that are not known may stand before the name, so the longest end of the line that names a file is
/// taken: one that leads to the file, or else one that has its name.
pub fn texture(files: &ModelFiles, library: &str, map: &MtlMap) -> Option<Found> {
    files.begin_reference();
    let line = &*map.statement;
    let starts = line
        .char_indices()
        .filter(|&(i, c)| i > 0 && !c.is_whitespace() && line[..i].ends_with(char::is_whitespace));
    let mut ends = starts.map(|(i, _)| &line[i..]).filter(|end| end.len() <= LONGEST_PATH);
    let in_place = |reference: &str| {
        let reference = without_quotes(reference).unwrap_or(reference);
        Some((reference.to_owned(), files.find_in_place(library, reference)?))
    };
    find(files, library, &map.file)
        .or_else(|| ends.clone().find_map(in_place))
        .or_else(|| ends.find_map(|end| find(files, library, end)))
}

/// The file of a reference, or of what stands between its quotes.
fn find(files: &ModelFiles, base: &str, reference: &str) -> Option<Found> {
    let references = [Some(reference), without_quotes(reference)].into_iter().flatten();
    references.into_iter().find_map(|reference| Some((reference.to_owned(), files.find(base, reference)?)))
}

/// What stands between the quotes of a name; none for a name without quotes.
pub fn without_quotes(name: &str) -> Option<&str> {
    name.trim().strip_prefix('"')?.strip_suffix('"')
}

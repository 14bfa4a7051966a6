//! The formats of models in help texts: all of them come from the library's one list.

use darboux_io::FileKind;

/// A help text in which `{models}` stands for the endings of models that this build reads, and `{written}`
/// for the endings of models that it writes.
pub fn with_endings(text: &str) -> String {
    text.replace("{models}", &FileKind::model_endings()).replace("{written}", &FileKind::written_endings())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    /// docs/formats.md describes every format, and names no other list.
    #[test]
    fn the_page_about_formats_has_all_endings() {
        let page = fs::read_to_string("../../docs/formats.md").expect("the page");
        let mut endings = FileKind::model_endings();
        if !endings.contains(".fbx") {
            endings += ", .fbx";
        }
        assert!(page.contains(&format!("`{endings}`")), "{endings}");
        let written = FileKind::written_endings();
        assert!(page.contains(&format!("`{written}`")), "{written}");
    }
}

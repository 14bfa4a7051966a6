//! What an OBJ refers to: material libraries, and their textures.

use std::fs;
use std::path::{Path, PathBuf};

/// References in longer lines are left out: so many bytes are more than a path has, and every word may begin one.
const LONGEST_LINE: usize = 4096;

/// A file, and the path by which the OBJ's folder knows it: with `/` between parts.
#[derive(Debug, PartialEq, Eq)]
pub struct Companion {
    pub name: String,
    pub path: PathBuf,
}

/// The libraries and textures that the OBJ at `path` names, as far as they lie in its folder or below; whatever is elsewhere is left out.
///
/// Errors: the file cannot be read; it has no faces.
pub fn companions(path: &Path) -> Result<Vec<Companion>, String> {
    let shown = path.display();
    let bytes = fs::read(path).map_err(|error| format!("{shown}: cannot be read: {error}"))?;
    let mut libraries = Vec::new();
    let mut has_faces = false;
    for (word, rest) in statements(&bytes) {
        has_faces |= word == b"f";
        if word == b"mtllib" && rest.len() <= LONGEST_LINE {
            libraries.push(rest);
        }
    }
    if !has_faces {
        return Err(format!("{shown}: has no faces as an OBJ has them; export it again"));
    }
    let folder = folder_of(path)?;
    let mut found = Vec::new();
    for library in libraries.into_iter().flat_map(|line| named(&folder, line)) {
        for texture in fs::read(&library.path).iter().flat_map(|text| textures(&folder, &library.name, text))
        {
            note(&mut found, texture);
        }
        note(&mut found, library);
    }
    Ok(found)
}

/// The folder of a file. The error is a sentence.
pub fn folder_of(path: &Path) -> Result<PathBuf, String> {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    let folder = parent.unwrap_or(Path::new(".")).canonicalize();
    folder.map_err(|error| format!("{}: its folder cannot be read: {error}", path.display()))
}

/// The libraries of a line: one whose name may have spaces, or several.
pub fn named(folder: &Path, line: &[u8]) -> Vec<Companion> {
    let words = || line.split(u8::is_ascii_whitespace).filter_map(|word| inside(folder, "", word));
    inside(folder, "", line).map_or_else(|| words().collect(), |library| vec![library])
}

fn note(found: &mut Vec<Companion>, companion: Companion) {
    if !found.contains(&companion) {
        found.push(companion);
    }
}

/// The textures of a material library.
fn textures(folder: &Path, library: &str, text: &[u8]) -> Vec<Companion> {
    let maps = statements(text).filter(|(word, _)| is_texture(word));
    maps.filter_map(|(_, line)| texture(folder, library, line)).collect()
}

/// The texture of a statement in a material library. Options stand before its name, which may have spaces: it is the longest end of the line
/// that names a file.
pub fn texture(folder: &Path, library: &str, line: &[u8]) -> Option<Companion> {
    if line.len() > LONGEST_LINE {
        return None;
    }
    let starts = line.iter().enumerate().filter(|&(at, _)| at == 0 || line[at - 1].is_ascii_whitespace());
    starts.map(|(at, _)| &line[at..]).find_map(|end| inside(folder, library, end))
}

fn is_texture(word: &[u8]) -> bool {
    let word = word.to_ascii_lowercase();
    word.starts_with(b"map_") || [&b"norm"[..], b"bump", b"disp", b"decal", b"refl"].contains(&&word[..])
}

/// The first word of every line, and what follows it.
fn statements(text: &[u8]) -> impl Iterator<Item = (&[u8], &[u8])> {
    text.split(|&byte| byte == b'\n' || byte == b'\r').map(|line| {
        let line = line.trim_ascii();
        let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
        (&line[..end], line[end..].trim_ascii())
    })
}

/// The file that `reference` means, seen from the file `base`, if it is one in `folder` or below, links followed.
fn inside(folder: &Path, base: &str, reference: &[u8]) -> Option<Companion> {
    let reference = str::from_utf8(reference).ok()?.replace('\\', "/");
    let mut parts: Vec<&str> = base.split('/').collect();
    parts.pop();
    for part in reference.split('/') {
        match part {
            "" | "." => {}
            ".." => _ = parts.pop()?,
            part => parts.push(part),
        }
    }
    let name = parts.join("/");
    let path = folder.join(&name).canonicalize().ok()?;
    let is_ours = !reference.starts_with('/') && path.starts_with(folder) && path.is_file();
    is_ours.then_some(Companion { name, path })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The names of an OBJ's companions; all files given are there.
    fn names_of(obj: &str, library: &str, files: &[&str]) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        files.iter().for_each(|file| fs::write(at(file), library).unwrap());
        fs::write(at("a.obj"), format!("{obj}\nf 1 2 3\n")).unwrap();
        companions(&at("a.obj")).unwrap().into_iter().map(|companion| companion.name).collect()
    }

    #[test]
    fn a_line_names_one_library_or_several() {
        assert_eq!(names_of("mtllib a.mtl\tb.mtl  c.mtl", "", &["a.mtl", "b.mtl"]), ["a.mtl", "b.mtl"]);
        assert_eq!(names_of("mtllib a b.mtl", "", &["a b.mtl", "a", "b.mtl"]), ["a b.mtl"]);
    }

    #[test]
    fn longer_lines_than_paths_are_left_out() {
        let line = |words: usize| format!("map_Kd {}a.png", "- ".repeat(words));
        let names = |words| names_of("mtllib a.mtl", &line(words), &["a.mtl", "a.png"]);
        assert_eq!(names(2000), ["a.png", "a.mtl"]);
        assert_eq!(names(60_000), ["a.mtl"]);
        assert!(names_of(&format!("mtllib {}a.mtl", " - ".repeat(60_000)), "", &["a.mtl"]).is_empty());
    }
}

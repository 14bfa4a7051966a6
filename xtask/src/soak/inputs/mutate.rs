//! Damages files: bytes of any file, lines of text, the JSON of glTF, and the chunks of PNG.

use serde_json::{Map, Value, json};

use super::model::{glb, split_glb};
use crate::soak::random::Random;

/// Numbers at which formats, counts and conversions break.
const NUMBERS: &[&str] = &[
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "3",
    "255",
    "256",
    "65535",
    "65536",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "9007199254740993",
    "18446744073709551615",
    "-9223372036854775808",
    "1e30",
    "1e39",
    "1e400",
    "-1e-50",
    "0.5",
    "nan",
    "inf",
    "",
];

/// Strings that break messages, paths and terminals.
const STRINGS: &[&str] = &[
    "",
    "\u{1b}[2J\u{1b}]0;x\u{7}",
    "a\nerror: forged",
    "a\r\nb",
    "\u{202e}fdp",
    "../outside",
    "/etc/passwd",
    "C:\\x",
    "a:b",
    "%00",
    "%2e%2e%2foutside",
    "http://x/y",
    "file:///etc/passwd",
    "data:,",
    "data:;base64,====",
    "TRIANGLES",
    "VEC3",
    "MAT4",
    "TEXCOORD_4294967296",
    "TANGENT",
    "EXT_meshopt_compression",
    "KHR_draco_mesh_compression",
];

/// Damages a file by its extension, to a degree that often leaves it readable; one in five stays as it is.
pub fn file(random: &mut Random, extension: &str, bytes: &mut Vec<u8>) {
    for _ in 0..random.pick(&[0, 1, 1, 1, 3]) {
        match extension {
            "glb" | "vrm" if !random.one_in(4) => glb_parts(random, bytes),
            "gltf" if !random.one_in(4) => {
                if let Ok(Value::Object(mut json)) = serde_json::from_slice(bytes) {
                    self::json(random, &mut json);
                    *bytes = Value::Object(json).to_string().into_bytes();
                }
            }
            "obj" | "mtl" | "toml" if !random.one_in(4) => lines(random, bytes),
            "ply" | "stl" if bytes.is_ascii() && !bytes.contains(&0) && !random.one_in(4) => {
                lines(random, bytes);
            }
            "png" if !random.one_in(3) => png_chunks(random, bytes),
            _ => some_bytes(random, bytes),
        }
    }
}

/// Changes, inserts, removes or repeats bytes anywhere.
pub fn some_bytes(random: &mut Random, bytes: &mut Vec<u8>) {
    let at = random.below(bytes.len());
    let end = (at + random.size(8)).min(bytes.len());
    match random.below(6) {
        0 => bytes.truncate(at),
        1 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
        2 => bytes[at..end].iter_mut().for_each(|byte| *byte = random.byte()),
        3 => drop(bytes.drain(at..end)),
        4 => {
            let part = bytes[at..end].to_vec();
            bytes.splice(at..at, part);
        }
        _ => {
            let number = random.pick(&[0, 1, u32::MAX, 1 << 31, 0x7F80_0000, 0x7FC0_0000, 0xFFFF]);
            let end = (at + 4).min(bytes.len());
            bytes.splice(at..end, number.to_le_bytes());
        }
    }
}

/// Repeats, removes and swaps lines of a text, and replaces its numbers.
fn lines(random: &mut Random, bytes: &mut Vec<u8>) {
    let text = String::from_utf8_lossy(bytes).into_owned();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    if lines.is_empty() {
        return;
    }
    let [a, b] = [random.below(lines.len()), random.below(lines.len())];
    match random.below(6) {
        0 => drop(lines.remove(a)),
        1 => lines.swap(a, b),
        2 => {
            let copies = vec![lines[a].clone(); random.size(12)];
            lines.splice(b..b, copies);
        }
        3 => lines[a] = format!("{} {}", lines[a], random.pick(STRINGS)),
        _ => {
            let mut words: Vec<&str> = lines[a].split(' ').collect();
            let word = random.below(words.len());
            words[word] = random.pick(NUMBERS);
            lines[a] = words.join(" ");
        }
    }
    *bytes = lines.join("\n").into_bytes();
}

/// Damages the JSON or the binary data of a GLB, and puts it together again with the right lengths.
fn glb_parts(random: &mut Random, bytes: &mut Vec<u8>) {
    let Some((mut document, mut data)) = split_glb(bytes) else { return some_bytes(random, bytes) };
    if random.one_in(3) {
        some_bytes(random, &mut data);
    } else {
        json(random, &mut document);
    }
    *bytes = glb(Value::Object(document).to_string().as_bytes(), &data);
}

/// Changes one value of a document: any value of any depth.
pub fn json(random: &mut Random, document: &mut Map<String, Value>) {
    let mut paths = Vec::new();
    collect(&Value::Object(document.clone()), String::new(), &mut paths);
    let path = paths[random.below(paths.len())].clone();
    let mut root = Value::Object(std::mem::take(document));
    if let Some(value) = root.pointer_mut(&path) {
        change(random, value);
    }
    *document = match root {
        Value::Object(changed) => changed,
        other => Map::from_iter([("asset".into(), other)]),
    };
}

/// Adds the pointers of all values below `value`.
fn collect(value: &Value, path: String, paths: &mut Vec<String>) {
    match value {
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(i, value)| collect(value, format!("{path}/{i}"), paths));
        }
        Value::Object(members) => members.iter().for_each(|(key, value)| {
            collect(value, format!("{path}/{}", key.replace('~', "~0").replace('/', "~1")), paths);
        }),
        _ => {}
    }
    paths.push(path);
}

fn change(random: &mut Random, value: &mut Value) {
    match value {
        Value::Number(number) if !random.one_in(5) => {
            let near = number.as_i64().unwrap_or(0).wrapping_add(random.below(9) as i64 - 4);
            *value = if random.one_in(2) { json!(near) } else { number_of(random) };
        }
        Value::String(_) if !random.one_in(5) => *value = string_of(random),
        Value::Array(list) if !list.is_empty() && !random.one_in(4) => {
            let at = random.below(list.len());
            match random.below(3) {
                0 => drop(list.remove(at)),
                1 => list.rotate_left(at),
                _ => {
                    let copies = vec![list[at].clone(); random.size(8)];
                    list.extend(copies);
                }
            }
        }
        Value::Object(members) if !members.is_empty() && !random.one_in(4) => {
            let key = members.keys().nth(random.below(members.len())).cloned().unwrap_or_default();
            match random.below(3) {
                0 => drop(members.remove(&key)),
                1 => {
                    let taken = members.remove(&key).unwrap_or_default();
                    members.insert(random.pick(STRINGS).to_owned(), taken);
                }
                _ => drop(members.insert(random.pick(STRINGS).to_owned(), number_of(random))),
            }
        }
        _ => {
            *value = random
                .pick(&[Value::Null, json!([]), json!({}), json!(true), json!("x"), json!(7)].each_ref())
                .clone()
        }
    }
}

fn number_of(random: &mut Random) -> Value {
    serde_json::from_str(random.pick(NUMBERS)).unwrap_or(Value::Null)
}

fn string_of(random: &mut Random) -> Value {
    let text = random.pick(STRINGS);
    Value::String(if random.one_in(20) { text.repeat(5000) } else { text.to_owned() })
}

/// Damages chunks of a PNG, and corrects their checksums.
fn png_chunks(random: &mut Random, bytes: &mut Vec<u8>) {
    let mut chunks = chunks_of(bytes);
    if chunks.is_empty() {
        return some_bytes(random, bytes);
    }
    let at = random.below(chunks.len());
    match random.below(5) {
        0 => drop(chunks.remove(at)),
        1 => chunks.swap(0, at),
        2 => chunks.insert(at, chunks[at].clone()),
        // The header: width, height, depth, colour type, interlacing.
        3 if chunks[0].len() == 17 => {
            let field = 4 + random.below(13);
            chunks[0][field] = random.pick(&[0, 1, 2, 3, 4, 6, 8, 16, 127, 255]);
        }
        _ => some_bytes(random, &mut chunks[at]),
    }
    let mut file = bytes[..8].to_vec();
    for chunk in chunks {
        file.extend((chunk.len().saturating_sub(4) as u32).to_be_bytes());
        file.extend(&chunk);
        file.extend(crc32fast::hash(&chunk).to_be_bytes());
    }
    *bytes = file;
}

/// The chunks of a PNG: each its type and content.
fn chunks_of(bytes: &[u8]) -> Vec<Vec<u8>> {
    let mut chunks = Vec::new();
    let mut rest = bytes.get(8..).unwrap_or_default();
    while let Some((length, after)) = rest.split_first_chunk::<4>() {
        let length = u32::from_be_bytes(*length) as usize;
        let Some(chunk) = after.get(..length.saturating_add(4)) else { break };
        chunks.push(chunk.to_vec());
        rest = after.get(length.saturating_add(8)..).unwrap_or_default();
    }
    chunks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soak::inputs::{images, model::Mesh};

    #[test]
    fn damage_is_repeatable_and_of_every_format() {
        let good = [
            ("glb", Mesh::square(1.0).glb()),
            ("gltf", br#"{"asset":{"version":"2.0"},"nodes":[{"name":"a/b~"}]}"#.to_vec()),
            ("obj", b"v 0 0 0\nf 1 1 1\n".to_vec()),
            ("png", images::any_png(&mut Random::new(1, 1)).expect("a PNG")),
            ("bin", Vec::new()),
        ];
        for (extension, good) in good {
            let damaged = |case| {
                let mut bytes = good.clone();
                file(&mut Random::new(5, case), extension, &mut bytes);
                bytes
            };
            assert!((0..300).all(|case| damaged(case) == damaged(case)), "{extension}");
            assert!((0..300).any(|case| damaged(case) != good), "{extension}");
        }
    }

    #[test]
    fn chunks_have_right_checksums() {
        let good = images::any_png(&mut Random::new(1, 1)).expect("a PNG");
        let whole = |bytes: &[u8]| chunks_of(bytes).iter().map(|chunk| chunk.len() + 8).sum::<usize>() + 8;
        assert_eq!(whole(&good), good.len());
    }
}

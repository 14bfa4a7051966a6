//! Reads the text of an OBJ: lists of positions, UVs and normals, and faces that refer to them.

use super::companions::NO_FACES;
use super::materials::Materials;
use super::meshes;
use super::statements::{is_face, statements, words};
use super::text::{Corner, KINDS, ObjText, Run};
use crate::LoadOptions;
use crate::code_page::decoded;
use crate::error::ContentError;
use crate::image::srgb_to_linear;
use crate::source::{ModelFiles, SourceFormat, SourceScene, program_of_comment};
use crate::words::counted;

/// Reads an OBJ with the material libraries and textures in its folder or below.
///
/// Errors: a number that is none; an index of nothing; no faces.
pub fn read(bytes: &[u8], files: &ModelFiles, _: &LoadOptions) -> Result<SourceScene, ContentError> {
    let mut scene = SourceScene::new(SourceFormat::Obj);
    scene.generator = generator(bytes);
    let mut text = ObjText::default();
    let mut materials = Materials::new(files);
    for (line, statement, rest) in statements(bytes) {
        text.add(statement, rest, &mut materials).map_err(|problem| invalid(line, &problem))?;
    }
    text.end_run();
    if text.corners.is_empty() {
        return Err(ContentError::invalid("", without_faces(&text)));
    }
    text.leave_out_colors(&mut scene);
    text.use_zbrush_colors(&mut scene);
    scene.meshes = meshes::build(&text)
        .map_err(|missing| invalid(line_of_corner(bytes, missing.corner), &missing.problem))?;
    materials.finish(&mut scene);
    if text.lines_and_points > 0 {
        scene.not_carried.push(counted(text.lines_and_points, "line or point", "lines and points"));
    }
    if text.curves > 0 {
        let statements = ["statement of curves or surfaces", "statements of curves and surfaces"];
        scene.not_carried.push(counted(text.curves, statements[0], statements[1]));
    }
    Ok(scene)
}

/// What is wrong with a file without faces.
fn without_faces(text: &ObjText) -> String {
    let what = match (text.lines_and_points, text.positions.len()) {
        (0, 0) => return NO_FACES.to_owned(),
        (0, _) => "a point cloud",
        _ => "only lines and points",
    };
    format!("is an OBJ without faces, {what}; bake and tangents need faces; export the model as a mesh")
}

/// `problem`: a clause whose subject is the line.
fn invalid(line: usize, problem: &str) -> ContentError {
    ContentError::invalid(format!("line {line}"), format!("{problem}; export the file again"))
}

/// The line of the face to which a corner belongs. Elements may follow the faces that refer to them, so it is
/// known at the end of the text only that one is missing.
fn line_of_corner(bytes: &[u8], corner: usize) -> usize {
    let faces = statements(bytes).filter(|(_, statement, _)| is_face(statement));
    let mut ends = faces.scan(0, |end, (line, _, rest)| {
        let size = words(rest).count();
        *end += if size < 3 { 0 } else { size };
        Some((line, *end))
    });
    ends.find(|&(_, end)| end > corner).map_or(0, |(line, _)| line)
}

/// The program that the comments at the start name, as in `# Blender 5.0.1`.
fn generator(bytes: &[u8]) -> Option<String> {
    let lines = bytes[..bytes.len().min(1000)].split(|&byte| byte == b'\n' || byte == b'\r');
    let lines = lines.filter(|line| !line.is_empty()).map_while(|line| line.strip_prefix(b"#"));
    lines.map(String::from_utf8_lossy).find_map(|comment| program_of_comment(&comment))
}

impl ObjText {
    /// Adds a statement. The error is a clause whose subject is the line.
    fn add(&mut self, statement: &[u8], rest: &[u8], materials: &mut Materials<'_>) -> Result<(), String> {
        match statement {
            b"v" => self.add_position(rest)?,
            b"vt" => {
                let [u, v] = numbers(rest, 1)?;
                self.uvs.push([u, v]);
            }
            b"vn" => self.normals.push(numbers(rest, 3)?),
            face if is_face(face) => {
                if self.material.is_none() {
                    self.material = materials.with_name_only();
                }
                self.add_face(rest)?;
            }
            b"o" | b"g" => {
                self.end_run();
                self.name = decoded(rest).into_owned();
                self.kind = if statement == b"o" { "o" } else { "g" };
            }
            b"usemtl" => self.material = materials.choose(rest),
            b"mtllib" => materials.load(rest),
            b"s" => {
                self.has_smoothing = true;
                self.group = str::from_utf8(rest).ok().and_then(|group| group.parse().ok()).unwrap_or(0);
            }
            b"l" | b"p" => self.lines_and_points += 1,
            b"curv" | b"curv2" | b"surf" => self.curves += 1,
            b"#MRGB" => self.zbrush_colors.extend(rest.as_chunks().0.iter().map_while(zbrush_color)),
            _ => {}
        }
        Ok(())
    }

    fn add_position(&mut self, rest: &[u8]) -> Result<(), String> {
        let mut found = [0.0; 6];
        let mut count = 0;
        for word in words(rest).take(7) {
            if count < 6 {
                found[count] = number(word)?;
            }
            count += 1;
        }
        let [x, y, z, r, g, b] = found;
        if count < 3 {
            return Err("is a position with fewer than three numbers".to_owned());
        }
        self.colored_positions += usize::from(count == 6);
        if count == 6 && self.colors.len() == self.positions.len() {
            let linear = [r, g, b].map(|x| srgb_to_linear(f64::from(x).clamp(0.0, 1.0)) as f32);
            self.colors.push([linear[0], linear[1], linear[2], 1.0]);
        }
        self.positions.push([x, y, z]);
        Ok(())
    }

    /// Colours that only some positions have are left out.
    fn leave_out_colors(&self, scene: &mut SourceScene) {
        let (colored, positions) = (self.colored_positions, self.positions.len());
        if colored > 0 && colored < positions {
            let colors = counted(colored, "colour", "colours");
            scene.not_carried.push(format!("{colors} for {positions} positions"));
        }
    }

    /// Takes the colours of ZBrush where the file has no others and each position has one.
    fn use_zbrush_colors(&mut self, scene: &mut SourceScene) {
        let (colors, positions) = (std::mem::take(&mut self.zbrush_colors), self.positions.len());
        if colors.is_empty() {
            return;
        }
        if self.colors.is_empty() && colors.len() == positions {
            self.colors = colors;
        } else {
            let colors = counted(colors.len(), "colour", "colours");
            scene.not_carried.push(format!("{colors} of ZBrush (#MRGB) for {positions} positions"));
        }
    }

    fn add_face(&mut self, rest: &[u8]) -> Result<(), String> {
        let before = self.corners.len();
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        for word in words(rest) {
            self.corners.push(corner(word, counts)?);
        }
        let size = self.corners.len() - before;
        if size < 3 {
            self.corners.truncate(before);
            self.lines_and_points += 1;
            return Ok(());
        }
        self.sizes.push(size as u32);
        self.materials.push(self.material);
        self.smoothing.push(self.group);
        Ok(())
    }

    /// Ends the current object or group.
    fn end_run(&mut self) {
        let end = (self.corners.len(), self.sizes.len());
        if end.1 > self.start.1 {
            let [corners, faces] = [self.start.0..end.0, self.start.1..end.1];
            self.runs.push(Run { name: self.name.clone(), kind: self.kind, corners, faces });
        }
        self.start = end;
    }
}

/// Linear RGBA of a colour of ZBrush: eight hexadecimal digits, of which the first two are a mask.
fn zbrush_color(digits: &[u8; 8]) -> Option<[f32; 4]> {
    let number = u32::from_str_radix(str::from_utf8(digits).ok()?, 16).ok()?;
    let [_, r, g, b] = number.to_be_bytes().map(|byte| srgb_to_linear(f64::from(byte) / 255.0) as f32);
    Some([r, g, b, 1.0])
}

/// The numbers at the start of a statement; those after the first `least` may be missing, and are 0.
fn numbers<const N: usize>(rest: &[u8], least: usize) -> Result<[f32; N], String> {
    let mut found = [0.0; N];
    let mut count = 0;
    for (slot, word) in found.iter_mut().zip(words(rest)) {
        *slot = number(word)?;
        count += 1;
    }
    if count < least { Err(format!("has fewer than {least} numbers")) } else { Ok(found) }
}

fn number(word: &[u8]) -> Result<f32, String> {
    let text = str::from_utf8(word).ok();
    text.and_then(|text| text.parse().ok()).ok_or_else(|| {
        format!("has {:?}, which is no number", crate::error::shortened(&String::from_utf8_lossy(word)))
    })
}

/// The indices of a corner, such as `1/2/3`, `1//3` or `-1`. `counts`: the positions, UVs and normals before
/// the face.
fn corner(word: &[u8], counts: [usize; 3]) -> Result<Corner, String> {
    let wrong = || {
        format!(
            "has {:?}, which is no corner of a face",
            crate::error::shortened(&String::from_utf8_lossy(word))
        )
    };
    let mut corner = Corner::default();
    for (kind, index) in word.split(|&byte| byte == b'/').enumerate() {
        if kind == 3 {
            return Err(wrong());
        }
        if index.is_empty() && kind > 0 {
            continue;
        }
        let index = whole_number(index).ok_or_else(wrong)?;
        let absolute = if index < 0 { counts[kind] as i64 + index } else { index - 1 };
        corner[kind] = u32::try_from(absolute).map_err(|_| match index {
            0 => "has the index 0, but indices begin at 1".to_owned(),
            ..0 => format!("refers to {} {index}, but there are {} before it", KINDS[kind], counts[kind]),
            _ => wrong(),
        })?;
    }
    Ok(corner)
}

/// A whole number in decimal digits, with or without a sign. None for other texts, and for more digits than
/// an index has.
fn whole_number(text: &[u8]) -> Option<i64> {
    let (is_negative, digits) = match text {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if !(1..=18).contains(&digits.len()) {
        return None;
    }
    let mut number = 0;
    for digit in digits {
        number = 10 * number + i64::from(digit.checked_sub(b'0').filter(|digit| *digit < 10)?);
    }
    Some(if is_negative { -number } else { number })
}

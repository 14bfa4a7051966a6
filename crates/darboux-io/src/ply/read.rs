//! Reads the elements of a PLY: vertices here, faces in their file, others to skip them.

use super::faces::FaceReader;
use super::header::{self, Element, Encoding, Header, NumberType};
use super::layout::{VertexLayout, VertexProperty, layout};
use super::property::{cut_off, next, properties, too_short};
use super::textures;
use super::values::{Values, decode};
use crate::error::{ContentError, shortened};
use crate::image::srgb_to_linear;
use crate::source::{
    CornerValues, ModelFiles, SourceFormat, SourceMesh, SourceScene, SourceUvSet, program_of_comment,
};

/// Reads a PLY. Errors: a header that is none; numbers that are cut off or none; no faces.
///
/// In ASCII, each record is a line. A file that cannot be read so, because its records wrap or share lines,
/// is read without regard to line ends if that leaves nothing over. One that is cut off, or has a word where
/// a number should be, is not read again.
pub fn read(bytes: &[u8], files: &ModelFiles) -> Result<SourceScene, ContentError> {
    let header = header::parse(bytes)?;
    let mut elements = Elements::new(bytes, &header, true);
    if let Err(error) = elements.read_all(&header) {
        if !elements.values.may_wrap() {
            return Err(error);
        }
        elements = Elements::new(bytes, &header, false);
        let is_read = elements.read_all(&header).is_ok() && elements.values.rest().trim_ascii().is_empty();
        if !is_read {
            return Err(error);
        }
    }
    let Elements { mut mesh, faces, mut scene, values } = elements;
    if !faces.has_surface() {
        let advice = "bake and tangents need faces; export the model as a mesh";
        return Err(ContentError::invalid("", format!("is a PLY without faces, a point cloud; {advice}")));
    }
    scene.generator = generator(&header);
    scene.warnings.extend(surplus_warning(&values));
    scene.warnings.extend(trailing_warning(&values, &header));
    let textures = textures::add(&header, files, &mut scene);
    faces.finish(textures, &mut mesh, &mut scene);
    scene.meshes.push(mesh);
    Ok(scene)
}

/// The elements of a file.
struct Elements<'a> {
    mesh: SourceMesh,
    faces: FaceReader,
    scene: SourceScene,
    values: Values<'a>,
}

impl<'a> Elements<'a> {
    fn new(bytes: &'a [u8], header: &Header, by_lines: bool) -> Self {
        Self {
            mesh: SourceMesh::default(),
            faces: FaceReader::default(),
            scene: SourceScene::new(SourceFormat::Ply),
            values: Values::new(bytes, header, by_lines),
        }
    }

    fn read_all(&mut self, header: &Header) -> Result<(), ContentError> {
        let Self { mesh, faces, scene, values } = self;
        // The bytes that all elements so far have at least, so that no memory or time is taken for elements
        // that cannot be there.
        let (mut needed, present) = (0_usize, values.left() + 1);
        for element in header.elements.iter().filter(|element| !element.properties.is_empty()) {
            let least = element.least_bytes(header.encoding).max(1);
            needed = needed.saturating_add(element.count.saturating_mul(least));
            if needed > present {
                return Err(too_short(element));
            }
            match &*element.name {
                "vertex" if mesh.positions.is_empty() => {
                    read_vertices(element, header.encoding, values, mesh, scene)?
                }
                "face" | "tristrips" => faces.read(element, values, scene)?,
                _ => skip(element, values, scene)?,
            }
        }
        Ok(())
    }
}

/// A sentence about values that are not in the header; none for none.
fn surplus_warning(values: &Values<'_>) -> Option<String> {
    let (count, lines) = (values.surplus.values, values.surplus.lines);
    if lines == 0 {
        return None;
    }
    let first = values.first_surplus_line();
    Some(match (count, lines) {
        (1, _) => format!("line {first} has 1 value more than its header says, which is ignored"),
        (_, 1) => format!("line {first} has {count} values more than its header says, which are ignored"),
        _ => format!(
            "{lines} lines have {count} values more than its header says, line {first} first; they are \
             ignored"
        ),
    })
}

/// A sentence about what follows the last element; none for none, and for a line end.
fn trailing_warning(values: &Values<'_>, header: &Header) -> Option<String> {
    let rest = values.rest();
    let (count, what) = if header.encoding == Encoding::Ascii {
        let lines = rest.split(|&byte| byte == b'\n' || byte == b'\r');
        (lines.filter(|line| !line.trim_ascii().is_empty()).count(), "line")
    } else if matches!(rest, b"\n" | b"\r\n") {
        (0, "byte")
    } else {
        (rest.len(), "byte")
    };
    let after = "after the last element that its header counts";
    Some(match count {
        0 => return None,
        1 => format!("1 {what} {after} is ignored"),
        _ => format!("{count} {what}s {after} are ignored"),
    })
}

/// The program of a comment such as `Created in Blender version 5.0.1`.
fn generator(header: &Header) -> Option<String> {
    let text =
        |line: &str| line.split_once(char::is_whitespace).map_or(String::new(), |(_, text)| text.to_owned());
    header.comments.iter().find_map(|line| program_of_comment(&text(line)))
}

/// The vertices while they are read.
#[derive(Debug, Default)]
struct VertexLists {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uv_sets: Vec<Vec<[f32; 2]>>,
    colors: Vec<[f32; 4]>,
    tangents: Vec<[f32; 4]>,
}

fn read_vertices(
    element: &Element,
    encoding: Encoding,
    values: &mut Values<'_>,
    mesh: &mut SourceMesh,
    scene: &mut SourceScene,
) -> Result<(), ContentError> {
    let VertexLayout { kinds, uv_sets, has_normals, has_colors, has_tangents } = layout(element)
        .ok_or_else(|| ContentError::invalid("element vertex", "has no x, y and z; export the file again"))?;
    let count = element.count;
    let mut lists = VertexLists { positions: vec![[0.0; 3]; count], ..VertexLists::default() };
    lists.uv_sets.resize_with(uv_sets.len(), || vec![[0.0; 2]; count]);
    lists.normals.resize(if has_normals { count } else { 0 }, [0.0; 3]);
    lists.colors.resize(if has_colors { count } else { 0 }, [1.0; 4]);
    lists.tangents.resize(if has_tangents { count } else { 0 }, [0.0; 4]);
    match (encoding, row_size(element)) {
        (Encoding::LittleEndian | Encoding::BigEndian, Some(size)) => {
            let rows = values.bytes(size * element.count).ok_or_else(|| too_short(element))?;
            lists.read_rows(element, &kinds, encoding, rows, size);
        }
        _ => {
            for vertex in 0..element.count {
                values.begin_record();
                for (property, &kind) in element.properties.iter().zip(&kinds) {
                    let value = next(property, values).ok_or_else(|| cut_off(element, vertex, values))?;
                    lists.set(vertex, kind, value, property.number);
                }
                values.end_record();
            }
        }
    }
    let others = element.properties.iter().zip(&kinds).filter(|(_, kind)| **kind == VertexProperty::Other);
    scene.not_carried.extend(properties("vertex", others.map(|(property, _)| &*property.name)));
    lists.finish(uv_sets, mesh);
    Ok(())
}

/// The number of bytes of a binary row; none if it has lists.
fn row_size(element: &Element) -> Option<usize> {
    element
        .properties
        .iter()
        .map(|property| property.length.is_none().then_some(property.number.size()))
        .sum()
}

/// The binary rows of an element, all of one size.
struct Columns<'a> {
    element: &'a Element,
    kinds: &'a [VertexProperty],
    encoding: Encoding,
    rows: &'a [u8],
    size: usize,
}

impl Columns<'_> {
    /// Copies the vectors of these properties into `list` and adds the properties to `done`, if all are
    /// little-endian numbers of single precision.
    fn copy<const N: usize>(
        &self,
        wanted: [VertexProperty; N],
        list: &mut Vec<[f32; N]>,
        done: &mut Vec<VertexProperty>,
    ) {
        let Some(offsets) = self.offsets(wanted) else { return };
        list.clear();
        for row in self.rows.chunks_exact(self.size) {
            let mut vector = [0.0; N];
            for (number, &at) in vector.iter_mut().zip(&offsets) {
                *number = f32::from_le_bytes([row[at], row[at + 1], row[at + 2], row[at + 3]]);
            }
            list.push(vector);
        }
        done.extend(wanted);
    }

    fn offsets<const N: usize>(&self, wanted: [VertexProperty; N]) -> Option<[usize; N]> {
        if self.encoding != Encoding::LittleEndian {
            return None;
        }
        let mut found = [0; N];
        for (to, kind) in found.iter_mut().zip(wanted) {
            let place = self.kinds.iter().position(|&other| other == kind)?;
            let properties = &self.element.properties;
            if properties[place].number != NumberType::F32 {
                return None;
            }
            *to = properties[..place].iter().map(|property| property.number.size()).sum();
        }
        Some(found)
    }
}

impl VertexLists {
    /// Reads rows: vectors of single precision in one pass each, then what is left property by property, so
    /// that each loop has one type and one target.
    fn read_rows(
        &mut self,
        element: &Element,
        kinds: &[VertexProperty],
        encoding: Encoding,
        rows: &[u8],
        size: usize,
    ) {
        use VertexProperty::{Normal, Position, Tangent, Uv};

        let columns = Columns { element, kinds, encoding, rows, size };
        let mut done = Vec::new();
        columns.copy([0, 1, 2].map(Position), &mut self.positions, &mut done);
        if !self.normals.is_empty() {
            columns.copy([0, 1, 2].map(Normal), &mut self.normals, &mut done);
        }
        if !self.tangents.is_empty() {
            columns.copy([0, 1, 2, 3].map(Tangent), &mut self.tangents, &mut done);
        }
        for (set, uvs) in self.uv_sets.iter_mut().enumerate() {
            columns.copy([0, 1].map(|axis| Uv(set, axis)), uvs, &mut done);
        }
        let mut offset = 0;
        for (property, &kind) in element.properties.iter().zip(kinds) {
            let number = property.number;
            if kind != VertexProperty::Other && !done.contains(&kind) {
                for (vertex, row) in rows.chunks_exact(size).enumerate() {
                    self.set(vertex, kind, decode(number, encoding, &row[offset..]), number);
                }
            }
            offset += number.size();
        }
    }

    #[inline]
    fn set(&mut self, vertex: usize, kind: VertexProperty, value: f64, number: NumberType) {
        match kind {
            VertexProperty::Position(axis) => self.positions[vertex][axis] = value as f32,
            VertexProperty::Normal(axis) => {
                if let Some(normal) = self.normals.get_mut(vertex) {
                    normal[axis] = value as f32;
                }
            }
            VertexProperty::Uv(set, axis) => self.uv_sets[set][vertex][axis] = value as f32,
            VertexProperty::Color(channel) => {
                if let Some(color) = self.colors.get_mut(vertex) {
                    let value = value / number.full_intensity();
                    color[channel] =
                        if channel == 3 { value } else { srgb_to_linear(value.clamp(0.0, 1.0)) } as f32;
                }
            }
            VertexProperty::Tangent(axis) => {
                if let Some(tangent) = self.tangents.get_mut(vertex) {
                    tangent[axis] = value as f32;
                }
            }
            VertexProperty::Other => {}
        }
    }

    /// Moves everything into the mesh. `uv_sets`: their names.
    fn finish(self, uv_sets: Vec<String>, mesh: &mut SourceMesh) {
        mesh.positions = self.positions;
        mesh.normals = (!self.normals.is_empty()).then(|| CornerValues::of_positions(self.normals));
        mesh.tangents = (!self.tangents.is_empty()).then(|| CornerValues::of_positions(self.tangents));
        if !self.colors.is_empty() {
            mesh.colors.push(CornerValues::of_positions(self.colors));
        }
        let uv_sets = uv_sets.into_iter().zip(self.uv_sets);
        let uv_sets = uv_sets.map(|(name, uvs)| SourceUvSet { name, uvs: CornerValues::of_positions(uvs) });
        mesh.uv_sets.extend(uv_sets);
    }
}

fn skip(element: &Element, values: &mut Values<'_>, scene: &mut SourceScene) -> Result<(), ContentError> {
    for index in 0..element.count {
        values.begin_record();
        for property in &element.properties {
            next(property, values).ok_or_else(|| cut_off(element, index, values))?;
        }
        values.end_record();
    }
    if element.count > 0 {
        let (count, name) = (element.count, shortened(&element.name));
        scene.not_carried.push(format!("{count} {name}, an element that is not read"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file that cannot be read line by line is read again only where its records may wrap or share lines.
    #[test]
    fn files_that_are_cut_off_are_read_once() {
        let head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
        for (rows, expected) in [
            ("0 0 0\n1 0 0\n0 1 0\n3 0 1\n", false),
            ("0.0 0.0 0.0\n1.0 0.0 0.0\n0 1", false),
            ("0.0 0.0 0.0\n1.0 0.0 0.0\n", false),
            ("0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n", false),
            ("0 0\n0\n1 0 0\n0 1 0\n3 0 1 2\n", true),
            ("0 0 0 1 0 0\n0 1 0 3 0 1 2\n", true),
        ] {
            let file = format!("{head}{rows}");
            let header = header::parse(file.as_bytes()).expect("a header");
            let mut elements = Elements::new(file.as_bytes(), &header, true);
            assert!(elements.read_all(&header).is_err(), "{rows:?}");
            assert_eq!(elements.values.may_wrap(), expected, "{rows:?}");
        }
    }
}

//! The table of `darboux inspect`: numbers in columns, and below each row the primitive's name and
//! attributes.
//!
//! The columns fit into 80 characters unless the counts are very large.

use darboux_io::gltf::PrimitiveInfo;
use darboux_io::words::Count;

use super::recipe::MadeBy;
use super::report::{InspectedFile, InspectedPrimitive};
use crate::text::printable;

/// A column: its title in two lines, its alignment, and its text for a primitive.
struct Column {
    title: [&'static str; 2],
    align: Align,
    cell: fn(&PrimitiveInfo) -> String,
}

enum Align {
    Left,
    Right,
}

const COLUMNS: [Column; 8] = [
    column(["", ""], Align::Left, |info| format!("{}.{}", info.name.mesh, info.name.primitive)),
    column(["", "vertices"], Align::Right, |info| count(info.vertices)),
    column(["", "triangles"], Align::Right, triangles),
    column(["UV", "set"], Align::Right, |info| info.uv_set.to_string()),
    column(["mirrored", "edges"], Align::Right, |info| count(info.counts.mirrored_edges)),
    column(["degenerate", "triangles"], Align::Right, degenerate_triangles),
    column(["vertices", "to split"], Align::Right, |info| count(info.counts.split_vertices)),
    column(["", "tangents"], Align::Left, |info| tangents(info).to_owned()),
];

const fn column(title: [&'static str; 2], align: Align, cell: fn(&PrimitiveInfo) -> String) -> Column {
    Column { title, align, cell }
}

/// The space between two columns.
const GAP: &str = "  ";

fn count(count: usize) -> String {
    Count(count).to_string()
}

/// The number of triangles, and the mode of strips and fans.
fn triangles(info: &PrimitiveInfo) -> String {
    match info.mode.strip_prefix("TRIANGLE_") {
        Some(mode) => format!("{} {}", count(info.counts.triangles), mode.to_lowercase()),
        None => count(info.counts.triangles),
    }
}

fn degenerate_triangles(info: &PrimitiveInfo) -> String {
    match info.counts.uv_degenerate_triangles {
        0 => count(info.counts.degenerate_triangles),
        in_uv => format!("{}, {} UV", count(info.counts.degenerate_triangles), count(in_uv)),
    }
}

fn tangents(info: &PrimitiveInfo) -> &'static str {
    match (info.has_tangents, info.needs_tangents, &info.ineligible) {
        (true, ..) => "yes",
        (false, _, Some(_)) => "-",
        (false, true, None) => "needed",
        (false, false, None) => "no",
    }
}

/// The file's name and its table. Below a row: the mesh's name, the attributes, how its tangents were made,
/// and why the primitive cannot have tangents.
pub fn describe(file: &InspectedFile) -> String {
    let cells = |info: &PrimitiveInfo| COLUMNS.each_ref().map(|column| (column.cell)(info));
    let rows: Vec<_> = file.primitives.iter().map(|primitive| cells(&primitive.info)).collect();
    let titles = [0, 1].map(|line| COLUMNS.each_ref().map(|column| column.title[line].to_owned()));
    let widths: [usize; COLUMNS.len()] = std::array::from_fn(|column| {
        rows.iter().chain(&titles).map(|row| row[column].len()).max().unwrap_or_default()
    });
    let mut text = format!("{}\n\n", printable(&file.input));
    titles.iter().for_each(|title| text += &aligned(title, &widths));
    text += &aligned(&widths.map(|width| "-".repeat(width)), &widths);
    for (row, primitive) in rows.iter().zip(&file.primitives) {
        text += &aligned(row, &widths);
        text += &details(primitive, widths[0]);
    }
    text + "\n"
}

/// One line of the table.
fn aligned(cells: &[String; COLUMNS.len()], widths: &[usize; COLUMNS.len()]) -> String {
    let aligned: Vec<String> = (0..COLUMNS.len())
        .map(|column| match COLUMNS[column].align {
            Align::Left => format!("{:<width$}", cells[column], width = widths[column]),
            Align::Right => format!("{:>width$}", cells[column], width = widths[column]),
        })
        .collect();
    format!("{}\n", aligned.join(GAP).trim_end())
}

/// The lines below a row, indented by the width of the first column.
fn details(primitive: &InspectedPrimitive, indent: usize) -> String {
    let InspectedPrimitive { info, made_by } = primitive;
    let name = info.name.shown_mesh_name().map(|name| format!("\"{name}\" ")).unwrap_or_default();
    let targets = match info.morph_targets {
        0 => String::new(),
        count => format!(" + {count} morph targets"),
    };
    let mut text = String::new();
    let attributes = format!("{name}{}{targets}", info.attributes.join(" "));
    let has_tangents = info.attributes.iter().any(|attribute| attribute == "TANGENT");
    let outcome = if has_tangents { "its tangents cannot be computed again" } else { "no tangents" };
    let ineligible = info.ineligible.as_ref().map(|reason| format!("{outcome}: {reason}"));
    for line in [Some(attributes), made_by.as_ref().map(MadeBy::describe), ineligible] {
        let line = line.filter(|line| !line.is_empty());
        line.iter().for_each(|line| text += &format!("{:indent$}{GAP}{}\n", "", printable(line)));
    }
    text
}

//! Formats results as tables for people.

use comfy_table::{CellAlignment, Table, presets};

use crate::engines::{MESHOPT, REFERENCE};
use crate::instructions::{Counts, MESHES};
use crate::rounds::{Row, times_over};

const HEADER: [&str; 11] = [
    "mesh",
    "engine",
    "ns/triangle min",
    "median",
    "wall median",
    "x mikktspace.c",
    "x meshopt",
    "threads",
    "rounds",
    "extra bytes/triangle",
    "answer",
];

/// One line per row; unknown values give empty cells.
pub fn table(rows: &[Row]) -> Table {
    let mut table = empty(&HEADER);
    for row in rows {
        let shown = |time: Option<f64>| time.map_or(String::new(), |time| format!("{time:.1}"));
        let [min, median] = [0, 1].map(|i| shown(row.time().map(|time| time[i])));
        let times =
            |engine| times_over(rows, engine, row).map_or(String::new(), |times| format!("{times:.2}"));
        table.add_row([
            row.mesh.clone(),
            row.engine.to_string(),
            min,
            median,
            shown(row.spread(|time| time.wall).map(|time| time[1])),
            times(REFERENCE),
            times(MESHOPT),
            row.threads.to_string(),
            row.rounds.len().to_string(),
            row.extra_bytes.map_or("n/a".into(), |bytes| format!("{bytes:.0}")),
            row.answer.clone(),
        ]);
    }
    for column in 2..10 {
        align_right(&mut table, column);
    }
    table
}

/// A line per engine, a column per mesh: instructions per triangle.
pub fn instructions(rows: &[Counts]) -> Table {
    let header: Vec<&str> = std::iter::once("instructions/triangle").chain(MESHES).collect();
    let mut table = empty(&header);
    for row in rows {
        let cells = row.of_mesh.iter().map(|count| count.map_or("n/a".into(), |count| format!("{count:.0}")));
        table.add_row(std::iter::once(row.engine.to_string()).chain(cells));
    }
    for column in 1..header.len() {
        align_right(&mut table, column);
    }
    table
}

pub fn empty(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN).set_header(header.to_vec());
    table
}

pub fn align_right(table: &mut Table, column: usize) {
    if let Some(column) = table.column_mut(column) {
        column.set_cell_alignment(CellAlignment::Right);
    }
}

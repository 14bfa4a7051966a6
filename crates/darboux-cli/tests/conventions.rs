//! The table of presets in docs/conventions.md agrees with the code.

mod common;

use common::asset;
use darboux::{
    Axis, BitangentDirection, Convention, Handedness, SignRule, TangentDirection, UvOrigin, Winding,
};

fn axis(axis: Axis) -> &'static str {
    match axis {
        Axis::X => "x",
        Axis::MinusX => "-x",
        Axis::Y => "y",
        Axis::MinusY => "-y",
        Axis::Z => "z",
        Axis::MinusZ => "-z",
    }
}

/// A preset's row of the table.
fn row(name: &str, convention: Convention) -> String {
    let Convention { axes, winding, uv_origin, tangent, bitangent, sign } = convention;
    let axes_text = [axes.right(), axes.up(), axes.front()].map(axis).join(", ");
    let [_, _, _, w] = convention.generated().to(convention).tangent([1.0, 0.0, 0.0, 1.0]);
    let name = format!("`{name}`");
    let cells = [
        name.as_str(),
        axes_text.as_str(),
        if axes.handedness() == Handedness::Right { "right-handed" } else { "left-handed" },
        if winding == Winding::CounterClockwise { "counter-clockwise" } else { "clockwise" },
        if uv_origin == UvOrigin::TopLeft { "top" } else { "bottom" },
        if tangent == TangentDirection::Right { "right" } else { "left" },
        if bitangent == BitangentDirection::Up { "up" } else { "down" },
        if sign == SignRule::NormalCrossTangent { "w cross(n, t)" } else { "w cross(t, n)" },
        if w > 0.0 { "as it is" } else { "negated" },
    ];
    format!("| {} |", cells.join(" | "))
}

#[test]
fn the_table_of_conventions_is_that_of_the_presets() {
    let document = std::fs::read_to_string(asset("../docs/conventions.md")).expect("docs/conventions.md");
    let rows: Vec<String> = Convention::PRESETS.into_iter().map(|(name, preset)| row(name, preset)).collect();
    let start = document.find("| name | right, up, front |").expect("a table");
    let table: Vec<&str> =
        document[start..].lines().skip(2).take_while(|line| line.starts_with('|')).collect();
    assert_eq!(table, rows, "the table should be\n{}", rows.join("\n"));
    for (name, _) in Convention::PRESETS {
        assert!(document.contains(&format!("- **{name}**: ")), "{name} has no source");
    }
}

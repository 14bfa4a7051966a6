//! The frame in shaders: columns of a matrix, and transforms.

use super::drawing::{Figure, Side};
use super::plane::{Vec2, View, direction, vec2};

/// The columns T, B, n times a texel.
pub fn matrix_columns() -> Figure {
    let mut figure = Figure::new(
        720,
        240,
        "The columns of the matrix are T, B and n",
        "A matrix with the columns tangent, bitangent and normal is multiplied with a texel. The result is red times T plus green times B \
         plus blue times n.",
    );
    let (top, height) = (50.0, 110.0);
    for (column, (name, class)) in
        [("T", "tangent"), ("B", "bitangent"), ("n", "normal")].into_iter().enumerate()
    {
        let left = 80.0 + 60.0 * column as f64;
        figure.cell(vec2(left, top), vec2(44.0, height), "face line");
        for (row, axis) in ["x", "y", "z"].into_iter().enumerate() {
            figure.symbol(vec2(left + 19.0, top + 22.0 + 33.0 * row as f64), name, axis, class);
        }
    }
    bracket(&mut figure, 66.0, top - 8.0, height + 16.0, 1.0);
    bracket(&mut figure, 258.0, top - 8.0, height + 16.0, -1.0);
    for (row, name) in ["red", "green", "blue"].into_iter().enumerate() {
        figure.label(vec2(310.0, top + 22.0 + 33.0 * row as f64), name, "small", Side::Centre);
    }
    bracket(&mut figure, 276.0, top - 8.0, height + 16.0, 1.0);
    bracket(&mut figure, 344.0, top - 8.0, height + 16.0, -1.0);
    figure.label(vec2(366.0, top + 55.0), "=", "", Side::Centre);
    let mut left = 390.0;
    for (words, class) in [
        ("red", ""),
        ("T", "symbol tangent"),
        ("+ green", ""),
        ("B", "symbol bitangent"),
        ("+ blue", ""),
        ("n", "symbol normal"),
    ] {
        figure.label(vec2(left, top + 55.0), words, class, Side::Right);
        left += 9.0 * words.len() as f64 + 14.0;
    }
    figure.label(vec2(360.0, 205.0), "Test: the texel (0, 0, 1) must give n.", "quiet", Side::Centre);
    figure
}

fn bracket(figure: &mut Figure, x: f64, top: f64, height: f64, inwards: f64) {
    let points = [(8.0 * inwards, 0.0), (0.0, 0.0), (0.0, height), (8.0 * inwards, height)];
    figure.curve(&points.map(|(right, down)| vec2(x + right, top + down)), "ink");
}

/// A circle that is scaled to an ellipse: tangents go with the matrix, normals with its inverse transpose.
pub fn non_uniform_scale() -> Figure {
    let mut figure = Figure::new(
        720,
        290,
        "Non-uniform scale",
        "A circle with a tangent and a normal is scaled to twice its width. The tangent, transformed by the matrix, still touches the \
         ellipse. The normal, transformed by the same matrix, leans; by the inverse transpose it stays perpendicular.",
    );
    let degrees = 52.0;
    let (base, normal) = (direction(degrees), direction(degrees));
    let tangent = -normal.turned();
    let scale = |point: Vec2| vec2(2.0 * point.x, point.y);
    let inverse_transpose = |way: Vec2| vec2(way.x / 2.0, way.y);
    let ring: Vec<Vec2> = (0..=90).map(|step| direction(f64::from(step) * 4.0)).collect();
    let [before, after] = [View::new(100.0, 185.0, 72.0), View::new(390.0, 185.0, 72.0)];
    figure.curve(&ring.iter().map(|point| before.at(*point)).collect::<Vec<_>>(), "ink");
    figure.curve(&ring.iter().map(|point| after.at(scale(*point))).collect::<Vec<_>>(), "ink");
    figure.arrow(before.at(base), before.at(base + tangent * 0.75), "tangent");
    figure.arrow(before.at(base), before.at(base + normal * 0.75), "normal");
    let start = scale(base);
    let right = inverse_transpose(normal).unit();
    let wrong = scale(normal).unit();
    let moved = scale(tangent).unit();
    figure.arrow(after.at(start), after.at(start + moved * 0.85), "tangent");
    figure.arrow(after.at(start), after.at(start + right * 0.85), "normal");
    figure.arrow(after.at(start), after.at(start + wrong * 0.85), "normal dashed");
    figure.label(before.at(base + normal * 0.9), "n", "symbol normal", Side::Centre);
    figure.label(before.at(base + tangent * 0.9), "T", "symbol tangent", Side::Centre);
    figure.label(after.at(start + moved * 0.85) + vec2(8.0, 8.0), "M T", "symbol tangent", Side::Right);
    figure.label(
        after.at(start + right * 0.92) + vec2(-20.0, -12.0),
        "inverse transpose of M, times n",
        "small normal",
        Side::Right,
    );
    figure.label(
        after.at(start + wrong * 0.85) + vec2(8.0, -2.0),
        "M n: not perpendicular",
        "small",
        Side::Right,
    );
    figure.label(vec2(226.0, 205.0), "M →", "symbol", Side::Left);
    figure
}

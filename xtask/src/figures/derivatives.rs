//! From UVs to the surface: dP/du, dP/dv and the determinant.

use super::drawing::{Figure, Side};
use super::plane::{Vec2, View, derivatives, vec2};

/// A triangle in the UV square, the same triangle on the surface, and the two derivatives.
pub fn uv_to_surface() -> Figure {
    let mut figure = Figure::new(
        720,
        340,
        "The UV map of one triangle",
        "Left, a triangle in the UV square. Right, the same triangle on the surface, with the lines of the UV square drawn onto it. The \
         arrow P with index u runs along a line of constant v, the arrow P with index v along a line of constant u. Neither has unit \
         length, and they are not perpendicular.",
    );
    let uvs = [vec2(0.2, 0.15), vec2(0.9, 0.4), vec2(0.35, 0.85)];
    let positions = [vec2(0.5, 0.35), vec2(2.35, 0.5), vec2(1.35, 1.85)];
    let [along_u, along_v] = derivatives(positions, uvs);
    let on_surface = |uv: Vec2| positions[0] + along_u * (uv.x - uvs[0].x) + along_v * (uv.y - uvs[0].y);
    let [map, surface] = [View::new(60.0, 270.0, 220.0), View::new(365.0, 268.0, 104.0)];
    for step in 0..=4 {
        let share = f64::from(step) / 4.0;
        for (start, end) in [(vec2(share, 0.0), vec2(share, 1.0)), (vec2(0.0, share), vec2(1.0, share))] {
            figure.line(map.at(start), map.at(end), "guide");
            figure.line(surface.at(on_surface(start)), surface.at(on_surface(end)), "guide");
        }
    }
    figure.polygon(&uvs.map(|uv| map.at(uv)), "face line");
    figure.polygon(&positions.map(|position| surface.at(position)), "face line");
    edges(&mut figure, map, uvs, "uv", ["(du1, dv1)", "(du2, dv2)"]);
    edges(&mut figure, surface, positions, "p", ["e1", "e2"]);
    let start = on_surface(uvs[0]);
    for (derivative, name, class) in [(along_u, "u", "tangent"), (along_v, "v", "bitangent")] {
        let end = start + derivative * 0.42;
        figure.arrow(surface.at(start), surface.at(end), class);
        let beside = if name == "u" { vec2(0.02, -0.14) } else { vec2(-0.2, 0.06) };
        figure.symbol(surface.at(end + beside), "P", name, class);
    }
    figure.arrow(map.at(vec2(0.0, 0.0)), map.at(vec2(0.3, 0.0)), "tangent");
    figure.arrow(map.at(vec2(0.0, 0.0)), map.at(vec2(0.0, 0.3)), "bitangent");
    figure.label(map.at(vec2(0.3, -0.09)), "u", "symbol tangent", Side::Centre);
    figure.label(map.at(vec2(-0.09, 0.3)), "v", "symbol bitangent", Side::Centre);
    figure.label(vec2(170.0, 318.0), "UV square", "quiet small", Side::Centre);
    figure.label(vec2(520.0, 318.0), "surface", "quiet small", Side::Centre);
    figure
}

/// The two edges of a triangle from corner 0 as arrows, with their names outside, and the names of its corners.
fn edges(figure: &mut Figure, view: View, corners: [Vec2; 3], corner: &str, names: [&str; 2]) {
    let middle = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
    for (number, at) in corners.into_iter().enumerate() {
        figure.point(view.at(at));
        let outwards = (at - middle).unit() * (19.0 / view.scale);
        figure.label(view.at(at + outwards), &format!("{corner}{number}"), "small", Side::Centre);
    }
    for (end, name, side) in [(corners[1], names[0], Side::Right), (corners[2], names[1], Side::Left)] {
        figure.arrow(view.at(corners[0]), view.at(end), "dark");
        let at = corners[0].towards(end, 0.76);
        let across = (end - corners[0]).unit().turned();
        let outwards = if across.dot(middle - at) > 0.0 { -across } else { across };
        figure.label(view.at(at + outwards * (16.0 / view.scale)), name, "small", side);
    }
}

/// Three triangles in UV space: positive, negative and no area.
pub fn determinant() -> Figure {
    let mut figure = Figure::new(
        720,
        250,
        "The determinant is twice the signed UV area",
        "Three triangles in UV space. The corners of the first run counter-clockwise: its determinant is 0.36 and w is +1. The second is \
         mirrored: minus 0.36 and w is -1. The corners of the third lie on a line: 0, and there is no tangent.",
    );
    let cases = [
        ([vec2(0.15, 0.15), vec2(0.85, 0.2), vec2(0.35, 0.68)], "face line", "w = +1"),
        ([vec2(0.85, 0.15), vec2(0.15, 0.2), vec2(0.65, 0.68)], "mirrored line", "mirrored: w = −1"),
        (
            [vec2(0.12, 0.2), vec2(0.85, 0.62), vec2(0.5, 0.418_630_136_986_301_4)],
            "face line",
            "no area: no tangent",
        ),
    ];
    for (column, (uvs, class, meaning)) in cases.into_iter().enumerate() {
        let view = View::new(40.0 + 230.0 * column as f64, 190.0, 180.0);
        figure.polygon(&uvs.map(|uv| view.at(uv)), class);
        for (number, uv) in uvs.into_iter().enumerate() {
            figure.point(view.at(uv));
            let middle = (uvs[0] + uvs[1] + uvs[2]) * (1.0 / 3.0);
            let away = if column == 2 { vec2(-0.03, 0.1) } else { (uv - middle).unit() * 0.1 };
            figure.label(view.at(uv + away), &number.to_string(), "small", Side::Centre);
        }
        let determinant = (uvs[1] - uvs[0]).cross(uvs[2] - uvs[0]);
        let number = format!("det = {:.2}", determinant + 0.0).replace('-', "−");
        figure.label(view.at(vec2(0.5, -0.06)), &number, "code small", Side::Centre);
        figure.label(view.at(vec2(0.5, -0.2)), meaning, "", Side::Centre);
    }
    figure
}

//! Small files whose time grew with the square of their size in an earlier version: many triangles over the
//! same texels, and faces of many corners. Each must end within a limit of processor time that a quadratic
//! method passes by far, in 512 MiB and ten times the file of addresses.

#![cfg(target_os = "linux")]

mod common;

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

use common::limited::{ends_beside, ends_in_time};

/// Triangles over each other: a grid of 4 x 4 squares, 2,000 times.
fn copies() -> String {
    let mut obj = String::new();
    for y in 0..5 {
        for x in 0..5 {
            let height = 0.3 * f64::from(x + y).sin();
            writeln!(obj, "v {x} {height} {y}\nvt {} {}", f64::from(x) / 4.0, f64::from(y) / 4.0)
                .expect("text");
        }
    }
    obj += "vn 0 1 0\n";
    let mut faces = String::new();
    for first in (0..4).flat_map(|y| (1..5).map(move |x| 5 * y + x)) {
        let [a, b, c, d] = [first, first + 5, first + 6, first + 1].map(|i| format!("{i}/{i}/1"));
        writeln!(faces, "f {a} {b} {c} {d}").expect("text");
    }
    obj + &faces.repeat(2000)
}

#[test]
fn triangles_over_each_other_are_verified() {
    ends_in_time("m.obj", copies().as_bytes(), &["bake IN --high IN -o o.png --size 16 --verify"]);
}

/// A square to bake onto.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";

fn face(corners: impl Iterator<Item = String>) -> String {
    format!("f {}\n", corners.collect::<Vec<_>>().join(" "))
}

/// [`SQUARE`] and, as an object without UVs, a polygon.
fn beside_square(polygon: &[[f64; 2]]) -> String {
    let places: String = polygon.iter().map(|[x, y]| format!("v {x} {y} 0\n")).collect();
    let corners = (5..polygon.len() + 5).map(|i| i.to_string());
    SQUARE.to_owned() + &places + "o polygon\n" + &face(corners)
}

/// A polygon whose corners have these distances from its middle, in turn.
fn polygon(count: usize, distances: [f64; 2]) -> String {
    let place = |i: usize| {
        let (angle, distance) = (TAU * i as f64 / count as f64, distances[i % 2]);
        [distance * angle.cos(), distance * angle.sin()]
    };
    beside_square(&(0..count).map(place).collect::<Vec<_>>())
}

/// A half circle of reflex corners before two that are far from it.
fn arch(count: usize) -> String {
    let place = |i: usize| {
        let angle = PI * i as f64 / (count - 2) as f64;
        [3.0 * angle.sin(), angle.cos()]
    };
    let far = [[10.0, -1.0], [10.0, 1.0]];
    beside_square(&far.into_iter().chain((0..count - 2).map(place)).collect::<Vec<_>>())
}

#[test]
fn faces_of_many_corners_are_cut() {
    let lines = ["bake IN --high IN -o o.png --size 8x3"];
    ends_in_time("m.obj", polygon(24_000, [1.0, 1.0]).as_bytes(), &lines);
    ends_in_time("m.obj", polygon(24_000, [1.0, 0.3]).as_bytes(), &lines);
    for file in [polygon(50_000, [1.0, 1.0]), polygon(50_000, [1.0, 0.3]), arch(24_000)] {
        let said = ends_in_time("m.obj", file.as_bytes(), &["inspect IN"]);
        assert!(!said.contains("is too large to cut"), "{said}");
    }
    let repeated = ["1/1/1", "2/2/1", "3/3/1"].into_iter().cycle().map(str::to_owned);
    ends_in_time("m.obj", (SQUARE.to_owned() + &face(repeated.take(300_000))).as_bytes(), &lines);
}

/// Statements whose name of a texture may begin at each of many words.
#[test]
fn long_statements_of_textures_are_not_tried_without_end() {
    let mut library = String::new();
    for material in 0..800 {
        writeln!(library, "newmtl {material}\nmap_Kd {material} {}", "a ".repeat(2000)).expect("text");
    }
    let obj = format!("mtllib m.mtl\n{}usemtl 0\nf 1 2 3\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    let others = [("m.mtl", library.as_bytes())];
    ends_beside("m.obj", obj.as_bytes(), &others, &["inspect IN --quiet"]);
}

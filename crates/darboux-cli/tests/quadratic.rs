//! Small files whose time grew with the square of their size in an earlier version: many triangles over the
//! same texels, and faces of many corners. Each must end within a limit of processor time that a quadratic
//! method passes by far, in 512 MiB and ten times the file of addresses.

#![cfg(target_os = "linux")]

mod common;

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::process::Command;

use common::text;

/// Seconds of the processor. Today's release build takes 0.1 to 1.8, tests are built without optimisation,
/// and quadratic methods took minutes.
const SECONDS: usize = 40;

/// Runs the command on a file `m.obj` of its own. It must end within the limits, by itself, with code 0 or
/// one sentence.
#[track_caller]
fn ends_in_time(model: &str, line: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("m.obj");
    fs::write(&path, model).expect("a file");
    let addresses = (512 << 10) + 10 * model.len() / 1024;
    let limits = format!("ulimit -t {SECONDS} && ulimit -v {addresses} && exec \"$0\" \"$@\"");
    let output = Command::new("sh")
        .env("MALLOC_ARENA_MAX", "1")
        .args(["-c", &limits, env!("CARGO_BIN_EXE_darboux")])
        .args(line.split(' ').map(|word| if word == "m.obj" { text(&path) } else { word }))
        .current_dir(folder.path())
        .output()
        .expect("a shell");
    let stderr = String::from_utf8_lossy(&output.stderr);
    let errors = stderr.lines().filter(|line| line.starts_with("error: ")).count();
    match output.status.code() {
        Some(0) => assert_eq!(errors, 0, "{stderr}"),
        Some(1) => assert_eq!(errors, 1, "{stderr}"),
        other => panic!("{line}: {other:?} ({}): {stderr}", output.status),
    }
}

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
    ends_in_time(&copies(), "bake m.obj --high m.obj -o o.png --size 16 --verify");
}

/// A square to bake onto.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";

fn face(corners: impl Iterator<Item = String>) -> String {
    format!("f {}\n", corners.collect::<Vec<_>>().join(" "))
}

/// [`SQUARE`] and a polygon whose corners have these distances from its middle, in turn.
fn polygon(count: usize, distances: [f64; 2]) -> String {
    let place = |i: usize| {
        let (angle, distance) = (TAU * i as f64 / count as f64, distances[i % 2]);
        format!("v {} {} 0\n", distance * angle.cos(), distance * angle.sin())
    };
    let corners = (5..count + 5).map(|i| i.to_string());
    SQUARE.to_owned() + &(0..count).map(place).collect::<String>() + &face(corners)
}

#[test]
fn faces_of_many_corners_are_cut() {
    let line = "bake m.obj --high m.obj -o o.png --size 8x3";
    ends_in_time(&polygon(24_000, [1.0, 1.0]), line);
    ends_in_time(&polygon(24_000, [1.0, 0.3]), line);
    let repeated = ["1/1/1", "2/2/1", "3/3/1"].into_iter().cycle().map(str::to_owned);
    ends_in_time(&(SQUARE.to_owned() + &face(repeated.take(300_000))), line);
}

//! Reads cases and writes results, for adapters in Rust; needs cpu-time and serde_json. Copy it. Licence:
//! CC0.

use std::path::Path;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;
use std::{env, fs, thread};

use cpu_time::ThreadTime;
use serde_json::Value;

/// The repetitions of large cases, of which the fastest counts, in processor time.
const REPETITIONS: usize = 5;

/// A case.
#[derive(Clone)]
pub struct Case {
    pub name: String,
    pub class: String,
    pub threshold: f32,
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub uvs: Vec<[f32; 2]>,
    /// The number of corners of each face.
    pub faces: Vec<usize>,
    /// The first corner of each face.
    pub first_corners: Vec<usize>,
    /// The vertex of each corner.
    pub indices: Vec<u32>,
}

#[allow(dead_code)]
impl Case {
    pub fn vertex(&self, face: usize, corner: usize) -> usize {
        self.indices[self.first_corners[face] + corner] as usize
    }

    pub fn is_triangles(&self) -> bool {
        self.faces.iter().all(|&size| size == 3)
    }

    /// The default tangent for every corner.
    pub fn defaults(&self) -> Vec<[f32; 4]> {
        vec![[1.0, 0.0, 0.0, -1.0]; self.indices.len()]
    }

    fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).expect("a case can be read");
        let case: Value = serde_json::from_str(&text).expect("a case is JSON");
        let bits = &case["bits"];
        let integers = |key: &str| -> Vec<u32> {
            list(&case[key]).iter().map(|x| x.as_u64().expect("an integer") as u32).collect()
        };
        let faces: Vec<usize> = integers("faces").into_iter().map(|size| size as usize).collect();
        let first_corners =
            faces.iter().scan(0, |next, size| Some(std::mem::replace(next, *next + size))).collect();
        Self {
            name: case["name"].as_str().expect("a name").into(),
            class: case["class"].as_str().expect("a class").into(),
            threshold: float(&bits["threshold"]),
            positions: rows(&bits["positions"]),
            normals: rows(&bits["normals"]),
            uvs: rows(&bits["uvs"]),
            faces,
            first_corners,
            indices: integers("indices"),
        }
    }
}

fn list(value: &Value) -> &Vec<Value> {
    value.as_array().expect("a list")
}

fn float(word: &Value) -> f32 {
    f32::from_bits(u32::from_str_radix(word.as_str().expect("a word"), 16).expect("hexadecimal"))
}

fn rows<const N: usize>(value: &Value) -> Vec<[f32; N]> {
    let row = |row: &Value| std::array::from_fn(|i| float(&list(row)[i]));
    list(value).iter().map(row).collect()
}

/// What an adapter gives: tangents per corner, or tangents per vertex with the vertex of each corner.
pub enum Found {
    PerCorner(Vec<[f32; 4]>),
    #[allow(dead_code)]
    PerVertex(Vec<[f32; 4]>, Vec<u32>),
}

/// The seconds after which a case counts as one that does not end.
const LIMIT: u64 = 60;

/// Runs `compute` on a case; where it panics or does not end, all tangents are NaN. The thread of an endless
/// computation is abandoned.
fn guarded(compute: Compute, case: &Case) -> Result<(Found, f64), String> {
    let (sender, receiver) = mpsc::channel();
    let own = case.clone();
    thread::Builder::new()
        .stack_size(1 << 28)
        .spawn(move || {
            let start = ThreadTime::now();
            let found = compute(&own);
            let _ = sender.send((found, start.elapsed().as_secs_f64()));
        })
        .expect("a thread starts");
    match receiver.recv_timeout(Duration::from_secs(LIMIT)) {
        Ok((found, seconds)) => Ok((found?, seconds)),
        Err(error) => {
            eprintln!(
                "{}: {}",
                case.name,
                if error == RecvTimeoutError::Timeout { "no end" } else { "panic" }
            );
            Ok((Found::PerCorner(vec![[f32::NAN; 4]; case.indices.len()]), f64::INFINITY))
        }
    }
}

type Compute = fn(&Case) -> Result<Found, String>;

/// Runs an adapter whose last two arguments are the folders of cases and results. An error is the reason for
/// skipping a case.
pub fn run(compute: Compute) {
    let words: Vec<String> = env::args().collect();
    let [.., cases, results] = words.as_slice() else { panic!("usage: ADAPTER CASES RESULTS") };
    fs::create_dir_all(results).expect("a folder for the results");
    for entry in fs::read_dir(cases).expect("a folder of cases") {
        let path = entry.expect("a case").path();
        let case = Case::read(&path);
        let mut found = guarded(compute, &case);
        for _ in 1..if case.class == "large" { REPETITIONS } else { 1 } {
            if let (Ok((_, least)), Ok((_, seconds))) = (&mut found, guarded(compute, &case)) {
                *least = least.min(seconds);
            }
        }
        let text = match found {
            Err(why) => format!("{{\"skipped\": {why:?}}}\n"),
            Ok((Found::PerCorner(tangents), seconds)) => {
                format!("{{\"seconds\": {}, \"tangents\": {}}}\n", time(seconds), json(&tangents))
            }
            Ok((Found::PerVertex(tangents, indices), seconds)) => {
                format!(
                    "{{\"seconds\": {}, \"indices\": {indices:?}, \"tangents\": {}}}\n",
                    time(seconds),
                    json(&tangents)
                )
            }
        };
        fs::write(Path::new(results).join(path.file_name().expect("a file name")), text)
            .expect("a result is written");
    }
}

/// Seconds as JSON.
fn time(seconds: f64) -> String {
    if seconds.is_finite() { format!("{seconds:?}") } else { "null".into() }
}

fn json(rows: &[[f32; 4]]) -> String {
    let number = |x: &f32| if x.is_finite() { format!("{x:?}") } else { format!("\"{x}\"").to_lowercase() };
    let row = |row: &[f32; 4]| format!("[{}]", row.iter().map(number).collect::<Vec<_>>().join(", "));
    format!("[{}]", rows.iter().map(row).collect::<Vec<_>>().join(",\n"))
}

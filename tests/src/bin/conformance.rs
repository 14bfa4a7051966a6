//! Computes the cases of the conformance suite: `conformance CASES RESULTS [reference|repaired|corrected]`.
//!
//! Without a third argument the results are mikktspace.c's, with all nine values per corner and what the
//! modes of Darboux give that repair its defects: the input of `conformance/regenerate.py`. With a mode they
//! are Darboux's, timed, for the judge.

use std::path::Path;
use std::time::Instant;
use std::{env, fs};

use darboux::{Frame, MikkTSpaceOptions, Mode, generate_frames, generate_tangents};
use darboux_tests::corpus::{CorpusCase, read_folder, result_text, rows_text};
use darboux_tests::engine;

/// The repetitions of large cases, of which the fastest counts.
const REPETITIONS: usize = 5;

fn main() {
    let words: Vec<String> = env::args().skip(1).collect();
    let (folder, results, mode) = match words.as_slice() {
        [folder, results] => (folder, results, None),
        [folder, results, mode] => (folder, results, Some(mode.as_str())),
        _ => panic!("usage: conformance CASES RESULTS [reference|repaired|corrected]"),
    };
    fs::create_dir_all(results).expect("a folder for the results");
    for corpus_case in read_folder(Path::new(folder)) {
        let text = match mode {
            None => reference(&corpus_case),
            Some("reference") => darboux(&corpus_case, Mode::Reference),
            Some("repaired") => darboux(&corpus_case, Mode::Repaired),
            Some("corrected") => darboux(&corpus_case, Mode::Corrected),
            Some(other) => panic!("{other} is not a mode"),
        };
        let path = Path::new(results).join(&corpus_case.name).with_extension("json");
        fs::write(path, text).expect("a result is written");
    }
}

fn reference(CorpusCase { mesh, threshold, .. }: &CorpusCase) -> String {
    let unwritten =
        Frame { tangent: [1.0, 0.0, 0.0], bitangent: [0.0, 1.0, 0.0], magnitude: [1.0; 2], sign: -1.0 };
    let start = Instant::now();
    let frames = engine::reference(mesh, *threshold);
    let seconds = start.elapsed().as_secs_f64();
    let frames: Vec<Frame> = frames.into_iter().map(|frame| frame.unwrap_or(unwritten)).collect();
    let [repaired, corrected] = [Mode::Repaired, Mode::Corrected].map(|mode| {
        let options = MikkTSpaceOptions::new().with_mode(mode).with_threshold(*threshold);
        generate_frames(&mesh.view(), &options.into()).corners.into_per_corner()
    });
    let tangents = |frames: &[Frame]| rows_text(frames.iter().map(Frame::tangent_and_sign));
    format!(
        "{{\"seconds\": {seconds:?},\n\"tangents\": {},\n\"bitangents\": {},\n\"magnitudes\": \
         {},\n\"repaired\": {},\n\"corrected\": {}}}\n",
        tangents(&frames),
        rows_text(frames.iter().map(|frame| frame.bitangent)),
        rows_text(frames.iter().map(|frame| frame.magnitude)),
        tangents(&repaired),
        tangents(&corrected),
    )
}

fn darboux(CorpusCase { class, mesh, threshold, .. }: &CorpusCase, mode: Mode) -> String {
    let options = MikkTSpaceOptions::new().with_mode(mode).with_threshold(*threshold).into();
    let run = || {
        let start = Instant::now();
        let tangents = generate_tangents(&mesh.view(), &options).corners.into_per_corner();
        (start.elapsed().as_secs_f64(), tangents)
    };
    let (mut seconds, tangents) = run();
    for _ in 1..if class == "large" { REPETITIONS } else { 1 } {
        seconds = seconds.min(run().0);
    }
    result_text(seconds, &tangents)
}

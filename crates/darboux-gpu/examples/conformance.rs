//! Computes the cases of the conformance suite on the adapter that wgpu prefers: `conformance CASES RESULTS
//! reference|repaired|corrected`.

use std::time::Instant;
use std::{env, fs, path::Path};

use darboux::{MikkTSpaceOptions, Mode};
use darboux_gpu::{Gpu, GpuError, MikkTSpace};
use darboux_tests::corpus::{read_folder, result_text};

fn main() -> Result<(), GpuError> {
    let words: Vec<String> = env::args().skip(1).collect();
    let [folder, results, mode] = words.as_slice() else {
        panic!("usage: conformance CASES RESULTS reference|repaired|corrected")
    };
    let mode = match mode.as_str() {
        "reference" => Mode::Reference,
        "repaired" => Mode::Repaired,
        "corrected" => Mode::Corrected,
        other => panic!("{other} is not a mode"),
    };
    fs::create_dir_all(results).expect("a folder for the results");
    let gpu = pollster::block_on(Gpu::open())?;
    let kernels = MikkTSpace::new(&gpu)?;
    for case in read_folder(Path::new(folder)) {
        let options = MikkTSpaceOptions::new().with_mode(mode).with_threshold(case.threshold).into();
        let start = Instant::now();
        let tangents = if case.mesh.corner_count() > 0 {
            kernels.generate_tangents(&case.mesh.view(), &options)?.tangents.corners.into_per_corner()
        } else {
            Vec::new()
        };
        let text = result_text(start.elapsed().as_secs_f64(), &tangents);
        let path = Path::new(results).join(&case.name).with_extension("json");
        fs::write(path, text).expect("a result is written");
    }
    println!("{}", gpu.name);
    Ok(())
}

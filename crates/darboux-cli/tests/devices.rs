//! `darboux devices` and `darboux tangents --device`.

mod common;

use common::{asset, darboux, darboux_with, darboux_without_adapters, folder_with, has_adapter, text};

const MODELS: [&str; 4] = [
    "NormalTangentTest/NormalTangentTest.glb",
    "made/draco.glb",
    "made/meshopt.glb",
    "made/quantised-sparse.glb",
];

#[test]
fn a_gpu_writes_the_files_of_the_cpu() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for model in MODELS {
        let outputs = ["cpu", "gpu"].map(|device| folder.path().join(device).with_extension("glb"));
        let input = asset(model);
        let run = |device: &str, output: &std::path::Path| {
            let (input, output) = (text(&input), text(output));
            let all =
                ["tangents", input, "-o", output, "--force", "--overwrite", "--json", "--device", device];
            darboux(&all).exits(0).json()["files"][0]["device"].clone()
        };
        let [of_cpu, of_gpu] = [run("cpu", &outputs[0]), run("gpu", &outputs[1])];
        let [cpu, gpu] = outputs.map(|output| std::fs::read(output).expect("an output"));
        assert!(cpu == gpu, "{model}");
        assert_eq!((of_cpu["kind"].as_str(), of_gpu["kind"].as_str()), (Some("cpu"), Some("gpu")), "{model}");
        assert!(of_cpu["adapter"].is_null() && of_gpu["adapter"].is_string(), "{model}");
        assert_eq!(of_cpu["cpu_corners"], of_cpu["corners"], "{model}");
        assert_eq!(of_gpu["corners"], of_cpu["corners"], "{model}");
        // A plan on the CPU moves morph targets.
        let all_on_cpu = of_gpu["cpu_corners"] == of_gpu["corners"];
        assert_eq!(all_on_cpu, model == "made/meshopt.glb", "{model}: {of_gpu}");
    }
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "drivers are found by environment variables on Linux only")]
fn without_an_adapter_only_device_gpu_fails() {
    let folder = tempfile::tempdir().expect("a folder");
    let input = asset(MODELS[0]);
    let run = |device: &str| {
        let output = folder.path().join(device).with_extension("glb");
        let (input, output) = (text(&input), text(&output));
        darboux_without_adapters(&[
            "tangents",
            input,
            "-o",
            output,
            "--overwrite",
            "--json",
            "--device",
            device,
        ])
    };
    let failed = run("gpu").exits(1);
    assert!(failed.stderr.contains("no GPU adapter was found"), "{}", failed.stderr);
    assert!(failed.json()["files"][0]["device"].is_null());
    assert!(!folder.path().join("gpu.glb").exists());
    let done = run("auto").exits(0).json();
    assert_eq!(done["files"][0]["device"]["kind"], "cpu");
    let listed = darboux_without_adapters(&["devices"]).exits(0);
    assert!(String::from_utf8_lossy(&listed.stdout).starts_with("no GPU adapter was found"));
}

/// Runs `darboux tangents --json` where auto takes the GPU from so many triangles on.
fn auto_from(triangles: &str, drivers: Option<&str>) -> common::Run {
    let folder = tempfile::tempdir().expect("a folder");
    let (input, output) = (asset(MODELS[0]), folder.path().join("out.glb"));
    let mut variables = vec![("DARBOUX_GPU_TRIANGLES", triangles)];
    for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        variables.extend(drivers.map(|drivers| (name, drivers)));
    }
    darboux_with(&variables, &["tangents", text(&input), "-o", text(&output), "--overwrite", "--json"])
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "drivers are found by environment variables on Linux only")]
fn auto_takes_the_cpu_where_there_is_no_gpu_and_says_so() {
    let run = auto_from("1", Some("/nowhere")).exits(0);
    let file = &run.json()["files"][0];
    assert_eq!(file["device"]["kind"], "cpu");
    let warning = file["warnings"].to_string();
    let expected = "the CPU computed the tangents because the GPU failed: no GPU adapter was found";
    assert!(warning.contains(expected), "{warning}");
    assert!(run.stderr.contains(expected), "{}", run.stderr);
}

#[test]
fn auto_takes_the_gpu_from_the_triangles_that_were_measured() {
    if !has_adapter() {
        return;
    }
    let kind = |triangles| auto_from(triangles, None).exits(0).json()["files"][0]["device"]["kind"].clone();
    assert_eq!([kind("1"), kind("100000000")], ["gpu", "cpu"]);
    let refused = auto_from("many", None).exits(1);
    assert!(
        refused.stderr.contains("DARBOUX_GPU_TRIANGLES is many: set it to a number"),
        "{}",
        refused.stderr
    );
}

#[test]
fn other_methods_are_not_for_a_gpu() {
    let input = asset(MODELS[0]);
    let all = ["tangents", text(&input), "--method", "area", "--device", "gpu"];
    let refused = darboux(&all).exits(2);
    assert!(refused.stderr.contains("--device gpu needs --method mikktspace"), "{}", refused.stderr);
}

#[test]
fn software_is_told_once_and_nothing_else_is() {
    if !has_adapter() {
        return;
    }
    let listed = darboux(&["devices", "--json"]).exits(0).json();
    let is_software = |adapter: &serde_json::Value| adapter["kind"] == "software";
    let all = listed["adapters"].as_array().expect("a list").iter().all(is_software);
    let (folder, out) = (folder_with(&[MODELS[0], MODELS[3]]), tempfile::tempdir().expect("a folder"));
    let words = ["tangents", text(folder.path()), "--out-dir", text(out.path()), "--device", "gpu"];
    let told = darboux(&words).exits(0).stderr;
    assert_eq!(
        told.matches("is a software adapter; --device cpu gives the same bits").count(),
        usize::from(all)
    );
}

#[test]
fn messages_of_drivers_are_not_printed() {
    // Mesa prints a line to standard error for this value.
    let run = darboux_with(&[("XDG_RUNTIME_DIR", "")], &["devices"]);
    assert!(!run.stderr.contains("XDG_RUNTIME_DIR"), "{}", run.stderr);
}

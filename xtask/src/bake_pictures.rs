//! `docs/bake/*.png`: what the settings of a bake do, and bakes of simplified models.

use std::path::{Path, PathBuf};

use crate::run::{Outcome, further_models, program, root, run, target_folder};

/// Pictures of the made pair: the file's name, options of the bake, and options of the picture.
const SETTINGS: [(&str, &str, &str); 8] = [
    ("right", "--cage-offset 0.18 --match name --samples 16 --size 512", ""),
    ("offset-small", "--cage-offset 0.03 --match name --samples 16 --size 512", ""),
    ("offset-large", "--cage-offset 1 --samples 16 --size 512", ""),
    ("offset-large-by-name", "--cage-offset 1 --match name --samples 16 --size 512", ""),
    ("distance", "--distance 0.18,0.18 --match name --samples 16 --size 512", ""),
    ("samples-1", "--cage-offset 0.18 --match name --size 192", ""),
    ("samples-16", "--cage-offset 0.18 --match name --size 192 --samples 16", ""),
    ("green", "--cage-offset 0.18 --match name --samples 16 --size 512", "--mistakes green"),
];

/// Models of the folder of further models, and the part of their triangles that the low model keeps.
const MODELS: [(&str, &str, &str); 2] =
    [("bottle", "WaterBottle/WaterBottle.gltf", "0.2"), ("boombox", "BoomBox/BoomBox.gltf", "0.2")];

/// Draws all pictures.
pub fn draw() -> Outcome {
    let folder = target_folder()?.join("bake-pictures");
    run(example("settings").arg(&folder))?;
    let (low, high) = (folder.join("low.glb"), folder.join("high.glb"));
    picture(&high, "original", "--camera 30,25")?;
    let flat = bake(&folder, "without", &low, &low, "--cage-offset 0.01 --size 64")?;
    picture(&flat, "without", "--camera 30,25")?;
    for (name, options, of_picture) in SETTINGS {
        let model = bake(&folder, name, &low, &high, options)?;
        picture(&model, name, &format!("--camera 30,25 {of_picture}"))?;
    }
    let Some(models) = further_models() else {
        println!("skipped: the simplified models need a folder in DARBOUX_MODELS");
        return Ok(());
    };
    for (name, file, share) in MODELS {
        let (low, high) = (folder.join(name).with_extension("low.glb"), models.join(file));
        run(example("simplify").arg(&high).arg(share).arg(&low))?;
        let errors = folder.join(name).with_extension("errors.glb");
        let options = format!("--samples 4 --verify --heat-model {}", errors.display());
        let baked = bake(&folder, name, &low, &high, &options)?;
        for (model, what) in [(&high, "original"), (&low, "low"), (&baked, "baked"), (&errors, "errors")] {
            picture(model, &format!("{name}-{what}"), "")?;
        }
    }
    Ok(())
}

fn example(name: &str) -> std::process::Command {
    let mut command = program("cargo run --quiet --release --package darboux-bake --all-features --example");
    command.args([name, "--"]);
    command
}

fn darboux(words: &str) -> std::process::Command {
    let mut command = program("cargo run --quiet --release --package darboux-cli --features full --");
    command.args(words.split_whitespace());
    command
}

/// Bakes a map; returns the model that was written with it.
fn bake(folder: &Path, name: &str, low: &Path, high: &Path, options: &str) -> Result<PathBuf, String> {
    let model = folder.join(name).with_extension("glb");
    let mut command = darboux("bake --force");
    command.arg(low).arg("--high").arg(high).arg("-o").arg(model.with_extension("png"));
    command.args(options.split_whitespace()).arg("--write-model").arg(&model);
    run(&mut command)?;
    Ok(model)
}

fn picture(model: &Path, name: &str, options: &str) -> Outcome {
    let output = root().join("docs/bake").join(name).with_extension("png");
    let mut command = darboux("render --size 240x220 --no-legend --force");
    command.arg(model).arg("-o").arg(output).args(options.split_whitespace());
    run(&mut command)
}

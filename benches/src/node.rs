//! Engines that run in Node.js: one child process per engine and mesh. `node/peers.mjs` defines the protocol.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{ChildStdin, ChildStdout, Command, Stdio};

use darboux_tests::OwnedMesh;
use serde_json::Value;

use crate::run::{Run, Tangent, Time};

/// A running node process that holds one mesh.
pub struct Child {
    process: std::process::Child,
    questions: ChildStdin,
    answers: BufReader<ChildStdout>,
    output: PathBuf,
    corners: usize,
}

impl Child {
    /// Starts an engine on a mesh. `folder` has peers.mjs and the installed packages.
    pub fn start(engine: &str, mesh: &OwnedMesh, folder: &Path) -> Result<Self, String> {
        let input = folder.join("mesh");
        write_mesh(mesh, &input)
            .map_err(|error| format!("{} cannot be written: {error}", input.display()))?;
        let output = input.join(format!("{engine}.f32"));
        let mut process = Command::new("node")
            .arg(folder.join("peers.mjs"))
            .arg(engine)
            .arg(&input)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| format!("node cannot start: {error}"))?;
        let (Some(questions), Some(answers)) = (process.stdin.take(), process.stdout.take()) else {
            return Err("node has no standard input or output".into());
        };
        let mut child = Self {
            process,
            questions,
            answers: BufReader::new(answers),
            output,
            corners: mesh.corner_count(),
        };
        child.answer()?;
        Ok(child)
    }

    fn ask(&mut self, question: &str) -> Result<Value, String> {
        writeln!(self.questions, "{question}").map_err(|error| format!("node has ended: {error}"))?;
        self.answer()
    }

    fn answer(&mut self) -> Result<Value, String> {
        let mut line = String::new();
        self.answers.read_line(&mut line).map_err(|error| format!("node has ended: {error}"))?;
        serde_json::from_str(&line).map_err(|_| "node has ended, see above".into())
    }
}

impl Run for Child {
    fn run(&mut self, count: usize) -> Result<Time, String> {
        let answer = self.ask(&count.to_string())?;
        match (answer["wall"].as_f64(), answer["cpu"].as_f64()) {
            (Some(wall), Some(cpu)) => Ok(Time { wall, cpu }),
            _ => Err(format!("node answers {answer}")),
        }
    }

    fn tangents(&mut self) -> Result<Vec<Tangent>, String> {
        let output = self.output.display().to_string();
        self.ask(&output)?;
        let bytes = fs::read(&self.output).map_err(|error| format!("{output} cannot be read: {error}"))?;
        let floats: Vec<f32> = bytes.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
        Ok(floats.as_chunks().0.to_vec())
    }

    fn output_len(&self) -> usize {
        self.corners
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        // The process may already have ended.
        _ = self.process.kill();
        _ = self.process.wait();
    }
}

fn write_mesh(mesh: &OwnedMesh, folder: &Path) -> std::io::Result<()> {
    let floats = |values: &[f32]| values.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    fs::create_dir_all(folder)?;
    fs::write(folder.join("positions.f32"), floats(mesh.positions.as_flattened()))?;
    fs::write(folder.join("normals.f32"), floats(mesh.normals.as_flattened()))?;
    fs::write(folder.join("uvs.f32"), floats(mesh.uvs.as_flattened()))?;
    let indices = folder.join("indices.u32");
    match &mesh.indices {
        Some(list) => fs::write(indices, list.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>()),
        None if indices.exists() => fs::remove_file(indices),
        None => Ok(()),
    }
}

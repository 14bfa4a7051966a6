//! `darboux view`: who gets what from its server.

mod common;

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use common::darboux;

/// A running viewer, which ends with the test.
struct Viewer {
    child: Child,
    address: String,
}

impl Drop for Viewer {
    fn drop(&mut self) {
        let _gone_already = self.child.kill();
        let _gone_already = self.child.wait();
    }
}

impl Viewer {
    /// Shows a model in a page of one file.
    fn start(folder: &Path, model: &Path) -> Self {
        fs::write(folder.join("index.html"), "the page").expect("a page");
        let mut child = Command::new(env!("CARGO_BIN_EXE_darboux"))
            .args(["view", "--no-open", "--page"])
            .args([folder, model])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the command starts");
        let mut address = String::new();
        BufReader::new(child.stdout.take().expect("a pipe")).read_line(&mut address).expect("an address");
        Self { child, address: address.trim_end().to_owned() }
    }

    /// The host and port, and the path with the secret.
    fn parts(&self) -> (&str, &str) {
        let rest = self.address.strip_prefix("http://").expect("an address");
        let (host, path) = rest.split_once('/').expect("a path");
        (host, path.split('/').next().expect("a secret"))
    }

    /// The status and the body of what is at `path`, asked for as from `host`.
    fn get(&self, host: &str, path: &str) -> (u16, Vec<u8>) {
        let mut stream = TcpStream::connect(self.parts().0).expect("a connection");
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n")
            .expect("a request");
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).expect("an answer");
        let end = answer.windows(4).position(|four| four == b"\r\n\r\n").expect("a head");
        let head = String::from_utf8_lossy(&answer[..end]);
        let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).expect("a status");
        (status, answer[end + 4..].to_vec())
    }
}

fn asset(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets").join(name)
}

#[test]
fn the_page_and_the_model_are_behind_the_secret() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = asset("NormalTangentTest/NormalTangentTest.glb");
    let viewer = Viewer::start(folder.path(), &model);
    let (host, secret) = viewer.parts();
    assert!(host.starts_with("127.0.0.1:") && secret.len() == 32, "{}", viewer.address);
    assert!(viewer.address.ends_with("/?model=NormalTangentTest.glb"), "{}", viewer.address);
    assert_eq!(viewer.get(host, &format!("/{secret}/")), (200, b"the page".to_vec()));
    let (status, body) = viewer.get(host, &format!("/{secret}/model"));
    assert!(status == 200 && body == fs::read(model).expect("a model"), "{status}, {} bytes", body.len());
    for path in ["/", "/index.html", "/model", "/0123456789abcdef0123456789abcdef/", &format!("/{secret}")] {
        assert_eq!(viewer.get(host, path).0, 403, "{path}");
    }
    assert_eq!(viewer.get("evil.example", &format!("/{secret}/")).0, 403);
}

#[test]
fn files_beside_the_page_are_not_served() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("page")).expect("a folder");
    fs::write(folder.path().join("private"), "x").expect("a file");
    let viewer = Viewer::start(&folder.path().join("page"), &asset("made/draco.glb"));
    let (host, secret) = viewer.parts();
    for path in ["../private", "%2e%2e/private", "..%2fprivate", "/../private", "page/../../private"] {
        assert_eq!(viewer.get(host, &format!("/{secret}/{path}")).0, 404, "{path}");
    }
}

#[test]
fn a_gltf_comes_whole_and_a_broken_one_as_a_sentence() {
    let folder = tempfile::tempdir().expect("a folder");
    let viewer = Viewer::start(folder.path(), &asset("TwoSidedPlane/TwoSidedPlane.gltf"));
    let (host, secret) = viewer.parts();
    assert!(viewer.address.ends_with("/?model=TwoSidedPlane.glb"), "{}", viewer.address);
    let (status, body) = viewer.get(host, &format!("/{secret}/model"));
    assert_eq!((status, body.get(..4)), (200, Some(&b"glTF"[..])));

    let broken = folder.path().join("broken.glb");
    fs::write(&broken, "glTF").expect("a file");
    let viewer = Viewer::start(folder.path(), &broken);
    let (host, secret) = viewer.parts();
    let (status, body) = viewer.get(host, &format!("/{secret}/model"));
    let sentence = String::from_utf8(body).expect("text");
    assert!(status == 422 && sentence.contains("broken.glb: "), "{status} {sentence}");
}

#[test]
fn without_the_page_the_command_says_what_makes_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = darboux(&["view".as_ref(), "--no-open".as_ref(), "--page".as_ref(), folder.path()]).exits(1);
    assert!(run.stderr.contains("cargo xtask dist-viewer"), "{}", run.stderr);
}

#[test]
fn what_is_no_model_is_refused() {
    for (model, said) in
        [("no-such.glb", "cannot be read"), (".", "is not a file"), ("Cargo.toml", "cannot be shown")]
    {
        let run = darboux(&["view", "--no-open", model]).exits(1);
        assert!(run.stderr.contains(said), "{model}: {}", run.stderr);
    }
}

//! The server of `darboux view`: what it serves, what it refuses, and how it bears hostile connections.

mod common;

use std::fs;
use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use common::{asset, darboux, folder_with};

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
        Self::start_with(Command::new(env!("CARGO_BIN_EXE_darboux")), folder, &[model])
    }

    fn start_with(mut command: Command, folder: &Path, models: &[&Path]) -> Self {
        fs::write(folder.join("index.html"), "the page").expect("a page");
        let mut child = command
            .args(["view", "--no-open", "--page"])
            .arg(folder)
            .args(models)
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

#[test]
fn the_page_and_the_model_are_behind_the_secret() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = asset("NormalTangentTest/NormalTangentTest.glb");
    let viewer = Viewer::start(folder.path(), &model);
    let (host, secret) = viewer.parts();
    assert!(host.starts_with("127.0.0.1:") && secret.len() == 32, "{}", viewer.address);
    assert!(viewer.address.ends_with("/?model=NormalTangentTest.glb"), "{}", viewer.address);
    assert_eq!(viewer.get(host, &format!("/{secret}/")), (200, b"the page".to_vec()));
    let names = viewer.get(host, &format!("/{secret}/model"));
    assert_eq!(names, (200, br#"["NormalTangentTest.glb"]"#.to_vec()));
    let (status, body) = viewer.get(host, &format!("/{secret}/model/0"));
    assert!(status == 200 && body == fs::read(model).expect("a model"), "{status}, {} bytes", body.len());
    for path in [
        "/",
        "/index.html",
        "/model",
        "/model/0",
        "/0123456789abcdef0123456789abcdef/",
        &format!("/{secret}"),
    ] {
        assert_eq!(viewer.get(host, path).0, 403, "{path}");
    }
    for hosts in [format!("{host}\r\nHost: {host}"), format!("{host}\r\nHost: example.com")] {
        assert_eq!(viewer.get(&hosts, &format!("/{secret}/")).0, 403, "{hosts}");
    }
    assert_eq!(viewer.get("evil.example", &format!("/{secret}/")).0, 403);
}

#[test]
fn a_high_model_is_served_beside_the_low_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let (low, high) = (asset("made/shield.glb"), asset("NormalTangentTest/NormalTangentTest.glb"));
    let command = Command::new(env!("CARGO_BIN_EXE_darboux"));
    let viewer = Viewer::start_with(command, folder.path(), &[&low, Path::new("--high"), &high]);
    let (host, secret) = viewer.parts();
    assert!(viewer.address.ends_with("/?model=shield.glb&high=NormalTangentTest.glb"), "{}", viewer.address);
    assert_eq!(viewer.get(host, &format!("/{secret}/high")), (200, br#"["NormalTangentTest.glb"]"#.to_vec()));
    for (address, model) in [("model", &low), ("high", &high)] {
        let (status, body) = viewer.get(host, &format!("/{secret}/{address}/0"));
        assert!(status == 200 && body == fs::read(model).expect("a model"), "{address}: {status}");
    }
    let alone = Viewer::start(folder.path(), &low);
    let (host, secret) = alone.parts();
    assert_eq!(alone.get(host, &format!("/{secret}/high")).0, 404);
    darboux(&["view", "--no-open", "--high", &high.display().to_string()]).exits(2);
}

/// A thread whose stack is larger than the address space cannot start.
#[test]
fn without_threads_every_request_is_answered() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = Command::new(env!("CARGO_BIN_EXE_darboux"));
    command.env("RUST_MIN_STACK", (1u64 << 50).to_string());
    let viewer = Viewer::start_with(command, folder.path(), &[&asset("made/shield.glb")]);
    let (host, secret) = viewer.parts();
    for _ in 0..3 {
        assert_eq!(viewer.get(host, &format!("/{secret}/")), (200, b"the page".to_vec()));
        assert_eq!(viewer.get(host, &format!("/{secret}/model/0")).0, 200);
    }
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
fn a_gltf_comes_whole_and_as_a_sentence_once_it_is_broken() {
    let folder = folder_with(&[
        "TwoSidedPlane/TwoSidedPlane.gltf",
        "TwoSidedPlane/TwoSidedPlane.bin",
        "TwoSidedPlane/TwoSidedPlane_BaseColor.png",
        "TwoSidedPlane/TwoSidedPlane_MetallicRoughness.png",
        "TwoSidedPlane/TwoSidedPlane_Normal.png",
    ]);
    let model = folder.path().join("TwoSidedPlane.gltf");
    let viewer = Viewer::start(folder.path(), &model);
    let (host, secret) = viewer.parts();
    assert!(viewer.address.ends_with("/?model=TwoSidedPlane.gltf"), "{}", viewer.address);
    let address = format!("/{secret}/model/0");
    let (status, body) = viewer.get(host, &address);
    assert_eq!((status, body.get(..4)), (200, Some(&b"glTF"[..])));
    for none in ["1", "-1", "", "x", "18446744073709551616"] {
        assert_eq!(viewer.get(host, &format!("/{secret}/model/{none}")).0, 404, "{none}");
    }
    fs::write(&model, "glTF").expect("a file");
    let (status, body) = viewer.get(host, &address);
    let sentence = String::from_utf8(body).expect("text");
    assert!(status == 422 && sentence.contains("TwoSidedPlane.gltf: "), "{status} {sentence}");
}

#[test]
fn an_obj_comes_with_what_it_refers_to_in_its_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("model");
    fs::create_dir_all(place.join("maps")).expect("a folder");
    let write = |path: &str, text: &str| fs::write(place.join(path), text).expect("a file");
    write("quad.obj", "mtllib maps/quad one.mtl\r\nmtllib ../outside.mtl\nmtllib linked.mtl\nf 1 2 3\n");
    write(
        "maps/quad one.mtl",
        "newmtl a\nmap_Kd -s 1 1 1 -o 0 0 0 my color.png\n  norm ..\\normal.png\nmap_Bump -bm 2 gone.png\nKd private\n\
         map_Ks ../../outside.png\nmap_Ke /etc/hostname\nmap_d my color.png\n",
    );
    for name in ["maps/my color.png", "normal.png", "private", "maps/color.png"] {
        write(name, name);
    }
    for name in ["outside.mtl", "outside.png"] {
        fs::write(folder.path().join(name), "newmtl b\n").expect("a file");
    }
    #[cfg(unix)]
    std::os::unix::fs::symlink("../outside.mtl", place.join("linked.mtl")).expect("a link");
    let viewer = Viewer::start(folder.path(), &place.join("quad.obj"));
    let (host, secret) = viewer.parts();
    let (_, names) = viewer.get(host, &format!("/{secret}/model"));
    let names: Vec<String> = serde_json::from_slice(&names).expect("a list");
    assert_eq!(names, ["quad.obj", "maps/my color.png", "normal.png", "maps/quad one.mtl"]);
    for (at, name) in names.iter().enumerate() {
        let content = fs::read(place.join(name)).expect("a file");
        assert_eq!(viewer.get(host, &format!("/{secret}/model/{at}")), (200, content), "{name}");
    }
}

#[test]
fn without_the_page_the_command_says_what_makes_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = darboux(&["view".as_ref(), "--no-open".as_ref(), "--page".as_ref(), folder.path()]).exits(1);
    assert!(run.stderr.contains("cargo xtask dist-viewer"), "{}", run.stderr);
}

#[test]
fn what_is_no_model_is_refused_in_a_sentence() {
    let folder = folder_with(&["NormalTangentTest/NormalTangentTest.glb"]);
    let at = |name: &str| folder.path().join(name).display().to_string();
    fs::write(at("index.html"), "the page").expect("a page");
    fs::write(at("empty.glb"), "").expect("a file");
    fs::write(at("start.glb"), "glTF").expect("a file");
    let good = fs::read(at("NormalTangentTest.glb")).expect("a model");
    fs::write(at("cut.glb"), &good[..good.len() / 2]).expect("a file");
    let text = fs::read_to_string(asset("made/shared-vertices-two-uv-sets.gltf")).expect("a model");
    fs::write(at("index.gltf"), text.replacen("\"POSITION\": 0", "\"POSITION\": 99", 1)).expect("a file");
    fs::write(at("empty.obj"), "").expect("a file");
    fs::write(at("points.obj"), "v 0 0 0\n").expect("a file");
    let cases = [
        ("no-such.glb", "cannot be read"),
        (".", "it is a folder; name a file in it"),
        ("index.html", "is of no format that is read; give a model"),
        ("empty.glb", "empty.glb: "),
        ("start.glb", "start.glb: "),
        ("cut.glb", "cut.glb: "),
        ("index.gltf", "accessor 99 does not exist"),
        ("empty.obj", "has no faces"),
        ("points.obj", "has no faces"),
    ];
    for (model, said) in cases {
        let run = darboux(&["view", "--no-open", "--page", &at(""), &at(model)]).exits(1);
        assert!(run.stderr.contains(said) && run.stderr.lines().count() == 1, "{model}: {}", run.stderr);
        assert!(run.stdout.is_empty(), "{model}: no address");
    }
}

/// Connections that send nothing, too much, too slowly or lies, each without the secret.
fn hostile_requests() -> Vec<Vec<u8>> {
    let get = |more: &str| format!("GET / HTTP/1.1\r\nHost: x\r\n{more}").into_bytes();
    vec![
        Vec::new(),
        b"G".to_vec(),
        get(""),
        get("Content-Length: 18446744073709551615\r\n\r\n"),
        get("Content-Length: 1000000000000\r\n\r\nx"),
        get("Content-Length: 10\r\nExpect: 100-continue\r\n\r\n"),
        get("Transfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n"),
        get(&format!("X: {}\r\n\r\n", "x".repeat(1 << 20))),
        get(&"X: y\r\n".repeat(100_000)),
        [get("\r\n"), get("\r\n"), get("\r\n")].concat(),
        vec![0; 1 << 16],
    ]
}

#[test]
fn hostile_connections_neither_block_the_page_nor_fill_the_memory() {
    let folder = tempfile::tempdir().expect("a folder");
    let viewer = Viewer::start(folder.path(), &asset("made/draco.glb"));
    let (host, secret) = viewer.parts();
    let requests = hostile_requests();
    let connections: Vec<TcpStream> = (0..200)
        .map(|number| {
            let mut stream = TcpStream::connect(host).expect("a connection");
            stream.set_write_timeout(Some(std::time::Duration::from_millis(200))).expect("a timeout");
            // The server may close the connection before it has everything.
            let _refused = stream.write_all(&requests[number % requests.len()]);
            stream
        })
        .collect();
    assert_eq!(viewer.get(host, &format!("/{secret}/")), (200, b"the page".to_vec()));
    // A server that waits for slow connections answers only after it has closed them.
    let is_open = |stream: &TcpStream| {
        stream.set_nonblocking(true).expect("a connection");
        stream.peek(&mut [0]).is_err_and(|error| error.kind() == ErrorKind::WouldBlock)
    };
    assert!(connections.iter().any(is_open), "the page came after all other connections were closed");
    if cfg!(target_os = "linux") {
        let status = fs::read_to_string(format!("/proc/{}/status", viewer.child.id())).expect("Linux");
        let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB"));
        let peak: u64 = peak.and_then(|size| size.trim().parse().ok()).expect("a size");
        assert!(peak < 200 << 10, "{peak} kB");
    }
    drop(connections);
}

#[test]
#[cfg(unix)]
fn a_link_or_a_fifo_in_place_of_a_page_file_is_not_served() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("page")).expect("a folder");
    let at = |name: &str| folder.path().join("page").join(name);
    fs::write(folder.path().join("private"), "x").expect("a file");
    ["a.js", "b.js"].iter().for_each(|name| fs::write(at(name), "1").expect("a file"));
    let viewer = Viewer::start(&folder.path().join("page"), &asset("made/draco.glb"));
    let (host, secret) = viewer.parts();
    assert_eq!(viewer.get(host, &format!("/{secret}/a.js")).0, 200);
    ["a.js", "b.js"].iter().for_each(|name| fs::remove_file(at(name)).expect("a file"));
    std::os::unix::fs::symlink("../private", at("a.js")).expect("a link");
    assert!(Command::new("mkfifo").arg(at("b.js")).status().expect("mkfifo").success());
    for name in ["a.js", "b.js"] {
        assert_eq!(viewer.get(host, &format!("/{secret}/{name}")).0, 404, "{name}");
    }
}

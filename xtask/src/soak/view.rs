//! Hostile connections to the server of `darboux view`.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use super::child::{OwnedChild, ResourceUse, measure, time_in_the_scheduler};
use super::random::Random;
use super::verdict::BrokenPromise;

/// The hostile connections that are open when the page is asked for.
const CONNECTIONS: usize = 200;
/// The memory that the server may take beside four times the model.
const MEMORY: u64 = 200 << 20;
/// The time in which the page and the model must arrive, without the time in which the server or the
/// soak uses the processor or waits for it.
const PAGE_TIME: Duration = Duration::from_secs(5);
/// The time of the processor that the server may use for them.
const PAGE_PROCESSOR_TIME: Duration = Duration::from_secs(5);
/// The time in which the server must start, measured in the same way.
const START_TIME: Duration = Duration::from_secs(20);
/// The longest wait for an answer, on any machine.
const LONGEST_WAIT: Duration = Duration::from_secs(600);

/// Starts the server, opens hostile connections, and asks for the page and the model. Errors: the system
/// refuses.
pub fn run(
    command: &mut Command,
    streams: &Path,
    input_size: u64,
    random: &mut Random,
    used: &mut ResourceUse,
    broken: &mut Vec<BrokenPromise>,
) -> io::Result<()> {
    let stdout = streams.join("stdout");
    command.stdin(Stdio::null()).stdout(File::create(&stdout)?).stderr(File::create(streams.join("stderr"))?);
    let mut server = OwnedChild::spawn(command)?;
    let address = wait_for_address(&mut server, &stdout)?;
    if let Some((host, path)) = address.as_deref().and_then(parts) {
        attack(&mut server, host, path, random, used, broken)?;
        if used.memory > MEMORY + 4 * input_size {
            broken.push(BrokenPromise {
                kind: "memory",
                detail: format!("the server took {} MB", used.memory >> 20),
            });
        }
    }
    let _may_have_ended = server.kill();
    let status = server.wait()?;
    if address.is_none() && status.code() != Some(1) {
        broken.push(BrokenPromise { kind: "server", detail: format!("printed no address ({status})") });
    }
    Ok(())
}

/// The first line of standard output; `None` if the program ended without one.
fn wait_for_address(server: &mut Child, stdout: &Path) -> io::Result<Option<String>> {
    let start = Instant::now();
    while start.elapsed() < START_TIME + time_in_the_scheduler(server.id()) {
        let has_ended = server.try_wait()?.is_some();
        if let Some((line, _)) = fs::read_to_string(stdout)?.split_once('\n') {
            return Ok(Some(line.to_owned()));
        }
        if has_ended {
            break;
        }
        thread::sleep(Duration::from_millis(2));
    }
    Ok(None)
}

/// The host and port of an address, and the path of the page.
fn parts(address: &str) -> Option<(&str, &str)> {
    let rest = address.trim_end().strip_prefix("http://")?;
    let (host, path) = rest.split_at(rest.find('/')?);
    Some((host, path.split('?').next()?))
}

fn attack(
    server: &mut Child,
    host: &str,
    path: &str,
    random: &mut Random,
    used: &mut ResourceUse,
    broken: &mut Vec<BrokenPromise>,
) -> io::Result<()> {
    let mut add = |detail: String| broken.push(BrokenPromise { kind: "server", detail });
    let mut connections = Vec::new();
    for _ in 0..CONNECTIONS {
        // A server that has ended refuses connections, which the request for the page reports.
        let Ok(mut stream) = TcpStream::connect(host) else { break };
        stream.set_write_timeout(Some(Duration::from_millis(100)))?;
        let _refused = stream.write_all(&request(random));
        connections.push(stream);
    }
    measure(server.id(), used);
    let id = server.id();
    let scheduled = || time_in_the_scheduler(id) + time_in_the_scheduler(std::process::id());
    let (start, scheduled_before, processor_before) = (Instant::now(), scheduled(), used.processor);
    for file in ["", "model", "model/0"] {
        match get(host, &format!("{path}{file}")) {
            Ok(200) => {}
            Ok(status) => add(format!("/{file} gave status {status}")),
            Err(error) => add(format!("/{file} did not arrive: {error}")),
        }
    }
    used.wall = start.elapsed();
    let idle = used.wall.saturating_sub(scheduled().saturating_sub(scheduled_before));
    if idle > PAGE_TIME {
        let [wall, idle] = [used.wall, idle].map(|time| time.as_secs_f32());
        add(format!("the page took {wall:.1} s, of which the server was idle for {idle:.1} s"));
    }
    if let Some(status) = server.try_wait()? {
        add(format!("the server ended ({status})"));
    }
    measure(server.id(), used);
    if used.processor - processor_before > PAGE_PROCESSOR_TIME {
        let seconds = (used.processor - processor_before).as_secs_f32();
        add(format!("the page took {seconds:.1} s of the processor"));
    }
    Ok(())
}

/// A request that is slow, silent, too large, lies, or is noise. None has the secret.
fn request(random: &mut Random) -> Vec<u8> {
    let get = |more: &str| format!("GET / HTTP/1.1\r\nHost: x\r\n{more}").into_bytes();
    match random.below(12) {
        0 => Vec::new(),
        1 => b"G".to_vec(),
        2 => get(""),
        3 => get("Content-Length: 18446744073709551615\r\n\r\n"),
        4 => get("Content-Length: 1000000000000\r\n\r\nx"),
        5 => get("Content-Length: 10\r\nExpect: 100-continue\r\n\r\n"),
        6 => get("Transfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n"),
        7 => get(&format!("X: {}\r\n\r\n", "x".repeat(1 << 20))),
        8 => get(&"X: y\r\n".repeat(1 << 16)),
        9 => [get("\r\n"), get("\r\n"), get("\r\n")].concat(),
        10 => get("Content-Length: 1000000\r\n\r\n"),
        _ => (0..1 << 12).map(|_| random.byte()).collect(),
    }
}

/// The status of the answer to a request for `path`. Errors: none arrives in time.
fn get(host: &str, path: &str) -> io::Result<u16> {
    let mut stream = TcpStream::connect(host)?;
    stream.set_read_timeout(Some(LONGEST_WAIT))?;
    write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n")?;
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer)?;
    let head = String::from_utf8_lossy(&answer[..answer.len().min(32)]).into_owned();
    let status = head.split(' ').nth(1).and_then(|status| status.parse().ok());
    status.ok_or_else(|| io::Error::other("the answer is no HTTP"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_has_a_host_and_a_path() {
        assert_eq!(parts("http://127.0.0.1:80/secret/?model=a.glb\n"), Some(("127.0.0.1:80", "/secret/")));
        assert_eq!(parts("127.0.0.1:80/"), None);
    }
}

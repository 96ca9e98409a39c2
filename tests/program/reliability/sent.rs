//! Poses that `pantin track --realtime --send` gives out while it runs, against the files of the same run.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpStream, UdpSocket};
use std::path::Path;
use std::process::{Child, Stdio};
use std::thread;

use glam::{DQuat, DVec3};
use rosc::{OscPacket, OscType};
use serde_json::Value;

use super::{command, track};
use crate::support::{refused, sequence};

const FEW: [&str; 7] = ["--realtime", "--backend", "cpu", "--particles", "60", "--iterations", "4"];

/// A run at work, and what it says on standard error from its first word after `before` on.
fn started(output: &Path, more: &[&str], before: &str) -> (Child, String, thread::JoinHandle<String>) {
    let mut child = command(sequence(), output, &[&FEW[..], more].concat())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut messages = BufReader::new(child.stderr.take().unwrap());
    let mut all = String::new();
    let word = loop {
        let mut line = String::new();
        assert!(messages.read_line(&mut line).unwrap() > 0, "it ended without a word on {before:?}: {all}");
        all += &line;
        if let Some((_, rest)) = line.split_once(before) {
            break rest.split_whitespace().next().unwrap().to_string();
        }
    };
    // What else it says must not fill the pipe.
    let rest = thread::spawn(move || messages.lines().map_while(Result::ok).collect());
    (child, word, rest)
}

fn ended(child: Child, messages: thread::JoinHandle<String>) -> String {
    let output = child.wait_with_output().unwrap();
    let messages = messages.join().unwrap();
    assert!(output.status.success(), "{messages}");
    String::from_utf8(output.stdout).unwrap()
}

/// The rows of a table, by frame and column.
struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap();
        let mut lines = text.lines().map(|line| line.split(',').map(str::to_string).collect::<Vec<_>>());
        Self { header: lines.next().unwrap(), rows: lines.collect() }
    }

    fn cell(&self, frame: u64, column: &str) -> &str {
        let at = self.header.iter().position(|name| name == column).unwrap_or_else(|| panic!("no column {column}"));
        let frame = frame.to_string();
        &self.rows.iter().find(|row| row[0] == frame).unwrap_or_else(|| panic!("no frame {frame}"))[at]
    }

    fn value(&self, frame: u64, column: &str) -> f64 {
        self.cell(frame, column).parse().unwrap()
    }
}

/// Holds a line to the files of its run.
fn check(line: &Value, output: &Path) {
    let frame = line["frame"].as_u64().unwrap();
    let [poses, joints, confidence] =
        ["poses.csv", "joints.csv", "confidence.csv"].map(|name| Table::read(&output.join(name)));
    let near = |found: &Value, expected: f64, within: f64, what: &str| {
        let found = found.as_f64().unwrap_or_else(|| panic!("{what}: {found}"));
        assert!((found - expected).abs() <= within, "frame {frame}, {what}: {found} sent, {expected} in the file");
    };
    let dofs = line["pose"].as_object().unwrap();
    assert_eq!(dofs.len() + 1, poses.header.len());
    for (name, value) in dofs {
        near(value, poses.value(frame, name), 1e-6, name);
    }
    let points = line["joints"].as_object().unwrap();
    assert_eq!(points.len() * 4 + 2, joints.header.len(), "every joint, its coordinates and its expected error");
    for (name, point) in points {
        for (axis, value) in ["x", "y", "z"].iter().zip(point.as_array().unwrap()) {
            near(value, joints.value(frame, &format!("{name}.{axis}")), 2e-3, name);
        }
        near(&line["sigma"][name], joints.value(frame, &format!("{name}.sigma")), 0.01, name);
    }
    near(&line["time"], joints.value(frame, "time"), 1e-9, "time");
    for name in ["fitness", "confidence", "wrong"] {
        near(&line[name], confidence.value(frame, name), 1e-5, name);
    }
    let state = if line["lost"].as_bool().unwrap() { "lost" } else { "sure" };
    assert_eq!(confidence.cell(frame, "state"), state);
    let latency = line["latency"].as_f64().unwrap();
    assert!(latency > 0.0 && latency < 60_000.0, "{latency} ms");
}

fn account(output: &Path) -> Value {
    serde_json::from_slice(&fs::read(output.join("realtime.json")).unwrap()).unwrap()
}

#[test]
fn lines_are_what_the_files_hold() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("track");
    let more = ["--rate", "0.4", "--loop", "6", "--send", "jsonl://127.0.0.1:0"];
    let (child, address, messages) = started(&output, &more, "connect to ");
    // One leaves after two lines and comes again, one stays and is silent.
    let silent = TcpStream::connect(&address).unwrap();
    let mut early = BufReader::new(TcpStream::connect(&address).unwrap()).lines();
    let mut lines: Vec<String> = (0..2).map(|_| early.next().unwrap().unwrap()).collect();
    drop(early);
    lines.extend(BufReader::new(TcpStream::connect(&address).unwrap()).lines().map(Result::unwrap));
    let text = ended(child, messages);
    drop(silent);
    assert!(lines.len() > 10, "only {} lines", lines.len());
    let lines: Vec<Value> = lines.iter().map(|line| serde_json::from_str(line).unwrap()).collect();
    let frames: Vec<u64> = lines.iter().map(|line| line["frame"].as_u64().unwrap()).collect();
    assert!(frames.is_sorted_by(|a, b| a < b) && *frames.last().unwrap() == 35, "{frames:?}");
    lines.iter().for_each(|line| check(line, &output));
    let sent = &account(&output)["sent"][0];
    assert_eq!((&sent["to"], &sent["receivers"]), (&"jsonl://127.0.0.1:0".into(), &3.into()), "{sent}");
    assert!(sent["sent"].as_u64().unwrap() >= lines.len() as u64 && sent["dropped"] == 0, "{sent}");
    assert!(
        text.contains("jsonl://127.0.0.1:0: ") && text.contains(" poses were sent to 3 receivers, 0 were dropped"),
        "{text}"
    );
}

/// What a receiver of VMC makes of a run: every bone's place in the world, by a chain of local places and turns, is the joint's in
/// joints.csv, in Unity's axes.
#[test]
fn vmc_bones_chain_to_the_joints_of_the_files() {
    const CHAIN: [(&str, &str, &str); 6] = [
        ("Hips", "", "pelvis"),
        ("Spine", "Hips", "thorax"),
        ("LeftShoulder", "Spine", "left_clavicle"),
        ("LeftUpperArm", "LeftShoulder", "left_shoulder"),
        ("LeftLowerArm", "LeftUpperArm", "left_elbow"),
        ("LeftHand", "LeftLowerArm", "left_wrist"),
    ];
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("track");
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.set_read_timeout(Some(std::time::Duration::from_secs(2))).unwrap();
    let to = format!("vmc://{}", socket.local_addr().unwrap());
    let more = ["--rate", "0.4", "--loop", "2", "--send", &to];
    let (child, _, messages) = started(&output, &more, "poses go to ");
    let mut child = Some((child, messages));
    // The messages of each time, in the order they came.
    let mut times: Vec<(f32, Vec<rosc::OscMessage>)> = Vec::new();
    let mut buffer = [0; 65_536];
    loop {
        match socket.recv(&mut buffer) {
            Ok(size) => {
                assert!(size <= 1400, "{size} bytes");
                let (_, OscPacket::Bundle(bundle)) = rosc::decoder::decode_udp(&buffer[..size]).unwrap() else {
                    panic!("no bundle")
                };
                for packet in bundle.content {
                    let OscPacket::Message(message) = packet else { panic!("a bundle in a bundle") };
                    match (message.addr.as_str(), message.args.as_slice()) {
                        ("/VMC/Ext/T", [OscType::Float(time)]) => times.push((*time, Vec::new())),
                        ("/VMC/Ext/OK", args) => assert_eq!(args.len(), 4, "{args:?}"),
                        _ => times.last_mut().unwrap().1.push(message),
                    }
                }
            }
            // Nothing for two seconds: the run is over, or begins slowly.
            Err(_) if !times.is_empty() => break,
            Err(error) => {
                let (child, _) = child.as_mut().unwrap();
                assert!(child.try_wait().unwrap().is_none(), "it ended before a pose came: {error}");
            }
        }
    }
    let (child, messages) = child.take().unwrap();
    ended(child, messages);
    let joints = Table::read(&output.join("joints.csv"));
    assert!(times.len() > 4, "only {} poses", times.len());
    for (time, messages) in &times {
        let frame = (f64::from(*time) * 25.0).round() as u64;
        assert_eq!(messages.len(), 18, "the root and 17 bones");
        let bone = |name: &str| {
            let message = messages.iter().find(|message| message.args[0] == OscType::String(name.to_string())).unwrap();
            let values: Vec<f64> = message.args[1..].iter().map(|it| f64::from(it.clone().float().unwrap())).collect();
            (DVec3::from_slice(&values[..3]), DQuat::from_slice(&values[3..]))
        };
        assert_eq!(bone("root"), (DVec3::ZERO, DQuat::IDENTITY));
        let mut world = std::collections::HashMap::from([("", (DVec3::ZERO, DQuat::IDENTITY))]);
        for (name, parent, joint) in CHAIN {
            let ((from, turn), (at, own)) = (world[parent], bone(name));
            let place = from + turn * at;
            world.insert(name, (place, turn * own));
            let [x, y, z] = ["x", "y", "z"].map(|axis| joints.value(frame, &format!("{joint}.{axis}")) / 1e3);
            let expected = DVec3::new(-y, z, x);
            assert!((place - expected).length() < 1e-4, "frame {frame}, {name}: {place} is not {expected}");
        }
    }
    let sent = &account(&output)["sent"][0];
    assert_eq!((&sent["to"], &sent["receivers"]), (&to.as_str().into(), &Value::Null), "{sent}");
}

/// The live page of a real run: the page, poses as events, overlays as pictures, and nothing for others.
#[test]
fn the_live_page_shows_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("track");
    let (child, url, messages) = started(&output, &["--rate", "0.4", "--loop", "12", "--live"], "live page: ");
    let address = url.strip_prefix("http://").unwrap().strip_suffix('/').unwrap().to_string();
    let ask = |request: &str| {
        let mut stream = TcpStream::connect(&address).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        stream
    };
    let answer = |request: &str| {
        let mut bytes = Vec::new();
        ask(request).read_to_end(&mut bytes).unwrap();
        let end = bytes.windows(4).position(|end| end == b"\r\n\r\n").unwrap() + 4;
        (String::from_utf8(bytes[..end].to_vec()).unwrap(), bytes[end..].to_vec())
    };
    let get = |path: &str| format!("GET {path} HTTP/1.1\r\nHost: {address}\r\n\r\n");
    let (head, page) = answer(&get("/"));
    assert!(head.starts_with("HTTP/1.1 200 OK\r\n"), "{head}");
    let page = String::from_utf8(page).unwrap();
    assert!(page.contains("function makePlayer") && page.contains("<figcaption>cam3</figcaption>"), "{page}");
    assert!(answer(&format!("PUT / HTTP/1.1\r\nHost: {address}\r\n\r\n")).0.starts_with("HTTP/1.1 405 "));
    assert!(answer("GET / HTTP/1.1\r\nHost: pantin.example\r\n\r\n").0.starts_with("HTTP/1.1 403 "));
    let mut events = BufReader::new(ask(&get("/events"))).lines().map(Result::unwrap);
    let mut poses: Vec<Value> = Vec::new();
    let (mut event, mut shown, mut is_over) = (String::new(), 0, false);
    for line in &mut events {
        if let Some(name) = line.strip_prefix("event: ") {
            event = name.to_string();
        } else if let Some(data) = line.strip_prefix("data: ") {
            match event.as_str() {
                "pose" => poses.push(serde_json::from_str(data).unwrap()),
                "views" => {
                    shown += 1;
                    let (head, picture) = answer(&get(&format!("/view/3?{data}")));
                    assert!(head.contains("Content-Type: image/jpeg"), "{head}");
                    let picture = image::load_from_memory(&picture).unwrap();
                    assert_eq!((picture.width(), picture.height()), (160, 120));
                }
                "end" => is_over = true,
                other => panic!("the event {other}"),
            }
        }
    }
    let text = ended(child, messages);
    assert!(is_over && poses.len() > 10 && shown >= 2, "{} poses, {shown} times overlays", poses.len());
    poses.iter().for_each(|pose| check(pose, &output));
    assert!(text.contains(&format!("{url}: ")), "{text}");
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let again = track(sequence(), &folder.path().join("other"), &[&FEW[..], &["--live", &port]].concat());
    refused(&again, &[&format!("--live {port}: port {port} is taken by another program")]);
}

/// With a delay what goes out is the pose that was searched again, and what is said of it is of that pose.
#[test]
fn with_a_delay_the_later_pose_is_sent() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("track");
    let more = ["--rate", "0.4", "--loop", "4", "--delay", "2", "--send", "jsonl://localhost:0"];
    let (child, address, messages) = started(&output, &more, "connect to ");
    let lines: Vec<String> =
        BufReader::new(TcpStream::connect(&address).unwrap()).lines().map(Result::unwrap).collect();
    ended(child, messages);
    assert!(lines.len() > 5, "only {} lines", lines.len());
    lines.iter().for_each(|line| check(&serde_json::from_str(line).unwrap(), &output));
}

#[test]
fn wrong_destinations_are_sentences_and_leave_the_folder_alone() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("track");
    let run = |more: &[&str]| track(sequence(), &output, more);
    let usage = |more: &[&str], part: &str| {
        let done = run(more);
        let text = String::from_utf8(done.stderr).unwrap();
        assert!(done.status.code() == Some(2) && text.contains(part), "{text}");
    };
    usage(&["--realtime", "--send", "osc://127.0.0.1:9"], "unknown scheme `osc`, the nearest is ");
    usage(&["--realtime", "--send", "127.0.0.1:9"], "is no destination, expected SCHEME://HOST:PORT");
    usage(&["--realtime", "--send", "jsonl://127.0.0.1:x"], "has a port that is no number from 0 to 65535");
    usage(&["--send", "jsonl://127.0.0.1:0"], "--realtime");
    usage(&["--live"], "--realtime");
    usage(&["--realtime", "--live", "65536"], "65536 is not in 0..=65535");
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let to = format!("jsonl://{}", taken.local_addr().unwrap());
    refused(&run(&["--realtime", "--send", &to]), &[&to, "is taken by another program, expected a free one"]);
    let parts = ["jsonl://no-such-host.invalid:5005", "is not known"];
    refused(&run(&["--realtime", "--send", parts[0]]), &parts);
    refused(&run(&["--realtime", "--send", "vmc://127.0.0.1:0"]), &["nobody receives at port 0"]);
    assert!(!output.join("run.toml").exists() && !output.join("journal.txt").exists(), "nothing was begun");
}

use std::fs;
use std::path::{Path, PathBuf};

use super::super::manifest::tests::camera_table;
use super::super::video::tests::ffmpeg_is_here;
use super::*;

/// A sequence of views that ffmpeg makes up while it is asked; `others` are sources and options of all but the first.
fn sequence_of(folder: &Path, fps: f64, others: &[&str]) -> PathBuf {
    fs::write(folder.join("body.toml"), "").unwrap();
    let tables: String =
        (0..=others.len()).map(|at| camera_table(&format!("cam{at}"), [64, 48], [0.0, at as f64, 0.0])).collect();
    fs::write(folder.join("cameras.toml"), format!("{tables}[metadata]\nunits = \"mm\"\n")).unwrap();
    let head = format!("name = \"live\"\nfps = {fps:.1}\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\n");
    let first = made_up("64x48", "");
    let views = [first.as_str()].into_iter().chain(others.iter().copied()).enumerate();
    let views: String = views.map(|(at, view)| format!("[[view]]\ncamera = \"cam{at}\"\n{view}\n")).collect();
    fs::write(folder.join("sequence.toml"), head + &views).unwrap();
    folder.join("sequence.toml")
}

/// Of two views.
fn sequence(folder: &Path, second: &str) -> PathBuf {
    sequence_of(folder, 25.0, &[second])
}

fn made_up(size: &str, more: &str) -> String {
    format!("source = \"testsrc2=size={size}:rate=25{more}\"\ninput = [\"-re\", \"-f\", \"lavfi\"]")
}

/// Sets until one of them says that it is enough, which must be before a minute is over.
fn sets_until(reader: &mut LiveReader, is_enough: impl Fn(&Captured) -> bool) -> Vec<Captured> {
    let begin = Instant::now();
    let mut sets: Vec<Captured> = Vec::new();
    while !sets.last().is_some_and(&is_enough) {
        assert!(begin.elapsed() < Duration::from_secs(60), "{} sets, none of them enough", sets.len());
        sets.push(reader.next_set().unwrap().expect("sources that go on"));
    }
    sets
}

/// A writer that plays so many seconds of pictures into a named pipe.
#[cfg(unix)]
fn writer(pipe: &Path, seconds: u32) -> std::process::Child {
    let source = format!("testsrc2=size=64x48:rate=25:duration={seconds}");
    std::process::Command::new("ffmpeg")
        .args(["-v", "error", "-nostdin", "-y", "-re", "-f", "lavfi", "-i", &source])
        .args(["-c:v", "rawvideo", "-f", "nut", "-flush_packets", "1"])
        .arg(pipe)
        .spawn()
        .unwrap()
}

/// A camera whose cable is pulled and put in again.
#[cfg(unix)]
#[test]
fn a_view_that_breaks_off_is_left_out_until_it_delivers_again() {
    if !ffmpeg_is_here("a_view_that_breaks_off_is_left_out_until_it_delivers_again") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let made_up = made_up("64x48", "");
    let path = sequence_of(folder.path(), 10.0, &[&made_up, "source = \"pipe\"\ninput = [\"-f\", \"nut\"]"]);
    let sequence = Sequence::open_live(&path).unwrap();
    let mut reader = sequence.read_live(0, Duration::from_secs(30)).unwrap();
    let mut first = writer(&pipe, 2);
    let sets = sets_until(&mut reader, |set| !set.silent.is_empty());
    let (without, with) = sets.split_last().unwrap();
    assert!(!with.is_empty() && with.iter().all(|it| it.set.ignored.iter().all(Option::is_none)));
    assert!(with.iter().all(|it| it.set.pictures[2].pixels().any(|pixel| pixel.0 != [0; 3])));
    assert_eq!(
        (without.silent.as_slice(), without.set.pictures.len(), without.set.masks.len()),
        ([2].as_slice(), 3, 3)
    );
    assert!(without.set.pictures[2].pixels().all(|pixel| pixel.0 == [0; 3]));
    assert!(without.set.pictures[1].pixels().any(|pixel| pixel.0 != [0; 3]));
    let [None, None, Some(ignored)] = without.set.ignored.as_slice() else { panic!("the silent one alone is ignored") };
    assert!(ignored.dimensions() == (64, 48) && ignored.pixels().all(|pixel| pixel.0 == [255]));
    let news = reader.take_news();
    let told = format!("; frames from {} on are tracked without it until it delivers again", without.set.index);
    assert!(news.len() == 1 && news[0].starts_with("camera \"cam2\" (") && news[0].ends_with(&told), "{news:?}");
    first.wait().unwrap();
    let mut second = writer(&pipe, 20);
    let sets = sets_until(&mut reader, |set| set.silent.is_empty());
    let again = sets.last().unwrap().set.index;
    assert!(sets.is_sorted_by_key(|it| it.set.index) && again > without.set.index);
    let news = reader.take_news();
    assert!(news[0].ends_with(&format!("delivers again: frames from {again} on are tracked with it")), "{news:?}");
    drop(reader);
    second.kill().unwrap();
    second.wait().unwrap();
}

/// A camera slower than the others is waited for, once that is known of it.
#[test]
fn a_slow_view_is_not_silent() {
    if !ffmpeg_is_here("a_slow_view_is_not_silent") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let slow = "source = \"testsrc2=size=64x48:rate=1\"\ninput = [\"-re\", \"-f\", \"lavfi\"]";
    let sequence = Sequence::open_live(&sequence_of(folder.path(), 10.0, &[&made_up("64x48", ""), slow])).unwrap();
    let mut reader = sequence.read_live(0, Duration::from_secs(30)).unwrap();
    let (begin, mut in_a_row) = (Instant::now(), 0);
    while in_a_row < 2 {
        assert!(begin.elapsed() < Duration::from_secs(60), "it is left out again and again");
        let Captured { silent, .. } = reader.next_set().unwrap().unwrap();
        in_a_row = if silent.is_empty() { in_a_row + 1 } else { 0 };
    }
}

/// One of three that ends for good leaves two; when another ends, a pose can no longer be told.
#[test]
fn views_that_end_are_left_out_while_there_are_two() {
    if !ffmpeg_is_here("views_that_end_are_left_out_while_there_are_two") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let [one, other] = [":duration=4", ":duration=1"].map(|more| made_up("64x48", more));
    let sequence = Sequence::open_live(&sequence_of(folder.path(), 10.0, &[&one, &other])).unwrap();
    let mut reader = sequence.read_live(0, Duration::from_secs(30)).unwrap();
    let sets = sets_until(&mut reader, |set| !set.silent.is_empty());
    assert_eq!(sets.last().unwrap().silent, [2]);
    let news = reader.take_news();
    assert!(news.len() == 1 && news[0].contains("camera \"cam2\"") && news[0].contains("ended after"), "{news:?}");
    assert!(news[0].ends_with("on are tracked without it"), "it is not opened again: {news:?}");
    while let Some(Captured { silent, .. }) = reader.next_set().unwrap() {
        assert_eq!(silent, [2]);
    }
    assert!(reader.ended().is_some_and(|how| how.contains("camera \"cam1\"")), "{:?}", reader.ended());
}

/// Two of three that hold their line and deliver nothing.
#[cfg(unix)]
#[test]
fn a_stream_of_one_view_stalls() {
    if !ffmpeg_is_here("a_stream_of_one_view_stalls") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let pipes = ["pipe1", "pipe2"].map(|name| folder.path().join(name));
    assert!(std::process::Command::new("mkfifo").args(&pipes).status().unwrap().success());
    let [one, other] = ["pipe1", "pipe2"].map(|name| format!("source = \"{name}\"\ninput = [\"-f\", \"nut\"]"));
    let sequence = Sequence::open_live(&sequence_of(folder.path(), 10.0, &[&one, &other])).unwrap();
    let mut reader = sequence.read_live(0, Duration::from_secs(4)).unwrap();
    // The pipe stays open when its writer has ended.
    let _held = pipes.each_ref().map(|pipe| fs::OpenOptions::new().read(true).write(true).open(pipe).unwrap());
    let mut writers = pipes.each_ref().map(|pipe| writer(pipe, 2));
    let sets = sets_until(&mut reader, |set| set.silent.is_empty());
    let error = loop {
        match reader.next_set() {
            Ok(set) => assert!(set.is_some_and(|it| it.silent.len() < 2), "the others hold their lines"),
            Err(error) => break format!("{error:#}"),
        }
    };
    assert!(!sets.is_empty() && error.contains("stalled: it delivered no picture for 4.0 s"), "{error}");
    for writer in &mut writers {
        writer.wait().unwrap();
    }
}

#[test]
fn pictures_are_matched_by_arrival() {
    if !ffmpeg_is_here("pictures_are_matched_by_arrival") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = sequence(folder.path(), &made_up("64x48", ":duration=1"));
    let error = format!("{:#}", Sequence::open(&path).unwrap_err());
    assert!(error.contains("source of camera \"cam0\" is live, which only `track --realtime` reads"), "{error}");
    let sequence = Sequence::open_live(&path).unwrap();
    assert!(sequence.is_live() && sequence.frame_count == Sequence::NO_END);
    let mut reader = sequence.read_live(7, Duration::from_secs(20)).unwrap();
    let mut indices = Vec::new();
    while let Some(Captured { set, .. }) = reader.next_set().unwrap() {
        assert_eq!((set.pictures.len(), set.pictures[1].dimensions()), (2, (64, 48)));
        indices.push(set.index);
    }
    assert_eq!(indices.first(), Some(&7));
    assert!(indices.len() > 5 && indices.is_sorted_by(|a, b| a < b), "{indices:?}");
    assert!(reader.ended().is_some_and(|how| how.contains("camera \"cam1\"") && how.contains("ended after")));
}

/// Each begins when its ffmpeg does.
#[test]
fn four_cameras_without_a_trigger_make_sets() {
    if !ffmpeg_is_here("four_cameras_without_a_trigger_make_sets") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let made_up = made_up("64x48", "");
    let sequence = Sequence::open_live(&sequence_of(folder.path(), 25.0, &[made_up.as_str(); 3])).unwrap();
    let mut reader = sequence.read_live(0, Duration::from_secs(30)).unwrap();
    assert_eq!(reader.apart(), None);
    let sets = sets_until(&mut reader, |set| set.set.index >= 50);
    assert!(sets.len() >= 25, "{} sets in 50 frames", sets.len());
    let apart = reader.apart().unwrap();
    assert!((0.0..0.04).contains(&apart), "{apart}");
}

#[test]
fn what_is_wrong_with_a_source_is_a_sentence() {
    if !ffmpeg_is_here("what_is_wrong_with_a_source_is_a_sentence") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let failed = |second: &str, timeout: f64| {
        let sequence = Sequence::open_live(&sequence(folder.path(), second)).unwrap();
        let mut reader = sequence.read_live(0, Duration::from_secs_f64(timeout)).unwrap();
        loop {
            match reader.next_set() {
                Ok(set) => assert!(set.is_some(), "it ended without a sentence"),
                Err(error) => return format!("{error:#}"),
            }
        }
    };
    let error = failed(&made_up("80x48", ""), 20.0);
    assert!(error.contains("camera \"cam1\"") && error.contains("pictures of 80x48 pixels"), "{error}");
    let error = failed("source = \"rtsp://127.0.0.1:1/none\"", 20.0);
    assert!(error.contains("camera \"cam1\" (rtsp://127.0.0.1:1/none) delivered no picture: ffmpeg says"), "{error}");
    fs::write(folder.path().join("garbage"), [7; 9000]).unwrap();
    let error = failed("source = \"garbage\"\ninput = [\"-f\", \"mpegts\"]", 20.0);
    assert!(error.contains("camera \"cam1\"") && error.contains("delivered no picture"), "{error}");
}

#[test]
fn a_manifest_cannot_hand_anything_to_ffmpeg() {
    let folder = tempfile::tempdir().unwrap();
    let path = sequence(folder.path(), "source = \"x\"\ninput = [\"-i\", \"y\", \"out.mp4\"]");
    let error = format!("{:#}", Sequence::open_live(&path).unwrap_err());
    assert!(error.contains("the source of camera \"cam1\": `input` has \"-i\""), "{error}");
    let written = folder.path().join("written");
    let path = sequence(folder.path(), &made_up("64x48", &format!(",metadata=mode=print:file={}", written.display())));
    let error = format!("{:#}", Sequence::open_live(&path).unwrap_err());
    assert!(error.contains("the source of camera \"cam1\": `source` is \"testsrc2=") && !written.exists(), "{error}");
    let path = sequence(folder.path(), "source = \"x_%04d.png\"");
    assert!(Sequence::open_live(&path).is_err());
}

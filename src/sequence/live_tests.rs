use std::fs;
use std::path::{Path, PathBuf};

use super::super::manifest::tests::camera_table;
use super::super::video::tests::ffmpeg_is_here;
use super::*;

/// A sequence of two views that ffmpeg makes up while it is asked; `second` is the second's source and options.
fn sequence(folder: &Path, second: &str) -> PathBuf {
    fs::write(folder.join("body.toml"), "").unwrap();
    let tables: String =
        (0..2).map(|at| camera_table(&format!("cam{at}"), [64, 48], [0.0, f64::from(at), 0.0])).collect();
    fs::write(folder.join("cameras.toml"), format!("{tables}[metadata]\nunits = \"mm\"\n")).unwrap();
    let text = format!(
        "name = \"live\"\nfps = 25.0\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\n[[view]]\ncamera = \"cam0\"\n\
         source = \"testsrc2=size=64x48:rate=25\"\ninput = [\"-re\", \"-f\", \"lavfi\"]\n[[view]]\ncamera = \"cam1\"\n{second}\n"
    );
    fs::write(folder.join("sequence.toml"), text).unwrap();
    folder.join("sequence.toml")
}

fn made_up(size: &str, more: &str) -> String {
    format!("source = \"testsrc2=size={size}:rate=25{more}\"\ninput = [\"-re\", \"-f\", \"lavfi\"]")
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

#[test]
fn a_stream_of_pictures_is_read_to_the_byte() {
    let picture = |shade: u8| [b"P6\n2 1\n255\n".as_slice(), &[shade; 6]].concat();
    let read = |bytes: &[u8]| -> Result<Vec<u8>> {
        let (mut stream, mut shades) = (bytes, Vec::new());
        while let Some(picture) = read_ppm(&mut stream, [2, 1], "camera \"a\"")? {
            shades.push(picture.into_raw()[5]);
        }
        Ok(shades)
    };
    let two = [picture(10), picture(200)].concat();
    assert_eq!(read(&two).unwrap(), [10, 200]);
    for cut in 0..two.len() {
        assert_eq!(read(&two[..cut]).unwrap().len(), usize::from(cut >= two.len() / 2), "cut at {cut}");
    }
    for (bytes, part) in [
        (b"P6\n3 1\n255\n123456789".to_vec(), "pictures of 3x1 pixels"),
        (b"P5\n2 1\n255\n12".to_vec(), "no picture"),
        (b"P6\n2 1\n65535\n12".to_vec(), "no picture"),
        (vec![b'x'; 100], "no picture"),
        (b"\n\n\n".to_vec(), "no picture"),
    ] {
        let error = format!("{:#}", read(&bytes).unwrap_err());
        assert!(error.contains(part), "{error}");
    }
}

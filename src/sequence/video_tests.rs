use std::fs;

use super::super::program::lock;
use super::*;

/// Whether the programs are there; says so where not, so that a skipped test is seen.
pub(crate) fn ffmpeg_is_here(test: &str) -> bool {
    let here = Command::new("ffmpeg").arg("-version").output().is_ok() && Command::new("ffprobe").output().is_ok();
    if !here {
        println!("SKIPPED {test}: ffmpeg is not installed");
    }
    here
}

/// Makes a video with ffmpeg's own test picture, which differs from frame to frame.
pub(crate) fn make_video(path: &Path, size: &str, frames: usize, options: &[&str]) {
    let status = Command::new("ffmpeg")
        .args(["-v", "error", "-nostdin", "-y", "-f", "lavfi", "-i", &format!("testsrc2=size={size}:rate=25")])
        .args(options)
        .args(["-frames:v", &frames.to_string()])
        .arg(path)
        .status()
        .unwrap();
    assert!(status.success(), "ffmpeg cannot make {}", path.display());
}

fn as_stored(path: &Path) -> Video {
    Video { path: path.to_path_buf(), stored: probe_video(path).unwrap().size, turn: Turn::None }
}

fn decode(path: &Path, range: Range<usize>, size: [u32; 2]) -> Result<Vec<Vec<u8>>> {
    let mut decoder = VideoDecoder::open(&as_stored(path), None, range, size, PixelFormat::Rgb, 1)?;
    let mut frames = Vec::new();
    while let Some(frame) = decoder.next_frame()? {
        frames.push(frame);
    }
    Ok(frames)
}

#[test]
fn every_frame_is_found_by_its_number() {
    if !ffmpeg_is_here("every_frame_is_found_by_its_number") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("-a 100%.mp4");
    make_video(&path.with_file_name("plain.mp4"), "320x240", 30, &["-bf", "2", "-g", "7"]);
    fs::rename(path.with_file_name("plain.mp4"), &path).unwrap();
    let info = probe_video(&path).unwrap();
    assert_eq!((info.size, info.frame_count, info.turn, info.fps), ([320, 240], 30, Turn::None, Some(25.0)));
    assert!(info.times.is_some_and(|times| times.is_regular()));
    let all = decode(&path, 0..30, [160, 120]).unwrap();
    assert_eq!(all.len(), 30);
    assert!(all.windows(2).all(|pair| pair[0] != pair[1]), "the frames differ, so that a shift is seen");
    for range in [0..1, 6..9, 13..20, 29..30] {
        assert_eq!(decode(&path, range.clone(), [160, 120]).unwrap(), all[range]);
    }
    for (count, expected) in
        [(30, (0..30).collect::<Vec<_>>()), (3, vec![9, 19, 29]), (7, vec![4, 8, 12, 17, 21, 25, 29])]
    {
        let mut decoder = VideoDecoder::open_spread(&as_stored(&path), 30, count, [160, 120]).unwrap();
        for frame in expected {
            assert_eq!(decoder.next_frame().unwrap().as_ref(), Some(&all[frame]), "{count} frames, frame {frame}");
        }
        assert_eq!(decoder.next_frame().unwrap(), None);
    }
}

/// Pictures that come in planes are those that come in pixels, byte for byte, whatever is stored and whatever the scale.
#[test]
fn planes_hold_the_same_pixels() {
    if !ffmpeg_is_here("planes_hold_the_same_pixels") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let in_pixels = |path: &Path, [width, height]: [u32; 2]| {
        let scale = format!("scale={width}:{height}:flags=area+accurate_rnd+full_chroma_int+bitexact,format=rgb24");
        let mut command = Command::new("ffmpeg");
        command.args(["-v", "error", "-nostdin", "-i"]).arg(path).args([
            "-vf",
            &scale,
            "-bitexact",
            "-f",
            "rawvideo",
            "-",
        ]);
        command.output().unwrap().stdout
    };
    for (name, options) in [
        ("420", ["-c:v", "libx264", "-pix_fmt", "yuv420p"]),
        ("444", ["-c:v", "ffv1", "-pix_fmt", "yuv444p"]),
        ("full", ["-c:v", "mjpeg", "-pix_fmt", "yuvj422p"]),
        ("deep", ["-c:v", "ffv1", "-pix_fmt", "yuv420p10le"]),
        ("grey", ["-c:v", "ffv1", "-pix_fmt", "gray"]),
        ("colours", ["-c:v", "png", "-pix_fmt", "rgb24"]),
    ] {
        let path = folder.path().join(format!("{name}.mkv"));
        make_video(&path, "322x246", 3, &options);
        for size in [[161, 122], [160, 120], [80, 61], [81, 37], [322, 30], [23, 5]] {
            assert!(comes_in_planes([322, 246], size));
            let expected = in_pixels(&path, size);
            let found = decode(&path, 0..3, size).unwrap().concat();
            assert!(found == expected, "{name} at {size:?}: {} bytes, {} expected", found.len(), expected.len());
        }
    }
    assert!(![[322, 246], [161, 123], [10, 200]].into_iter().any(|size| comes_in_planes([322, 246], size)));
    // Red, green and blue are told apart, and each pixel from its neighbour.
    let mut pixels = [0; 6];
    interleave(&[1, 2, 3, 4, 5, 6], &mut pixels);
    assert_eq!(pixels, [5, 1, 3, 6, 2, 4]);
}

/// How many decoders share the processors is nothing that a picture tells.
#[test]
fn threads_do_not_change_pictures() {
    assert!(threads_of_one(1) >= 1 && threads_of_one(1) <= 16);
    assert_eq!([threads_of_one(0), threads_of_one(100_000)], [threads_of_one(1), 1]);
    if !ffmpeg_is_here("threads_do_not_change_pictures") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("video.mp4");
    make_video(&path, "320x240", 20, &["-bf", "2", "-g", "7"]);
    let mut alone = VideoDecoder::open(&as_stored(&path), None, 3..20, [80, 60], PixelFormat::Rgb, 1).unwrap();
    let mut one_of_many = VideoDecoder::open(&as_stored(&path), None, 3..20, [80, 60], PixelFormat::Rgb, 64).unwrap();
    for _ in 3..20 {
        let frame = alone.next_frame().unwrap();
        assert!(frame.is_some() && frame == one_of_many.next_frame().unwrap());
    }
}

/// A matrix in a header says how a video is shown; one that mirrors was taken for half a turn once.
#[test]
fn mirrored_videos_are_known_by_their_matrix() {
    if !ffmpeg_is_here("mirrored_videos_are_known_by_their_matrix") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plain.mp4");
    make_video(&path, "64x48", 2, &[]);
    let plain = fs::read(&path).unwrap();
    // Behind the name of the track's header and what comes before its matrix.
    let at = plain.windows(4).position(|word| word == b"tkhd").unwrap() + 44;
    for (rows, turn) in [
        ([-1, 0, 0, 1], Turn::Mirrored),
        ([1, 0, 0, -1], Turn::Flipped),
        ([-1, 0, 0, -1], Turn::Half),
        ([0, 1, -1, 0], Turn::Clockwise),
        ([0, 1, 1, 0], Turn::Transposed),
    ] {
        let mut marked = plain.clone();
        for (number, place) in rows.into_iter().zip([0, 1, 3, 4]) {
            marked[at + 4 * place..][..4].copy_from_slice(&(number * 65536_i32).to_be_bytes());
        }
        fs::write(&path, marked).unwrap();
        let info = probe_video(&path).unwrap();
        assert_eq!((info.turn, info.size), (turn, [64, 48]), "{rows:?}");
        let video = Video { path: path.clone(), stored: info.size, turn };
        let shown = |video: &Video, size| {
            VideoDecoder::open(video, None, 0..1, size, PixelFormat::Rgb, 1).unwrap().next_frame().unwrap().unwrap()
        };
        let stored = image::RgbImage::from_raw(64, 48, shown(&as_stored(&path), [64, 48])).unwrap();
        let expected = turn.of(stored.into()).into_rgb8();
        // Colours have half the rows, which do not lie the same way upside down: whole pixels along edges of colours differ.
        let turned = shown(&video, turn.turned([64, 48]));
        let apart = |other: &image::RgbImage| {
            let sum: u32 = turned.iter().zip(other.as_raw()).map(|(a, b)| u32::from(a.abs_diff(*b))).sum();
            f64::from(sum) / turned.len() as f64
        };
        assert!(apart(&expected) < 12.0, "{turn:?}: {}", apart(&expected));
        assert!(apart(&image::imageops::rotate180(&expected)) > 30.0, "{turn:?}");
    }
}

#[test]
fn irregular_time_stamps_neither_repeat_nor_drop_frames() {
    if !ffmpeg_is_here("irregular_time_stamps_neither_repeat_nor_drop_frames") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("irregular.mkv");
    // Gaps of one to several frame times, as telephones record them.
    let stamps = ["-vf", "setpts=(N+floor(N*N/7))/(25*TB)", "-fps_mode", "passthrough", "-c:v", "mpeg4"];
    if !passthrough_option(Path::new("ffmpeg")).unwrap().contains(&"-fps_mode") {
        println!("SKIPPED irregular_time_stamps_neither_repeat_nor_drop_frames: ffmpeg is older than 5.1");
        return;
    }
    make_video(&path, "320x240", 12, &stamps);
    assert_eq!(probe_video(&path).unwrap().frame_count, 12);
    let all = decode(&path, 0..12, [320, 240]).unwrap();
    assert_eq!(all.len(), 12);
    assert!(all.windows(2).all(|pair| pair[0] != pair[1]));
}

#[test]
fn broken_videos_are_sentences() {
    if !ffmpeg_is_here("broken_videos_are_sentences") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let probe = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        format!("{:#}", probe_video(&path).unwrap_err())
    };
    let error = probe("garbage.mp4", &[7; 5000]);
    assert!(error.contains("garbage.mp4 cannot be read as a video: ffmpeg says"), "{error}");
    let error = probe("empty.mp4", b"");
    assert!(error.contains("empty.mp4 cannot be read as a video"), "{error}");
    let path = folder.path().join("whole.mp4");
    make_video(&path, "320x240", 40, &["-movflags", "+faststart", "-g", "10"]);
    let whole = fs::read(&path).unwrap();
    // Its index is at the front and promises all frames.
    let error = probe("half.mp4", &whole[..whole.len() / 2]);
    assert!(error.contains("half.mp4 is damaged or cut short") && error.contains("promises 40 frames"), "{error}");
    let error = probe("index_cut.mp4", &whole[..200]);
    assert!(error.contains("index_cut.mp4 cannot be read as a video"), "{error}");
    let error = probe("endless.mp4", b"#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\npart.ts\n");
    assert!(error.contains("endless.mp4 is an HLS playlist"), "{error}");
    let sound = folder.path().join("sound.wav");
    let made =
        Command::new("ffmpeg").args(["-v", "error", "-f", "lavfi", "-i", "sine=duration=0.1"]).arg(&sound).status();
    assert!(made.unwrap().success());
    let error = format!("{:#}", probe_video(&sound).unwrap_err());
    assert!(error.contains("sound.wav cannot be read as a video"), "{error}");
}

#[cfg(unix)]
#[test]
fn a_silent_program_is_ended() {
    let said = |script: &str| {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        let mut process = Process::spawn(command).unwrap();
        let watch = process.watch(Duration::from_millis(800)).unwrap();
        let lines = BufReader::new(&mut process.output).lines().inspect(|_| watch.heard()).count();
        (lines, watch.has_stopped_it())
    };
    assert_eq!(said("for i in 1 2 3 4 5; do echo $i; sleep 0.3; done"), (5, false));
    assert_eq!(said("echo 1; exec sleep 60"), (1, true));
}

#[test]
fn a_decoder_that_stops_names_the_frame() {
    if !ffmpeg_is_here("a_decoder_that_stops_names_the_frame") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("spoilt.mp4");
    make_video(&path, "320x240", 40, &["-movflags", "+faststart", "-g", "10"]);
    let mut bytes = fs::read(&path).unwrap();
    let (from, to) = (bytes.len() / 2, bytes.len() / 2 + 4000);
    bytes[from..to].fill(0x55);
    fs::write(&path, bytes).unwrap();
    assert_eq!(probe_video(&path).unwrap().frame_count, 40, "the index is whole");
    let error = format!("{:#}", decode(&path, 0..40, [32, 24]).unwrap_err());
    assert!(error.contains("spoilt.mp4: decoding stopped before frame") && error.contains("ffmpeg says"), "{error}");
    // A range past the end ends the same way.
    let short = folder.path().join("short.mp4");
    make_video(&short, "64x48", 5, &[]);
    let error = format!("{:#}", decode(&short, 0..9, [64, 48]).unwrap_err());
    assert!(error.contains("decoding stopped before frame 5, expected frames up to 8"), "{error}");
}

#[test]
fn a_dropped_decoder_ends_its_process() {
    if !ffmpeg_is_here("a_dropped_decoder_ends_its_process") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.mp4");
    make_video(&path, "320x240", 200, &[]);
    let mut decoder = VideoDecoder::open(&as_stored(&path), None, 0..200, [320, 240], PixelFormat::Rgb, 1).unwrap();
    decoder.next_frame().unwrap();
    let entry = format!("/proc/{}", lock(&decoder.process.child).id());
    assert!(!Path::new("/proc/self").exists() || Path::new(&entry).exists());
    // A stopped decoder hands out what the pipe still holds, then an error; it never blocks.
    decoder.stopper().stop();
    let error = loop {
        match decoder.next_frame() {
            Ok(frame) => assert!(frame.is_some(), "the decoder was stopped before the last frame"),
            Err(error) => break format!("{error:#}"),
        }
    };
    assert!(error.contains("long.mp4: decoding stopped before frame"), "{error}");
    drop(decoder);
    assert!(!Path::new(&entry).exists(), "the child was killed and reaped");
}

#[test]
fn a_missing_program_says_how_to_install_it() {
    let error = format!("{:#}", probe_with(Path::new("no-such-ffprobe"), Path::new("Cargo.toml")).unwrap_err());
    assert!(error.contains("`no-such-ffprobe` was not found") && error.contains("apt install ffmpeg"), "{error}");
}

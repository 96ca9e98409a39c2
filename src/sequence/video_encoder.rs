//! Video files, written through the `ffmpeg` program: H.264, the same bytes for the same pictures.

use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};

use anyhow::{Context, Result, anyhow, bail, ensure};

use crate::files::shortened;

/// Encodes the frames of one video in their order. The encoder is another process; what it writes has a temporary name until
/// [`Self::finish`].
#[derive(Debug)]
pub struct VideoEncoder {
    path: PathBuf,
    temporary: PathBuf,
    process: Child,
    input: Option<ChildStdin>,
    frame_bytes: usize,
}

impl VideoEncoder {
    /// Starts a video of pictures of `size` (width, height; RGB, or one byte a pixel where grey) at `fps`, with the constant
    /// rate factor `crf` (0 loses nothing, 51 most). A file of that name is replaced.
    ///
    /// # Errors
    /// When a side is odd (H.264 halves the colours' size), or ffmpeg is missing.
    pub fn create(path: &Path, size: [u32; 2], fps: f64, is_grey: bool, crf: u8) -> Result<Self> {
        let [width, height] = size;
        ensure!(
            width % 2 == 0 && height % 2 == 0,
            "{}: pictures of {width} x {height} cannot be a video, expected even sides",
            path.display()
        );
        let program = ffmpeg_sidecar::paths::ffmpeg_path();
        let temporary = path.with_extension("tmp.mp4");
        let mut command = Command::new(&program);
        command.args([
            "-v",
            "error",
            "-nostdin",
            "-y",
            "-f",
            "rawvideo",
            "-pix_fmt",
            if is_grey { "gray" } else { "rgb24" },
        ]);
        command.args(["-s", &format!("{width}x{height}"), "-r", &fps.to_string(), "-i", "pipe:0"]);
        // One thread: the encoder's decisions depend on their number.
        command.args(["-c:v", "libx264", "-threads", "1", "-preset", "veryfast", "-crf", &crf.to_string()]);
        command.args(["-pix_fmt", "yuv420p", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1"]);
        command.arg(&temporary).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut process = command.spawn().map_err(|error| match error.kind() {
            ErrorKind::NotFound => {
                anyhow!("{} is not there, expected ffmpeg to be installed for writing videos", program.display())
            }
            _ => anyhow!("cannot start {}: {error}", program.display()),
        })?;
        let input = process.stdin.take();
        let frame_bytes = width as usize * height as usize * if is_grey { 1 } else { 3 };
        Ok(Self { path: path.to_path_buf(), temporary, process, input, frame_bytes })
    }

    /// Adds a frame, row by row.
    ///
    /// # Errors
    /// When it has another size, or ffmpeg has ended; its last words are part of the message.
    pub fn write(&mut self, frame: &[u8]) -> Result<()> {
        ensure!(
            frame.len() == self.frame_bytes,
            "a frame of {} bytes for {}, expected {}",
            frame.len(),
            self.path.display(),
            self.frame_bytes
        );
        let written = self.input.as_mut().map_or(Err(ErrorKind::BrokenPipe.into()), |input| input.write_all(frame));
        match written {
            Ok(()) => Ok(()),
            Err(error) => {
                let words = self.last_words();
                bail!("cannot write {}: {error}: {words}", self.path.display())
            }
        }
    }

    /// Ends the video and gives it its name.
    ///
    /// # Errors
    /// When ffmpeg failed or the file cannot be renamed.
    pub fn finish(mut self) -> Result<()> {
        drop(self.input.take());
        let words = self.last_words();
        let status = self.process.wait().with_context(|| format!("cannot write {}", self.path.display()))?;
        ensure!(status.success(), "cannot write {}: ffmpeg ended with {status}: {words}", self.path.display());
        std::fs::rename(&self.temporary, &self.path).with_context(|| format!("cannot write {}", self.path.display()))
    }

    /// The last line of what ffmpeg says, until it ends.
    fn last_words(&mut self) -> String {
        drop(self.input.take());
        let mut words = String::new();
        if let Some(stderr) = &mut self.process.stderr {
            let mut bytes = Vec::new();
            // Only what cannot be read is lost.
            let _ = stderr.take(1 << 16).read_to_end(&mut bytes);
            words = String::from_utf8_lossy(&bytes).into_owned();
        }
        shortened(words.lines().last().unwrap_or_default())
    }
}

impl Drop for VideoEncoder {
    /// A video that was not finished leaves nothing behind.
    fn drop(&mut self) {
        drop(self.input.take());
        if self.temporary.exists() {
            let _ = self.process.kill();
            let _ = self.process.wait();
            let _ = std::fs::remove_file(&self.temporary);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::video::tests::ffmpeg_is_here;

    #[test]
    fn frames_come_back_and_bytes_repeat() {
        if !ffmpeg_is_here("frames_come_back_and_bytes_repeat") {
            return;
        }
        let folder = tempfile::tempdir().unwrap();
        let make = |name: &str| {
            let path = folder.path().join(name);
            let mut encoder = VideoEncoder::create(&path, [64, 48], 25.0, true, 10).unwrap();
            for frame in 0..12u8 {
                encoder.write(&vec![40 + 10 * frame; 64 * 48]).unwrap();
            }
            assert!(!path.exists(), "not before it is complete");
            encoder.finish().unwrap();
            path
        };
        let path = make("a.mp4");
        let info = crate::sequence::probe_video(&path).unwrap();
        assert_eq!((info.size, info.frame_count), ([64, 48], 12));
        assert_eq!(std::fs::read(&path).unwrap(), std::fs::read(make("b.mp4")).unwrap());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2, "no temporary is left");
    }

    #[test]
    fn what_cannot_be_a_video_is_named() {
        let error = VideoEncoder::create(Path::new("x.mp4"), [63, 48], 25.0, true, 10).unwrap_err().to_string();
        assert!(error.contains("63 x 48") && error.contains("even sides"), "{error}");
        if !ffmpeg_is_here("what_cannot_be_a_video_is_named") {
            return;
        }
        let folder = tempfile::tempdir().unwrap();
        let mut encoder = VideoEncoder::create(&folder.path().join("x.mp4"), [64, 48], 25.0, false, 10).unwrap();
        assert!(encoder.write(&[0; 5]).unwrap_err().to_string().contains("a frame of 5 bytes"));
        let nowhere = VideoEncoder::create(&folder.path().join("none/x.mp4"), [64, 48], 25.0, false, 10).unwrap();
        assert!(nowhere.finish().unwrap_err().to_string().contains("cannot write"));
    }
}

//! Video files, read through the `ffmpeg` and `ffprobe` programs: every stored frame once, in decoding order, in the
//! orientation it is stored in (a calibration is made for the file as it is, not for how a player would turn it).

use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::Duration;

use anyhow::{Context, Result, anyhow, bail};

use super::playlist::refuse_playlist;
use super::program::{Process, Stopper, missing_program};

/// What a video file holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VideoInfo {
    /// Size of its pictures as they are stored, pixels, width then height.
    pub size: [u32; 2],
    /// Number of frames.
    pub frame_count: usize,
    /// What a player would turn the pictures by, degrees; ignored when reading.
    pub rotation: i32,
    /// Frames per second on average, where the file tells.
    pub fps: Option<f64>,
}

/// A file of which ffprobe tells nothing for so long is given up: frames are listed as they are come upon.
const LONGEST_SILENCE: Duration = Duration::from_secs(60);

/// Reads the size and counts the frames of a video without decoding it.
///
/// # Errors
/// One sentence when ffprobe is missing, or when the file is no video but a playlist, say, has no frames or is cut short; the last line
/// ffprobe wrote is part of it. And when it goes on for a minute without a frame.
pub fn probe_video(path: &Path) -> Result<VideoInfo> {
    probe_with(&ffmpeg_sidecar::ffprobe::ffprobe_path(), path)
}

fn probe_with(program: &Path, path: &Path) -> Result<VideoInfo> {
    refuse_playlist(path)?;
    let mut command = Command::new(program);
    command.args(["-v", "error", "-select_streams", "v:0", "-of", "flat", "-show_entries"]);
    // Packets are listed rather than counted: those an edit list cuts off are marked, and never become frames.
    command.arg("stream=width,height,nb_frames,avg_frame_rate:stream_side_data=rotation:packet=flags");
    command.args(["-protocol_whitelist", "file", "-i"]).arg(file_url(path));
    let mut process = Process::spawn(command)?;
    let watch = process.watch(LONGEST_SILENCE)?;
    let (mut size, mut promised, mut rotation, mut fps) = ([0_u32; 2], 0_usize, 0, None);
    let (mut packets, mut discarded, mut corrupt) = (0_usize, 0_usize, 0_usize);
    for line in BufReader::new(&mut process.output).lines() {
        let line = line.with_context(|| format!("cannot read what ffprobe says of {}", path.display()))?;
        watch.heard();
        let Some((key, value)) = line.split_once('=') else { continue };
        let value = value.trim_matches('"');
        match key.rsplit('.').next() {
            Some("flags") => {
                packets += 1;
                discarded += usize::from(value.contains('D'));
                corrupt += usize::from(value.contains('C'));
            }
            Some("width") => size[0] = value.parse().unwrap_or(0),
            Some("height") => size[1] = value.parse().unwrap_or(0),
            Some("nb_frames") => promised = value.parse().unwrap_or(0),
            Some("avg_frame_rate") => fps = rate(value),
            Some("rotation") => rotation = value.parse().unwrap_or(0),
            _ => {}
        }
    }
    if watch.has_stopped_it() {
        let seconds = LONGEST_SILENCE.as_secs();
        bail!("{} cannot be read as a video: ffprobe read it for {seconds} s and found no frame", path.display());
    }
    let ended = process.finish();
    if !ended.success() || size.contains(&0) {
        bail!("{} cannot be read as a video: {ended}", path.display());
    }
    if packets < promised || corrupt > 0 {
        bail!(
            "{} is damaged or cut short: its header promises {promised} frames, {} whole ones are there: {ended}",
            path.display(),
            packets - corrupt
        );
    }
    if packets == discarded {
        bail!("{} holds a video of no frames", path.display());
    }
    Ok(VideoInfo { size, frame_count: packets - discarded, rotation, fps })
}

/// A rate as ffprobe writes it, `30000/1001`.
fn rate(text: &str) -> Option<f64> {
    let (count, seconds) = text.split_once('/')?;
    let rate = count.parse::<f64>().ok()? / seconds.parse::<f64>().ok()?;
    (rate.is_finite() && rate > 0.0).then_some(rate)
}

/// The mean rate of a video, frames a second, as its container tells it.
///
/// # Errors
/// When ffprobe is missing, or the file is no video or tells no rate.
pub fn probe_rate(path: &Path) -> Result<f64> {
    refuse_playlist(path)?;
    let mut command = Command::new(ffmpeg_sidecar::ffprobe::ffprobe_path());
    command.args(["-v", "error", "-select_streams", "v:0", "-of", "csv=p=0", "-show_entries", "stream=avg_frame_rate"]);
    command.args(["-protocol_whitelist", "file", "-i"]).arg(file_url(path));
    let mut process = Process::spawn(command)?;
    let mut text = String::new();
    process
        .output
        .read_to_string(&mut text)
        .with_context(|| format!("cannot read what ffprobe says of {}", path.display()))?;
    let ended = process.finish();
    if !ended.success() {
        bail!("{} cannot be read as a video: {ended}", path.display());
    }
    let rate = text.trim().split_once('/').and_then(|(frames, seconds)| {
        let [frames, seconds]: [f64; 2] = [frames.parse().ok()?, seconds.parse().ok()?];
        Some(frames / seconds).filter(|rate| rate.is_finite() && *rate > 0.0)
    });
    rate.with_context(|| format!("{} tells no frame rate, expected a video that does", path.display()))
}

/// What each pixel of a decoded picture holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PixelFormat {
    /// Red, green, blue; scaled by area averaging.
    Rgb,
    /// Grey, one byte; at the stored size it is left as it is.
    Grey,
}

/// Decodes consecutive frames of one video. The decoder is another process; dropping this ends it.
#[derive(Debug)]
pub(super) struct VideoDecoder {
    path: PathBuf,
    process: Process,
    next: usize,
    end: usize,
    frame_bytes: usize,
}

impl VideoDecoder {
    /// Starts decoding the frames of `range`, each delivered at `size` (width, height).
    ///
    /// Everything before the range is decoded and dropped: seeking by time lands on the wrong frame in files whose time
    /// stamps are not regular, and here frame A has to be the A-th picture of the file in every view.
    ///
    /// # Errors
    /// When ffmpeg is missing or cannot be started.
    pub(super) fn open(path: &Path, range: Range<usize>, size: [u32; 2], format: PixelFormat) -> Result<Self> {
        let select = format!("gte(n\\,{})", range.start);
        Self::select(path, &select, range, size, format)
    }

    /// Starts decoding `count` frames of a file that has `total`, evenly spread, each delivered at `size`.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub(super) fn open_spread(path: &Path, total: usize, count: usize, size: [u32; 2]) -> Result<Self> {
        // Frame n is one of them where n count / total passes a whole number before the next frame.
        let select = format!("gt(floor((n+1)*{count}/{total})\\,floor(n*{count}/{total}))");
        Self::select(path, &select, 0..count, size, PixelFormat::Rgb)
    }

    /// Starts decoding the frames that `select` lets through, which are counted by `range`.
    fn select(path: &Path, select: &str, range: Range<usize>, size: [u32; 2], format: PixelFormat) -> Result<Self> {
        let program = ffmpeg_sidecar::paths::ffmpeg_path();
        let [width, height] = size;
        let (pixels, channels) = match format {
            PixelFormat::Rgb => ("rgb24", 3),
            PixelFormat::Grey => ("gray", 1),
        };
        let mut command = Command::new(&program);
        // A picture that could not be decoded would shift all later ones against the other views, so it ends the run.
        command.args(["-v", "error", "-nostdin", "-xerror", "-noautorotate"]);
        // A change of format inside the file must not restart the count of `select`.
        command.args(["-reinit_filter", "0", "-protocol_whitelist", "file", "-i"]).arg(file_url(path));
        command.args(["-map", "0:v:0", "-an", "-sn", "-dn"]).args(passthrough_option(&program)?);
        // One conversion with rounding that does not depend on the processor's instruction set.
        command.arg("-vf").arg(format!(
            "select={select},scale={width}:{height}:flags=area+accurate_rnd+full_chroma_int+bitexact,format={pixels}"
        ));
        command.arg("-frames:v").arg(range.len().to_string()).args(["-bitexact", "-f", "rawvideo", "pipe:1"]);
        Ok(Self {
            path: path.to_path_buf(),
            process: Process::spawn(command)?,
            next: range.start,
            end: range.end,
            frame_bytes: width as usize * height as usize * channels,
        })
    }

    /// What ends the decoder from another thread: a reader blocked in [`Self::next_frame`] then gets an error.
    pub(super) fn stopper(&self) -> Stopper {
        self.process.stopper()
    }

    /// The next frame, row-major bytes; `None` after the last of the range.
    ///
    /// # Errors
    /// When the decoder ends early: the file, the frame and the last line ffmpeg wrote.
    pub(super) fn next_frame(&mut self) -> Result<Option<Vec<u8>>> {
        if self.next >= self.end {
            return Ok(None);
        }
        let mut bytes = vec![0; self.frame_bytes];
        match self.process.output.read_exact(&mut bytes) {
            Ok(()) => {
                self.next += 1;
                Ok(Some(bytes))
            }
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => {
                let ended = self.process.finish();
                Err(anyhow!(
                    "{}: decoding stopped before frame {}, expected frames up to {} (re-encoding the file may help): {ended}",
                    self.path.display(),
                    self.next,
                    self.end - 1
                ))
            }
            Err(error) => {
                Err(error).with_context(|| format!("cannot read frame {} of {}", self.next, self.path.display()))
            }
        }
    }
}

/// The option that hands on every frame exactly once, whatever its time stamp. It was renamed in ffmpeg 5.1, and later
/// versions drop the old name.
pub(super) fn passthrough_option(program: &Path) -> Result<[&'static str; 2]> {
    static NEW_NAME: OnceLock<bool> = OnceLock::new();
    let known = match NEW_NAME.get() {
        Some(known) => *known,
        None => {
            let help = Command::new(program)
                .args(["-hide_banner", "-h", "long"])
                .output()
                .map_err(|error| missing_program(&program.to_string_lossy(), &error))?;
            *NEW_NAME.get_or_init(|| String::from_utf8_lossy(&help.stdout).contains("-fps_mode"))
        }
    };
    Ok(if known { ["-fps_mode", "passthrough"] } else { ["-vsync", "0"] })
}

/// The path as a `file:` address: a name like `-y` or `http:x` is then still a file.
fn file_url(path: &Path) -> std::ffi::OsString {
    let mut url = std::ffi::OsString::from("file:");
    url.push(path);
    url
}

#[cfg(test)]
#[path = "video_tests.rs"]
pub(super) mod tests;

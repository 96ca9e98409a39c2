//! Video files, read through the `ffmpeg` and `ffprobe` programs: every stored picture once, in the order they are shown, or those that
//! a list picks; as they are stored, or turned as players turn them.

use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use anyhow::{Context, Result, anyhow, bail};

use super::playlist::refuse_playlist;
use super::program::{Process, Stopper, missing_program};
use super::source::Video;
use super::timestamps::Timestamps;
use super::turn::Turn;

/// What a video file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct VideoInfo {
    /// Size of its pictures as they are stored, pixels, width then height.
    pub size: [u32; 2],
    /// Number of frames.
    pub frame_count: usize,
    /// How a player turns the pictures before it shows them.
    pub turn: Turn,
    /// Frames per second, where the file tells: on average where they came at a constant rate, else where none is missing.
    pub fps: Option<f64>,
    /// When each picture is to be shown, where the file tells.
    pub times: Option<Timestamps>,
    /// When the recording was made by the camera's own clock, to a second: as it is written, `2024-05-01T10:00:00.000000Z`.
    pub made: Option<String>,
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
    command.arg(
        "stream=width,height,nb_frames,avg_frame_rate,time_base:stream_side_data=displaymatrix:stream_tags=creation_time:\
         packet=pts_time,flags",
    );
    command.args(["-protocol_whitelist", "file", "-i"]).arg(file_url(path));
    let mut process = Process::spawn(command)?;
    let watch = process.watch(LONGEST_SILENCE)?;
    let (mut size, mut promised, mut turn, mut fps) = ([0_u32; 2], 0_usize, Turn::None, None);
    let (mut times, mut time, mut tick, mut made) = (Vec::new(), f64::NAN, 0.0, None);
    let (mut packets, mut discarded, mut corrupt) = (0_usize, 0_usize, 0_usize);
    for line in BufReader::new(&mut process.output).lines() {
        let line = line.with_context(|| format!("cannot read what ffprobe says of {}", path.display()))?;
        watch.heard();
        let Some((key, value)) = line.split_once('=') else { continue };
        let value = value.trim_matches('"');
        match key.rsplit('.').next() {
            // Written before the flags of the same packet.
            Some("pts_time") => time = value.parse().unwrap_or(f64::NAN),
            Some("flags") => {
                packets += 1;
                corrupt += usize::from(value.contains('C'));
                if value.contains('D') {
                    discarded += 1;
                } else {
                    times.push(time);
                }
                time = f64::NAN;
            }
            Some("width") => size[0] = value.parse().unwrap_or(0),
            Some("height") => size[1] = value.parse().unwrap_or(0),
            Some("nb_frames") => promised = value.parse().unwrap_or(0),
            Some("avg_frame_rate") => fps = rate(value),
            Some("time_base") => tick = rate(value).unwrap_or(0.0),
            // Its rows are told apart by an escaped end of a line.
            Some("displaymatrix") => turn = Turn::of_matrix(&value.replace("\\n", " ")).unwrap_or(Turn::None),
            Some("creation_time") => made = Some(value.to_string()),
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
    let times = Timestamps::of(times, tick);
    // Where pictures are missing the mean is the rate of no camera.
    let fps = times.as_ref().filter(|times| !times.is_regular()).map(Timestamps::usual_rate).or(fps);
    Ok(VideoInfo { size, frame_count: packets - discarded, turn, fps, times, made })
}

/// A rate as ffprobe writes it, `30000/1001`.
fn rate(text: &str) -> Option<f64> {
    let (count, seconds) = text.split_once('/')?;
    let rate = count.parse::<f64>().ok()? / seconds.parse::<f64>().ok()?;
    (rate.is_finite() && rate > 0.0).then_some(rate)
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
    /// Room for a picture whose colours come one plane after the other: green, blue, red. None where pixels come whole.
    planes: Option<Vec<u8>>,
    /// Which picture each frame is; none: its own.
    picks: Option<Picked>,
}

/// Frames that are picked out of the pictures that come.
#[derive(Debug)]
struct Picked {
    /// The number of each frame's picture, ascending.
    picks: Arc<[u32]>,
    /// The number of the picture that comes next.
    coming: u32,
    /// The picture that came last.
    last: Vec<u8>,
}

impl VideoDecoder {
    /// Starts decoding the frames of `range`, each delivered at `size` (width, height). `picks` holds the number of each frame's picture,
    /// ascending; without it they are the same.
    ///
    /// So many decoders, this one included, run side by side: each takes its share of the processors, since threads of a decoder cost more
    /// than they bring where all processors are at work anyway.
    ///
    /// Everything before the range is decoded and dropped: seeking by time lands on the wrong frame in files whose time
    /// stamps are not regular, and here frame A has to be the A-th picture of the file in every view.
    ///
    /// # Errors
    /// When ffmpeg is missing or cannot be started.
    pub(super) fn open(
        video: &Video,
        picks: Option<&Arc<[u32]>>,
        range: Range<usize>,
        size: [u32; 2],
        format: PixelFormat,
        side_by_side: usize,
    ) -> Result<Self> {
        let Some(picks) = picks else {
            let (first, count) = (range.start, range.len());
            return Self::select(video, &format!("gte(n\\,{first})"), count, range, size, (format, side_by_side));
        };
        let picked = picks.get(range.clone()).unwrap_or_default();
        let (Some(&first), Some(&last)) = (picked.first(), picked.last()) else {
            bail!("{} has no frames {}..{}", video.path.display(), range.start, range.end);
        };
        let count = (last - first) as usize + 1;
        let picks = Picked { picks: Arc::clone(picks), coming: first, last: Vec::new() };
        let which = format!("gte(n\\,{first})");
        let decoder = Self::select(video, &which, count, range, size, (format, side_by_side))?;
        Ok(Self { picks: Some(picks), ..decoder })
    }

    /// Starts decoding `count` frames of a file that has `total`, evenly spread, each delivered at `size`.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub(super) fn open_spread(video: &Video, total: usize, count: usize, size: [u32; 2]) -> Result<Self> {
        // Frame n is one of them where n count / total passes a whole number before the next frame.
        let select = format!("gt(floor((n+1)*{count}/{total})\\,floor(n*{count}/{total}))");
        Self::select(video, &select, count, 0..count, size, (PixelFormat::Rgb, 1))
    }

    /// Starts decoding the first `count` pictures that `select` lets through, for the frames of `range`.
    fn select(
        video: &Video,
        select: &str,
        count: usize,
        range: Range<usize>,
        size: [u32; 2],
        (format, side_by_side): (PixelFormat, usize),
    ) -> Result<Self> {
        let path = video.path.as_path();
        let program = ffmpeg_sidecar::paths::ffmpeg_path();
        let [width, height] = size;
        let stored = video.turn.turned(video.stored);
        let (pixels, channels) = match format {
            PixelFormat::Rgb if comes_in_planes(stored, size) => ("gbrp", 3),
            PixelFormat::Rgb => ("rgb24", 3),
            PixelFormat::Grey => ("gray", 1),
        };
        let frame_bytes = width as usize * height as usize * channels;
        let mut command = Command::new(&program);
        // A picture that could not be decoded would shift all later ones against the other views, so it ends the run.
        command.args(["-v", "error", "-nostdin", "-xerror", "-noautorotate"]);
        command.arg("-threads").arg(threads_of_one(side_by_side).to_string());
        // A change of format inside the file must not restart the count of `select`.
        command.args(["-reinit_filter", "0", "-protocol_whitelist", "file", "-i"]).arg(file_url(path));
        command.args(["-map", "0:v:0", "-an", "-sn", "-dn"]).args(passthrough_option(&program)?);
        // One conversion with rounding that does not depend on the processor's instruction set.
        command.arg("-vf").arg(format!(
            "select={select},{}scale={width}:{height}:flags=area+accurate_rnd+full_chroma_int+bitexact,format={pixels}",
            video.turn.filter()
        ));
        command.arg("-frames:v").arg(count.to_string()).args(["-bitexact", "-f", "rawvideo", "pipe:1"]);
        Ok(Self {
            path: path.to_path_buf(),
            process: Process::spawn(command)?,
            next: range.start,
            end: range.end,
            frame_bytes,
            planes: (pixels == "gbrp").then(|| vec![0; frame_bytes]),
            picks: None,
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
        let bytes = match &self.picks {
            None => self.next_picture(self.next)?,
            Some(picked) => {
                let wanted = picked.picks[self.next];
                self.picked(wanted)?
            }
        };
        self.next += 1;
        Ok(Some(bytes))
    }

    /// The picture of that number, which is the one that came last or one to come.
    fn picked(&mut self, wanted: u32) -> Result<Vec<u8>> {
        while let Some(coming) = self.picks.as_ref().map(|picked| picked.coming).filter(|coming| *coming <= wanted) {
            let bytes = self.next_picture(coming as usize)?;
            if let Some(picked) = &mut self.picks {
                (picked.coming, picked.last) = (coming + 1, bytes);
            }
        }
        Ok(self.picks.as_ref().map(|picked| picked.last.clone()).unwrap_or_default())
    }

    /// The picture that comes next, called `number` in messages.
    fn next_picture(&mut self, number: usize) -> Result<Vec<u8>> {
        let mut bytes = vec![0; self.frame_bytes];
        match self.process.output.read_exact(self.planes.as_mut().unwrap_or(&mut bytes)) {
            Ok(()) => {
                self.planes.iter().for_each(|planes| interleave(planes, &mut bytes));
                Ok(bytes)
            }
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => {
                let ended = self.process.finish();
                let last = self.picks.as_ref().map_or(self.end - 1, |picked| picked.picks[self.end - 1] as usize);
                Err(anyhow!(
                    "{}: decoding stopped before frame {number}, expected frames up to {last} (re-encoding the file may help): {ended}",
                    self.path.display(),
                ))
            }
            Err(error) => Err(error).with_context(|| format!("cannot read frame {number} of {}", self.path.display())),
        }
    }
}

/// Threads of one of so many decoders that run side by side. More than 16 bring nothing and cost memory.
fn threads_of_one(side_by_side: usize) -> usize {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    (processors / side_by_side.max(1)).clamp(1, 16)
}

/// Whether colours are asked for plane by plane. ffmpeg's scaler adds up the rows of a pixel by the same whole numbers then, but in vector
/// code. Of two rows or fewer, whole pixels take short cuts of their own; a picture that is made less than half as high has more.
fn comes_in_planes(stored: [u32; 2], size: [u32; 2]) -> bool {
    2 * u64::from(size[1]) < u64::from(stored[1])
}

/// Pixels of red, green and blue from planes of green, blue and red.
#[multiversion::multiversion(targets("x86_64+avx2"))]
fn interleave(planes: &[u8], pixels: &mut [u8]) {
    let (green, rest) = planes.split_at(planes.len() / 3);
    let (blue, red) = rest.split_at(rest.len() / 2);
    let (pixels, _) = pixels.as_chunks_mut::<3>();
    for (((pixel, &red), &green), &blue) in pixels.iter_mut().zip(red).zip(green).zip(blue) {
        *pixel = [red, green, blue];
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

//! Cameras and streams, through ffmpeg: pictures as they come, put together by when they arrived.

use std::io::{ErrorKind, Read};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow, bail, ensure};
use image::{GrayImage, RgbImage};

use super::frames::FrameSet;
use super::live_options;
use super::manifest::Sequence;
use super::player::Captured;
use super::program::{Process, Stopper};
use super::source::{LiveSource, Source};
use super::video::passthrough_option;

/// Pictures on their way from the views' threads: room for two of each view.
const ON_THEIR_WAY: usize = 2;

/// Reads live views. A set is a picture of every view whose arrivals lie within half a frame; of each view the newest
/// picture counts, one that was not matched by then is passed over. Dropping the reader ends threads and decoders.
#[derive(Debug)]
pub struct LiveReader {
    views: Vec<LiveView>,
    arrivals: Receiver<Arrival>,
    /// What every set ignores, one a view.
    ignored: Vec<Option<Arc<GrayImage>>>,
    fps: f64,
    stall_timeout: Duration,
    /// The first set's capture and its index.
    zero: Option<Instant>,
    next: usize,
    first: usize,
    last_set: Instant,
    unmatched: u64,
    ended: Option<String>,
}

#[derive(Debug)]
struct LiveView {
    camera: String,
    decoder: Stopper,
    thread: Option<JoinHandle<()>>,
    complained: Arc<AtomicU64>,
    heard: Instant,
    waiting: Option<(Instant, RgbImage)>,
}

#[derive(Debug)]
struct Arrival {
    view: usize,
    at: Instant,
    /// A picture; or how the source ended.
    picture: Result<RgbImage, End>,
}

#[derive(Debug)]
enum End {
    /// After pictures that came well.
    Ended(String),
    /// Nothing usable ever came.
    Failed(anyhow::Error),
}

impl Sequence {
    /// Opens all live views; sets are numbered from `first` by their time of capture.
    ///
    /// # Errors
    /// When a view is not live, or ffmpeg cannot be started.
    pub fn read_live(&self, first: usize, stall_timeout: Duration) -> Result<LiveReader> {
        let (sender, arrivals) = sync_channel(self.views.len() * ON_THEIR_WAY);
        let now = Instant::now();
        let mut reader = LiveReader {
            views: Vec::new(),
            arrivals,
            ignored: Vec::new(),
            fps: self.fps,
            stall_timeout,
            zero: None,
            next: first,
            first,
            last_set: now,
            unmatched: 0,
            ended: None,
        };
        for (index, (view, &size)) in self.views.iter().zip(&self.sizes).enumerate() {
            let Source::Live(source) = &view.source else {
                bail!("camera {:?} is not live, expected all views to be", view.camera);
            };
            let ignored = view.ignored.as_ref().map(|ignored| ignored.frames(size)?.of_frame(first, size));
            reader.ignored.push(ignored.transpose()?);
            let process = Process::spawn(command(source, self.scale)?)?;
            let (decoder, complained) = (process.stopper(), process.complained());
            let name = format!("camera {:?} ({})", view.camera, source.address);
            let sender = sender.clone();
            let thread = thread::Builder::new()
                .name(format!("capture {}", view.camera))
                .spawn(move || send_all(process, index, size, &name, &sender))
                .context("cannot start a thread to capture pictures")?;
            reader.views.push(LiveView {
                camera: view.camera.clone(),
                decoder,
                thread: Some(thread),
                complained,
                heard: now,
                waiting: None,
            });
        }
        Ok(reader)
    }
}

/// Pictures with their size before each, so that a camera that delivers another one is noticed.
fn command(source: &LiveSource, scale: f64) -> Result<Command> {
    let program = ffmpeg_sidecar::paths::ffmpeg_path();
    let mut command = Command::new(&program);
    // What arrives damaged is left out and complained about; nothing is held back.
    command.args([
        "-v",
        "error",
        "-nostdin",
        "-noautorotate",
        "-fflags",
        "+nobuffer+discardcorrupt",
        "-flags",
        "low_delay",
    ]);
    command.args(&source.input).args(["-protocol_whitelist", live_options::PROTOCOLS]).arg("-i").arg(&source.address);
    command.args(["-map", "0:v:0", "-an", "-sn", "-dn"]).args(passthrough_option(&program)?);
    let side = |of: &str| format!("max(round({of}*{scale})\\,1)");
    command.arg("-vf").arg(format!("scale={}:{}:flags=area+accurate_rnd,format=rgb24", side("iw"), side("ih")));
    command.args(["-c:v", "ppm", "-f", "image2pipe", "-flush_packets", "1", "pipe:1"]);
    Ok(command)
}

/// Reads a source until it ends or nobody listens.
fn send_all(mut process: Process, view: usize, size: [u32; 2], name: &str, sender: &SyncSender<Arrival>) {
    let mut count = 0_u64;
    loop {
        let picture = match read_ppm(&mut process.output, size, name) {
            Ok(Some(picture)) => Ok(picture),
            Ok(None) => {
                let ended = process.finish();
                Err(match count {
                    0 => End::Failed(anyhow!("{name} delivered no picture: {ended}")),
                    _ if ended.success() => End::Ended(format!("{name} ended after {count} pictures")),
                    _ => End::Ended(format!("{name} broke off after {count} pictures: {ended}")),
                })
            }
            Err(error) => Err(End::Failed(error)),
        };
        count += 1;
        let is_last = picture.is_err();
        if sender.send(Arrival { view, at: Instant::now(), picture }).is_err() || is_last {
            return;
        }
    }
}

/// Longest header of a PPM that ffmpeg writes.
const LONGEST_HEADER: usize = 40;

/// The next picture of a stream of PPM files; `None` at its end, be it in the middle of a picture.
fn read_ppm(stream: &mut impl Read, size: [u32; 2], name: &str) -> Result<Option<RgbImage>> {
    // Byte by byte, three lines: nothing may be read ahead that the next picture needs.
    let mut header = Vec::with_capacity(LONGEST_HEADER);
    while header.iter().filter(|byte| **byte == b'\n').count() < 3 {
        let mut byte = [0];
        if !whole(stream.read_exact(&mut byte), name)? {
            return Ok(None);
        }
        header.push(byte[0]);
        ensure!(header.len() <= LONGEST_HEADER, "{name}: ffmpeg sent something that is no picture");
    }
    let text = String::from_utf8_lossy(&header);
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    let number = |at: usize| words.get(at).and_then(|word| word.parse::<u32>().ok());
    let (Some(&"P6"), Some(width), Some(height), Some(255)) = (words.first(), number(1), number(2), number(3)) else {
        bail!("{name}: ffmpeg sent something that is no picture: {text:?}");
    };
    ensure!(
        [width, height] == size,
        "{name} delivers pictures of {width}x{height} pixels at the working scale, expected {}x{} as it is calibrated",
        size[0],
        size[1]
    );
    let mut bytes = vec![0; width as usize * height as usize * 3];
    Ok(if whole(stream.read_exact(&mut bytes), name)? { RgbImage::from_raw(width, height, bytes) } else { None })
}

/// Whether a read got all it asked for; not so at the end of the stream.
fn whole(read: std::io::Result<()>, name: &str) -> Result<bool> {
    match read {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(error).with_context(|| format!("cannot read from {name}")),
    }
}

impl LiveReader {
    /// Pictures that no set was made of.
    pub fn unmatched(&self) -> u64 {
        self.unmatched
    }

    /// Lines with which the decoders complained: damaged pictures, most of all.
    pub fn complaints(&self) -> u64 {
        self.views.iter().map(|view| view.complained.load(Ordering::Relaxed)).sum()
    }

    /// Which source ended the stream, and how.
    pub fn ended(&self) -> Option<&str> {
        self.ended.as_deref()
    }

    /// The next set; `None` when a source has ended.
    ///
    /// # Errors
    /// When a view delivers nothing, or nothing in time; when pictures come but never within half a frame of each other.
    pub fn next_set(&mut self) -> Result<Option<Captured>> {
        loop {
            let silent_since = self.views.iter().map(|view| view.heard).min().unwrap_or(self.last_set);
            let patience = (silent_since + self.stall_timeout).saturating_duration_since(Instant::now());
            match self.arrivals.recv_timeout(patience) {
                Ok(Arrival { view, at, picture: Ok(picture) }) => {
                    let view = &mut self.views[view];
                    view.heard = at;
                    self.unmatched += u64::from(view.waiting.replace((at, picture)).is_some());
                }
                Ok(Arrival { picture: Err(End::Ended(how)), .. }) => {
                    self.ended = Some(how);
                    return Ok(None);
                }
                Ok(Arrival { picture: Err(End::Failed(error)), .. }) => return Err(error),
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
                Err(RecvTimeoutError::Timeout) => return Err(self.stalled()),
            }
            if let Some(set) = self.matched() {
                return Ok(Some(set));
            }
            // A view that has been silent for a while is about to be called stalled: that, and not its clock, is what is wrong.
            let all_deliver = self.views.iter().all(|view| view.heard.elapsed() < self.stall_timeout / 2);
            ensure!(
                self.last_set.elapsed() < self.stall_timeout || !all_deliver,
                "pictures of all cameras came, but for {:.1} s never within half a frame of each other (fps is {})",
                self.stall_timeout.as_secs_f64(),
                self.fps
            );
        }
    }

    fn stalled(&self) -> anyhow::Error {
        let silent = self.views.iter().min_by_key(|view| view.heard);
        anyhow!(
            "camera {:?} stalled: it delivered no picture for {:.1} s (--stall-timeout)",
            silent.map_or("", |view| view.camera.as_str()),
            self.stall_timeout.as_secs_f64()
        )
    }

    /// The waiting pictures as a set, when they belong together.
    fn matched(&mut self) -> Option<Captured> {
        let arrivals: Option<Vec<Instant>> = self.views.iter().map(|view| Some(view.waiting.as_ref()?.0)).collect();
        let arrivals = arrivals?;
        let (first, last) = (*arrivals.iter().min()?, *arrivals.iter().max()?);
        if (last - first).as_secs_f64() > 0.5 / self.fps {
            return None;
        }
        let pictures: Vec<RgbImage> = self.views.iter_mut().filter_map(|view| Some(view.waiting.take()?.1)).collect();
        let zero = *self.zero.get_or_insert(first);
        let elapsed = (first.saturating_duration_since(zero).as_secs_f64() * self.fps).round() as usize;
        let index = (self.first + elapsed).max(self.next);
        self.next = index + 1;
        self.last_set = last;
        let masks = vec![None; pictures.len()];
        let ignored = self.ignored.clone();
        Some(Captured { set: FrameSet { index, pictures, masks, ignored }, at: first })
    }
}

impl Drop for LiveReader {
    fn drop(&mut self) {
        // A thread ends when its decoder does, or when its next picture finds no room and then no listener.
        self.views.iter().for_each(|view| view.decoder.stop());
        let (_, nobody) = sync_channel(0);
        drop(std::mem::replace(&mut self.arrivals, nobody));
        for view in &mut self.views {
            if let Some(thread) = view.thread.take() {
                let _ = thread.join();
            }
        }
    }
}

#[cfg(test)]
#[path = "live_tests.rs"]
mod tests;

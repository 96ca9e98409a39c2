//! One live view: the ffmpeg that opens it, and the thread that sends on what it delivers.

use std::io::{ErrorKind, Read};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::SyncSender;
use std::thread::{self, JoinHandle};
use std::time::Instant;

use anyhow::{Context, Result, anyhow, bail, ensure};
use image::RgbImage;

use super::live_options;
use super::program::{Process, Stopper};
use super::source::LiveSource;
use super::video::passthrough_option;

/// A decoder and the thread that reads it.
#[derive(Debug)]
pub(super) struct Capture {
    decoder: Stopper,
    thread: Option<JoinHandle<()>>,
    complained: Arc<AtomicU64>,
    /// When it was opened.
    pub(super) begin: Instant,
    pub(super) is_given_up: bool,
}

/// What a view's thread sends.
#[derive(Debug)]
pub(super) struct Arrival {
    pub(super) view: usize,
    pub(super) at: Instant,
    /// A picture; or how the source ended.
    pub(super) picture: Result<RgbImage, End>,
}

/// How a source ended.
#[derive(Debug)]
pub(super) enum End {
    /// After pictures that came well.
    Ended(String),
    /// Nothing usable ever came.
    Failed(anyhow::Error),
}

impl Capture {
    /// Opens the source of view `index`.
    pub(super) fn begin(
        index: usize,
        size: [u32; 2],
        name: &str,
        source: &LiveSource,
        scale: f64,
        sender: &SyncSender<Arrival>,
    ) -> Result<Self> {
        let process = Process::spawn(command(source, scale)?)?;
        let (decoder, complained) = (process.stopper(), process.complained());
        let (sender, name) = (sender.clone(), name.to_string());
        let thread = thread::Builder::new()
            .name(format!("capture {index}"))
            .spawn(move || send_all(process, index, size, &name, &sender))
            .context("cannot start a thread to capture pictures")?;
        Ok(Self { decoder, thread: Some(thread), complained, begin: Instant::now(), is_given_up: false })
    }

    /// Ends a decoder that is silent.
    pub(super) fn give_up(&mut self) {
        self.is_given_up = true;
        self.decoder.stop();
    }

    /// Lines with which its decoder complained.
    pub(super) fn complaints(&self) -> u64 {
        self.complained.load(Ordering::Relaxed)
    }

    /// What it complained of was no picture.
    pub(super) fn forget_complaints(&self) {
        self.complained.store(0, Ordering::Relaxed);
    }
}

impl Drop for Capture {
    /// Its thread ends when its decoder does, or when its next picture finds no room and then no listener.
    fn drop(&mut self) {
        self.decoder.stop();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
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

#[cfg(test)]
mod tests {
    use super::*;

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
}

//! A recorded sequence played at its frame rate, as if its cameras delivered it now (METHOD A11).

use std::ops::Range;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Result, ensure};

use super::frames::{FrameReader, FrameSet};
use super::manifest::Sequence;

/// The next round's decoders are started this many frames before it begins.
const START_AHEAD: usize = 25;

/// One moment of all cameras and when it was captured.
#[derive(Debug)]
pub struct Captured {
    /// The pictures; their index is that of the run: it goes on over the rounds of a loop.
    pub set: FrameSet,
    /// The moment of capture: a recorded frame's turn; of live pictures, the first one's arrival.
    pub at: Instant,
    /// The views that delivered nothing (live ones alone): their pictures are black, and all of their pixels ignored.
    pub silent: Vec<usize>,
}

/// How a recorded sequence is played.
#[derive(Clone, Debug, PartialEq)]
pub struct Playback {
    /// Its frames.
    pub range: Range<usize>,
    /// Frames a second.
    pub fps: f64,
    /// Frames to play, as many rounds of the range as that takes.
    pub frames: usize,
    /// Frames of them to leave out at the beginning (a run that is gone on with).
    pub skip: usize,
    /// How long a view may take for a picture.
    pub stall_timeout: Duration,
}

/// Plays a sequence. Frame k of the run is captured k intervals after the first; when a frame could not be read by then, its
/// capture is the moment it was there and all later ones are that much later.
#[derive(Debug)]
pub struct Player {
    sequence: Sequence,
    playback: Playback,
    /// Frames played or left out.
    position: usize,
    reader: Option<FrameReader>,
    upcoming: Option<FrameReader>,
    due: Option<Instant>,
    late: u64,
}

impl Player {
    /// Starts the decoders.
    ///
    /// # Errors
    /// When the range is empty or not the sequence's, the rate is no rate, or a decoder cannot be started.
    pub fn start(sequence: &Sequence, playback: Playback) -> Result<Self> {
        let Playback { range, fps, skip, .. } = &playback;
        ensure!(!range.is_empty(), "there is nothing to play in the frames {}..{}", range.start, range.end);
        ensure!(*fps > 0.0 && fps.is_finite(), "the rate is {fps} frames/s, expected a positive number");
        let position = *skip;
        let mut player =
            Self { sequence: sequence.clone(), playback, position, reader: None, upcoming: None, due: None, late: 0 };
        let within = position % player.playback.range.len();
        player.reader = Some(player.open(within)?);
        Ok(player)
    }

    fn open(&self, within: usize) -> Result<FrameReader> {
        let Range { start, end } = self.playback.range;
        Ok(self.sequence.read_frames(start + within..end)?.with_stall_timeout(self.playback.stall_timeout))
    }

    /// Frames that were not read by their turn.
    pub fn late(&self) -> u64 {
        self.late
    }

    /// The next frame, at its moment; `None` after the last.
    ///
    /// # Errors
    /// As [`FrameReader::next_frame`].
    pub fn next_frame(&mut self) -> Result<Option<Captured>> {
        let length = self.playback.range.len();
        if self.position >= self.playback.frames {
            return Ok(None);
        }
        let within = self.position % length;
        let reader = match self.reader.take() {
            Some(reader) => reader,
            None => self.upcoming.take().map_or_else(|| self.open(within), Ok)?,
        };
        let reader = self.reader.insert(reader);
        let Some(mut set) = reader.next_frame()? else { return Ok(None) };
        set.index = self.playback.range.start + self.position;
        if within + 1 == length {
            self.reader = None;
        }
        self.position += 1;
        let to_next_round = length - within;
        if self.upcoming.is_none()
            && to_next_round <= START_AHEAD
            && self.position - 1 + to_next_round < self.playback.frames
        {
            self.upcoming = Some(self.open(0)?);
        }
        let interval = Duration::from_secs_f64(1.0 / self.playback.fps);
        let now = Instant::now();
        let due = self.due.unwrap_or(now);
        let at = if now > due + interval / 2 {
            self.late += 1;
            now
        } else {
            thread::sleep(due.saturating_duration_since(now));
            due
        };
        self.due = Some(at + interval);
        Ok(Some(Captured { set, at, silent: Vec::new() }))
    }
}

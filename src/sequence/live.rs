//! Cameras and streams, through ffmpeg: pictures as they come, put together by when they arrived.

use std::cmp::Reverse;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::{Duration, Instant};

use anyhow::{Result, bail, ensure};
use image::{GrayImage, Luma, RgbImage};

use super::frames::FrameSet;
use super::live_capture::{Arrival, Capture, End};
use super::live_matching::Matching;
use super::manifest::Sequence;
use super::player::Captured;
use super::source::{LiveSource, Source};

/// Pictures on their way from the views' threads: room for two of each view.
const ON_THEIR_WAY: usize = 2;
/// A view is silent when it delivered nothing for so many of its intervals, and for so long, while others did.
const SILENT_INTERVALS: f64 = 4.0;
const SILENT: Duration = Duration::from_millis(500);
/// An interval is a mean that moves by this much of what is new, and of a longer one by what this one is.
const INTERVAL_GAIN: f64 = 0.125;
const LONGEST_INTERVAL: Duration = Duration::from_secs(2);
/// A set is of so many views at least, where there are as many: a single one does not tell a pose.
const FEWEST: usize = 2;
/// A source that broke off is opened again after so long,
const OPENED_AFTER: Duration = Duration::from_secs(2);
/// and a connection that delivers nothing for so long is given up for that.
const GIVEN_UP_AFTER: Duration = Duration::from_secs(10);

/// Reads live views. A set is a picture of every view that arrived as close together as the cameras offer; of each view the newest
/// picture counts, one that was not matched by then is passed over. A view that falls silent after the first set is left out of the sets
/// until it delivers again. Dropping the reader ends threads and decoders.
#[derive(Debug)]
pub struct LiveReader {
    views: Vec<LiveView>,
    arrivals: Receiver<Arrival>,
    /// Handed to the thread of a view that is opened again.
    sender: SyncSender<Arrival>,
    scale: f64,
    fps: f64,
    matching: Matching,
    stall_timeout: Duration,
    /// The first set's capture and its index.
    zero: Option<Instant>,
    next: usize,
    first: usize,
    last_set: Instant,
    unmatched: u64,
    ended: Option<String>,
    news: Vec<String>,
}

#[derive(Debug)]
struct LiveView {
    name: String,
    camera: String,
    source: LiveSource,
    size: [u32; 2],
    /// What every set ignores of it.
    ignored: Option<Arc<GrayImage>>,
    /// All of its pixels.
    all: Arc<GrayImage>,
    capture: Capture,
    /// Lines with which decoders complained that have ended.
    complained: u64,
    /// When it delivered last, or was first opened.
    heard: Instant,
    /// Between its pictures, s.
    interval: f64,
    /// Its newest picture, while no set was made of it.
    waiting: Option<RgbImage>,
    /// Whether the newest set is without it.
    is_left_out: bool,
    /// How its source ended, while it is not open.
    end: Option<Broken>,
}

/// A source that ended.
#[derive(Debug)]
struct Broken {
    how: String,
    /// When it is opened again; never, if that would play it from its beginning.
    again: Option<Instant>,
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
            sender,
            scale: self.scale,
            fps: self.fps,
            matching: Matching::new(self.fps),
            stall_timeout,
            zero: None,
            next: first,
            first,
            last_set: now,
            unmatched: 0,
            ended: None,
            news: Vec::new(),
        };
        for (index, (view, &size)) in self.views.iter().zip(&self.sizes).enumerate() {
            let Source::Live(source) = &view.source else {
                bail!("camera {:?} is not live, expected all views to be", view.camera);
            };
            let ignored = view.ignored.as_ref().map(|ignored| ignored.frames(size)?.of_frame(first, size));
            let name = format!("camera {:?} ({})", view.camera, source.address);
            reader.views.push(LiveView {
                capture: Capture::begin(index, size, &name, source, self.scale, &reader.sender)?,
                name,
                camera: view.camera.clone(),
                source: source.clone(),
                size,
                ignored: ignored.transpose()?,
                all: Arc::new(GrayImage::from_pixel(size[0], size[1], Luma([u8::MAX]))),
                complained: 0,
                heard: now,
                interval: self.fps.recip(),
                waiting: None,
                is_left_out: false,
                end: None,
            });
        }
        Ok(reader)
    }
}

impl LiveReader {
    /// Pictures that no set was made of.
    pub fn unmatched(&self) -> u64 {
        self.unmatched
    }

    /// What the pictures of a set lay apart on average, s; of no set nothing.
    pub fn apart(&self) -> Option<f64> {
        self.matching.apart()
    }

    /// Lines with which the decoders complained: damaged pictures, most of all.
    pub fn complaints(&self) -> u64 {
        self.views.iter().map(|view| view.complained + view.capture.complaints()).sum()
    }

    /// Which source ended the stream, and how.
    pub fn ended(&self) -> Option<&str> {
        self.ended.as_deref()
    }

    /// Sentences that were not told yet: which views are left out from now on, and which are there again.
    pub fn take_news(&mut self) -> Vec<String> {
        std::mem::take(&mut self.news)
    }

    /// The next set; `None` when too few sources are left.
    ///
    /// # Errors
    /// Before the first set, when a view delivers nothing, or nothing in time; afterwards when fewer than two do (one, where there is no other);
    /// when pictures come but never within a frame of each other.
    pub fn next_set(&mut self) -> Result<Option<Captured>> {
        loop {
            self.open_again()?;
            match self.arrivals.recv_timeout(self.patience()) {
                Ok(arrival) => self.take(arrival)?,
                Err(_) if self.stalls_at() <= Instant::now() => match self.last_needed() {
                    Some(LiveView { end: Some(end), .. }) => self.ended = Some(end.how.clone()),
                    view => {
                        let camera = view.map_or("", |view| view.camera.as_str());
                        let seconds = self.stall_timeout.as_secs_f64();
                        bail!(
                            "camera {camera:?} stalled: it delivered no picture for {seconds:.1} s (--stall-timeout)"
                        );
                    }
                },
                // It is time to open a source again.
                Err(_) => continue,
            }
            // Before a view is called silent, all that has come is looked at.
            while self.views.iter().any(|view| self.is_silent(view))
                && let Ok(arrival) = self.arrivals.try_recv()
            {
                self.take(arrival)?;
            }
            if self.ended.is_some() {
                return Ok(None);
            }
            if let Some(set) = self.matched() {
                return Ok(Some(set));
            }
            // A view that has been silent for a while is about to be called stalled: that, and not its clock, is what is wrong.
            let delivering = self.views.iter().filter(|view| view.heard.elapsed() < self.stall_timeout / 2).count();
            ensure!(
                self.last_set.elapsed() < self.stall_timeout || delivering < self.needed(),
                "pictures of all cameras came, but for {:.1} s never within a frame of each other (fps is {})",
                self.stall_timeout.as_secs_f64(),
                self.fps
            );
        }
    }

    /// Takes what arrived; the end of a source may be that of the stream.
    fn take(&mut self, Arrival { view: index, at, picture }: Arrival) -> Result<()> {
        let has_begun = self.zero.is_some();
        let view = &mut self.views[index];
        let how = match picture {
            Ok(picture) => {
                if has_begun {
                    let interval = at.saturating_duration_since(view.heard).min(LONGEST_INTERVAL).as_secs_f64();
                    view.interval += INTERVAL_GAIN * (interval - view.interval);
                }
                view.heard = at;
                self.unmatched += u64::from(view.waiting.replace(picture).is_some());
                return Ok(());
            }
            Err(End::Ended(_)) if view.capture.is_given_up => format!("{} fell silent", view.name),
            Err(End::Ended(how)) => how,
            Err(End::Failed(error)) if has_begun => {
                // What a source that cannot be opened complains of is no damaged picture.
                view.capture.forget_complaints();
                format!("{error:#}")
            }
            Err(End::Failed(error)) => return Err(error),
        };
        let again = view.source.may_return().then(|| Instant::now() + OPENED_AFTER);
        view.end = Some(Broken { how: how.clone(), again });
        let open = self.views.iter().filter(|view| view.end.is_none()).count();
        let may_deliver = self.views.iter().filter(|view| view.end.as_ref().is_none_or(|end| end.again.is_some()));
        if !has_begun || open == 0 || may_deliver.count() < self.needed() {
            self.ended = Some(how);
        }
        Ok(())
    }

    /// Opens sources again whose time has come, and gives up connections that are silent.
    fn open_again(&mut self) -> Result<()> {
        let now = Instant::now();
        for (index, view) in self.views.iter_mut().enumerate() {
            match &view.end {
                Some(Broken { again: Some(again), .. }) if *again <= now => {
                    let (name, source) = (&view.name, &view.source);
                    view.complained += view.capture.complaints();
                    view.capture = Capture::begin(index, view.size, name, source, self.scale, &self.sender)?;
                    view.end = None;
                }
                None if self.zero.is_some() && view.given_up_at().is_some_and(|moment| moment <= now) => {
                    view.capture.give_up();
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// How long nothing need arrive before something is to be done.
    fn patience(&self) -> Duration {
        let to_open = |view: &LiveView| match &view.end {
            Some(end) => end.again,
            None => view.given_up_at(),
        };
        let now = Instant::now();
        let opened = self.views.iter().filter_map(to_open).filter(|moment| *moment > now).min();
        let stalled = self.stalls_at();
        opened.map_or(stalled, |opened| opened.min(stalled)).saturating_duration_since(now)
    }

    /// Views that must deliver.
    fn needed(&self) -> usize {
        if self.zero.is_some() { FEWEST.min(self.views.len()) } else { self.views.len() }
    }

    /// The view that was heard longest ago of as many as must deliver, those that were heard last.
    fn last_needed(&self) -> Option<&LiveView> {
        let mut views: Vec<&LiveView> = self.views.iter().collect();
        views.sort_by_key(|view| Reverse(view.heard));
        views.get(self.needed() - 1).copied()
    }

    /// When the stream is given up, unless something is heard of that view.
    fn stalls_at(&self) -> Instant {
        self.last_needed().map_or(self.last_set, |view| view.heard) + self.stall_timeout
    }

    /// Whether a view has delivered nothing for a while in which others did. Before the first set none is.
    fn is_silent(&self, view: &LiveView) -> bool {
        let newest = self.views.iter().map(|view| view.heard).max().unwrap_or(view.heard);
        let silent = SILENT.max(Duration::from_secs_f64(SILENT_INTERVALS * view.interval));
        self.zero.is_some() && newest - view.heard > silent
    }

    /// The waiting pictures as a set, when they belong together.
    fn matched(&mut self) -> Option<Captured> {
        let silent: Vec<usize> = (0..self.views.len()).filter(|&view| self.is_silent(&self.views[view])).collect();
        if self.views.len() - silent.len() < self.needed() {
            return None;
        }
        let delivering = || self.views.iter().enumerate().filter(|(index, _)| !silent.contains(index));
        let all_wait = delivering().all(|(_, view)| view.waiting.is_some());
        if self.zero.is_none() && !all_wait {
            return None;
        }
        let newest: Vec<Instant> = delivering().map(|(_, view)| view.heard).collect();
        let times = self.matching.of_one_frame(&newest).filter(|_| all_wait)?;
        self.matching.took(times);
        let [first, last] = times;
        let zero = *self.zero.get_or_insert(first);
        let elapsed = (first.saturating_duration_since(zero).as_secs_f64() * self.fps).round() as usize;
        let index = (self.first + elapsed).max(self.next);
        self.next = index + 1;
        self.last_set = last;
        let mut set = FrameSet { index, pictures: Vec::new(), masks: Vec::new(), ignored: Vec::new() };
        for (at, view) in self.views.iter_mut().enumerate() {
            let is_silent = silent.contains(&at);
            self.news.extend(view.leave_out(is_silent, index));
            let waiting = view.waiting.take();
            self.unmatched += u64::from(is_silent && waiting.is_some());
            let [width, height] = view.size;
            let picture = waiting.filter(|_| !is_silent).unwrap_or_else(|| RgbImage::new(width, height));
            set.pictures.push(picture);
            set.masks.push(None);
            set.ignored.push(if is_silent { Some(Arc::clone(&view.all)) } else { view.ignored.clone() });
        }
        Some(Captured { set, at: first, silent })
    }
}

impl LiveView {
    /// When a connection is given up, unless it delivers before.
    fn given_up_at(&self) -> Option<Instant> {
        let may_be = self.source.is_connection() && !self.capture.is_given_up;
        may_be.then(|| self.heard.max(self.capture.begin) + GIVEN_UP_AFTER)
    }

    /// Has sets from this one on be without it, or with it; a sentence where that is news.
    fn leave_out(&mut self, is_left_out: bool, frame: usize) -> Option<String> {
        if is_left_out == std::mem::replace(&mut self.is_left_out, is_left_out) {
            return None;
        }
        let name = &self.name;
        Some(match &self.end {
            _ if !is_left_out => format!("{name} delivers again: frames from {frame} on are tracked with it"),
            Some(Broken { how, again: None }) => format!("{how}; frames from {frame} on are tracked without it"),
            Some(Broken { how, .. }) => {
                format!("{how}; frames from {frame} on are tracked without it until it delivers again")
            }
            None => format!(
                "{name} delivers nothing; frames from {frame} on are tracked without it until it delivers again"
            ),
        })
    }
}

impl Drop for LiveReader {
    /// Threads that wait for room must find that nobody listens.
    fn drop(&mut self) {
        let (_, nobody) = sync_channel(0);
        drop(std::mem::replace(&mut self.arrivals, nobody));
    }
}

#[cfg(test)]
#[path = "live_tests.rs"]
mod tests;

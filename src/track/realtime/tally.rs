//! What a run in real time is judged by: rates, ages of poses, what was left out.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde::Serialize;

use super::RealtimeSettings;
use crate::live::SentSummary;
use crate::track::histogram::Histogram;

/// What the modules in front of the tracker count.
#[derive(Debug, Default)]
pub(super) struct Counts {
    /// Sets of pictures captured.
    pub(super) captured: AtomicU64,
    /// Pictures of live views that no set was made of.
    pub(super) unmatched: AtomicU64,
    /// Recorded frames that could not be read by their turn.
    pub(super) late: AtomicU64,
    /// Lines in which live decoders complained.
    pub(super) complaints: AtomicU64,
    /// Sets passed over before processing, a newer one being there.
    pub(super) not_processed: AtomicU64,
    /// Processed sets passed over before tracking.
    pub(super) not_tracked: AtomicU64,
    /// What the pictures of a live set lay apart, s.
    apart: Mutex<Option<f64>>,
    first_and_last: Mutex<Option<[Instant; 2]>>,
    ended: Mutex<Option<String>>,
    news: Mutex<Vec<String>>,
}

impl Counts {
    /// A set was captured.
    pub(super) fn capture(&self, at: Instant) {
        self.captured.fetch_add(1, Ordering::Relaxed);
        lock(&self.first_and_last).get_or_insert([at; 2])[1] = at;
    }

    /// What the pictures of a live set lay apart on average by now, s.
    pub(super) fn set_apart(&self, apart: Option<f64>) {
        *lock(&self.apart) = apart;
    }

    /// A source ended the run.
    pub(super) fn end(&self, how: &str) {
        lock(&self.ended).get_or_insert_with(|| how.to_string());
    }

    /// Something happened to the sources that the user should know.
    pub(super) fn add_news(&self, news: Vec<String>) {
        lock(&self.news).extend(news);
    }

    /// What happened since this was asked before.
    pub(super) fn take_news(&self) -> Vec<String> {
        std::mem::take(&mut *lock(&self.news))
    }

    /// How a source ended the run.
    pub(super) fn ended(&self) -> Option<String> {
        lock(&self.ended).clone()
    }
}

/// Plain values, never left half changed.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What the tracker counts.
#[derive(Debug, Default)]
pub(super) struct Tally {
    latency: Histogram,
    in_time: u64,
    evaluations: u64,
    first_and_last: Option<[Instant; 2]>,
    pub(super) fitness: f64,
    pub(super) confidence: f64,
}

impl Tally {
    /// A search scored so many poses.
    pub(super) fn searched(&mut self, evaluations: usize) {
        self.evaluations += evaluations as u64;
    }

    /// A pose of pictures captured at `captured` is out now.
    pub(super) fn deliver(&mut self, captured: Instant, deadline: Option<Duration>) {
        let now = Instant::now();
        let latency = now.saturating_duration_since(captured);
        self.latency.add(latency);
        self.in_time += u64::from(deadline.is_some_and(|deadline| latency <= deadline));
        self.first_and_last.get_or_insert([now; 2])[1] = now;
    }

    /// Poses so far.
    pub(super) fn poses(&self) -> u64 {
        self.latency.count()
    }

    /// All of it.
    pub(super) fn summary(&self, counts: &Counts, settings: &RealtimeSettings, error: Option<f64>) -> RealtimeSummary {
        let get = |count: &AtomicU64| count.load(Ordering::Relaxed);
        let captured = get(&counts.captured);
        let poses = self.poses();
        let rate = |count: u64, times: Option<[Instant; 2]>| {
            let seconds = times.map_or(0.0, |[first, last]| (last - first).as_secs_f64());
            if seconds > 0.0 { count.saturating_sub(1) as f64 / seconds } else { 0.0 }
        };
        let share = |part: u64| if poses > 0 { part as f64 / poses as f64 } else { 0.0 };
        let quantile = |share| self.latency.quantile(share);
        RealtimeSummary {
            input_fps: rate(captured, *lock(&counts.first_and_last)),
            output_fps: rate(poses, self.first_and_last),
            captured,
            poses,
            latency_ms: LatencySummary {
                p50: quantile(0.5),
                p90: quantile(0.9),
                p99: quantile(0.99),
                max: quantile(1.0),
            },
            deadline_ms: settings.deadline.map(|deadline| deadline.as_secs_f64() * 1e3),
            in_time: settings.deadline.map(|_| share(self.in_time)),
            delay: settings.delay,
            evaluations: share(self.evaluations),
            drops: Drops {
                acquisition: get(&counts.unmatched),
                processing: get(&counts.not_processed),
                tracking: get(&counts.not_tracked),
            },
            late: get(&counts.late),
            complaints: get(&counts.complaints),
            apart_ms: lock(&counts.apart).map(|apart| 1e3 * apart),
            ended: counts.ended(),
            error_mm: error,
            sent: Vec::new(),
        }
    }
}

/// How well a run kept time; realtime.json.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RealtimeSummary {
    /// Sets of pictures captured a second.
    pub input_fps: f64,
    /// Poses a second.
    pub output_fps: f64,
    /// Sets captured.
    pub captured: u64,
    /// Poses.
    pub poses: u64,
    /// Age of a pose when it was out, from the capture of its pictures.
    pub latency_ms: LatencySummary,
    /// The deadline, where there was one.
    pub deadline_ms: Option<f64>,
    /// Share of the poses that were no older, in [0, 1].
    pub in_time: Option<f64>,
    /// Frames that a pose waited for.
    pub delay: usize,
    /// Evaluations of a frame's first search, on average.
    pub evaluations: f64,
    /// What was left out, by the module that passed it over.
    pub drops: Drops,
    /// Recorded frames that were not read by their turn and so came late.
    pub late: u64,
    /// Lines in which the decoders of live sources complained: damaged pictures, most of all.
    pub complaints: u64,
    /// What the pictures of a live set lay apart by when they came, on average.
    pub apart_ms: Option<f64>,
    /// Which live source ended the run, and how.
    pub ended: Option<String>,
    /// Mean error over frames against the truth, mm.
    pub error_mm: Option<f64>,
    /// What became of the poses that were sent as they were found, a destination each.
    pub sent: Vec<SentSummary>,
}

/// Percentiles, ms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LatencySummary {
    /// Half are older.
    pub p50: f64,
    /// A tenth is older.
    pub p90: f64,
    /// A hundredth is older.
    pub p99: f64,
    /// The oldest.
    pub max: f64,
}

/// What each module passed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Drops {
    /// Pictures of live views that matched no others.
    pub acquisition: u64,
    /// Sets that a newer one replaced before they were processed.
    pub processing: u64,
    /// Processed sets that a newer one replaced before they were tracked.
    pub tracking: u64,
}

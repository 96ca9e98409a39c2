//! What the three modules did in the last moments, as a picture.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use anyhow::Result;

use crate::report::{Bar, Mark, TimelineChart, timeline_chart};
use crate::track::timings::Span;

/// Entries that are kept: enough for some seconds of a few cameras.
const KEPT: usize = 4000;
/// Frame times that are drawn.
const DRAWN_FRAMES: f64 = 30.0;

/// A module's row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Row {
    Acquisition,
    /// Processing one view.
    View(usize),
    Tracking,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    row: Row,
    frame: usize,
    span: Span,
    /// Whether the frame was passed over here.
    is_dropped: bool,
}

/// The last entries of all modules. Memory does not grow.
#[derive(Debug)]
pub(super) struct Timeline {
    zero: Instant,
    entries: Mutex<VecDeque<Entry>>,
}

impl Default for Timeline {
    fn default() -> Self {
        Self { zero: Instant::now(), entries: Mutex::new(VecDeque::with_capacity(KEPT)) }
    }
}

impl Timeline {
    /// A module worked on a frame.
    pub(super) fn worked(&self, row: Row, frame: usize, span: Span) {
        self.add(Entry { row, frame, span, is_dropped: false });
    }

    /// A frame came to a module at this moment (acquisition: it was captured).
    pub(super) fn came(&self, row: Row, frame: usize, at: Instant) {
        self.worked(row, frame, Span { start: at, time: Duration::ZERO });
    }

    /// A module passed a frame over.
    pub(super) fn dropped(&self, row: Row, frame: usize) {
        let span = Span { start: Instant::now(), time: Duration::ZERO };
        self.add(Entry { row, frame, span, is_dropped: true });
    }

    fn add(&self, entry: Entry) {
        let mut entries = self.lock();
        if entries.len() == KEPT {
            entries.pop_front();
        }
        entries.push_back(entry);
    }

    fn lock(&self) -> MutexGuard<'_, VecDeque<Entry>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The last moments as SVG: a row a module (processing: a view), a colour a frame, a line from each capture to its pose.
    ///
    /// # Errors
    /// As [`timeline_chart`].
    pub(super) fn draw(&self, cameras: &[String], fps: f64, deadline: Option<Duration>) -> Result<String> {
        let entries = self.lock();
        let ms = |at: Instant| at.saturating_duration_since(self.zero).as_secs_f64() * 1e3;
        let end = |entry: &Entry| ms(entry.span.start + entry.span.time);
        let last = entries.iter().map(end).fold(0.0, f64::max);
        let first = (last - DRAWN_FRAMES / fps * 1e3).max(0.0);
        let mut rows = vec!["acquisition".to_string()];
        rows.extend(cameras.iter().map(|camera| format!("processing {camera}")));
        rows.push("tracking".to_string());
        let mut chart = TimelineChart { rows, from: first, to: last.max(first + 1.0), ..TimelineChart::default() };
        chart.deadline = deadline.map(|deadline| deadline.as_secs_f64() * 1e3);
        for entry in entries.iter().filter(|entry| end(entry) >= first) {
            let row = match entry.row {
                Row::Acquisition => 0,
                Row::View(view) => 1 + view,
                Row::Tracking => 1 + cameras.len(),
            };
            let start = ms(entry.span.start);
            if entry.span.time.is_zero() {
                chart.marks.push(Mark { row, at: start, frame: entry.frame, is_dropped: entry.is_dropped });
            } else {
                chart.bars.push(Bar { row, start, end: end(entry), frame: entry.frame });
            }
        }
        drop(entries);
        timeline_chart(&chart)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_moments_are_drawn_and_no_more_is_kept() {
        let timeline = Timeline::default();
        let at = |ms: u64| timeline.zero + Duration::from_millis(ms);
        for frame in 0..5000 {
            timeline.came(Row::Acquisition, frame, at(40 * frame as u64));
            let span = Span { start: at(40 * frame as u64 + 5), time: Duration::from_millis(30) };
            timeline.worked(Row::Tracking, frame, span);
        }
        timeline.add(Entry {
            row: Row::View(0),
            frame: 4999,
            span: Span { start: at(40 * 4999), time: Duration::ZERO },
            is_dropped: true,
        });
        assert_eq!(timeline.lock().len(), KEPT);
        let svg = timeline.draw(&["cam<1>".to_string()], 25.0, Some(Duration::from_millis(100))).unwrap();
        assert!(
            svg.contains("processing cam&lt;1&gt;") && svg.contains("\n4999\n") && !svg.contains("\n4900\n"),
            "{svg}"
        );
        Timeline::default().draw(&[], 25.0, None).unwrap();
    }
}

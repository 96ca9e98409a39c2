//! Where the time goes: one figure a stage, and a time-line for trace viewers. Memory does not grow with the track.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use serde::Serialize;

/// Ratio of the borders of a histogram's bucket: the median is known to half a per cent.
const BUCKET: f64 = 1.01;
/// Buckets from a nanosecond to over a day.
const BUCKETS: usize = 3300;

/// When something ran.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    /// Its start.
    pub(super) start: Instant,
    /// How long it took.
    pub(super) time: Duration,
}

impl Span {
    /// From `start` until now.
    pub(super) fn since(start: Instant) -> Self {
        Self { start, time: start.elapsed() }
    }
}

/// The time of one stage, ms.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StageSummary {
    /// Its name.
    pub name: String,
    /// How often it ran: once a frame.
    pub count: u64,
    /// All of it.
    pub total: f64,
    /// Half the frames took longer.
    pub median: f64,
    /// The shortest.
    pub min: f64,
    /// The longest.
    pub max: f64,
}

#[derive(Debug)]
struct Stage {
    name: &'static str,
    count: u64,
    total: Duration,
    min: Duration,
    max: Duration,
    histogram: Vec<u64>,
}

impl Stage {
    fn summary(&self) -> StageSummary {
        let ms = |time: Duration| time.as_secs_f64() * 1e3;
        let mut seen = 0;
        let middle = self.histogram.iter().position(|count| {
            seen += count;
            2 * seen >= self.count
        });
        let middle = BUCKET.powf(middle.unwrap_or(0) as f64 + 0.5) * 1e-6;
        StageSummary {
            name: self.name.to_string(),
            count: self.count,
            total: ms(self.total),
            median: middle.clamp(ms(self.min), ms(self.max)),
            min: ms(self.min),
            max: ms(self.max),
        }
    }
}

/// Stage times of a run, and its trace: Chrome trace events written as they come.
#[derive(Debug)]
pub(super) struct Stages {
    stages: Vec<Stage>,
    zero: Instant,
    trace: BufWriter<File>,
    trace_path: PathBuf,
    is_first_event: bool,
}

/// Threads in the trace.
#[derive(Clone, Copy, Debug)]
pub(super) enum Thread {
    /// Searching.
    Search = 1,
    /// Reading and features.
    Features = 2,
}

impl Stages {
    /// Starts counting; the trace is written under a temporary name beside `trace_path`.
    pub(super) fn new(trace_path: &Path) -> Result<Self> {
        let trace_path = trace_path.to_path_buf();
        let temporary = temporary(&trace_path);
        let file = File::create(&temporary).with_context(|| format!("cannot write {}", temporary.display()))?;
        let mut trace = BufWriter::new(file);
        trace
            .write_all(b"{\"displayTimeUnit\":\"ms\",\"traceEvents\":[")
            .with_context(|| format!("cannot write {}", temporary.display()))?;
        Ok(Self { stages: Vec::new(), zero: Instant::now(), trace, trace_path, is_first_event: true })
    }

    /// Counts a time for a stage.
    pub(super) fn count(&mut self, name: &'static str, time: Duration) {
        let index = match self.stages.iter().position(|stage| stage.name == name) {
            Some(index) => index,
            None => {
                self.stages.push(Stage {
                    name,
                    count: 0,
                    total: Duration::ZERO,
                    min: Duration::MAX,
                    max: Duration::ZERO,
                    histogram: vec![0; BUCKETS],
                });
                self.stages.len() - 1
            }
        };
        let stage = &mut self.stages[index];
        stage.count += 1;
        stage.total += time;
        stage.min = stage.min.min(time);
        stage.max = stage.max.max(time);
        let bucket = (time.as_nanos().max(1) as f64).ln() / BUCKET.ln();
        stage.histogram[(bucket as usize).min(BUCKETS - 1)] += 1;
    }

    /// Puts an event on the time-line.
    pub(super) fn trace(&mut self, name: &str, thread: Thread, frame: usize, span: Span) -> Result<()> {
        let start = span.start.saturating_duration_since(self.zero).as_secs_f64() * 1e6;
        let time = span.time.as_secs_f64() * 1e6;
        let comma = if self.is_first_event { "" } else { "," };
        self.is_first_event = false;
        write!(
            self.trace,
            "{comma}\n{{\"name\":\"{name}\",\"ph\":\"X\",\"pid\":1,\"tid\":{},\"ts\":{start:.3},\"dur\":{time:.3},\
             \"args\":{{\"frame\":{frame}}}}}",
            thread as u32
        )
        .with_context(|| format!("cannot write {}", temporary(&self.trace_path).display()))
    }

    /// Counts a time and puts it on the time-line.
    pub(super) fn record(&mut self, name: &'static str, thread: Thread, frame: usize, span: Span) -> Result<()> {
        self.count(name, span.time);
        self.trace(name, thread, frame, span)
    }

    /// What was counted so far, in the order stages first ran.
    pub(super) fn summaries(&self) -> Vec<StageSummary> {
        self.stages.iter().map(Stage::summary).collect()
    }

    /// Ends the trace and gives it its name. When nothing ran, the trace of an earlier run stays.
    pub(super) fn finish(mut self) -> Result<Vec<StageSummary>> {
        if self.stages.is_empty() && self.trace_path.exists() {
            let unused = temporary(&self.trace_path);
            fs::remove_file(&unused).with_context(|| format!("cannot remove {}", unused.display()))?;
            return Ok(Vec::new());
        }
        for (thread, name) in [(Thread::Search, "search"), (Thread::Features, "reading and features")] {
            let comma = if self.is_first_event { "" } else { "," };
            self.is_first_event = false;
            write!(
                self.trace,
                "{comma}\n{{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":{},\"args\":{{\"name\":\"{name}\"}}}}",
                thread as u32
            )?;
        }
        let path = &self.trace_path;
        (|| -> Result<()> {
            self.trace.write_all(b"\n]}\n")?;
            self.trace.flush()?;
            Ok(fs::rename(temporary(path), path)?)
        })()
        .with_context(|| format!("cannot write {}", path.display()))?;
        Ok(self.summaries())
    }
}

fn temporary(path: &Path) -> PathBuf {
    path.with_extension("json.tmp")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_summed_up() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("trace.json");
        let mut stages = Stages::new(&path).unwrap();
        let start = Instant::now();
        for ms in [5, 1, 3, 100, 2] {
            let span = Span { start, time: Duration::from_millis(ms) };
            stages.record("search", Thread::Search, 7, span).unwrap();
        }
        stages.count("empty", Duration::ZERO);
        assert!(!path.exists(), "complete or absent");
        let summaries = stages.finish().unwrap();
        let search = &summaries[0];
        assert_eq!((search.count, search.min, search.max), (5, 1.0, 100.0));
        assert!((search.total - 111.0).abs() < 1e-9 && (search.median - 3.0).abs() < 0.03, "{search:?}");
        assert_eq!(summaries[1].median, 0.0);
        let trace: serde_json::Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
        let events = trace["traceEvents"].as_array().unwrap();
        assert_eq!(events.len(), 7);
        assert_eq!((events[3]["dur"].as_f64(), events[3]["args"]["frame"].as_u64()), (Some(100_000.0), Some(7)));
    }
}

//! Where the time goes: one figure a phase of a frame (reading, features, search and so on), and a time-line for trace
//! viewers. Memory does not grow with the track.

use std::borrow::Cow;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use serde::Serialize;
use serde_json::{Value, json};

use super::histogram::Histogram;
use crate::gpu::DevicePass;

/// Events that a trace holds at most, some 60 MB: what comes later is counted and not traced.
const MOST_EVENTS: usize = 500_000;

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

/// The times of one phase, ms.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimingSummary {
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

impl TimingSummary {
    /// Of one frame, ms; 0 where it never ran.
    pub fn mean(&self) -> f64 {
        if self.count > 0 { self.total / self.count as f64 } else { 0.0 }
    }
}

#[derive(Debug)]
struct Phase {
    name: Cow<'static, str>,
    times: Histogram,
}

impl Phase {
    fn summary(&self) -> TimingSummary {
        let times = &self.times;
        TimingSummary {
            name: self.name.to_string(),
            count: times.count(),
            total: times.total(),
            median: times.quantile(0.5),
            min: times.quantile(0.0),
            max: times.quantile(1.0),
        }
    }
}

/// Times of the phases of a run, and its trace: Chrome trace events written as they come.
#[derive(Debug)]
pub(super) struct Timings {
    phases: Vec<Phase>,
    zero: Instant,
    trace: BufWriter<File>,
    trace_path: PathBuf,
    events: usize,
    /// Whether a device told of passes of the search, and of the features.
    has_device: [bool; 2],
}

/// Processes in the trace: trace viewers give each a group of rows.
const HOST: u32 = 1;
const DEVICE: u32 = 2;

/// Threads of the host in the trace.
#[derive(Clone, Copy, Debug)]
pub(super) enum Thread {
    /// Searching.
    Search = 1,
    /// Reading and features.
    Features = 2,
}

impl Timings {
    /// Starts counting; the trace is written under a temporary name beside `trace_path`.
    pub(super) fn new(trace_path: &Path) -> Result<Self> {
        let trace_path = trace_path.to_path_buf();
        let temporary = temporary(&trace_path);
        let file = File::create(&temporary).with_context(|| format!("cannot write {}", temporary.display()))?;
        let mut trace = BufWriter::new(file);
        trace
            .write_all(b"{\"displayTimeUnit\":\"ms\",\"traceEvents\":[")
            .with_context(|| format!("cannot write {}", temporary.display()))?;
        Ok(Self { phases: Vec::new(), zero: Instant::now(), trace, trace_path, events: 0, has_device: [false; 2] })
    }

    /// Whether nothing was counted yet.
    pub(super) fn is_empty(&self) -> bool {
        self.phases.is_empty()
    }

    /// Counts a time for a phase.
    pub(super) fn count(&mut self, name: impl Into<Cow<'static, str>>, time: Duration) {
        let name = name.into();
        let index = match self.phases.iter().position(|phase| phase.name == name) {
            Some(index) => index,
            None => {
                self.phases.push(Phase { name, times: Histogram::default() });
                self.phases.len() - 1
            }
        };
        self.phases[index].times.add(time);
    }

    /// Puts an event on the time-line.
    pub(super) fn trace(&mut self, name: &str, thread: Thread, frame: usize, span: Span) -> Result<()> {
        self.event(name, HOST, thread as u32, span, &json!({ "frame": frame }))
    }

    /// Counts the passes that a device ran for a frame, and puts them on a row of the device's on the time-line.
    pub(super) fn record_passes(&mut self, thread: Thread, frame: usize, passes: &[DevicePass]) -> Result<()> {
        let mut sums: Vec<(&str, Duration)> = Vec::new();
        for pass in passes {
            match sums.iter_mut().find(|(name, _)| *name == pass.name) {
                Some((_, sum)) => *sum += pass.duration,
                None => sums.push((&pass.name, pass.duration)),
            }
            let mut arguments = json!({ "frame": frame });
            if let (Some(counts), Value::Object(arguments)) = (pass.statistics, &mut arguments) {
                for (name, count) in [
                    ("vertices", counts.vertices),
                    ("primitives", counts.primitives),
                    ("fragments", counts.fragments),
                    ("compute_invocations", counts.compute),
                ] {
                    arguments.insert(name.to_string(), count.into());
                }
            }
            self.event(&pass.name, DEVICE, thread as u32, Span { start: pass.start, time: pass.duration }, &arguments)?;
        }
        let (of, row) = match thread {
            Thread::Search => ("device", 0),
            Thread::Features => ("device features", 1),
        };
        for (name, time) in sums {
            self.count(format!("{of} {name}"), time);
        }
        self.has_device[row] |= !passes.is_empty();
        Ok(())
    }

    fn event(&mut self, name: &str, process: u32, thread: u32, span: Span, arguments: &Value) -> Result<()> {
        if self.events >= MOST_EVENTS {
            return Ok(());
        }
        let start = span.start.saturating_duration_since(self.zero).as_secs_f64() * 1e6;
        let time = span.time.as_secs_f64() * 1e6;
        self.comma()?;
        write!(
            self.trace,
            "{{\"name\":{},\"ph\":\"X\",\"pid\":{process},\"tid\":{thread},\"ts\":{start:.3},\"dur\":{time:.3},\
             \"args\":{arguments}}}",
            Value::from(name)
        )
        .with_context(|| format!("cannot write {}", temporary(&self.trace_path).display()))
    }

    /// What stands before an event.
    fn comma(&mut self) -> Result<()> {
        let comma = if self.events == 0 { "\n" } else { ",\n" };
        self.events += 1;
        let written = self.trace.write_all(comma.as_bytes());
        written.with_context(|| format!("cannot write {}", temporary(&self.trace_path).display()))
    }

    /// Counts a time and puts it on the time-line.
    pub(super) fn record(&mut self, name: &'static str, thread: Thread, frame: usize, span: Span) -> Result<()> {
        self.count(name, span.time);
        self.trace(name, thread, frame, span)
    }

    /// Whether a device told of the search's passes.
    pub(super) fn has_device_passes(&self) -> bool {
        self.has_device[0]
    }

    /// What was counted so far, in the order phases first ran.
    pub(super) fn summaries(&self) -> Vec<TimingSummary> {
        self.phases.iter().map(Phase::summary).collect()
    }

    /// Ends the trace and gives it its name. When nothing ran, the trace of an earlier run stays.
    pub(super) fn finish(mut self) -> Result<Vec<TimingSummary>> {
        if self.phases.is_empty() && self.trace_path.exists() {
            let unused = temporary(&self.trace_path);
            fs::remove_file(&unused).with_context(|| format!("cannot remove {}", unused.display()))?;
            return Ok(Vec::new());
        }
        let mut names = vec![
            ("process_name", HOST, 0, "CPU"),
            ("thread_name", HOST, Thread::Search as u32, "search"),
            ("thread_name", HOST, Thread::Features as u32, "reading and features"),
        ];
        if self.has_device.contains(&true) {
            names.push(("process_name", DEVICE, 0, "GPU"));
        }
        for (row, thread, name) in [(0, Thread::Search, "queue"), (1, Thread::Features, "features")] {
            if self.has_device[row] {
                names.push(("thread_name", DEVICE, thread as u32, name));
            }
        }
        for (kind, process, thread, name) in names {
            self.comma()?;
            let event = json!({ "name": kind, "ph": "M", "pid": process, "tid": thread, "args": { "name": name } });
            write!(self.trace, "{event}")?;
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
        let mut timings = Timings::new(&path).unwrap();
        let start = Instant::now();
        for ms in [5, 1, 3, 100, 2] {
            let span = Span { start, time: Duration::from_millis(ms) };
            timings.record("search", Thread::Search, 7, span).unwrap();
        }
        timings.count("empty", Duration::ZERO);
        assert!(!path.exists(), "complete or absent");
        let summaries = timings.finish().unwrap();
        let search = &summaries[0];
        assert_eq!((search.count, search.min, search.max), (5, 1.0, 100.0));
        assert!((search.total - 111.0).abs() < 1e-9 && (search.median - 3.0).abs() < 0.03, "{search:?}");
        assert_eq!(summaries[1].median, 0.0);
        let trace: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
        let events = trace["traceEvents"].as_array().unwrap();
        assert_eq!(events.len(), 8);
        assert_eq!((events[3]["dur"].as_f64(), events[3]["args"]["frame"].as_u64()), (Some(100_000.0), Some(7)));
    }
    #[test]
    fn device_passes_have_rows_of_their_own_on_the_same_axis() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("trace.json");
        let mut timings = Timings::new(&path).unwrap();
        let start = timings.zero + Duration::from_millis(2);
        timings.trace("evaluate", Thread::Search, 3, Span { start, time: Duration::from_millis(5) }).unwrap();
        let statistics = crate::gpu::PassStatistics { vertices: 8, primitives: 4, fragments: 99, compute: 64 };
        let pass = |name: &str, ms, statistics| DevicePass {
            name: name.to_string(),
            start: start + Duration::from_millis(ms),
            duration: Duration::from_millis(1),
            statistics,
            work: None,
        };
        let passes = [pass("a \"pose\"", 1, None), pass("draw", 2, Some(statistics)), pass("draw", 3, None)];
        timings.record_passes(Thread::Search, 3, &passes).unwrap();
        let summaries = timings.finish().unwrap();
        let found: Vec<(&str, u64, f64)> = summaries.iter().map(|s| (s.name.as_str(), s.count, s.total)).collect();
        assert_eq!(found, [("device a \"pose\"", 1, 1.0), ("device draw", 1, 2.0)]);
        let trace: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
        let events = trace["traceEvents"].as_array().unwrap();
        assert_eq!((&events[0]["pid"], &events[0]["ts"]), (&json!(1), &json!(2000.0)));
        assert_eq!(
            (&events[1]["pid"], &events[1]["ts"], &events[1]["name"]),
            (&json!(2), &json!(3000.0), &json!("a \"pose\""))
        );
        let counts = json!({ "frame": 3, "vertices": 8, "primitives": 4, "fragments": 99, "compute_invocations": 64 });
        assert_eq!(events[2]["args"], counts);
        let processes: Vec<&Value> =
            events.iter().filter(|event| event["name"] == "process_name").map(|event| &event["args"]["name"]).collect();
        assert_eq!(processes, ["CPU", "GPU"]);
    }
}

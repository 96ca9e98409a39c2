//! `pantin track`.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use clap::ArgAction;

use super::drawing_flags::DrawingFlags;
use super::interrupt::Interrupt;
use super::objective_flags::ObjectiveFlags;
use super::output::{say, tell};
use super::progress::{TerminalBar, WorkBar};
use super::realtime_flags::{RealtimeFlags, duration};
use super::threads_flag::ThreadsFlag;
use crate::body::Model;
use crate::files::{OutputFolder, Overwrite};
use crate::live::SentSummary;
use crate::search::{SearchKind, SearchSettings};
use crate::sequence::{STALL_TIMEOUT, Sequence};
use crate::track::{
    FeaturesOn, FrameDone, FrameRange, Passes, Prediction, Progress, RealtimeSummary, RunStart, TrackSettings,
    TrackSummary, Width, track_all,
};

/// Tracks a person through a sequence: poses, joints and markers over time (CSV, TRC, C3D), how far they can be
/// trusted, the motion for animation programs (BVH, glTF) and OpenSim (MOT), the model drawn over the pictures, and a report. A run that was stopped or killed goes on with --resume and
/// ends with the same files. The same seed, inputs and backend give the same bytes.
#[derive(clap::Args, Debug)]
pub(super) struct TrackArgs {
    /// The sequence: its sequence.toml, or the folder that holds it.
    #[arg(value_name = "SEQUENCE")]
    sequence: PathBuf,
    /// The folder for the results.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    options: TrackOptions,
    /// Go on with the run that the folder holds.
    #[arg(long, conflicts_with = "force")]
    resume: bool,
    /// Replace what the folder holds.
    #[arg(long)]
    force: bool,
}

/// How a person is tracked.
#[derive(clap::Args, Debug)]
pub(super) struct TrackOptions {
    #[command(flatten)]
    drawing: DrawingFlags,
    /// Who makes the features. Without: the device that poses are scored on, where it is a single one, no part of the processor, and can
    /// hold what is compared; else the processor. The bits are the same.
    #[arg(long = "features", value_name = "NAME", default_value_t)]
    features_on: FeaturesOn,
    /// What the body is drawn as.
    #[arg(long, value_name = "NAME", default_value_t)]
    model: Model,
    /// Poses scored at once.
    #[arg(long, value_name = "N", default_value_t = SearchSettings::default().particles)]
    particles: usize,
    /// Times that many poses are scored a frame.
    #[arg(long, value_name = "K", default_value_t = SearchSettings::default().iterations)]
    iterations: usize,
    #[command(flatten)]
    objective: ObjectiveFlags,
    /// How poses are searched. All score N x K poses.
    #[arg(long, value_name = "NAME", default_value_t)]
    search: SearchKind,
    /// Poses scored to refine each frame's winner, beyond those N x K.
    #[arg(long, value_name = "N", default_value_t = 0)]
    refine: usize,
    /// Where a frame's search starts. Without: learnt with the search maes, none with the others.
    #[arg(long, value_name = "NAME")]
    predict: Option<Prediction>,
    /// How wide it starts. Without: learnt with the search maes, steps with the others.
    #[arg(long, value_name = "NAME")]
    width: Option<Width>,
    /// How often the run goes over its frames. Without: both with the search maes, forward with the others and in real time.
    #[arg(long, value_name = "NAME")]
    passes: Option<Passes>,
    /// Measure the person again between the two passes, in the poses of the first: where joints lie in the flesh, bent limbs tell and a
    /// T-pose does not. Where other frames fit better with that body the results are of it: refined_body.toml beside them. Without: as the
    /// manifest's `measure_again` says; =no for never.
    #[arg(long, value_name = "yes|no", num_args = 0..=1, require_equals = true, default_missing_value = "yes", value_parser = yes_or_no)]
    measure_again: Option<bool>,
    /// Search wider for a person who is lost, and leave frames without a find as gaps in the results; in a run of one pass with the search
    /// maes, look for limbs that show elsewhere too: yes or no.
    #[arg(long, value_name = "yes|no", default_value = "yes", value_parser = yes_or_no, action = ArgAction::Set)]
    recover: bool,
    /// Seed of all random numbers.
    #[arg(long, value_name = "S", default_value_t = SearchSettings::default().seed)]
    seed: u64,
    /// Factor on the width of the search round the previous pose (the body's steps, scaled to the time between frames).
    #[arg(long, value_name = "F", default_value_t = 1.0)]
    spread: f64,
    /// Which frames: A..B without B, A.., or ..B; counted from 0.
    #[arg(long, value_name = "A..B", default_value = "..")]
    frames: FrameRange,
    /// A poses.csv to start from instead of the sequence's: one row, or one whose frame is the first.
    #[arg(long, value_name = "FILE")]
    start: Option<PathBuf>,
    /// Smooth the results too, into smoothed/ beside them: a low-pass without delay, Butterworth, of the fourth order in all, with this
    /// cut-off (-3 dB) in Hz; 6 suits walking.
    #[arg(long, value_name = "HZ")]
    smooth: Option<f64>,
    /// Draw the model over the pictures every N frames; 0 for never. Without: 10, and 0 in real time, which drawing disturbs.
    #[arg(long, value_name = "N")]
    overlay_every: Option<usize>,
    /// Write which part of the body shows at each pixel too: labels/CAMERA_%06d.png, a picture a view and frame in the videos' own size, 8-bit
    /// grey, 0 where nothing of the body is and else the part's `label` (1 to 127; labels.csv beside them names the parts). Frames in which the
    /// person is lost have none.
    #[arg(long)]
    labels: bool,
    /// Measure every pass on the Vulkan device too, for trace.json and stages.json; it costs some time of its own.
    #[arg(long)]
    trace: bool,
    /// Write the report as report.rrd too, a recording for the viewer of rerun.io: the same in space and time. Only in builds
    /// with the feature `rerun`.
    #[arg(long)]
    rerun: bool,
    /// How long a view may take for a picture, s, before the run ends with a sentence that names it.
    #[arg(long, value_name = "S", default_value_t = STALL_TIMEOUT.as_secs_f64())]
    stall_timeout: f64,
    #[command(flatten)]
    realtime: RealtimeFlags,
    #[command(flatten)]
    pub(super) threads: ThreadsFlag,
}

fn yes_or_no(word: &str) -> Result<bool> {
    match word {
        "yes" => Ok(true),
        "no" => Ok(false),
        other => bail!("it is {other:?}, expected yes or no"),
    }
}

impl TrackOptions {
    /// The settings they ask for.
    ///
    /// # Errors
    /// When one makes no sense.
    pub(super) fn settings(&self) -> Result<TrackSettings> {
        let realtime = self.realtime.settings()?;
        let default_overlay = if realtime.is_some() { 0 } else { TrackSettings::default().overlay_every };
        let settings = TrackSettings {
            drawing: self.drawing.drawing(self.model)?,
            devices: self.drawing.devices.clone(),
            features_on: self.features_on,
            model: self.model,
            objective: self.objective.choice(),
            search: SearchSettings {
                kind: self.search,
                particles: self.particles,
                iterations: self.iterations,
                seed: self.seed,
                refine: self.refine,
                ..SearchSettings::default()
            },
            spread: self.spread,
            predict: self.predict,
            width: self.width,
            passes: self.passes,
            measure_again: self.measure_again,
            recover: self.recover,
            frames: self.frames,
            start: self.start.clone(),
            smooth: self.smooth,
            overlay_every: self.overlay_every.unwrap_or(default_overlay),
            labels: self.labels,
            trace: self.trace,
            recording: self.rerun,
            resume: false,
            stall_timeout: duration("the stall time-out", self.stall_timeout)?,
            realtime,
        };
        settings.check()?;
        Ok(settings)
    }
}

/// Runs the command.
///
/// # Errors
/// As [`track`]; and when it was interrupted: the sentence says how to go on.
pub(super) fn run(args: &TrackArgs) -> Result<()> {
    let mut bar = TrackProgress::new()?;
    let tracked = tracked(args, &mut bar);
    bar.clear();
    let tracked = tracked?;
    for (_, summary) in &tracked {
        check_ended(summary, args)?;
    }
    for (folder, summary) in &tracked {
        if *folder != args.output {
            say!("{}:", folder.file_name().unwrap_or_default().to_string_lossy());
        }
        print_summary(summary, folder, args.options.rerun);
    }
    Ok(())
}

/// Every person's folder and what was tracked there; one, that of the results, where the manifest names no people.
///
/// # Errors
/// As [`track`].
pub(super) fn tracked(args: &TrackArgs, progress: &mut dyn Progress) -> Result<Vec<(PathBuf, TrackSummary)>> {
    let settings = TrackSettings { resume: args.resume, ..args.options.settings()? };
    args.options.threads.apply()?;
    let sequence = if settings.realtime.is_some() {
        Sequence::open_live(&args.sequence)?
    } else {
        Sequence::open(&args.sequence)?
    };
    if args.resume {
        if !args.output.is_dir() {
            bail!("there is no folder {} to resume a run in: leave out --resume", args.output.display());
        }
        return track_all(&sequence, &settings, &OutputFolder::open(&args.output)?, progress);
    }
    let overwrite = Overwrite::forced(args.force);
    OutputFolder::filled(&args.output, overwrite, |output| track_all(&sequence, &settings, output, progress))
}

fn check_ended(summary: &TrackSummary, args: &TrackArgs) -> Result<()> {
    if let Some(next) = summary.stopped_before {
        bail!(
            "stopped before frame {next}, {} frames are safe in {}: run the same command with --resume to go on",
            summary.frames.len(),
            args.output.display()
        );
    }
    Ok(())
}

/// What the user sees when all is done.
pub(super) fn print_summary(summary: &TrackSummary, folder: &std::path::Path, has_recording: bool) {
    for warning in &summary.warnings {
        tell!("note: {warning}");
    }
    let [name, variant] = summary.backend;
    match &summary.realtime {
        None => {
            let (frames, rate) = (summary.frames.len(), summary.frames_per_second);
            say!("{frames} frames at {rate:.1} frames/s with {name} ({variant})");
        }
        Some(realtime) => print_realtime(realtime, &format!("{name} ({variant})")),
    }
    say!("fitness {:.3}, confidence {:.2} on average", summary.mean_fitness, summary.mean_confidence);
    if let Some(error) = &summary.error {
        let count = error.error.points.len();
        say!("error {:.2} ± {:.2} mm over {count} {}", error.error.mean, error.error.std, error.compared);
    }
    if summary.new_frames > 0 {
        let shares = summary.timings.iter().map(|timing| format!("{} {:.1} ms", timing.name, timing.mean()));
        say!("a frame: {}", shares.collect::<Vec<_>>().join(", "));
    }
    let first = if summary.realtime.is_some() { "timeline.svg" } else { "report.html" };
    say!("results in {}, start with {}", folder.display(), folder.join(first).display());
    if has_recording {
        say!("the report as a recording: rerun {}", folder.join("report.rrd").display());
    }
}

fn print_realtime(realtime: &RealtimeSummary, evaluator: &str) {
    let RealtimeSummary { input_fps, output_fps, captured, poses, latency_ms: latency, drops, .. } = realtime;
    say!("{captured} frames came at {input_fps:.1} frames/s, {poses} poses went at {output_fps:.1} with {evaluator}");
    say!(
        "from capture to pose: half within {:.1} ms, 90 % within {:.1}, 99 % within {:.1}, all within {:.1}",
        latency.p50,
        latency.p90,
        latency.p99,
        latency.max
    );
    if let (Some(deadline), Some(in_time)) = (realtime.deadline_ms, realtime.in_time) {
        let evaluations = realtime.evaluations;
        say!("{:.2} % within the deadline of {deadline} ms, with {evaluations:.0} evaluations a pose", 1e2 * in_time);
    }
    say!(
        "passed over: {} in acquisition, {} before processing, {} before tracking; {} were read late",
        drops.acquisition,
        drops.processing,
        drops.tracking,
        realtime.late
    );
    if realtime.complaints > 0 {
        say!("the decoders complained {} times: pictures were damaged", realtime.complaints);
    }
    if let Some(apart) = realtime.apart_ms {
        say!("the pictures of a set came within {apart:.1} ms of each other, on average");
    }
    for SentSummary { to, receivers, sent, dropped } in &realtime.sent {
        let receivers = receivers.map(|count| format!(" to {count} receivers")).unwrap_or_default();
        say!("{to}: {sent} poses were sent{receivers}, {dropped} were dropped");
    }
    if let Some(error) = realtime.error_mm {
        say!("error {error:.2} mm on average");
    }
}

/// A bar on a terminal, a line now and then elsewhere; and Ctrl-C.
pub(super) struct TrackProgress {
    stop: Interrupt,
    preparing: WorkBar,
    bar: TerminalBar,
    begin: Instant,
    last_line: Instant,
    first: usize,
    /// None where a live source has no end.
    total: Option<usize>,
}

/// Between two plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(10);

impl TrackProgress {
    pub(super) fn new() -> Result<Self> {
        let stop = Interrupt::listen()?;
        let now = Instant::now();
        Ok(Self {
            stop,
            preparing: WorkBar::default(),
            bar: TerminalBar::default(),
            begin: now,
            last_line: now,
            first: 0,
            total: None,
        })
    }

    pub(super) fn clear(&mut self) {
        self.preparing = WorkBar::default();
        self.bar = TerminalBar::default();
    }
}

impl Progress for TrackProgress {
    fn start(&mut self, run: &RunStart) {
        self.preparing = WorkBar::default();
        tell!("{}", run.backend);
        for outlet in &run.outlets {
            tell!("{outlet}");
        }
        if run.done > 0 {
            let total = run.frames.map(|frames| format!(" of {frames}")).unwrap_or_default();
            tell!("going on from frame {}, {}{total} are done", run.first_frame + run.done, run.done);
        }
        (self.first, self.total) = (run.done, run.frames);
        (self.begin, self.last_line) = (Instant::now(), Instant::now());
        let template = match run.frames {
            Some(_) => "{bar:30} {pos}/{len} frames, {per_sec}, {eta} left  {msg}",
            None => "{spinner} {pos} frames, {per_sec}  {msg} (Ctrl-C ends it)",
        };
        self.bar = TerminalBar::new(template, run.done, run.frames);
    }

    fn preparing(&mut self, what: &'static str, done: usize, total: usize) {
        self.preparing.show(what, done, total);
    }

    fn looked_back(&mut self, done: usize) {
        if !self.bar.show(done, "second pass") && self.last_line.elapsed() >= LINE_INTERVAL {
            self.last_line = Instant::now();
            let total = self.total.map(|total| format!("/{total}")).unwrap_or_default();
            tell!("second pass: {done}{total}");
        }
    }

    fn frame(&mut self, frame: &FrameDone) {
        let error = frame.mean_error.map(|error| format!(", mean error {error:.1} mm")).unwrap_or_default();
        let message = format!("fitness {:.3}, confidence {:.2}{error}", frame.fitness, frame.confidence);
        if !self.bar.show(frame.done, &message) && self.last_line.elapsed() >= LINE_INTERVAL {
            self.last_line = Instant::now();
            let each = self.begin.elapsed().as_secs_f64() / (frame.done - self.first).max(1) as f64;
            let (at, done) = (frame.frame, frame.done);
            match self.total {
                Some(total) => {
                    let left = each * (total - done) as f64;
                    tell!("frame {at}, {done}/{total}, {left:.0} s left: {message}");
                }
                None => tell!("frame {at}: {message}"),
            }
        }
    }

    fn tell(&mut self, news: &str) {
        self.bar.tell(news);
    }

    fn should_stop(&self) -> bool {
        self.stop.is_asked()
    }
}

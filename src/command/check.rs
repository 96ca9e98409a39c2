//! `pantin check`.

use std::path::PathBuf;

use anyhow::{Result, bail};

use super::output::say;
use super::progress::WorkBar;
use crate::check::{CheckReport, CheckSettings, Finding, Status, check_with};
use crate::observe::Advance;
use crate::track::FrameRange;

/// Is this sequence sane? Looks at units, axes, lenses, the space that the cameras share, and at whether the silhouettes of
/// a few frames agree with each other, in direction and in time, and show a person on the floor. What failed or is doubtful comes
/// first, with its number, its limit and what to do; what is well is one line. Exit status 0 when none failed, else 1.
#[derive(clap::Args, Debug)]
pub(super) struct CheckArgs {
    /// The sequence: its sequence.toml, or the folder that holds it. Its body and start need not exist yet.
    #[arg(value_name = "SEQUENCE")]
    sequence: PathBuf,
    /// Frames that may be looked at: A..B without B, A.., or ..B; counted from 0 [default: the first hundred].
    #[arg(long, value_name = "A..B", default_value = "..", hide_default_value = true)]
    frames: FrameRange,
    /// How many of them, evenly spread (the timing takes three more to either side of each).
    #[arg(long, value_name = "N", default_value_t = CheckSettings::default().samples)]
    samples: usize,
    /// Print every check with its number and its limit, those that are well too, in the order they are made.
    #[arg(long, conflicts_with = "json")]
    all: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// As [`crate::check::check`]; and when a check failed.
pub(super) fn run(args: &CheckArgs) -> Result<()> {
    let mut bar = WorkBar::default();
    let report = checked(args, &mut |what, done, total| bar.show(what, done, total))?;
    drop(bar);
    if args.json {
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        print(&report, args.all);
    }
    let failed: Vec<&Finding> = report.checks.iter().filter(|finding| finding.status == Status::Failed).collect();
    if let Some(first) = failed.first() {
        let found = if first.found.is_empty() { String::new() } else { format!(": {}", first.found) };
        bail!(
            "{}: {} of {} checks failed, the first is `{}`{found}",
            args.sequence.display(),
            failed.len(),
            report.checks.len(),
            first.check
        );
    }
    Ok(())
}

/// What was found out.
///
/// # Errors
/// As [`crate::check::check`].
pub(super) fn checked(args: &CheckArgs, progress: &mut Advance<'_>) -> Result<CheckReport> {
    let settings = CheckSettings { start: args.frames.start, end: args.frames.end, samples: args.samples };
    check_with(&args.sequence, &settings, progress)
}

fn print(report: &CheckReport, all: bool) {
    let frames: Vec<String> = report.frames.iter().map(usize::to_string).collect();
    say!("{}: frames {}", report.sequence, frames.join(" "));
    if all {
        report.checks.iter().for_each(|finding| print_finding(finding, finding.camera.as_deref()));
        return;
    }
    let of = |status: Status| report.checks.iter().filter(move |finding| finding.status == status);
    of(Status::Failed)
        .chain(of(Status::Doubtful))
        .for_each(|finding| print_finding(finding, finding.camera.as_deref()));
    // Of several cameras for one reason.
    let mut unmeasured: Vec<(&Finding, Vec<&str>)> = Vec::new();
    for finding in of(Status::NotMeasured) {
        let alike =
            |(other, _): &&mut (&Finding, Vec<&str>)| (other.check, &other.found) == (finding.check, &finding.found);
        match unmeasured.iter_mut().find(alike) {
            Some((_, cameras)) => cameras.extend(finding.camera.as_deref()),
            None => unmeasured.push((finding, finding.camera.as_deref().into_iter().collect())),
        }
    }
    for (finding, cameras) in unmeasured {
        print_finding(finding, Some(cameras.join(" ")).as_deref().filter(|cameras| !cameras.is_empty()));
    }
    let mut well: Vec<(&str, usize)> = Vec::new();
    for finding in of(Status::Ok) {
        match well.iter_mut().find(|(check, _)| *check == finding.check) {
            Some((_, count)) => *count += 1,
            None => well.push((finding.check, 1)),
        }
    }
    let kinds: Vec<String> = well
        .iter()
        .map(|(check, count)| if *count == 1 { (*check).to_string() } else { format!("{check} ({count})") })
        .collect();
    if !kinds.is_empty() {
        say!("ok     {} (--all prints them)", kinds.join(", "));
    }
}

/// One finding, of these cameras.
fn print_finding(finding: &Finding, cameras: Option<&str>) {
    let status = match finding.status {
        Status::Ok => "ok    ",
        Status::Doubtful => "doubt ",
        Status::Failed => "FAILED",
        Status::NotMeasured => "-     ",
    };
    let camera = cameras.map(|camera| format!(" {camera}")).unwrap_or_default();
    let number = finding.value.filter(|_| finding.status != Status::NotMeasured).map_or(String::new(), |value| {
        let scatter = finding.scatter.map_or(String::new(), |scatter| format!(" ± {scatter:.2}"));
        // What is late by less than nothing is early.
        let (value, unit) = match finding.unit {
            "frames late" if value < 0.0 => (-value, "frames early"),
            unit => (value, unit),
        };
        format!(" {}{scatter} {unit} ({})", rounded(value), finding.limit)
    });
    let between = if number.is_empty() { " " } else { "; " };
    let found = if finding.found.is_empty() { String::new() } else { format!("{between}{}", finding.found) };
    say!("{status} {}{camera}:{number}{found}", finding.check);
    if !finding.advice.is_empty() {
        say!("       {}", finding.advice);
    }
}

/// Three digits or the whole number.
fn rounded(value: f64) -> String {
    let digits = if value == value.round() { 0 } else { (2 - value.abs().log10().floor() as i32).clamp(0, 3) as usize };
    format!("{value:.digits$}")
}

//! `pantin check`.

use std::path::PathBuf;

use anyhow::{Result, bail};

use super::output::say;
use super::progress::WorkBar;
use crate::check::{CheckReport, CheckSettings, Finding, Status, check_with};
use crate::observe::Advance;
use crate::track::FrameRange;

/// Is this sequence sane? Looks at units, axes, lenses, the space that the cameras share, and at whether the silhouettes of
/// a few frames agree with each other, in direction and in time, and show a person on the floor. Each check tells its
/// number, its limit and what to do. Exit status 0 when none failed, else 1.
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
        print(&report);
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

fn print(report: &CheckReport) {
    let frames: Vec<String> = report.frames.iter().map(usize::to_string).collect();
    say!("{}: frames {}", report.sequence, frames.join(" "));
    for finding in &report.checks {
        let status = match finding.status {
            Status::Ok => "ok    ",
            Status::Doubtful => "doubt ",
            Status::Failed => "FAILED",
            Status::NotMeasured => "-     ",
        };
        let camera = finding.camera.as_deref().map(|camera| format!(" {camera}")).unwrap_or_default();
        let number = finding.value.filter(|_| finding.status != Status::NotMeasured).map_or(String::new(), |value| {
            let scatter = finding.scatter.map_or(String::new(), |scatter| format!(" ± {scatter:.2}"));
            format!(" {}{scatter} {} ({})", rounded(value), finding.unit, finding.limit)
        });
        let between = if number.is_empty() { " " } else { "; " };
        let found = if finding.found.is_empty() { String::new() } else { format!("{between}{}", finding.found) };
        say!("{status} {}{camera}:{number}{found}", finding.check);
        if !finding.advice.is_empty() {
            say!("       {}", finding.advice);
        }
    }
}

/// Three digits or the whole number.
fn rounded(value: f64) -> String {
    let digits = if value == value.round() { 0 } else { (2 - value.abs().log10().floor() as i32).clamp(0, 3) as usize };
    format!("{value:.digits$}")
}

//! Which stored picture of each view is which frame of the sequence: cameras that were started late, videos whose pictures came at a
//! varying rate, views that end at different moments.

use std::sync::Arc;

use anyhow::{Result, bail};

use super::footage::Footage;
use super::source::Source;
use super::timestamps::Timestamps;
use crate::files::{choices, listed};

/// Rates of frames that differ by less than this share are one rate.
pub(crate) const SAME_RATE: f64 = 1e-3;
/// `fps` may be this share off the rate of videos that are resampled unless told otherwise: else their times are not believed.
const LIKE_RATE: f64 = 0.05;
/// Frames by which a camera may be late.
pub(super) const MOST_DELAY: f64 = 100_000.0;
/// What is said where lengths differ by so many frames and no delay is stated; cameras that are triggered together differ by one.
const FRAMES_APART: usize = 2;
const UNTOLD: &str = "whether the cameras were started together their files do not say: frame 0 of all is taken for one moment; \
                      `pantin start` and `pantin check` look for the delay, and `delay` in a [[view]] states it (0 where they were)";
/// First pictures that are further apart than this share of a frame were not taken at one moment, if the files' clocks are one.
const APART: f64 = 0.5;

choices! {
    /// What the times at which a video's pictures are to be shown are taken for.
    "use of timestamps" pub enum Stamps {
        /// Of each moment the picture nearest in time is a frame, in every video.
        "resample" Resample,
        /// Every stored picture is a frame, whatever its time says.
        "ignore" Ignore,
    }
}

/// One view as it was recorded.
#[derive(Clone, Debug)]
pub(super) struct Recorded {
    /// The camera's name.
    pub(super) camera: String,
    /// Its pictures.
    pub(super) footage: Footage,
    /// Frames by which its pictures come too late, where the manifest says.
    pub(super) delay: Option<f64>,
}

impl Recorded {
    fn is_live(&self) -> bool {
        matches!(self.footage.source, Source::Live(_))
    }

    /// How long it filmed, s.
    pub(super) fn seconds(&self, fps: f64) -> f64 {
        let footage = &self.footage;
        match &footage.times {
            Some(times) => times.seconds(),
            None => footage.frame_count as f64 / footage.fps.unwrap_or(fps),
        }
    }
}

/// What belongs together in time.
#[derive(Debug)]
pub(super) struct Synchrony {
    /// For each view the number of the stored picture of every frame; none where they are the same.
    pub(super) picks: Vec<Option<Arc<[u32]>>>,
    /// Frames that all views have.
    pub(super) frame_count: usize,
    /// What a user should know, a sentence each.
    pub(super) remarks: Vec<String>,
    /// What follows from what the user stated, a sentence each: nothing is amiss.
    pub(super) notes: Vec<String>,
}

/// Puts the views of a sequence of `fps` frames a second together in time.
///
/// # Errors
/// When views that are one picture a frame differ in length since pictures are missing or came at other rates; a delay is out of range or
/// longer than the view; timestamps make no sense.
pub(super) fn synchronise(views: &[Recorded], fps: f64, stamps: Option<Stamps>) -> Result<Synchrony> {
    if views.iter().any(Recorded::is_live) {
        return live(views);
    }
    let mut remarks = Vec::new();
    let resampled = is_resampled(views, fps, stamps, &mut remarks);
    let delays: Vec<f64> = views.iter().map(|view| view.delay.unwrap_or(0.0)).collect();
    let earliest = delays.iter().copied().fold(f64::INFINITY, f64::min);
    let mut notes: Vec<String> = first_moment(views, fps).into_iter().collect();
    let mut picks = Vec::new();
    for (view, delay) in views.iter().zip(&delays) {
        let late = delay - earliest;
        let times = view.footage.times.as_ref().filter(|_| resampled);
        let pictures = view.footage.frame_count as u32;
        picks.push(match times {
            Some(times) => Some(times.nearest(fps, late / fps)?),
            // The nearest picture, of two as near the earlier, as where times are known.
            None if late > 0.5 => Some(((late - 0.5).ceil() as u32..pictures).collect()),
            None => None,
        });
    }
    let length =
        |(view, picks): (&Recorded, &Option<Vec<u32>>)| picks.as_ref().map_or(view.footage.frame_count, Vec::len);
    let lengths: Vec<usize> = views.iter().zip(&picks).map(length).collect();
    let is_stated = views.iter().any(|view| view.delay.is_some());
    // Pictures that are missing or came at another rate shift all that follow them: then a length tells nothing of when a view ended.
    let are_regular = views.iter().all(|view| view.footage.times.as_ref().is_none_or(Timestamps::is_regular));
    let may_differ = resampled || is_stated || (are_regular && are_of_one_rate(views));
    let frame_count = common_length(views, &lengths, may_differ, &remarks, &mut notes)?;
    if lengths.iter().any(|length| length - frame_count >= FRAMES_APART) && !is_stated {
        remarks.push(UNTOLD.to_string());
    }
    if stamps != Some(Stamps::Ignore) {
        remarks.extend(rates(views, fps, resampled));
        remarks.extend(beginnings(views, fps));
    }
    let cut = |picks: Option<Vec<u32>>| {
        let picks = picks.map(|mut picks| {
            picks.truncate(frame_count);
            picks
        });
        // A video that is regular after all is read as every other one.
        picks.filter(|picks| picks.iter().enumerate().any(|(frame, pick)| frame != *pick as usize)).map(Arc::from)
    };
    Ok(Synchrony { picks: picks.into_iter().map(cut).collect(), frame_count, remarks, notes })
}

/// Live views have no frames that could be counted or put off.
fn live(views: &[Recorded]) -> Result<Synchrony> {
    if let Some(view) = views.iter().find(|view| view.delay.is_some()) {
        bail!("camera {:?} is live and has `delay`, expected it of recordings alone", view.camera);
    }
    if let (Some(live), Some(recorded)) =
        (views.iter().find(|view| view.is_live()), views.iter().find(|view| !view.is_live()))
    {
        bail!(
            "one of the cameras {:?} and {:?} is live and one is recorded, expected the same of all",
            live.camera,
            recorded.camera
        );
    }
    let frame_count = views[0].footage.frame_count;
    Ok(Synchrony { picks: vec![None; views.len()], frame_count, remarks: Vec::new(), notes: Vec::new() })
}

/// Whether the frames are the pictures nearest in time, and what is to be said of the videos that ask for it.
fn is_resampled(views: &[Recorded], fps: f64, stamps: Option<Stamps>, remarks: &mut Vec<String>) -> bool {
    if let Some(stamps) = stamps {
        return stamps == Stamps::Resample;
    }
    if !are_of_one_rate(views) && lasted_alike(views, fps) {
        return true;
    }
    let irregular: Vec<&Recorded> =
        views.iter().filter(|view| view.footage.times.as_ref().is_some_and(|times| !times.is_regular())).collect();
    let rate = |view: &Recorded| view.footage.fps.map_or(f64::INFINITY, |rate| (rate / fps - 1.0).abs());
    let believed = irregular.iter().all(|view| rate(view) < LIKE_RATE);
    for view in &irregular {
        let Some(times) = &view.footage.times else { continue };
        let then = if believed {
            "each frame is the picture nearest in time (`timestamps = \"ignore\"` takes every picture as a frame)"
        } else {
            "every picture is taken as a frame, since `fps` is another rate (`timestamps = \"resample\"` takes the pictures nearest in \
             time)"
        };
        remarks.push(format!(
            "the pictures of camera {:?} did not come at a constant rate: {:.1} ms apart in the median, {:.1} ms at most, {} missing; {then}",
            view.camera,
            1e3 * times.median_step(),
            1e3 * times.longest_step(),
            times.missing()
        ));
    }
    !irregular.is_empty() && believed
}

/// Whether no two videos tell of different rates.
fn are_of_one_rate(views: &[Recorded]) -> bool {
    let rates = || views.iter().filter_map(|view| view.footage.fps);
    rates().fold(0.0, f64::max) <= rates().fold(f64::INFINITY, f64::min) * (1.0 + SAME_RATE)
}

/// Whether videos, all of which have time stamps, are more alike in how long they lasted than in how many pictures they have: then the
/// cameras filmed at the rates that the files say. Cameras that were triggered together have as many pictures each, whatever the files say.
fn lasted_alike(views: &[Recorded], fps: f64) -> bool {
    let spread = |values: Vec<f64>| {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        values.iter().copied().fold(0.0, f64::max) / least.max(f64::MIN_POSITIVE)
    };
    let counts = views.iter().map(|view| view.footage.frame_count as f64).collect();
    let lasted = views.iter().map(|view| view.seconds(fps)).collect();
    views.iter().all(|view| view.footage.times.is_some()) && spread(lasted) < spread(counts)
}

/// The number of frames that all views have.
fn common_length(
    views: &[Recorded],
    lengths: &[usize],
    may_differ: bool,
    remarks: &[String],
    notes: &mut Vec<String>,
) -> Result<usize> {
    let shortest = lengths.iter().copied().min().unwrap_or(0);
    if let Some(at) = lengths.iter().position(|length| *length == 0) {
        bail!(
            "camera {:?} has no frame of the moments that the others saw, expected a smaller `delay`",
            views[at].camera
        );
    }
    let Some(other) = lengths.iter().position(|length| *length != lengths[0]) else { return Ok(shortest) };
    if may_differ {
        let each = views.iter().zip(lengths).map(|(view, length)| format!("{} {length}", view.camera));
        let each: Vec<String> = each.collect();
        let each: Vec<&str> = each.iter().map(String::as_str).collect();
        notes.push(format!(
            "the cameras filmed for different times ({} frames): {shortest} are taken, those of all",
            listed(&each)
        ));
        return Ok(shortest);
    }
    let (first, second) = (&views[0], &views[other]);
    let hint = match (first.footage.fps, second.footage.fps) {
        // What was found of the videos is the likelier reason.
        _ if !remarks.is_empty() => remarks.join("; "),
        (Some(a), Some(b)) if (a / b - 1.0).abs() > SAME_RATE => format!(
            "their files have {a:.3} and {b:.3} frames a second: `timestamps = \"resample\"` takes the pictures nearest in time"
        ),
        _ => {
            "pictures are missing in one of them; `delay = 0` in a [[view]] takes the frames that all have".to_string()
        }
    };
    bail!(
        "camera {:?} has {} frames and camera {:?} has {} ({}; {}), expected views of the same length ({hint})",
        first.camera,
        lengths[0],
        second.camera,
        lengths[other],
        first.footage.shown,
        second.footage.shown
    );
}

/// A sentence where frame 0 is not the first picture of the cameras that are in time.
fn first_moment(views: &[Recorded], fps: f64) -> Option<String> {
    // Where every camera has a delay, none is there to be measured from.
    views.iter().find(|view| view.delay.unwrap_or(0.0) == 0.0)?;
    let delayed = views.iter().filter_map(|view| Some((view, view.delay.filter(|delay| *delay < 0.0)?)));
    let (view, delay) = delayed.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let late = -delay;
    Some(format!(
        "frame 0 lies {late} frames ({:.3} s) after the first pictures of cameras without `delay`, since camera {:?} has `delay = {delay}`: \
         motion capture beside them is to be cut by as much",
        late / fps,
        view.camera
    ))
}

/// Sentences on videos that have another rate than the sequence.
fn rates(views: &[Recorded], fps: f64, resampled: bool) -> Vec<String> {
    let is_off = |rate: &f64| (rate / fps - 1.0).abs() > SAME_RATE;
    let off: Vec<(&Recorded, f64)> =
        views.iter().filter_map(|view| Some((view, view.footage.fps.filter(is_off)?))).collect();
    let Some((_, rate)) = off.first() else { return Vec::new() };
    let one = views.len() == off.len() && off.iter().all(|(_, other)| (other / rate - 1.0).abs() <= SAME_RATE);
    let then = if resampled {
        "of each video the pictures nearest in time are taken (`timestamps = \"ignore\"` takes every picture as a frame)"
    } else if one {
        "times and speeds follow from `fps`: state the rate at which the cameras filmed (`timestamps = \"ignore\"` says that it is so)"
    } else {
        "frames that were not taken at the same moment cannot be put together: state `timestamps = \"resample\"`, or `timestamps = \
         \"ignore\"` where the files are wrong"
    };
    if one {
        return vec![format!("`fps` is {fps} and the videos have {rate:.3} frames a second: {then}")];
    }
    let each: Vec<String> = off.iter().map(|(view, rate)| format!("{} {rate:.3}", view.camera)).collect();
    let each: Vec<&str> = each.iter().map(String::as_str).collect();
    vec![format!("`fps` is {fps} and videos have other rates ({} frames a second): {then}", listed(&each))]
}

/// A sentence where the first pictures were taken at different moments of the files' clocks and no delay is stated.
fn beginnings(views: &[Recorded], fps: f64) -> Vec<String> {
    if views.iter().any(|view| view.delay.is_some()) {
        return Vec::new();
    }
    let firsts: Vec<(&str, f64)> =
        views.iter().filter_map(|view| Some((view.camera.as_str(), view.footage.times.as_ref()?.first()))).collect();
    let earliest = firsts.iter().map(|(_, first)| *first).fold(f64::INFINITY, f64::min);
    let late = firsts.iter().filter(|(_, first)| (first - earliest) * fps > APART);
    let said: Vec<String> = late
        .map(|(camera, first)| {
            format!("{camera} {:.3} s (`delay = {:.0}`)", first - earliest, -(first - earliest) * fps)
        })
        .collect();
    let mut remarks = Vec::new();
    if !said.is_empty() {
        let said: Vec<&str> = said.iter().map(String::as_str).collect();
        remarks.push(format!(
            "videos begin later than the others by their own clocks: {}; their first pictures are taken for one moment unless `delay` is \
             stated",
            listed(&said)
        ));
    }
    let made: Vec<(&str, &str)> =
        views.iter().filter_map(|view| Some((view.camera.as_str(), view.footage.made.as_deref()?))).collect();
    if let Some(((camera, time), (other, later))) =
        made.first().zip(made.iter().find(|(_, time)| Some(*time) != made.first().map(|(_, first)| *first)))
    {
        remarks.push(format!(
            "the videos say that they were made at different times, {camera} at {time} and {other} at {later}: frame 0 of all is taken for one \
             moment; `pantin start` and `pantin check` look for the delay (`delay` in a [[view]])"
        ));
    }
    remarks
}

//! By how many frames cameras were started late, as far as their files make it likely: their lengths, if all were stopped together, the
//! clocks by which they say when they were made, and their first time stamps. Each is a guess that silhouettes have to confirm.

use super::synchrony::Recorded;

/// Guesses that differ by less than this in every view, frames, are one; delays that small need no guess.
const SAME: f64 = 2.0;
/// Frames that all views must have at least once they are put together by a guess.
const FEWEST: f64 = 20.0;
/// Recordings whose clocks differ by more than this, s, are not of one event, or the clocks are not set.
const ONE_EVENT: f64 = 3600.0;

/// Delays of all views that what their files say makes likely, whole frames each, 0 for the one that began first and negative for those
/// that began later; the likeliest first. None where all say that they began together, or a delay is stated.
pub(super) fn likely_delays(views: &[Recorded], fps: f64) -> Vec<Vec<f64>> {
    if views.len() < 2 || views.iter().any(|view| view.delay.is_some()) {
        return Vec::new();
    }
    let lengths: Vec<f64> = views.iter().map(|view| view.seconds(fps)).collect();
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    let stopped_together = lengths.iter().map(|length| longest - length).collect();
    let clocks: Option<Vec<f64>> = views.iter().map(|view| clock(view.footage.made.as_deref()?)).collect();
    let firsts: Option<Vec<f64>> = views.iter().map(|view| Some(view.footage.times.as_ref()?.first())).collect();
    // Some write when a recording began, others when it was ended.
    let ended = clocks.as_ref().map(|clocks| clocks.iter().zip(&lengths).map(|(end, length)| end - length).collect());
    let mut guesses: Vec<Vec<f64>> = Vec::new();
    for begins in [firsts, Some(stopped_together), clocks, ended].into_iter().flatten() {
        let first = begins.iter().copied().fold(f64::INFINITY, f64::min);
        let late: Vec<f64> = begins.iter().map(|begin| begin - first).collect();
        let delays: Vec<f64> = late.iter().map(|late| -(late * fps).round()).map(|delay| delay + 0.0).collect();
        let left = late.iter().zip(&lengths).map(|(late, length)| (late + length) * fps).fold(f64::INFINITY, f64::min)
            - late.iter().copied().fold(0.0, f64::max) * fps;
        let is_new = |known: &[f64]| known.iter().zip(&delays).any(|(known, delay)| (known - delay).abs() >= SAME);
        let is_late = is_new(&vec![0.0; delays.len()]);
        if is_late && left >= FEWEST && late.iter().all(|late| *late < ONE_EVENT) && guesses.iter().all(|g| is_new(g)) {
            guesses.push(delays);
        }
    }
    guesses
}

/// Seconds since some moment of `2024-05-01T10:00:00.000000Z`; none of what is written otherwise, or of a clock that was never set.
fn clock(made: &str) -> Option<f64> {
    let (date, time) = made.trim().trim_end_matches('Z').split_once(['T', ' '])?;
    let numbers = |text: &str, between: char| -> Option<[f64; 3]> {
        let numbers: Vec<f64> = text.split(between).map(|part| part.parse().ok()).collect::<Option<_>>()?;
        numbers.try_into().ok()
    };
    let [year, month, day] = numbers(date, '-')?;
    let [hour, minute, second] = numbers(time, ':')?;
    let in_range = (1990.0..3000.0).contains(&year) && (1.0..13.0).contains(&month) && (1.0..32.0).contains(&day);
    let in_range = in_range && hour < 24.0 && minute < 60.0 && (0.0..61.0).contains(&second);
    // Days of the calendar whose years begin in March, so that a leap day is the last one.
    let (year, month) = if month > 2.0 { (year, month - 3.0) } else { (year - 1.0, month + 9.0) };
    let leap = (year / 4.0).floor() - (year / 100.0).floor() + (year / 400.0).floor();
    let days = 365.0 * year + leap + ((153.0 * month + 2.0) / 5.0).floor() + day;
    in_range.then_some(((days * 24.0 + hour) * 60.0 + minute) * 60.0 + second)
}

#[cfg(test)]
mod tests {
    use super::super::footage::Footage;
    use super::super::source::{Source, Video};
    use super::super::timestamps::Timestamps;
    use super::super::turn::Turn;
    use super::*;

    fn view(frames: u32, first: f64, made: Option<&str>) -> Recorded {
        let source = Source::Video(Video { path: "v.mp4".into(), stored: [64, 48], turn: Turn::None });
        let times = (0..frames).map(|frame| first + f64::from(frame) / 30.0).collect();
        let footage = Footage {
            fps: Some(30.0),
            times: Timestamps::of(times, 1e-3),
            made: made.map(str::to_string),
            ..Footage::plain("v.mp4".into(), source, [8, 8], frames as usize)
        };
        Recorded { camera: "c".into(), footage, delay: None }
    }

    #[test]
    fn lengths_clocks_and_first_stamps_each_make_a_guess() {
        let at = |second: &str| format!("2024-02-29T23:59:{second}.000000Z");
        let next_day = "2024-03-01T00:00:02.000000Z";
        let likely = |views: &[Recorded]| likely_delays(views, 30.0);
        assert!(likely(&[view(300, 0.0, None), view(301, 0.01, None)]).is_empty(), "a frame more or less is no guess");
        assert_eq!(likely(&[view(300, 0.0, None), view(240, 0.0, None)]), [[0.0, -60.0]]);
        assert_eq!(likely(&[view(300, 0.5, None), view(300, 0.0, None)]), [[-15.0, 0.0]]);
        // A clock that says when it began, or when it ended: 240 frames are 2 s less.
        let views = [view(300, 0.0, Some(&at("58"))), view(240, 0.0, Some(next_day))];
        assert_eq!(likely(&views), [[0.0, -60.0], [0.0, -120.0], [0.0, -180.0]]);
        // What leaves no common stretch, or is of another day, is none; nor is anything where the user has spoken.
        let views = [view(100, 0.0, Some(&at("00"))), view(100, 0.0, Some(&at("59")))];
        assert!(likely(&views).is_empty());
        let views = [view(300, 0.0, None), Recorded { delay: Some(0.0), ..view(240, 0.0, None) }];
        assert!(likely(&views).is_empty());
        assert_eq!(clock("1904-01-01T00:00:00Z"), None);
        assert_eq!(clock("yesterday"), None);
    }
}

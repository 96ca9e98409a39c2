//! When people are first seen.

use std::ops::Range;

use anyhow::Result;

use super::meant::{PersonSeen, people_in};
use crate::observe::Advance;
use crate::sequence::Sequence;

/// Frames of a second that are looked at.
const A_SECOND: usize = 5;
/// Frames that are looked at together at first; twice as many each time that nobody is seen in them.
const AT_FIRST: usize = 10;

/// The frame of a range in which so many people are first seen standing apart, of those that are looked at; of the second that begins there, the one
/// in which the most views have all of them in their pictures.
///
/// # Errors
/// As [`people_in`].
pub(in crate::track) fn first_seen(
    sequence: &Sequence,
    people: usize,
    range: Range<usize>,
    progress: &mut Advance<'_>,
) -> Result<Option<usize>> {
    let step = ((sequence.fps / A_SECOND as f64).round() as usize).max(1);
    let (mut next, mut together) = (range.start, AT_FIRST);
    while next < range.end {
        progress("looking for somebody", next - range.start, range.len());
        let frames: Vec<usize> = (next..range.end).step_by(step).take(together).collect();
        let seen = people_in(sequence, &frames)?;
        if let Some(at) = seen.iter().position(|seen| seen.len() >= people) {
            let second: Vec<usize> = (frames[at]..range.end).step_by(step).take(A_SECOND).collect();
            let seen = people_in(sequence, &second)?;
            return Ok(best_seen(&seen, people).map(|at| second[at]));
        }
        next += step * frames.len();
        together *= 2;
    }
    Ok(None)
}

/// The place of the frame in which whoever is whole in the fewest views is so in the most; of equals the first.
fn best_seen(frames: &[Vec<PersonSeen>], people: usize) -> Option<usize> {
    let views = |seen: &Vec<PersonSeen>| seen.get(..people)?.iter().map(|person| person.views).min();
    let counted = frames.iter().enumerate().filter_map(|(at, seen)| Some((at, views(seen)?)));
    counted.rev().max_by_key(|(_, views)| *views).map(|(at, _)| at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_frame_in_which_most_views_have_all_of_everybody() {
        let frame = |views: &[usize]| -> Vec<PersonSeen> {
            views.iter().map(|&views| PersonSeen { at: [0.0; 2], height: 1800.0, views }).collect()
        };
        let frames = [frame(&[3]), frame(&[2, 4]), frame(&[3, 3]), frame(&[4, 3, 0]), frame(&[])];
        assert_eq!(best_seen(&frames, 1), Some(3));
        assert_eq!(best_seen(&frames, 2), Some(2));
        assert_eq!(best_seen(&frames, 3), Some(3));
        assert_eq!(best_seen(&frames, 4), None);
    }
}

//! Which of the people in a picture is to be measured.

use anyhow::{Result, bail};
use glam::DVec2;

use super::super::figures::{Figure, figures, nearest};
use super::seen::Seen;
use crate::files::listed;
use crate::observe::with_plates;
use crate::sequence::Sequence;

/// How far from a place somebody may be who is said to stand there, mm.
const THERE: f64 = 1000.0;

/// Who is meant, from frame to frame.
pub(super) struct Meant<'a> {
    /// Where he was said or found to stand.
    place: Option<DVec2>,
    /// The number of the first frame, and the sequence, for messages.
    first: usize,
    name: &'a str,
    /// A sentence on the others in the first frame.
    pub(super) others: Option<String>,
}

impl<'a> Meant<'a> {
    pub(super) fn new(place: Option<[f64; 2]>, first: usize, name: &'a str) -> Self {
        Self { place: place.map(DVec2::from), first, name, others: None }
    }

    /// The one who is meant in the next frame, who was near in the one before; in the first, `at` 0, the one who stands where he was said to.
    ///
    /// # Errors
    /// When nobody stands there.
    pub(super) fn choose(&mut self, at: usize, figures: &[Figure]) -> Result<Option<usize>> {
        let chosen = match self.place {
            Some(place) => nearest(figures, place),
            None => (!figures.is_empty()).then_some(0),
        };
        if at == 0
            && let Some(place) = self.place
            && chosen.is_none_or(|own| figures[own].place.distance(place) > THERE)
        {
            let seen: Vec<String> = figures.iter().map(shown).collect();
            bail!(
                "{}, frame {}: nobody stands within {THERE} mm of {:.0},{:.0}; {}",
                self.name,
                self.first,
                place.x,
                place.y,
                match &seen[..] {
                    [] => "nobody is seen standing upright".to_string(),
                    [one] => format!("seen is somebody at {one}"),
                    more => format!("seen are people at {}", listed(more)),
                }
            );
        }
        let Some(own) = chosen else { return Ok(None) };
        if at == 0 {
            self.others = self.said(figures, own);
        }
        self.place = Some(figures[own].place);
        Ok(Some(own))
    }

    fn said(&self, figures: &[Figure], own: usize) -> Option<String> {
        let others = figures.iter().enumerate().filter(|(at, _)| *at != own);
        let others: Vec<String> = others.map(|(_, figure)| shown(figure)).collect();
        (!others.is_empty()).then(|| {
            format!(
                "{} people are seen in frame {}: the one at {} is measured, not {}. `pantin start` and `pantin fit` take another with --at X,Y. Who is \
                 not tracked disturbs whom he overlaps in pictures: `pantin start --people {}` has all tracked together",
                figures.len(),
                self.first,
                shown(&figures[own]),
                if let [other] = &others[..] { format!("the one at {other}") } else { format!("those at {}", listed(&others)) },
                figures.len()
            )
        })
    }
}

/// As `--at` takes it.
fn shown(figure: &Figure) -> String {
    format!("{:.0},{:.0}", figure.place.x, figure.place.y)
}

/// Somebody in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PersonSeen {
    /// The middle of what is seen, over the floor: world x and y, mm.
    pub at: [f64; 2],
    /// Of the visual hull, mm.
    pub height: f64,
    /// How many views have all of the visual hull in their pictures.
    pub views: usize,
}

/// The people who are seen in each of some frames, which rise: those first who stand nearest to where the cameras look.
///
/// # Errors
/// As [`super::fit`].
pub fn people_in(sequence: &Sequence, frames: &[usize]) -> Result<Vec<Vec<PersonSeen>>> {
    let plated = with_plates(sequence, &mut |_, _, _| {})?;
    let sequence = plated.sequence.as_ref();
    let mut people = Vec::new();
    Seen::look(sequence, frames, false, &mut |_, views| {
        let seen = |figure: Figure| PersonSeen {
            at: figure.place.into(),
            height: figure.height,
            views: figure.whole_in(&sequence.cameras),
        };
        people.push(figures(&sequence.cameras, views).into_iter().map(seen).collect());
        Ok(Vec::new())
    })?;
    Ok(people)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_where_nobody_stands_is_no_persons() {
        let error = |place: Option<[f64; 2]>| {
            Meant::new(place, 4, "walk.toml").choose(0, &[]).map_err(|error| format!("{error:#}"))
        };
        let expected = "walk.toml, frame 4: nobody stands within 1000 mm of 900,-20; nobody is seen standing upright";
        assert_eq!(error(Some([900.0, -20.0])), Err(expected.to_string()));
        assert_eq!(error(None), Ok(None), "whoever lies on the floor is measured where nobody was named");
    }
}

//! Is a camera's picture upside down, on its side or mirrored, against its calibration? Its silhouettes, turned or mirrored, would then meet
//! the others' as these meet each other.

use super::agreement::{CAP, FEWER_RAYS, Moment, Ray, disagreement, percent_explained, rays, rays_of};
use super::exchanges::{BETTER, DISAGREE, suspects};
use super::finding::Finding;
use super::partners::shows;
use super::signed_distance::SignedDistance;
use crate::geometry::Camera;
use crate::sequence::{Orientation, Sequence, Turn};

/// The others must explain a turned silhouette's border by at least this part of what is explained of theirs.
const AS_THE_OTHERS: f64 = 0.75;

/// A camera whose picture agrees with the others' once it is turned.
pub(super) struct Misplaced {
    view: usize,
    turn: Turn,
    before: f64,
    after: f64,
    /// All rays with it turned.
    pub(super) rays: Vec<Ray>,
}

impl Misplaced {
    /// The camera whose turned picture betters the agreement most, where that is by much and it then agrees as the others do. `found` are
    /// the rays as the pictures are.
    pub(super) fn find(cameras: &[Camera], moments: &[Moment], found: &[Ray]) -> Option<Self> {
        if disagreement(found, CAP) <= DISAGREE {
            return None;
        }
        let tried = suspects(cameras.len(), found).into_iter().flat_map(|view| {
            let [width, height] = cameras[view].size;
            let is_possible = move |turn: &Turn| turn.turned([width, height]) == [width, height];
            Turn::ALL.into_iter().filter(is_possible).map(move |turn| (view, turn))
        });
        let measured = tried.map(|(view, turn)| {
            let put = put(moments, view, turn);
            let is_touched = |other: usize| shows(view, other, cameras.len());
            let before = disagreement(found.iter().filter(|ray| is_touched(ray.view)), CAP);
            let after = disagreement(&rays_of(cameras, &seen(&put, moments, view), FEWER_RAYS, is_touched), CAP);
            (view, turn, before, after)
        });
        let (view, turn, before, after) = measured.min_by(|a, b| (a.3 / a.2).total_cmp(&(b.3 / b.2)))?;
        let put = put(moments, view, turn);
        let rays = rays(cameras, &seen(&put, moments, view), FEWER_RAYS);
        let [own, others] =
            [true, false].map(|is_own| percent_explained(rays.iter().filter(|ray| (ray.view == view) == is_own)));
        (after < BETTER * before && own >= AS_THE_OTHERS * others).then_some(Self { view, turn, before, after, rays })
    }

    /// What is to be written into the manifest, and why.
    pub(super) fn sentence(&self, sequence: &Sequence) -> String {
        let view = &sequence.views[self.view];
        let how = self.turn.said();
        let orientation = Orientation::of(view.source.turn().then(self.turn)).map_or_else(
            || "turn the video itself".to_string(),
            |orientation| format!("write `orientation = {}` into its [[view]]", orientation.value()),
        );
        format!(
            "{} agrees with the others when its picture is {how}: {orientation}; a plate that was learnt from it is to be learnt anew and the \
             person to be measured again (`pantin start` with --force, which keeps that line)",
            view.camera
        )
    }

    /// The same as a check that failed.
    pub(super) fn finding(&self, sequence: &Sequence) -> Finding {
        let value = self.after / self.before;
        let limit = [BETTER, f64::INFINITY];
        Finding::number("orientation", "of the disagreement left with its picture turned or mirrored", value, limit)
            .of(&sequence.views[self.view].camera)
            .found(format!(
                "the views then disagree by {:.2} px a border ray instead of {:.2}",
                self.after, self.before
            ))
            .or(self.sentence(sequence))
    }
}

/// One view's silhouettes, turned.
fn put(moments: &[Moment], view: usize, turn: Turn) -> Vec<Option<SignedDistance>> {
    moments.iter().map(|moment| moment[view].map(|silhouette| silhouette.put(turn))).collect()
}

/// The moments with other silhouettes of one view.
fn seen<'a>(put: &'a [Option<SignedDistance>], moments: &[Moment<'a>], view: usize) -> Vec<Moment<'a>> {
    let seen = |(moment, put): (&Moment<'a>, &'a Option<SignedDistance>)| {
        let mut moment = moment.clone();
        moment[view] = put.as_ref();
        moment
    };
    moments.iter().zip(put).map(seen).collect()
}

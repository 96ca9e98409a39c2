//! Is a camera's picture upside down, on its side or mirrored, against its calibration? Its silhouettes, turned or mirrored, would then meet
//! the others' as these meet each other.

use rayon::prelude::*;

use super::agreement::{CAP, FEWER_RAYS, Moment, Ray, disagreement, percent_explained, rays, rays_of};
use super::exchanges::{BETTER, DISAGREE, suspects};
use super::finding::Finding;
use super::partners::shows;
use super::signed_distance::SignedDistance;
use crate::geometry::Camera;
use crate::sequence::{Orientation, Sequence, Turn};

/// The others must explain a turned silhouette's border by at least this part of what is explained of theirs.
const AS_THE_OTHERS: f64 = 0.75;

/// Two cameras whose pictures are turned are looked for among as many that agree least, with so many rays a silhouette; each silhouette's
/// border is then explained by this part, %.
const MOST_OF_TWO: usize = 5;
const RAYS_OF_TWO: usize = 20;
const EXPLAINED_OF_TWO: f64 = 60.0;

/// One camera, or two, whose pictures agree with the others' once they are turned.
pub(super) struct Misplaced {
    placed: Vec<(usize, Turn)>,
    before: f64,
    after: f64,
    /// All rays with them turned.
    pub(super) rays: Vec<Ray>,
}

/// A view's silhouettes, turned.
struct Put {
    view: usize,
    turn: Turn,
    silhouettes: Vec<Option<SignedDistance>>,
}

impl Misplaced {
    /// The camera whose turned picture betters the agreement most, where that is by much and it then agrees as the others do; where there is
    /// none, two of which the same can be said together. `found` are the rays as the pictures are.
    pub(super) fn find(cameras: &[Camera], moments: &[Moment], found: &[Ray]) -> Option<Self> {
        if disagreement(found, CAP) <= DISAGREE {
            return None;
        }
        let suspects = suspects(cameras.len(), found);
        Self::one(cameras, moments, found, &suspects).or_else(|| Self::two(cameras, moments, found, &suspects))
    }

    fn one(cameras: &[Camera], moments: &[Moment], found: &[Ray], suspects: &[usize]) -> Option<Self> {
        let tried = suspects.iter().flat_map(|&view| turns(&cameras[view]).map(move |turn| (view, turn)));
        let measured = tried.map(|(view, turn)| {
            let put = [put(moments, view, turn)];
            let is_touched = |other: usize| shows(view, other, cameras.len());
            let before = disagreement(found.iter().filter(|ray| is_touched(ray.view)), CAP);
            let after = disagreement(&rays_of(cameras, &seen(&put.each_ref(), moments), FEWER_RAYS, is_touched), CAP);
            (view, turn, before, after)
        });
        let (view, turn, before, after) = measured.min_by(|a, b| (a.3 / a.2).total_cmp(&(b.3 / b.2)))?;
        let put = [put(moments, view, turn)];
        let rays = rays(cameras, &seen(&put.each_ref(), moments), FEWER_RAYS);
        let [own, others] =
            [true, false].map(|is_own| percent_explained(rays.iter().filter(|ray| (ray.view == view) == is_own)));
        let placed = vec![(view, turn)];
        (after < BETTER * before && own >= AS_THE_OTHERS * others).then_some(Self { placed, before, after, rays })
    }

    /// Two at once, since a ray misses the one as long as the other is not put right. With three cameras the two would be most of them.
    fn two(cameras: &[Camera], moments: &[Moment], found: &[Ray], suspects: &[usize]) -> Option<Self> {
        if cameras.len() < 4 {
            return None;
        }
        let agreement = |view: &usize| disagreement(found.iter().filter(|ray| ray.view == *view), CAP);
        let mut worst = suspects.to_vec();
        worst.sort_by(|a, b| agreement(b).total_cmp(&agreement(a)));
        worst.truncate(MOST_OF_TWO);
        let tried = worst.iter().flat_map(|&view| turns(&cameras[view]).map(move |turn| (view, turn)));
        let puts: Vec<Put> = tried.map(|(view, turn)| put(moments, view, turn)).collect();
        let measure = |puts: &[&Put]| disagreement(&rays_of(cameras, &seen(puts, moments), RAYS_OF_TWO, |_| true), CAP);
        let before = puts.par_iter().map(|put| measure(&[put])).collect::<Vec<f64>>();
        let before = before.into_iter().chain([measure(&[])]).fold(f64::INFINITY, f64::min);
        let pairs: Vec<[&Put; 2]> = puts
            .iter()
            .enumerate()
            .flat_map(|(at, first)| puts[at + 1..].iter().map(move |second| [first, second]))
            .filter(|[first, second]| first.view != second.view)
            .collect();
        let measured: Vec<f64> = pairs.par_iter().map(|pair| measure(pair)).collect();
        let (pair, after) = pairs.iter().zip(measured).min_by(|a, b| a.1.total_cmp(&b.1))?;
        let rays = rays(cameras, &seen(pair, moments), FEWER_RAYS);
        let explained = |view: usize| percent_explained(rays.iter().filter(|ray| ray.view == view));
        let is_whole = (0..cameras.len()).all(|view| explained(view) >= EXPLAINED_OF_TWO);
        let placed = pair.map(|put| (put.view, put.turn)).to_vec();
        (after < BETTER * before && is_whole).then_some(Self { placed, before, after, rays })
    }

    /// What is to be written into the manifest, and why; a sentence a camera.
    pub(super) fn sentences(&self, sequence: &Sequence) -> Vec<String> {
        self.placed.iter().map(|placed| Self::sentence(*placed, sequence)).collect()
    }

    fn sentence((view, turn): (usize, Turn), sequence: &Sequence) -> String {
        let view = &sequence.views[view];
        let how = turn.said();
        let orientation = Orientation::of(view.source.turn().then(turn)).map_or_else(
            || "turn the video itself".to_string(),
            |orientation| format!("write `orientation = {}` into its [[view]]", orientation.value()),
        );
        format!(
            "{} agrees with the others when its picture is {how}: {orientation}; a plate that was learnt from it is to be learnt anew and the \
             person to be measured again (`pantin start` with --force, which keeps that line)",
            view.camera
        )
    }

    /// The same as checks that failed.
    pub(super) fn findings(&self, sequence: &Sequence) -> Vec<Finding> {
        let value = self.after / self.before;
        let limit = [BETTER, f64::INFINITY];
        let together = if self.placed.len() > 1 { ", with both put right" } else { "" };
        let finding = |&(view, turn): &(usize, Turn)| {
            Finding::number("orientation", "of the disagreement left with its picture turned or mirrored", value, limit)
                .of(&sequence.views[view].camera)
                .found(format!(
                    "the views then disagree by {:.2} px a border ray instead of {:.2}{together}",
                    self.after, self.before
                ))
                .or(Self::sentence((view, turn), sequence))
        };
        self.placed.iter().map(finding).collect()
    }
}

/// How a camera's picture can be turned and keep its size.
fn turns(camera: &Camera) -> impl Iterator<Item = Turn> {
    let size = camera.size;
    Turn::ALL.into_iter().filter(move |turn| turn.turned(size) == size)
}

fn put(moments: &[Moment], view: usize, turn: Turn) -> Put {
    let silhouettes = moments.iter().map(|moment| moment[view].map(|silhouette| silhouette.put(turn))).collect();
    Put { view, turn, silhouettes }
}

/// The moments with the silhouettes of some views put otherwise.
fn seen<'a>(puts: &[&'a Put], moments: &[Moment<'a>]) -> Vec<Moment<'a>> {
    let seen = |(at, moment): (usize, &Moment<'a>)| {
        let mut moment = moment.clone();
        puts.iter().for_each(|put| moment[put.view] = put.silhouettes[at].as_ref());
        moment
    };
    moments.iter().enumerate().map(seen).collect()
}

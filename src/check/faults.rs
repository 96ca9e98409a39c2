//! Which cameras look beside where their calibration says, and whose pictures come early or late. One fault makes others look at fault that
//! share much of its view, and a late camera of a person who walks by looks like a turned one: so the one change of one camera that
//! betters the agreement most is believed, if it counts, and the rest is measured again with it put right, until no change counts.
//! Only where something is amiss cameras are also looked for that are farther off in time.

use std::cell::OnceCell;

use anyhow::Result;
use rayon::prelude::*;

use super::agreement::{FEWER_RAYS, Moment, Ray, percent_explained, rays};
use super::betterment::{Betterment, COUNTS, SURE};
use super::finding::Finding;
use super::partners::worst;
use super::silhouettes::{SHIFTS, Silhouettes};
use super::timing::{Delay, FAR_COUNTS, delay, far};
use super::turns::{Turn, all_turned, best_turn_and_zoom, best_turns, rays_that_show};
use crate::geometry::Camera;

/// Cameras that look farther beside than this, degrees, spoil a track: a person 4 m away is then off by 14 mm.
const BESIDE: f64 = 0.2;
/// Turns about the view's own axis move a person in the middle of the picture hardly at all, and show as little.
const ROLLED: f64 = 0.6;
/// More than this many frames is late.
const LATE: f64 = 0.6;

/// Where the other views explain less of a silhouette's border, %, something is amiss even if no turn and no small delay betters it.
const AMISS: f64 = 60.0;

/// Focal lengths that are off by less than this part spoil little, by more than that are no zoom that somebody forgot.
const ZOOMED: f64 = 0.03;
const MOST_ZOOMED: f64 = 0.35;
/// Another focal length is looked for where less than this of a silhouette's border is explained, %, and believed where as much of its own is
/// then and it takes away this part of the disagreement that the best turn leaves.
const UNLIKE: f64 = 85.0;
const ZOOM_COUNTS: f64 = 0.5;

/// All cameras are believed to be turned where that takes away this part of the disagreement that single ones leave.
const TOGETHER: f64 = 0.3;

/// What is believed of the cameras.
struct Belief<'a> {
    cameras: &'a [Camera],
    silhouettes: &'a Silhouettes,
    /// Delays that the manifest states, frames.
    stated: &'a [f64],
    begun: Option<(&'a [isize], [f64; 2])>,
    fps: f64,
    turns: Vec<Turn>,
    delays: Vec<isize>,
    is_turned: Vec<bool>,
    is_zoomed: Vec<bool>,
    is_late: Vec<bool>,
}

/// What is measured of one camera, the others being as is believed.
struct Measured {
    turn: Turn,
    turning: Betterment,
    delay: Delay,
}

/// A change of a camera that counts.
enum Change {
    Turned(Turn),
    Zoomed(Turn),
    Late(isize),
}

/// What is at fault, and what is left when that is put right.
pub(super) struct Faults {
    /// Direction, roll and timing of every camera.
    pub(super) findings: Vec<Finding>,
    /// The rays of the samples with every fault put right.
    pub(super) rays: Vec<Ray>,
}

/// What is known of the views' times: the delays that the manifest states, in frames, the frames a second, and how the silhouettes are
/// read again with more neighbours of some views.
pub(super) struct Times<'a> {
    pub(super) stated: &'a [f64],
    /// Delays by which the cameras were already put together, and the part of the borders that is explained without and with, %.
    pub(super) begun: Option<(&'a [isize], [f64; 2])>,
    pub(super) fps: f64,
    pub(super) widen: &'a mut dyn FnMut(&[usize]) -> Result<Silhouettes>,
}

/// Looks for faults until no change of a camera counts; then `count` rays a silhouette.
///
/// # Errors
/// When the silhouettes cannot be read again.
pub(super) fn faults(
    cameras: &[Camera],
    Times { stated, begun, fps, widen }: Times<'_>,
    silhouettes: &Silhouettes,
    count: usize,
) -> Result<Faults> {
    let views = cameras.len();
    // The views that may be far off in time, and the silhouettes with their neighbours.
    let wide: OnceCell<(Vec<usize>, Silhouettes)> = OnceCell::new();
    let mut belief = Belief {
        cameras,
        silhouettes,
        stated,
        begun,
        fps,
        turns: vec![Turn::default(); views],
        delays: vec![0; views],
        is_turned: vec![false; views],
        is_zoomed: vec![false; views],
        is_late: vec![false; views],
    };
    let mut is_tried_together = false;
    // Ends: a camera is zoomed once, between two of which it is turned once, and late once, and all are turned together once.
    loop {
        let measured: Vec<Measured> = (0..views).into_par_iter().map(|view| belief.measure(view)).collect();
        let mut changes: Vec<(usize, Change, f64)> =
            measured.iter().enumerate().flat_map(|(view, measured)| belief.changes(view, measured)).collect();
        let explained = belief.explained();
        if !changes.is_empty() || explained.iter().any(|percent| *percent < AMISS) {
            if wide.get().is_none() {
                let suspects = worst(&explained);
                let read = widen(&suspects)?;
                belief.silhouettes = &wide.get_or_init(|| (suspects, read)).1;
            }
            let suspects = wide.get().map_or(&[][..], |(suspects, _)| suspects);
            changes.extend(belief.far_changes(suspects));
        }
        if explained.iter().any(|percent| *percent < UNLIKE) {
            changes.extend(belief.zoom_changes(&measured));
        }
        let Some((view, change, _)) = changes.into_iter().max_by(|a, b| a.2.total_cmp(&b.2)) else {
            let is_suspected = measured.iter().any(|measured| Direction::of(&measured.turn).is_beside());
            if is_suspected && !is_tried_together {
                is_tried_together = true;
                if belief.turn_all() {
                    continue;
                }
            }
            let findings =
                measured.iter().enumerate().flat_map(|(view, measured)| belief.findings(view, measured)).collect();
            return Ok(Faults { findings, rays: rays(&all_turned(cameras, &belief.turns), &belief.moments(), count) });
        };
        match change {
            Change::Turned(turn) => {
                belief.turns[view] = turn;
                belief.is_turned[view] = true;
            }
            Change::Zoomed(turn) => {
                // What was believed of directions may have made up for it.
                belief.is_zoomed[view] = true;
                belief.turns[view] = turn;
                belief.is_turned = vec![false; views];
                belief.turns = (0..views).map(|view| belief.straight(view)).collect();
            }
            Change::Late(shift) => {
                belief.delays[view] = shift;
                belief.is_late[view] = true;
            }
        }
        belief.turn_together();
    }
}

impl<'a> Belief<'a> {
    /// The samples as the views saw them, late ones put right.
    fn moments(&self) -> Vec<Moment<'a>> {
        let samples = self.silhouettes.samples.iter();
        samples.filter_map(|&sample| self.silhouettes.moment(sample, |view| self.delays[view])).collect()
    }

    /// What a camera's best turn betters, and its delay. One that is believed to be turned is measured against itself unturned, one
    /// that is late against itself as it comes.
    fn measure(&self, view: usize) -> Measured {
        let moments = self.moments();
        let turns = if self.is_turned[view] {
            self.turns.clone()
        } else {
            best_turns(self.cameras, &moments, &self.turns, &[view])
        };
        let rays = |turns: &[Turn]| rays_that_show(&all_turned(self.cameras, turns), &moments, &[view]);
        let unturned = self.with(view, self.straight(view));
        let turning = Betterment::of(&rays(&unturned), &rays(&turns), moments.len());
        let about = if SHIFTS.contains(&self.delays[view]) { 0 } else { self.delays[view] };
        Measured { turn: turns[view], turning, delay: self.delay(view, about) }
    }

    fn delay(&self, view: usize, about: isize) -> Delay {
        delay(&all_turned(self.cameras, &self.turns), self.silhouettes, &self.delays, view, about)
    }

    /// The share of each silhouette's border that the others explain, %.
    fn explained(&self) -> Vec<f64> {
        let rays = rays(&all_turned(self.cameras, &self.turns), &self.moments(), FEWER_RAYS);
        let of = |view: usize| percent_explained(rays.iter().filter(|ray| ray.view == view));
        (0..self.cameras.len()).map(of).collect()
    }

    /// What the cameras of `suspects` that are far off in time take away; which are not believed to be late yet.
    fn far_changes(&self, suspects: &[usize]) -> Vec<(usize, Change, f64)> {
        let cameras = all_turned(self.cameras, &self.turns);
        let change = |&view: &usize| {
            let about = far(&cameras, self.silhouettes, &self.delays, view, self.fps)?;
            let Delay::Late { shift, late, scatter, betterment } = self.delay(view, about) else { return None };
            let counts = late.abs() > SURE * scatter && betterment.part() >= FAR_COUNTS;
            counts.then(|| (view, Change::Late(shift), betterment.gain()))
        };
        suspects.par_iter().filter(|view| !self.is_late[**view]).filter_map(change).collect()
    }

    /// The changes of a camera that count and are not believed yet, and what they take away.
    fn changes(&self, view: usize, measured: &Measured) -> Vec<(usize, Change, f64)> {
        let mut changes = Vec::new();
        let turned = Direction::of(&measured.turn);
        if !self.is_turned[view] && (turned.is_beside() || turned.is_rolled()) && measured.turning.counts() {
            changes.push((view, Change::Turned(measured.turn), measured.turning.gain()));
        }
        if let Delay::Late { shift, late, scatter, betterment } = measured.delay
            && !self.is_late[view]
            && late.abs() > f64::max(LATE, SURE * scatter)
            && betterment.counts()
        {
            changes.push((view, Change::Late(shift), betterment.gain()));
        }
        changes
    }

    /// What is believed, but for one camera's turn.
    fn with(&self, view: usize, turn: Turn) -> Vec<Turn> {
        let mut turns = self.turns.clone();
        turns[view] = turn;
        turns
    }

    /// A camera that is not turned, with the focal length that is believed.
    fn straight(&self, view: usize) -> Turn {
        let Turn { zoom, zoom_scatter, .. } = self.turns[view];
        Turn { zoom, zoom_scatter, ..Turn::default() }
    }

    /// Cameras whose focal length is believed to be another one: that must take away most of what turns leave, in every view about as much as a
    /// right lens does, since silhouettes that lose legs or a head look taken from farther off too.
    fn zoom_changes(&self, measured: &[Measured]) -> Vec<(usize, Change, f64)> {
        let moments = self.moments();
        let change = |view: usize| {
            let rays = |turns: &[Turn]| rays_that_show(&all_turned(self.cameras, turns), &moments, &[view]);
            let as_is = rays(&self.turns);
            let turned = rays(&if self.is_turned[view] {
                best_turns(self.cameras, &moments, &self.turns, &[view])
            } else {
                self.with(view, measured[view].turn)
            });
            let turns = best_turn_and_zoom(self.cameras, &moments, &self.turns, view);
            let zoomed = rays(&turns);
            let turn = turns[view];
            let is_another =
                (ZOOMED..MOST_ZOOMED).contains(&turn.zoom.abs()) && turn.zoom.abs() > SURE * turn.zoom_scatter;
            let beside = Betterment::of(&turned, &zoomed, moments.len());
            let own = percent_explained(zoomed.iter().filter(|ray| ray.view == view));
            let is_told = is_another && beside.part() >= ZOOM_COUNTS && own >= UNLIKE;
            is_told.then(|| (view, Change::Zoomed(turn), Betterment::of(&as_is, &zoomed, moments.len()).gain()))
        };
        let views: Vec<usize> = (0..self.cameras.len()).filter(|view| !self.is_zoomed[*view]).collect();
        views.into_par_iter().filter_map(change).collect()
    }

    /// All cameras that are believed to be turned, once more together.
    fn turn_together(&mut self) {
        let free: Vec<usize> = (0..self.cameras.len()).filter(|&view| self.is_turned[view]).collect();
        if !free.is_empty() {
            self.turns = best_turns(self.cameras, &self.moments(), &self.turns, &free);
        }
    }

    /// Where no camera alone betters much since all are wrong: all turned together. Whether that takes away a good part of what is left,
    /// and is believed.
    fn turn_all(&mut self) -> bool {
        let views = self.cameras.len();
        let (moments, all): (_, Vec<usize>) = (self.moments(), (0..views).collect());
        let straight: Vec<Turn> = all.iter().map(|&view| self.straight(view)).collect();
        let together = best_turns(self.cameras, &moments, &straight, &all);
        let rays = |turns: &[Turn]| rays_that_show(&all_turned(self.cameras, turns), &moments, &all);
        if Betterment::of(&rays(&self.turns), &rays(&together), moments.len()).part() < TOGETHER {
            return false;
        }
        for (view, turn) in together.into_iter().enumerate() {
            let direction = Direction::of(&turn);
            self.is_turned[view] = direction.is_beside() || direction.is_rolled();
            self.turns[view] = if self.is_turned[view] { turn } else { self.straight(view) };
        }
        self.turn_together();
        true
    }

    fn findings(&self, view: usize, measured: &Measured) -> Vec<Finding> {
        let turned = Direction::of(&measured.turn);
        let direction = Finding::number("direction", "degrees", turned.beside, [0.0, BESIDE])
            .give_or_take(turned.beside_scatter)
            .found(format!(
                "turned by {:.2} about its x (to the right) and {:.2} about its y (down), {}",
                turned.right,
                turned.down,
                measured.turning.words()
            ));
        let roll = Finding::number("roll", "degrees", turned.roll, [-ROLLED, ROLLED])
            .give_or_take(turned.roll_scatter)
            .found("about the view, clockwise");
        let advice = "the camera was moved since its calibration, or that is not exact: calibrate it anew, or refine it on points that \
                      several cameras see";
        let believed = |is_sure| self.is_turned[view] && is_sure;
        let [direction, roll] = [(direction, believed(turned.is_beside())), (roll, believed(turned.is_rolled()))]
            .map(|(finding, is_believed)| believed_or_not(finding, is_believed, advice).of(&self.cameras[view].name));
        let mut findings = vec![direction, roll, self.timing(view, &measured.delay)];
        findings.extend(self.is_zoomed[view].then(|| self.focal_length(view)));
        findings
    }

    fn focal_length(&self, view: usize) -> Finding {
        let Turn { zoom, zoom_scatter, .. } = self.turns[view];
        let percent = 100.0 * (zoom.exp() - 1.0);
        let than = if percent > 0.0 { "larger" } else { "smaller" };
        Finding::number("focal length", "% too short", percent, [-100.0 * ZOOMED, 100.0 * ZOOMED])
            .give_or_take(100.0 * zoom_scatter)
            .found(format!("what it shows is {:.1} % {than} than its calibration makes it", percent.abs()))
            .or("the lens was zoomed since it was calibrated, its pictures were cut or scaled, or the camera stands nearer or farther than \
                 calibrated: calibrate it anew, with the zoom fixed and at the size of the videos")
            .of(&self.cameras[view].name)
    }

    fn timing(&self, view: usize, delay: &Delay) -> Finding {
        let begun = self.begun.map_or(0, |(delays, _)| delays[view]);
        let put = self.begun.filter(|_| begun != 0).map(|(_, [before, after])| {
            format!(
                "put together as the lengths and clocks of the files make likely, the views explain {after:.0} % of each other's borders \
                 instead of {before:.0}"
            )
        });
        let (shift, finding) = match delay {
            Delay::NoNeighbours | Delay::NobodyMoves if begun != 0 => {
                (0, Finding::number("timing", "frames late", begun as f64, [-LATE, LATE]))
            }
            Delay::NoNeighbours => {
                (0, Finding::not_measured("timing", "the frames looked at have no three neighbours to either side"))
            }
            Delay::NobodyMoves => {
                (0, Finding::not_measured("timing", "nobody moves enough in the frames looked at to tell"))
            }
            Delay::Late { shift, late, scatter, betterment } => {
                let found = if *shift == 0 {
                    format!("the views agree best with this camera as it is, to {:.3} px", betterment.after)
                } else {
                    format!("with this camera moved by {shift} frames, {}", betterment.words())
                };
                let late = begun as f64 + late;
                let finding = Finding::number("timing", "frames late", late, [-LATE, LATE]);
                (*shift, finding.give_or_take(*scatter).found(found))
            }
        };
        let finding = match put {
            Some(put) => finding.found(put),
            None => finding,
        };
        let stated = self.stated[view];
        let now = if stated == 0.0 { String::new() } else { format!(" (now {stated})") };
        let most = if shift.unsigned_abs() < self.silhouettes.reach {
            ""
        } else {
            ". Nothing beyond is looked for: then check again, and look for a clap where it stays"
        };
        let advice = format!(
            "write `delay = {}`{now} into the [[view]] of this camera: frames by which its pictures come too late, negative where they come \
             too early. Then measure the person again (`pantin fit`){most}",
            stated + (begun + shift) as f64
        );
        believed_or_not(finding, self.is_late[view] || begun != 0, &advice).of(&self.cameras[view].name)
    }
}

/// A number beyond its limit fails where it is believed, and else is doubtful.
fn believed_or_not(finding: Finding, is_believed: bool, advice: &str) -> Finding {
    if is_believed {
        return finding.or(advice);
    }
    let needed = format!(
        "too little to tell from the silhouettes' own faults (what is {SURE:.0} times its scatter and takes away {:.0} % of the \
         disagreement is held against the camera): better silhouettes, or more frames (`--samples`), tell",
        100.0 * COUNTS
    );
    finding.doubtful_within([f64::NEG_INFINITY, f64::INFINITY]).or(needed)
}

/// A turn in degrees.
struct Direction {
    right: f64,
    down: f64,
    beside: f64,
    beside_scatter: f64,
    roll: f64,
    roll_scatter: f64,
}

impl Direction {
    fn of(turn: &Turn) -> Self {
        let [right, down, roll] = turn.by.to_array().map(f64::to_degrees);
        let [right_scatter, down_scatter, roll_scatter] = turn.scatter.to_array().map(f64::to_degrees);
        let beside = right.hypot(down);
        let beside_scatter = (right * right_scatter).hypot(down * down_scatter) / beside.max(f64::MIN_POSITIVE);
        Self { right, down, beside, beside_scatter, roll, roll_scatter }
    }

    fn is_beside(&self) -> bool {
        self.beside > BESIDE && self.beside > SURE * self.beside_scatter
    }

    fn is_rolled(&self) -> bool {
        self.roll.abs() > ROLLED && self.roll.abs() > SURE * self.roll_scatter
    }
}

//! The smallest turn of a camera about its own centre after which the silhouettes agree best: by that angle it looks beside where its
//! calibration says. And the same together with its focal length.

use glam::{DVec3, DVec4};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::agreement::{CAP, Moment, Near, Ray, disagreement, rays_of};
use super::partners::{fewer, shows};
use crate::geometry::{Camera, Lens, rodrigues_matrix};

/// Residuals beyond this many pixels are taken for faults of the silhouettes and weigh ever less.
const SCALE: f64 = 1.5;
/// The same while the views disagree by more than `APART` pixels, so that a camera that is far off is drawn in.
const WIDE_SCALE: f64 = 6.0;
const APART: f64 = 1.0;
/// Turns cost what one ray costs that is off by this many pixels a degree: where silhouettes say nothing, nothing moves.
const PRIOR: f64 = 1.0;
/// Rounds of Gauss and Newton.
const ROUNDS: usize = 8;
/// Rounds with the wide scale.
const WIDE_ROUNDS: usize = 4;
/// Step of the differences, radians.
const STEP: f64 = 1e-3;
/// The longest step of a round, and one that is not worth another round, radians.
const LONGEST: f64 = 0.02;
const SHORTEST: f64 = 1e-4;
/// Rays a silhouette.
const RAYS: usize = 80;

/// A camera's turn, in its own axes (x right, y down, z ahead), radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Turn {
    /// Rodrigues vector.
    pub(super) by: DVec3,
    /// One standard deviation, from the scatter over the moments.
    pub(super) scatter: DVec3,
    /// Logarithm of the focal length over the stated one, and its standard deviation; 0 where that is not asked for.
    pub(super) zoom: f64,
    pub(super) zoom_scatter: f64,
}

/// What of a camera is free.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Free {
    /// Where it looks.
    Turn,
    /// That, and its focal length.
    TurnAndZoom,
}

impl Free {
    fn count(self) -> usize {
        match self {
            Self::Turn => 3,
            Self::TurnAndZoom => 4,
        }
    }
}

/// The camera with another focal length, of which the logarithm grows by `zoom`.
fn zoomed(camera: &Camera, zoom: f64) -> Camera {
    let mut zoomed = camera.clone();
    match &mut zoomed.lens {
        Lens::Tsai(lens) => lens.f *= zoom.exp(),
        Lens::BrownConrady(lens) => lens.focal *= zoom.exp(),
    }
    zoomed
}

/// The camera turned about its centre by a Rodrigues vector in its own axes, radians.
pub(super) fn turned(camera: &Camera, turn: DVec3) -> Camera {
    let mut turned = camera.clone();
    let turn = rodrigues_matrix(turn);
    turned.camera_from_world.matrix3 = turn * camera.camera_from_world.matrix3;
    turned.camera_from_world.translation = turn * camera.camera_from_world.translation;
    turned
}

/// Every camera turned.
pub(super) fn all_turned(cameras: &[Camera], turns: &[Turn]) -> Vec<Camera> {
    let put = |(camera, turn): (&Camera, &Turn)| {
        let camera = turned(camera, turn.by);
        if turn.zoom == 0.0 { camera } else { zoomed(&camera, turn.zoom) }
    };
    cameras.iter().zip(turns).map(put).collect()
}

/// The rays that a change of one of the cameras `of` shows in.
pub(super) fn rays_that_show(cameras: &[Camera], moments: &[Moment], of: &[usize]) -> Vec<Ray> {
    let count = cameras.len();
    rays_of(cameras, moments, fewer(RAYS, count), |view| of.iter().any(|&changed| shows(changed, view, count)))
}

/// The best turns of the cameras `free` together, the others turned as they are; those that come in are where the search begins.
pub(super) fn best_turns(cameras: &[Camera], moments: &[Moment], turns: &[Turn], free: &[usize]) -> Vec<Turn> {
    best(cameras, moments, turns, free, Free::Turn)
}

/// [`best_turns`] of one camera, with its best focal length.
pub(super) fn best_turn_and_zoom(cameras: &[Camera], moments: &[Moment], turns: &[Turn], view: usize) -> Vec<Turn> {
    best(cameras, moments, turns, &[view], Free::TurnAndZoom)
}

fn best(cameras: &[Camera], moments: &[Moment], turns: &[Turn], free: &[usize], what: Free) -> Vec<Turn> {
    let search = Search { cameras, moments, free, what };
    let mut turns = turns.to_vec();
    let first = search.rays(&turns);
    if disagreement(&first, CAP) > APART {
        search.descend(&mut turns, WIDE_SCALE, WIDE_ROUNDS);
    }
    search.descend(&mut turns, SCALE, ROUNDS);
    turns
}

/// Which cameras are turned, before what.
struct Search<'a> {
    cameras: &'a [Camera],
    moments: &'a [Moment<'a>],
    free: &'a [usize],
    what: Free,
}

/// The normal equations of one moment's rays.
type Normal = (DMatrix<f64>, DVector<f64>);

impl Search<'_> {
    fn rays(&self, turns: &[Turn]) -> Vec<Ray> {
        rays_that_show(&all_turned(self.cameras, turns), self.moments, self.free)
    }

    /// Damped Gauss-Newton steps; `turns` are the best that were met, with their scatter.
    fn descend(&self, turns: &mut Vec<Turn>, scale: f64, rounds: usize) {
        let mut at = turns.clone();
        let mut best = f64::INFINITY;
        let mut damping = 1.0;
        for _ in 0..rounds {
            let rays = self.rays(&at);
            let cost = self.cost(&rays, &at, scale);
            if cost >= best {
                // A step too far: back half the way.
                for (turn, best) in at.iter_mut().zip(turns.iter()) {
                    turn.by = (turn.by + best.by) * 0.5;
                    turn.zoom = (turn.zoom + best.zoom) * 0.5;
                }
                damping *= 4.0;
                continue;
            }
            best = cost;
            damping = f64::max(damping * 0.5, 0.25);
            let Some((step, scatter)) = self.step(&rays, &at, scale, damping) else {
                turns.clone_from(&at);
                break;
            };
            for (&camera, scatter) in self.free.iter().zip(scatter) {
                at[camera].scatter = scatter.truncate();
                if self.what == Free::TurnAndZoom {
                    at[camera].zoom_scatter = scatter.w;
                }
            }
            turns.clone_from(&at);
            let longest = step.iter().map(|turn| turn.length()).fold(0.0, f64::max);
            if longest < SHORTEST {
                break;
            }
            for (&camera, step) in self.free.iter().zip(step) {
                let step = step * (LONGEST / longest).min(1.0);
                at[camera].by += step.truncate();
                at[camera].zoom += step.w;
            }
        }
    }

    /// A camera's zoom where it is free; else it is as it is.
    fn own_zoom(&self, turn: &Turn) -> f64 {
        if self.what == Free::TurnAndZoom { turn.zoom } else { 0.0 }
    }

    fn cost(&self, rays: &[Ray], turns: &[Turn], scale: f64) -> f64 {
        let seen: f64 = rays.iter().map(|ray| scale * scale * (1.0 + (ray.excess() / scale).powi(2)).ln()).sum();
        let squares = |&camera: &usize| turns[camera].by.extend(self.own_zoom(&turns[camera])).length_squared();
        let turned: f64 = self.free.iter().map(squares).sum();
        (seen + prior(rays.len()) * turned) / rays.len().max(1) as f64
    }

    /// One damped step of each free camera, and the scatter of where it leads: the moments' own wishes to go elsewhere.
    fn step(&self, rays: &[Ray], turns: &[Turn], scale: f64, damping: f64) -> Option<(Vec<DVec4>, Vec<DVec4>)> {
        let each = self.what.count();
        let unknowns = each * self.free.len();
        let moments = self.normal_equations(rays, turns, scale);
        let prior = prior(rays.len());
        let mut matrix = DMatrix::from_diagonal_element(unknowns, unknowns, prior);
        let mut vector = DVector::from_fn(unknowns, |at, _| {
            let turn = &turns[self.free[at / each]];
            prior * turn.by.extend(turn.zoom)[at % each]
        });
        let mut spread = DMatrix::zeros(unknowns, unknowns);
        for (moment_matrix, moment_vector) in &moments {
            matrix += moment_matrix;
            vector += moment_vector;
        }
        let mean = &vector / moments.len().max(1) as f64;
        for (_, moment_vector) in &moments {
            let apart = moment_vector - &mean;
            spread += &apart * apart.transpose();
        }
        let inverse = matrix.clone().cholesky()?.inverse();
        let count = moments.len() as f64;
        let covariance = &inverse * (spread * (count / (count - 1.0).max(1.0))) * &inverse;
        for at in 0..unknowns {
            matrix[(at, at)] *= 1.0 + 0.1 * damping;
        }
        let solution = matrix.cholesky()?.solve(&vector);
        let of_cameras = |value: &dyn Fn(usize) -> f64| {
            let own = |at: usize, axis: usize| if axis < each { value(each * at + axis) } else { 0.0 };
            (0..self.free.len()).map(|at| DVec4::from_array([0, 1, 2, 3].map(|axis| own(at, axis)))).collect()
        };
        Some((of_cameras(&|at| -solution[at]), of_cameras(&|at| covariance[(at, at)].max(0.0).sqrt())))
    }

    fn normal_equations(&self, rays: &[Ray], turns: &[Turn], scale: f64) -> Vec<Normal> {
        let each = self.what.count();
        let unknowns = each * self.free.len();
        let current = all_turned(self.cameras, turns);
        let moved: Vec<(usize, [Camera; 2])> = (0..unknowns)
            .map(|unknown| {
                let camera = self.free[unknown / each];
                let by = |step: f64| {
                    let mut turn = DVec4::ZERO;
                    turn[unknown % each] = step;
                    let own = turned(&current[camera], turn.truncate());
                    if turn.w == 0.0 { own } else { zoomed(&own, turn.w) }
                };
                (camera, [STEP, -STEP].map(by))
            })
            .collect();
        // What moves a ray's miss: its own camera's turn and those of the cameras that it is compared with.
        let row = |ray: &Ray| {
            let near = Near::of(&current, &self.moments[ray.moment], ray);
            let slope = |camera: usize, [up, down]: &[Camera; 2]| match (
                near.excess_with(camera, up),
                near.excess_with(camera, down),
            ) {
                (Some(up), Some(down)) => (up - down) / (2.0 * STEP),
                _ => 0.0,
            };
            let involved = moved.iter().enumerate().filter(|(_, (camera, _))| shows(*camera, ray.view, current.len()));
            involved.map(|(unknown, (camera, moved))| (unknown, slope(*camera, moved))).collect::<Vec<_>>()
        };
        // Summed in the rays' order, so that the sums are the same on every run.
        let rows: Vec<_> = rays.par_iter().map(row).collect();
        let mut sums: Vec<Option<Normal>> = vec![None; self.moments.len()];
        for (ray, row) in rays.iter().zip(rows) {
            let nothing = || (DMatrix::zeros(unknowns, unknowns), DVector::zeros(unknowns));
            let (matrix, vector) = sums[ray.moment].get_or_insert_with(nothing);
            let excess = ray.excess();
            let weight = 1.0 / (1.0 + (excess / scale).powi(2));
            for &(at, slope) in &row {
                vector[at] += weight * excess * slope;
                for &(other, along) in &row {
                    matrix[(at, other)] += weight * slope * along;
                }
            }
        }
        sums.into_iter().flatten().collect()
    }
}

fn prior(rays: usize) -> f64 {
    // Of a share of the rays, so that more of them do not drown it.
    PRIOR.to_degrees().powi(2) * 0.002 * rays as f64
}

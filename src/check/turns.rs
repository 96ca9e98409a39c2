//! The smallest turn of each camera about its own centre after which the silhouettes agree best: by that angle a camera
//! looks beside where its calibration says.

use glam::DVec3;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::agreement::{CAP, Moment, Ray, again, disagreement, rays};
use super::finding::Finding;
use super::partners::{fewer, partners};
use crate::geometry::{Camera, rodrigues_matrix};

/// Residuals beyond this many pixels are taken for faults of the silhouettes and weigh ever less.
const SCALE: f64 = 1.5;
/// Turns cost what one ray costs that is off by this many pixels a degree: where silhouettes say nothing, nothing moves.
const PRIOR: f64 = 1.0;
/// Rounds of Gauss and Newton.
const ROUNDS: usize = 8;
/// Step of the differences, radians.
const STEP: f64 = 1e-3;

/// Cameras that look farther beside than this, degrees, spoil a track: a person 4 m away is then off by 14 mm.
const BESIDE: f64 = 0.2;
/// Turns about the view's own axis move a person in the middle of the picture hardly at all, and show as little.
const ROLLED: f64 = 0.6;
/// Rays a silhouette.
const RAYS: usize = 80;

/// By which angles each camera looks beside its calibration, and is rolled against it.
pub(super) fn turns(cameras: &[Camera], moments: &[Moment]) -> Vec<Finding> {
    let found = best_turns(cameras, moments);
    let after: Vec<Camera> = cameras.iter().zip(&found).map(|(camera, turn)| turned(camera, *turn)).collect();
    let count = fewer(RAYS, cameras.len());
    let [before, after] = [cameras, &after].map(|cameras| disagreement(&rays(cameras, moments, count), CAP));
    let finding = |(camera, turn): (&Camera, &DVec3)| {
        let [right, down, ahead] = turn.to_array().map(f64::to_degrees);
        let advice = "the camera was moved since its calibration, or that is not exact: calibrate it anew, or refine it on \
                      points that several cameras see";
        [
            Finding::number("direction", "degrees", right.hypot(down), [0.0, BESIDE])
                .of(&camera.name)
                .found(format!(
                    "turned by {right:.2} about its x (to the right) and {down:.2} about its y (down) the views agree best: \
                     {before:.3} px become {after:.3} with all cameras turned"
                ))
                .or(advice),
            Finding::number("roll", "degrees", ahead, [-ROLLED, ROLLED])
                .of(&camera.name)
                .found("about the view, clockwise")
                .or(advice),
        ]
    };
    cameras.iter().zip(&found).flat_map(finding).collect()
}

/// The camera turned about its centre by a Rodrigues vector in its own axes, radians.
fn turned(camera: &Camera, turn: DVec3) -> Camera {
    let mut turned = camera.clone();
    let turn = rodrigues_matrix(turn);
    turned.camera_from_world.matrix3 = turn * camera.camera_from_world.matrix3;
    turned.camera_from_world.translation = turn * camera.camera_from_world.translation;
    turned
}

/// The turn of each camera, camera axes (x right, y down, z ahead), radians.
fn best_turns(cameras: &[Camera], moments: &[Moment]) -> Vec<DVec3> {
    let mut turns = vec![DVec3::ZERO; cameras.len()];
    let mut best = (f64::INFINITY, turns.clone());
    let mut damping = 1.0;
    for _ in 0..ROUNDS {
        let current: Vec<Camera> = cameras.iter().zip(&turns).map(|(camera, turn)| turned(camera, *turn)).collect();
        let rays = rays(&current, moments, fewer(RAYS, cameras.len()));
        let cost = cost(&rays, &turns);
        if cost < best.0 {
            best = (cost, turns.clone());
            damping = f64::max(damping * 0.5, 0.25);
        } else {
            // A step too far: back half the way.
            turns = best.1.iter().zip(&turns).map(|(a, b)| (*a + *b) * 0.5).collect();
            damping *= 4.0;
            continue;
        }
        let step = step(&current, moments, &rays, &turns, damping);
        let Some(step) = step else { break };
        let longest = step.iter().map(|turn| turn.length()).fold(0.0, f64::max);
        turns = turns.iter().zip(&step).map(|(turn, step)| *turn + *step * (0.02 / longest).min(1.0)).collect();
        if longest < 1e-5 {
            break;
        }
    }
    best.1
}

fn weight(excess: f64) -> f64 {
    1.0 / (1.0 + (excess / SCALE).powi(2))
}

fn prior(rays: usize) -> f64 {
    // Of a share of the rays, so that more of them do not drown it.
    PRIOR.to_degrees().powi(2) * 0.002 * rays as f64
}

fn cost(rays: &[Ray], turns: &[DVec3]) -> f64 {
    let seen: f64 = rays.iter().map(|ray| SCALE * SCALE * (1.0 + (ray.excess() / SCALE).powi(2)).ln()).sum();
    (seen + prior(rays.len()) * turns.iter().map(|turn| turn.length_squared()).sum::<f64>()) / rays.len().max(1) as f64
}

/// One damped Gauss-Newton step.
fn step(cameras: &[Camera], moments: &[Moment], rays: &[Ray], turns: &[DVec3], damping: f64) -> Option<Vec<DVec3>> {
    let unknowns = 3 * cameras.len();
    let moved: Vec<[Vec<Camera>; 2]> = (0..unknowns)
        .map(|unknown| {
            [STEP, -STEP].map(|step| {
                let mut moved = cameras.to_vec();
                let mut turn = DVec3::ZERO;
                turn[unknown % 3] = step;
                moved[unknown / 3] = turned(&cameras[unknown / 3], turn);
                moved
            })
        })
        .collect();
    // What moves a ray's miss: its own camera's turn and those of the cameras that it is compared with.
    let equations = |ray: &Ray| {
        let moment = &moments[ray.moment];
        let excess = |cameras: &[Camera]| again(cameras, moment, ray).map(|miss| (miss + 0.5).max(0.0));
        let mut involved = partners(ray.view, cameras.len());
        involved.push(ray.view);
        involved.sort_unstable();
        let row = involved.into_iter().flat_map(|camera| 3 * camera..3 * camera + 3).map(|unknown| {
            let [up, down] = &moved[unknown];
            let slope = match (excess(up), excess(down)) {
                (Some(up), Some(down)) => (up - down) / (2.0 * STEP),
                _ => 0.0,
            };
            (unknown, slope)
        });
        (row.collect::<Vec<_>>(), ray.excess())
    };
    let sum = |(mut matrix, mut vector): (DMatrix<f64>, DVector<f64>), (row, excess): (Vec<(usize, f64)>, f64)| {
        let weight = weight(excess);
        for &(at, slope) in &row {
            vector[at] += weight * excess * slope;
            for &(other, along) in &row {
                matrix[(at, other)] += weight * slope * along;
            }
        }
        (matrix, vector)
    };
    let nothing = || (DMatrix::zeros(unknowns, unknowns), DVector::zeros(unknowns));
    // Summed in the rays' order, so that the sums are the same on every run.
    let rows: Vec<_> = rays.par_iter().map(equations).collect();
    let (mut matrix, mut vector) = rows.into_iter().fold(nothing(), sum);
    let prior = prior(rays.len());
    for unknown in 0..unknowns {
        matrix[(unknown, unknown)] += prior;
        vector[unknown] += prior * turns[unknown / 3][unknown % 3];
        matrix[(unknown, unknown)] *= 1.0 + 0.1 * damping;
    }
    let solution = matrix.cholesky()?.solve(&vector);
    let mut step = vec![DVec3::ZERO; cameras.len()];
    for unknown in 0..unknowns {
        step[unknown / 3][unknown % 3] = -solution[unknown];
    }
    Some(step)
}

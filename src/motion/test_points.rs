//! What the tests of the formats share: trajectories to write and read again, and the way to the real files.

use std::path::PathBuf;

use glam::DVec3;
use proptest::prelude::*;

use super::points::PointTrajectory;

/// Any trajectory a format can hold: blanks and accents in names, missing points, a start other than 0.
pub(crate) fn trajectories() -> impl Strategy<Value = PointTrajectory> {
    let coordinate = prop_oneof![4 => -5000.0..5000.0f64, 1 => -1e5..1e5f64, 1 => Just(0.0)];
    let point = proptest::option::weighted(0.8, [coordinate.clone(), coordinate.clone(), coordinate]);
    (proptest::collection::hash_set("[A-Za-zé][A-Za-z0-9 _:é]{0,9}[A-Za-z0-9]", 1..5), 1..6usize).prop_flat_map(
        move |(names, frames)| {
            let row = proptest::collection::vec(point.clone(), names.len());
            (proptest::collection::vec(row, frames), prop_oneof![Just(25.0), Just(59.94), 1.0..1000.0f64], 0..5000usize)
                .prop_map(move |(rows, rate, first_frame)| PointTrajectory {
                    names: names.iter().cloned().collect(),
                    // Rates are kept to what 32 bits hold, as C3D keeps them.
                    rate: f64::from(super::points::meant_rate(rate) as f32),
                    first_frame,
                    frames: rows.into_iter().map(|r| r.into_iter().map(|p| p.map(DVec3::from)).collect()).collect(),
                    smoothed: None,
                })
        },
    )
}

/// Equal names, rate, frames and missing points; coordinates within `tolerance` mm and 32-bit rounding.
pub(crate) fn close(a: &PointTrajectory, b: &PointTrajectory, tolerance: f64) -> bool {
    let point = |p: &Option<DVec3>, q: &Option<DVec3>| match (p, q) {
        (Some(p), Some(q)) => (*p - *q).abs().max_element() <= tolerance + 1e-7 * p.abs().max_element(),
        (None, None) => true,
        _ => false,
    };
    a.names == b.names
        // A rate that is hardly farther from a whole number than what is rounded is rounded when its times are.
        && (a.rate - b.rate).abs() <= 1.01e-4 * a.rate
        && a.first_frame == b.first_frame
        && a.frames.len() == b.frames.len()
        && a.frames.iter().zip(&b.frames).all(|(p, q)| p.len() == q.len() && p.iter().zip(q).all(|(p, q)| point(p, q)))
}

/// A folder of the real data, or a visible line that the test is skipped.
pub(crate) fn real_data(test: &str, folder: &str) -> Option<PathBuf> {
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data")).join(folder);
    if !path.is_dir() {
        println!("SKIPPED {test}: ../shared/data is absent");
        return None;
    }
    Some(path)
}

/// `a` moves along x a millimetre a frame, `b` along y.
pub(crate) fn trajectory(rate: f64, first_frame: usize, frames: usize) -> PointTrajectory {
    let row = |i: usize| {
        let seconds = (first_frame + i) as f64 / rate;
        vec![Some(DVec3::new(seconds * 100.0, 0.0, 0.0)), Some(DVec3::new(0.0, seconds * 50.0, 1000.0))]
    };
    PointTrajectory {
        names: vec!["a".into(), "b".into()],
        rate,
        first_frame,
        frames: (0..frames).map(row).collect(),
        smoothed: None,
    }
}

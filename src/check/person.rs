//! The surface that the views agree on: does it stand on the floor, upright, and has it the size of a person?

use std::path::Path;

use anyhow::Result;
use glam::DVec3;

use super::agreement::{EXPLAINED, Ray, WELL_EXPLAINED, percent_explained};
use super::finding::Finding;
use crate::body::Body;

/// Part of the points cut off below and above: specks, and where few cameras look.
const OUTLIERS: f64 = 0.005;
/// Part of the points left out at either end where the person's shape is asked for: a ray whose other views are nearly
/// parallel agrees far behind the person too.
const BEYOND_SHAPE: f64 = 0.1;

/// Feet, height and shape; and the height of the body file against it, where there is one.
///
/// # Errors
/// When the body file cannot be read.
pub(super) fn person(rays: &[Ray], body: Option<&Path>) -> Result<Vec<Finding>> {
    let agreed: Vec<&Ray> = rays.iter().filter(|ray| ray.excess() <= EXPLAINED).collect();
    let last = rays.iter().map(|ray| ray.moment).max().unwrap_or(0);
    let (mut feet, mut heights, mut shapes) = (Vec::new(), Vec::new(), Vec::new());
    for moment in 0..=last {
        let points: Vec<DVec3> = agreed.iter().filter(|ray| ray.moment == moment).map(|ray| ray.point).collect();
        if points.len() < 20 {
            continue;
        }
        let [low, high] = extent(&points, DVec3::Z, OUTLIERS);
        feet.push(low);
        heights.push(high - low);
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
            let [begin, end] = extent(&points, axis, BEYOND_SHAPE);
            end - begin
        });
        shapes.push(z / x.max(y));
    }
    let (Some(feet), Some(height), Some(shape)) = (median(feet), median(heights), median(shapes)) else {
        return Ok(vec![Finding::not_measured("feet", "the views agree on too little of the person")]);
    };
    // Silhouettes that lose legs make a person short and let it hang in the air, whatever the calibration.
    let is_whole = percent_explained(rays) >= WELL_EXPLAINED;
    let doubtful = |finding: Finding, range: [f64; 2]| if is_whole { finding } else { finding.doubtful_within(range) };
    let feet_found =
        Finding::number("feet", "mm above z = 0", feet, [-150.0, 200.0]).found("median of the lowest points");
    let height_found =
        Finding::number("height", "mm", height, [1000.0, 2300.0]).found("median from the lowest to the highest point");
    let shape_found = Finding::number("upright", "of the breadth", shape, [0.6, f64::INFINITY])
        .found("height over the larger horizontal extent of the middle four fifths");
    let mut checks = vec![
        doubtful(feet_found, [-600.0, 1200.0]).or(if feet < -600.0 {
            "the person hangs below the floor: z points down, turn the calibration's world over"
        } else {
            "z = 0 is not the floor the person stands on: move the calibration's world there, or check its units"
        }),
        doubtful(height_found, [500.0, 4600.0]).or(unit_advice(height)),
        doubtful(shape_found, [0.3, f64::INFINITY]).or("the person lies on the side: is z the axis upwards?"),
    ];
    if let Some(path) = body {
        let body = Body::load(path)?;
        let joints = body.joint_positions(&body.world_from_bones(&body.standing_pose())?);
        let levels = joints.iter().map(|joint| joint.z);
        let (low, high) = levels.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
        let found = Finding::number("body", "of the person's height", (high - low) / height, [0.75, 1.35])
            .found(format!("the joints of {} span {:.0} mm", path.display(), high - low));
        checks.push(
            doubtful(found, [0.37, 2.7]).or("measure the person with `pantin fit`, and check the units of body.toml"),
        );
    }
    Ok(checks)
}

fn unit_advice(height: f64) -> String {
    const UNITS: [(f64, &str); 5] =
        [(1000.0, "metres"), (100.0, "decimetres"), (10.0, "centimetres"), (25.4, "inches"), (0.001, "micrometres")];
    // The unit that makes the person most like one of 1700 mm.
    let likely = UNITS.iter().min_by(|a, b| {
        let off = |unit: f64| (height * unit / 1700.0).ln().abs();
        off(a.0).total_cmp(&off(b.0))
    });
    match likely.filter(|(unit, _)| (0.6..1.6).contains(&(height * unit / 1700.0))) {
        Some((_, unit)) => format!("the calibration's lengths look like {unit}: state its unit, or convert them to mm"),
        None => {
            "check the unit of the calibration's lengths, and whether the silhouettes show a whole person".to_string()
        }
    }
}

/// Where points begin and end along an axis, without the farthest part `beyond` at either.
fn extent(points: &[DVec3], axis: DVec3, beyond: f64) -> [f64; 2] {
    let mut places: Vec<f64> = points.iter().map(|point| point.dot(axis)).collect();
    places.sort_by(f64::total_cmp);
    let cut = (beyond * places.len() as f64) as usize;
    [places[cut], places[places.len() - 1 - cut]]
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

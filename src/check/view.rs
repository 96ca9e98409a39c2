//! What the calibration alone tells: lenses, and the space that the cameras share.

use glam::{DVec2, DVec3};

use super::finding::Finding;
use crate::geometry::{Camera, Lens};

/// Side of a cell of space, mm, and the cells looked at: 8 m by 8 m, and 2.2 m above the floor.
const CELL: f64 = 100.0;
const HALF: i32 = 40;
const HIGH: i32 = 22;
/// Lenses of 85 degrees and more move the picture's rim by half of its half diagonal, %; few by more.
const WIDE: f64 = 60.0;

/// Distortion, branch, field of view and pixel shape of every camera.
pub(super) fn lenses(cameras: &[Camera]) -> Vec<Finding> {
    cameras.iter().flat_map(|camera| [distortion(camera), field_of_view(camera), aspect(camera)]).collect()
}

/// By which part of the half diagonal the lens moves the picture's corners.
fn distortion(camera: &Camera) -> Finding {
    let [width, height] = camera.size.map(|side| f64::from(side) - 1.0);
    let half_diagonal = 0.5 * width.hypot(height);
    let around = (0..=16).flat_map(|at| {
        let part = f64::from(at) / 16.0;
        [DVec2::new(part, 0.0), DVec2::new(part, 1.0), DVec2::new(0.0, part), DVec2::new(1.0, part)]
    });
    // A pixel that no point has as its image lies past the end of the distortion's branch.
    let shift = |pixel: DVec2| {
        camera
            .lens
            .undistort(camera.lens.from_pixel(pixel))
            .map_or(f64::INFINITY, |at| camera.lens.to_pixel(at).distance(pixel))
    };
    let largest = around.map(|part| shift(part * DVec2::new(width, height))).fold(0.0, f64::max);
    let percent = 100.0 * largest / half_diagonal;
    let found = if largest.is_finite() {
        format!("the lens moves the picture's rim by up to {largest:.1} px")
    } else {
        "part of the picture lies past the end of the distortion's branch, where no point has an image".to_string()
    };
    Finding::number("distortion", "% of the half diagonal", percent, [0.0, WIDE])
        .doubtful_within([0.0, f64::MAX])
        .of(&camera.name)
        .found(found)
        .or("check the order k1 k2 p1 p2 (k3), and whether coefficients in another program's scale were copied; calibrate anew")
}

fn field_of_view(camera: &Camera) -> Finding {
    let focal = focal(camera);
    let [width, height] = camera.size.map(f64::from);
    let degrees = |side: f64, focal: f64| 2.0 * (0.5 * side / focal).atan().to_degrees();
    let angles = [degrees(width, focal.x), degrees(height, focal.y)];
    Finding::number("field of view", "degrees", angles[0].max(angles[1]), [5.0, 130.0])
        .of(&camera.name)
        .found(format!("{:.0} by {:.0} degrees", angles[0], angles[1]))
        .or("the focal length belongs to pictures of another size: calibrate at the size of the pictures, or scale fx fy cx cy")
}

fn aspect(camera: &Camera) -> Finding {
    let focal = focal(camera);
    Finding::number("pixel shape", "fx / fy", focal.x / focal.y, [0.9, 1.12])
        .of(&camera.name)
        .found(String::new())
        .or("pixels are square in nearly every camera: was the picture stretched, or turned after calibration?")
}

fn focal(camera: &Camera) -> DVec2 {
    match camera.lens {
        Lens::Tsai(lens) => DVec2::new(lens.sx, 1.0) * lens.f / lens.pitch,
        Lens::BrownConrady(lens) => lens.focal,
    }
}

/// The space round `middle` that at least three cameras see (two where there are two).
pub(super) fn volume(cameras: &[Camera], middle: DVec3) -> [Finding; 2] {
    let enough = cameras.len().min(3);
    let (mut cells, mut floor) = (0_u32, 0_u32);
    for z in 0..HIGH {
        for (x, y) in (-HALF..=HALF).flat_map(|x| (-HALF..=HALF).map(move |y| (x, y))) {
            let above = (f64::from(z) + 0.5) * CELL;
            let point = DVec3::new(middle.x + f64::from(x) * CELL, middle.y + f64::from(y) * CELL, above);
            let seeing = cameras.iter().filter(|camera| sees(camera, point)).count();
            cells += u32::from(seeing >= enough);
            floor += u32::from(z == 0 && seeing >= enough);
        }
    }
    let by = format!("by {enough} of {} cameras", cameras.len());
    let advice = "turn or move cameras, or check rotations, translations and units: they look past each other";
    [
        Finding::number("common volume", "m³", f64::from(cells) * (CELL / 1000.0).powi(3), [1.5, f64::INFINITY])
            .found(format!("seen {by}, up to 2.2 m above z = 0"))
            .or(advice),
        Finding::number("common floor", "m²", f64::from(floor) * (CELL / 1000.0).powi(2), [0.3, f64::INFINITY])
            .found(format!("seen {by} at z = 0"))
            .or(format!("{advice}; or z = 0 is not the floor")),
    ]
}

fn sees(camera: &Camera, point: DVec3) -> bool {
    let [width, height] = camera.size.map(f64::from);
    camera
        .project(point)
        .is_some_and(|pixel| (-0.5..width - 0.5).contains(&pixel.x) && (-0.5..height - 0.5).contains(&pixel.y))
}

/// How far the cameras' upward directions lean from z, on average.
pub(super) fn up_axis(cameras: &[Camera]) -> Finding {
    let up: DVec3 = cameras.iter().map(|camera| -camera.camera_from_world.matrix3.row(1)).sum();
    let degrees = up.normalize_or_zero().z.clamp(-1.0, 1.0).acos().to_degrees();
    let nearest = [("x", DVec3::X), ("-x", -DVec3::X), ("y", DVec3::Y), ("-y", -DVec3::Y), ("-z", -DVec3::Z)]
        .into_iter()
        .max_by(|a, b| a.1.dot(up).total_cmp(&b.1.dot(up)))
        .map_or("", |(name, _)| name);
    Finding::number("up axis", "degrees", degrees, [0.0, 50.0])
        .found("between z and the mean upward direction of the pictures")
        .or(format!(
            "the calibration's world has {nearest} upwards: turn it so that z points up and z = 0 is the floor (or the cameras \
             hang on their side, in which case turn the pictures)"
        ))
}

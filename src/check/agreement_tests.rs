use glam::DAffine3;

use super::*;
use crate::check::turns::turned;
use crate::features::BitImage;
use crate::geometry::{BrownConrady, Lens};

/// Four cameras round a few small balls, and what they see of them. Of a big one a view tells little: its border lies inside in the others.
fn scene() -> (Vec<Camera>, Vec<SignedDistance>) {
    let size = [320, 240];
    let (centre, focal) = (DVec2::new(159.5, 119.5), DVec2::splat(300.0));
    let lens = Lens::BrownConrady(BrownConrady { focal, centre, radial: [-0.05, 0.02, 0.0], tangential: [0.0; 2] });
    let camera = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let eye = DVec3::new(3000.0 * cos, 3000.0 * sin, 1200.0 + 2.0 * degrees);
        let ahead = (DVec3::new(0.0, 0.0, 1000.0) - eye).normalize();
        let right = ahead.cross(DVec3::Z).normalize();
        let world_from_camera = DMat3::from_cols(right, ahead.cross(right), ahead);
        let camera_from_world = DAffine3::from_mat3_translation(world_from_camera, eye).inverse();
        Camera { name: format!("{degrees}"), size, camera_from_world, lens }
    };
    let cameras: Vec<Camera> = [10.0, 85.0, 160.0, 250.0].map(camera).to_vec();
    let balls = [
        [0.0, 0.0, 1500.0, 110.0],
        [20.0, 240.0, 1200.0, 60.0],
        [250.0, -200.0, 1000.0, 70.0],
        [-60.0, 90.0, 600.0, 80.0],
    ];
    let seen = |camera: &Camera| {
        let inside = |x: u32, y: u32| {
            let (origin, direction) = camera.ray(DVec2::new(f64::from(x), f64::from(y))).unwrap();
            balls.iter().any(|[x, y, z, radius]| (DVec3::new(*x, *y, *z) - origin).cross(direction).length() < *radius)
        };
        SignedDistance::of(&BitImage::from_fn(size[0], size[1], inside), 1, None).unwrap()
    };
    let fields = cameras.iter().map(seen).collect();
    (cameras, fields)
}

#[test]
fn right_cameras_agree_and_a_turned_one_does_not() {
    let (cameras, fields) = scene();
    let moments = [fields.iter().map(Some).collect::<Moment>()];
    let found = rays(&cameras, &moments, 40);
    let right = disagreement(&found, CAP);
    assert!(found.len() > 120 && right < 0.1, "{right}");
    assert!(percent_explained(&found) > 99.0);
    let mut turned_away = cameras.clone();
    turned_away[1] = turned(&cameras[1], DVec3::new(0.0, 0.01, 0.0));
    let apart = disagreement(&rays(&turned_away, &moments, 40), CAP);
    assert!(apart > 2.5 * right, "{apart} {right}");
}

/// Who leaves a camera's picture is not missed there; who is in it and not seen is.
#[test]
fn a_view_is_asked_for_those_who_are_in_its_picture() {
    let (cameras, fields) = scene();
    let mut away = cameras.clone();
    away[1] = turned(&cameras[1], DVec3::new(0.0, 1.2, 0.0));
    let moment = |seen: [bool; 4]| -> Moment<'_> {
        fields.iter().zip(seen).map(|(field, seen)| seen.then_some(field)).collect()
    };
    let all = moment([true; 4]);
    let [missed, alone, nobody] = [[true, false, true, true], [true, false, false, false], [false; 4]].map(moment);
    let percent = |cameras: &[Camera], moments: &[&Moment]| -> f64 {
        let moments: Vec<Moment> = moments.iter().map(|moment| (*moment).clone()).collect();
        percent_seen(cameras, &moments, 1)
    };
    assert_eq!(percent(&cameras, &[&all, &missed]), 50.0);
    assert_eq!(percent(&away, &[&all, &missed]), 100.0, "he is not in the second's picture");
    assert_eq!(percent(&away, &[&missed, &missed]), 0.0, "he never is");
    assert_eq!(percent(&cameras, &[&all, &nobody, &nobody]), 100.0, "nobody is there");
    assert_eq!(percent(&cameras, &[&nobody, &nobody]), 0.0);
    assert_eq!(percent(&away, &[&all, &alone]), 50.0, "one view does not tell where he is");
}

/// How a small turn of each camera changes what rays miss by, beside a search of each ray with that camera turned.
#[test]
fn small_turns_do_what_a_search_finds() {
    let (mut cameras, fields) = scene();
    // Off, so that rays miss by something.
    cameras[2] = turned(&cameras[2], DVec3::new(0.004, -0.006, 0.002));
    let moments = [fields.iter().map(Some).collect::<Moment>()];
    let found = rays(&cameras, &moments, 60);
    let slope = |view: usize, axis: DVec3| {
        let [up, down] = [1.5e-3, -1.5e-3].map(|angle| turned(&cameras[view], axis * angle));
        let searched = |changed: &Camera| -> f64 {
            let mut all = cameras.clone();
            all[view] = changed.clone();
            let searched = rays(&all, &moments, 60);
            assert_eq!(searched.len(), found.len());
            searched.iter().map(|ray| ray.excess().powi(2)).sum()
        };
        let near = |changed: &Camera| -> f64 {
            let excess = |ray: &Ray| Near::of(&cameras, &moments[0], ray).excess_with(view, changed).unwrap();
            found.iter().map(|ray| excess(ray).powi(2)).sum()
        };
        [searched(&up) - searched(&down), near(&up) - near(&down)]
    };
    let views = 0..cameras.len();
    let slopes: Vec<[f64; 2]> =
        views.flat_map(|view| [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| slope(view, axis))).collect();
    let length = |of: &dyn Fn(&[f64; 2]) -> f64| slopes.iter().map(|slope| of(slope).powi(2)).sum::<f64>().sqrt();
    let (searched, apart) = (length(&|slope| slope[0]), length(&|slope| slope[1] - slope[0]));
    assert!(searched > 1.0 && apart < 0.2 * searched, "{apart} of {searched}: {slopes:?}");
}

/// Where a view is surely far it says so when asked, over the whole length of rays, and leaving such places out changes no ray's best point.
#[test]
fn places_that_are_left_out_are_far() {
    let (mut cameras, fields) = scene();
    // Whose picture ends beside the balls; and a lens that bends much.
    cameras[1] = turned(&cameras[1], DVec3::new(0.05, 0.45, 0.1));
    let Lens::BrownConrady(lens) = &mut cameras[3].lens else { panic!("no such lens") };
    (lens.radial, lens.tangential) = ([-0.25, 0.08, 0.0], [0.004, -0.003]);
    let moment: Moment = fields.iter().map(Some).collect();
    let far: Vec<Option<SurelyFar>> =
        cameras.iter().zip(&fields).map(|(camera, field)| SurelyFar::of(camera, field)).collect();
    assert!(far.iter().all(Option::is_some));
    let (mut left_out, mut places) = (0, 0);
    for (view, field) in fields.iter().enumerate() {
        for pixel in field.border().iter().step_by(5) {
            let (origin, direction) = cameras[view].ray(*pixel).unwrap();
            let search = |far: Vec<Option<SurelyFar>>| {
                let middle = DVec3::new(0.0, 0.0, 1000.0);
                Looked { index: 0, moment: &moment, middle, far }.best(&cameras, view, origin, direction)
            };
            assert_eq!(search(far.clone()), search(vec![None; 4]), "view {view}, {pixel}");
            for other in (0..4).filter(|other| *other != view) {
                let map = &cameras[other].camera_from_world;
                let along = far[other].unwrap().along(map.transform_point3(origin), map.transform_vector3(direction));
                for place in (0..600).map(|at| f64::from(at) * 10.0).filter(|&place| is_far(along, place)) {
                    let asked = said(&cameras[other], &fields[other], origin + direction * place);
                    assert_eq!(asked, Some(fields[other].farthest()), "view {view}, {pixel}, {other} at {place}");
                    left_out += 1;
                }
                places += 600;
            }
        }
    }
    assert!(4 * left_out > places, "{left_out} of {places}");
}

#[test]
fn the_least_of_the_largest_is_where_lines_cross() {
    // One that rises and one that falls meet at 4, half way; a third lies below them.
    let lines = [(2.0, 0.5), (6.0, -0.5), (3.0, 0.1)];
    assert_eq!(least_of_the_largest(&lines), Some(4.0));
    // Falling alone: as far as is looked.
    assert_eq!(least_of_the_largest(&[(2.0, -0.1)]), Some(2.0 - 0.1 * NEAR));
    assert_eq!(least_of_the_largest(&[]), None);
}

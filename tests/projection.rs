//! What the swarm is projected with (single precision) against the cameras' own projection (double precision).

use glam::{DVec2, DVec3};
use pantin::body::{ADULT_HEIGHT, Body};
use pantin::evaluate::Projector;
use pantin::geometry::{BrownConrady, Camera, Lens, Tsai};

/// Four cameras around the origin, two of each lens.
fn cameras() -> Vec<Camera> {
    let tsai = |kappa| {
        let (centre, pitch) = (DVec2::new(318.0, 243.0), DVec2::new(0.011, 0.0108));
        Lens::Tsai(Tsai { f: 7.5, kappa, centre, sx: 1.01, pitch })
    };
    let brown = |radial| {
        let (focal, centre) = (DVec2::new(690.0, 684.0), DVec2::new(322.0, 238.0));
        Lens::BrownConrady(BrownConrady { focal, centre, radial, tangential: [0.0006, -0.0007] })
    };
    [tsai(-0.003), brown([-0.046, 0.14, 0.0]), tsai(0.002), brown([-0.2, 0.05, 0.01])]
        .into_iter()
        .enumerate()
        .map(|(index, lens)| {
            let angle = 0.3 + index as f64 * 1.5;
            let rotation = glam::DMat3::from_rotation_x(1.65) * glam::DMat3::from_rotation_z(angle);
            let vector = pantin::geometry::rodrigues_vector(rotation);
            Camera::from_rodrigues("cam", [640, 480], lens, vector, DVec3::new(40.0, 950.0, 4200.0))
        })
        .collect()
}

/// The corners of a truncated cone as METHOD A4 gives them.
fn corners(a: DVec3, b: DVec3, radius_a: f64, radius_b: f64, centre: DVec3) -> [DVec3; 4] {
    let r = (a - b).cross(centre - b).normalize();
    [a + r * radius_a, b + r * radius_b, b - r * radius_b, a - r * radius_a]
}

#[test]
fn single_precision_agrees_with_the_cameras() {
    let body = Body::adult(ADULT_HEIGHT).unwrap();
    let cameras = cameras();
    let projector = Projector::new(&body, &cameras);
    let mut worst = 0.0_f64;
    let mut compared = 0;
    for shift in 0..20 {
        let mut pose = body.standing_pose();
        for (index, value) in pose.iter_mut().enumerate() {
            let swing = (1.3 * index as f64 + 0.7 * f64::from(shift)).sin();
            *value += if index < 3 { 300.0 * swing } else { 0.5 * swing };
        }
        // The swarm's pose is single precision: start both from the same numbers.
        let single: Vec<f32> = pose.iter().map(|&value| value as f32).collect();
        let double: Vec<f64> = single.iter().map(|&value| f64::from(value)).collect();
        let bones = body.world_from_bones(&double).unwrap();
        for (view, camera) in cameras.iter().enumerate() {
            for (part, quad) in body.parts.iter().zip(projector.quads(&single, view)) {
                let bone = &bones[part.bone];
                let (a, b) = (bone.transform_point3(part.a), bone.transform_point3(part.b));
                let centre = camera.centre_in_world();
                // Along the limb the cross product loses its digits, and the rule is another one there.
                if (a - b).normalize().cross((centre - b).normalize()).length() < 0.05 {
                    continue;
                }
                let exact = corners(a, b, part.radius_a, part.radius_b, centre).map(|corner| camera.project(corner));
                assert_eq!(quad.drawn, exact.iter().all(Option::is_some), "{} in view {view}", part.name);
                for (corner, exact) in quad.corners.iter().zip(exact) {
                    let Some(exact) = exact else { continue };
                    let snapped = DVec2::new(f64::from(corner[0]), f64::from(corner[1])) / 256.0;
                    worst = worst.max((snapped - exact).abs().max_element());
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 4000, "{compared} corners compared");
    // Half a step of 1/256 pixel is the snapping alone.
    assert!(worst < 0.02, "{worst} px");
}

use proptest::prelude::*;

use super::super::TsaiConstants;
use super::*;

fn brown(radial: [f64; 3], tangential: [f64; 2]) -> Lens {
    let (focal, centre) = (DVec2::new(1675.0, 1668.0), DVec2::new(540.0, 955.0));
    Lens::BrownConrady(BrownConrady { focal, centre, radial, tangential })
}

fn tsai(kappa: f64) -> Lens {
    let (centre, pitch) = (DVec2::new(531.0, 948.0), DVec2::new(0.0055, 0.0056));
    Lens::Tsai(Tsai { f: 9.2, kappa, centre, sx: 1.01, pitch })
}

fn camera(lens: Lens) -> Camera {
    let (rotation, translation) = (DVec3::new(1.4, -1.39, 0.42), DVec3::new(508.0, 26.0, 4404.0));
    Camera::from_rodrigues("cam", [1080, 1920], lens, rotation, translation)
}

prop_compose! {
    fn any_lens()(
        is_tsai: bool, kappa in -0.004..0.004_f64, k1 in -0.3..0.3_f64, k2 in -0.2..0.2_f64, k3 in -0.1..0.1_f64,
        p in prop::array::uniform2(-0.002..0.002_f64),
    ) -> Lens {
        if is_tsai { tsai(kappa) } else { brown([k1, k2, k3], p) }
    }
}

proptest! {
    #[test]
    fn undistort_inverts_distort(lens in any_lens(), x in -0.7..0.7_f64, y in -0.7..0.7_f64) {
        let at = DVec2::new(x, y);
        if let Some(image) = lens.distort(at) {
            // At the very end of the branch the inverse has no slope: leave the last hundredth out.
            let near_the_end = lens.distort(at * 1.01).is_none();
            if !near_the_end {
                let back = lens.undistort(image).expect("an image has an origin");
                prop_assert!((back - at).length() < 1e-9, "{at} {back}");
            }
            prop_assert!((lens.from_pixel(lens.to_pixel(image)) - image).length() < 1e-14);
        }
    }

    #[test]
    fn points_of_a_ray_project_back(
        lens in any_lens(), u in 0.0..1080.0_f64, v in 0.0..1920.0_f64, distance in 1.0..20_000.0_f64,
    ) {
        let (camera, pixel) = (camera(lens), DVec2::new(u, v));
        if let Some((origin, direction)) = camera.ray(pixel) {
            prop_assert!((direction.length() - 1.0).abs() < 1e-14);
            prop_assert!(camera.project(origin).is_none(), "the centre itself has no image");
            prop_assert!(camera.project(origin - direction * distance).is_none(), "nor has what is behind");
            let ahead = origin + direction * distance;
            // A rounding may push a pixel of the very end over it.
            if let Some(back) = camera.project(ahead) {
                prop_assert!((back - pixel).length() < 1e-4, "{pixel} {back}");
            } else {
                prop_assert!(lens.distort(camera_coordinates(&camera, ahead) * 0.999_999).is_some());
            }
        }
    }

    #[test]
    fn a_step_in_the_world_moves_the_pixel_as_its_ray_says(
        lens in any_lens(), x in -800.0..800.0_f64, y in -800.0..800.0_f64, z in 2000.0..5000.0_f64,
    ) {
        // Finite differences: moving a point along its own ray leaves the pixel where it is, moving it across by h
        // leads to a ray that meets the moved point.
        let camera = camera(lens);
        let at = camera.camera_from_world.inverse().transform_point3(DVec3::new(x, y, z));
        if let (Some(pixel), Some(_)) = (camera.project(at), lens.distort(DVec2::new(x, y) / z * 1.05)) {
            let (origin, direction) = camera.ray(pixel).expect("a pixel that was projected has a ray");
            let h = 0.01;
            let along = camera.project(at + direction * h).expect("still in front");
            prop_assert!((along - pixel).length() / h < 1e-4);
            let across = camera.project(at + direction.any_orthonormal_vector() * h).expect("still on the branch");
            let slope = (across - pixel).length() / h;
            prop_assert!(slope > 0.0 && slope < 10.0, "{slope} pixels per mm");
            let moved = camera.ray(across).expect("on the branch").1;
            let turned = moved.cross(direction).length();
            prop_assert!((turned * (at - origin).length() / h - 1.0).abs() < 1e-3, "{turned}");
        }
    }

    #[test]
    fn scaling_follows_the_pixel_centres(
        lens in any_lens(), x in -800.0..800.0_f64, y in -800.0..800.0_f64, width in 1..4000_u32, height in 1..4000_u32,
    ) {
        let camera = camera(lens);
        let small = camera.scaled([width, height]);
        prop_assert_eq!(small.size, [width, height]);
        let at = camera.camera_from_world.inverse().transform_point3(DVec3::new(x, y, 4000.0));
        match (camera.project(at), small.project(at)) {
            (Some(full), Some(scaled)) => {
                let s = DVec2::new(f64::from(width) / 1080.0, f64::from(height) / 1920.0);
                prop_assert!((scaled - ((full + 0.5) * s - 0.5)).length() < 1e-8, "{full} {scaled}");
            }
            (None, None) => {}
            other => prop_assert!(false, "{other:?}"),
        }
    }

    #[test]
    fn tsai_agrees_with_a_bisection(kappa in -0.01..0.05_f64, r in 0.0..2.0_f64, turn in 0.0..6.3_f64) {
        let lens = tsai(kappa);
        let f = 9.2;
        // On the image plane in mm, straight from the specification: r_d (1 + kappa r_d^2) = r_u up to the branch's end.
        let r_u = f * r;
        let end = if kappa < 0.0 { (-1.0 / (3.0 * kappa)).sqrt() } else { r_u + 1.0 };
        let cubic = |r_d: f64| r_d * (1.0 + kappa * r_d * r_d);
        let image = lens.distort(DVec2::from_angle(turn) * r);
        let reach = cubic(end);
        if r_u > reach * (1.0 + 1e-12) {
            prop_assert!(image.is_none());
        } else if r_u < reach * (1.0 - 1e-12) {
            let (mut low, mut high) = (0.0, end);
            for _ in 0..200 {
                let middle = 0.5 * (low + high);
                if cubic(middle) < r_u { low = middle } else { high = middle }
            }
            let found = image.expect("before the branch's end").length() * f;
            prop_assert!((found - low).abs() < 1e-6 * (1.0 + low), "{found} {low}");
            prop_assert!((cubic(found) - r_u).abs() < 1e-12 * (1.0 + r_u), "{found} {r_u}");
        }
    }

    #[test]
    fn nothing_is_ever_nan(
        bits in prop::array::uniform12(any::<u64>()), is_tsai: bool, point in prop::array::uniform3(any::<f64>()),
    ) {
        // Whatever bits a file may have held: an image that exists is a number.
        let value = bits.map(f64::from_bits);
        let lens = if is_tsai {
            let (centre, pitch) = (DVec2::new(value[2], value[3]), DVec2::new(value[5], value[6]));
            Lens::Tsai(Tsai { f: value[0], kappa: value[1], centre, sx: value[4], pitch })
        } else {
            let (focal, centre) = (DVec2::new(value[0], value[1]), DVec2::new(value[2], value[3]));
            let (radial, tangential) = ([value[4], value[5], value[6]], [value[7], value[8]]);
            Lens::BrownConrady(BrownConrady { focal, centre, radial, tangential })
        };
        let camera = camera(lens);
        if let Some(pixel) = camera.project(DVec3::from_array(point)) {
            prop_assert!(pixel.is_finite());
        }
        if let Some((origin, direction)) = camera.ray(DVec2::new(value[9], value[10])) {
            prop_assert!(origin.is_finite() && direction.is_finite());
        }
    }
}

fn camera_coordinates(camera: &Camera, at: DVec3) -> DVec2 {
    let at = camera.camera_from_world.transform_point3(at);
    at.truncate() / at.z
}

#[test]
fn a_plain_pinhole_is_what_the_book_says() {
    let lens = brown([0.0; 3], [0.0; 2]);
    let camera = Camera::from_rodrigues("cam", [1080, 1920], lens, DVec3::ZERO, DVec3::new(0.0, 0.0, 1000.0));
    assert_eq!(camera.project(DVec3::new(100.0, -50.0, 0.0)), Some(DVec2::new(540.0 + 167.5, 955.0 - 83.4)));
    assert_eq!(camera.project(DVec3::new(0.0, 0.0, -1000.0)), None, "in the camera's own plane");
    assert_eq!(camera.project(DVec3::new(0.0, 0.0, -2000.0)), None, "behind");
    assert_eq!(camera.centre_in_world(), DVec3::new(0.0, 0.0, -1000.0));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(camera.project(DVec3::new(bad, 0.0, 0.0)), None);
        assert_eq!(camera.project(DVec3::new(0.0, 0.0, bad)), None);
        assert_eq!(camera.ray(DVec2::new(bad, 0.0)), None);
    }
}

#[test]
fn the_branch_of_tsai_ends_where_its_slope_does() {
    let (kappa, f) = (-0.004, 9.2);
    let lens = tsai(kappa);
    let end = (-1.0_f64 / (3.0 * kappa)).sqrt();
    let reach = end * 2.0 / 3.0 / f;
    let last = lens.distort(DVec2::X * reach * (1.0 - 1e-14)).unwrap();
    assert!((last.x * f - end).abs() < 1e-5, "{last}");
    assert_eq!(lens.distort(DVec2::X * reach * (1.0 + 1e-12)), None);
    assert_eq!(lens.undistort(DVec2::X * end / f * (1.0 + 1e-12)), None);
    assert!(lens.undistort(DVec2::X * end / f * (1.0 - 1e-12)).is_some());
}

#[test]
fn raw_constants_of_tsai_become_a_camera_and_come_back() {
    let raw = TsaiConstants {
        f: 9.25,
        kappa: -1e-4,
        cx: 529.5,
        cy: 945.4,
        sx: 1.02,
        ncx: 768.0,
        nfx: 1080.0,
        dx: 0.0078,
        dy: 0.00554,
        rx: 1.7,
        ry: -0.4,
        rz: 2.9,
        tx: 10.0,
        ty: 20.0,
        tz: 3000.0,
    };
    let raw_camera = raw.camera("cam", [1080, 1920]);
    let Lens::Tsai(lens) = raw_camera.lens else { panic!("{:?}", raw_camera.lens) };
    assert_eq!(lens.pitch, DVec2::new(0.0078 * (768.0 / 1080.0), 0.00554));
    // R = Rz Ry Rx: turn about x first, then about y, then about z.
    let turn = |v: DVec3| {
        let v = DVec3::new(v.x, v.y * raw.rx.cos() - v.z * raw.rx.sin(), v.y * raw.rx.sin() + v.z * raw.rx.cos());
        let v = DVec3::new(v.x * raw.ry.cos() + v.z * raw.ry.sin(), v.y, -v.x * raw.ry.sin() + v.z * raw.ry.cos());
        DVec3::new(v.x * raw.rz.cos() - v.y * raw.rz.sin(), v.x * raw.rz.sin() + v.y * raw.rz.cos(), v.z)
    };
    let point = DVec3::new(123.0, -456.0, 789.0);
    let expected = turn(point) + DVec3::new(10.0, 20.0, 3000.0);
    assert!((raw_camera.camera_from_world.transform_point3(point) - expected).length() < 1e-12 * 3000.0);

    let back = TsaiConstants::of(&raw_camera).unwrap();
    assert!((back.rx - raw.rx).abs() + (back.ry - raw.ry).abs() + (back.rz - raw.rz).abs() < 1e-14, "{back:?}");
    assert_eq!(back.camera("cam", [1080, 1920]).lens, raw_camera.lens);
    // At the gimbal's lock the angles differ, the rotation must not.
    for ry in [std::f64::consts::FRAC_PI_2, -std::f64::consts::FRAC_PI_2] {
        let camera = TsaiConstants { ry, ..raw }.camera("cam", [1080, 1920]);
        let again = TsaiConstants::of(&camera).unwrap().camera("cam", [1080, 1920]);
        let difference = again.camera_from_world.matrix3 - camera.camera_from_world.matrix3;
        assert!(difference.to_cols_array().iter().all(|d| d.abs() < 1e-14), "{difference}");
    }
    assert_eq!(TsaiConstants::of(&camera(brown([0.0; 3], [0.0; 2]))), None);
}

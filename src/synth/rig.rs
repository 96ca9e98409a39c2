//! Four cameras round the room, looking at its middle.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use crate::geometry::{BrownConrady, Camera, Lens};

/// Where a camera stands and what its lens is like.
struct Station {
    /// Place along x and y as fractions of the room's half size.
    at: [f64; 2],
    /// Height, mm.
    z: f64,
    /// Factor on the rig's focal length.
    zoom: f64,
    /// k1 k2
    radial: [f64; 2],
    /// p1 p2
    tangential: [f64; 2],
}

const STATIONS: [Station; 4] = [
    Station { at: [0.93, 0.90], z: 2150.0, zoom: 1.00, radial: [-0.110, 0.018], tangential: [0.0006, -0.0004] },
    Station { at: [-0.92, 0.93], z: 1850.0, zoom: 1.03, radial: [-0.095, 0.012], tangential: [-0.0005, 0.0003] },
    Station { at: [-0.94, -0.91], z: 2300.0, zoom: 0.98, radial: [-0.120, 0.022], tangential: [0.0003, 0.0006] },
    Station { at: [0.91, -0.94], z: 1600.0, zoom: 1.01, radial: [-0.080, 0.009], tangential: [-0.0004, -0.0005] },
];

/// Focal length over picture width: about 66 degrees across.
const FOCAL: f64 = 0.77;

/// The cameras for a room of `half_size` (mm) and pictures of `size` pixels, named cam1 to cam4.
pub fn four_cameras(half_size: DVec2, size: [u32; 2]) -> Vec<Camera> {
    let (width, height) = (f64::from(size[0]), f64::from(size[1]));
    // A picture narrower than 16:9 must still hold a person's height.
    let reference = width.min(height * 16.0 / 9.0);
    let camera = |(index, station): (usize, &Station)| {
        let centre = (half_size * DVec2::from(station.at)).extend(station.z);
        let focal = reference * FOCAL * station.zoom;
        // A principal point off the middle by a few thousandths, as real lenses have it.
        let shift = DVec2::new(0.004 - 0.003 * index as f64, 0.002 * index as f64 - 0.003) * reference;
        Camera {
            name: format!("cam{}", index + 1),
            size,
            camera_from_world: look_at(centre, DVec3::new(0.0, 0.0, 880.0)),
            lens: Lens::BrownConrady(BrownConrady {
                focal: DVec2::new(focal, focal * 1.002),
                centre: DVec2::new(0.5 * (width - 1.0), 0.5 * (height - 1.0)) + shift,
                radial: [station.radial[0], station.radial[1], 0.0],
                tangential: station.tangential,
            }),
        }
    };
    STATIONS.iter().enumerate().map(camera).collect()
}

/// The frame of an upright camera at `centre` that looks at `target`: x right, y down, z forward.
fn look_at(centre: DVec3, target: DVec3) -> DAffine3 {
    let forward = (target - centre).normalize_or(DVec3::X);
    let right = forward.cross(DVec3::Z).normalize_or(DVec3::X);
    let world_from_camera = DMat3::from_cols(right, forward.cross(right), forward);
    let camera_from_world = world_from_camera.transpose();
    DAffine3 { matrix3: camera_from_world, translation: -(camera_from_world * centre) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_the_room_is_in_every_picture_upright() {
        for size in [[480, 270], [640, 480], [270, 480], [1920, 1080]] {
            for camera in four_cameras(DVec2::new(3600.0, 3100.0), size) {
                // A person anywhere on the walking circle.
                for i in 0..24 {
                    let a = f64::from(i) * std::f64::consts::TAU / 24.0;
                    let foot = DVec3::new(a.cos(), a.sin(), 0.0) * 950.0;
                    let (low, high) = (camera.project(foot), camera.project(foot + DVec3::Z * 1780.0));
                    let (low, high) = (low.unwrap(), high.unwrap());
                    let end = DVec2::new(f64::from(size[0]), f64::from(size[1])) - 0.5;
                    let inside = |p: DVec2| p.cmpge(DVec2::splat(-0.5)).all() && p.cmple(end).all();
                    assert!(inside(low) && inside(high), "{} {size:?} {low} {high}", camera.name);
                    assert!(low.y > high.y, "feet below the head");
                }
            }
        }
    }
}

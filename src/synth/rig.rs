//! Cameras round the room, looking at its middle: four in the corners, any number in a ring, or those of a calibration.

use anyhow::{Result, bail};
use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::room::Room;
use super::scene::{LensKind, RigKind, RigSettings, StationSettings};
use crate::geometry::{BrownConrady, Camera, Lens, Tsai};
use crate::sequence::read_cameras;

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
            camera_from_world: look_at(centre, TARGET),
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

/// The cameras of a scene.
///
/// # Errors
/// When the calibration cannot be read, or a camera of it stands outside the room (the message names it).
pub fn cameras(settings: &RigSettings, room: &Room) -> Result<Vec<Camera>> {
    if let Some(path) = &settings.cameras {
        let cameras = read_cameras(path)?;
        for camera in &cameras {
            let centre = camera.centre_in_world();
            let inside =
                centre.truncate().abs().cmplt(room.half_size).all() && centre.z > 0.0 && centre.z < room.height;
            if !inside {
                bail!(
                    "{}: the camera {} stands at {centre:.0} mm, expected it inside the room of {:.0} x {:.0} x {:.0} mm: make [room] larger",
                    path.display(),
                    camera.name,
                    2.0 * room.half_size.x,
                    2.0 * room.half_size.y,
                    room.height
                );
            }
        }
        return Ok(cameras);
    }
    let mut cameras = match settings.preset {
        _ if !settings.station.is_empty() => stations(&settings.station, settings.size, room)?,
        RigKind::Ring => ring(settings.count, room.half_size, settings.size),
        RigKind::Corners => four_cameras(room.half_size, settings.size),
    };
    for camera in &mut cameras {
        let centre = camera.centre_in_world();
        // Low ceilings bring a camera down.
        if settings.station.is_empty() && centre.z > room.height - 100.0 {
            camera.camera_from_world = look_at(centre.with_z(room.height - 100.0), TARGET);
        }
        if let Lens::BrownConrady(lens) = &mut camera.lens {
            lens.focal *= settings.zoom;
            match settings.lens {
                LensKind::Pinhole => (lens.radial, lens.tangential) = ([0.0; 3], [0.0; 2]),
                LensKind::Tsai => camera.lens = Lens::Tsai(tsai(lens)),
                LensKind::BrownConrady => {}
            }
        }
    }
    Ok(cameras)
}

/// Cameras that stand where each is asked to.
fn stations(settings: &[StationSettings], size: [u32; 2], room: &Room) -> Result<Vec<Camera>> {
    let middle = (DVec2::new(f64::from(size[0]), f64::from(size[1])) - 1.0) * 0.5;
    let camera = |(index, station): (usize, &StationSettings)| {
        let name = format!("cam{}", index + 1);
        let at = DVec3::from(station.at);
        if !(at.truncate().abs().cmplt(room.half_size).all() && at.z > 0.0 && at.z < room.height) {
            bail!("the station of {name} is at {at:.0} mm, expected it inside the room");
        }
        let upright = look_at(at, DVec3::from(station.towards));
        Ok(Camera {
            name,
            size,
            camera_from_world: DAffine3::from_axis_angle(DVec3::Z, station.roll.to_radians()) * upright,
            lens: Lens::BrownConrady(BrownConrady {
                focal: DVec2::splat(station.focal),
                centre: middle + DVec2::from(station.centre),
                radial: [station.radial[0], station.radial[1], 0.0],
                tangential: station.tangential,
            }),
        })
    };
    settings.iter().enumerate().map(camera).collect()
}

/// A lens of 6 mm with the same focal length in pixels and, to first order, the same distortion.
fn tsai(lens: &BrownConrady) -> Tsai {
    let f = 6.0;
    let pitch = f / lens.focal;
    Tsai { f, kappa: -lens.radial[0] / (f * f), centre: lens.centre, sx: 1.0, pitch: DVec2::new(pitch.x, pitch.y) }
}

/// `count` cameras on an ellipse along the walls, at changing heights, named cam1 and so on.
fn ring(count: usize, half_size: DVec2, size: [u32; 2]) -> Vec<Camera> {
    let corners = four_cameras(half_size, size);
    (0..count)
        .map(|index| {
            let angle = std::f64::consts::TAU * (index as f64 + 0.5) / count as f64;
            let centre = (half_size * 0.94 * DVec2::from_angle(angle)).extend([2150.0, 1700.0, 2300.0][index % 3]);
            Camera {
                name: format!("cam{}", index + 1),
                camera_from_world: look_at(centre, TARGET),
                ..corners[index % 4].clone()
            }
        })
        .collect()
}

/// What they look at, mm.
const TARGET: DVec3 = DVec3::new(0.0, 0.0, 880.0);

/// The frame of an upright camera at `centre` that looks at `target`: x right, y down, z forward.
pub(super) fn look_at(centre: DVec3, target: DVec3) -> DAffine3 {
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
    fn rings_and_lenses() {
        let room = Room::new(&super::super::scene::RoomSettings::default()).unwrap();
        let settings = RigSettings { preset: RigKind::Ring, count: 7, lens: LensKind::Tsai, ..RigSettings::default() };
        let cameras = cameras(&settings, &room).unwrap();
        assert_eq!(cameras.len(), 7);
        let same = super::cameras(&RigSettings { lens: LensKind::BrownConrady, ..settings.clone() }, &room).unwrap();
        for (camera, brown) in cameras.iter().zip(&same) {
            let at = DVec3::new(300.0, -200.0, 1400.0);
            let (tsai, brown) = (camera.project(at).unwrap(), brown.project(at).unwrap());
            assert!(tsai.distance(brown) < 1.0, "{tsai} {brown}");
            assert!(
                tsai.distance(
                    super::cameras(&RigSettings { zoom: 2.0, ..settings.clone() }, &room).unwrap()[0]
                        .project(at)
                        .unwrap()
                ) > 5.0
            );
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cameras.toml");
        crate::sequence::write_cameras_toml(&path, &cameras, crate::files::Overwrite::Refuse).unwrap();
        let read = RigSettings { cameras: Some(path.clone()), ..RigSettings::default() };
        assert_eq!(super::cameras(&read, &room).unwrap().len(), 7);
        let small = super::super::scene::RoomSettings { size: [3000.0, 3000.0], ..Default::default() };
        let error = super::cameras(&read, &Room::new(&small).unwrap()).unwrap_err().to_string();
        assert!(
            error.contains("cameras.toml") && error.contains("cam1") && error.contains("make [room] larger"),
            "{error}"
        );
    }

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

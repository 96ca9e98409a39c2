//! Where the cameras stand: round the way that somebody goes, so that at least three see the whole person all the time.

use std::f64::consts::TAU;

use anyhow::{Result, bail, ensure};
use glam::{DAffine3, DVec2, DVec3};

use super::super::performance::Performance;
use super::super::rig::{self, look_at};
use super::super::room::Room;
use super::super::scene::{Gait, MotionSettings, RigSettings, RoomSettings, Scene, StationSettings};
use super::draws::Draws;
use crate::body::Body;
use crate::geometry::Camera;

/// Cameras that must see every joint in every frame.
const WITNESSES: usize = 3;
/// Room between a person and the walls at least, mm.
const TO_WALL: f64 = 1300.0;
/// Distance of a camera from a person at least, mm.
const TO_CAMERA: f64 = 1500.0;
/// Pixels that a joint is inside a picture at least.
const MARGIN: f64 = 4.0;
/// How often places are drawn, and from when on lenses get wider from time to time.
const TRIES: usize = 400;
const PATIENCE: usize = 60;

/// Sizes of pictures with their weights.
const SIZES: [(f64, [u32; 2]); 8] = [
    (2.0, [480, 270]),
    (2.0, [640, 360]),
    (2.0, [640, 480]),
    (1.0, [480, 360]),
    (1.0, [800, 450]),
    (1.0, [800, 600]),
    (0.7, [540, 540]),
    (1.0, [360, 640]),
];

/// Puts the first actor of a scene, who has his motion, and the cameras into its room, which grows where it is too small. Gives what
/// he does in the T-pose second.
///
/// # Errors
/// When the motion cannot be given to the body, or no place was found from which he is seen.
pub(super) fn place(draws: Draws, scene: &mut Scene, body: &Body) -> Result<MotionSettings> {
    let Some(actor) = scene.actor.first() else { bail!("nobody is there to be placed") };
    let centred = MotionSettings { at: [0.0, 0.0], ..actor.motion.clone() };
    // How large the room is says nothing of how he moves.
    let anywhere = Room::new(&RoomSettings { size: [50_000.0; 2], ..RoomSettings::default() })?;
    let performance = Performance::new(body, &centred, scene, &anywhere)?;
    let mut moments = Vec::with_capacity(scene.frames);
    for frame in 0..scene.frames {
        moments.push(joints(body, &performance.pose(frame as f64 / scene.fps)?)?);
    }
    let over = moments.iter().flatten().map(|at| at.truncate());
    let low = over.clone().reduce(DVec2::min).unwrap_or_default();
    let high = over.reduce(DVec2::max).unwrap_or_default();
    let needed = high - low + 2.0 * TO_WALL;
    for (side, needed) in scene.room.size.iter_mut().zip(needed.to_array()) {
        *side = side.max(needed.ceil());
    }
    let slack = (DVec2::from(scene.room.size) - needed) * 0.5;
    let shift = [("x", slack.x), ("y", slack.y)]
        .map(|(axis, slack)| draws.between(&format!("motion/{axis}"), [-0.6 * slack, 0.6 * slack]));
    let middle = DVec2::from(shift);
    let at = (middle - 0.5 * (low + high)).round();
    let t_pose = MotionSettings {
        gait: Some(Gait::TPose),
        at: middle.round().to_array(),
        heading: Some(draws.between("t-pose/heading", [-180.0, 180.0])),
        ..MotionSettings::default()
    };
    for joint in moments.iter_mut().flatten() {
        *joint += at.extend(0.0);
    }
    moments.push(joints(body, &Performance::new(body, &t_pose, scene, &anywhere)?.pose(0.0)?)?);
    scene.actor[0].motion.at = at.to_array();

    let room = Room::new(&scene.room)?;
    scene.rig.size = draws.one_of("rig/size", &SIZES).unwrap_or([640, 480]);
    let count = draws.one_of("rig/cameras", &[(4.5, 4), (3.0, 5), (2.5, 6)]).unwrap_or(4);
    for attempt in 0..TRIES {
        let stations = (0..count).map(|index| {
            let name = |what: &str| format!("rig/{attempt}/{index}/{what}");
            let first = TAU * draws.unit(&format!("rig/{attempt}/turn"));
            let angle = first + TAU * (index as f64 + draws.between(&name("angle"), [-0.3, 0.3])) / count as f64;
            let wider = 1.0 - 0.001 * attempt.saturating_sub(PATIENCE) as f64;
            station(draws, &name, angle, wider, &room, middle, scene.rig.size, &moments)
        });
        let Some(stations) = stations.collect::<Option<Vec<_>>>() else { continue };
        let rig = RigSettings { station: stations, ..scene.rig.clone() };
        let cameras = rig::cameras(&rig, &room)?;
        if cameras.iter().all(has_rays) && moments.iter().all(|moment| witnesses(&cameras, moment) >= WITNESSES) {
            scene.rig = rig;
            return Ok(t_pose);
        }
    }
    bail!(
        "no place for {count} cameras was found from which {WITNESSES} see him all the time, expected another seed or fewer frames"
    )
}

fn joints(body: &Body, pose: &[f64]) -> Result<Vec<DVec3>> {
    let joints = body.joint_positions(&body.world_from_bones(pose)?);
    ensure!(joints.iter().all(|at| at.is_finite()), "a pose of the motion is not finite");
    Ok(joints)
}

/// A camera near the wall in a direction from the room's middle, which looks roughly at the middle of the way and has a lens for it.
#[expect(clippy::too_many_arguments, reason = "everything that a camera depends on")]
fn station(
    draws: Draws,
    name: &dyn Fn(&str) -> String,
    angle: f64,
    wider: f64,
    room: &Room,
    middle: DVec2,
    size: [u32; 2],
    moments: &[Vec<DVec3>],
) -> Option<StationSettings> {
    let of = |what: &str, range: [f64; 2]| draws.between(&name(what), range);
    let direction = DVec2::from_angle(angle);
    let to_wall = (room.half_size / direction.abs()).min_element();
    let flat = direction * (to_wall * of("distance", [0.80, 0.96]));
    let at = flat.extend(of("height", [1000.0, (room.height - 150.0).min(2800.0)])).round();
    let towards = (middle.extend(of("aim z", [800.0, 1050.0]))
        + DVec3::new(of("aim x", [-250.0, 250.0]), of("aim y", [-250.0, 250.0]), 0.0))
    .round();
    let roll = of("roll", [-2.0, 2.0]);
    let camera_from_world = DAffine3::from_axis_angle(DVec3::Z, roll.to_radians()) * look_at(at, towards);
    let [width, height] = size.map(f64::from);
    // The longest focal length with which all that happens is in the picture.
    let mut longest = f64::INFINITY;
    for joint in moments.iter().flatten() {
        let seen = camera_from_world.transform_point3(*joint);
        if seen.z < 500.0 || joint.truncate().distance(at.truncate()) < TO_CAMERA {
            return None;
        }
        longest = longest.min(0.5 * width * seen.z / seen.x.abs()).min(0.5 * height * seen.z / seen.y.abs());
    }
    let reference = width.min(height * 16.0 / 9.0);
    let focal = (longest * of("fill", [0.68, 1.10]) * wider).clamp(0.55 * reference, 2.2 * reference);
    let k1 = of("k1", [-0.16, 0.04]);
    Some(StationSettings {
        at: at.to_array(),
        towards: towards.to_array(),
        roll,
        focal: (focal * 100.0).round() / 100.0,
        centre: [("cx", width), ("cy", height)].map(|(what, side)| side * of(what, [-0.015, 0.015])),
        radial: [k1, -k1 * of("k2", [0.0, 0.2])],
        tangential: [of("p1", [-0.001, 0.001]), of("p2", [-0.001, 0.001])],
    })
}

/// Whether the lens has a ray through every corner of the picture, so that the room can be drawn.
fn has_rays(camera: &Camera) -> bool {
    let [width, height] = camera.size.map(f64::from);
    let grid = |side: f64| (0..=8).map(move |i| side * f64::from(i) / 8.0 - 0.5);
    grid(width).all(|x| grid(height).all(|y| camera.ray(DVec2::new(x, y)).is_some()))
}

/// How many cameras have all joints in their pictures.
fn witnesses(cameras: &[Camera], joints: &[DVec3]) -> usize {
    let sees = |camera: &&Camera| {
        let size = DVec2::from(camera.size.map(f64::from));
        joints.iter().all(|joint| {
            let pixel = camera.project(*joint);
            pixel.is_some_and(|p| p.cmpge(DVec2::splat(MARGIN)).all() && p.cmple(size - 1.0 - MARGIN).all())
        })
    };
    cameras.iter().filter(sees).count()
}

//! Where somebody is seen: room, light and sensor. The ranges are frozen (docs/SCENES.md).

use super::super::finish::{FinishParameters, FinishSettings};
use super::super::scene::{CameraSettings, LightSettings, OutputSettings, PictureForm, RoomSettings, SensorSettings};
use super::draws::Draws;

/// A room, and what is seen of it behind a person: colours of the walls and the floor, sRGB.
pub(super) struct Stage {
    pub(super) room: RoomSettings,
    pub(super) wall: [f64; 3],
    pub(super) floor: [f64; 3],
}

/// A surface: its finish, and the colour it has on the whole.
type Surface = (Option<FinishSettings>, [f64; 3]);

/// What walls or floors may be made of.
#[derive(Clone, Copy)]
enum Make {
    /// As the room has them: panels and paper, tiles.
    Usual,
    Paint(Paint),
    /// A material by its name and mm to its unit.
    Material(&'static str, [f64; 2]),
}

/// Colours of paint, as ranges of brightness, and by how much single channels differ.
#[derive(Clone, Copy)]
enum Paint {
    White,
    Grey,
    Beige,
    Coloured,
}

pub(super) fn stage(draws: Draws) -> Stage {
    let walls = [
        (1.5, Make::Usual),
        (1.0, Make::Paint(Paint::White)),
        (2.0, Make::Paint(Paint::Grey)),
        (2.0, Make::Paint(Paint::Beige)),
        (1.5, Make::Paint(Paint::Coloured)),
        (0.8, Make::Material("brick", [250.0, 350.0])),
        (0.6, Make::Material("marble", [500.0, 1500.0])),
        (0.6, Make::Material("timber", [600.0, 1200.0])),
    ];
    let floors = [
        (2.0, Make::Usual),
        (2.5, Make::Material("timber", [350.0, 1000.0])),
        (1.5, Make::Paint(Paint::Grey)),
        (1.0, Make::Paint(Paint::Beige)),
        (0.5, Make::Paint(Paint::Coloured)),
        (1.5, Make::Material("granite", [150.0, 400.0])),
        (1.0, Make::Material("marble", [400.0, 1200.0])),
    ];
    let (walls, wall) = surface(draws, "walls", &walls, [0.72, 0.70, 0.64]);
    let (floor_finish, floor) = surface(draws, "floor", &floors, [0.70, 0.67, 0.62]);
    let room = RoomSettings {
        size: [draws.between("room/x", [5200.0, 9000.0]), draws.between("room/y", [4600.0, 8000.0])],
        height: draws.between("room/height", [2450.0, 3600.0]),
        rug: if draws.chance("room/rug", 0.4) { draws.between("room/rug radius", [600.0, 1800.0]) } else { 0.0 },
        floor: floor_finish,
        walls,
    };
    Stage { room, wall, floor }
}

fn surface(draws: Draws, name: &str, makes: &[(f64, Make)], usual: [f64; 3]) -> Surface {
    let of = |what: &str, range: [f64; 2]| draws.between(&format!("{name}/{what}"), range);
    let paint = |level: f64, spread: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|i| ((level + spread[i]).clamp(0.05, 0.97) * 1e4).round() / 1e4)
    };
    let plain = |colour: [f64; 3]| (Some(FinishSettings { colour: Some(colour), ..FinishSettings::default() }), colour);
    match draws.one_of(&format!("{name}/make"), makes).unwrap_or(Make::Usual) {
        Make::Usual => (None, usual),
        Make::Paint(Paint::White) => plain(paint(of("white", [0.86, 0.95]), [0.0; 3])),
        Make::Paint(Paint::Grey) => {
            let tinge = of("tinge", [-0.02, 0.02]);
            plain(paint(of("grey", [0.38, 0.80]), [tinge, 0.0, -tinge]))
        }
        Make::Paint(Paint::Beige) => {
            let warmth = of("warmth", [0.04, 0.12]);
            plain(paint(of("beige", [0.58, 0.82]), [warmth, 0.0, -1.3 * warmth]))
        }
        Make::Paint(Paint::Coloured) => plain(std::array::from_fn(|i| of(&format!("channel {i}"), [0.25, 0.80]))),
        Make::Material(material, scale) => {
            let (parameters, whole) = cut(material, of("tone", [0.0, 1.0]));
            let tint: [f64; 3] = std::array::from_fn(|i| of(&format!("tint {i}"), [0.78, 1.0]));
            let finish = FinishSettings {
                colour: Some(tint),
                material: Some(material.to_string()),
                scale: Some(of("scale", scale)),
                parameters,
                seed: Some(u64::from(draws.whole(&format!("{name}/seed"), [1, 1000]))),
            };
            (Some(finish), std::array::from_fn(|i| whole[i] * tint[i]))
        }
    }
}

/// A material of houses: its parameters from a dark (0) to a pale (1) tone, and the colour it has on the whole.
fn cut(material: &str, tone: f64) -> (Option<FinishParameters>, [f64; 3]) {
    let mix = |dark: [f64; 3], pale: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|i| ((dark[i] + (pale[i] - dark[i]) * tone) * 1e4).round() / 1e4)
    };
    let table = |colours: [(&str, [f64; 3]); 2]| {
        let entries = colours.map(|(key, colour)| (key.to_string(), toml::Value::from(colour.to_vec())));
        Some(FinishParameters::Here(toml::Table::from_iter(entries)))
    };
    match material {
        "timber" => {
            let light = mix([0.42, 0.27, 0.16], [0.80, 0.66, 0.48]);
            (table([("light", light), ("dark", light.map(|channel| channel * 0.78))]), light.map(|c| c * 0.9))
        }
        "marble" => {
            let (vein, stone) = (mix([0.58, 0.56, 0.57], [0.80, 0.78, 0.78]), [0.92, 0.91, 0.88]);
            (table([("vein", vein), ("stone", stone)]), std::array::from_fn(|i| 0.5 * (vein[i] + stone[i])))
        }
        "brick" => (None, [0.60, 0.42, 0.36]),
        _ => (None, [0.60; 3]),
    }
}

/// A window, or one, two or four lamps; shadows harder or softer; light that changes a little.
pub(super) fn light(draws: Draws, room: &RoomSettings) -> LightSettings {
    let count = draws.one_of("light/lamps", &[(3.0, 0), (3.0, 1), (2.5, 2), (1.5, 4)]).unwrap_or(0);
    let half = room.size.map(|extent| 0.5 * extent);
    let lamp = |index: usize| {
        let of = |what: &str, range: [f64; 2]| draws.between(&format!("light/lamp {index} {what}"), range);
        // Each in a quarter of its own, so that two do not stand in one place.
        let [x, y] = [[1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0]][index % 4];
        [x * half[0] * of("x", [0.1, 1.0]), y * half[1] * of("y", [0.1, 1.0]), of("height", [2300.0, 4200.0])]
            .map(|value| (value * 10.0).round() / 10.0)
    };
    LightSettings {
        position: None,
        lamps: (0..count).map(lamp).collect(),
        softness: draws.whole("light/softness", [2, 12]),
        swing: if draws.chance("light/changes", 0.5) { draws.between("light/swing", [0.01, 0.06]) } else { 0.0 },
        period: draws.between("light/period", [1.5, 15.0]),
    }
}

pub(super) fn sensor(draws: Draws, fps: f64) -> SensorSettings {
    let exposure = if draws.chance("sensor/slow", 0.35) { draws.between("sensor/exposure", [3.0, 10.0]) } else { 0.0 };
    SensorSettings {
        grey: draws.chance("sensor/grey", 0.1),
        noise: draws.between("sensor/noise", [1.0, 6.0]),
        gain: draws.between("sensor/gain", [0.55, 1.15]),
        exposure: exposure.min(900.0 / fps),
        sub_frames: 3,
    }
}

/// What single cameras do otherwise: brighter or darker, noisier or cleaner.
pub(super) fn cameras(draws: Draws, sensor: &SensorSettings, count: usize) -> Vec<CameraSettings> {
    let camera = |index: usize| {
        let of = |what: &str, range: [f64; 2]| draws.between(&format!("camera {index}/{what}"), range);
        CameraSettings {
            name: format!("cam{}", index + 1),
            gain: Some((sensor.gain * of("gain", [0.9, 1.1]) * 1e4).round() / 1e4),
            noise: Some((sensor.noise * of("noise", [0.8, 1.25]) * 1e4).round() / 1e4),
            ..CameraSettings::default()
        }
    };
    (0..count).map(camera).collect()
}

/// PNG, or JPEG of any quality, mostly with the colour of videos.
pub(super) fn output(draws: Draws) -> OutputSettings {
    let is_jpeg = draws.chance("output/jpeg", 0.75);
    OutputSettings {
        pictures: if is_jpeg { PictureForm::Jpeg } else { PictureForm::Png },
        quality: draws.whole("output/quality", [40, 92]) as u8,
        masks: true,
        half_chroma: is_jpeg && draws.chance("output/half chroma", 0.7),
        ..OutputSettings::default()
    }
}

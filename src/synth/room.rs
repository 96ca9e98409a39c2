//! The room the actor walks in: a tiled floor with a round rug, four walls with panels, paper, pictures and a door.

use std::sync::Arc;

use anyhow::Result;
use glam::{DVec2, DVec3};

use super::colour::Colour;
use super::finish::Finish;
use super::hash::{cell, smooth_noise};
use super::scene::RoomSettings;
use super::solid::Ray;

/// A rectangular room round the origin, floor at z = 0.
#[derive(Clone, Debug)]
pub struct Room {
    /// Half of its extent along x and y, mm.
    pub half_size: DVec2,
    /// Height of the ceiling, mm.
    pub height: f64,
    /// Radius of the round rug in the middle, mm.
    pub rug_radius: f64,
    floor: Option<Arc<Finish>>,
    walls: Option<Arc<Finish>>,
}

/// Which surface of the room a point is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// z = 0
    Floor,
    /// z = height
    Ceiling,
    /// The walls at +x, +y, -x, -y: 0 to 3.
    Wall(usize),
}

/// Height of the skirting board, of the panels' upper rail, mm.
const SKIRTING: f64 = 110.0;
const RAIL: f64 = 960.0;
const TILE: f64 = 400.0;

impl Room {
    /// The room of a scene.
    ///
    /// # Errors
    /// When a finish is unknown or out of range.
    pub fn new(settings: &RoomSettings) -> Result<Self> {
        let finish = |settings: &Option<super::finish::FinishSettings>, what| {
            settings.as_ref().map(|settings| settings.finish(what).map(Arc::new)).transpose()
        };
        Ok(Self {
            half_size: DVec2::from(settings.size) * 0.5,
            height: settings.height,
            rug_radius: settings.rug,
            floor: finish(&settings.floor, "[room] floor")?,
            walls: finish(&settings.walls, "[room] walls")?,
        })
    }

    /// Where a ray from inside the room leaves it.
    pub fn hit(&self, ray: &Ray) -> (f64, Surface) {
        let along = |origin: f64, direction: f64, low: f64, high: f64| {
            if direction > 0.0 {
                (high - origin) / direction
            } else if direction < 0.0 {
                (low - origin) / direction
            } else {
                f64::INFINITY
            }
        };
        let (o, d) = (ray.origin, ray.direction);
        let x = along(o.x, d.x, -self.half_size.x, self.half_size.x);
        let y = along(o.y, d.y, -self.half_size.y, self.half_size.y);
        let z = along(o.z, d.z, 0.0, self.height);
        if z <= x && z <= y {
            (z, if d.z < 0.0 { Surface::Floor } else { Surface::Ceiling })
        } else if x <= y {
            (x, Surface::Wall(if d.x > 0.0 { 0 } else { 2 }))
        } else {
            (y, Surface::Wall(if d.y > 0.0 { 1 } else { 3 }))
        }
    }

    /// The light that leaves a point of a surface: pattern times a soft illumination, darker in the corners.
    pub fn light(&self, point: DVec3, surface: Surface) -> Colour {
        match surface {
            Surface::Floor => self.floor(point.truncate()) * self.illumination(point, 1.0),
            Surface::Ceiling => Colour::splat(0.82) * self.illumination(point, 0.75),
            Surface::Wall(wall) => {
                // Distance along the wall from its middle.
                let u = if wall.is_multiple_of(2) { point.y } else { point.x };
                // Walls that face the key light are a little brighter.
                let facing = [0.74, 0.86, 0.92, 0.78][wall];
                self.wall(wall, u, point.z) * self.illumination(point, facing)
            }
        }
    }

    /// Light falls off towards the edges where two surfaces meet.
    fn illumination(&self, point: DVec3, base: f64) -> f64 {
        let gaps = [self.half_size.x - point.x.abs(), self.half_size.y - point.y.abs(), point.z, self.height - point.z];
        let corner: f64 = gaps.iter().filter(|gap| **gap > 1e-6).map(|gap| 1.0 - 0.22 * (-gap / 350.0).exp()).product();
        let away = point.truncate().length() / self.half_size.length();
        base * corner * (1.0 - 0.18 * away * away)
    }

    fn floor(&self, p: DVec2) -> Colour {
        let radius = p.length();
        let weave = 0.94 + 0.12 * smooth_noise(p.x / 9.0, p.y / 9.0, 11);
        if radius < self.rug_radius {
            return rug(radius / self.rug_radius, p.y.atan2(p.x)) * weave;
        }
        if let Some(finish) = &self.floor {
            return finish.at(p.extend(0.0));
        }
        let (tx, ty) = ((p.x / TILE).floor(), (p.y / TILE).floor());
        let (ix, iy) = (tx as i64, ty as i64);
        let inside = DVec2::new(p.x / TILE - tx, p.y / TILE - ty);
        let joint = inside.min(1.0 - inside).min_element() * TILE;
        if joint < 4.0 {
            return Colour::new(0.30, 0.28, 0.25);
        }
        let tone = 0.86 + 0.22 * cell(ix, iy, 3);
        let stone = 0.90 + 0.20 * smooth_noise(p.x / 70.0, p.y / 45.0, 5);
        let base =
            if (ix + iy).rem_euclid(2) == 0 { Colour::new(0.58, 0.52, 0.44) } else { Colour::new(0.47, 0.44, 0.39) };
        base * tone * stone
    }

    fn wall(&self, wall: usize, u: f64, z: f64) -> Colour {
        if let Some(colour) = ornament(wall, u, z) {
            return colour;
        }
        if z < SKIRTING {
            return Colour::new(0.33, 0.36, 0.36);
        }
        if let Some(finish) = &self.walls {
            // Each wall is cut from another place of the material.
            return finish.at(DVec3::new(u + 20_000.0 * wall as f64, z, 0.0));
        }
        if z < RAIL {
            return panel(u, z);
        }
        if z < RAIL + 50.0 {
            return Colour::new(0.62, 0.63, 0.60);
        }
        // Paper: small diamonds on faint stripes.
        let stripe = if (u / 180.0).rem_euclid(2.0) < 1.0 { 1.0 } else { 0.93 };
        let row = (z / 180.0).floor();
        let shifted = u / 180.0 + if row.rem_euclid(2.0) < 1.0 { 0.0 } else { 0.5 };
        let diamond = ((shifted - shifted.floor() - 0.5).abs() + (z / 180.0 - row - 0.5).abs()) < 0.17;
        if diamond { Colour::new(0.50, 0.52, 0.44) } else { Colour::new(0.72, 0.69, 0.60) * stripe }
    }
}

/// Rings and petals; `r` from 0 in the middle to 1 at the rim.
fn rug(r: f64, angle: f64) -> Colour {
    let cream = Colour::new(0.60, 0.54, 0.43);
    let sage = Colour::new(0.30, 0.37, 0.31);
    let ochre = Colour::new(0.52, 0.38, 0.17);
    let petals = 0.5 + 0.5 * (angle * 12.0).cos();
    match r {
        r if r > 0.97 => sage * 0.7,
        r if r > 0.90 => cream,
        r if r > 0.87 => ochre,
        r if r > 0.60 => {
            // A ring of petals between two circles.
            let across = (r - 0.735).abs() / 0.115;
            if across < petals { sage } else { cream }
        }
        r if r > 0.56 => ochre,
        r if r > 0.20 => {
            let star = 0.22 + 0.30 * (0.5 + 0.5 * (angle * 8.0).cos()).powi(2);
            if r < star { ochre } else { sage * 1.15 }
        }
        _ => cream,
    }
}

/// Painted panels with a groove round each field.
fn panel(u: f64, z: f64) -> Colour {
    let paint = Colour::new(0.40, 0.47, 0.45);
    let across = (u / 620.0 - (u / 620.0).floor() - 0.5).abs() * 620.0;
    let up = (z - (SKIRTING + RAIL) / 2.0).abs();
    let (frame_u, frame_z) = (235.0 - across, 335.0 - up);
    let edge = frame_u.min(frame_z);
    if (0.0..16.0).contains(&edge) {
        paint * 0.62
    } else if (16.0..30.0).contains(&edge) {
        paint * 1.22
    } else {
        paint
    }
}

/// Framed pictures, a window with evening light, a door.
fn ornament(wall: usize, u: f64, z: f64) -> Option<Colour> {
    let rectangle = |centre: DVec2, half: DVec2| {
        let offset = (DVec2::new(u, z) - centre).abs();
        let inside = half - offset;
        (inside.x > 0.0 && inside.y > 0.0).then(|| (inside.min_element(), (DVec2::new(u, z) - centre) / half))
    };
    match wall {
        0 => {
            let (edge, at) = rectangle(DVec2::new(-900.0, 1650.0), DVec2::new(560.0, 420.0))?;
            Some(framed(edge, || {
                // Hills under a pale sky.
                let ridge = 0.35 * (at.x * 3.0 + 0.5).sin() - 0.1;
                let far = 0.25 * (at.x * 2.1 - 1.0).sin() + 0.25;
                if at.y < ridge - 0.2 {
                    Colour::new(0.14, 0.22, 0.13)
                } else if at.y < far {
                    Colour::new(0.25, 0.33, 0.36)
                } else {
                    Colour::new(0.75, 0.66, 0.48) * (0.8 + 0.2 * at.y)
                }
            }))
        }
        1 => {
            let (edge, at) = rectangle(DVec2::new(300.0, 1700.0), DVec2::new(850.0, 560.0))?;
            let bar = at.x.abs() < 0.02 || (at.y - 0.25).abs() < 0.03;
            Some(if edge < 55.0 || bar {
                Colour::new(0.78, 0.77, 0.72)
            } else {
                Colour::new(0.36, 0.50, 0.66).lerp(Colour::new(0.85, 0.76, 0.62), 0.5 - 0.5 * at.y)
            })
        }
        2 => {
            let (edge, at) = rectangle(DVec2::new(1100.0, 1020.0), DVec2::new(440.0, 1040.0))?;
            let knob = (DVec2::new(u, z) - DVec2::new(770.0, 1000.0)).length() < 32.0;
            let wood = Colour::new(0.34, 0.22, 0.13) * (0.85 + 0.3 * smooth_noise(u / 22.0, z / 260.0, 21));
            let field = at.x.abs() < 0.66 && ((at.y - 0.48).abs() < 0.36 || (at.y + 0.48).abs() < 0.36);
            Some(if knob {
                Colour::new(0.65, 0.52, 0.25)
            } else if edge < 60.0 {
                wood * 1.5
            } else if field {
                wood * 0.8
            } else {
                wood
            })
        }
        _ => {
            // Three small prints in a row.
            (-1..=1).find_map(|i| {
                let (edge, at) = rectangle(DVec2::new(820.0 * f64::from(i) - 150.0, 1620.0), DVec2::new(270.0, 340.0))?;
                Some(framed(edge, || {
                    let disc = at.length() < 0.45 + 0.08 * f64::from(i);
                    let ink =
                        [Colour::new(0.12, 0.24, 0.36), Colour::new(0.45, 0.20, 0.12), Colour::new(0.16, 0.30, 0.20)];
                    if disc { ink[(i + 1) as usize] } else { Colour::new(0.74, 0.72, 0.64) }
                }))
            })
        }
    }
}

/// A dark frame, a pale mount, the picture.
fn framed(edge: f64, picture: impl Fn() -> Colour) -> Colour {
    if edge < 32.0 {
        Colour::new(0.10, 0.08, 0.06)
    } else if edge < 85.0 {
        Colour::new(0.80, 0.79, 0.75)
    } else {
        picture()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_end_on_the_right_surfaces() {
        let room = Room::new(&RoomSettings::default()).unwrap();
        let from = DVec3::new(100.0, -200.0, 1000.0);
        let hit = |direction: DVec3| room.hit(&Ray { origin: from, direction });
        assert_eq!(hit(-DVec3::Z), (1000.0, Surface::Floor));
        assert_eq!(hit(DVec3::Z), (1800.0, Surface::Ceiling));
        assert_eq!(hit(DVec3::X), (3500.0, Surface::Wall(0)));
        assert_eq!(hit(DVec3::Y), (3300.0, Surface::Wall(1)));
        assert_eq!(hit(-DVec3::X), (3700.0, Surface::Wall(2)));
        assert_eq!(hit(-DVec3::Y), (2900.0, Surface::Wall(3)));
    }

    #[test]
    fn floors_and_walls_of_other_finish() {
        let red = super::super::finish::FinishSettings { colour: Some([1.0, 0.0, 0.0]), ..Default::default() };
        let settings =
            RoomSettings { floor: Some(red.clone()), walls: Some(red), rug: 500.0, ..RoomSettings::default() };
        let room = Room::new(&settings).unwrap();
        let is_red = |light: Colour| light.x > 0.2 && light.y == 0.0;
        assert!(is_red(room.light(DVec3::new(2000.0, 0.0, 0.0), Surface::Floor)));
        assert!(is_red(room.light(DVec3::new(3600.0, 1500.0, 700.0), Surface::Wall(0))));
        assert!(!is_red(room.light(DVec3::ZERO, Surface::Floor)), "the rug lies on it");
        let none = RoomSettings { walls: Some(Default::default()), ..RoomSettings::default() };
        assert!(format!("{:#}", Room::new(&none).unwrap_err()).contains("[room] walls"));
    }

    #[test]
    fn every_surface_gives_light_within_range() {
        let room = Room::new(&RoomSettings::default()).unwrap();
        for i in 0..40_000u32 {
            let a = f64::from(i) * 2.399_963;
            let direction = DVec3::new(a.cos(), a.sin(), f64::from(i) / 20_000.0 - 1.0).normalize();
            let ray = Ray { origin: DVec3::new(0.0, 0.0, 1200.0), direction };
            let (t, surface) = room.hit(&ray);
            let light = room.light(ray.origin + direction * t, surface);
            assert!(light.min_element() > 0.0 && light.max_element() < 1.0, "{surface:?} {light}");
        }
    }
}

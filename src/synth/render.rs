//! Drawing: one ray through each quarter of a pixel, the room once a camera, the actor over it in every frame.

use anyhow::{Result, anyhow};
use glam::{DAffine3, DVec2, DVec3};

use super::actor::{Actor, Material, Shape};
use super::hash::smooth_noise;
use super::room::{Colour, Room, Surface};
use super::shadow::{FloorShadow, LightBins};
use super::solid::{PlacedSolid, Ray};
use crate::geometry::Camera;

/// Direction to the key light (not of unit length), its share of the light on the floor.
const TO_LIGHT: DVec3 = DVec3::new(0.42, -0.38, 1.25);
const KEY_SHARE: f32 = 0.40;

/// Pixels a side of the tiles that solids are sorted into.
const TILE: usize = 8;
/// Rays a side through a pixel: for the actor, for the room.
const ACTOR_RAYS: usize = 2;
const ROOM_RAYS: usize = 3;

/// Surfaces closer than this are shaded as one, mm.
const BLEND: f64 = 30.0;

/// A picture in linear light, row-major.
pub type Light = Vec<[f32; 3]>;

/// A camera with its view of the empty room.
pub struct View {
    camera: Camera,
    centre: DVec3,
    /// Directions in the world through the corners of the pixels, (width + 1) x (height + 1).
    directions: Vec<[f32; 3]>,
    plate: Light,
    /// Where the middle of each pixel meets the floor, NaN where it does not.
    floor: Vec<[f32; 2]>,
}

/// The actor in one frame, ready to be drawn in any view.
pub struct PlacedActor<'a> {
    shapes: &'a [Shape],
    solids: &'a [PlacedSolid],
    bone_from_world: Vec<DAffine3>,
    bins: LightBins<'a>,
    floor_shadow: FloorShadow,
}

impl<'a> PlacedActor<'a> {
    /// Prepares shadows. `solids` are those of `actor` placed by `world_from_bone`.
    pub fn new(actor: &'a Actor, solids: &'a [PlacedSolid], world_from_bone: &[DAffine3]) -> Self {
        let bins = LightBins::new(solids, TO_LIGHT.normalize());
        // The middle of the shadow lies away from the light.
        let low = solids.iter().map(|s| s.bounding_balls()[0].0.truncate());
        let middle = low.fold(DVec2::ZERO, |sum, p| sum + p) / solids.len().max(1) as f64;
        let floor_shadow = FloorShadow::new(&bins, middle - TO_LIGHT.truncate() / TO_LIGHT.z * 700.0);
        let bone_from_world = world_from_bone.iter().map(DAffine3::inverse).collect();
        Self { shapes: actor.shapes(), solids, bone_from_world, bins, floor_shadow }
    }

    /// The normal at a point, mixed with those of solids of the same material that pass close by: the crease between two
    /// muscles is then shaded as one soft surface.
    fn blended(&self, normal: DVec3, point: DVec3, material: Material, candidates: &[u16]) -> DVec3 {
        let mut sum = normal * 1e-3;
        for &index in candidates {
            let index = usize::from(index);
            if self.shapes[index].material.joins(material) {
                let (outside, own) = self.solids[index].near(point);
                let weight = (1.0 - outside.abs() / BLEND).max(0.0);
                sum += own * (weight * weight);
            }
        }
        sum.normalize_or(normal)
    }

    /// The light from the nearest solid among `candidates` along a ray.
    fn light(&self, ray: &Ray, candidates: &[u16]) -> Option<Colour> {
        let (index, distance, normal) = candidates
            .iter()
            .filter_map(|&index| {
                let (distance, normal) = self.solids[usize::from(index)].first_hit(ray)?;
                Some((usize::from(index), distance, normal))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))?;
        let shape = &self.shapes[index];
        let point = ray.origin + ray.direction * distance;
        let at = self.bone_from_world[shape.bone].transform_point3(point);
        let lifted = point + normal * 2.0;
        let normal = self.blended(normal, point, shape.material, candidates) + folds(shape.material, at);
        let normal = normal.normalize_or_zero();
        let towards_light = normal.dot(TO_LIGHT.normalize()).max(0.0);
        // Lifted off the surface, so that a solid does not shade its own skin by rounding.
        let lit = towards_light > 0.0 && !self.bins.in_shadow(lifted);
        let key = if lit { towards_light } else { 0.0 };
        let up = 0.5 + 0.5 * normal.z;
        // Near the floor less of the room's light arrives.
        let open = 0.72 + 0.28 * (point.z / 500.0).clamp(0.0, 1.0);
        let sky = Colour::new(0.44, 0.46, 0.50) * up * open;
        let bounce = Colour::new(0.25, 0.22, 0.18) * (1.0 - up) * open;
        // Grazing views of cloth and skin are a little brighter.
        let rim = 0.08 * (1.0 + normal.dot(ray.direction)).clamp(0.0, 1.0).powi(3);
        Some(shape.reflectance(at) * (Colour::new(0.98, 0.94, 0.86) * key + sky + bounce) + Colour::splat(rim * 0.3))
    }
}

/// Creases of cloth: a small tilt of the normal from smooth noise.
fn folds(material: Material, at: DVec3) -> DVec3 {
    let (depth, width) = match material {
        Material::Shirt => (0.34, 62.0),
        Material::Trousers => (0.38, 70.0),
        Material::Hair => (0.30, 14.0),
        _ => return DVec3::ZERO,
    };
    let around = at.y.atan2(at.x) * 90.0;
    let noise = |layer| smooth_noise(around / width + at.z / (2.2 * width), at.z / width, layer) - 0.5;
    DVec3::new(noise(41), noise(42), noise(43)) * depth
}

impl View {
    /// Draws the empty room.
    ///
    /// # Errors
    /// When a pixel of the camera has no ray (its distortion folds over); the message names the camera.
    pub fn new(camera: &Camera, room: &Room) -> Result<Self> {
        let [width, height] = camera.size.map(|side| side as usize);
        let mut directions = Vec::with_capacity((width + 1) * (height + 1));
        for y in 0..=height {
            for x in 0..=width {
                let pixel = DVec2::new(x as f64 - 0.5, y as f64 - 0.5);
                let (_, direction) = camera.ray(pixel).ok_or_else(|| {
                    anyhow!("camera {} has no ray through {pixel}: its distortion is too strong", camera.name)
                })?;
                directions.push(direction.normalize_or(DVec3::Z).as_vec3().to_array());
            }
        }
        let centre = camera.centre_in_world();
        let mut view = Self { camera: camera.clone(), centre, directions, plate: Vec::new(), floor: Vec::new() };
        for y in 0..height {
            for x in 0..width {
                let mut sum = Colour::ZERO;
                for (fx, fy) in quarters(ROOM_RAYS) {
                    let ray = view.ray(x, y, fx, fy);
                    let (t, surface) = room.hit(&ray);
                    sum += room.light(ray.origin + ray.direction * t, surface);
                }
                view.plate.push((sum / (ROOM_RAYS * ROOM_RAYS) as f64).as_vec3().to_array());
                let ray = view.ray(x, y, 0.5, 0.5);
                let (t, surface) = room.hit(&ray);
                let point = ray.origin + ray.direction * t;
                let point = if surface == Surface::Floor { point.truncate() } else { DVec2::NAN };
                view.floor.push(point.as_vec2().to_array());
            }
        }
        Ok(view)
    }

    /// The camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The empty room.
    pub fn plate(&self) -> &Light {
        &self.plate
    }

    /// The room with the actor in it, and how much of each pixel the actor covers, in 0..=4 quarters.
    pub fn picture(&self, actor: &PlacedActor) -> (Light, Vec<u8>) {
        let [width, height] = self.camera.size.map(|side| side as usize);
        let mut light: Light = self
            .plate
            .iter()
            .zip(&self.floor)
            .map(|(rgb, &[x, y])| {
                if x.is_nan() {
                    return *rgb;
                }
                let [key, around] = actor.floor_shadow.at(f64::from(x), f64::from(y));
                let factor = KEY_SHARE * key + (1.0 - KEY_SHARE) * around;
                rgb.map(|value| value * factor)
            })
            .collect();
        let mut coverage = vec![0; light.len()];
        for (tile, candidates) in self.tiles(actor.solids).iter().enumerate().filter(|(_, list)| !list.is_empty()) {
            let columns = width.div_ceil(TILE);
            let (left, top) = (tile % columns * TILE, tile / columns * TILE);
            for y in top..(top + TILE).min(height) {
                for x in left..(left + TILE).min(width) {
                    let hits =
                        quarters(ACTOR_RAYS).filter_map(|(fx, fy)| actor.light(&self.ray(x, y, fx, fy), candidates));
                    let (mut sum, mut count) = (Colour::ZERO, 0u8);
                    for hit in hits {
                        sum += hit;
                        count += 1;
                    }
                    if count > 0 {
                        let all = (ACTOR_RAYS * ACTOR_RAYS) as f32;
                        let behind = &mut light[y * width + x];
                        let seen = f32::from(count) / all;
                        for (value, actor) in behind.iter_mut().zip(sum.as_vec3().to_array()) {
                            *value = *value * (1.0 - seen) + actor / all;
                        }
                        coverage[y * width + x] = count;
                    }
                }
            }
        }
        (light, coverage)
    }

    /// The ray through a pixel; `fx`, `fy` from 0 at its left (upper) border to 1 at its right (lower) one.
    fn ray(&self, x: usize, y: usize, fx: f64, fy: f64) -> Ray {
        let stride = self.camera.size[0] as usize + 1;
        let corner = |dx: usize, dy: usize| DVec3::from(self.directions[(y + dy) * stride + x + dx].map(f64::from));
        // Between the corners of one pixel directions are linear to a thousandth of a pixel.
        let upper = corner(0, 0).lerp(corner(1, 0), fx);
        let lower = corner(0, 1).lerp(corner(1, 1), fx);
        Ray { origin: self.centre, direction: upper.lerp(lower, fy).normalize_or(DVec3::Z) }
    }

    /// The solids that may be seen in each tile of the picture.
    fn tiles(&self, solids: &[PlacedSolid]) -> Vec<Vec<u16>> {
        let [width, height] = self.camera.size.map(|side| side as usize);
        let (columns, rows) = (width.div_ceil(TILE), height.div_ceil(TILE));
        let mut tiles = vec![Vec::new(); columns * rows];
        for (index, solid) in solids.iter().enumerate() {
            let boxes = solid.bounding_balls().map(|(centre, radius)| self.ball_box(centre, radius));
            // A ball that cannot be bounded (round the camera) may be anywhere.
            let (low, high) = match boxes {
                [Some(a), Some(b)] => (a.0.min(b.0), a.1.max(b.1)),
                _ => (DVec2::ZERO, DVec2::new(width as f64, height as f64)),
            };
            if high.x < 0.0 || high.y < 0.0 || low.x >= width as f64 || low.y >= height as f64 {
                continue;
            }
            for row in low.y as usize / TILE..=(high.y as usize / TILE).min(rows - 1) {
                for column in low.x as usize / TILE..=(high.x as usize / TILE).min(columns - 1) {
                    tiles[row * columns + column].push(index as u16);
                }
            }
        }
        tiles
    }

    /// A rectangle of the picture that holds a ball, with a margin for perspective and distortion.
    fn ball_box(&self, centre: DVec3, radius: f64) -> Option<(DVec2, DVec2)> {
        let world_from_camera = self.camera.camera_from_world.matrix3.transpose();
        let middle = self.camera.project(centre)?;
        let mut reach = 0.0f64;
        for axis in [world_from_camera.x_axis, world_from_camera.y_axis] {
            for side in [axis, -axis] {
                reach = reach.max(self.camera.project(centre + side * radius)?.distance(middle));
            }
        }
        let reach = reach * 1.2 + 3.0;
        Some((middle - reach, middle + reach))
    }
}

/// Middles of the cells of a `side` x `side` grid over a pixel.
fn quarters(side: usize) -> impl Iterator<Item = (f64, f64)> {
    (0..side * side).map(move |i| (((i % side) as f64 + 0.5) / side as f64, ((i / side) as f64 + 0.5) / side as f64))
}

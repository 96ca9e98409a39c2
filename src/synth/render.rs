//! Drawing: one ray through each quarter of a pixel, the room once a camera, the people over it in every frame.

use std::sync::OnceLock;

use anyhow::{Result, anyhow};
use glam::{DVec2, DVec3, Vec2};

use super::actor::Material;
use super::colour::Colour;
use super::figure::PlacedFigure;
use super::hash::smooth_noise;
use super::room::{Room, Surface};
use super::scene::USUAL_SOFTNESS;
use super::shaders::TILE_SIDE;
use super::shadow::{FloorShadow, LightBins};
use super::solid::Ray;
use super::triangle::Primitive;
use crate::geometry::Camera;

/// Direction to the light where there is no lamp in the room (not of unit length): that of a high window.
const TO_WINDOW: DVec3 = DVec3::new(0.42, -0.38, 1.25);

/// Distance off a surface from which its shadow is asked, mm.
const LIFT: f64 = 2.0;

/// The lamp's share of the light on the floor.
const KEY_SHARE: f32 = 0.40;

/// Pixels a side of the tiles that solids are sorted into.
const TILE: usize = TILE_SIDE as usize;
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
    pub(super) centre: DVec3,
    /// Directions in the world through the corners of the pixels, (width + 1) x (height + 1).
    pub(super) directions: Vec<[f32; 3]>,
    plate: Light,
    /// Where the middle of each pixel meets the floor, NaN where it does not.
    pub(super) floor: Vec<[f32; 2]>,
}

/// The people in one instant, ready to be drawn in any view.
pub struct Cast<'a> {
    pub(super) members: Vec<Member<'a>>,
}

/// One of them with the light as it falls there.
pub(super) struct Member<'a> {
    pub(super) figure: &'a PlacedFigure<'a>,
    /// The first lamp, and those beside it; each gives an equal share of the key light.
    pub(super) lamp: Lamp<'a>,
    others: Vec<Lamp<'a>>,
}

/// The light of a lamp at a member.
pub(super) struct Lamp<'a> {
    pub(super) to_light: DVec3,
    pub(super) bins: LightBins<'a>,
    /// The middle of the shadow on the floor.
    pub(super) shadow_middle: DVec2,
    softness: u32,
    /// Made when it is first asked for: a device makes its own.
    floor_shadow: OnceLock<FloorShadow>,
}

impl<'a> Lamp<'a> {
    /// The light at `figure` of a lamp at a place (mm), or from far away.
    fn new(figure: &'a PlacedFigure<'a>, lamp: Option<DVec3>, softness: u32) -> Result<Self> {
        let towards = match lamp {
            None => TO_WINDOW,
            Some(lamp) => {
                // A lamp beside a person would throw a shadow without end.
                let towards = (lamp - figure.root()?).normalize_or(DVec3::Z);
                towards.with_z(towards.z.max(0.25))
            }
        };
        let to_light = towards.normalize();
        let bins = LightBins::new(&figure.primitives, to_light);
        // The middle of the shadow lies away from the light.
        let low = figure.balls.iter().map(|pair| pair[0].0.truncate());
        let middle = low.fold(DVec2::ZERO, |sum, p| sum + p) / figure.balls.len().max(1) as f64;
        let shadow_middle = middle - towards.truncate() / towards.z * 700.0;
        Ok(Self { to_light, bins, shadow_middle, softness, floor_shadow: OnceLock::new() })
    }
}

impl Member<'_> {
    pub(super) fn floor_shadow(&self) -> &FloorShadow {
        self.shadow_of(&self.lamp)
    }

    fn shadow_of<'l>(&self, lamp: &'l Lamp<'_>) -> &'l FloorShadow {
        let shadow = || FloorShadow::new(&lamp.bins, &self.figure.balls, lamp.shadow_middle, lamp.softness);
        lamp.floor_shadow.get_or_init(shadow)
    }

    fn lamps(&self) -> impl Iterator<Item = &Lamp<'_>> {
        std::iter::once(&self.lamp).chain(&self.others)
    }

    /// The share of its light that a point of the floor keeps.
    fn shading(&self, shadows: &[&FloorShadow], x: f64, y: f64) -> f32 {
        let [first, around] = self.floor_shadow().at(x, y);
        let others: f32 = shadows.iter().map(|shadow| shadow.at(x, y)[0]).sum();
        let key = (first + others) / (1 + shadows.len()) as f32;
        KEY_SHARE * key + (1.0 - KEY_SHARE) * around
    }
}

/// The pixels that a primitive may be seen in.
#[derive(Clone, Copy)]
pub(super) struct PixelBox {
    low: Vec2,
    high: Vec2,
}

impl PixelBox {
    const EVERYWHERE: Self = Self { low: Vec2::NEG_INFINITY, high: Vec2::INFINITY };

    fn holds(&self, x: usize, y: usize) -> bool {
        let (x, y) = (x as f32, y as f32);
        self.low.x <= x && x <= self.high.x && self.low.y <= y && y <= self.high.y
    }
}

/// Where a ray meets somebody.
pub(super) struct Meeting {
    of: Candidate,
    pub(super) point: DVec3,
    /// The normal of the primitive alone.
    facet: DVec3,
    /// The normal as it is shaded.
    pub(super) normal: DVec3,
}

/// A primitive of a member: (member, index).
pub(super) type Candidate = (u16, u32);

impl<'a> Cast<'a> {
    /// Prepares shadows, for a lamp at a place in the room (mm) or light from far away.
    ///
    /// # Errors
    /// When a figure has no root.
    pub fn new(figures: &'a [PlacedFigure<'a>], lamp: Option<DVec3>) -> Result<Self> {
        Self::lit(figures, lamp.as_slice(), USUAL_SOFTNESS)
    }

    /// The same with any number of lamps, and shadows on the floor that are blurred `softness` times.
    ///
    /// # Errors
    /// When a figure has no root.
    pub(super) fn lit(figures: &'a [PlacedFigure<'a>], lamps: &[DVec3], softness: u32) -> Result<Self> {
        let member = |figure: &'a PlacedFigure<'a>| {
            let lamp = Lamp::new(figure, lamps.first().copied(), softness)?;
            let others = lamps.iter().skip(1).map(|at| Lamp::new(figure, Some(*at), softness));
            Ok(Member { figure, lamp, others: others.collect::<Result<_>>()? })
        };
        Ok(Self { members: figures.iter().map(member).collect::<Result<_>>()? })
    }

    /// The normal at a point, mixed with those of solids of the same material that pass close by: the crease between two
    /// muscles is then shaded as one soft surface. Triangles have mixed normals of their own.
    fn blended(&self, normal: DVec3, point: DVec3, of: Candidate, candidates: &[Candidate]) -> DVec3 {
        let figure = self.members[usize::from(of.0)].figure;
        if matches!(figure.primitives[of.1 as usize], Primitive::Triangle(_)) {
            return normal;
        }
        let material = figure.material(of.1 as usize);
        let mut sum = normal * 1e-3;
        for &(_, index) in candidates.iter().filter(|(member, _)| *member == of.0) {
            let index = index as usize;
            if figure.material(index).joins(material)
                && let Primitive::Solid(solid) = &figure.primitives[index]
            {
                let (outside, own) = solid.near(point);
                let weight = (1.0 - outside.abs() / BLEND).max(0.0);
                sum += own * (weight * weight);
            }
        }
        sum.normalize_or(normal)
    }

    /// Where a ray first meets somebody.
    pub(super) fn first_meeting(&self, ray: &Ray, candidates: &[Candidate]) -> Option<Meeting> {
        let (of, distance, facet) = candidates
            .iter()
            .filter_map(|&(member, index)| {
                let hit = self.members[usize::from(member)].figure.primitives[index as usize].first_hit(ray)?;
                Some(((member, index), hit.0, hit.1))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))?;
        let point = ray.origin + ray.direction * distance;
        Some(Meeting { of, point, facet, normal: self.blended(facet, point, of, candidates) })
    }

    /// Whether a member stands between a meeting and the lamp of that number.
    fn in_shadow(&self, meeting: &Meeting, lamp: usize) -> bool {
        // Lifted off the surface, so that nothing shades its own skin by rounding.
        let lifted = meeting.point + meeting.facet * LIFT;
        self.members.iter().filter_map(|other| other.lamps().nth(lamp)).any(|lamp| lamp.bins.in_shadow(lifted))
    }

    /// The member that is first met along a ray, and the light from there.
    fn light(&self, ray: &Ray, candidates: &[Candidate]) -> Option<(u16, Colour)> {
        let meeting = self.first_meeting(ray, candidates)?;
        let (of, index) = meeting.of;
        let (member, point) = (&self.members[usize::from(of)], meeting.point);
        let look = member.figure.look(index as usize, point);
        let normal = (meeting.normal + folds(look.material, look.at)).normalize_or_zero();
        let arriving = |(number, lamp): (usize, &Lamp<'_>)| {
            let towards_light = normal.dot(lamp.to_light).max(0.0);
            if towards_light > 0.0 && !self.in_shadow(&meeting, number) { towards_light } else { 0.0 }
        };
        let key = member.lamps().enumerate().map(arriving).sum::<f64>() / (1 + member.others.len()) as f64;
        let up = 0.5 + 0.5 * normal.z;
        // Near the floor less of the room's light arrives.
        let open = 0.72 + 0.28 * (point.z / 500.0).clamp(0.0, 1.0);
        let sky = Colour::new(0.44, 0.46, 0.50) * up * open;
        let bounce = Colour::new(0.25, 0.22, 0.18) * (1.0 - up) * open;
        // Grazing views of cloth and skin are a little brighter.
        let rim = 0.08 * (1.0 + normal.dot(ray.direction)).clamp(0.0, 1.0).powi(3);
        let light = Colour::new(0.98, 0.94, 0.86) * key + sky + bounce;
        Some((of, look.reflectance * light + Colour::splat(rim * 0.3)))
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

    /// The room with people in it, and how much of each pixel the first of them covers, in 0..=4 quarters.
    pub fn picture<'a>(&self, cast: &'a Cast<'_>) -> (Light, Vec<u8>) {
        let [width, height] = self.camera.size.map(|side| side as usize);
        let others = |member: &'a Member<'_>| member.others.iter().map(|lamp| member.shadow_of(lamp)).collect();
        let shadows: Vec<Vec<&FloorShadow>> = cast.members.iter().map(others).collect();
        let mut light: Light = self
            .plate
            .iter()
            .zip(&self.floor)
            .map(|(rgb, &[x, y])| {
                if x.is_nan() {
                    return *rgb;
                }
                let (x, y) = (f64::from(x), f64::from(y));
                let shadings = cast.members.iter().zip(&shadows).map(|(member, others)| member.shading(others, x, y));
                let factor: f32 = shadings.product();
                rgb.map(|value| value * factor)
            })
            .collect();
        let mut coverage = vec![0; light.len()];
        let mut here = Vec::new();
        for (tile, candidates) in self.tiles(cast).iter().enumerate().filter(|(_, list)| !list.is_empty()) {
            let columns = width.div_ceil(TILE);
            let (left, top) = (tile % columns * TILE, tile / columns * TILE);
            for y in top..(top + TILE).min(height) {
                for x in left..(left + TILE).min(width) {
                    here.clear();
                    here.extend(
                        candidates.iter().filter(|(_, seen)| seen.holds(x, y)).map(|(primitive, _)| *primitive),
                    );
                    let hits = quarters(ACTOR_RAYS).filter_map(|(fx, fy)| cast.light(&self.ray(x, y, fx, fy), &here));
                    let (mut sum, mut count, mut first) = (Colour::ZERO, 0u8, 0u8);
                    for (member, hit) in hits {
                        sum += hit;
                        count += 1;
                        first += u8::from(member == 0);
                    }
                    if count > 0 {
                        let all = (ACTOR_RAYS * ACTOR_RAYS) as f32;
                        let behind = &mut light[y * width + x];
                        let seen = f32::from(count) / all;
                        for (value, actor) in behind.iter_mut().zip(sum.as_vec3().to_array()) {
                            *value = *value * (1.0 - seen) + actor / all;
                        }
                        coverage[y * width + x] = first;
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

    /// What may be seen in each tile of the picture, and where.
    pub(super) fn tiles(&self, cast: &Cast) -> Vec<Vec<(Candidate, PixelBox)>> {
        let [width, height] = self.camera.size.map(|side| side as usize);
        let (columns, rows) = (width.div_ceil(TILE), height.div_ceil(TILE));
        let mut tiles = vec![Vec::new(); columns * rows];
        let all = cast.members.iter().enumerate().flat_map(|(member, of)| {
            of.figure
                .primitives
                .iter()
                .enumerate()
                .map(move |(index, primitive)| ((member as u16, index as u32), primitive))
        });
        for (candidate, primitive) in all {
            // The far side of a closed mesh is never seen.
            if matches!(primitive, Primitive::Triangle(triangle) if !triangle.faces(self.centre)) {
                continue;
            }
            // What cannot be bounded (round the camera) may be anywhere.
            let everywhere = (DVec2::ZERO, DVec2::new(width as f64, height as f64));
            let (low, high) = self.bounds(primitive).unwrap_or(everywhere);
            if high.x < 0.0 || high.y < 0.0 || low.x >= width as f64 || low.y >= height as f64 {
                continue;
            }
            // A solid shades its neighbours, so all of its tile know of it.
            let seen = if matches!(primitive, Primitive::Triangle(_)) {
                PixelBox { low: low.as_vec2() - 1.0, high: high.as_vec2() + 1.0 }
            } else {
                PixelBox::EVERYWHERE
            };
            for row in low.y as usize / TILE..=(high.y as usize / TILE).min(rows - 1) {
                for column in low.x as usize / TILE..=(high.x as usize / TILE).min(columns - 1) {
                    tiles[row * columns + column].push((candidate, seen));
                }
            }
        }
        tiles
    }

    /// A rectangle of the picture that holds a primitive.
    fn bounds(&self, primitive: &Primitive) -> Option<(DVec2, DVec2)> {
        match primitive {
            Primitive::Solid(solid) => {
                let [first, second] = solid.bounding_balls();
                let one = self.ball_box(first.0, first.1)?;
                let other = if first == second { one } else { self.ball_box(second.0, second.1)? };
                Some((one.0.min(other.0), one.1.max(other.1)))
            }
            Primitive::Triangle(triangle) => {
                let [a, b, c] = triangle.corners();
                let (a, b, c) = (self.camera.project(a)?, self.camera.project(b)?, self.camera.project(c)?);
                // Distortion bends the edges of so small a triangle by far less than a pixel.
                Some((a.min(b).min(c) - 1.0, a.max(b).max(c) + 1.0))
            }
        }
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

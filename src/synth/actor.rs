//! The actor: a clothed person of ellipsoids and capsules, hung on the bones of a body.

use anyhow::{Result, anyhow};
use glam::{DAffine3, DMat3, DVec3};

use super::colour::Colour;
use super::hash::smooth_noise;
use super::solid::{PlacedSolid, Solid};
use crate::body::Body;

/// What a shape is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Material {
    /// Bare skin.
    Skin,
    /// The head: skin with eyes and mouth painted on.
    Face,
    /// Hair.
    Hair,
    /// The shirt.
    Shirt,
    /// Trousers.
    Trousers,
    /// Shoes.
    Shoe,
}

impl Material {
    /// The name of the garment in scene.toml.
    pub fn garment(self) -> &'static str {
        match self {
            Self::Skin | Self::Face => "skin",
            Self::Hair => "hair",
            Self::Shirt => "shirt",
            Self::Trousers => "trousers",
            Self::Shoe => "shoes",
        }
    }

    /// Reflectance at a point of the bone's frame, mm, as the tailor makes it.
    pub fn reflectance(self, at: DVec3) -> Colour {
        let grain = |scale: f64| 0.9 + 0.2 * smooth_noise(at.y / scale + 3.1 * at.x / scale, at.z / scale, 31);
        match self {
            Self::Skin => Colour::new(0.55, 0.31, 0.21),
            Self::Face => Colour::new(0.58, 0.33, 0.225),
            Self::Hair => Colour::new(0.055, 0.032, 0.02) * (0.7 + 0.6 * smooth_noise(at.y / 7.0, at.x / 40.0, 33)),
            Self::Shirt => {
                // Brick red with pale bands.
                let band = (at.z / 105.0).rem_euclid(1.0) < 0.2;
                let cloth = if band { Colour::new(0.66, 0.58, 0.46) } else { Colour::new(0.56, 0.085, 0.05) };
                cloth * grain(26.0)
            }
            Self::Trousers => Colour::new(0.045, 0.075, 0.17) * grain(18.0),
            Self::Shoe => Colour::new(0.10, 0.05, 0.03),
        }
    }

    /// Whether two materials go over into each other without a crease.
    pub fn joins(self, other: Self) -> bool {
        let family = |material| if material == Self::Face { Self::Skin } else { material };
        family(self) == family(other)
    }
}

/// One solid of the actor, rigid on a bone.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Index of the bone.
    pub bone: usize,
    /// What it is made of.
    pub material: Material,
    solid: Solid,
    bone_from_local: DAffine3,
}

/// The shapes of a person with given bones.
#[derive(Clone, Debug)]
pub struct Actor {
    shapes: Vec<Shape>,
}

/// Collects shapes; lengths below are for a person of 1750 mm and are scaled to the body's own height.
struct Tailor<'a> {
    body: &'a Body,
    scale: f64,
    shapes: Vec<Shape>,
}

impl Tailor<'_> {
    fn bone(&self, name: &str) -> Result<usize> {
        self.body.bone_index(name).ok_or_else(|| {
            anyhow!("the body `{}` has no bone `{name}`, expected one for the actor to wear", self.body.name)
        })
    }

    /// An ellipsoid with `radii` along the bone's axes.
    fn ellipsoid(&mut self, bone: usize, material: Material, centre: DVec3, radii: [f64; 3]) {
        let matrix = DMat3::from_diagonal(DVec3::from(radii) * self.scale);
        let bone_from_local = DAffine3 { matrix3: matrix, translation: centre };
        self.shapes.push(Shape { bone, material, solid: Solid::Ball, bone_from_local });
    }

    /// A capsule from `a` to `b`, its section squeezed to `flat` of the radii along the bone's x axis.
    fn capsule(&mut self, bone: usize, material: Material, a: DVec3, b: DVec3, radii: [f64; 2], flat: f64) {
        let length = a.distance(b).max(1.0);
        let z = (b - a).normalize_or(DVec3::Z);
        // The local x axis is the one nearest to the bone's x, so that `flat` thins the body front to back.
        let x = (DVec3::X - z * z.x).normalize_or(DVec3::Y);
        let matrix3 = DMat3::from_cols(x * flat, z.cross(x), z);
        let solid = Solid::Capsule { length, radius_a: radii[0] * self.scale, radius_b: radii[1] * self.scale };
        self.shapes.push(Shape { bone, material, solid, bone_from_local: DAffine3 { matrix3, translation: a } });
    }

    /// The far end of a bone: the `b` end of the first part on it.
    fn free_end(&self, bone: usize) -> Result<DVec3> {
        let part = self.body.parts.iter().find(|part| part.bone == bone);
        part.map(|part| part.b).ok_or_else(|| {
            let name = &self.body.bones[bone].name;
            anyhow!("the body `{}` has no part on bone `{name}`, expected one that shows where it ends", self.body.name)
        })
    }

    fn trunk(&mut self) -> Result<()> {
        use Material::{Shirt, Skin, Trousers};
        let (pelvis, thorax, head) = (self.bone("pelvis")?, self.bone("thorax")?, self.bone("head")?);
        let s = self.scale;
        let hip = self.body.bones[self.bone("left_axis")?].offset + self.body.bones[self.bone("left_hip")?].offset;
        let waist = self.body.bones[thorax].offset;
        let neck = self.body.bones[head].offset;
        // Pelvis: a broad ellipsoid from hip to hip, the seat behind it.
        self.ellipsoid(pelvis, Trousers, DVec3::new(-4.0 * s, 0.0, hip.z + 34.0 * s), [112.0, 162.0, 112.0]);
        for side in [1.0, -1.0] {
            self.ellipsoid(pelvis, Trousers, DVec3::new(-45.0 * s, side * 62.0 * s, hip.z), [86.0, 88.0, 96.0]);
        }
        // The shirt: a belly whose hem falls over the trousers, chest, shoulder yoke.
        self.ellipsoid(pelvis, Shirt, DVec3::new(4.0 * s, 0.0, 0.5 * hip.z + waist.z - 2.0 * s), [116.0, 150.0, 122.0]);
        let shoulder = self.shoulder("left")?;
        let chest = DVec3::new(6.0 * s, 0.0, 0.48 * shoulder.z);
        self.ellipsoid(thorax, Shirt, chest, [118.0, 158.0, 185.0]);
        for side in [1.0, -1.0] {
            let breast = DVec3::new(34.0 * s, side * 58.0 * s, 0.66 * shoulder.z);
            self.ellipsoid(thorax, Shirt, breast, [78.0, 88.0, 92.0]);
            let blade = DVec3::new(-42.0 * s, side * 76.0 * s, 0.74 * shoulder.z);
            self.ellipsoid(thorax, Shirt, blade, [66.0, 80.0, 110.0]);
            // The yoke slopes from the neck to the shoulder.
            let at_neck = DVec3::new(-8.0 * s, side * 34.0 * s, shoulder.z + 28.0 * s);
            let at_shoulder = DVec3::new(shoulder.x, side * (shoulder.y - 8.0 * s), shoulder.z - 4.0 * s);
            self.capsule(thorax, Shirt, at_neck, at_shoulder, [56.0, 60.0], 0.95);
        }
        let collar = DVec3::new(-6.0 * s, 0.0, shoulder.z + 52.0 * s);
        self.ellipsoid(thorax, Shirt, collar, [70.0, 76.0, 30.0]);
        let throat = DVec3::new(-4.0 * s, 0.0, shoulder.z + 76.0 * s);
        self.capsule(thorax, Skin, throat, neck + DVec3::new(6.0 * s, 0.0, 40.0 * s), [55.0, 54.0], 1.0);
        Ok(())
    }

    /// The shoulder joint in the thorax's axes, arms at rest.
    fn shoulder(&self, side: &str) -> Result<DVec3> {
        let clavicle = self.body.bones[self.bone(&format!("{side}_clavicle"))?].offset;
        Ok(clavicle + self.body.bones[self.bone(&format!("{side}_shoulder"))?].offset)
    }

    fn head(&mut self) -> Result<()> {
        use Material::{Face, Hair, Skin};
        let head = self.bone("head")?;
        let s = self.scale;
        let top = self.free_end(head)?.z.max(120.0 * s);
        // Everything hangs from the top, which the body fixes.
        let centre = DVec3::new(14.0 * s, 0.0, top - 104.0 * s);
        self.ellipsoid(head, Face, centre, [90.0, 72.0, 100.0]);
        self.ellipsoid(head, Face, centre + DVec3::new(22.0, 0.0, -62.0) * s, [62.0, 54.0, 56.0]);
        self.ellipsoid(head, Hair, centre + DVec3::new(-15.0, 0.0, 12.0) * s, [87.0, 77.0, 96.0]);
        self.ellipsoid(head, Hair, centre + DVec3::new(24.0, 0.0, 68.0) * s, [68.0, 62.0, 36.0]);
        self.ellipsoid(head, Skin, centre + DVec3::new(90.0, 0.0, -26.0) * s, [20.0, 13.0, 22.0]);
        for side in [1.0, -1.0] {
            self.ellipsoid(head, Skin, centre + DVec3::new(-4.0, side * 76.0, -20.0) * s, [20.0, 9.0, 30.0]);
        }
        Ok(())
    }

    fn leg(&mut self, side: &str, sign: f64) -> Result<()> {
        use Material::{Shoe, Trousers};
        let (hip, knee) = (self.bone(&format!("{side}_hip"))?, self.bone(&format!("{side}_knee"))?);
        let s = self.scale;
        let thigh = self.body.bones[knee].offset;
        let ankle = self.free_end(knee)?;
        self.capsule(hip, Trousers, DVec3::new(0.0, 0.0, 12.0 * s), thigh, [86.0, 58.0], 1.0);
        // Muscle in front of the upper thigh and outside.
        self.ellipsoid(hip, Trousers, thigh * 0.36 + DVec3::new(10.0 * s, sign * 4.0 * s, 0.0), [79.0, 80.0, 190.0]);
        // A trouser leg wider than the calf, with the calf in it, down to a hem above the shoe.
        let hem = ankle * 0.93;
        self.capsule(knee, Trousers, DVec3::ZERO, hem, [59.0, 50.0], 1.0);
        self.ellipsoid(knee, Trousers, ankle * 0.34 + DVec3::new(-16.0 * s, 0.0, 0.0), [58.0, 60.0, 132.0]);
        // The shoe runs along the foot part, from behind the heel to the toes, its sole level with the part's.
        let foot = self.body.parts.iter().filter(|part| part.bone == knee).nth(1).ok_or_else(|| {
            anyhow!("the body `{}` has no second part on bone `{side}_knee`, expected a foot", self.body.name)
        })?;
        let on_foot = |t: f64, up: f64| foot.a.lerp(foot.b, t) + DVec3::Z * (up * s);
        self.capsule(knee, Shoe, on_foot(0.0, 2.0), on_foot(0.78, 2.0), [40.0, 37.0], 1.0);
        self.ellipsoid(knee, Shoe, on_foot(0.84, 2.0), [68.0, 46.0, 33.0]);
        self.ellipsoid(knee, Shoe, on_foot(0.26, 22.0), [66.0, 40.0, 50.0]);
        Ok(())
    }

    fn arm(&mut self, side: &str, sign: f64) -> Result<()> {
        use Material::{Shirt, Skin};
        let (shoulder, elbow) = (self.bone(&format!("{side}_shoulder"))?, self.bone(&format!("{side}_elbow"))?);
        let s = self.scale;
        let upper = self.body.bones[elbow].offset;
        let wrist = self.free_end(elbow)?;
        self.ellipsoid(shoulder, Shirt, DVec3::new(0.0, sign * 4.0 * s, -16.0 * s), [62.0, 60.0, 72.0]);
        self.capsule(shoulder, Shirt, DVec3::ZERO, upper * 0.56, [57.0, 55.0], 1.0);
        self.capsule(shoulder, Skin, upper * 0.4, upper, [45.0, 39.0], 1.0);
        self.ellipsoid(shoulder, Skin, upper * 0.6 + DVec3::new(8.0 * s, 0.0, 0.0), [44.0, 42.0, 82.0]);
        self.capsule(elbow, Skin, DVec3::ZERO, wrist, [39.0, 29.0], 1.0);
        self.ellipsoid(elbow, Skin, wrist * 0.3, [41.0, 42.0, 92.0]);
        // The hand: palm, fingers a little bent, thumb.
        let hand = self.body.parts.iter().filter(|part| part.bone == elbow).nth(1);
        let tip = hand.map_or(wrist * 1.6, |hand| hand.b);
        let reach = (tip - wrist).length().max(60.0 * s);
        let along = (tip - wrist).normalize_or(DVec3::NEG_Z);
        self.ellipsoid(elbow, Skin, wrist + along * (0.34 * reach), [38.0, 22.0, 62.0]);
        self.capsule(
            elbow,
            Skin,
            wrist + along * (0.6 * reach),
            wrist + along * (0.92 * reach) - DVec3::Y * (sign * 10.0 * s),
            [29.0, 22.0],
            1.2,
        );
        let thumb = wrist + along * (0.25 * reach) + DVec3::X * (30.0 * s);
        self.capsule(elbow, Skin, thumb, thumb + along * (0.4 * reach) + DVec3::X * (10.0 * s), [15.0, 12.0], 1.0);
        Ok(())
    }
}

impl Actor {
    /// Dresses a body. It must have the bones of the default body (METHOD A3) and parts that show where limbs end.
    ///
    /// # Errors
    /// When a bone or the end of a limb is missing; the message names it.
    pub fn new(body: &Body, height: f64) -> Result<Self> {
        let mut tailor = Tailor { body, scale: height / 1750.0, shapes: Vec::new() };
        tailor.trunk()?;
        tailor.head()?;
        for (side, sign) in [("left", 1.0), ("right", -1.0)] {
            tailor.leg(side, sign)?;
            tailor.arm(side, sign)?;
        }
        Ok(Self { shapes: tailor.shapes })
    }

    /// Changes every shape: `change` is given its bone, how far up the bone it lies (mm) and what it is made of, and says how it
    /// is widened along the bone's axes and what it is made of from now on.
    pub(super) fn rebuild(&mut self, change: impl Fn(usize, f64, Material) -> (DVec3, Material)) {
        for shape in &mut self.shapes {
            let (widening, material) = change(shape.bone, shape.bone_from_local.translation.z, shape.material);
            shape.bone_from_local = DAffine3::from_scale(widening) * shape.bone_from_local;
            shape.material = material;
        }
    }

    /// The shapes, in the order of [`Self::place`].
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// The shapes in the world, for given bone frames (`world_from_bone`, one a bone).
    pub fn place(&self, world_from_bone: &[DAffine3]) -> Vec<PlacedSolid> {
        let place = |shape: &Shape| PlacedSolid::new(shape.solid, world_from_bone[shape.bone] * shape.bone_from_local);
        self.shapes.iter().map(place).collect()
    }
}

impl Shape {
    /// Reflectance at a point of the bone's frame, mm.
    pub fn reflectance(&self, at: DVec3) -> Colour {
        if self.material == Material::Face { self.face(at) } else { self.material.reflectance(at) }
    }

    /// Of a face's ellipsoids the jaw is the flatter one: it carries the mouth alone.
    pub(super) fn is_jaw(&self) -> bool {
        let radii = self.bone_from_local.matrix3;
        self.material == Material::Face && radii.z_axis.z < radii.x_axis.x
    }

    /// Eyes, brows and mouth on the front of the head, placed relative to the shape's own centre.
    fn face(&self, at: DVec3) -> Colour {
        let skin = self.material.reflectance(at);
        let radii = self.bone_from_local.matrix3;
        let local =
            (at - self.bone_from_local.translation) / DVec3::new(radii.x_axis.x, radii.y_axis.y, radii.z_axis.z);
        if local.x < 0.5 || self.is_jaw() {
            let mouth = local.x > 0.6 && local.y.abs() < 0.42 && (local.z + 0.08).abs() < 0.1;
            return if mouth { Colour::new(0.36, 0.13, 0.11) } else { skin };
        }
        let (side, up) = (local.y.abs() - 0.42, local.z + 0.06);
        let eye = (side / 0.15).powi(2) + (up / 0.075).powi(2) < 1.0;
        let brow = side.abs() < 0.22 && (local.z - 0.14).abs() < 0.04;
        if eye {
            Colour::new(0.06, 0.05, 0.05)
        } else if brow {
            Colour::new(0.10, 0.06, 0.04)
        } else {
            skin
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_limb_is_named() {
        let mut body = Body::adult(1750.0).unwrap();
        assert!(Actor::new(&body, 1750.0).unwrap().shapes().len() > 40);
        let elbow = body.bone_index("left_elbow").unwrap();
        body.parts.retain(|part| part.bone != elbow);
        let error = Actor::new(&body, 1750.0).unwrap_err().to_string();
        assert!(error.contains("no part on bone `left_elbow`"), "{error}");
        body.bones[elbow].name = "tentacle".into();
        let error = Actor::new(&body, 1750.0).unwrap_err().to_string();
        assert!(error.contains("no bone `left_elbow`"), "{error}");
    }

    #[test]
    fn the_actor_is_as_tall_as_asked_and_stands_on_his_soles() {
        for height in [1000.0, 1750.0, 2100.0] {
            let body = Body::adult(height).unwrap();
            let actor = Actor::new(&body, height).unwrap();
            let bones = body.world_from_bones(&body.standing_pose()).unwrap();
            let (mut low, mut high) = (f64::INFINITY, 0.0f64);
            for solid in actor.place(&bones) {
                // Rays straight down and up through the solid's balls find its ends.
                for (centre, _) in solid.bounding_balls() {
                    let hit = |from: f64, direction: DVec3| {
                        let origin = centre + DVec3::Z * from;
                        let ray = super::super::solid::Ray { origin, direction };
                        solid.first_hit(&ray).map(|(t, _)| (origin + direction * t).z)
                    };
                    high = high.max(hit(3000.0, DVec3::NEG_Z).unwrap_or(high));
                    low = low.min(hit(-3000.0, DVec3::Z).unwrap_or(low));
                }
            }
            assert!((high - height).abs() < 0.012 * height, "crown at {high} of {height}");
            assert!(low.abs() < 0.012 * height, "soles at {low} of {height}");
        }
    }
}

//! A person as drawn: ellipsoids and capsules on the bones of a body, or a skinned mesh, with what each wears.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use glam::{DAffine3, DVec3};

use super::actor::{Actor, Material};
use super::build::Build;
use super::colour::Colour;
use super::finish::{Finish, FinishSettings};
use super::solid::BoundingBall;
use super::triangle::{Primitive, Triangle};
use crate::body::{Body, Mesh, without_side};

/// The finishes that replace the tailor's own, by garment.
#[derive(Debug, Default)]
pub struct Wardrobe(BTreeMap<String, Finish>);

impl Wardrobe {
    /// Looks up what scene.toml names.
    ///
    /// # Errors
    /// When a finish is unknown or out of range.
    pub fn new(clothes: &BTreeMap<String, FinishSettings>) -> Result<Self> {
        let finish = |(name, settings): (&String, &FinishSettings)| Ok((name.clone(), settings.finish(name)?));
        Ok(Self(clothes.iter().map(finish).collect::<Result<_>>()?))
    }

    /// The colour of a garment at a point of its object (x forward, y left, z up, mm), where it is replaced.
    fn colour(&self, material: Material, at: DVec3) -> Option<Colour> {
        // Materials lie in their x and y: around and up the body.
        self.0.get(material.garment()).map(|finish| finish.at(DVec3::new(at.y, at.z, at.x)))
    }
}

/// A person, ready to be posed.
#[derive(Debug)]
pub struct Figure {
    body: Body,
    wardrobe: Wardrobe,
    shape: Shape,
}

#[derive(Debug)]
enum Shape {
    Solids(Actor),
    Mesh { mesh: Mesh, materials: Vec<Material> },
}

/// A person in one pose.
pub struct PlacedFigure<'a> {
    figure: &'a Figure,
    bone_from_world: Vec<DAffine3>,
    /// Solids or triangles, in the order of the figure's.
    pub primitives: Vec<Primitive>,
    /// What stands for them where light comes from all around.
    pub balls: Vec<[BoundingBall; 2]>,
}

/// What a person looks like at a point.
pub struct Look {
    /// What it is made of.
    pub material: Material,
    /// Its colour.
    pub reflectance: Colour,
    /// The point in the object's own frame, mm.
    pub at: DVec3,
}

impl Figure {
    /// What replaces the tailor's own, by garment.
    pub(super) fn finishes(&self) -> &BTreeMap<String, Finish> {
        &self.wardrobe.0
    }

    /// A person of ellipsoids and capsules.
    ///
    /// # Errors
    /// When the body lacks a bone that is dressed.
    pub fn of_solids(body: &Body, height: f64, wardrobe: Wardrobe) -> Result<Self> {
        Ok(Self { body: body.clone(), wardrobe, shape: Shape::Solids(Actor::new(body, height)?) })
    }

    /// A person with the skin of the body's mesh.
    ///
    /// # Errors
    /// When the mesh cannot be read or does not fit the body.
    pub fn of_mesh(body: &Body, wardrobe: Wardrobe) -> Result<Self> {
        let mesh = Mesh::of_body(body)?;
        let origins: Vec<DVec3> = mesh.inverse_bind.iter().map(|bind| bind.inverse().translation).collect();
        let of_bone = |name: &str| body.bone_index(name).map(|bone| origins[bone]);
        let low = mesh.vertices.iter().map(|vertex| f64::from(vertex.position.z)).fold(f64::INFINITY, f64::min);
        let high = mesh.vertices.iter().map(|vertex| f64::from(vertex.position.z)).fold(f64::NEG_INFINITY, f64::max);
        let (neck, waist) = (of_bone("head").map_or(high, |at| at.z), of_bone("thorax").map_or(0.0, |at| at.z));
        let materials = mesh
            .triangles
            .iter()
            .map(|corners| {
                let vertices = corners.map(|corner| &mesh.vertices[corner as usize]);
                let middle = vertices.iter().map(|vertex| vertex.position.as_dvec3()).sum::<DVec3>() / 3.0;
                let bone = usize::from(vertices[0].bones[0]);
                let name = body.bones[bone].name.as_str();
                let plain = without_side(name);
                let along = (mesh.inverse_bind[bone].transform_point3(middle)).z;
                match plain {
                    "head" => {
                        let up = (middle.z - neck) / (high - neck).max(1.0);
                        let is_hair =
                            up > 0.78 || (up > 0.45 && middle.x < of_bone("head").map_or(0.0, |at| at.x) + 5.0);
                        if is_hair { Material::Hair } else { Material::Skin }
                    }
                    // Ankles are 0.04 of the height above the floor, hems a little higher.
                    "hip" | "knee" if middle.z < low + 0.05 * (high - low) => Material::Shoe,
                    "hip" | "knee" => Material::Trousers,
                    "pelvis" | "axis" if middle.z < waist - 70.0 => Material::Trousers,
                    "thorax" | "clavicle" if middle.z > neck - 45.0 => Material::Skin,
                    // Sleeves end above the elbow.
                    "shoulder" if along < -165.0 => Material::Skin,
                    "elbow" => Material::Skin,
                    _ => Material::Shirt,
                }
            })
            .collect();
        Ok(Self { body: body.clone(), wardrobe, shape: Shape::Mesh { mesh, materials } })
    }

    /// The person with another build: wider or thinner across the bones, with longer sleeves, shorter trousers. Lengths are the
    /// body's.
    #[must_use]
    pub fn built(mut self, build: &Build) -> Self {
        let end_of = |bone: usize| self.body.parts.iter().find(|part| part.bone == bone).map_or(0.0, |part| part.b.z);
        let wearing = |bone: usize, along: f64, material: Material| {
            let name = self.body.bones[bone].name.as_str();
            let is_arm = name.ends_with("shoulder") || (name.ends_with("elbow") && along > 0.93 * end_of(bone));
            match material {
                Material::Skin if build.long_sleeves && is_arm => Material::Shirt,
                Material::Trousers if build.shorts && name.ends_with("knee") => Material::Skin,
                other => other,
            }
        };
        match &mut self.shape {
            Shape::Solids(actor) => actor.rebuild(|bone, along, material| {
                (build.widening(&self.body.bones[bone].name), wearing(bone, along, material))
            }),
            Shape::Mesh { mesh, materials } => {
                for (corners, material) in mesh.triangles.iter().zip(materials) {
                    let vertices = corners.map(|corner| &mesh.vertices[corner as usize]);
                    let middle = vertices.iter().map(|vertex| vertex.position.as_dvec3()).sum::<DVec3>() / 3.0;
                    let bone = usize::from(vertices[0].bones[0]);
                    *material = wearing(bone, mesh.inverse_bind[bone].transform_point3(middle).z, *material);
                }
                for (bind, bone) in mesh.inverse_bind.iter_mut().zip(&self.body.bones) {
                    *bind = DAffine3::from_scale(build.widening(&bone.name)) * *bind;
                }
            }
        }
        self
    }

    /// The person in a pose (mm, radians).
    ///
    /// # Errors
    /// When the pose does not fit the body.
    pub fn place(&self, pose: &[f64]) -> Result<PlacedFigure<'_>> {
        let world_from_bone = self.body.world_from_bones(pose)?;
        let bone_from_world = world_from_bone.iter().map(DAffine3::inverse).collect();
        let (primitives, balls): (Vec<Primitive>, Vec<[BoundingBall; 2]>) = match &self.shape {
            Shape::Solids(actor) => {
                let solids = actor.place(&world_from_bone);
                let balls = solids.iter().map(|solid| solid.bounding_balls()).collect();
                (solids.into_iter().map(Primitive::Solid).collect(), balls)
            }
            Shape::Mesh { mesh, .. } => {
                let posed: Vec<DVec3> = mesh.posed(&world_from_bone)?.into_iter().map(|at| at.as_dvec3()).collect();
                let balls = self.body.parts.iter().map(|part| {
                    let bone = &world_from_bone[part.bone];
                    [(bone.transform_point3(part.a), part.radius_a), (bone.transform_point3(part.b), part.radius_b)]
                });
                (triangles(mesh, &posed), balls.collect())
            }
        };
        Ok(PlacedFigure { figure: self, bone_from_world, primitives, balls })
    }
}

/// The triangles with normals that are the mean of those that meet in a corner, weighted by their areas.
fn triangles(mesh: &Mesh, posed: &[DVec3]) -> Vec<Primitive> {
    let mut normals = vec![DVec3::ZERO; posed.len()];
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|corner| posed[corner as usize]);
        for &corner in corners {
            normals[corner as usize] += (b - a).cross(c - a);
        }
    }
    let normals: Vec<DVec3> = normals.into_iter().map(DVec3::normalize_or_zero).collect();
    let triangle = |corners: &[u32; 3]| {
        Primitive::Triangle(Triangle::new(
            corners.map(|corner| posed[corner as usize]),
            corners.map(|corner| normals[corner as usize]),
            corners.map(|corner| mesh.vertices[corner as usize].position.as_dvec3()),
        ))
    };
    mesh.triangles.iter().map(triangle).collect()
}

impl PlacedFigure<'_> {
    /// What the person looks like at a point of a primitive.
    pub fn look(&self, primitive: usize, point: DVec3) -> Look {
        let (material, at, own) = match (&self.figure.shape, &self.primitives[primitive]) {
            (Shape::Solids(actor), _) => {
                let shape = &actor.shapes()[primitive];
                let at = self.bone_from_world[shape.bone].transform_point3(point);
                (shape.material, at, shape.reflectance(at))
            }
            (Shape::Mesh { materials, .. }, Primitive::Triangle(triangle)) => {
                let (material, at) = (materials[primitive], triangle.rest_at(point));
                (material, at, material.reflectance(at))
            }
            (Shape::Mesh { materials, .. }, Primitive::Solid(_)) => {
                (materials[primitive], point, materials[primitive].reflectance(point))
            }
        };
        // A painted face stays, whatever its skin is replaced by.
        let is_painted = material == Material::Face && own != Material::Face.reflectance(at);
        let worn = if is_painted { None } else { self.figure.wardrobe.colour(material, at) };
        Look { material, reflectance: worn.unwrap_or(own), at }
    }

    /// Of a solid: the frame that what it is made of lies in, and whether it is a jaw.
    pub(super) fn object_of(&self, primitive: usize) -> (DAffine3, bool) {
        match &self.figure.shape {
            Shape::Solids(actor) => {
                let shape = &actor.shapes()[primitive];
                (self.bone_from_world[shape.bone], shape.is_jaw())
            }
            Shape::Mesh { .. } => (DAffine3::IDENTITY, false),
        }
    }

    /// What a primitive is made of.
    pub fn material(&self, primitive: usize) -> Material {
        match &self.figure.shape {
            Shape::Solids(actor) => actor.shapes()[primitive].material,
            Shape::Mesh { materials, .. } => materials[primitive],
        }
    }

    /// The middle of the root, on the floor.
    ///
    /// # Errors
    /// When the body has no root.
    pub fn root(&self) -> Result<DVec3> {
        let root = self.figure.body.update_order.first().context("the body has no root")?;
        Ok(self.bone_from_world[*root].inverse().translation)
    }
}

//! What a body is. Reading it from `body.toml` is in the loader, posing it in the kinematics.

use anyhow::{Result, ensure};
use glam::DVec3;

use super::MeshSource;
use crate::files::choices;
use crate::geometry::EulerOrder;

/// A body: any tree of bones, any degrees of freedom. Built by the loader, which guarantees: exactly one root, no cycle,
/// unique names, unique labels 1..=127, limits in order, positive radii and lengths of parts, everything finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// The bones in file order; a parent may stand after its child.
    pub bones: Vec<Bone>,
    /// The parts of the flat model in file order; at equal depth the later one is nearer.
    pub parts: Vec<Part>,
    /// The virtual markers in file order.
    pub markers: Vec<Marker>,
    /// Where the mesh comes from, when the body has one.
    pub mesh: Option<MeshSource>,
    /// Indices of the bones, every parent before its children.
    pub update_order: Vec<usize>,
}

/// A point of a body that no bone has its origin in, named in joints.csv: an ankle, a wrist, the top of the head.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeEnd {
    /// Its name.
    pub name: &'static str,
    /// Index of the bone it is fixed to.
    pub bone: usize,
    /// Position in the bone's frame, mm.
    pub at: DVec3,
}

/// Free ends and the bones they end, as FORMATS settles them: each is the `b` end of the bone's first part.
const FREE_ENDS: [(&str, &str); 5] = [
    ("left_ankle", "left_knee"),
    ("right_ankle", "right_knee"),
    ("left_wrist", "left_elbow"),
    ("right_wrist", "right_elbow"),
    ("head_top", "head"),
];

/// A bone: its joint with the parent and the rigid frame that hangs on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Bone {
    /// Its name.
    pub name: String,
    /// The parent's index; `None` for the root.
    pub parent: Option<usize>,
    /// Origin from the parent's origin in the parent's axes, mm.
    pub offset: DVec3,
    /// Order in which its rotations multiply.
    pub order: EulerOrder,
    /// Its degrees of freedom, in the order tx ty tz rx ry rz.
    pub dofs: Vec<Dof>,
}

/// One degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dof {
    /// What it moves.
    pub axis: DofAxis,
    /// Smallest and largest value: mm, or radians.
    pub limits: [f64; 2],
    /// Standard deviation of its change in 1/25 s: mm, or radians.
    pub step: f64,
}

choices! {
    /// What a degree of freedom moves, in the order of the state vector.
    #[derive(PartialOrd, Ord)]
    "dof" pub enum DofAxis {
        /// Translation along x.
        "tx" Tx,
        /// Translation along y.
        "ty" Ty,
        /// Translation along z.
        "tz" Tz,
        /// Rotation about x.
        "rx" Rx,
        /// Rotation about y.
        "ry" Ry,
        /// Rotation about z.
        "rz" Rz,
    }
}

impl DofAxis {
    /// A value as files write it: degrees for an angle, mm for a length.
    pub fn to_file(self, value: f64) -> f64 {
        if self.is_rotation() { value.to_degrees() } else { value }
    }

    /// The inverse of [`Self::to_file`].
    pub fn from_file(self, value: f64) -> f64 {
        if self.is_rotation() { value.to_radians() } else { value }
    }

    /// The unit of [`Self::to_file`], for messages.
    pub fn file_unit(self) -> &'static str {
        if self.is_rotation() { "degrees" } else { "mm" }
    }

    /// Whether the value is an angle (radians inside, degrees in files) and not a length (mm).
    pub fn is_rotation(self) -> bool {
        self >= Self::Rx
    }

    /// Its slot among the six of a bone.
    pub fn slot(self) -> usize {
        self as usize
    }
}

/// A truncated cone of the flat model.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// Index of the bone it hangs on.
    pub bone: usize,
    /// Centre of one end in the bone's frame, mm.
    pub a: DVec3,
    /// Centre of the other end in the bone's frame, mm.
    pub b: DVec3,
    /// Radius at `a`, mm.
    pub radius_a: f64,
    /// Radius at `b`, mm.
    pub radius_b: f64,
    /// Label in candidate images, 1..=127.
    pub label: u8,
}

/// A virtual marker, for comparison with motion capture.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// Its name.
    pub name: String,
    /// Index of its bone.
    pub bone: usize,
    /// Position in the bone's frame, mm.
    pub at: DVec3,
}

impl Body {
    /// The degrees of freedom of the whole body in state-vector order: (bone index, degree of freedom), bones in file
    /// order.
    pub fn dofs(&self) -> impl Iterator<Item = (usize, &Dof)> {
        self.bones.iter().enumerate().flat_map(|(index, bone)| bone.dofs.iter().map(move |dof| (index, dof)))
    }

    /// The length of the state vector.
    pub fn dof_count(&self) -> usize {
        self.bones.iter().map(|bone| bone.dofs.len()).sum()
    }

    /// Column names of the state vector, `pelvis.tx` first.
    pub fn dof_names(&self) -> Vec<String> {
        self.dofs().map(|(bone, dof)| format!("{}.{}", self.bones[bone].name, dof.axis.name())).collect()
    }

    /// The place of the degree of freedom of that name in the state vector.
    pub fn dof_index(&self, name: &str) -> Option<usize> {
        let (bone, axis) = name.rsplit_once('.')?;
        self.dofs().position(|(index, dof)| self.bones[index].name == bone && dof.axis.name() == axis)
    }

    /// The place of the root's degree of freedom along or about an axis in the state vector.
    pub fn root_dof(&self, axis: DofAxis) -> Option<usize> {
        self.dofs().position(|(bone, dof)| self.bones[bone].parent.is_none() && dof.axis == axis)
    }

    /// The index of the bone of that name.
    pub fn bone_index(&self, name: &str) -> Option<usize> {
        self.bones.iter().position(|bone| bone.name == name)
    }

    /// The free ends of this body: those whose bone is there, has a part, and whose name is not that of a bone (a body
    /// with ankles of its own).
    pub fn free_ends(&self) -> Vec<FreeEnd> {
        FREE_ENDS
            .into_iter()
            .filter(|(name, _)| self.bone_index(name).is_none())
            .filter_map(|(name, bone)| {
                let bone = self.bone_index(bone)?;
                let part = self.parts.iter().find(|part| part.bone == bone)?;
                Some(FreeEnd { name, bone, at: part.b })
            })
            .collect()
    }

    /// Names of the joints as joints.csv has them: every bone, then the free ends.
    pub fn joint_names(&self) -> Vec<String> {
        let ends = self.free_ends();
        self.bones.iter().map(|bone| bone.name.clone()).chain(ends.iter().map(|end| end.name.to_string())).collect()
    }

    /// The place of the joint of that name among [`Self::joint_names`].
    pub fn joint_index(&self, name: &str) -> Option<usize> {
        let end = || self.free_ends().iter().position(|end| end.name == name);
        self.bone_index(name).or_else(|| Some(self.bones.len() + end()?))
    }

    /// Names of the markers in file order.
    pub fn marker_names(&self) -> Vec<String> {
        self.markers.iter().map(|marker| marker.name.clone()).collect()
    }

    /// The same body `factor` times as large: offsets, parts, markers, and the translations of joints inside the body.
    /// The root's translation limits and step stay, being about the room; so do angles, and a mesh's file.
    ///
    /// # Errors
    /// When the factor is not between 0.01 and 100.
    pub fn scaled(&self, factor: f64) -> Result<Self> {
        ensure!((0.01..=100.0).contains(&factor), "a body cannot be scaled by {factor}, expected 0.01 to 100");
        let mut body = self.clone();
        for bone in &mut body.bones {
            bone.offset *= factor;
            if bone.parent.is_some() {
                for dof in bone.dofs.iter_mut().filter(|dof| !dof.axis.is_rotation()) {
                    dof.limits = dof.limits.map(|limit| limit * factor);
                    dof.step *= factor;
                }
            }
        }
        for part in &mut body.parts {
            part.a *= factor;
            part.b *= factor;
            part.radius_a *= factor;
            part.radius_b *= factor;
        }
        for marker in &mut body.markers {
            marker.at *= factor;
        }
        Ok(body)
    }

    /// The same body with its lengths (offsets, parts, markers) rounded to tenths of a millimetre, as a file is better read.
    /// Radii stay above zero.
    pub fn rounded(&self) -> Self {
        let tenths = |length: f64| (length * 10.0).round() / 10.0;
        let point = |at: DVec3| DVec3::new(tenths(at.x), tenths(at.y), tenths(at.z));
        let mut body = self.clone();
        for bone in &mut body.bones {
            bone.offset = point(bone.offset);
        }
        for part in &mut body.parts {
            (part.a, part.b) = (point(part.a), point(part.b));
            (part.radius_a, part.radius_b) = (tenths(part.radius_a).max(0.1), tenths(part.radius_b).max(0.1));
        }
        for marker in &mut body.markers {
            marker.at = point(marker.at);
        }
        body
    }
}

/// The name of a bone, part or joint without its side, which `left_` or `right_` before it says.
pub(crate) fn without_side(name: &str) -> &str {
    name.strip_prefix("left_").or_else(|| name.strip_prefix("right_")).unwrap_or(name)
}

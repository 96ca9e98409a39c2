//! What a body is. Reading it from `body.toml` is in the loader, posing it in the kinematics.

use glam::DVec3;

use crate::geometry::EulerOrder;

/// A body: any tree of bones, any degrees of freedom. Built by the loader, which guarantees: exactly one root, no cycle,
/// unique names, unique labels 1..=127, limits in order, positive radii, everything finite.
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
    /// Indices of the bones, every parent before its children.
    pub update_order: Vec<usize>,
}

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

/// What a degree of freedom moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DofAxis {
    /// Translation along x.
    Tx,
    /// Translation along y.
    Ty,
    /// Translation along z.
    Tz,
    /// Rotation about x.
    Rx,
    /// Rotation about y.
    Ry,
    /// Rotation about z.
    Rz,
}

impl DofAxis {
    /// All six in the order of the state vector.
    pub const ALL: [Self; 6] = [Self::Tx, Self::Ty, Self::Tz, Self::Rx, Self::Ry, Self::Rz];

    /// The name as files write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tx => "tx",
            Self::Ty => "ty",
            Self::Tz => "tz",
            Self::Rx => "rx",
            Self::Ry => "ry",
            Self::Rz => "rz",
        }
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

    /// The index of the bone of that name.
    pub fn bone_index(&self, name: &str) -> Option<usize> {
        self.bones.iter().position(|bone| bone.name == name)
    }
}

//! Rotations of bones: Euler angles in a stated order, right-handed (SPEC A3).

use glam::{DMat3, DVec3};

/// The order in which the three elementary rotations of a bone are multiplied, leftmost first: `Xyz` is R_x R_y R_z,
/// the documented convention of the body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum EulerOrder {
    /// R_x R_y R_z
    #[default]
    Xyz,
    /// R_x R_z R_y
    Xzy,
    /// R_y R_x R_z
    Yxz,
    /// R_y R_z R_x
    Yzx,
    /// R_z R_x R_y
    Zxy,
    /// R_z R_y R_x
    Zyx,
}

impl EulerOrder {
    /// All six, for tests and messages.
    pub const ALL: [Self; 6] = [Self::Xyz, Self::Xzy, Self::Yxz, Self::Yzx, Self::Zxy, Self::Zyx];

    /// The axes of the product from left to right: 0 = x, 1 = y, 2 = z.
    pub fn axes(self) -> [usize; 3] {
        match self {
            Self::Xyz => [0, 1, 2],
            Self::Xzy => [0, 2, 1],
            Self::Yxz => [1, 0, 2],
            Self::Yzx => [1, 2, 0],
            Self::Zxy => [2, 0, 1],
            Self::Zyx => [2, 1, 0],
        }
    }

    /// The name as files write it: `xyz`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Xyz => "xyz",
            Self::Xzy => "xzy",
            Self::Yxz => "yxz",
            Self::Yzx => "yzx",
            Self::Zxy => "zxy",
            Self::Zyx => "zyx",
        }
    }

    /// The order of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|order| order.name() == name)
    }
}

/// The rotation of `angles` (about x, y, z, radians), multiplied in `order`.
pub fn euler_matrix(angles: DVec3, order: EulerOrder) -> DMat3 {
    let elementary =
        [DMat3::from_rotation_x(angles.x), DMat3::from_rotation_y(angles.y), DMat3::from_rotation_z(angles.z)];
    let [first, second, third] = order.axes();
    elementary[first] * elementary[second] * elementary[third]
}

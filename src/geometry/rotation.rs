//! Rotations, right-handed: of bones by Euler angles in a stated order (METHOD A3), of cameras by Rodrigues vectors.

use glam::{DMat3, DQuat, DVec3};

use crate::files::choices;

choices! {
    /// The order in which the three elementary rotations of a bone are multiplied, leftmost first: `xyz` is R_x R_y R_z, the
    /// documented convention of the body; and the axes from left to right, 0 = x, 1 = y, 2 = z.
    #[derive(Default)]
    "order" pub enum EulerOrder => pub axes: [usize; 3] {
        /// R_x R_y R_z
        "xyz" #[default] Xyz => [0, 1, 2],
        /// R_x R_z R_y
        "xzy" Xzy => [0, 2, 1],
        /// R_y R_x R_z
        "yxz" Yxz => [1, 0, 2],
        /// R_y R_z R_x
        "yzx" Yzx => [1, 2, 0],
        /// R_z R_x R_y
        "zxy" Zxy => [2, 0, 1],
        /// R_z R_y R_x
        "zyx" Zyx => [2, 1, 0],
    }
}

impl EulerOrder {
    /// The angles about x, y, z (radians, the middle one within a quarter turn) whose product in this order is `rotation`:
    /// the inverse of [`euler_matrix`].
    pub fn angles(self, rotation: &DMat3) -> [f64; 3] {
        let [i, j, k] = self.axes();
        // Even orders are x y z and what follows from it by going round.
        let sign = if (i + 1) % 3 == j { 1.0 } else { -1.0 };
        let at = |row: usize, column: usize| rotation.col(column)[row];
        let mut angles = [0.0; 3];
        angles[i] = (-sign * at(j, k)).atan2(at(k, k));
        angles[j] = (sign * at(i, k)).clamp(-1.0, 1.0).asin();
        angles[k] = (-sign * at(i, j)).atan2(at(i, i));
        angles
    }
}

/// The rotation of `angles` (about x, y, z, radians), multiplied in `order`.
pub fn euler_matrix(angles: DVec3, order: EulerOrder) -> DMat3 {
    let elementary =
        [DMat3::from_rotation_x(angles.x), DMat3::from_rotation_y(angles.y), DMat3::from_rotation_z(angles.z)];
    let [first, second, third] = order.axes();
    elementary[first] * elementary[second] * elementary[third]
}

/// The rotation of a Rodrigues vector: about its direction, by its length in radians.
pub fn rodrigues_matrix(vector: DVec3) -> DMat3 {
    let angle = vector.length();
    // Below this the axis cannot be normalised any more, and the sine is the angle to the last bit.
    if angle < 1e-150 {
        return DMat3::from_cols(
            DVec3::new(1.0, vector.z, -vector.y),
            DVec3::new(-vector.z, 1.0, vector.x),
            DVec3::new(vector.y, -vector.x, 1.0),
        );
    }
    DMat3::from_axis_angle(vector / angle, angle)
}

/// The Rodrigues vector of a rotation, of length pi or less.
pub fn rodrigues_vector(rotation: DMat3) -> DVec3 {
    let quaternion = DQuat::from_mat3(&rotation);
    // q and -q are the same rotation; this one turns by less than half a circle.
    let quaternion = if quaternion.w < 0.0 { -quaternion } else { quaternion };
    let axis = quaternion.xyz();
    let sine = axis.length();
    if sine < 1e-150 { axis * 2.0 } else { axis * (2.0 * sine.atan2(quaternion.w) / sine) }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn rodrigues_vectors_round_trip(x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -1.0..1.0_f64, exponent in -20..1) {
            let vector = DVec3::new(x, y, z) * 10.0_f64.powi(exponent) * 1.8;
            prop_assume!(vector.length() < std::f64::consts::PI);
            let back = rodrigues_vector(rodrigues_matrix(vector));
            prop_assert!((back - vector).length() <= 1e-15 + 1e-14 * vector.length(), "{vector} {back}");
        }
    }

    proptest! {
        #[test]
        fn angles_are_those_of_the_matrix(a in -3.1..3.1_f64, b in -1.5..1.5_f64, c in -3.1..3.1_f64, which in 0..6_usize) {
            let order = EulerOrder::ALL[which];
            let mut angles = [0.0; 3];
            for (axis, angle) in order.axes().into_iter().zip([a, b, c]) {
                angles[axis] = angle;
            }
            let found = order.angles(&euler_matrix(angles.into(), order));
            prop_assert!(found.iter().zip(angles).all(|(f, e)| (f - e).abs() < 1e-9), "{found:?} {angles:?}");
        }
    }

    #[test]
    fn rodrigues_at_the_ends() {
        assert_eq!(rodrigues_matrix(DVec3::ZERO), DMat3::IDENTITY);
        assert_eq!(rodrigues_vector(DMat3::IDENTITY), DVec3::ZERO);
        let half_turn = DVec3::new(1.0, 2.0, -2.0) / 3.0 * std::f64::consts::PI;
        let back = rodrigues_vector(rodrigues_matrix(half_turn));
        assert!((back - half_turn).length().min((back + half_turn).length()) < 1e-12, "{back}");
        let quarter = rodrigues_matrix(DVec3::Z * std::f64::consts::FRAC_PI_2);
        assert!((quarter * DVec3::X - DVec3::Y).length() < 1e-15, "right-handed");
    }
}

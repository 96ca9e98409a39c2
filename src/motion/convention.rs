//! Whose axes and units a file is written in.

use glam::DVec3;

use crate::files::choices;

choices! {
    /// Whose axes and units a file is written in.
    #[derive(Default)]
    "convention" pub enum Convention {
        /// As all files here: mm, z up (x forward, y left); a BVH in centimetres, y up.
        "pantin" #[default] Pantin,
        /// As OpenSim has it: metres, y up (x left, z forward).
        "opensim" OpenSim,
    }
}

impl Convention {
    /// Length of the unit that a BVH is written in, mm.
    pub fn bvh_unit(self) -> f64 {
        match self {
            Self::Pantin => 10.0,
            Self::OpenSim => 1000.0,
        }
    }
}

/// A vector of the z-up frame (x forward, y left) in the y-up frame (x left, z forward) of OpenSim, BVH and glTF files.
pub(crate) fn y_up(p: DVec3) -> DVec3 {
    DVec3::new(p.y, p.z, p.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn y_up_is_right_handed() {
        assert_eq!((y_up(DVec3::X), y_up(DVec3::Y), y_up(DVec3::Z)), (DVec3::Z, DVec3::X, DVec3::Y));
        assert_eq!(y_up(DVec3::X).cross(y_up(DVec3::Y)), y_up(DVec3::Z));
    }
}

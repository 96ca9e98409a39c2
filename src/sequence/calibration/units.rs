//! The unit of a calibration's lengths: stated, or metres with a check that tells when that cannot be.

use anyhow::{Result, anyhow, ensure};

use crate::geometry::Camera;

/// No recording has a camera farther from the origin of its world.
const FARTHEST_MM: f64 = 100_000.0;

/// Where no camera stands farther from the origin than this, the lengths are no millimetres.
const NEAREST_MM: f64 = 50.0;

/// The unit of a file's lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Units {
    Metres,
    Millimetres,
}

impl Units {
    pub(super) fn from_name(name: &str) -> Result<Self> {
        match name {
            "m" => Ok(Self::Metres),
            "mm" => Ok(Self::Millimetres),
            _ => Err(anyhow!("units is {name:?}, expected \"m\" or \"mm\"")),
        }
    }

    fn in_mm(self) -> f64 {
        match self {
            Self::Metres => 1000.0,
            Self::Millimetres => 1.0,
        }
    }
}

/// Brings translations to mm. `stated` is what the file says; without it metres are assumed. `how` shows the line that
/// states a unit, with `{}` for it.
///
/// # Errors
/// When the cameras then stand absurdly far from the origin of the world, or all absurdly near.
pub(super) fn to_mm(cameras: &mut [Camera], stated: Option<Units>, how: &str) -> Result<()> {
    let units = stated.unwrap_or(Units::Metres);
    let state = |unit: &str| how.replace("{}", unit);
    let mut farthest = 0.0_f64;
    for camera in cameras {
        camera.camera_from_world.translation *= units.in_mm();
        let distance = camera.camera_from_world.translation.length();
        farthest = farthest.max(distance);
        let name = &camera.name;
        let metres = distance / 1000.0;
        ensure!(
            distance <= FARTHEST_MM,
            "{}",
            match stated {
                None => format!(
                    "camera `{name}` would stand {metres:.0} m from the origin: the file states no units and metres are \
                     assumed; if its lengths are millimetres, add {}",
                    state("mm")
                ),
                Some(Units::Metres) => format!(
                    "camera `{name}` would stand {metres:.0} m from the origin, expected at most 100: wrong units, if the \
                     lengths are millimetres write {}",
                    state("mm")
                ),
                Some(Units::Millimetres) => format!(
                    "camera `{name}` would stand {metres:.0} m from the origin, expected at most 100: wrong units or a \
                     damaged translation"
                ),
            }
        );
    }
    // A single camera may well be its world's own origin: there is then no length to judge by.
    ensure!(
        units == Units::Metres || farthest == 0.0 || farthest >= NEAREST_MM,
        "no camera would stand farther than {farthest:.1} mm from the origin, expected at least {NEAREST_MM}: wrong units, \
         if the lengths are metres write {}",
        state("m")
    );
    Ok(())
}

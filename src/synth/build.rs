//! How an actor is built: bones and girths that differ from the default adult's.

use std::collections::BTreeMap;

use anyhow::Result;
use glam::DVec3;

use super::scene::ActorSettings;
use crate::body::{Body, Proportions, without_side};

/// What of an actor's figure differs from the usual.
#[derive(Clone, Debug, Default)]
pub struct Build {
    /// Factors on lengths and girths.
    pub proportions: Proportions,
    /// Sleeves reach the wrists.
    pub long_sleeves: bool,
    /// Trousers end at the knees.
    pub shorts: bool,
}

impl Build {
    /// What a scene asks for.
    ///
    /// # Errors
    /// When a proportion is unknown or out of range.
    pub(super) fn of(actor: &ActorSettings) -> Result<Self> {
        let proportions = Proportions::named(&actor.proportions)?;
        Ok(Self { proportions, long_sleeves: actor.long_sleeves, shorts: actor.shorts })
    }

    /// Factors along a bone's axes on what hangs on it: lengths are the bones' own, so only across.
    pub(super) fn widening(&self, bone: &str) -> DVec3 {
        let plain = without_side(bone);
        let of = |name| self.proportions.of(name);
        // A trunk grows more to the front than to the sides, where the arms hang.
        let trunk = |girth: f64, width: f64| DVec3::new(1.0 + 1.3 * (girth - 1.0), width + 0.6 * (girth - 1.0), 1.0);
        let round = |girth: f64| DVec3::new(girth, girth, 1.0);
        match plain {
            "pelvis" | "axis" => trunk(of("belly girth"), 0.5 + 0.5 * of("hip width")),
            "thorax" => trunk(of("chest girth"), 0.5 + 0.5 * of("shoulder width")),
            "head" => round(of("head girth")),
            "shoulder" => round(of("upper arm girth")),
            "elbow" => round(of("forearm girth")),
            "hip" => round(of("thigh girth")),
            "knee" => round(of("calf girth")),
            _ => DVec3::ONE,
        }
    }
}

/// The bones and parts of an actor; the skin of a mesh is not among them.
///
/// # Errors
/// When the height is none of a person, a proportion is unknown, or the mesh's bones cannot be read.
pub(super) fn body_of(actor: &ActorSettings) -> Result<Body> {
    let adult = Body::adult(actor.height)?;
    let mut body = match &actor.mesh {
        Some(file) if actor.own_bones => {
            let mut body = Body::from_gltf(file, &adult, Some(actor.height), &BTreeMap::new())?;
            body.mesh = None;
            for side in ["left", "right"] {
                set_clavicle(&mut body, &adult, side);
            }
            body
        }
        _ => adult,
    };
    if !actor.proportions.is_empty() {
        body = Proportions::named(&actor.proportions)?.apply(&body);
        // Longer legs make nobody taller than he says.
        let bones = body.world_from_bones(&body.standing_pose())?;
        let joints = body.joint_names().into_iter().zip(body.joint_positions(&bones));
        let top = joints.filter(|(name, _)| name == "head_top").map(|(_, at)| at.z).fold(0.0, f64::max);
        if top > 0.0 {
            body = body.scaled(actor.height / top)?;
        }
    }
    Ok(body)
}

/// Puts a clavicle where the adult has it between neck and shoulder, which stays. Rigs have a joint of that name anywhere, and
/// joints of one name are to be one place.
fn set_clavicle(body: &mut Body, adult: &Body, side: &str) {
    let names = [format!("{side}_clavicle"), format!("{side}_shoulder")];
    let ([Some(clavicle), Some(shoulder)], [Some(usual), Some(below)]) =
        (names.each_ref().map(|name| body.bone_index(name)), names.each_ref().map(|name| adult.bone_index(name)))
    else {
        return;
    };
    let there = body.bones[clavicle].offset + body.bones[shoulder].offset;
    let (usual, whole) = (adult.bones[usual].offset, adult.bones[usual].offset + adult.bones[below].offset);
    let share = |there: f64, usual: f64, whole: f64| if whole.abs() > 1.0 { there * usual / whole } else { usual };
    body.bones[clavicle].offset = DVec3::new(
        share(there.x, usual.x, whole.x),
        share(there.y, usual.y, whole.y),
        share(there.z, usual.z, whole.z),
    );
    body.bones[shoulder].offset = there - body.bones[clavicle].offset;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn proportions_change_limbs_and_not_the_stature() {
        let proportions = [("thigh", 1.1), ("belly girth", 1.2)].map(|(name, factor)| (name.to_string(), factor));
        let actor = ActorSettings { proportions: BTreeMap::from(proportions), ..ActorSettings::default() };
        let (usual, body) = (body_of(&ActorSettings::default()).unwrap(), body_of(&actor).unwrap());
        let bone = |body: &Body, name: &str| body.bones[body.bone_index(name).unwrap()].offset.length();
        let ratio = |name: &str| bone(&body, name) / bone(&usual, name);
        assert!((ratio("left_knee") / ratio("left_elbow") - 1.1).abs() < 1e-9);
        let bones = body.world_from_bones(&body.standing_pose()).unwrap();
        let top = body.joint_positions(&bones).into_iter().map(|at| at.z).fold(0.0, f64::max);
        assert!((top - 1750.0).abs() < 1.0, "{top}");
        let build = Build::of(&actor).unwrap();
        assert!(build.widening("pelvis").x > 1.2 && build.widening("left_knee") == DVec3::ONE);
        let unknown =
            ActorSettings { proportions: BTreeMap::from([("thihg".into(), 1.0)]), ..ActorSettings::default() };
        let error = body_of(&unknown).unwrap_err().to_string();
        assert!(error.contains("thihg") && error.contains("nearest is `thigh`"), "{error}");
    }
}

//! The shape of a person: proportions, and how far the flesh lies off the bones.

use glam::DVec3;

use crate::body::{Body, Proportion, Proportions, without_side};

/// An offset of flesh from its bone, or of a joint from the spine.
struct Offset {
    /// The parts it moves an end of, without their sides, and whether that is the far end, `b`.
    ends: &'static [(&'static str, bool)],
    /// The bones whose joints it moves, without their sides.
    joints: &'static [&'static str],
    towards: Towards,
    /// Standard deviation, mm.
    deviation: f64,
}

/// Which way an offset goes at rest.
#[derive(Clone, Copy, Debug)]
enum Towards {
    Front,
    /// Away from the other side.
    Outside,
    Top,
}

impl Towards {
    fn direction(self, is_right: bool) -> DVec3 {
        match self {
            Self::Front => DVec3::X,
            Self::Outside if is_right => DVec3::NEG_Y,
            Self::Outside => DVec3::Y,
            Self::Top => DVec3::Z,
        }
    }
}

const fn forwards(ends: &'static [(&'static str, bool)], joints: &'static [&'static str]) -> Offset {
    Offset { ends, joints, towards: Towards::Front, deviation: 20.0 }
}

/// All of the trunk, with arms and head.
const TRUNK: &[(&str, bool)] =
    &[("belly", false), ("belly", true), ("chest", false), ("chest", true), ("neck", false), ("neck", true)];

const OFFSETS: [Offset; Shape::OFFSETS] = [
    // How far the spine is from the middle of the trunk, where bodies differ most; what else lies before it is moved by itself besides.
    Offset { deviation: 45.0, ..forwards(TRUNK, &["shoulder", "head"]) },
    forwards(&[("belly", true), ("chest", false)], &[]),
    forwards(&[("chest", true), ("neck", false)], &[]),
    forwards(&[], &["shoulder"]),
    forwards(&[("neck", true)], &["head"]),
    forwards(&[("head", false), ("head", true)], &[]),
    forwards(&[("upper_arm", true), ("forearm", false)], &[]),
    forwards(&[("thigh", false)], &[]),
    forwards(&[("thigh", true)], &[]),
    forwards(&[("calf", false)], &[]),
    Offset { towards: Towards::Outside, ..forwards(&[("thigh", false)], &[]) },
    // The muscle over the shoulder's joint, which else is drawn up to the skin (METHOD A3).
    Offset { towards: Towards::Top, deviation: 40.0, ..forwards(&[("upper_arm", false)], &[]) },
];

/// How far an offset may go, mm.
const FARTHEST: f64 = 60.0;

/// Deviations of the proportions of a body that was measured, as a share of those among people: a straight limb tells its length, and not so
/// well where its joint is; silhouettes tell widths.
const LIMBS: f64 = 0.5;
const OTHERS: f64 = 0.25;
/// Of thighs and calves: cones come nearer to clothed hips by legs that are too long, and trunks too short for it (METHOD A3).
const LEGS: f64 = 0.125;

/// Standard deviation of a proportion of a body that was measured, as a fraction.
fn doubt(known: &Proportion) -> f64 {
    let share = match known.name {
        "hip width" | "upper arm" | "forearm" => LIMBS,
        "thigh" | "calf" => LEGS,
        _ => OTHERS,
    };
    known.deviation * share
}

/// Proportions and offsets of a person.
#[derive(Clone, Debug, Default)]
pub(super) struct Shape {
    proportions: Proportions,
    /// mm.
    offsets: [f64; Self::OFFSETS],
}

impl Shape {
    const OFFSETS: usize = 12;
    /// Values of a row.
    pub(super) const COUNT: usize = Proportions::COUNT + Self::OFFSETS;

    pub(super) fn from_row(row: &[f32]) -> Self {
        let mut shape = Self { proportions: proportions(row), ..Self::default() };
        shape.offsets.iter_mut().zip(&row[Proportions::COUNT..]).for_each(|(value, given)| *value = f64::from(*given));
        shape
    }

    pub(super) fn row(&self) -> Vec<f32> {
        self.proportions.0.iter().chain(&self.offsets).map(|value| *value as f32).collect()
    }

    /// Lowest values, highest ones, deviations from a body that was measured.
    pub(super) fn ranges() -> [Vec<f32>; 3] {
        let of = |value: fn(&Proportion) -> f64, offset: fn(&Offset) -> f64| -> Vec<f32> {
            Proportions::ALL.iter().map(value).chain(OFFSETS.iter().map(offset)).map(|value| value as f32).collect()
        };
        [
            of(|known| known.limits[0], |_| -FARTHEST),
            of(|known| known.limits[1], |_| FARTHEST),
            of(doubt, |offset| offset.deviation),
        ]
    }

    /// Sum of squares of the deviations it is off by.
    pub(super) fn oddness(&self) -> f64 {
        let factors = self.proportions.0.iter().zip(&Proportions::ALL);
        let offsets = self.offsets.iter().zip(&OFFSETS);
        let off = factors
            .map(|(factor, known)| (factor - 1.0) / doubt(known))
            .chain(offsets.map(|(value, offset)| value / offset.deviation));
        off.map(|off| off * off).sum()
    }

    pub(super) fn apply(&self, body: &Body) -> Body {
        let mut result = self.proportions.apply(body);
        let moves = |side: &str| {
            let is_right = side.starts_with("right_");
            OFFSETS
                .iter()
                .zip(self.offsets)
                .map(move |(offset, value)| (offset, value * offset.towards.direction(is_right)))
        };
        for part in &mut result.parts {
            for (offset, by) in moves(&part.name) {
                for (_, is_far) in offset.ends.iter().filter(|(name, _)| *name == without_side(&part.name)) {
                    *(if *is_far { &mut part.b } else { &mut part.a }) += by;
                }
            }
        }
        for bone in &mut result.bones {
            for (_, by) in moves(&bone.name).filter(|(offset, _)| offset.joints.contains(&without_side(&bone.name))) {
                bone.offset += by;
            }
        }
        result
    }
}

/// Proportions from a row of a search.
pub(super) fn proportions(factors: &[f32]) -> Proportions {
    let mut proportions = Proportions::default();
    for (factor, value) in proportions.0.iter_mut().zip(factors) {
        *factor = f64::from(*value);
    }
    proportions
}

/// Sum of the squares of the deviations that proportions are off the tables by.
pub(super) fn oddness(proportions: &Proportions) -> f64 {
    let off = proportions.0.iter().zip(&Proportions::ALL).map(|(factor, known)| (factor - 1.0) / known.deviation);
    off.map(|off| off * off).sum()
}

//! The shape of a person: proportions, and how far the flesh lies off the bones.

use glam::DVec3;

use crate::body::{Body, Proportion, Proportions, without_side};

/// An offset of flesh from its bone.
struct Offset {
    /// The parts it moves an end of, without their sides, and whether that is the far end, `b`.
    ends: &'static [(&'static str, bool)],
    /// Away from the other side, not forwards.
    is_outward: bool,
}

const OFFSETS: [Offset; Shape::OFFSETS] = [
    Offset { ends: &[("belly", false)], is_outward: false },
    Offset { ends: &[("belly", true), ("chest", false)], is_outward: false },
    Offset { ends: &[("chest", true), ("neck", false)], is_outward: false },
    Offset { ends: &[("neck", true), ("head", false), ("head", true)], is_outward: false },
    Offset { ends: &[("upper_arm", false)], is_outward: false },
    Offset { ends: &[("upper_arm", true), ("forearm", false)], is_outward: false },
    Offset { ends: &[("thigh", false)], is_outward: false },
    Offset { ends: &[("thigh", true)], is_outward: false },
    Offset { ends: &[("calf", false)], is_outward: false },
    Offset { ends: &[("thigh", false)], is_outward: true },
    Offset { ends: &[("upper_arm", false)], is_outward: true },
];

/// Deviation of an offset, and how far it may go, mm.
const DEVIATION: f64 = 20.0;
const FARTHEST: f64 = 60.0;

/// Proportions and offsets of a person.
#[derive(Clone, Debug, Default)]
pub(super) struct Shape {
    proportions: Proportions,
    /// mm.
    offsets: [f64; Self::OFFSETS],
}

impl Shape {
    const OFFSETS: usize = 11;
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

    /// Lowest values, highest ones, deviations.
    pub(super) fn ranges() -> [Vec<f32>; 3] {
        let off = |value: f64| [value as f32; Self::OFFSETS];
        let of = |value: fn(&Proportion) -> f64, offset: f64| -> Vec<f32> {
            Proportions::ALL.iter().map(|known| value(known) as f32).chain(off(offset)).collect()
        };
        [
            of(|known| known.limits[0], -FARTHEST),
            of(|known| known.limits[1], FARTHEST),
            of(|known| known.deviation, DEVIATION),
        ]
    }

    /// Sum of squares of the deviations it is off by.
    pub(super) fn oddness(&self) -> f64 {
        let offsets = self.offsets.iter().map(|offset| offset / DEVIATION);
        deviations(&self.proportions).chain(offsets).map(|off| off * off).sum()
    }

    pub(super) fn apply(&self, body: &Body) -> Body {
        let mut result = self.proportions.apply(body);
        for part in &mut result.parts {
            let outward = if part.name.starts_with("right_") { DVec3::NEG_Y } else { DVec3::Y };
            for (offset, value) in OFFSETS.iter().zip(self.offsets) {
                let by = value * if offset.is_outward { outward } else { DVec3::X };
                for (_, is_far) in offset.ends.iter().filter(|(name, _)| *name == without_side(&part.name)) {
                    *(if *is_far { &mut part.b } else { &mut part.a }) += by;
                }
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

/// How many of their deviations each of the proportions is off the tables.
fn deviations(proportions: &Proportions) -> impl Iterator<Item = f64> {
    proportions.0.iter().zip(&Proportions::ALL).map(|(factor, known)| (factor - 1.0) / known.deviation)
}

/// The sum of the squares of [`deviations`].
pub(super) fn oddness(proportions: &Proportions) -> f64 {
    deviations(proportions).map(|off| off * off).sum()
}

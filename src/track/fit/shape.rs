//! The shape of a person: proportions, and how far the flesh lies off the bones.

use glam::DVec3;

use crate::body::{Body, Proportions};

/// Which ends of which parts an offset moves, and along which axis of the bone (0 forward, 1 outward).
struct Offset {
    ends: &'static [(&'static str, bool)],
    axis: usize,
}

const OFFSETS: [Offset; Shape::OFFSETS] = [
    Offset { ends: &[("belly", false)], axis: 0 },
    Offset { ends: &[("belly", true), ("chest", false)], axis: 0 },
    Offset { ends: &[("chest", true), ("neck", false)], axis: 0 },
    Offset { ends: &[("neck", true), ("head", false), ("head", true)], axis: 0 },
    Offset { ends: &[("upper_arm", false)], axis: 0 },
    Offset { ends: &[("upper_arm", true), ("forearm", false)], axis: 0 },
    Offset { ends: &[("thigh", false)], axis: 0 },
    Offset { ends: &[("thigh", true)], axis: 0 },
    Offset { ends: &[("calf", false)], axis: 0 },
    Offset { ends: &[("thigh", false)], axis: 1 },
    Offset { ends: &[("upper_arm", false)], axis: 1 },
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
        let mut shape = Self::default();
        let values = shape.proportions.0.iter_mut().chain(&mut shape.offsets);
        values.zip(row).for_each(|(value, given)| *value = f64::from(*given));
        shape
    }

    pub(super) fn row(&self) -> Vec<f32> {
        self.proportions.0.iter().chain(&self.offsets).map(|value| *value as f32).collect()
    }

    /// Lowest values, highest ones, deviations.
    pub(super) fn ranges() -> [Vec<f32>; 3] {
        let off = |value: f64| [value as f32; Self::OFFSETS];
        let of = |value: fn(&crate::body::Proportion) -> f64, offset: f64| -> Vec<f32> {
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
        let off =
            self.proportions.0.iter().zip(&Proportions::ALL).map(|(factor, known)| (factor - 1.0) / known.deviation);
        off.chain(self.offsets.iter().map(|offset| offset / DEVIATION)).map(|off| off * off).sum()
    }

    pub(super) fn apply(&self, body: &Body) -> Body {
        let mut result = self.proportions.apply(body);
        for part in &mut result.parts {
            let (plain, side) = match (part.name.strip_prefix("left_"), part.name.strip_prefix("right_")) {
                (Some(plain), _) => (plain, 1.0),
                (_, Some(plain)) => (plain, -1.0),
                _ => (part.name.as_str(), 1.0),
            };
            for (offset, value) in OFFSETS.iter().zip(self.offsets) {
                for (name, is_far) in offset.ends {
                    if *name == plain {
                        let by = if offset.axis == 0 { DVec3::X * value } else { DVec3::Y * (value * side) };
                        *(if *is_far { &mut part.b } else { &mut part.a }) += by;
                    }
                }
            }
        }
        result
    }
}

//! Where a frame's search starts, from the poses before.

use anyhow::{Result, bail};

use crate::search::SearchSpace;

/// How the pose of a frame is predicted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Prediction {
    /// It is the pose before.
    #[default]
    None,
    /// It goes on from the pose before as that came from the one before it: constant velocity of every degree of freedom,
    /// within the limits.
    Velocity,
}

impl Prediction {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::None, Self::Velocity];

    /// The name as `--predict` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Velocity => "velocity",
        }
    }

    /// The prediction of that name.
    ///
    /// # Errors
    /// When there is none: the sentence names them.
    pub fn from_name(name: &str) -> Result<Self> {
        match Self::ALL.into_iter().find(|known| known.name() == name) {
            Some(known) => Ok(known),
            None => bail!("there is no prediction {name:?}, expected one of {}", Self::ALL.map(Self::name).join(", ")),
        }
    }

    /// The start of the search after `last`, before which came `earlier` where that is known.
    pub(super) fn start(self, space: &SearchSpace, last: &[f32], earlier: Option<&[f32]>) -> Vec<f32> {
        let mut start = last.to_vec();
        if let (Self::Velocity, Some(earlier)) = (self, earlier) {
            for (value, earlier) in start.iter_mut().zip(earlier) {
                *value += *value - earlier;
            }
            space.clamp(&mut start);
        }
        start
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocity_goes_on_within_the_limits() {
        let space = SearchSpace::new(vec![-1.0; 2], vec![1.0; 2], vec![0.1; 2]).unwrap();
        let (last, earlier) = ([0.5, 0.9], [0.25, 0.5]);
        assert_eq!(Prediction::Velocity.start(&space, &last, Some(&earlier)), [0.75, 1.0]);
        assert_eq!(Prediction::Velocity.start(&space, &last, None), last);
        assert_eq!(Prediction::None.start(&space, &last, Some(&earlier)), last);
        let error = Prediction::from_name("linear").unwrap_err().to_string();
        assert_eq!(error, "there is no prediction \"linear\", expected one of none, velocity");
    }
}

//! Where a frame's search starts, from the poses before.

use crate::files::choices;
use crate::search::SearchSpace;

choices! {
    /// How the pose of a frame is predicted.
    "prediction" pub enum Prediction {
        /// It is the pose before.
        "none" None,
        /// It goes on from the pose before as that came from the one before it: constant velocity of every degree of freedom,
        /// within the limits.
        "velocity" Velocity,
        /// It goes on as velocity, by the share of a velocity that has gone on so far, learnt for every degree of freedom.
        "learnt" Learnt,
    }
}

impl Prediction {
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
        assert_eq!(error, "unknown prediction `linear`, the nearest is `none` (known: none, velocity, learnt)");
    }
}

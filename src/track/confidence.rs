//! How far a frame's pose can be trusted.

use super::FrameResult;
use crate::body::Body;

/// Spread of the root's position at which the confidence in it is halved, mm: about a limb's thickness.
const HALF_TRUST: f64 = 100.0;

/// The confidence of one frame after the other.
///
/// A frame's confidence is the product of three factors, each in [0, 1]:
/// - its fitness over the best fitness of the track so far (a track that is being lost scores less than it did);
/// - the square root of the worst view's f1 over the mean f1 of all views (a pose that is wrong in depth fits some views
///   and not others);
/// - 1 / (1 + (s / 100 mm)^2), where s is the standard deviation of the candidates' root position (a swarm that has not
///   settled has not decided).
#[derive(Clone, Debug)]
pub struct Confidence {
    best_fitness: f64,
    root: Vec<usize>,
    angles: Vec<usize>,
}

/// The confidence of a frame and the spreads it shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameConfidence {
    /// Root mean square over the root's translations of the candidates' standard deviation, mm.
    pub position_spread: f64,
    /// Root mean square over all rotations of the candidates' standard deviation, degrees.
    pub angle_spread: f64,
    /// In [0, 1].
    pub confidence: f64,
}

impl Confidence {
    /// For a body; before the first frame.
    pub fn new(body: &Body) -> Self {
        let chosen = |choose: &dyn Fn(usize, bool) -> bool| {
            let dofs = body.dofs().enumerate();
            dofs.filter(|(_, (bone, dof))| choose(*bone, dof.axis.is_rotation())).map(|(index, _)| index).collect()
        };
        Self {
            best_fitness: 0.0,
            root: chosen(&|bone, is_rotation| !is_rotation && body.bones[bone].parent.is_none()),
            angles: chosen(&|_, is_rotation| is_rotation),
        }
    }

    /// The next frame's.
    pub fn next(&mut self, result: &FrameResult) -> FrameConfidence {
        let fitness = f64::from(result.fitness).clamp(0.0, 1.0);
        self.best_fitness = self.best_fitness.max(fitness);
        let relative = if self.best_fitness > 0.0 { fitness / self.best_fitness } else { 0.0 };
        let f1 = || result.views.iter().map(|view| f64::from(view[0]));
        let mean = f1().sum::<f64>() / result.views.len().max(1) as f64;
        let balance = if mean > 0.0 { (f1().fold(f64::INFINITY, f64::min) / mean).clamp(0.0, 1.0).sqrt() } else { 0.0 };
        let position_spread = root_mean_square(&result.spread, &self.root);
        let settled = 1.0 / (1.0 + (position_spread / HALF_TRUST).powi(2));
        FrameConfidence {
            position_spread,
            angle_spread: root_mean_square(&result.spread, &self.angles).to_degrees(),
            confidence: relative * balance * settled,
        }
    }
}

fn root_mean_square(values: &[f32], chosen: &[usize]) -> f64 {
    if chosen.is_empty() {
        return 0.0;
    }
    let squares = chosen.iter().filter_map(|&index| values.get(index)).map(|value| f64::from(*value).powi(2));
    (squares.sum::<f64>() / chosen.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn result(fitness: f32, views: &[f32], spread: f32) -> FrameResult {
        FrameResult {
            frame: 0,
            pose: vec![0.0; 31],
            fitness,
            spread: vec![spread; 31],
            views: views.iter().map(|f1| [*f1, 0.5]).collect(),
        }
    }

    #[test]
    fn each_factor_lowers_it() {
        let body = Body::adult(1750.0).unwrap();
        let mut confidence = Confidence::new(&body);
        assert_eq!(confidence.next(&result(0.8, &[0.9, 0.9], 0.0)).confidence, 1.0);
        assert!((confidence.next(&result(0.4, &[0.9, 0.9], 0.0)).confidence - 0.5).abs() < 1e-6);
        let uneven = confidence.next(&result(0.8, &[0.9, 0.1], 0.0)).confidence;
        assert!((uneven - 0.2_f64.sqrt()).abs() < 1e-6, "{uneven}");
        let unsettled = confidence.next(&result(0.8, &[0.9, 0.9], 100.0));
        assert!((unsettled.confidence - 0.5).abs() < 1e-6 && (unsettled.position_spread - 100.0).abs() < 1e-9);
        assert!((unsettled.angle_spread - 100.0_f64.to_degrees()).abs() < 1e-6);
    }

    #[test]
    fn nothing_seen_is_no_confidence() {
        let mut confidence = Confidence::new(&Body::adult(1750.0).unwrap());
        for result in [result(0.0, &[0.0, 0.0], 0.0), result(0.0, &[], 0.0), result(f32::NAN, &[0.1], 1.0)] {
            assert_eq!(confidence.next(&result).confidence, 0.0);
        }
    }
}

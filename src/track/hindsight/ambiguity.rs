//! How far from where its joints were settled the other poses of a frame lie that were found and are worth about as much: what the pictures leave
//! open, as far as another pose was come upon (METHOD A13).

use super::refining::Settled;
use super::scorer::{Candidate, most_worth};

/// By how much less a pose is worth by itself that is e times less likely, and the path through it: front and back look alike in a single frame,
/// and neighbours say which it is.
const LIKELY: f64 = 2.0;
const LED: f64 = 64.0;
/// By how much less the poses of a frame are worth than those of another where hardly anybody is seen in it, which tells nothing of that other.
const NOBODY: f64 = 100.0;

/// The ambiguity of each joint in each frame, mm: of all candidates of the frame and of those up to `reach` around it, as likely as they and the
/// paths through them are worth, the root mean square of how far the joint lies from where it was settled.
pub(super) fn ambiguities(
    settled: &[Settled],
    candidates: &[Vec<Candidate>],
    losses: &[Vec<f64>],
    reach: usize,
) -> Vec<Vec<f32>> {
    let frames = settled.iter().zip(candidates).zip(losses);
    let own: Vec<Vec<f64>> = frames.map(|((frame, found), losses)| mean_squares(frame, found, losses)).collect();
    let worth: Vec<f64> = candidates.iter().map(most_worth).collect();
    let around = |t: usize| {
        let near = t.saturating_sub(reach)..(t + reach + 1).min(own.len());
        let near: Vec<&Vec<f64>> = near.filter(|&at| worth[at] >= worth[t] - NOBODY).map(|at| &own[at]).collect();
        let mean = |joint: usize| near.iter().map(|frame| frame[joint]).sum::<f64>() / near.len() as f64;
        (0..own[t].len()).map(|joint| mean(joint).sqrt() as f32).collect()
    };
    (0..own.len()).map(around).collect()
}

/// The mean square of how far each joint of a frame's candidates lies from where it was settled, mm^2.
fn mean_squares(settled: &Settled, candidates: &[Candidate], losses: &[f64]) -> Vec<f64> {
    let said = |(candidate, loss): (&Candidate, &f64)| candidate.worth / LIKELY - loss / LED;
    let most = candidates.iter().zip(losses).map(said).fold(f64::NEG_INFINITY, f64::max);
    let mut sums = vec![0.0; settled.points.len()];
    let mut all = 0.0;
    for (candidate, loss) in candidates.iter().zip(losses) {
        let likely = (said((candidate, loss)) - most).exp();
        let pairs = candidate.points.iter().zip(&settled.points);
        sums.iter_mut().zip(pairs).for_each(|(sum, (a, b))| *sum += likely * a.distance_squared(*b));
        all += likely;
    }
    sums.into_iter().map(|sum| if all > 0.0 { sum / all } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// A pose far away counts by what it is worth, in its own frame and in those around it, for the joints that it has elsewhere.
    #[test]
    fn another_pose_counts_as_it_is_worth() {
        let at = |x: f64| vec![DVec3::new(x, 0.0, 0.0), DVec3::new(0.0, 50.0, 0.0)];
        let candidate = |x: f64, worth: f64| Candidate {
            pose: Vec::new(),
            points: at(x),
            worth,
            is_looked_at: false,
            is_looked_into: false,
        };
        let settled: Vec<Settled> = (0..5).map(|frame| Settled { frame, pose: Vec::new(), points: at(0.0) }).collect();
        let led = |other: Candidate, loss: f64| {
            let mut losses = vec![vec![0.0]; 5];
            losses[1].push(loss);
            let mut candidates = vec![vec![candidate(0.0, -30.0)]; 5];
            candidates[1].push(other);
            ambiguities(&settled, &candidates, &losses, 1)
        };
        let with = |other: Candidate| led(other, 0.0);
        let joint = |found: &[Vec<f32>]| -> Vec<f32> { found.iter().map(|frame| frame[0]).collect() };
        // As likely: half of the square in frame 1, shared with its neighbours; frame 0 has one neighbour.
        let equal = with(candidate(200.0, -30.0));
        let [two, three] = [2.0, 3.0].map(|frames: f32| (20_000.0 / frames).sqrt());
        for (found, expected) in joint(&equal).into_iter().zip([two, three, three, 0.0, 0.0]) {
            assert!((found - expected).abs() < 1e-3, "{equal:?}");
        }
        assert!(equal.iter().all(|frame| frame[1] == 0.0), "the other joint is where it was: {equal:?}");
        // The more it is worth the more it counts, up to all of it where what was settled is worth much less.
        let counted = [-60.0, -34.0, -30.0, -26.0, 0.0].map(|worth| joint(&with(candidate(200.0, worth)))[1]);
        assert!(counted.is_sorted() && counted[0] < 1.0, "{counted:?}");
        assert!((counted[4] - (40_000.0_f32 / 3.0).sqrt()).abs() < 0.1, "{counted:?}");
        let share = |counted: f32| counted * counted * 3.0 / 40_000.0;
        assert!((share(counted[1]) - 1.0 / (1.0 + 2.0_f32.exp())).abs() < 1e-3, "{counted:?}");
        // Neighbours speak against it, more softly.
        let spoken = joint(&led(candidate(200.0, -30.0), 128.0))[1];
        assert!((share(spoken) - 1.0 / (1.0 + 2.0_f32.exp())).abs() < 1e-3, "{spoken}");
        // Where nobody is seen any more, poses lie anywhere; that is no doubt of who was there the frame before.
        let mut candidates = vec![vec![candidate(0.0, -30.0)]; 5];
        candidates[3] = [0.0, 900.0].map(|x| candidate(x, -2000.0)).to_vec();
        let mut losses = vec![vec![0.0]; 5];
        losses[3] = vec![0.0; 2];
        let gone = joint(&ambiguities(&settled, &candidates, &losses, 1));
        assert!(gone[3] > 300.0 && gone[2] == 0.0 && gone[4] == 0.0, "{gone:?}");
    }
}

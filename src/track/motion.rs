//! How a person moves, learnt from the frames before: how far each joint is found from where its search began, and how much of a
//! change goes on in the next frame (METHOD A8).

use super::FrameResult;
use crate::files::choices;

choices! {
    /// How wide a frame's search starts.
    "width" pub enum Width {
        /// The body's steps.
        "steps" Steps,
        /// The body's steps, each times a factor that is learnt from how far its joint was found from where the search began.
        "learnt" Learnt,
    }
}

/// Frames that the mean square of the innovation remembers. Few: a person who starts to run must be followed at once.
const MEMORY: f64 = 8.0;
/// Frames that the share of a change that goes on remembers.
const LONG_MEMORY: f64 = 15.0;
/// Square of the innovation, steps, that is taken for granted before the first frames, and at least after a loss: about the width of the
/// body's steps, with which an arm that begins in the wrong place is found.
const UNSURE: f64 = 2.0;
/// Width of a search, in innovations. What was found is a little off itself, so innovations are larger than the motion.
const WIDTH: f64 = 0.7;
/// Share of a degree of freedom's width that comes from all of them together: what one does not show, others do.
const SHARED: f64 = 0.5;
/// Least and greatest factor on a step. Below the least a search cannot notice that it lags; the greatest is for quick dances, which
/// move by three of the body's steps.
const FACTORS: [f64; 2] = [0.25, 3.0];
/// Share of the newest change in the velocity.
const NEWEST: f64 = 0.7;
/// Square of the velocity, steps, from which on a change is believed to be one: slower ones are mostly jitter of the estimates, which
/// would feed itself if it were extrapolated, above all where nothing in the pictures holds a joint.
const JITTER: f64 = 1.0;

/// What is learnt of a track. Everything is in units of the body's steps, scaled to the time between frames.
pub(super) struct LearntMotion {
    /// Whether searches begin where the motion leads.
    predicts: bool,
    /// The step of each degree of freedom from a frame to the next: mm, radians.
    steps: Vec<f32>,
    /// The frame before, and its pose.
    last: Option<(usize, Vec<f32>)>,
    habits: Vec<Habit>,
}

/// What is learnt of a degree of freedom.
#[derive(Clone, Copy)]
struct Habit {
    /// Mean square of the distance between where a frame's search began and what it found.
    innovation: f64,
    /// Change a frame, smoothed; none while nothing is known.
    velocity: Option<f64>,
    /// Mean of the velocity's square, and of its product with the change that followed.
    energy: f64,
    kept: f64,
}

impl Habit {
    const NEW: Self = Self { innovation: UNSURE, velocity: None, energy: 0.0, kept: 0.0 };

    /// Change that is expected in the next frame: the velocity times the share that velocities have kept.
    fn expected(&self) -> f64 {
        self.velocity.map_or(0.0, |velocity| (self.kept / (self.energy + JITTER)).clamp(0.0, 1.0) * velocity)
    }

    /// Learns from a change a frame, where `expected` was expected.
    fn learn(&mut self, change: f64, expected: f64) {
        self.innovation += ((change - expected).powi(2) - self.innovation) / MEMORY;
        if let Some(velocity) = self.velocity {
            self.energy += (velocity * velocity - self.energy) / LONG_MEMORY;
            self.kept += (velocity * change - self.kept) / LONG_MEMORY;
        }
        self.velocity = Some(self.velocity.map_or(change, |velocity| velocity + NEWEST * (change - velocity)));
    }
}

impl LearntMotion {
    /// Before the first frame; `steps` are the body's from a frame to the next: mm, radians.
    pub(super) fn new(steps: Vec<f32>, predicts: bool) -> Self {
        Self { predicts, habits: vec![Habit::NEW; steps.len()], steps, last: None }
    }

    /// The frame learnt from last.
    pub(super) fn last_frame(&self) -> Option<usize> {
        self.last.as_ref().map(|(frame, _)| *frame)
    }

    /// Learns from the next frame. One that does not follow the last, or in which the person is lost, only is the place from which
    /// the next one goes on: velocities are forgotten, and widths are about the body's steps at least.
    pub(super) fn note(&mut self, result: &FrameResult, follows: bool) {
        let Some((before, last)) = self.last.replace((result.frame, result.pose.clone())) else { return };
        let age = result.frame.saturating_sub(before).max(1) as f64;
        let values = result.pose.iter().zip(&last).zip(&self.steps);
        for (habit, ((now, last), step)) in self.habits.iter_mut().zip(values) {
            if !follows {
                habit.velocity = None;
                habit.innovation = habit.innovation.max(UNSURE);
                continue;
            }
            let step = f64::from(*step) * age;
            let change = if step > 0.0 { (f64::from(*now) - f64::from(*last)) / step } else { 0.0 };
            habit.learn(change, if self.predicts { habit.expected() } else { 0.0 });
        }
    }

    /// Where the search `age` frame times after the pose `last` begins; not held within the limits.
    pub(super) fn start(&self, last: &[f32], age: f32) -> Vec<f32> {
        let steps = self.habits.iter().zip(&self.steps).map(|(habit, step)| habit.expected() as f32 * step * age);
        last.iter().zip(steps).map(|(last, step)| last + step).collect()
    }

    /// Factors on the body's steps that the next search starts with.
    pub(super) fn widths(&self) -> Vec<f32> {
        let mean = self.habits.iter().map(|habit| habit.innovation).sum::<f64>() / self.habits.len() as f64;
        let [least, greatest] = FACTORS;
        let width = |habit: &Habit| WIDTH * (habit.innovation + SHARED * (mean - habit.innovation)).sqrt();
        self.habits.iter().map(|habit| width(habit).clamp(least, greatest) as f32).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn result(frame: usize, pose: &[f32]) -> FrameResult {
        let count = pose.len();
        FrameResult {
            frame,
            pose: pose.to_vec(),
            fitness: 1.0,
            spread: vec![0.0; count],
            views: Vec::new(),
            joints: Vec::new(),
        }
    }

    /// After 40 frames of a motion with steps of 10 and 0.1.
    fn learnt(predicts: bool, motion: impl Fn(f32) -> [f32; 2]) -> LearntMotion {
        let mut learnt = LearntMotion::new(vec![10.0, 0.1], predicts);
        for frame in 0..40 {
            let follows = learnt.last_frame().is_some();
            learnt.note(&result(frame, &motion(frame as f32)), follows);
        }
        learnt
    }

    #[test]
    fn widths_follow_the_motion_of_each_joint() {
        let still = learnt(true, |_| [500.0, 1.0]);
        assert_eq!(still.widths(), [0.25; 2]);
        assert_eq!(still.start(&[500.0, 1.0], 1.0), [500.0, 1.0]);
        // One step a frame to and fro, the other joint still: the mean of squares is 1/2, half of which is everybody's.
        let shaking = learnt(true, |at| [if at % 2.0 == 0.0 { 0.0 } else { 10.0 }, 1.0]);
        let widths = shaking.widths();
        assert!((widths[0] - 0.7 * 0.75_f32.sqrt()).abs() < 0.01 && (widths[1] - 0.35).abs() < 0.01, "{widths:?}");
        assert_eq!(shaking.start(&[0.0, 1.0], 1.0), [0.0, 1.0], "what turns round at once does not go on");
        let wild = learnt(true, |at| [if at % 2.0 == 0.0 { 0.0 } else { 1000.0 }, 1.0]);
        assert_eq!(wild.widths()[0], 3.0);
    }

    #[test]
    fn what_goes_on_is_predicted_and_jitter_is_not() {
        // Four steps a frame, and a fifth of a step.
        let even = |at: f32| [40.0 * at, 0.02 * at];
        let found = learnt(true, even);
        let [fast, slow] = [found.start(&even(39.0), 1.0)[0], found.start(&even(39.0), 1.0)[1]];
        assert!((1560.0 + 35.0..1600.0).contains(&fast), "{fast}");
        assert!((0.78..0.782).contains(&slow), "{slow}");
        // Twice the time, twice the way.
        let twice = found.start(&even(39.0), 2.0)[0];
        assert!((twice - 1560.0 - 2.0 * (fast - 1560.0)).abs() < 0.01, "{twice}");
        // What is predicted need not be searched for.
        assert!(found.widths()[0] < 1.0 && learnt(false, even).widths()[0] > 2.0);
    }

    #[test]
    fn frames_left_out_count_as_time_and_a_loss_forgets() {
        let mut learnt = LearntMotion::new(vec![10.0], true);
        for frame in (0..80).step_by(2) {
            let follows = learnt.last_frame().is_some();
            learnt.note(&result(frame, &[20.0 * frame as f32]), follows);
        }
        let start = learnt.start(&[1560.0], 1.0)[0];
        assert!((1570.0..1580.0).contains(&start), "two steps a frame, whatever was left out: {start}");
        assert!(learnt.widths()[0] < 0.5);
        learnt.note(&result(80, &[0.0]), false);
        assert_eq!(learnt.start(&[0.0], 1.0), [0.0]);
        assert!((learnt.widths()[0] - 0.99).abs() < 0.01);
    }
}

//! How many poses a frame may score so that its pose is out in time.

use std::time::{Duration, Instant};

/// Fewest particles while there is more than one iteration to give up.
const LEAST_PARTICLES: usize = 64;
/// Fewest iterations of a frame. With [`LEAST_PARTICLES`] it is the least a frame costs, however late it is.
const LEAST_ITERATIONS: usize = 3;
/// Deviations above the mean that are reckoned with.
const DEVIATIONS: f64 = 3.0;

/// Particles and iterations of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Size {
    pub(super) particles: usize,
    pub(super) iterations: usize,
}

/// A running estimate of a time, s, as TCP keeps of its round trips: a mean that moves by an eighth, a mean deviation that
/// moves by a quarter.
#[derive(Clone, Copy, Debug, Default)]
struct Running {
    mean: f64,
    deviation: f64,
    is_known: bool,
}

impl Running {
    fn learn(&mut self, value: f64) {
        if self.is_known {
            let off = value - self.mean;
            self.mean += off / 8.0;
            self.deviation += (off.abs() - self.deviation) / 4.0;
        } else {
            (self.mean, self.deviation, self.is_known) = (value, value / 2.0, true);
        }
    }

    /// What the next one should not exceed.
    fn bound(&self) -> f64 {
        self.mean + DEVIATIONS * self.deviation
    }
}

/// The budget of a run, by one rule that depends on the times measured alone.
///
/// What is left of the deadline when the search of a frame begins, less the bound on what comes after the search, is divided
/// by the bound on the cost of one evaluation. A frame whose evaluations all fit gets them. Otherwise particles are given up
/// first, in steps of an eighth of those asked for (a swarm loses little by it), down to [`LEAST_PARTICLES`]; then
/// iterations, down to [`LEAST_ITERATIONS`]. The first frame is searched whole, since nothing was measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget {
    asked: Size,
    deadline: Option<Duration>,
    cost: Running,
    after: Running,
}

impl Budget {
    pub(super) fn new(asked: Size, deadline: Option<Duration>) -> Self {
        Self { asked, deadline, cost: Running::default(), after: Running::default() }
    }

    /// The size of a frame's search that begins at `now`, its pictures captured at `captured`.
    pub(super) fn size(&self, captured: Instant, now: Instant) -> Size {
        let (Some(until), true) = (self.until(captured), self.cost.is_known) else { return self.asked };
        let left = until.saturating_duration_since(now).as_secs_f64();
        let evaluations = left / self.cost.bound().max(1e-12);
        let Size { particles, iterations } = self.asked;
        let least = LEAST_PARTICLES.min(particles);
        let affordable = (evaluations / iterations as f64) as usize;
        if affordable >= particles {
            return self.asked;
        }
        let step = (particles / 8).next_multiple_of(16);
        let stepped = affordable / step * step;
        if stepped >= least {
            return Size { particles: stepped, iterations };
        }
        let fewer = (evaluations / least as f64) as usize;
        Size { particles: least, iterations: fewer.clamp(LEAST_ITERATIONS.min(iterations), iterations) }
    }

    /// When the search of a frame has to be done.
    pub(super) fn until(&self, captured: Instant) -> Option<Instant> {
        let search = self.deadline?.saturating_sub(Duration::from_secs_f64(self.after.bound()));
        Some(captured + search)
    }

    /// Takes note of a search.
    pub(super) fn searched(&mut self, evaluations: usize, time: Duration) {
        self.cost.learn(time.as_secs_f64() / evaluations.max(1) as f64);
    }

    /// Takes note of what came after it.
    pub(super) fn delivered(&mut self, time: Duration) {
        self.after.learn(time.as_secs_f64());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASKED: Size = Size { particles: 300, iterations: 15 };

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    /// A budget that has seen a steady 10 µs an evaluation and 1 ms after it.
    fn steady(deadline: u64) -> Budget {
        let mut budget = Budget::new(ASKED, Some(ms(deadline)));
        for _ in 0..200 {
            budget.searched(1000, ms(10));
            budget.delivered(ms(1));
        }
        budget
    }

    #[test]
    fn particles_go_before_iterations() {
        let now = Instant::now();
        let of = |deadline: u64, age: u64| {
            let Size { particles, iterations } = steady(deadline).size(now, now + ms(age));
            [particles, iterations]
        };
        assert_eq!(of(60, 10), [300, 15], "45 ms are enough for 4500");
        assert_eq!(of(46, 10), [192, 15], "35 ms: 3500 evaluations, 233 particles, in steps of 48");
        assert_eq!(of(21, 10), [64, 15], "10 ms: 1000 evaluations, 66 particles");
        assert_eq!(of(19, 10), [64, 12]);
        assert_eq!(of(19, 40), [64, 3], "late whatever is done");
        let unbound = Budget::new(ASKED, None);
        assert_eq!((unbound.size(now, now + ms(900)), unbound.until(now)), (ASKED, None));
        let small = Budget { asked: Size { particles: 20, iterations: 2 }, ..steady(2) };
        assert_eq!(small.size(now, now + ms(5)), Size { particles: 20, iterations: 2 });
    }

    #[test]
    fn times_are_learnt_and_noise_makes_careful() {
        let now = Instant::now();
        let mut budget = Budget::new(ASKED, Some(ms(40)));
        assert_eq!(budget.size(now, now), ASKED, "nothing is known yet");
        budget.searched(4500, ms(90));
        assert!(budget.size(now, now).particles < 150);
        (0..100).for_each(|_| budget.searched(1000, ms(4)));
        assert_eq!(budget.size(now, now), ASKED);
        // The same mean, and half of them twice as long.
        (0..100).for_each(|turn| budget.searched(1000, if turn % 2 == 0 { ms(8) } else { ms(1) }));
        assert!(budget.size(now, now).particles < 300);
        let Some(until) = budget.until(now) else { panic!("there is a deadline") };
        assert_eq!(until, now + ms(40));
    }
}

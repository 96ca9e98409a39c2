//! Rounds of several things to measure, interleaved.

use std::time::{Duration, Instant};

use anyhow::Result;

use crate::evaluate::{Evaluator, Objective};

/// Rounds that passes are measured in.
const PASS_ROUNDS: usize = 5;

/// One round of a thing to measure.
pub type Round<'a> = Box<dyn FnMut() -> Result<()> + 'a>;

/// The times of a thing's rounds, milliseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// Half the rounds took longer.
    pub median: f64,
    /// The shortest.
    pub min: f64,
    /// The longest.
    pub max: f64,
}

impl Times {
    pub(super) fn of(mut ms: Vec<f64>) -> Self {
        ms.sort_by(f64::total_cmp);
        let at = |place: usize| ms.get(place).copied().unwrap_or(f64::NAN);
        Self { median: at(ms.len() / 2), min: at(0), max: at(ms.len().saturating_sub(1)) }
    }
}

/// Runs every thing a round, again and again, each until it has run `most` rounds or has spent `share` and run at least
/// three. One that fails is left out from there on, and its error takes the place of its times. The first round of each warms
/// up and is not counted, unless it took longer than `share`: then it is the only one.
pub fn interleaved(things: &mut [Round<'_>], most: usize, share: Duration) -> Vec<Result<Times>> {
    const LEAST: usize = 3;
    let share = share.as_secs_f64() * 1e3;
    let mut told: Vec<Result<Vec<f64>>> = things.iter_mut().map(|run| Ok(vec![timed(run)?])).collect();
    let mut is_left: Vec<bool> = told.iter().map(|ms| ms.as_ref().is_ok_and(|ms| ms[0] <= share)).collect();
    for (ms, _) in told.iter_mut().zip(&is_left).filter(|(_, is_left)| **is_left) {
        *ms = Ok(Vec::new());
    }
    for _ in 0..most {
        if !is_left.contains(&true) {
            break;
        }
        for ((run, told), is_left) in things.iter_mut().zip(&mut told).zip(&mut is_left) {
            let Ok(ms) = told else { continue };
            if !*is_left {
                continue;
            }
            match timed(run) {
                Ok(time) => {
                    ms.push(time);
                    *is_left = ms.len() < LEAST || ms.iter().sum::<f64>() < share;
                }
                Err(error) => (*told, *is_left) = (Err(error), false),
            }
        }
    }
    told.into_iter().map(|ms| ms.map(Times::of)).collect()
}

/// Medians over several runs of times that carry names, in the first run's order: name and milliseconds.
pub fn medians(runs: &[Vec<(String, f64)>]) -> Vec<(String, f64)> {
    let names = runs.iter().take(1).flatten().enumerate();
    names
        .map(|(place, (name, _))| {
            let ms = runs.iter().filter_map(|run| Some(run.get(place)?.1)).collect();
            (name.clone(), Times::of(ms).median)
        })
        .collect()
}

/// Medians of the times of an evaluator's passes by name, from rounds of their own: measuring passes takes time itself. None
/// where it runs none on a device.
///
/// # Errors
/// When an evaluation fails.
pub fn pass_times(
    evaluator: &mut dyn Evaluator,
    poses: &[f32],
    objective: &Objective,
    fitness: &mut [f32],
) -> Result<Vec<(String, f64)>> {
    evaluator.measure_passes(true)?;
    let mut runs: Vec<Vec<(String, f64)>> = Vec::new();
    for _ in 0..PASS_ROUNDS {
        evaluator.fitness(poses, objective, fitness)?;
        let mut sums: Vec<(String, f64)> = Vec::new();
        for pass in evaluator.device_passes() {
            let ms = pass.duration.as_secs_f64() * 1e3;
            match sums.iter_mut().find(|(name, _)| *name == pass.name) {
                Some((_, sum)) => *sum += ms,
                None => sums.push((pass.name, ms)),
            }
        }
        if sums.is_empty() {
            break;
        }
        runs.push(sums);
    }
    evaluator.measure_passes(false)?;
    Ok(medians(&runs))
}

fn timed(run: &mut Round<'_>) -> Result<f64> {
    let start = Instant::now();
    run()?;
    Ok(start.elapsed().as_secs_f64() * 1e3)
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use anyhow::bail;

    use super::*;

    #[test]
    fn rounds_take_turns_and_a_failure_stays_alone() {
        let order = RefCell::new(String::new());
        let mut runs = 0;
        let sleep = |name: char, ms: u64| {
            order.borrow_mut().push(name);
            std::thread::sleep(Duration::from_millis(ms));
            Ok(())
        };
        let mut things: Vec<Round<'_>> = vec![
            Box::new(|| sleep('a', 0)),
            Box::new(|| sleep('b', 8)),
            Box::new(|| sleep('c', 40)),
            Box::new(|| {
                order.borrow_mut().push('d');
                runs += 1;
                if runs == 3 { bail!("it broke") } else { Ok(()) }
            }),
        ];
        let times = interleaved(&mut things, 6, Duration::from_millis(20));
        drop(things);
        // The fast one has all rounds, the slow one stops after three, the slowest after the first, the broken one at once.
        assert_eq!(order.into_inner(), ["abcd", "abd", "abd", "ab", "a", "a", "a"].concat());
        let slow = times[1].as_ref().unwrap();
        assert!(slow.min >= 8.0 && slow.median >= slow.min && slow.max >= slow.median, "{slow:?}");
        assert!(times[2].as_ref().unwrap().median >= 40.0);
        assert_eq!(times[3].as_ref().unwrap_err().to_string(), "it broke");
    }

    #[test]
    fn the_median_is_the_middle() {
        assert_eq!(Times::of(vec![9.0, 1.0, 4.0]), Times { median: 4.0, min: 1.0, max: 9.0 });
    }
}

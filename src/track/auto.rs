//! What `--backend auto` takes: the processor, unless a device was measured to be faster on this very body and cameras.

use std::time::Duration;

use anyhow::{Context, Result, anyhow};

use crate::bench::{Round, interleaved, seen_of};
use crate::body::Body;
use crate::evaluate::device::{device_settings, open_instance};
use crate::evaluate::{Evaluator, Objective};
use crate::features::Observation;
use crate::geometry::Camera;
use crate::gpu::{DeviceKind, Timing, devices};
use crate::search::{DeviceSearch, SearchSettings, SearchSpace};

/// Iterations of the search that is measured: a third of a usual frame's.
const ITERATIONS: usize = 5;
/// Seconds from one frame to the next there.
const INTERVAL: f64 = 0.04;
/// Rounds at most, and the time after which an evaluator has had its share.
const ROUNDS: usize = 30;
const SHARE: Duration = Duration::from_millis(60);
/// A device must be so much faster to be taken, so that two runs on one machine choose alike.
const ADVANTAGE: f64 = 1.1;

/// Whether this machine has a device that may be faster than its processor; if not, why, in a sentence.
pub(super) fn is_device_worth_measuring() -> Result<(), String> {
    let found = open_instance().and_then(|instance| Ok((devices(&instance)?, device_settings()?.index)));
    let (found, index) = found.map_err(|error| format!("{error:#}"))?;
    let usable = found.iter().filter(|device| device.usable && index.is_none_or(|index| index == device.index));
    let Some(best) = usable.min_by_key(|device| device.kind) else {
        let unusable = found.iter().filter(|device| !device.usable);
        let why: Vec<String> = unusable.map(|d| format!("{}: {}", d.name, d.reasons.join("; "))).collect();
        return Err(match index.filter(|&index| index >= found.len()) {
            _ if found.is_empty() => "Vulkan finds no device on this machine".to_string(),
            Some(index) => format!(
                "PANTIN_DEVICE is {index}, and of the Vulkan devices that this machine has the last is {}, counted from 0",
                found.len() - 1
            ),
            None => format!("no Vulkan device that may be taken can be used ({})", why.join("; ")),
        });
    };
    if best.kind == DeviceKind::Cpu {
        return Err(format!("the best Vulkan device, {}, is computed by the processor itself", best.name));
    }
    Ok(())
}

/// A frame's search round a pose, in which this is seen.
struct Task<'a> {
    seen: &'a [Observation],
    settings: SearchSettings,
    space: &'a SearchSpace,
    around: &'a [f32],
    spread: &'a [f32],
}

impl<'a> Task<'a> {
    /// The search as a run does it on this evaluator, where its form for devices is compiled and recorded. What a frame brings along is there
    /// already: a run on a device makes it there.
    fn round(self, evaluator: &'a mut dyn Evaluator) -> Result<Round<'a>> {
        let Self { seen, settings, space, around, spread } = self;
        let objective = Objective::default();
        evaluator.observe(seen)?;
        if let Some(there) = evaluator.on_device().filter(|there| settings.kind.fits(there.device())) {
            let mut search = DeviceSearch::new(there, &objective, &settings, space, Timing::Off)?;
            search.search_frame(0, around, spread)?;
            return Ok(Box::new(move || search.search_frame(0, around, spread).map(drop)));
        }
        let mut search = settings.build(space)?;
        Ok(Box::new(move || {
            let fitness = &mut |poses: &[f32], fitness: &mut [f32]| evaluator.fitness(poses, &objective, fitness);
            search.search_frame(0, around, spread, fitness).map(drop)
        }))
    }
}

/// The evaluator that searches a frame fastest, round a pose, and a sentence with all times. The first is taken unless another is
/// clearly faster; one that fails is not taken.
///
/// # Errors
/// When the first one fails, or there is none.
pub(super) fn fastest(
    mut evaluators: Vec<Box<dyn Evaluator>>,
    body: &Body,
    cameras: &[Camera],
    around: &[f32],
) -> Result<(Box<dyn Evaluator>, String)> {
    let seen = seen_of(body, cameras, around);
    let settings = SearchSettings { iterations: ITERATIONS, ..SearchSettings::default() };
    let space = SearchSpace::of(body)?;
    let spread = space.spread(INTERVAL)?;
    let mut rounds: Vec<Round<'_>> = Vec::new();
    for evaluator in &mut evaluators {
        let task = Task { seen: &seen, settings, space: &space, around, spread: &spread };
        let round = task.round(evaluator.as_mut());
        rounds.push(round.unwrap_or_else(|error| Box::new(move || Err(anyhow!("{error:#}")))));
    }
    let times = interleaved(&mut rounds, ROUNDS, SHARE);
    drop(rounds);
    let names: Vec<[&str; 2]> = evaluators.iter().map(|each| [each.name(), each.variant()]).collect();
    let told: Vec<String> = names
        .iter()
        .zip(&times)
        .map(|([name, variant], times)| match times {
            Ok(times) => format!("{name} ({variant}) {:.2} ms", times.median),
            Err(error) => format!("{name} failed ({error:#})"),
        })
        .collect();
    let mut times = times.into_iter();
    let first = times.next().ok_or_else(|| anyhow!("there is no evaluator to choose"))?;
    let first = first.with_context(|| format!("the evaluator {}", names[0][0]))?.median;
    let chosen = clearly_faster(first, times.map(|times| times.map_or(f64::INFINITY, |times| times.median)));
    let poses = settings.particles * settings.iterations;
    let reason = format!("measured on a search of {poses} poses in {} views: {}", cameras.len(), told.join(", "));
    Ok((evaluators.swap_remove(chosen), reason))
}

/// The place of the fastest of several times, counted from 1; 0, that of the first, unless it is clearly faster.
fn clearly_faster(first: f64, rivals: impl Iterator<Item = f64>) -> usize {
    let fastest = rivals.enumerate().min_by(|l, r| l.1.total_cmp(&r.1));
    fastest.filter(|(_, time)| time * ADVANTAGE < first).map_or(0, |(place, _)| place + 1)
}

#[cfg(test)]
mod tests {
    use anyhow::bail;

    use super::*;
    use crate::bench::Scene;
    use crate::evaluate::Components;
    use crate::features::Observation;

    /// Takes so long, or fails.
    struct Slow(&'static str, Option<u64>);

    impl Evaluator for Slow {
        fn name(&self) -> &'static str {
            self.0
        }
        fn variant(&self) -> &'static str {
            "test"
        }
        fn view_count(&self) -> usize {
            4
        }
        fn dof_count(&self) -> usize {
            31
        }
        fn observe(&mut self, _: &[Observation]) -> Result<()> {
            Ok(())
        }
        fn components(&mut self, _: &[f32], _: &mut [Components]) -> Result<()> {
            Ok(())
        }
        fn fitness(&mut self, _: &[f32], _: &Objective, fitness: &mut [f32]) -> Result<()> {
            let Some(us) = self.1 else { bail!("it is lost") };
            std::thread::sleep(Duration::from_micros(us));
            fitness.fill(0.5);
            Ok(())
        }
    }

    fn chosen(evaluators: &[(&'static str, Option<u64>)]) -> Result<(&'static str, String)> {
        let scene = Scene::new([96, 72], 50.0)?;
        let all: Vec<Box<dyn Evaluator>> =
            evaluators.iter().map(|&(name, us)| Box::new(Slow(name, us)) as Box<dyn Evaluator>).collect();
        let (evaluator, reason) = fastest(all, &scene.body, &scene.cameras, &scene.pose)?;
        Ok((evaluator.name(), reason))
    }

    #[test]
    fn the_fastest_is_taken_and_all_times_are_told() {
        let (name, reason) = chosen(&[("cpu", Some(9000)), ("compute", Some(1000)), ("graphics", None)]).unwrap();
        assert_eq!(name, "compute");
        let start = "measured on a search of 1500 poses in 4 views: cpu (test) ";
        // On a busy machine a sleep takes longer than it was asked to.
        assert!(reason.starts_with(start) && reason.contains(", compute (test) "), "{reason}");
        assert!(reason.ends_with("graphics failed (it is lost)"), "{reason}");
        assert_eq!(chosen(&[("cpu", Some(1000)), ("compute", Some(9000))]).unwrap().0, "cpu");
        let error = format!("{:#}", chosen(&[("cpu", None), ("compute", Some(10))]).unwrap_err());
        assert_eq!(error, "the evaluator cpu: it is lost");
    }

    #[test]
    fn what_is_hardly_faster_is_not_taken() {
        assert_eq!(clearly_faster(10.0, [9.2, f64::INFINITY].into_iter()), 0);
        assert_eq!(clearly_faster(10.0, [9.2, 9.0, f64::INFINITY].into_iter()), 2);
        assert_eq!(clearly_faster(10.0, std::iter::empty()), 0);
    }
}

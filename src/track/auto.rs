//! What `--backend auto` takes: the processor, unless a device was measured to be faster on this very body and cameras.

use std::time::Duration;

use anyhow::{Context, Result, anyhow};

use crate::bench::{Round, interleaved, seen_of, swarm};
use crate::body::Body;
use crate::evaluate::device::{device_settings, open_instance};
use crate::evaluate::{Evaluator, Objective};
use crate::geometry::Camera;
use crate::gpu::{DeviceKind, devices};

/// Poses scored in a round of the measurement: a usual swarm.
const POSES: usize = 256;
/// Rounds at most, and the time after which an evaluator has had its share.
const ROUNDS: usize = 30;
const SHARE: Duration = Duration::from_millis(20);
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

/// The fastest of several evaluators on a swarm round a pose, and a sentence with all times. The first is taken unless another is
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
    let poses = swarm(body, around, POSES);
    let seen = seen_of(body, cameras, around);
    let objective = Objective::default();
    let mut rounds: Vec<Round<'_>> = Vec::new();
    for evaluator in &mut evaluators {
        let mut fitness = vec![0.0; POSES];
        let (poses, seen, objective) = (&poses, &seen, &objective);
        // A frame brings its observations along, so they are part of the time.
        rounds.push(Box::new(move || {
            evaluator.observe(seen)?;
            evaluator.fitness(poses, objective, &mut fitness)
        }));
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
    let reason = format!("measured on {POSES} poses in {} views: {}", cameras.len(), told.join(", "));
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
        fn fitness(&mut self, _: &[f32], _: &Objective, _: &mut [f32]) -> Result<()> {
            let Some(us) = self.1 else { bail!("it is lost") };
            std::thread::sleep(Duration::from_micros(us));
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
        let start = "measured on 256 poses in 4 views: cpu (test) ";
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

//! The measuring.

use std::time::{Duration, Instant};

use anyhow::{Result, ensure};

use super::super::contestants::Contestant;
use super::super::report::machine;
use super::super::rounds::{Times, interleaved};
use super::super::scene::{Scene, swarm};
use super::peaks::{Peaks, measure};
use super::report::{CompiledStage, Invocations, Pass, Profile, ProfileReport, Statistic};
use crate::body::Model;
use crate::evaluate::device::{GraphicsSettings, Packing, device_settings, open_instance};
use crate::evaluate::{Evaluator, Objective};
use crate::gpu::{Device, DevicePass, DeviceSettings, Inspect, Work};

/// Rounds of which the medians are told.
const ROUNDS: usize = 9;
/// Time for the rounds of an iteration as a whole.
const SHARE: Duration = Duration::from_millis(300);

/// Pictures and how tall the person is in them, pixels; candidates of the flat model and of the mesh.
const LARGE: ([u32; 2], f64) = ([640, 480], 280.0);
const SMALL: ([u32; 2], f64) = ([480, 270], 150.0);
const FLAT: usize = 512;
const MESH: usize = 304;

/// Profiles the device that backends work on; `begin` hears what is measured next.
///
/// # Errors
/// When there is no device, it has no timestamps, or the scene cannot be made. What it cannot run is listed instead.
pub fn run(begin: &mut dyn FnMut(&str)) -> Result<ProfileReport> {
    let (instance, settings) = (open_instance()?, device_settings()?);
    let open = |inspect, pipeline_cache| {
        Device::open(&instance, DeviceSettings { inspect, pipeline_cache, ..settings.clone() })
    };
    let device = open(Inspect::Compiled, settings.pipeline_cache.clone())?;
    let counting = open(Inspect::Work, None)?;
    let facts = device.facts();
    ensure!(
        device.capabilities().timestamps,
        "the Vulkan device {} has no timestamps, and a profile is made of them: pantin bench measures without",
        facts.name
    );
    begin("the device's peaks");
    let mut report = ProfileReport {
        machine: machine(),
        device: format!("{}, {}", facts.name, facts.driver),
        peaks: measure(&device, &counting)?,
        profiles: Vec::new(),
        compiled: Vec::new(),
        unavailable: Vec::new(),
    };
    let mesh = Model::ladder().nth(1).unwrap_or(Model::Flat);
    for (model, particles, (size, person)) in
        [(Model::Flat, FLAT, LARGE), (Model::Flat, FLAT, SMALL), (mesh, MESH, LARGE)]
    {
        let scene = Scene::new(size, person)?;
        for contestant in contestants(model, size, &device) {
            let name = format!("{} {}", contestant.backend(), contestant.variant());
            begin(&format!("{name}, {model}, {particles} particles, {}x{}", size[0], size[1]));
            let task = Task { model, particles, scene: &scene, contestant };
            match task.profile(&device, &counting, &report.peaks) {
                Ok(profile) => report.profiles.push(profile),
                Err(error) => report.unavailable.push(format!("{name} ({model}, {}x{}): {error:#}", size[0], size[1])),
            }
        }
    }
    report.compiled = compiled(&device);
    Ok(report)
}

/// Who is profiled: the compute backend and the graphics pipeline; in the large pictures both ways of the first and two packings of
/// the second.
fn contestants(model: Model, size: [u32; 2], device: &Device) -> Vec<Contestant> {
    let subgroup = device.capabilities().subgroup_arithmetic;
    let usual = Contestant::Graphics(GraphicsSettings::default());
    let depth = Contestant::Graphics(GraphicsSettings { packing: Packing::Depth, ..GraphicsSettings::default() });
    if model != Model::Flat {
        vec![Contestant::Compute { subgroup: false }, depth]
    } else if size == LARGE.0 {
        vec![Contestant::Compute { subgroup }, Contestant::Spans, usual, depth]
    } else {
        vec![Contestant::Compute { subgroup }, usual]
    }
}

fn compiled(device: &Device) -> Vec<CompiledStage> {
    let mut all = Vec::new();
    for (pipeline, stages) in device.compiled() {
        all.extend(stages.into_iter().map(|stage| CompiledStage {
            pipeline: pipeline.clone(),
            stage: stage.name,
            subgroup_size: stage.subgroup_size,
            statistics: stage.statistics.into_iter().map(|(name, value)| Statistic { name, value }).collect(),
        }));
    }
    all.sort_by(|l, r| l.pipeline.cmp(&r.pipeline));
    all
}

struct Task<'a> {
    model: Model,
    particles: usize,
    scene: &'a Scene,
    contestant: Contestant,
}

impl Task<'_> {
    fn profile(&self, device: &Device, counting: &Device, peaks: &Peaks) -> Result<Profile> {
        let Self { model, particles, scene, contestant } = *self;
        let mesh = model.mesh(&scene.body)?;
        let build = |device: &Device| contestant.build(scene, mesh.as_ref(), &Ok(device.clone()));
        let poses = swarm(&scene.body, &scene.pose, particles);
        let objective = Objective::default();
        let mut fitness = vec![0.0; particles];
        let mut evaluator = build(device)?;
        // What runs first compiles too, and is no round.
        evaluator.fitness(&poses, &objective, &mut fitness)?;
        let mut rounds: Vec<super::super::Round<'_>> =
            vec![Box::new(|| evaluator.fitness(&poses, &objective, &mut fitness))];
        let times = interleaved(&mut rounds, 200, SHARE).remove(0)?;
        drop(rounds);
        let mut runs = Vec::new();
        for _ in 0..ROUNDS {
            runs.push(Iteration::of(&passes(evaluator.as_mut(), &poses, &objective, &mut fitness)?));
        }
        drop(evaluator);
        let counted = Iteration::of(&passes(build(counting)?.as_mut(), &poses, &objective, &mut fitness)?);
        let all = merged(&runs, &counted, peaks);
        ensure!(!all.is_empty(), "it runs nothing on the device");
        let [width, height] = scene.cameras.first().map_or([0; 2], |camera| camera.size);
        Ok(Profile {
            backend: contestant.backend().to_string(),
            variant: contestant.variant().to_string(),
            model: model.to_string(),
            particles,
            views: scene.cameras.len(),
            width,
            height,
            ms: times.median,
            gaps_ms: all.iter().map(|pass| pass.gap_ms).sum(),
            passes: all,
        })
    }
}

/// The passes of an iteration behind one that is not measured, which compiles and brings everything to the device.
fn passes(
    evaluator: &mut dyn Evaluator,
    poses: &[f32],
    objective: &Objective,
    fitness: &mut [f32],
) -> Result<Vec<DevicePass>> {
    evaluator.measure_passes(true)?;
    evaluator.fitness(poses, objective, fitness)?;
    evaluator.device_passes();
    evaluator.fitness(poses, objective, fitness)?;
    let passes = evaluator.device_passes();
    evaluator.measure_passes(false)?;
    Ok(passes)
}

/// All passes of a name in one iteration.
#[derive(Clone, Debug, PartialEq)]
struct Sum {
    name: String,
    count: usize,
    ms: f64,
    gap_ms: f64,
    start_ms: f64,
    invocations: Option<Invocations>,
    work: Option<Work>,
}

/// One iteration, its passes by name in the order in which they first ran.
struct Iteration(Vec<Sum>);

impl Iteration {
    fn of(passes: &[DevicePass]) -> Self {
        let mut sums: Vec<Sum> = Vec::new();
        let first = passes.first().map(|pass| pass.start);
        let mut end: Option<Instant> = None;
        for pass in passes {
            let since = |from: Option<Instant>| {
                from.map_or(0.0, |from| pass.start.saturating_duration_since(from).as_secs_f64() * 1e3)
            };
            let (gap_ms, start_ms) = (since(end), since(first));
            let ended = pass.start + pass.duration;
            end = Some(end.map_or(ended, |end| end.max(ended)));
            let place = sums.iter().position(|sum| sum.name == pass.name).unwrap_or_else(|| {
                let name = pass.name.clone();
                sums.push(Sum { name, count: 0, ms: 0.0, gap_ms: 0.0, start_ms, invocations: None, work: None });
                sums.len() - 1
            });
            let sum = &mut sums[place];
            sum.count += 1;
            sum.ms += pass.duration.as_secs_f64() * 1e3;
            sum.gap_ms += gap_ms;
            if let Some(own) = pass.statistics {
                let all = sum.invocations.get_or_insert_default();
                all.compute += own.compute;
                all.vertices += own.vertices;
                all.primitives += own.primitives;
                all.fragments += own.fragments;
            }
            if let Some(own) = &pass.work {
                sum.work.get_or_insert_default().add(1, own);
            }
        }
        Self(sums)
    }
}

/// Medians of the iterations' times, with the work of the one that was counted.
fn merged(runs: &[Iteration], counted: &Iteration, peaks: &Peaks) -> Vec<Pass> {
    let Some(last) = runs.last() else { return Vec::new() };
    let median = |name: &str, of: fn(&Sum) -> f64| {
        let all = runs.iter().filter_map(|run| run.0.iter().find(|sum| sum.name == name)).map(of);
        Times::of(all.collect()).median
    };
    let mut passes: Vec<Pass> = last
        .0
        .iter()
        .map(|sum| {
            let ms = median(&sum.name, |sum| sum.ms);
            let work = counted.0.iter().find(|other| other.name == sum.name).and_then(|other| other.work);
            Pass {
                name: sum.name.clone(),
                count: sum.count,
                ms,
                share: 0.0,
                gap_ms: median(&sum.name, |sum| sum.gap_ms),
                start_ms: sum.start_ms,
                invocations: sum.invocations,
                of_peak: work.as_ref().map(|work| peaks.part(work, ms * 1e-3)),
                work,
            }
        })
        .collect();
    let all: f64 = passes.iter().map(|pass| pass.ms).sum();
    passes.iter_mut().for_each(|pass| pass.share = if all > 0.0 { pass.ms / all } else { 0.0 });
    passes
}

#[cfg(test)]
mod tests {
    use crate::gpu::test_device::device;
    use crate::gpu::{Capabilities, PassStatistics};

    use super::*;

    #[test]
    fn small_tasks_are_profiled_whoever_draws() {
        let settings = |inspect| DeviceSettings { inspect, ..DeviceSettings::default() };
        let name = "small_tasks_are_profiled_whoever_draws";
        let Some((timed, log)) = device(name, settings(Inspect::Compiled)) else { return };
        let Some((counting, counting_log)) = device(name, settings(Inspect::Work)) else { return };
        if !timed.capabilities().timestamps {
            return;
        }
        let peaks = Peaks { integer: 1e9, float: 1e9, memory: 1e9, shared: 1e9 };
        let scene = Scene::new([96, 72], 50.0).unwrap();
        let mesh = Model::ladder().nth(1).unwrap();
        for (model, particles) in [(Model::Flat, 6), (mesh, 3)] {
            for contestant in contestants(model, LARGE.0, &timed) {
                if contestant.backend() == "graphics" && !timed.capabilities().graphics {
                    continue;
                }
                let task = Task { model, particles, scene: &scene, contestant };
                let profile = task.profile(&timed, &counting, &peaks).unwrap();
                let of = |name: &str| profile.passes.iter().find(|pass| pass.name == name).unwrap();
                assert_eq!((profile.views, profile.width, profile.height), (4, 96, 72));
                let shares: f64 = profile.passes.iter().map(|pass| pass.share).sum();
                assert!((shares - 1.0).abs() < 1e-9 && profile.ms > 0.0, "{profile:?}");
                // By itself for a mesh, with the projection for the flat model.
                let pose = profile.passes.iter().find(|pass| pass.name.starts_with("pose")).unwrap();
                let work = pose.work.unwrap();
                assert!(work.float > 1000 * particles as u64 && work.memory() > 0, "{pose:?}");
                assert!((pose.of_peak.unwrap().float - work.float as f64 / pose.ms * 1e-6).abs() < 1e-9, "{pose:?}");
                assert!(of("upload poses").work.is_none(), "a copy runs no code");
                if contestant.backend() == "graphics" && timed.capabilities().fragment_stores {
                    let draw = profile.passes.iter().find(|pass| pass.name.starts_with("draw")).unwrap();
                    assert!(draw.work.unwrap().integer > 0, "{draw:?}");
                }
            }
        }
        drop((timed, counting));
        assert_eq!((log.messages(), counting_log.messages()), (Vec::<String>::new(), Vec::new()));
    }

    #[test]
    fn peaks_need_timestamps_and_are_rates() {
        let lower: fn(&mut Capabilities) = |capabilities| capabilities.memory = 64 << 20;
        let settings = |inspect| DeviceSettings { inspect, lower: Some(lower), ..DeviceSettings::default() };
        let name = "peaks_need_timestamps_and_are_rates";
        let Some((timed, _log)) = device(name, settings(Inspect::Nothing)) else { return };
        let Some((counting, _log)) = device(name, settings(Inspect::Work)) else { return };
        match measure(&timed, &counting) {
            // No device does fewer than a million a second, none more than 10^16.
            Ok(Peaks { integer, float, memory, shared }) => {
                assert!([integer, float, memory, shared].iter().all(|rate| (1e6..1e16).contains(rate)));
            }
            Err(error) => {
                assert!(!timed.capabilities().timestamps, "{error:#}");
                assert!(error.to_string().contains("has no timestamps"), "{error:#}");
            }
        }
    }

    #[test]
    fn passes_of_a_name_are_one_and_what_lies_between_is_told() {
        let zero = Instant::now();
        let pass = |name: &str, start: u64, length: u64, float: u64| DevicePass {
            name: name.to_string(),
            start: zero + Duration::from_micros(start),
            duration: Duration::from_micros(length),
            statistics: Some(PassStatistics { compute: 64, ..PassStatistics::default() }),
            work: (float > 0).then(|| Work { float, ..Work::default() }),
        };
        let found = Iteration::of(&[pass("a", 0, 1000, 0), pass("b", 1500, 1000, 0), pass("a", 2500, 2000, 0)]);
        let counted = Iteration::of(&[pass("a", 0, 1, 300), pass("b", 1, 1, 0), pass("a", 2, 1, 300)]);
        let peaks = Peaks { float: 1e6, ..Peaks::default() };
        let [a, b] = &merged(&[found], &counted, &peaks)[..] else { unreachable!() };
        assert_eq!((a.name.as_str(), a.count, b.count), ("a", 2, 1));
        assert!((a.ms - 3.0).abs() < 1e-9 && (a.share - 0.75).abs() < 1e-9, "{a:?}");
        assert!(a.gap_ms.abs() < 1e-9 && (b.gap_ms - 0.5).abs() < 1e-9 && (b.start_ms - 1.5).abs() < 1e-9, "{b:?}");
        assert_eq!(a.invocations.unwrap().compute, 128);
        // 600 operations in 3 ms of a million a second.
        assert!((a.of_peak.unwrap().float - 0.2).abs() < 1e-9 && b.of_peak.is_none(), "{a:?}");
        assert_eq!(a.of_peak.unwrap().largest().0, "float");
        assert!(merged(&[], &counted, &peaks).is_empty());
    }
}

//! What is measured, and the measuring.

use std::time::{Duration, Instant};

use anyhow::{Result, bail};

use super::contestants::{Contestant, Missing, WrongPixels};
use super::report::{BenchReport, Row, machine};
use super::rounds::{Round, Times, interleaved, pass_times};
use super::scene::{Scene, swarm};
use crate::body::Model;
use crate::evaluate::device::open_device;
use crate::evaluate::{Evaluator, Objective};
use crate::files::choices;
use crate::gpu::Device;

/// Candidates whose fitness is compared.
const COMPARED: usize = 24;
/// An evaluator that would take longer for a round is measured on those few candidates, in the quick preset.
const PATIENCE: Duration = Duration::from_secs(1);

choices! {
    /// A set of tasks.
    #[derive(Default)]
    "preset" pub enum Preset {
        /// 512 particles on both picture sizes, a few seconds.
        "quick" #[default] Quick,
        /// 96, 304 and 512 particles on both picture sizes and the model ladder at 96 and 304, beside published figures (METHOD
        /// A10).
        "thesis" Thesis,
    }
}

/// One task: a model, a number of candidates, and pictures in which the person is so tall.
#[derive(Clone, Copy, Debug)]
struct Task {
    model: Model,
    particles: usize,
    size: [u32; 2],
    person: f64,
}

const LARGE: ([u32; 2], f64) = ([640, 480], 280.0);
const SMALL: ([u32; 2], f64) = ([480, 270], 150.0);

impl Preset {
    fn tasks(self) -> Vec<Task> {
        let counts: &[usize] = match self {
            Self::Quick => &[512],
            Self::Thesis => &[96, 304, 512],
        };
        let flat = [LARGE, SMALL].into_iter().flat_map(|(size, person)| {
            counts.iter().map(move |&particles| Task { model: Model::Flat, particles, size, person })
        });
        let (rungs, counts): (usize, &[usize]) = match self {
            Self::Quick => (1, &[304]),
            Self::Thesis => (Model::ALL.len(), &[96, 304]),
        };
        let (size, person) = LARGE;
        let ladder = Model::ladder()
            .skip(1)
            .take(rungs)
            .flat_map(|model| counts.iter().map(move |&particles| Task { model, particles, size, person }));
        flat.chain(ladder).collect()
    }

    /// Time for the rounds of one evaluator on one task.
    fn share(self) -> Duration {
        match self {
            Self::Quick => Duration::from_millis(150),
            Self::Thesis => Duration::from_millis(600),
        }
    }
}

/// Measures every task of a preset; `begin` hears what is measured next.
///
/// # Errors
/// When the scene cannot be made; an evaluator that fails is listed with its error instead.
pub fn run(preset: Preset, begin: &mut dyn FnMut(&str)) -> Result<BenchReport> {
    let mut report = empty(preset);
    let device = open_device().map_err(|error| format!("{error:#}"));
    report.device = device.as_ref().ok().map(|device| format!("{}, {}", device.facts().name, device.facts().driver));
    for task in preset.tasks() {
        let [width, height] = task.size;
        begin(&format!("{}, {} particles, {width}x{height}", task.model.name(), task.particles));
        let scene = Scene::new(task.size, task.person)?;
        let evaluators = evaluators(&task, &scene, &device, &mut report)?;
        measure(preset, &task, &scene, evaluators, &mut report);
    }
    Ok(report)
}

fn empty(preset: Preset) -> BenchReport {
    BenchReport {
        preset: preset.name().to_string(),
        machine: machine(),
        device: None,
        rows: Vec::new(),
        unavailable: Vec::new(),
    }
}

/// Somebody who can do a task.
struct Present {
    evaluator: Box<dyn Evaluator>,
    /// How far its fitness may lie from the first one's.
    tolerance: f32,
    wrong: Option<WrongPixels>,
}

/// Everybody who can do a task here; who cannot is listed in the report, once.
fn evaluators(
    task: &Task,
    scene: &Scene,
    device: &Result<Device, String>,
    report: &mut BenchReport,
) -> Result<Vec<Present>> {
    let mesh = task.model.mesh(&scene.body)?;
    let all = if mesh.is_some() { Contestant::of_meshes() } else { Contestant::of_flat() };
    let mut present = Vec::new();
    for contestant in all {
        let wrong = || contestant.wrong_pixels(scene, device, &swarm(&scene.body, &scene.pose, COMPARED));
        let built = contestant.build(scene, mesh.as_ref(), device).and_then(|evaluator| Ok((evaluator, wrong()?)));
        match built {
            Ok((evaluator, wrong)) => present.push(Present { evaluator, tolerance: contestant.tolerance(), wrong }),
            Err(error) => {
                let missing = refusal(task, contestant.backend(), contestant.variant(), &error);
                if !report.unavailable.contains(&missing) {
                    report.unavailable.push(missing);
                }
            }
        }
    }
    Ok(present)
}

/// An evaluator at work on a task.
struct Entry {
    evaluator: Box<dyn Evaluator>,
    fitness: Vec<f32>,
    wrong: Option<WrongPixels>,
}

fn measure(preset: Preset, task: &Task, scene: &Scene, evaluators: Vec<Present>, report: &mut BenchReport) {
    let poses = swarm(&scene.body, &scene.pose, task.particles);
    let objective = Objective::default();
    let mut entries: Vec<Entry> = Vec::new();
    let mut expected: Option<(&'static str, Vec<f32>)> = None;
    for Present { mut evaluator, tolerance, wrong } in evaluators {
        let mut fitness = vec![0.0; task.particles];
        // A few candidates tell: the first evaluator is a slow one.
        let few = task.particles.min(COMPARED);
        let start = Instant::now();
        let found = evaluator.fitness(&poses[..few * scene.pose.len()], &objective, &mut fitness[..few]);
        let is_slow = start.elapsed() * (task.particles / few) as u32 > PATIENCE;
        let checked = found.and_then(|()| {
            let (name, expected) = expected.get_or_insert_with(|| (evaluator.name(), fitness[..few].to_vec()));
            agree(name, expected, &fitness[..few], tolerance)
        });
        match checked {
            Ok(()) => {
                if is_slow && preset == Preset::Quick {
                    fitness.truncate(few);
                }
                // Once in the size that is measured: rooms are made and their memory is touched for the first time.
                let warm = evaluator.fitness(&poses[..fitness.len() * scene.pose.len()], &objective, &mut fitness);
                match warm {
                    Ok(()) => entries.push(Entry { evaluator, fitness, wrong }),
                    Err(error) => report.unavailable.push(refusal(task, evaluator.name(), evaluator.variant(), &error)),
                }
            }
            Err(error) => report.unavailable.push(refusal(task, evaluator.name(), evaluator.variant(), &error)),
        }
    }
    let mut rounds: Vec<Round<'_>> = entries
        .iter_mut()
        .map(|entry| {
            let poses = &poses[..entry.fitness.len() * scene.pose.len()];
            let run = move || entry.evaluator.fitness(poses, &objective, &mut entry.fitness);
            Box::new(run) as Round<'_>
        })
        .collect();
    let times = interleaved(&mut rounds, 200, preset.share());
    drop(rounds);
    for (mut entry, times) in entries.into_iter().zip(times) {
        let Entry { evaluator, fitness, .. } = &mut entry;
        let poses = &poses[..fitness.len() * scene.pose.len()];
        let done = times.and_then(|times| Ok((times, pass_times(evaluator.as_mut(), poses, &objective, fitness)?)));
        match done {
            Ok((times, stages)) => report.rows.push(row(task, scene, &entry, times, stages)),
            Err(error) => {
                let Entry { evaluator, .. } = &entry;
                report.unavailable.push(refusal(task, evaluator.name(), evaluator.variant(), &error));
            }
        }
    }
}

/// Whether a fitness is that of the evaluator `name`, as far as backends promise it.
fn agree(name: &str, expected: &[f32], fitness: &[f32], tolerance: f32) -> Result<()> {
    let apart = expected.iter().zip(fitness).map(|(l, r)| (l - r).abs());
    if let Some(apart) = apart.filter(|apart| apart.is_nan() || *apart > tolerance).reduce(f32::max) {
        bail!("its fitness lies up to {apart} from that of {name}: it was not measured");
    }
    Ok(())
}

fn refusal(task: &Task, backend: &str, variant: &str, error: &anyhow::Error) -> Missing {
    Missing {
        backend: backend.to_string(),
        variant: variant.to_string(),
        model: task.model.to_string(),
        reason: format!("{error:#}"),
    }
}

fn row(task: &Task, scene: &Scene, entry: &Entry, times: Times, stages: Vec<(String, f64)>) -> Row {
    let (evaluator, particles) = (entry.evaluator.as_ref(), entry.fitness.len());
    let [width, height] = task.size;
    let footprint = evaluator.footprint();
    let poses_per_s = particles as f64 / times.median * 1e3;
    let images_per_s = poses_per_s * scene.cameras.len() as f64;
    Row {
        backend: evaluator.name().to_string(),
        variant: evaluator.variant().to_string(),
        model: task.model.to_string(),
        particles,
        views: scene.cameras.len(),
        width,
        height,
        tile: footprint.map_or(task.size, |footprint| footprint.tile),
        bytes_per_pixel: footprint.map(|footprint| footprint.bytes_per_pixel),
        ms: times.median,
        ms_min: times.min,
        ms_max: times.max,
        stages,
        poses_per_s,
        images_per_s,
        pixels_per_s: images_per_s * f64::from(width) * f64::from(height),
        wrong: entry.wrong,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_hold_what_the_thesis_measured() {
        let tasks = Preset::Thesis.tasks();
        for particles in [96, 304, 512] {
            for size in [[640, 480], [480, 270]] {
                let is_it =
                    |task: &&Task| task.model == Model::Flat && task.particles == particles && task.size == size;
                assert_eq!(tasks.iter().filter(is_it).count(), 1);
            }
        }
        for particles in [96, 304] {
            let ladder = tasks[6..].iter().filter(|task| task.particles == particles);
            let rungs: Vec<String> = ladder.map(|task| task.model.to_string()).collect();
            let elliptic = [18, 34, 66, 130, 258, 514].map(|vertices| format!("elliptic-{vertices}"));
            assert_eq!(rungs, [vec!["square".to_string()], elliptic.to_vec()].concat());
        }
        assert_eq!(tasks.len(), 6 + 14);
        let error = Preset::from_name("slow").unwrap_err().to_string();
        assert_eq!(error, "unknown preset `slow`, the nearest is `quick` (known: quick, thesis)");
    }

    #[test]
    fn no_number_agrees_with_nothing() {
        agree("reference", &[0.5, 0.25], &[0.5004, 0.25], 1e-3).unwrap();
        let error = agree("reference", &[0.5, 0.25], &[0.5, 0.5], 1e-3).unwrap_err().to_string();
        assert_eq!(error, "its fitness lies up to 0.25 from that of reference: it was not measured");
        assert!(agree("reference", &[0.5], &[f32::NAN], 1e-3).is_err());
    }

    #[test]
    fn an_evaluator_that_scores_otherwise_is_not_measured() {
        let task = Task { model: Model::Flat, particles: 6, size: [96, 72], person: 50.0 };
        let scene = Scene::new(task.size, task.person).unwrap();
        let mut report = empty(Preset::Quick);
        let mut all = evaluators(&task, &scene, &Err("no device".to_string()), &mut report).unwrap();
        report.unavailable.clear();
        // The last of them is made to look at something else.
        let mut blind = scene.observations.clone();
        blind.iter_mut().for_each(|seen| seen.bytes.fill(0));
        all.last_mut().unwrap().evaluator.observe(&blind).unwrap();
        let expected = all.len() - 1;
        measure(Preset::Quick, &task, &scene, all, &mut report);
        assert_eq!((report.rows.len(), report.unavailable.len()), (expected, 1), "{:?}", report.unavailable);
        assert!(report.unavailable[0].reason.contains("from that of reference"), "{:?}", report.unavailable);
        let row = &report.rows[0];
        assert_eq!((row.particles, row.views, row.tile), (6, 4, [96, 72]));
        assert!((row.images_per_s - 24.0 / row.ms * 1e3).abs() < 1e-6 * row.images_per_s);
        assert!((row.pixels_per_s - row.images_per_s * 96.0 * 72.0).abs() < 1e-6 * row.pixels_per_s);
    }
}

//! The measuring: all points take turns, so that a noisy moment of the machine touches all alike.

use anyhow::{Result, bail, ensure};

use super::super::report::machine;
use super::super::rounds::Times;
use super::super::scene::{Scene, swarm};
use super::point::Point;
use super::report::{SweepReport, SweepRow};
use crate::evaluate::cpu::Cpu;
use crate::evaluate::device::{RasterKernel, open_device};
use crate::evaluate::{Components, Evaluator, Objective};

/// Rounds of which the medians are told, after one that is not counted.
const ROUNDS: usize = 5;
/// Candidates whose sums are held to the processor's.
const COMPARED: usize = 24;

/// What is measured on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Task {
    pub(super) particles: usize,
    pub(super) size: [u32; 2],
    /// How tall the person is there, pixels.
    pub(super) person: f64,
}

/// Measures every stage on the device that backends work on, in the larger of the bench's pictures; `begin` hears what is measured next.
/// What gives other sums than the processor is listed and not measured.
///
/// # Errors
/// When there is no device, it has no timestamps, or it fails.
pub fn run(begin: &mut dyn FnMut(&str)) -> Result<SweepReport> {
    sweep(&Point::all(), Task { particles: 512, size: [640, 480], person: 280.0 }, begin)
}

/// A point at work.
struct Entry {
    point: Point,
    evaluator: Box<dyn Evaluator>,
    ms: Vec<f64>,
}

pub(super) fn sweep(points: &[Point], task: Task, begin: &mut dyn FnMut(&str)) -> Result<SweepReport> {
    let device = open_device()?;
    let facts = device.facts();
    ensure!(
        device.capabilities().timestamps,
        "the Vulkan device {} has no timestamps, and stages are told apart by them: pantin bench measures without",
        facts.name
    );
    let scene = Scene::new(task.size, task.person)?;
    let poses = swarm(&scene.body, &scene.pose, task.particles);
    let few = &poses[..task.particles.min(COMPARED) * scene.pose.len()];
    let mut cpu = Cpu::new(&scene.body, &scene.cameras)?;
    cpu.observe(&scene.observations)?;
    let expected = sums(&mut cpu, few)?;
    let mut report = SweepReport {
        machine: machine(),
        device: format!("{}, {}", facts.name, facts.driver),
        particles: task.particles,
        views: scene.cameras.len(),
        width: task.size[0],
        height: task.size[1],
        rows: Vec::new(),
        unavailable: Vec::new(),
    };
    let (mut entries, mut stage) = (Vec::new(), "");
    for &point in points {
        if point.stage() != stage {
            stage = point.stage();
            begin(&format!("{stage}: compiling it in every way"));
        }
        let built = point.build(&scene, &device).and_then(|mut evaluator| {
            let found = sums(evaluator.as_mut(), few)?;
            ensure!(found == expected, "its sums are not those of the processor: it was not measured");
            evaluator.measure_passes(true)?;
            Ok(evaluator)
        });
        match built {
            Ok(evaluator) => entries.push(Entry { point, evaluator, ms: Vec::new() }),
            Err(error) => report.unavailable.push(refusal(point, &error)),
        }
    }
    let mut fitness = vec![0.0; task.particles];
    for round in 0..=ROUNDS {
        begin(&format!("round {round} of {ROUNDS}, {} ways", entries.len()));
        for Entry { point, evaluator, ms } in &mut entries {
            evaluator.fitness(&poses, &Objective::default(), &mut fitness)?;
            let passes = evaluator.device_passes();
            let own =
                passes.iter().filter(|pass| point.is_timed_by(&pass.name)).map(|pass| pass.duration.as_secs_f64());
            let (count, seconds) = own.fold((0, 0.0), |(count, sum), seconds| (count + 1, sum + seconds));
            if count == 0 {
                bail!("no pass {} ran, of {} passes", point.stage(), passes.len());
            }
            // The first makes rooms and touches memory.
            if round > 0 {
                ms.push(seconds * 1e3);
            }
        }
    }
    for Entry { point, ms, .. } in entries {
        let Times { median, min, max } = Times::of(ms);
        report.rows.push(SweepRow {
            stage: point.stage().to_string(),
            way: point.way(),
            workgroup: point.group(),
            usual: point.is_usual(RasterKernel::usual(device.capabilities())),
            ms: median,
            ms_min: min,
            ms_max: max,
        });
    }
    ensure!(!report.rows.is_empty(), "nothing could be measured: {}", report.unavailable.join("; "));
    Ok(report)
}

fn sums(evaluator: &mut dyn Evaluator, poses: &[f32]) -> Result<Vec<Components>> {
    let images = poses.len() / evaluator.dof_count() * evaluator.view_count();
    let mut found = vec![Components::default(); images];
    evaluator.components(poses, &mut found)?;
    Ok(found)
}

fn refusal(point: Point, error: &anyhow::Error) -> String {
    let way = point.way();
    let way = if way.is_empty() { way } else { format!(", {way}") };
    format!("{}{way} by workgroups of {}: {error:#}", point.stage(), point.group())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::print_stdout, reason = "a test says what it leaves out")]

    use super::*;
    use crate::evaluate::device::{Gathering, RowWay};

    #[test]
    fn stages_are_timed_and_what_cannot_be_is_said() {
        if let Err(error) = open_device() {
            assert!(std::env::var_os("PANTIN_NEEDS_VULKAN").is_none(), "{error:#}");
            return println!("SKIPPED stages_are_timed_and_what_cannot_be_is_said: {error:#}");
        }
        let points = [
            Point::Project(32),
            Point::Raster(RasterKernel::ROWS),
            Point::Raster(RasterKernel::Rows(RowWay { group: 16, words: 4, keeps_edges: false })),
            Point::Raster(RasterKernel::Rows(RowWay { group: 24, words: 4, keeps_edges: false })),
            Point::Raster(RasterKernel::Spans { group: 32, workgroups: 2 }),
            Point::Compare(Gathering::Texels, 64),
            Point::Project(8),
        ];
        let task = Task { particles: 6, size: [96, 72], person: 50.0 };
        let report = sweep(&points, task, &mut |_| ()).unwrap();
        let rows: Vec<(&str, u32, bool)> =
            report.rows.iter().map(|row| (row.stage.as_str(), row.workgroup, row.usual)).collect();
        let expected = [
            ("project", 32, false),
            ("raster", 32, true),
            ("raster", 16, false),
            ("raster_spans", 32, false),
            ("compare", 64, false),
        ];
        assert_eq!(rows, expected, "{:?}", report.unavailable);
        assert!(report.rows.iter().all(|row| row.ms_min > 0.0 && row.ms_min <= row.ms && row.ms <= row.ms_max));
        let [rows, parts] = report.unavailable.as_slice() else { panic!("{:?}", report.unavailable) };
        assert!(rows.contains("raster, 4 words by workgroups of 24") && rows.contains("a power of two"), "{rows}");
        assert!(parts.contains("project by workgroups of 8") && parts.contains("expected 16 to 128"), "{parts}");
    }
}

//! Throughput of the evaluators, poses in to fitness out, side by side in one run.
//!
//! `cargo bench --bench evaluate` prints the table of docs/PERFORMANCE.md; run by `cargo test` it scores a few candidates. Either way
//! it checks first that all give the same integers. Rows `in segments` are scored by three segments (docs/RASTER.md), those `with edges`
//! by the edges of each too.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark ends where something fails, and prints")]

mod table;

use std::cell::RefCell;
use std::sync::Arc;

use pantin::bench::{Contestant, Scene, pass_times, swarm};
use pantin::body::Body;
use pantin::evaluate::cpu::{Cpu, InstructionSet};
use pantin::evaluate::device::{
    Comparison, Coverage, Gathering, GraphicsSettings, Packing, Primitives, Projection, Tiling, open_device,
};
use pantin::evaluate::{Components, EdgeTerm, Evaluator, Objective, Reference};
use pantin::features::{Observation, Segment, Segmentation, Segments};
use pantin::geometry::Camera;
use pantin::gpu::Device;
use table::{Table, in_a_line, is_measuring, is_wanted};

/// The time of a batch by its size: a candidate should cost the same in any.
fn scaling(threads: usize) {
    let scene = Scene::new([480, 270], 150.0).unwrap();
    let mut cpu = Cpu::with(&scene.body, &scene.cameras, InstructionSet::best(), threads).unwrap();
    cpu.observe(&scene.observations).unwrap();
    let (cpu, poses) = (RefCell::new(cpu), swarm(&scene.body, &scene.pose, 1024));
    let mut table = Table::new(format!("scaling: {} on A, {threads} threads", InstructionSet::best().name()), "image");
    for count in [128, 256, 512, 1024] {
        let (poses, mut fitness) = (&poses[..count * scene.pose.len()], vec![0.0; count]);
        let cpu = &cpu;
        table.row(format!("scaling: {count} candidates"), count * scene.cameras.len(), move || {
            cpu.borrow_mut().fitness(poses, &Objective::default(), &mut fitness).unwrap();
        });
    }
    table.run();
}

/// Observations whose silhouettes are told apart as the body's own parts in a pose: head and trunk, arms, legs.
fn in_segments(body: &Body, cameras: &[Camera], pose: &[f32], seen: &[Observation]) -> Vec<Observation> {
    let labels = |is_own: fn(&str) -> bool| -> Vec<u8> {
        body.parts.iter().filter(|part| is_own(&part.name)).map(|part| part.label).collect()
    };
    let is_arm = |name: &str| ["arm", "hand"].iter().any(|word| name.contains(word));
    let is_leg = |name: &str| ["thigh", "calf", "foot"].iter().any(|word| name.contains(word));
    let (arms, legs) = (labels(is_arm), labels(is_leg));
    let rest = body.parts.iter().map(|part| part.label).filter(|label| !arms.contains(label) && !legs.contains(label));
    let segment = |name: &str, labels: Vec<u8>, weight| Segment { name: name.into(), labels, weight };
    let list = vec![segment("trunk", rest.collect(), 0.4), segment("arms", arms, 0.3), segment("legs", legs, 0.3)];
    assert!(list.iter().all(|segment| !segment.labels.is_empty()));
    let segments = Arc::new(Segments::new(list).unwrap());
    let reference = Reference::new(body, cameras);
    seen.iter()
        .enumerate()
        .map(|(view, observation)| {
            let drawn = reference.draw(pose, view);
            let numbers = drawn.bytes.iter().map(|byte| segments.number(byte & 0x7f)).collect();
            let segmentation = Segmentation::new(Arc::clone(&segments), drawn.width, drawn.height, numbers).unwrap();
            observation.clone().with_segmentation(segmentation).unwrap()
        })
        .collect()
}

/// Who is measured, by the names of the rows: the yardsticks, every instruction set, compute, and of graphics the packings and
/// comparisons that differ most; in segments those that are fit for it.
fn contestants(in_segments: bool) -> Vec<(String, Contestant)> {
    let usual = GraphicsSettings::default();
    let depth = GraphicsSettings { packing: Packing::Depth, ..usual };
    let hardware = Coverage::Hardware;
    let covered = GraphicsSettings { coverage: hardware, ..depth };
    // What one writes first: whole pictures, a depth buffer, a write mask a channel.
    let whole = GraphicsSettings {
        coverage: hardware,
        comparison: Comparison::Device(Gathering::Subgroup),
        tiling: Tiling::Pictures,
        ..depth
    };
    let mut all: Vec<(String, Contestant)> = Vec::new();
    for contestant in Contestant::of_flat() {
        let name = match contestant {
            Contestant::Reference | Contestant::Compute { subgroup: false } => continue,
            Contestant::Yardstick(_) if in_segments => continue,
            Contestant::Cpu(set) if !set.is_available() => continue,
            // In depth what differs most: the usual comparison, and coverage by the hardware.
            Contestant::Graphics(settings)
                if settings.packing == Packing::Depth
                    && ![depth, covered].contains(&settings)
                    && !contestant.is_wrong() =>
            {
                continue;
            }
            Contestant::Graphics(GraphicsSettings { coverage, projection, primitives, .. })
                if in_segments
                    && (coverage == hardware
                        || projection == Projection::Feedback
                        || primitives == Primitives::Geometry) =>
            {
                continue;
            }
            Contestant::Compute { .. } => "compute subgroup".to_string(),
            Contestant::Spans => "compute spans".to_string(),
            Contestant::Graphics(settings) => format!("graphics-{}", settings.name()),
            Contestant::Yardstick(_) | Contestant::Cpu(_) => contestant.variant().to_string(),
        };
        all.push((name, contestant));
    }
    if !in_segments {
        all.push(("graphics-whole-pictures".to_string(), Contestant::Graphics(whole)));
    }
    all
}

/// An evaluator in its row's closure, once its integers are those of the rows before.
fn row<'a>(
    name: &str,
    contestant: Contestant,
    scene: &Scene,
    device: &Result<Device, String>,
    (poses, objective): (&'a [f32], Objective),
    expected: &mut Option<Vec<Components>>,
) -> Option<impl FnMut() + 'a> {
    let mut evaluator = match contestant.build(scene, None, device) {
        Ok(evaluator) => evaluator,
        Err(error) => {
            println!("SKIPPED {name}: {error:#}");
            return None;
        }
    };
    let few = &poses[..poses.len().min(24 * scene.pose.len())];
    if let Some(wrong) = contestant.wrong_pixels(scene, device, few).unwrap() {
        println!("{name} is wrong: {wrong}");
    }
    let count = poses.len() / scene.pose.len();
    let mut found = vec![Components::default(); count * scene.cameras.len()];
    evaluator.components(poses, &mut found).unwrap();
    // The hardware's rule covers other pixels at the edges.
    let is_exact = !matches!(contestant, Contestant::Graphics(settings) if settings.coverage == Coverage::Hardware);
    assert!(!is_exact || found == *expected.get_or_insert_with(|| found.clone()), "{name} gives other integers");
    let mut fitness = vec![0.0; count];
    let passes = pass_times(evaluator.as_mut(), poses, &objective, &mut fitness).unwrap();
    if !passes.is_empty() {
        println!("{name} stages, ms: {}", in_a_line(&passes));
    }
    Some(move || evaluator.fitness(poses, &objective, &mut fitness).unwrap())
}

fn main() {
    let count = if is_measuring() { 512 } else { 32 };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    scaling(threads);
    let device = open_device().map_err(|error| format!("{error:#}"));
    for (title, size, person) in [("A", [480, 270], 150.0), ("B", [640, 480], 280.0)] {
        let scene = Scene::new(size, person).unwrap();
        let Scene { body, cameras, observations, pose } = &scene;
        let poses = swarm(body, pose, count);
        let segmented = in_segments(body, cameras, pose, observations);
        let pixels: u32 = observations.iter().map(Observation::area).sum::<u32>() / 4;
        let title = format!(
            "{title}: {count} candidates x 4 cameras, {}x{}, person {person} px ({pixels} px silhouette), {threads} threads",
            size[0], size[1]
        );
        let mut table = Table::new(title, "image").beside(&["rowspan", "zbuffer"]);
        let mut expected = None;
        let segmented = Scene { observations: segmented, ..scene.clone() };
        let usual = Objective::default();
        let by_segments = Objective { edges: EdgeTerm::Segments, ..usual };
        for (suffix, scene, objective) in [
            ("", &scene, usual),
            (" in segments", &segmented, usual),
            (" in segments with edges", &segmented, by_segments),
        ] {
            for (name, contestant) in contestants(!suffix.is_empty()) {
                let name = format!("{name}{suffix}");
                if !is_wanted(&name) {
                    continue;
                }
                if let Some(run) = row(&name, contestant, scene, &device, (&poses, objective), &mut expected) {
                    table.row(name, count * cameras.len(), run);
                }
            }
        }
        table.run();
    }
}

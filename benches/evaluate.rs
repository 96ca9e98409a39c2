//! Throughput of the evaluators, poses in to fitness out, side by side in one run: the rounds of all rows are interleaved,
//! so that a noisy moment of the machine touches every row alike, and the ratios are of medians.
//!
//! `cargo bench --bench evaluate` prints the table of docs/PERFORMANCE.md; run by `cargo test` it does one round of each
//! row and checks that all give the same integers. Rows `in segments` are scored by three segments (docs/RASTER.md).
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use std::sync::Arc;
use std::time::Instant;

use pantin::bench::{Scene, Yardstick, YardstickKind, swarm};
use pantin::body::Body;
use pantin::evaluate::cpu::{Cpu, InstructionSet};
use pantin::evaluate::device::{
    Comparison, Compute, Coverage, Gathering, Graphics, GraphicsSettings, HostComparison, Packing, Projection, Tiling,
    open_device,
};
use pantin::evaluate::{Components, Evaluator, Objective, Reference};
use pantin::features::{Observation, Segment, Segmentation, Segments};
use pantin::geometry::Camera;
use pantin::gpu::{PassTiming, Timing, by_name};

/// Prints the time of a batch by its size: a candidate should cost the same in any.
fn scaling(threads: usize) {
    let Scene { body, cameras, observations, pose } = Scene::new([480, 270], 150.0).unwrap();
    let mut cpu = Cpu::with(&body, &cameras, InstructionSet::best(), threads).unwrap();
    let poses = swarm(&body, &pose, 1024);
    cpu.observe(&observations).unwrap();
    let mut sizes = [128, 256, 512, 1024].map(|count| (count, Vec::new()));
    let mut fitness = vec![0.0; 1024];
    for _ in 0..160 {
        for (count, ms) in &mut sizes {
            let start = Instant::now();
            cpu.fitness(&poses[..*count * body.dof_count()], &Objective::default(), &mut fitness[..*count]).unwrap();
            ms.push(start.elapsed().as_secs_f64() * 1e3);
        }
    }
    println!("scaling: {} on A by candidates, {threads} threads", InstructionSet::best().name());
    println!("{:>10} {:>9} {:>9} {:>10}", "candidates", "ms", "min", "us/image");
    for (count, ms) in &mut sizes {
        ms.sort_by(f64::total_cmp);
        let median = ms[ms.len() / 2];
        println!("{count:10} {median:9.3} {:9.3} {:10.3}", ms[0], median * 1e3 / (*count * cameras.len()) as f64);
    }
}

/// Prints what each stage on the device takes, of the second of two evaluations.
fn stages(compute: &mut Compute, poses: &[f32], fitness: &mut [f32]) {
    compute.time_stages(Timing::Stamps);
    for _ in 0..2 {
        compute.fitness(poses, &Objective::default(), fitness).unwrap();
    }
    print_stages("compute", &compute.timings().unwrap());
    compute.time_stages(Timing::Off);
}

fn print_stages(name: &str, timings: &[PassTiming]) {
    let text: Vec<String> = by_name(timings).iter().map(|(name, ms, _)| format!("{name} {ms:.3}")).collect();
    println!("{name} stages, ms: {}", text.join(", "));
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

struct Row {
    name: String,
    rounds_each: usize,
    /// Of how many rounds it takes part in one.
    every: usize,
    /// Whether it gives the reference's integers.
    is_exact: bool,
    run: Box<dyn FnMut() -> Vec<Components>>,
    ms: Vec<f64>,
}

fn main() {
    // `cargo bench --bench evaluate -- avx` keeps the rows whose names hold that word.
    let filter: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let measuring = std::env::args().any(|argument| argument == "--bench");
    let count = if measuring { 512 } else { 32 };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    if measuring && (filter.is_empty() || filter.iter().any(|word| "scaling".contains(word.as_str()))) {
        scaling(threads);
    }
    for (title, size, person) in [("A", [480, 270], 150.0), ("B", [640, 480], 280.0)] {
        let Scene { body, cameras, observations: seen, pose } = Scene::new(size, person).unwrap();
        let poses = swarm(&body, &pose, count);
        let segmented = in_segments(&body, &cameras, &pose, &seen);
        let told_apart = [("", &seen), (" in segments", &segmented)];
        let pixels: u32 = seen.iter().map(Observation::area).sum::<u32>() / 4;
        println!(
            "\n{title}: {count} candidates x 4 cameras, {}x{}, person {person} px ({pixels} px silhouette), {threads} threads",
            size[0], size[1]
        );

        let mut rows: Vec<Row> = Vec::new();
        for kind in YardstickKind::ALL {
            let mut yardstick = Yardstick::new(&body, &cameras, kind, threads);
            yardstick.observe(&seen).unwrap();
            let poses = poses.clone();
            rows.push(Row {
                name: kind.name().into(),
                rounds_each: 1,
                every: 1,
                is_exact: true,
                run: Box::new(move || {
                    let mut out = vec![Components::default(); count * 4];
                    yardstick.components(&poses, &mut out).unwrap();
                    out
                }),
                ms: Vec::new(),
            });
        }
        let sets = InstructionSet::ALL.into_iter().filter(|set| set.is_available());
        for (set, (suffix, seen)) in sets.flat_map(|set| told_apart.map(|each| (set, each))) {
            let mut cpu = Cpu::with(&body, &cameras, set, threads).unwrap();
            cpu.observe(seen).unwrap();
            let poses = poses.clone();
            let (mut fitness, mut out) = (vec![0.0; count], Vec::new());
            let objective = Objective::default();
            rows.push(Row {
                name: format!("{}{suffix}", set.name()),
                // The iterations of a frame follow each other; alone, an iteration would mostly wake its threads and fill caches.
                rounds_each: 15,
                every: 1,
                is_exact: true,
                run: Box::new(move || {
                    cpu.fitness(&poses, &objective, &mut fitness).unwrap();
                    if out.is_empty() {
                        out = vec![Components::default(); count * 4];
                        cpu.components(&poses, &mut out).unwrap();
                        return out.clone();
                    }
                    Vec::new()
                }),
                ms: Vec::new(),
            });
        }
        for (suffix, seen) in told_apart {
            let mut compute = match Compute::new(&body, &cameras) {
                Ok(compute) => compute,
                Err(error) => {
                    println!("SKIPPED compute: {error:#}");
                    break;
                }
            };
            compute.observe(seen).unwrap();
            let (name, poses) = (format!("compute {}{suffix}", compute.variant()), poses.clone());
            println!("compute on {}", compute.facts().name);
            let (mut fitness, mut out) = (vec![0.0; count], Vec::new());
            let objective = Objective::default();
            rows.push(Row {
                name,
                rounds_each: 2,
                every: 1,
                is_exact: true,
                run: Box::new(move || {
                    compute.fitness(&poses, &objective, &mut fitness).unwrap();
                    if out.is_empty() {
                        out = vec![Components::default(); count * 4];
                        compute.components(&poses, &mut out).unwrap();
                        stages(&mut compute, &poses, &mut fitness);
                        return out.clone();
                    }
                    Vec::new()
                }),
                ms: Vec::new(),
            });
        }
        rows.extend(graphics_rows(&body, &cameras, told_apart, &poses));
        if !filter.is_empty() {
            rows.retain(|row| filter.iter().any(|word| row.name.contains(word)));
        }
        // The first call warms up and shows that all compute the same.
        let mut expected = None;
        for row in &mut rows {
            let found = (row.run)();
            if row.is_exact {
                let expected = expected.get_or_insert_with(|| found.clone());
                assert!(found == *expected, "{} gives other integers than the rows before", row.name);
            }
        }
        for round in 0..if measuring { 40 } else { 1 } {
            for row in rows.iter_mut().filter(|row| round % row.every == 0) {
                let start = Instant::now();
                for _ in 0..row.rounds_each {
                    std::hint::black_box((row.run)());
                }
                row.ms.push(start.elapsed().as_secs_f64() * 1e3 / row.rounds_each as f64);
            }
        }
        if !measuring {
            continue;
        }
        println!(
            "{:40} {:>9} {:>9} {:>9} {:>10} {:>10} {:>10}",
            "variant", "ms", "min", "max", "us/image", "x rowspan", "x zbuffer"
        );
        let medians: Vec<f64> = rows
            .iter_mut()
            .map(|row| {
                row.ms.sort_by(f64::total_cmp);
                row.ms[row.ms.len() / 2]
            })
            .collect();
        let times = |name: &str, ms: f64| {
            rows.iter().position(|row| row.name == name).map_or(f64::NAN, |index| medians[index] / ms)
        };
        for (row, &ms) in rows.iter().zip(&medians) {
            println!(
                "{:40} {:9.3} {:9.3} {:9.3} {:10.3} {:10.1} {:10.1}",
                row.name,
                ms,
                row.ms[0],
                row.ms[row.ms.len() - 1],
                ms * 1e3 / (count as f64 * 4.0),
                times("rowspan", ms),
                times("zbuffer", ms)
            );
        }
    }
}

/// The graphics backend in all its variants, the first of them what one writes first: whole pictures, a depth buffer, a write mask a
/// channel; by whole silhouettes, and those that are fit for it by segments too. Nothing where there is no Vulkan.
fn graphics_rows(
    body: &Body,
    cameras: &[Camera],
    told_apart: [(&str, &Vec<Observation>); 2],
    poses: &[f32],
) -> Vec<Row> {
    let device = match open_device() {
        Ok(device) => device,
        Err(error) => {
            println!("SKIPPED graphics: {error:#}");
            return Vec::new();
        }
    };
    let usual = GraphicsSettings::default();
    let compare = |comparison| GraphicsSettings { comparison, ..usual };
    let whole = GraphicsSettings {
        packing: Packing::Depth,
        coverage: Coverage::Hardware,
        comparison: Comparison::Device(Gathering::Subgroup),
        tiling: Tiling::Pictures,
        ..usual
    };
    let variants = [
        ("graphics-whole-pictures", whole),
        ("graphics-max-texels", usual),
        ("graphics-max-subgroup", compare(Comparison::Device(Gathering::Subgroup))),
        ("graphics-max-shared", compare(Comparison::Device(Gathering::Shared))),
        ("graphics-max-readback", compare(Comparison::Host(HostComparison::Scalar))),
        ("graphics-max-readback-simd", compare(Comparison::Host(HostComparison::Simd))),
        ("graphics-max-feedback", GraphicsSettings { projection: Projection::Feedback, ..usual }),
        ("graphics-max-hardware", GraphicsSettings { coverage: Coverage::Hardware, ..usual }),
        ("graphics-depth-texels", GraphicsSettings { packing: Packing::Depth, ..usual }),
        (
            "graphics-depth-hardware",
            GraphicsSettings { packing: Packing::Depth, coverage: Coverage::Hardware, ..usual },
        ),
    ];
    let count = poses.len() / body.dof_count();
    let is_measured = |name: &str, in_segments: bool| {
        let plain = ["whole-pictures", "feedback", "hardware"].iter().any(|word| name.contains(word));
        !(in_segments && plain)
    };
    variants
        .into_iter()
        .flat_map(|(name, settings)| told_apart.map(|(suffix, seen)| (name, suffix, settings, seen)))
        .filter(|(name, suffix, ..)| is_measured(name, !suffix.is_empty()))
        .map(|(name, suffix, settings, seen)| {
            let name = format!("{name}{suffix}");
            let mut graphics = Graphics::on(&device, body, cameras, settings).unwrap();
            graphics.observe(seen).unwrap();
            let poses = poses.to_vec();
            let (mut fitness, mut out) = (vec![0.0; count], Vec::new());
            let objective = Objective::default();
            Row {
                name: name.clone(),
                rounds_each: 1,
                every: 4,
                is_exact: settings.coverage == Coverage::Exact,
                run: Box::new(move || {
                    graphics.fitness(&poses, &objective, &mut fitness).unwrap();
                    if out.is_empty() {
                        out = vec![Components::default(); count * 4];
                        graphics.components(&poses, &mut out).unwrap();
                        graphics.time_stages(Timing::Stamps);
                        for _ in 0..2 {
                            graphics.fitness(&poses, &objective, &mut fitness).unwrap();
                        }
                        print_stages(&name, &graphics.timings().unwrap());
                        graphics.time_stages(Timing::Off);
                        return out.clone();
                    }
                    Vec::new()
                }),
                ms: Vec::new(),
            }
        })
        .collect()
}

//! Throughput of the evaluators, poses in to fitness out, side by side in one run: the rounds of all rows are interleaved,
//! so that a noisy moment of the machine touches every row alike, and the ratios are of medians.
//!
//! `cargo bench --bench evaluate` prints the table of docs/PERFORMANCE.md; run by `cargo test` it does one round of each
//! row and checks that all give the same integers.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

mod yardstick;

use std::time::Instant;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use pantin::body::Body;
use pantin::evaluate::cpu::{Cpu, InstructionSet};
use pantin::evaluate::vulkan::Compute;
use pantin::evaluate::{Components, Evaluator as _, Objective, Reference};
use pantin::features::Observation;
use pantin::geometry::{BrownConrady, Camera, Lens};
use pantin::gpu::{Timing, by_name};
use yardstick::Yardstick;

/// Four cameras around a person who is `person` pixels tall in pictures of `size`.
fn cameras(size: [u32; 2], person: f64) -> Vec<Camera> {
    let distance = 4000.0;
    let focal = person * distance / 1750.0;
    (0..4)
        .map(|index| {
            let angle = f64::from(index) * std::f64::consts::FRAC_PI_2 + 0.6;
            let eye = DVec3::new(distance * angle.cos(), distance * angle.sin(), 1200.0);
            let forward = (DVec3::new(0.0, 0.0, 900.0) - eye).normalize();
            let right = forward.cross(DVec3::Z).normalize();
            let rotation = DMat3::from_cols(right, forward.cross(right), forward).transpose();
            Camera {
                name: format!("cam{index}"),
                size,
                camera_from_world: DAffine3::from_mat3_translation(rotation, -(rotation * eye)),
                lens: Lens::BrownConrady(BrownConrady {
                    focal: DVec2::splat(focal),
                    centre: DVec2::new(f64::from(size[0]), f64::from(size[1])) / 2.0,
                    radial: [-0.05, 0.01, 0.0],
                    tangential: [1e-4, -1e-4],
                }),
            }
        })
        .collect()
}

/// A swarm as it stands around a pose in mid-frame: the pose and `count - 1` others within one step of it.
fn swarm(body: &Body, count: usize) -> Vec<f32> {
    let mut state = 1_u64;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1_u64 << 24) as f64
    };
    let standing = body.standing_pose();
    let mut poses = Vec::new();
    for candidate in 0..count {
        for ((_, dof), start) in body.dofs().zip(&standing) {
            let spread = if candidate == 0 { 0.0 } else { 2.0 * uniform() - 1.0 };
            poses.push((start + dof.step * spread) as f32);
        }
    }
    poses
}

/// What the cameras would see of the first pose: its drawn silhouette, its edges with a falling proximity.
fn observations(body: &Body, cameras: &[Camera], pose: &[f32]) -> Vec<Observation> {
    let reference = Reference::new(body, cameras);
    (0..cameras.len())
        .map(|view| {
            let image = reference.draw(pose, view);
            let bytes = image.bytes.iter().enumerate().map(|(index, &drawn)| {
                let silhouette = if drawn != 0 { Observation::SILHOUETTE } else { 0 };
                silhouette | (index as u32).wrapping_mul(2_654_435_761).to_be_bytes()[0] & Observation::PROXIMITY
            });
            Observation { width: image.width, height: image.height, bytes: bytes.collect() }
        })
        .collect()
}

/// Prints the time of a batch by its size: a candidate should cost the same in any.
fn scaling(body: &Body, threads: usize) {
    let cameras = cameras([480, 270], 150.0);
    let mut cpu = Cpu::with(body, &cameras, InstructionSet::best(), threads).unwrap();
    let poses = swarm(body, 1024);
    let seen = observations(body, &cameras, &poses[..body.dof_count()]);
    cpu.observe(&seen).unwrap();
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
    let stages = by_name(&compute.timings().unwrap());
    let text: Vec<String> = stages.iter().map(|(name, ms, _)| format!("{name} {ms:.3}")).collect();
    println!("compute stages, ms: {}", text.join(", "));
    compute.time_stages(Timing::Off);
}

struct Row {
    name: String,
    rounds_each: usize,
    run: Box<dyn FnMut() -> Vec<Components>>,
    ms: Vec<f64>,
}

fn main() {
    // `cargo bench --bench evaluate -- avx` keeps the rows whose names hold that word.
    let filter: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let measuring = std::env::args().any(|argument| argument == "--bench");
    let count = if measuring { 512 } else { 32 };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let body = Body::adult(1750.0).unwrap();
    if measuring && (filter.is_empty() || filter.iter().any(|word| "scaling".contains(word.as_str()))) {
        scaling(&body, threads);
    }
    for (title, size, person) in [("A", [480, 270], 150.0), ("B", [640, 480], 280.0)] {
        let cameras = cameras(size, person);
        let poses = swarm(&body, count);
        let seen = observations(&body, &cameras, &poses[..body.dof_count()]);
        let pixels: u32 = seen.iter().map(Observation::area).sum::<u32>() / 4;
        println!(
            "\n{title}: {count} candidates x 4 cameras, {}x{}, person {person} px ({pixels} px silhouette), {threads} threads",
            size[0], size[1]
        );

        let mut rows: Vec<Row> = Vec::new();
        for kind in [Yardstick::ZBuffer, Yardstick::RowSpan] {
            let (evaluator, seen, poses) =
                (yardstick::Evaluator::new(&body, &cameras, kind), seen.clone(), poses.clone());
            rows.push(Row {
                name: if kind == Yardstick::ZBuffer { "zbuffer" } else { "rowspan" }.into(),
                rounds_each: 1,
                run: Box::new(move || {
                    let mut out = vec![Components::default(); count * 4];
                    evaluator.components(&poses, &seen, &mut out, threads);
                    out
                }),
                ms: Vec::new(),
            });
        }
        for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            let mut cpu = Cpu::with(&body, &cameras, set, threads).unwrap();
            cpu.observe(&seen).unwrap();
            let poses = poses.clone();
            let (mut fitness, mut out) = (vec![0.0; count], Vec::new());
            let objective = Objective::default();
            rows.push(Row {
                name: set.name().into(),
                rounds_each: 4,
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
        match Compute::new(&body, &cameras) {
            Ok(mut compute) => {
                compute.observe(&seen).unwrap();
                let (name, poses) = (format!("compute {}", compute.variant()), poses.clone());
                println!("compute on {}", compute.facts().name);
                let (mut fitness, mut out) = (vec![0.0; count], Vec::new());
                let objective = Objective::default();
                rows.push(Row {
                    name,
                    rounds_each: 2,
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
            Err(error) => println!("SKIPPED compute: {error:#}"),
        }
        if !filter.is_empty() {
            rows.retain(|row| filter.iter().any(|word| row.name.contains(word)));
        }
        // The first call warms up and shows that all compute the same.
        let Some(first) = rows.first_mut() else { continue };
        let expected = (first.run)();
        for row in &mut rows[1..] {
            assert!((row.run)() == expected, "{} gives other integers than the first row", row.name);
        }
        for _ in 0..if measuring { 40 } else { 1 } {
            for row in &mut rows {
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
            "{:16} {:>9} {:>9} {:>9} {:>10} {:>10} {:>10}",
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
                "{:16} {:9.3} {:9.3} {:9.3} {:10.3} {:10.1} {:10.1}",
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

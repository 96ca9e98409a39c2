//! An iteration of the search allocates nothing: neither the swarm's step nor the evaluation of its poses. A counting
//! allocator stands in for the system's in this program, and a case that does allocate shows that it counts.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DAffine3, DMat3, DVec2, DVec3};
use pantin::body::{Body, Mesh};
use pantin::evaluate::cpu::{Cpu, InstructionSet};
use pantin::evaluate::{Evaluator as _, Objective};
use pantin::features::Observation;
use pantin::geometry::{BrownConrady, Camera, Lens};
use pantin::search::{SearchKind, SearchSettings, SearchSpace};

/// The system's allocator, counting the blocks it hands out to any thread.
struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call is passed on to the system's allocator as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promises are the system allocator's conditions.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as in `alloc`.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: as in `alloc`.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Blocks allocated, by whatever thread, while `work` runs.
fn allocations(work: impl FnOnce()) -> usize {
    let before = ALLOCATIONS.load(Ordering::SeqCst);
    work();
    ALLOCATIONS.load(Ordering::SeqCst) - before
}

/// Enough for every worker to have several blocks of lanes, on every instruction set.
const PARTICLES: usize = 160;

/// A camera four metres before the person, looking along +y; the body's up is +z.
fn camera() -> Camera {
    let rotation = DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y).transpose();
    let lens = BrownConrady {
        focal: DVec2::splat(180.0),
        centre: DVec2::new(120.0, 68.0),
        radial: [0.0; 3],
        tangential: [0.0; 2],
    };
    Camera {
        name: "front".into(),
        size: [240, 136],
        camera_from_world: DAffine3::from_mat3_translation(rotation, rotation * DVec3::new(0.0, 4000.0, -900.0)),
        lens: Lens::BrownConrady(lens),
    }
}

/// A program without the test harness, which allocates beside a test that takes long.
fn main() {
    // A run of other tests by name is none of this one.
    if std::env::args().skip(1).any(|word| !word.starts_with('-') && !"an_iteration_allocates_nothing".contains(&word))
    {
        return;
    }
    an_iteration_allocates_nothing();
    println!("test an_iteration_allocates_nothing ... ok");
}

fn an_iteration_allocates_nothing() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), vec![camera(); 4]);
    let mut observation = Observation::empty(240, 136);
    observation.bytes.fill(Observation::SILHOUETTE | 50);
    let observations = vec![observation; 4];
    let objective = Objective::default();
    let space = SearchSpace::of(&body).unwrap();
    let centre: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
    let spread = space.spread(1.0 / 25.0).unwrap();
    let settings =
        SearchSettings { kind: SearchKind::Pso, particles: PARTICLES, iterations: 12, ..SearchSettings::default() };

    let poses = centre.repeat(PARTICLES);
    let mut fitness = vec![0.0; PARTICLES];
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        for (workers, mesh) in [(1, false), (3, false), (1, true), (3, true)] {
            let mut cpu = if mesh {
                Cpu::of_mesh_with(&body, Mesh::of_body(&body).unwrap(), &cameras, set, workers).unwrap()
            } else {
                Cpu::with(&body, &cameras, set, workers).unwrap()
            };
            cpu.observe(&observations).unwrap();
            // From the first batch on: the workers are all there.
            let count = allocations(|| {
                for _ in 0..5 {
                    cpu.fitness(&poses, &objective, &mut fitness).unwrap();
                }
            });
            assert!(fitness[0] > 0.0, "nothing was drawn");
            assert_eq!(count, 0, "fitness of {PARTICLES} poses, {} with {workers} workers, a mesh: {mesh}", set.name());

            let mut search = settings.build(&space).unwrap();
            search.start_frame(0, &centre, &spread).unwrap();
            let mut score = |poses: &[f32], fitness: &mut [f32]| cpu.fitness(poses, &objective, fitness);
            search.iterate(&mut score).unwrap();
            let count = allocations(|| {
                for _ in 1..settings.iterations {
                    search.iterate(&mut score).unwrap();
                }
            });
            assert_eq!(count, 0, "swarm iterations, {} with {workers} workers, a mesh: {mesh}", set.name());
        }
    }

    // The same loop with one small vector an iteration is caught, and so is one in another thread.
    let mut search = settings.build(&space).unwrap();
    search.start_frame(0, &centre, &spread).unwrap();
    let mut score = |poses: &[f32], fitness: &mut [f32]| {
        fitness.copy_from_slice(&vec![poses[0]; fitness.len()]);
        Ok(())
    };
    let count = allocations(|| {
        for _ in 0..settings.iterations {
            search.iterate(&mut score).unwrap();
        }
    });
    assert_eq!(count, settings.iterations, "an iteration that allocates was not counted");
    let started = allocations(|| std::thread::spawn(|| drop(std::hint::black_box(vec![1_u8; 64]))).join().unwrap());
    assert!(started > 0, "what another thread allocates was not counted");
}

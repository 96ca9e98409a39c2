//! The search on whatever Vulkan device there is against the search on the processor, under the validation layer.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use std::time::Instant;

use super::*;
use crate::evaluate::{ScoredBy, Scoring};
use crate::gpu::test_device::{device, device_under};
use crate::gpu::{
    Buffer, Capabilities, Device, DeviceSettings, Groups, Memory, Recorder, StagedBuffer, Validation, by_name,
};
use crate::search::arithmetic::box_muller;
use crate::search::{FilterSettings, Search, SearchKind, philox4x32};

#[allow(
    dead_code,
    missing_docs,
    clippy::unreadable_literal,
    clippy::large_stack_arrays,
    reason = "written by the build"
)]
mod generated {
    include!(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search_tests.rs"));
}
use generated::{random_comp, score_comp};

fn fetch<T: bytemuck::Pod>(device: &Device, buffer: &Buffer) -> Vec<T> {
    let len = buffer.size() as usize / size_of::<T>();
    let seen = device.buffer::<T>("seen", len, Memory::Readback).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    recorder.copy("fetch", (buffer, 0), (&seen, 0), buffer.size()).unwrap();
    recorder.finish().unwrap().run().unwrap();
    let mut values = vec![T::zeroed(); len];
    seen.read(0, &mut values).unwrap();
    values
}

/// What is not a good number, and above which first value of a pose it is given.
#[derive(Clone, Copy)]
pub(super) struct Bad {
    pub(super) from: f32,
    pub(super) value: f32,
}

pub(super) const NOTHING_BAD: Bad = Bad { from: f32::MAX, value: 0.0 };

/// The fitness of `score.comp`.
fn score(pose: &[f32], target: &[f32], bad: Bad) -> f32 {
    if pose[0] > bad.from {
        return bad.value;
    }
    let (mut bowl, mut ripples) = (0.0_f32, 0.0_f32);
    for (x, target) in pose.iter().zip(target) {
        let off = x - target;
        bowl += off * off;
        ripples += (off - off.floor() - 0.5).abs();
    }
    0.9 - bowl * 0.007_812_5 - (0.5 * pose.len() as f32 - ripples) * 0.003_906_25
}

/// An evaluator on the device of that fitness. Its two views' sums are made up from the fitness and the candidate.
struct Scorer {
    device: Device,
    dofs: usize,
    bad: Bad,
    target: StagedBuffer,
    poses: Buffer,
    fitness: Buffer,
    sums: Buffer,
    /// After how many evaluations of a frame which candidate's fitness is another one.
    nudge: Option<(std::cell::Cell<i32>, u32)>,
}

impl Scorer {
    fn new(device: &Device, target: &[f32], bad: Bad) -> Self {
        let buffer = |name: &str, len, memory| device.buffer::<f32>(name, len, memory).unwrap();
        Self {
            device: device.clone(),
            dofs: target.len(),
            bad,
            target: StagedBuffer::new::<f32>(device, "target", target.len()).unwrap(),
            poses: buffer("poses", target.len(), Memory::Device),
            fitness: buffer("fitness", 1, Memory::Device),
            sums: buffer("sums", 8, Memory::Device),
            nudge: None,
        }
    }

    fn observe(&mut self, target: &[f32]) {
        self.target.staging.write(0, target).unwrap();
    }
}

impl DeviceEvaluator for Scorer {
    fn device(&self) -> &Device {
        &self.device
    }
    fn poses(&self) -> &Buffer {
        &self.poses
    }
    fn fitness(&self) -> &Buffer {
        &self.fitness
    }
    fn views(&self) -> usize {
        2
    }
    fn sums(&self) -> &Buffer {
        &self.sums
    }
    fn reserve(&mut self, candidates: u32) -> Result<()> {
        let buffer = |name: &str, len| self.device.buffer::<f32>(name, len * candidates as usize, Memory::Device);
        self.poses = buffer("poses", self.dofs)?;
        self.fitness = buffer("fitness", 1)?;
        self.sums = buffer("sums", 8)?;
        Ok(())
    }
    fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.target.record_upload(recorder)
    }
    fn record_sums(&self, _: &mut Recorder, _: &Objective, _: u32) -> Result<()> {
        Ok(())
    }
    fn scoring(&self, _: &Objective, candidates: u32) -> Result<Scoring<'_>> {
        let push = score_comp::Push {
            candidates,
            dofs: self.dofs as u32,
            bad_from: self.bad.from.to_bits(),
            bad: self.bad.value.to_bits(),
            nudged: self.nudge.as_ref().map_or(u32::MAX, |(left, candidate)| {
                left.set(left.get() - 1);
                if left.get() == 0 { *candidate } else { u32::MAX }
            }),
        };
        let bindings = score_comp::Bindings {
            target: &self.target.buffer,
            positions: &self.poses,
            fitness: &self.fitness,
            sums: &self.sums,
        };
        let dispatch = bindings.dispatch(push, Groups::Over([candidates, 1, 1]));
        Ok(Scoring { by: ScoredBy::Otherwise, dispatch })
    }
}

/// Where limits, steps and target of dimension `d` lie: limits that take part, values from parts of a unit to thousands.
fn space(dofs: usize) -> SearchSpace {
    let centre = |d: usize| if d.is_multiple_of(7) { 2500.0 } else { 0.0 };
    SearchSpace::new(
        (0..dofs).map(|d| centre(d) - 2.0 - d as f32 * 0.01).collect(),
        (0..dofs).map(|d| centre(d) + 3.0).collect(),
        vec![0.5; dofs],
    )
    .and_then(|space| space.grouped((0..dofs).map(|d| d % 4).collect()))
    .unwrap()
}

fn start(dofs: usize) -> Vec<f32> {
    (0..dofs).map(|d| if d.is_multiple_of(7) { 2500.25 } else { 0.3 }).collect()
}

fn target_of(frame: u32, dofs: usize) -> Vec<f32> {
    let wave = |d: usize| ((d * 37 + 11 * frame as usize) % 64) as f32 / 32.0 - 1.0;
    start(dofs).iter().enumerate().map(|(d, x)| x + wave(d)).collect()
}

pub(super) fn settings(kind: SearchKind, particles: usize, iterations: usize) -> SearchSettings {
    let filter = FilterSettings { sigma: 0.1 };
    SearchSettings { kind, particles, iterations, seed: 0x0123_4567_89AB_CDEF, filter, ..SearchSettings::default() }
}

/// A frame's search by the processor, with the swarm's best fitness after each iteration.
fn on_the_processor(
    search: &mut dyn Search,
    frame: u32,
    centre: &[f32],
    spread: &[f32],
    bad: Bad,
) -> Result<(Estimate, Vec<f32>)> {
    let (dofs, target) = (centre.len(), target_of(frame, centre.len()));
    let mut best = Vec::new();
    let found = search.search_frame(frame, centre, spread, &mut |poses, fitness| {
        for (pose, fitness) in poses.chunks_exact(dofs).zip(fitness.iter_mut()) {
            *fitness = score(pose, &target, bad);
        }
        let now = fitness.iter().copied().filter(|f| f.is_finite()).fold(f32::NAN, f32::max);
        best.push(best.last().copied().unwrap_or(f32::NAN).max(now));
        Ok(())
    })?;
    if ["pf", "apf", "maes"].contains(&search.name()) {
        best.clear();
    }
    Ok((found, best))
}

/// What differs between a device's frames and the processor's, in words; none when nothing does.
pub(super) fn difference(
    device: &Device,
    settings: &SearchSettings,
    dofs: usize,
    bad: Bad,
    nudge: Option<(i32, u32)>,
) -> Option<String> {
    let space = space(dofs);
    let mut scorer = Scorer::new(device, &target_of(0, dofs), bad);
    scorer.nudge = nudge.map(|(batch, candidate)| (std::cell::Cell::new(batch), candidate));
    let mut there = DeviceSearch::new(&mut scorer, &Objective::default(), settings, &space, Timing::Off).unwrap();
    let mut here = settings.build(&space).unwrap();
    let spread = space.spread(0.04).unwrap();
    let mut centre = start(dofs);
    for frame in 7..10 {
        scorer.observe(&target_of(frame, dofs));
        let found = there.search_frame(frame, &centre, &spread).unwrap();
        let (expected, best) = on_the_processor(here.as_mut(), frame, &centre, &spread, bad).unwrap();
        let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        for (name, found, expected) in [
            ("fitness", &[found.estimate.fitness][..], &[expected.fitness][..]),
            ("best", &found.best, &best),
            ("pose", &found.estimate.pose, &expected.pose),
            ("spread", &found.estimate.spread, &expected.spread),
        ] {
            let odd = bits(found).iter().zip(bits(expected)).position(|(a, b)| *a != b);
            if odd.is_some() || found.len() != expected.len() {
                let place = odd.unwrap_or(0);
                return Some(format!("frame {frame}, {name} {place}: {found:?} for {expected:?}"));
            }
        }
        assert_eq!(found.estimate.evaluations, expected.evaluations);
        let [first, second] = [found.sums[0], found.sums[1]];
        assert_eq!([first[0], second[1]], [expected.fitness.to_bits(); 2], "the sums are the best pose's");
        assert_eq!((first[1], &first[2..], &second[2..]), (second[0], &[2, 3][..], &[5, 6][..]));
        centre = expected.pose;
    }
    None
}

/// The searches that run whole on a device.
fn on_devices() -> impl Iterator<Item = SearchKind> {
    SearchKind::ALL.into_iter().filter(|kind| kind.has_device_form())
}

#[test]
fn blocks_and_normals_are_the_processor_s() {
    let Some((device, log)) = device("blocks_and_normals_are_the_processor_s", DeviceSettings::default()) else {
        return;
    };
    let key = [0x89AB_CDEF, 0x0123_4567];
    let mut counters = vec![[0; 4], [u32::MAX; 4], [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344]];
    for i in 0..20_000_u32 {
        counters.push([i % 700, ((i % 4) << 24) | (i % 129), i / 1000, i.wrapping_mul(2_654_435_769)]);
    }
    let staging = device.buffer::<[u32; 4]>("counters", counters.len(), Memory::Upload).unwrap();
    staging.write(0, &counters).unwrap();
    let words = device.buffer::<[u32; 4]>("words", counters.len(), Memory::Device).unwrap();
    let normals = device.buffer::<[f32; 4]>("normals", counters.len(), Memory::Device).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    let push = random_comp::Push { count: counters.len() as u32, key_low: key[0], key_high: key[1] };
    let bindings = random_comp::Bindings { counters: &staging, words: &words, normals: &normals };
    recorder.run(bindings.dispatch(push, Groups::Over([counters.len() as u32, 1, 1]))).unwrap();
    recorder.finish().unwrap().run().unwrap();

    let expected: Vec<[u32; 4]> = counters.iter().map(|counter| philox4x32(*counter, key)).collect();
    let found: Vec<[u32; 4]> = fetch(&device, &words);
    assert_eq!(found.iter().zip(&expected).position(|(a, b)| a != b), None, "blocks");
    let found: Vec<[u32; 4]> = fetch(&device, &normals);
    for (index, (found, [a, b, c, d])) in found.iter().zip(expected).enumerate() {
        let [first, second] = [box_muller(a, b), box_muller(c, d)];
        let expected = [first.0, first.1, second.0, second.1].map(f32::to_bits);
        assert_eq!(*found, expected, "normals of block {index}");
    }
    drop((staging, words, normals, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn the_device_finds_what_the_processor_finds_to_the_bit() {
    let Some((device, log)) = device("the_device_finds_what_the_processor_finds", DeviceSettings::default()) else {
        return;
    };
    // One of everything, counts around the sizes of workgroups and lanes, and poses of one to four groups of random numbers.
    let cases = [
        (1, 1, 1),
        (1, 5, 31),
        (2, 2, 3),
        (63, 4, 33),
        (64, 15, 31),
        (65, 3, 32),
        (257, 6, 8),
        (300, 15, 31),
        (41, 5, 127),
        (1000, 3, 65),
    ];
    for kind in on_devices() {
        for (particles, iterations, dofs) in cases {
            let settings = settings(kind, particles, iterations);
            let odd = difference(&device, &settings, dofs, NOTHING_BAD, None);
            assert_eq!(odd, None, "{kind:?}: {particles} particles, {iterations} iterations, {dofs} values");
        }
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// Vulkan promises workgroups of 128 and no more.
#[test]
fn on_the_smallest_workgroups_a_search_runs_or_says_that_it_does_not_fit() {
    let lower: fn(&mut Capabilities) = |capabilities| capabilities.max_workgroup = 128;
    let settings_of = |kind| settings(kind, 300, 4);
    let lowered = DeviceSettings { lower: Some(lower), ..DeviceSettings::default() };
    let Some((device, log)) = device("on_the_smallest_workgroups", lowered) else { return };
    let fitting: Vec<SearchKind> = on_devices().filter(|kind| kind.fits(&device)).collect();
    assert_eq!(fitting, [SearchKind::MaEs]);
    for kind in on_devices() {
        if fitting.contains(&kind) {
            assert_eq!(difference(&device, &settings_of(kind), 31, NOTHING_BAD, None), None, "{kind:?}");
        } else {
            let mut scorer = Scorer::new(&device, &target_of(3, 31), NOTHING_BAD);
            let made =
                DeviceSearch::new(&mut scorer, &Objective::default(), &settings_of(kind), &space(31), Timing::Off);
            let error = format!("{:#}", made.err().unwrap());
            assert!(error.contains("wants workgroups of 256, and this device allows 128"), "{kind:?}: {error}");
        }
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn what_is_not_a_number_never_wins_there_either() {
    let Some((device, log)) = device("what_is_not_a_number_never_wins_there_either", DeviceSettings::default()) else {
        return;
    };
    for kind in on_devices() {
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.0, f32::MAX, f32::MIN] {
            // Filters weigh by the distance from 1, which a large fitness loses.
            if matches!(kind, SearchKind::ParticleFilter | SearchKind::Annealed) && value.abs() == f32::MAX {
                continue;
            }
            let odd = difference(&device, &settings(kind, 70, 5), 5, Bad { from: 2500.1, value }, None);
            assert_eq!(odd, None, "{kind:?} with {value}");
        }
        let dofs = 3;
        let mut scorer = Scorer::new(&device, &target_of(0, dofs), Bad { from: f32::MIN, value: f32::NAN });
        let settings = settings(kind, 40, 5);
        let mut search =
            DeviceSearch::new(&mut scorer, &Objective::default(), &settings, &space(dofs), Timing::Off).unwrap();
        let error = search.search_frame(1, &start(dofs), &[0.5; 3]).unwrap_err().to_string();
        assert_eq!(error, "none of the 200 poses of frame 1 has a finite fitness");
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn one_changed_number_is_noticed() {
    let Some((device, _)) = device_under(Validation::Off, "one_changed_number_is_noticed", DeviceSettings::default())
    else {
        return;
    };
    for kind in on_devices() {
        // Of a level of several only the best pose lives on, so there the last level's second batch is changed.
        let batch = if kind == SearchKind::Hierarchical { 11 } else { 2 };
        // An evolution scores a generation at a time.
        let last = if kind == SearchKind::MaEs { 49 } else { 299 };
        for candidate in [0, 17, last] {
            let odd = difference(&device, &settings(kind, 300, 15), 31, NOTHING_BAD, Some((batch, candidate)));
            assert!(
                odd.is_some(),
                "{kind:?}: the fitness {candidate} of batch {batch} was another, and nothing differs"
            );
        }
    }
}

#[test]
fn frames_repeat_and_misuse_has_its_sentence() {
    let Some((device, log)) = device("frames_repeat_and_misuse_has_its_sentence", DeviceSettings::default()) else {
        return;
    };
    let (dofs, space) = (5, space(5));
    let mut scorer = Scorer::new(&device, &target_of(3, dofs), NOTHING_BAD);
    let objective = Objective::default();
    for kind in on_devices() {
        let mut make =
            |settings: SearchSettings| DeviceSearch::new(&mut scorer, &objective, &settings, &space, Timing::Off);
        let mut search = make(settings(kind, 70, 4)).unwrap();
        assert_eq!(search.name(), kind.name());
        let centre = start(dofs);
        let first = search.search_frame(3, &centre, &[0.5; 5]).unwrap();
        assert_eq!(search.search_frame(3, &centre, &[0.5; 5]).unwrap(), first);
        assert_ne!(search.search_frame(4, &centre, &[0.5; 5]).unwrap(), first, "another frame");
        let mut other = make(SearchSettings { seed: 2, ..settings(kind, 70, 4) }).unwrap();
        assert_ne!(other.search_frame(3, &centre, &[0.5; 5]).unwrap(), first, "another seed");
        for (centre, spread, sentence) in [
            (vec![0.0], vec![1.0; 5], "centre has 1 values, expected 5"),
            (vec![f32::NAN; 5], vec![1.0; 5], "centre is NaN at index 0"),
            (vec![0.0; 5], vec![-1.0; 5], "spread is -1 at index 0"),
        ] {
            let error = search.search_frame(3, &centre, &spread).unwrap_err().to_string();
            assert!(error.contains(sentence), "{error}");
        }
        let error = |settings: SearchSettings, make: &mut dyn FnMut(SearchSettings) -> Result<DeviceSearch>| {
            format!("{:#}", make(settings).err().unwrap())
        };
        let none = error(settings(kind, 0, 4), &mut make);
        assert!(none.contains("particles is 0"), "{none}");
        drop((search, other));
    }
    drop((scorer, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// Without validation, which takes a minute to follow so many passes.
#[test]
fn a_frame_of_too_many_passes_is_refused() {
    let name = "a_frame_of_too_many_passes_is_refused";
    let Some((device, _)) = device_under(Validation::Off, name, DeviceSettings::default()) else { return };
    let mut scorer = Scorer::new(&device, &target_of(3, 5), NOTHING_BAD);
    for kind in on_devices() {
        let settings = settings(kind, 3, 9000);
        let made = DeviceSearch::new(&mut scorer, &Objective::default(), &settings, &space(5), Timing::Off);
        let many = format!("{:#}", made.err().unwrap());
        assert!(many.contains("3 particles and 9000 iterations") && many.contains("16384 passes"), "{many}");
    }
}

/// Run by hand: `cargo test --release time_of_a_frame -- --ignored --nocapture`.
#[test]
#[ignore = "measures"]
fn time_of_a_frame() {
    let Some((device, _)) = device_under(Validation::Off, "time_of_a_frame", DeviceSettings::default()) else { return };
    let dofs = 31;
    let (space, centre) = (space(dofs), start(dofs));
    let spread = space.spread(0.04).unwrap();
    let objective = Objective::default();
    for kind in on_devices() {
        let settings = settings(kind, 512, 15);
        let mut scorer = Scorer::new(&device, &target_of(3, dofs), NOTHING_BAD);
        let begin = Instant::now();
        let mut search = DeviceSearch::new(&mut scorer, &objective, &settings, &space, Timing::Stamps).unwrap();
        println!("{kind:?}: made in {:.1} ms", begin.elapsed().as_secs_f64() * 1e3);
        let mut timed = DeviceSearch::new(&mut scorer, &objective, &settings, &space, Timing::Off).unwrap();
        let mut times = Vec::new();
        for frame in 0..30 {
            search.search_frame(frame, &centre, &spread).unwrap();
            let begin = Instant::now();
            timed.search_frame(frame, &centre, &spread).unwrap();
            times.push(begin.elapsed().as_secs_f64() * 1e3);
        }
        times.sort_by(f64::total_cmp);
        println!("  a frame in one submission: median {:.3} ms", times[times.len() / 2]);
        for (name, ms, count) in by_name(&search.timings().unwrap()) {
            println!("    {name:10} {count:3} x, {ms:.3} ms");
        }
        // The same evaluator, with the search on the processor and a submission a batch.
        scorer.reserve(512).unwrap();
        let staging = device.buffer::<f32>("poses staging", 512 * dofs, Memory::Upload).unwrap();
        let seen = device.buffer::<f32>("fitness seen", 512, Memory::Readback).unwrap();
        let record = |candidates: usize| {
            let mut recorder = device.recorder(Timing::Off).unwrap();
            scorer.record_upload(&mut recorder).unwrap();
            let bytes = (4 * candidates * dofs) as u64;
            recorder.copy("poses", (&staging, 0), (&scorer.poses, 0), bytes).unwrap();
            scorer.record(&mut recorder, &objective, candidates as u32).unwrap();
            recorder.copy("fitness", (&scorer.fitness, 0), (&seen, 0), 4 * candidates as u64).unwrap();
            recorder.finish().unwrap()
        };
        let (mut batch, mut one) = (record(512), record(1));
        let mut host = settings.build(&space).unwrap();
        let mut times = Vec::new();
        for frame in 0..30 {
            let begin = Instant::now();
            host.search_frame(frame, &centre, &spread, &mut |poses, fitness| {
                staging.write(0, poses)?;
                if fitness.len() == 1 {
                    one.run()?
                } else {
                    batch.run()?
                }
                seen.read(0, fitness)
            })
            .unwrap();
            times.push(begin.elapsed().as_secs_f64() * 1e3);
        }
        times.sort_by(f64::total_cmp);
        println!("  driven by the host: median {:.3} ms", times[times.len() / 2]);
    }
}

//! What comes behind the drawing, in one pass or in one each: the processor's bits in every form, and how many passes and barriers.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use glam::{DVec2, DVec3};

use super::DeviceSearch;
use super::tests::{Bad, NOTHING_BAD, difference, settings};
use crate::body::Body;
use crate::evaluate::device::Compute;
use crate::evaluate::{Evaluator, Objective, ObjectiveKind};
use crate::geometry::{BrownConrady, Camera, Lens};
use crate::gpu::test_device::{device, device_under};
use crate::gpu::{Capabilities, Device, DeviceSettings, Timing, Validation};
use crate::search::{MatrixSettings, SearchKind, SearchSettings, SearchSpace};

type Lower = fn(&mut Capabilities);

/// How a device is taken to be, and what becomes of a search there.
const FORMS: [(&str, Lower); 4] = [
    ("one pass in one workgroup", |it| it.wide = false),
    ("one pass, as on a card", |it| it.wide = true),
    ("a pass each for want of buffers", |it| (it.wide, it.stage_buffers) = (false, 11)),
    ("a pass each for want of shared memory", |it| (it.wide, it.shared_memory) = (true, 2000)),
];

fn taken_for(lower: Lower) -> DeviceSettings {
    DeviceSettings { lower: Some(lower), ..DeviceSettings::default() }
}

/// The searches that have such stages.
const KINDS: [SearchKind; 3] = [SearchKind::Pso, SearchKind::Hierarchical, SearchKind::MaEs];

#[test]
fn every_form_finds_what_the_processor_finds_to_the_bit() {
    for (form, lower) in FORMS {
        let name = "every_form_finds_what_the_processor_finds";
        let Some((device, log)) = device(name, taken_for(lower)) else { return };
        for kind in KINDS {
            // Counts around the shares of workgroups, and more degrees of freedom than a generation is learnt from in one pass.
            for (particles, iterations, dofs) in
                [(1, 1, 1), (2, 2, 3), (33, 4, 32), (300, 8, 31), (1100, 2, 5), (41, 2, 300)]
            {
                let odd = difference(&device, &settings(kind, particles, iterations), dofs, NOTHING_BAD, None);
                assert_eq!(
                    odd, None,
                    "{form}, {kind:?}: {particles} particles, {iterations} iterations, {dofs} values"
                );
            }
            for value in [f32::NAN, f32::INFINITY, -0.0] {
                let odd = difference(&device, &settings(kind, 70, 4), 5, Bad { from: 2500.1, value }, None);
                assert_eq!(odd, None, "{form}, {kind:?} with {value}");
            }
        }
        // More samples than a generation is learnt from in one pass, and as many.
        for generation in [256, 257] {
            let matrix = MatrixSettings { generation, ..MatrixSettings::default() };
            let settings = SearchSettings { matrix, ..settings(SearchKind::MaEs, generation, 3) };
            let odd = difference(&device, &settings, 31, NOTHING_BAD, None);
            assert_eq!(odd, None, "{form}: {generation} samples");
        }
        drop(device);
        assert_eq!(log.messages(), Vec::<String>::new(), "{form}");
    }
}

#[test]
fn one_changed_number_is_noticed_in_every_form() {
    for (form, lower) in FORMS {
        let name = "one_changed_number_is_noticed_in_every_form";
        let Some((device, _)) = device_under(Validation::Off, name, taken_for(lower)) else { return };
        for kind in KINDS {
            let batch = if kind == SearchKind::Hierarchical { 11 } else { 2 };
            let odd = difference(&device, &settings(kind, 300, 15), 31, NOTHING_BAD, Some((batch, 17)));
            assert!(odd.is_some(), "{form}, {kind:?}: a fitness of batch {batch} was another, and nothing differs");
        }
    }
}

fn cameras() -> Vec<Camera> {
    let (focal, centre) = (DVec2::splat(60.0), DVec2::new(32.0, 24.0));
    let lens = BrownConrady { focal, centre, radial: [0.0; 3], tangential: [0.0; 2] };
    let down = DVec3::new(-1.5, 0.0, 0.0);
    [3000.0, 4000.0]
        .map(|away| {
            let lens = Lens::BrownConrady(lens);
            Camera::from_rodrigues("a", [64, 48], lens, down, DVec3::new(0.0, 900.0, away))
        })
        .to_vec()
}

/// Passes, with their names, and barriers that one iteration more takes.
fn of_an_iteration(device: &Device, kind: SearchKind) -> (Vec<String>, usize) {
    let body = Body::adult(1750.0).unwrap();
    let space = SearchSpace::of(&body).unwrap();
    let mut compute = Compute::on(device, &body, &cameras()).unwrap();
    let [(passes, barriers), (more, more_barriers)] = [4, 5].map(|iterations| {
        let settings = SearchSettings { kind, particles: 50, iterations, ..SearchSettings::default() };
        let objective = Objective::of(ObjectiveKind::Sp);
        let evaluator = compute.on_device().unwrap();
        let search = DeviceSearch::new(evaluator, &objective, &settings, &space, Timing::Off).unwrap();
        (search.recording.passes().to_vec(), search.recording.barriers())
    });
    let first = passes.iter().position(|pass| pass.starts_with("pose")).unwrap();
    (more[first..first + more.len() - passes.len()].to_vec(), more_barriers - barriers)
}

/// With the passes before and behind the drawing, and the drawing's own.
#[test]
fn an_iteration_has_as_few_passes_and_barriers() {
    let name = "an_iteration_has_as_few_passes_and_barriers";
    let [one, card, each, _] = FORMS.map(|(_, lower)| lower);
    let as_before: Lower = |it| (it.wide, it.stage_buffers) = (true, 11);
    let swarm = "best,move";
    let evolution = "rank,follow,turn,sample";
    for (lower, drawing, kind, behind) in [
        (card, "pose_project,raster", SearchKind::Pso, "advance_objective".to_string()),
        (as_before, "pose_project,raster", SearchKind::Pso, format!("objective,{swarm}")),
        (one, "pose,project,raster", SearchKind::Pso, "advance_objective".to_string()),
        (each, "pose,project,raster", SearchKind::Pso, format!("objective,{swarm}")),
        (card, "pose_project,raster", SearchKind::MaEs, "learn_objective,sample".to_string()),
        (as_before, "pose_project,raster", SearchKind::MaEs, format!("objective,{evolution}")),
        (one, "pose,project,raster", SearchKind::MaEs, "learn_objective,sample".to_string()),
        (each, "pose,project,raster", SearchKind::MaEs, format!("objective,{evolution}")),
    ] {
        let Some((device, _)) = device_under(Validation::Off, name, taken_for(lower)) else { return };
        let (passes, barriers) = of_an_iteration(&device, kind);
        println!("{kind:?}: {} passes and {barriers} barriers: {}", passes.len(), passes.join(", "));
        assert_eq!(passes.join(","), format!("{drawing},{behind}"), "{kind:?}");
        assert_eq!(barriers, passes.len(), "{kind:?}: each waits for the one before, and for none else");
    }
}

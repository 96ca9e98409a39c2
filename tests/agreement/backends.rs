//! The backends, each with all its variants, held to the reference in every case.

use pantin::evaluate::Evaluator;
use pantin::evaluate::cpu::{Cpu, InstructionSet};
use pantin::evaluate::device::{Compute, Graphics, RasterKernel, RowWay, Shared};
use pantin::gpu::{Capabilities, DeviceSettings};

use crate::cases::{CASES, Case, Kind, Stage, USUAL};
use crate::device::device;
use crate::found::{assert_fitness, found};
use crate::scene;

/// Makes an evaluator.
type Make<'a> = &'a dyn Fn(&Stage) -> Box<dyn Evaluator>;

/// Holds a backend to the reference in all cases, one evaluator for the cases of a stage: what was seen before leaves no trace.
fn hold(kind: Kind, name: &str, make: Make<'_>) {
    hold_where(|_| true, kind, name, make);
}

/// In those cases that it takes.
fn hold_where(takes: impl Fn(&Case) -> bool, kind: Kind, name: &str, make: Make<'_>) {
    let mut evaluator: Option<(*const Stage, Box<dyn Evaluator>)> = None;
    for case in CASES.iter().filter(|case| !case.poses(kind).is_empty() && takes(case)) {
        let stage: *const Stage = case.stage;
        let (_, evaluator) = match &mut evaluator {
            Some(made) if made.0 == stage => made,
            other => other.insert((stage, make(case.stage))),
        };
        hold_in(case, kind, name, evaluator.as_mut());
    }
}

/// Holds an evaluator to the reference in a case.
fn hold_in(case: &Case, kind: Kind, name: &str, evaluator: &mut dyn Evaluator) {
    let (poses, dofs) = (case.poses(kind), case.stage.body.dof_count());
    let expected = case.expected(poses);
    let what = format!("{name}, {}", case.name);
    // On a device again: what was recorded first gives the same the second time, and tiles fit what was drawn.
    let rounds = if evaluator.on_device().is_some() { 2 } else { 1 };
    for round in 0..rounds {
        let found = found(evaluator, &case.seen, poses);
        assert_eq!(expected.difference(&found), None, "{what}, round {round}");
    }
    let few = &poses[..poses.len().min(FITNESS * dofs)];
    for _ in 0..rounds {
        assert_fitness(evaluator, &case.expected(few), &case.seen, few, &what);
    }
    // One pixel otherwise shows, and so does one pose.
    let few = &poses[..poses.len().min(20 * dofs)];
    let expected = case.expected(few);
    let changed = found(evaluator, &case.changed, few);
    assert!(expected.difference(&changed).is_some(), "{what}: a changed pixel passed");
    if case.seen[0].segmentation.is_some() || case.seen[0].evidence.is_some() {
        assert!(expected.components == changed.components, "{what}: whole silhouettes are what they were");
    }
    if !expected.evidence.is_empty() {
        let by_one = expected.evidence.iter().zip(&changed.evidence).filter(|(a, b)| a.abs_diff(**b) == 1).count();
        assert!(by_one > 0, "{what}: a sum is one more or less");
    }
    let mut moved = few.to_vec();
    moved[0] += 40.0;
    let views = case.stage.cameras.len();
    let difference =
        scene::first_difference(views, &expected.components, &found(evaluator, &case.seen, &moved).components);
    assert!(difference.is_some_and(|text| text.starts_with("pose 0, ")), "{what}: a moved pose passed");
}

/// Poses whose fitness is compared.
const FITNESS: usize = 100;

#[test]
fn every_instruction_set_agrees() {
    for set in InstructionSet::ALL {
        if !set.is_available() {
            println!("SKIPPED {}: this processor does not have it", set.name());
            continue;
        }
        for workers in [1, 2, 3] {
            let make = |Stage { body, cameras }: &Stage| -> Box<dyn Evaluator> {
                Box::new(Cpu::with(body, cameras, set, workers).unwrap())
            };
            // How the work is shared out does not depend on who is seen.
            let takes = |case: &Case| workers == 2 || std::ptr::eq(case.stage, &*USUAL);
            hold_where(takes, Kind::Processor, &format!("{} with {workers} workers", set.name()), &make);
        }
    }
}

/// Lowers what a device can do.
type Lower = fn(&mut Capabilities);

/// Limits of a device, lowered so far that poses go in batches, and a device without subgroup operations.
pub(crate) const LOWERED: [(&str, Kind, Lower); 4] = [
    ("little storage", Kind::Small, |c| c.max_storage = 200_000),
    ("few groups", Kind::Batched, |c| c.max_groups = 64),
    ("little memory", Kind::Small, |c| c.memory = 900_000),
    ("no subgroups", Kind::Small, |c| (c.subgroup_arithmetic, c.subgroup_shuffle) = (false, false)),
];

#[test]
fn compute_agrees() {
    let whole: Lower = |_| ();
    for (name, kind, lower) in [("as it is", Kind::Compute, whole)].into_iter().chain(LOWERED) {
        let settings = DeviceSettings { lower: Some(lower), ..DeviceSettings::default() };
        let Some((device, log)) = device("compute_agrees", settings) else { return };
        let make = |Stage { body, cameras }: &Stage| -> Box<dyn Evaluator> {
            Box::new(Compute::on(&device, body, cameras).unwrap())
        };
        hold(kind, &format!("compute, {name}"), &make);
        // All strips by a workgroup, and some workgroups to share them, whole subgroups and not; other rows and words at once.
        let kernel = match name {
            "as it is" => Some(RasterKernel::Spans { group: 64, workgroups: 1 }),
            "few groups" => Some(RasterKernel::Spans { group: 20, workgroups: 40 }),
            "little memory" => Some(RasterKernel::Rows(RowWay { group: 64, words: 4, keeps_edges: true })),
            "no subgroups" => Some(RasterKernel::Rows(RowWay { group: 16, words: 2, keeps_edges: false })),
            _ => None,
        };
        if let Some(kernel) = kernel {
            let make = |Stage { body, cameras }: &Stage| -> Box<dyn Evaluator> {
                Box::new(Compute::with_kernel(&device, body, cameras, kernel).unwrap())
            };
            hold(kind, &format!("compute, {name}, {kernel}"), &make);
        }
        drop(device);
        assert_eq!(log.messages(), Vec::<String>::new(), "{name}");
    }
}

#[test]
fn graphics_agrees() {
    let Some((device, log)) = device("graphics_agrees", DeviceSettings::default()) else { return };
    for settings in scene::graphics_settings() {
        let make = |Stage { body, cameras }: &Stage| -> Box<dyn Evaluator> {
            Box::new(Graphics::on(&device, body, cameras, settings).unwrap())
        };
        hold(Kind::Graphics, &format!("graphics, {settings:?}"), &make);
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// Devices that share the candidates, by backends that need not be the same, as one.
#[test]
fn devices_that_share_agree() {
    let open = || device("devices_that_share_agree", DeviceSettings::default());
    let (Some((first, log)), Some((second, other_log))) = (open(), open()) else { return };
    let make = |Stage { body, cameras }: &Stage| -> Box<dyn Evaluator> {
        let spans = RasterKernel::Spans { group: 64, workgroups: 2 };
        let members: Vec<Box<dyn Evaluator>> = vec![
            Box::new(Compute::on(&first, body, cameras).unwrap()),
            Box::new(Compute::with_kernel(&second, body, cameras, spans).unwrap()),
        ];
        Box::new(Shared::new(members).unwrap())
    };
    hold(Kind::Batched, "two devices", &make);
    drop((first, second));
    assert_eq!([log, other_log].map(|log| log.messages()), [const { Vec::<String>::new() }; 2]);
}

/// The table fails where a backend draws one end of one part some millimetres off.
#[test]
#[should_panic(expected = "bent, silhouettes in part, round 0")]
fn a_backend_that_draws_otherwise_is_caught() {
    let make = |Stage { body, cameras }: &Stage| -> Box<dyn Evaluator> {
        let mut bent = body.clone();
        bent.parts[3].b.x += 15.0;
        Box::new(Cpu::new(&bent, cameras).unwrap())
    };
    hold(Kind::Processor, "bent", &make);
}

//! What is ignored, by the definition; poses that are no numbers and observations that do not fit, on the processor.

use std::sync::Arc;

use pantin::evaluate::cpu::{Cpu, InstructionSet};
use pantin::evaluate::{Components, Evaluator as _, Objective, Reference};
use pantin::features::{BitImage, Observation};

use crate::cases::{Kind, Stage, USUAL, case};
use crate::scene::{Random, evaluate, first_difference, observations};

/// And one pixel more that counts shows.
#[test]
fn what_is_ignored_counts_neither_for_nor_against() {
    let (in_part, all) = (case("silhouettes in part"), case("silhouettes"));
    let Stage { body, cameras } = in_part.stage;
    let poses = in_part.poses(Kind::Processor);
    let dofs = body.dof_count();
    let mut reference = Reference::new(body, cameras);
    let (expected, everywhere) = (in_part.expected(poses).components, all.expected(poses).components);
    let mut fewer = 0;
    for (image, sums) in expected.iter().enumerate() {
        let (pose, view) = (&poses[image / 4 * dofs..][..dofs], image % 4);
        let mut defined = Components::default();
        let drawn = reference.draw(pose, view);
        for at in (0..drawn.bytes.len()).filter(|&at| !in_part.seen[view].ignores(at)) {
            let (drawn, seen) = (drawn.bytes[at], all.seen[view].bytes[at]);
            defined.area_obs += u32::from(seen >> 7);
            defined.area_model += u32::from(drawn != 0);
            defined.overlap += u32::from(seen >> 7) * u32::from(drawn != 0);
            defined.edges += u32::from(drawn >> 7);
            defined.proximity += u32::from(drawn >> 7) * u32::from(seen & 0x7f);
        }
        assert_eq!(*sums, defined, "image {image}");
        fewer += usize::from(sums.area_model < everywhere[image].area_model);
    }
    assert!(fewer > 100, "only {fewer} images reach what is ignored");
    let mut seen = in_part.seen.clone();
    let mut ignored = seen[0].ignored.take().unwrap();
    let drawn = poses.chunks_exact(dofs).map(|pose| reference.draw(pose, 0));
    let at = drawn
        .flat_map(|image| image.bytes.into_iter().enumerate().collect::<Vec<_>>())
        .filter(|(_, byte)| *byte != 0)
        .map(|(at, _)| [at as u32 % cameras[0].size[0], at as u32 / cameras[0].size[0]])
        .find(|&[x, y]| ignored.get(x, y));
    let [x, y] = at.unwrap();
    Arc::make_mut(&mut ignored).set(x, y, false);
    seen[0].ignored = Some(ignored);
    let found = evaluate(&mut Cpu::new(body, cameras).unwrap(), &seen, poses);
    assert!(first_difference(4, &expected, &found).is_some(), "a pixel that counts again passed");
    reference.observe(&seen).unwrap();
    assert_eq!(first_difference(4, &evaluate(&mut reference, &seen, poses), &found), None);
}

/// One end of one part, moved by a few millimetres.
#[test]
fn a_changed_vertex_is_caught() {
    let case = case("silhouettes");
    let Stage { body, cameras } = case.stage;
    let poses = &case.poses(Kind::Processor)[..40 * body.dof_count()];
    let mut bent = body.clone();
    bent.parts[3].b.x += 15.0;
    let mut cpu = Cpu::new(&bent, cameras).unwrap();
    let found = evaluate(&mut cpu, &case.seen, poses);
    assert!(first_difference(4, &case.expected(poses).components, &found).is_some(), "a moved vertex passed");
}

#[test]
fn poses_that_are_no_numbers_do_no_harm() {
    let Stage { body, cameras } = &*USUAL;
    let mut random = Random(11);
    let seen = observations(cameras, &mut random);
    let mut poses = Vec::new();
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30, f32::MAX, f32::MIN_POSITIVE] {
        poses.extend(vec![value; body.dof_count()]);
    }
    let expected = evaluate(&mut Reference::new(body, cameras), &seen, &poses);
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        let found = evaluate(&mut Cpu::with(body, cameras, set, 1).unwrap(), &seen, &poses);
        assert_eq!(first_difference(4, &expected, &found), None, "{}", set.name());
    }
}

#[test]
fn misfits_are_named() {
    let Stage { body, cameras } = &*USUAL;
    let mut cpu = Cpu::new(body, cameras).unwrap();
    let error = cpu.observe(&[Observation::empty(131, 97)]).unwrap_err().to_string();
    assert!(error.contains("1 observations for 4 views"), "{error}");
    let mut wrong: Vec<_> = cameras.iter().map(|c| Observation::empty(c.size[0], c.size[1])).collect();
    wrong[1].ignored = Some(Arc::new(BitImage::new(48, 64)));
    let error = cpu.observe(&wrong).unwrap_err().to_string();
    assert_eq!(error, "the ignored pixels of view 1 are 48x64, its observation is 64x48");
    wrong[1].ignored = None;
    wrong[2] = Observation::empty(10, 10);
    let error = cpu.observe(&wrong).unwrap_err().to_string();
    assert!(error.contains("view 2 is 10x10") && error.contains("141x105"), "{error}");
    let error = cpu.fitness(&[0.0; 30], &Objective::default(), &mut [0.0]).unwrap_err().to_string();
    assert!(error.contains("30 values") && error.contains("31"), "{error}");
}

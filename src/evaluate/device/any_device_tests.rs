//! What any device must give, on one that is as inexact as Vulkan lets it be (`gpu/rough.rs`): the reference's corners, sums and
//! fitness, to the bit.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use std::path::Path;
use std::sync::LazyLock;

use super::tests::{cameras, device, fetch, poses, projected, recorded_fitness};
use super::{Comparison, Compute, Gathering, Graphics, GraphicsSettings, Packing};
use crate::body::Body;
use crate::evaluate::cpu::Cpu;
use crate::evaluate::device_evaluator::DeviceEvaluator;
use crate::evaluate::shaders::layout;
use crate::evaluate::{Components, Evaluator, Objective, ObjectiveKind};
use crate::features::Observation;
use crate::gpu::rough::rough;
use crate::gpu::shaders::compile::compile;
use crate::gpu::{Capabilities, DeviceSettings};

const GLSL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/glsl");

/// The poses that the whole proof is over.
const POSES: usize = 10_000;

/// A device as inexact as may be.
fn inexact() -> DeviceSettings {
    DeviceSettings { code: Some(rough), ..DeviceSettings::default() }
}

/// The shaders with quotients and roots as a device gives them.
static UNCORRECTED: LazyLock<tempfile::TempDir> = LazyLock::new(|| {
    fn copy(from: &Path, to: &Path) {
        std::fs::create_dir_all(to).unwrap();
        for entry in std::fs::read_dir(from).unwrap() {
            let entry = entry.unwrap();
            let (own, copied) = (entry.path(), to.join(entry.file_name()));
            if own.is_dir() {
                copy(&own, &copied);
            } else {
                std::fs::copy(&own, &copied).unwrap();
            }
        }
    }
    let folder = tempfile::tempdir().unwrap();
    copy(Path::new(GLSL), folder.path());
    let plain = "float quotient(float a, float b) {\n    return a / b;\n}\n\n\
        float square_root(float a) {\n    return sqrt(a);\n}\n";
    std::fs::write(folder.path().join("arithmetic/rounding.glsl"), plain).unwrap();
    folder
});

fn uncorrected_and_rough(name: &str, spirv: &[u32]) -> Vec<u32> {
    rough(name, &uncorrected(name, spirv))
}

fn uncorrected(name: &str, _spirv: &[u32]) -> Vec<u32> {
    compile(UNCORRECTED.path(), name).unwrap().spirv
}

/// How many corners there are, and how many of them are not the reference's; those of a part in another place of the order, or of
/// another depth, are not.
fn corners_off(settings: DeviceSettings, count: usize) -> Option<(usize, usize)> {
    let (device, log) = device("corners_off", settings)?;
    let body = Body::adult(1750.0).unwrap();
    let poses = poses(&body, count);
    let (projector, scene, workspace, _) = projected(&device, &body, &poses);
    let (views, parts) = (projector.view_count(), body.parts.len());
    let images = count * views;
    let quads: Vec<layout::Quad> = fetch(&device, &workspace.quads, images * parts);
    let (mut all, mut off) = (0, 0);
    for image in 0..images {
        let (candidate, view) = (image / views, image % views);
        let expected = projector.quads(&poses[candidate * body.dof_count()..][..body.dof_count()], view);
        let mut order: Vec<usize> = (0..parts).rev().collect();
        order.sort_by(|&l, &r| expected[l].depth_squared.total_cmp(&expected[r].depth_squared));
        for (found, part) in quads[image * parts..][..parts].iter().zip(order) {
            let own = &expected[part];
            all += 4;
            let at = |axis: usize| own.corners.map(|corner| if own.drawn { corner[axis] } else { 0 });
            let same = found.part == part as u32
                && (found.drawn == 1) == own.drawn
                && found.depth_squared.to_bits() == own.depth_squared.to_bits();
            let (x, y) = (at(0), at(1));
            off +=
                (0..4).filter(|&corner| !same || found.x[corner] != x[corner] || found.y[corner] != y[corner]).count();
        }
    }
    drop((workspace, scene, device));
    assert_eq!(log.messages(), Vec::<String>::new());
    Some((all, off))
}

#[test]
fn corners_of_ten_thousand_wild_poses_are_the_reference_s() {
    let Some((all, off)) = corners_off(inexact(), POSES) else { return };
    assert_eq!(off, 0, "of {all} corners");
    let (all, off) = corners_off(DeviceSettings::default(), POSES).unwrap();
    assert_eq!(off, 0, "of {all} corners on the device as it is");
    println!("{all} corners, all the reference's");
}

#[test]
fn without_correction_an_inexact_device_is_found_out() {
    let changed = DeviceSettings { code: Some(uncorrected_and_rough), ..DeviceSettings::default() };
    let Some((all, off)) = corners_off(changed, 1000) else { return };
    println!("{off} of {all} corners are not the reference's");
    assert!(off * 100 > all, "only {off} of {all} corners are off");
    // It is the device that is found out, not the change of the code.
    let plain = DeviceSettings { code: Some(uncorrected), ..DeviceSettings::default() };
    let (_, off) = corners_off(plain, 1000).unwrap();
    println!("{off} are not on the device as it is");
}

fn observations() -> Vec<Observation> {
    let mut state = 5_u64;
    cameras()
        .iter()
        .map(|camera| {
            let mut seen = Observation::empty(camera.size[0], camera.size[1]);
            for byte in &mut seen.bytes {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                *byte = (state >> 56) as u8;
            }
            seen
        })
        .collect()
}

/// Objectives of every formula, one of them with exponents that are no eighths.
fn objectives() -> Vec<Objective> {
    let of_silhouettes = ObjectiveKind::ALL.into_iter().map(Objective::of).filter(|own| !own.weighs_evidence());
    let odd = Objective { w1: 0.37, w2: 0.91, ..Objective::of(ObjectiveKind::Sp) };
    of_silhouettes.chain([odd, Objective { beta: 0.3, ..odd }]).collect()
}

fn same_sums_and_fitness(name: &str, evaluator: &mut dyn Evaluator, count: usize) {
    let (body, seen) = (Body::adult(1750.0).unwrap(), observations());
    let poses = poses(&body, count);
    let mut processor = Cpu::new(&body, &cameras()).unwrap();
    let views = seen.len();
    let mut sums = [vec![Components::default(); count * views], vec![Components::default(); count * views]];
    // Every objective draws them all anew.
    let scored = count.min(500);
    let mut fitness = [vec![0.0; scored], vec![0.0; scored]];
    processor.observe(&seen).unwrap();
    evaluator.observe(&seen).unwrap();
    processor.components(&poses, &mut sums[0]).unwrap();
    evaluator.components(&poses, &mut sums[1]).unwrap();
    assert!(sums[0] == sums[1], "{name}: {:?}", sums[0].iter().zip(&sums[1]).find(|(a, b)| a != b));
    for objective in objectives() {
        processor.fitness(&poses[..scored * body.dof_count()], &objective, &mut fitness[0]).unwrap();
        evaluator.fitness(&poses[..scored * body.dof_count()], &objective, &mut fitness[1]).unwrap();
        let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert!(bits(&fitness[0]) == bits(&fitness[1]), "{name}, {objective:?}");
        assert!(fitness[0].iter().any(|value| *value > 0.0), "{name}, {objective:?}: all fitness is 0");
    }
}

#[test]
fn sums_of_ten_thousand_wild_poses_and_their_fitness_are_the_processor_s() {
    let name = "sums_of_ten_thousand_wild_poses_and_their_fitness_are_the_processor_s";
    let Some((device, log)) = device(name, inexact()) else { return };
    let body = Body::adult(1750.0).unwrap();
    same_sums_and_fitness("compute", &mut Compute::on(&device, &body, &cameras()).unwrap(), POSES);
    for packing in Packing::ALL {
        let settings = GraphicsSettings { packing, ..GraphicsSettings::default() };
        let mut graphics = Graphics::on(&device, &body, &cameras(), settings).unwrap();
        same_sums_and_fitness(packing.name(), &mut graphics, POSES / 10);
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn what_a_search_records_has_the_processor_s_fitness() {
    let Some((device, log)) = device("what_a_search_records_has_the_processor_s_fitness", inexact()) else { return };
    let (body, seen) = (Body::adult(1750.0).unwrap(), observations());
    let poses = poses(&body, 300);
    let mut expected = vec![0.0; 300];
    let mut processor = Cpu::new(&body, &cameras()).unwrap();
    processor.observe(&seen).unwrap();
    let mut compute = Compute::on(&device, &body, &cameras()).unwrap();
    compute.observe(&seen).unwrap();
    compute.reserve(300).unwrap();
    for objective in objectives() {
        processor.fitness(&poses, &objective, &mut expected).unwrap();
        let found = recorded_fitness(&compute, &objective, &poses, 300);
        assert!(found.iter().zip(&expected).all(|(a, b)| a.to_bits() == b.to_bits()), "{objective:?}");
    }
    drop((compute, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn what_a_device_lacks_changes_no_integer() {
    let lowered: [fn(&mut Capabilities); 5] = [
        |c| c.longest_submission = Some(std::time::Duration::from_millis(1)),
        |c| c.subgroup_sizes = None,
        |c| c.graphics = false,
        |c| c.max_blend = false,
        |c| (c.rounds_to_nearest, c.keeps_denormals) = (false, false),
    ];
    let body = Body::adult(1750.0).unwrap();
    for lower in lowered {
        let settings = DeviceSettings { lower: Some(lower), ..DeviceSettings::default() };
        let Some((device, log)) = device("what_a_device_lacks_changes_no_integer", settings) else { return };
        same_sums_and_fitness("compute", &mut Compute::on(&device, &body, &cameras()).unwrap(), 200);
        let comparison = Comparison::Device(Gathering::Subgroup);
        let settings = GraphicsSettings { comparison, ..GraphicsSettings::default() };
        match Graphics::on(&device, &body, &cameras(), settings) {
            Ok(mut graphics) => {
                assert!(device.capabilities().graphics);
                let packing = if device.capabilities().max_blend { Packing::Max } else { Packing::Depth };
                assert_eq!(graphics.settings().packing, packing);
                same_sums_and_fitness("graphics", &mut graphics, 200);
            }
            Err(error) => {
                assert!(!device.capabilities().graphics, "{error:#}");
                assert!(format!("{error:#}").contains("has no queue for graphics"), "{error:#}");
            }
        }
        drop(device);
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}

//! The graphics backend gives the reference's integers and fitness in the same scene as the other backends: small and large
//! people, behind and inside of cameras, off screen.
//!
//! Runs on whatever Vulkan device there is, under the validation layer, which must stay silent.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

mod device;
mod scene;

use device::device;
use pantin::body::Body;
use pantin::evaluate::Reference;
use pantin::evaluate::device::{
    Comparison, Gathering, Graphics, GraphicsSettings, HostComparison, Packing, Projection, Tiling,
};
use pantin::evaluate::{Evaluator as _, Objective};
use pantin::gpu::DeviceSettings;
use scene::{Random, cameras, evaluate, first_difference, ignoring, observations, poses, reference_in_parallel};

#[test]
fn five_hundred_poses_give_identical_integers() {
    const NAME: &str = "five_hundred_poses_give_identical_integers";
    let Some((device, log)) = device(NAME, DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mut random = Random(21);
    let seen = observations(&cameras, &mut random);
    let count = 500;
    let poses = poses(&body, count, &mut random);
    let expected = reference_in_parallel(&body, &cameras, &seen, &poses);
    let in_part = ignoring(&seen, &mut random);
    let expected_in_part = evaluate(&mut Reference::new(&body, &cameras), &in_part, &poses[..100 * body.dof_count()]);
    assert!(expected_in_part != expected[..expected_in_part.len()]);
    let usual = GraphicsSettings::default();
    for settings in [
        usual,
        GraphicsSettings { comparison: Comparison::Device(Gathering::Subgroup), ..usual },
        GraphicsSettings { packing: Packing::Depth, projection: Projection::Feedback, ..usual },
        GraphicsSettings { tiling: Tiling::Pictures, ..usual },
        GraphicsSettings { comparison: Comparison::Host(HostComparison::Simd), ..usual },
    ] {
        let mut graphics = Graphics::on(&device, &body, &cameras, settings).unwrap();
        for tiles in ["guessed", "fitted"] {
            let found = evaluate(&mut graphics, &seen, &poses);
            assert_eq!(first_difference(cameras.len(), &expected, &found), None, "{settings:?}, {tiles} tiles");
        }
        for kind in scene::of_silhouettes() {
            let objective = Objective { kind, beta: 0.4, w1: 0.7, w2: 0.3 };
            let mut fitness = vec![-1.0; count];
            graphics.fitness(&poses, &objective, &mut fitness).unwrap();
            for (value, row) in fitness.iter().zip(expected.chunks_exact(cameras.len())) {
                let expected = objective.fitness(row);
                assert!((value - expected).abs() < 1e-5, "{}: {value} against {expected}", kind.name());
            }
        }
        let few = &poses[..100 * body.dof_count()];
        let found_in_part = evaluate(&mut graphics, &in_part, few);
        assert_eq!(first_difference(cameras.len(), &expected_in_part, &found_in_part), None, "{settings:?}, in part");
        // A changed corner or pixel would show: another pose's components are not these.
        let mut moved = poses.clone();
        moved[0] += 40.0;
        let found = evaluate(&mut graphics, &seen, &moved);
        let difference = first_difference(cameras.len(), &expected, &found).unwrap();
        assert!(difference.starts_with("pose 0, "), "{difference}");
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

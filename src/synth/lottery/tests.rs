use std::collections::HashSet;

use super::*;
use crate::synth::SyntheticSequence;

fn drawn(seed: u64) -> Lottery {
    Lottery::draw(&LotterySettings { seed, frames: Some(20), ..LotterySettings::default() }).unwrap()
}

#[test]
fn a_seed_draws_one_scene_and_others_draw_others() {
    let all: Vec<Lottery> = (1..=12).map(drawn).collect();
    assert_eq!(all[0], drawn(1));
    let texts: HashSet<String> = all.iter().map(|lottery| toml::to_string(&lottery.scene).unwrap()).collect();
    assert_eq!(texts.len(), all.len());
    let spread = |of: fn(&Scene) -> String| all.iter().map(|one| of(&one.scene)).collect::<HashSet<_>>().len();
    assert!(spread(|scene| scene.fps.to_string()) > 1 && spread(|scene| scene.rig.station.len().to_string()) > 1);
    assert!(
        spread(|scene| scene.light.lamps.len().to_string()) > 1 && spread(|scene| format!("{:?}", scene.rig.size)) > 3
    );
    assert!(spread(|scene| format!("{:?}", scene.actor[0].motion.gait)) > 2);
    for lottery in &all {
        // The record makes the same scene again.
        let text = toml::to_string(&lottery.scene).unwrap();
        assert_eq!(crate::files::parse_toml::<Scene>(&text, "scene.toml").unwrap(), lottery.scene);
        assert!((1500.0..=1950.0).contains(&lottery.stated_height) && !lottery.summary().is_empty());
        assert!((4..=6).contains(&lottery.scene.rig.station.len()));
        assert_eq!(lottery.t_pose.rig, lottery.scene.rig);
    }
}

#[test]
fn three_cameras_see_all_joints_all_the_time() {
    for seed in 1..=6 {
        let lottery = drawn(seed);
        for scene in [&lottery.scene, &lottery.t_pose] {
            let sequence = SyntheticSequence::new(scene).unwrap();
            for row in &sequence.joints().unwrap().frames {
                let sees = |camera: &&crate::geometry::Camera| {
                    row.iter().flatten().all(|joint| {
                        let [width, height] = camera.size.map(f64::from);
                        let pixel = camera.project(*joint).unwrap();
                        pixel.x > 0.0 && pixel.y > 0.0 && pixel.x < width - 1.0 && pixel.y < height - 1.0
                    })
                };
                assert!(sequence.cameras().iter().filter(sees).count() >= 3, "seed {seed}, {}", scene.name);
            }
        }
    }
}

#[test]
fn what_is_not_there_is_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let nowhere = Some(folder.path().join("nowhere"));
    let error = |settings: LotterySettings| format!("{:#}", Lottery::draw(&settings).unwrap_err());
    let message = error(LotterySettings { motions: nowhere.clone(), ..LotterySettings::default() });
    assert!(message.contains("cannot read the motions of") && message.contains("nowhere"), "{message}");
    let message = error(LotterySettings { people: nowhere, ..LotterySettings::default() });
    assert!(message.contains("cannot read the people of"), "{message}");
    let motions = Some(folder.path().to_path_buf());
    let message = error(LotterySettings { motions: motions.clone(), ..LotterySettings::default() });
    assert!(message.contains("holds no motion"), "{message}");
    std::fs::write(folder.path().join("torn.bvh"), "HIERARCHY\nROOT hips {").unwrap();
    let message = error(LotterySettings { seed: 1, motions, ..LotterySettings::default() });
    assert!(message.contains("torn.bvh") && message.lines().count() == 1, "{message}");
    let message = error(LotterySettings { frames: Some(0), ..LotterySettings::default() });
    assert!(message.contains("frames is 0"), "{message}");
}

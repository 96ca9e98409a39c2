//! `pantin track --labels`: which part of the body shows at each pixel of the videos.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use image::{GrayImage, ImageFormat};
use pantin::body::{Body, Mesh, Model, PoseTable};
use pantin::evaluate::Reference;

use super::support::{has_vulkan, pantin, refused, sequence, succeeded};
use super::walk;

/// A copy of the sequence that runs track, with other pictures where `change` makes them, at half of its size.
fn half_size(folder: &Path, change: impl Fn(&str) -> Option<GrayImage>) {
    for entry in fs::read_dir(sequence()).unwrap() {
        let from = entry.unwrap().path();
        let to = folder.join(from.file_name().unwrap());
        if from.is_dir() {
            fs::create_dir_all(&to).unwrap();
            for entry in fs::read_dir(&from).unwrap() {
                let from = entry.unwrap().path();
                let name = from.file_name().unwrap().to_str().unwrap();
                match change(name) {
                    Some(picture) => picture.save(to.join(name)).unwrap(),
                    None => drop(fs::copy(&from, to.join(name)).unwrap()),
                }
            }
        } else {
            fs::copy(&from, &to).unwrap();
        }
    }
    let manifest = fs::read_to_string(folder.join("sequence.toml")).unwrap();
    assert!(!manifest.contains("scale"), "{manifest}");
    fs::write(folder.join("sequence.toml"), format!("scale = 0.5\n{manifest}")).unwrap();
}

fn track(sequence: &Path, output: &Path, more: &[&str]) -> std::process::Output {
    let mut arguments = vec!["track", sequence.to_str().unwrap(), "-o", output.to_str().unwrap()];
    arguments.extend(["--search", "pso", "--particles", "40", "--iterations", "6", "--overlay-every", "0"]);
    arguments.extend(more);
    pantin(&arguments)
}

/// All files of labels/ by name.
fn labels(output: &Path) -> BTreeMap<String, Vec<u8>> {
    let read = |entry: fs::DirEntry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap());
    fs::read_dir(output.join("labels")).unwrap().map(|entry| read(entry.unwrap())).collect()
}

/// A picture of labels as it is stored: 8-bit grey.
fn picture(bytes: &[u8]) -> GrayImage {
    let image::DynamicImage::ImageLuma8(picture) =
        image::load_from_memory_with_format(bytes, ImageFormat::Png).unwrap()
    else {
        panic!("expected 8-bit grey")
    };
    picture
}

/// The part of pixels that two pictures have alike, of those that are not 0 in both.
fn alike(a: &[u8], b: &[u8]) -> f64 {
    let shown = || a.iter().zip(b).filter(|(a, b)| **a != 0 || **b != 0);
    shown().filter(|(a, b)| a == b).count() as f64 / shown().count().max(1) as f64
}

#[test]
fn every_pixel_of_the_videos_has_the_label_of_the_part_that_shows() {
    let folder = tempfile::tempdir().unwrap();
    let (at, output) = (folder.path().join("walk"), folder.path().join("track"));
    fs::create_dir(&at).unwrap();
    half_size(&at, |_| None);
    succeeded(&track(&at, &output, &["--labels", "--backend", "cpu"]));
    let whole = labels(&output);
    assert_eq!(whole.len(), 1 + 4 * walk::FRAMES);
    let body = Body::load(&at.join("body.toml")).unwrap();
    let legend = fs::read_to_string(output.join("labels/labels.csv")).unwrap();
    assert_eq!(legend.lines().count(), 1 + body.parts.len(), "{legend}");
    for part in &body.parts {
        assert!(
            legend.contains(&format!("\n{},{},{}\n", part.label, part.name, body.bones[part.bone].name)),
            "{legend}"
        );
    }
    // What the model in the found pose shows, in the videos' size and not in the one that was worked at.
    let poses = PoseTable::read(&output.join("poses.csv"), &body).unwrap();
    let cameras = walk::cameras();
    let reference = Reference::new(&body, &cameras);
    let mut parts = std::collections::BTreeSet::new();
    for (frame, pose) in poses.frames.iter().zip(&poses.poses) {
        let pose: Vec<f32> = pose.iter().map(|value| *value as f32).collect();
        for (view, camera) in cameras.iter().enumerate() {
            let found = picture(&whole[&format!("{}_{frame:06}.png", camera.name)]);
            assert_eq!([found.width(), found.height()], camera.size);
            let expected: Vec<u8> = reference.draw(&pose, view).bytes.iter().map(|byte| byte & 0x7f).collect();
            let share = alike(found.as_raw(), &expected);
            assert!(share > 0.995, "{share} of frame {frame}, {}", camera.name);
            // In another camera's picture it would be something else.
            let other = reference.draw(&pose, (view + 1) % cameras.len()).bytes;
            assert!(alike(found.as_raw(), &other) < 0.9);
            // And it lies on the person.
            let mask =
                image::open(at.join(format!("frames/{}_mask_{frame:04}.png", camera.name))).unwrap().into_luma8();
            let on = found.pixels().zip(mask.pixels()).filter(|(label, mask)| label.0[0] != 0 && mask.0[0] != 0);
            let drawn = found.pixels().filter(|label| label.0[0] != 0).count();
            assert!(on.count() as f64 > 0.8 * drawn as f64, "frame {frame}, {}", camera.name);
            parts.extend(found.as_raw().iter().copied());
        }
    }
    assert!(parts.len() > 12 && parts.iter().all(|label| *label <= 127), "{parts:?}");

    // Whatever computes them, and however often the run was stopped: a run that has none yet gets them.
    let bare = folder.path().join("bare");
    succeeded(&track(&at, &bare, &["--backend", "cpu"]));
    assert!(!bare.join("labels").exists());
    succeeded(&track(&at, &bare, &["--backend", "cpu", "--resume", "--labels"]));
    assert!(labels(&bare) == whole);
    fs::remove_file(bare.join("labels/cam1_000002.png")).unwrap();
    fs::write(bare.join("labels/cam1_000003.png"), "half a fi").unwrap();
    succeeded(&track(&at, &bare, &["--backend", "cpu", "--resume", "--labels"]));
    assert!(labels(&bare) == whole);
    let record = fs::read_to_string(output.join("run.toml")).unwrap();
    assert!(record.contains(" --labels"), "{record}");
    for backend in ["reference", "compute", "graphics"] {
        if backend == "reference" || has_vulkan("every_pixel_of_the_videos_has_the_label_of_the_part_that_shows") {
            let output = folder.path().join(backend);
            succeeded(&track(&at, &output, &["--labels", "--backend", backend, "--frames", "0..2"]));
            let found = labels(&output);
            assert_eq!(found.len(), 1 + 4 * 2);
            for (name, bytes) in &found {
                let is_same =
                    name == "labels.csv" || alike(picture(bytes).as_raw(), picture(&whole[name]).as_raw()) > 0.95;
                assert!(is_same, "{backend}: {name}");
            }
        }
    }
    // A new run takes away what a run drew, and nothing else.
    fs::write(bare.join("labels/mine.png"), "mine").unwrap();
    fs::write(bare.join("labels/cam9_000004.png"), "an earlier run's").unwrap();
    succeeded(&track(&at, &bare, &["--frames", "0..1", "--force"]));
    assert_eq!(labels(&bare).keys().collect::<Vec<_>>(), ["mine.png"]);
}

#[test]
fn meshes_are_labelled_by_their_skin() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("track");
    let more = ["--labels", "--backend", "cpu", "--frames", "0..1", "--model", "elliptic-18"];
    succeeded(&track(sequence(), &output, &more));
    let body = Body::load(&sequence().join("body.toml")).unwrap();
    let poses = PoseTable::read(&output.join("poses.csv"), &body).unwrap();
    let pose: Vec<f32> = poses.poses[0].iter().map(|value| *value as f32).collect();
    let mesh: Mesh = Model::Elliptic18.mesh(&body).unwrap().unwrap();
    let skin = Reference::of_mesh(&body, mesh, &walk::cameras()).unwrap();
    let flat = Reference::new(&body, &walk::cameras());
    let found = picture(&labels(&output)["cam0_000000.png"]);
    let of = |reference: &Reference| -> f64 {
        let drawn: Vec<u8> = reference.draw(&pose, 0).bytes.iter().map(|byte| byte & 0x7f).collect();
        alike(found.as_raw(), &drawn)
    };
    assert!(of(&skin) > 0.995 && of(&flat) < 0.99, "{} {}", of(&skin), of(&flat));
}

#[test]
fn frames_in_which_the_person_is_lost_have_no_labels() {
    let folder = tempfile::tempdir().unwrap();
    let (at, output) = (folder.path().join("walk"), folder.path().join("track"));
    fs::create_dir(&at).unwrap();
    // Nobody is to be seen in two frames.
    let is_empty = |name: &str| ["_mask_0003.png", "_mask_0004.png"].iter().any(|end| name.ends_with(end));
    half_size(&at, |name| is_empty(name).then(|| GrayImage::new(160, 120)));
    succeeded(&track(&at, &output, &["--labels", "--backend", "cpu", "--objective", "sp"]));
    let confidence = fs::read_to_string(output.join("confidence.csv")).unwrap();
    let state = confidence.lines().next().unwrap().split(',').position(|name| name == "state").unwrap();
    let lost: Vec<bool> = confidence.lines().skip(1).map(|row| row.split(',').nth(state) == Some("lost")).collect();
    assert!(lost.contains(&true) && lost.contains(&false), "{lost:?}");
    let found = labels(&output);
    for (frame, is_lost) in lost.into_iter().enumerate() {
        assert_eq!(!found.contains_key(&format!("cam1_{frame:06}.png")), is_lost, "frame {frame}");
    }
    let live = ["--labels", "--realtime"];
    refused(&track(&at, &folder.path().join("live"), &live), &["leave out --labels"]);
}

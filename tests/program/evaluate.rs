//! `pantin evaluate` from outside.

use std::fs;
use std::path::Path;

use pantin::body::{Body, Mesh, PoseTable};
use pantin::evaluate::Reference;
use pantin::features::Observation;
use pantin::files::Overwrite;

use super::support::{has_vulkan, pantin, refused, sequence, stderr, stdout, succeeded};
use super::walk;

/// The true poses, which frame 2 is compared with.
fn evaluate(output: &Path, more: &[&str]) -> std::process::Output {
    let poses = sequence().join("truth_poses.csv");
    let mut arguments = vec!["evaluate", "--poses", poses.to_str().unwrap(), "-o", output.to_str().unwrap()];
    arguments.extend(more);
    pantin(&arguments)
}

#[test]
fn both_backends_write_the_same_and_the_truth_scores_best() {
    let folder = tempfile::tempdir().unwrap();
    let of_frame = ["--sequence", sequence().to_str().unwrap(), "--frame", "2"];
    for backend in ["reference", "cpu"] {
        let output = folder.path().join(backend);
        let done = evaluate(&output, &[&of_frame[..], &["--backend", backend, "--images"]].concat());
        succeeded(&done);
        let says = stderr(&done).contains("the images are drawn by the reference");
        assert_eq!(says, backend == "cpu", "{}", stderr(&done));
    }
    let read = |backend: &str, name: &str| fs::read_to_string(folder.path().join(backend).join(name)).unwrap();
    for name in ["components.csv", "fitness.csv"] {
        assert_eq!(read("reference", name), read("cpu", name), "{name}");
    }
    let components = read("cpu", "components.csv");
    let mut lines = components.lines();
    assert_eq!(lines.next(), Some("pose,view,area_obs,area_model,overlap,edges,proximity"));
    assert_eq!(components.lines().count(), 1 + 4 * walk::FRAMES);
    let truth: Vec<&str> = components.lines().find(|line| line.starts_with("2,cam1,")).unwrap().split(',').collect();
    assert_eq!(truth[2], truth[3], "the observation is the drawing");
    assert_eq!(truth[3], truth[4]);
    let fitness = read("cpu", "fitness.csv");
    let values: Vec<f64> = fitness.lines().skip(1).map(|l| l.split(',').nth(1).unwrap().parse().unwrap()).collect();
    assert_eq!(values.len(), walk::FRAMES);
    assert!((0..walk::FRAMES).all(|pose| values[pose] <= values[2]), "{values:?}");

    let body = Body::adult(1750.0).unwrap();
    let pose: Vec<f32> = walk::poses(&body).poses[3].iter().map(|value| *value as f32).collect();
    let drawn = Reference::new(&body, &walk::cameras()).draw(&pose, 1);
    let image = image::open(folder.path().join("cpu/images/pose_000003_cam1.png")).unwrap().into_luma8();
    assert_eq!((image.width(), image.height()), (160, 120));
    assert!(image.into_raw() == drawn.bytes, "the picture is the candidate image");
}

/// Graphics writes what the device drew, compute says that it has nothing to write.
#[test]
fn devices_write_the_pictures_they_have() {
    if !has_vulkan("devices_write_the_pictures_they_have") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let body = Body::adult(1750.0).unwrap();
    let reference = Reference::new(&body, &walk::cameras());
    let of_frame = ["--sequence", sequence().to_str().unwrap(), "--frame", "2", "--images"];
    for backend in ["graphics", "compute"] {
        let output = folder.path().join(backend);
        let done = evaluate(&output, &[&of_frame[..], &["--backend", backend]].concat());
        succeeded(&done);
        let says = stderr(&done).contains("the images are drawn by the reference");
        assert_eq!(says, backend == "compute", "{}", stderr(&done));
        for (frame, pose) in walk::poses(&body).poses.iter().enumerate() {
            let pose: Vec<f32> = pose.iter().map(|value| *value as f32).collect();
            let image = image::open(output.join(format!("images/pose_{frame:06}_cam1.png"))).unwrap().into_luma8();
            let expected = reference.draw(&pose, 1).bytes;
            let wrong = image.as_raw().iter().zip(&expected).filter(|(found, expected)| found != expected).count();
            // A device may round a corner to the next 1/256 pixel.
            assert!(
                wrong * 100 <= expected.iter().filter(|byte| **byte != 0).count(),
                "{backend}, {frame}: {wrong} pixels"
            );
        }
    }
}

#[test]
fn packed_observations_instead_of_a_sequence() {
    let folder = tempfile::tempdir().unwrap();
    let body = Body::adult(1750.0).unwrap();
    let cameras = walk::cameras();
    let reference = Reference::new(&body, &cameras);
    let mut pose: Vec<f64> = walk::poses(&body).poses[4].clone();
    let row: Vec<f32> = pose.iter().map(|value| *value as f32).collect();
    for (view, camera) in cameras.iter().enumerate() {
        let drawn = reference.draw(&row, view);
        let bytes = drawn.bytes.iter().map(|b| u8::from(*b != 0) << 7 | if b & 0x80 != 0 { 127 } else { 0 }).collect();
        let observation = Observation { bytes, ..Observation::empty(drawn.width, drawn.height) };
        observation.write_png(&folder.path().join(format!("{}.png", camera.name)), Overwrite::Refuse).unwrap();
    }
    // A whole number of turns more is the same pose.
    pose[5] += 200.0 * std::f64::consts::TAU;
    let table = PoseTable { frames: vec![9, 9], poses: vec![walk::poses(&body).poses[4].clone(), pose] };
    let poses = folder.path().join("poses.csv");
    table.write(&poses, Overwrite::Refuse, &body).unwrap();
    let (cameras_file, body_file) = (sequence().join("cameras.toml"), sequence().join("body.toml"));
    let arguments = |observations: &Path| {
        let given = [
            ("--observations", observations),
            ("--cameras", &cameras_file),
            ("--body", &body_file),
            ("--poses", &poses),
        ];
        let flags = given.into_iter().flat_map(|(flag, path)| [flag.to_string(), path.display().to_string()]);
        ["evaluate".to_string()].into_iter().chain(flags).collect::<Vec<String>>()
    };
    let run = |arguments: &[String]| pantin(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    let done = run(&arguments(folder.path()));
    succeeded(&done);
    let text = stdout(&done);
    assert_eq!(text, "pose,fitness\n0,1\n1,1\n", "drawn from this very pose");

    let wrong = folder.path().join("cam2.png");
    Observation::empty(150, 120).write_png(&wrong, Overwrite::Replace).unwrap();
    refused(&run(&arguments(folder.path())), &["cam2.png is 150x120 pixels", "\"cam2\" has 160x120"]);
    fs::remove_file(&wrong).unwrap();
    refused(&run(&arguments(folder.path())), &["cannot read", "cam2.png"]);
}

/// The mesh model: its own drawing, its own components, and who cannot draw it.
#[test]
fn the_mesh_model_is_drawn_and_scored() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("mesh");
    let of_frame = ["--sequence", sequence().to_str().unwrap(), "--frame", "2", "--model", "mesh"];
    let done = evaluate(&output, &[&of_frame[..], &["--images"]].concat());
    succeeded(&done);
    let body = Body::adult(1750.0).unwrap();
    let reference = Reference::of_mesh(&body, Mesh::of_body(&body).unwrap(), &walk::cameras()).unwrap();
    let pose: Vec<f32> = walk::poses(&body).poses[3].iter().map(|value| *value as f32).collect();
    let drawn = reference.draw(&pose, 1);
    let image = image::open(output.join("images/pose_000003_cam1.png")).unwrap().into_luma8();
    assert!(image.into_raw() == drawn.bytes, "the picture is the candidate image");
    let components = fs::read_to_string(output.join("components.csv")).unwrap();
    let row = components.lines().find(|line| line.starts_with("3,cam1,")).unwrap();
    let area = drawn.bytes.iter().filter(|byte| **byte != 0).count();
    let edges = drawn.bytes.iter().filter(|byte| **byte & 0x80 != 0).count();
    let numbers: Vec<&str> = row.split(',').collect();
    assert_eq!((numbers[3], numbers[5]), (area.to_string().as_str(), edges.to_string().as_str()));
    // The processor gives the reference's bytes, and the picture is its own.
    let files = |backend: &str| {
        let output = folder.path().join(backend);
        succeeded(&evaluate(&output, &[&of_frame[..], &["--images", "--backend", backend]].concat()));
        let picture = fs::read(output.join("images/pose_000003_cam1.png")).unwrap();
        [fs::read(output.join("components.csv")).unwrap(), fs::read(output.join("fitness.csv")).unwrap(), picture]
    };
    let reference = files("reference");
    assert!(files("cpu") == reference);
    if has_vulkan("the_mesh_model_is_drawn_and_scored") {
        // So does compute; a device's powers may be off in the last place, and pictures are the reference's.
        assert!(files("compute")[0] == reference[0]);
    }
}

#[test]
fn wrong_requests() {
    let folder = tempfile::tempdir().unwrap();
    let name = sequence().to_str().unwrap();
    let output = folder.path().join("out");
    refused(&evaluate(&output, &["--sequence", name, "--frame", "6"]), &["no frame 6", "0 to 5"]);
    refused(
        &evaluate(folder.path().parent().unwrap(), &["--sequence", name, "--frame", "1"]),
        &["not empty", "--force"],
    );
    for wrong in [
        &["--sequence", name][..],
        &["--frame", "1"],
        &["--observations", name],
        &["--sequence", name, "--frame", "1", "--backend", "cuda"],
        &["--sequence", name, "--frame", "1", "--model", "solid"],
    ] {
        assert_eq!(evaluate(&output, wrong).status.code(), Some(2), "{wrong:?}");
    }
    let of_frame = ["--sequence", name, "--frame", "1"];
    for (flags, parts) in [
        (&["--packing", "depth"][..], &["--packing depth", "the backend is auto: expected --backend graphics"][..]),
        (
            &["--backend", "graphics", "--model", "mesh", "--coverage", "exact"],
            &["--coverage exact is for the flat model", "mesh"],
        ),
        (&["--backend", "cpu", "--devices", "0"], &["and the backend is cpu: expected --backend compute"]),
    ] {
        refused(&evaluate(&output, &[&of_frame[..], flags].concat()), parts);
    }
    if has_vulkan("wrong_requests") {
        let flags = ["--backend", "compute", "--devices", "0,99"];
        refused(&evaluate(&output, &[&of_frame[..], &flags].concat()), &["there is no Vulkan device 99", "from 0"]);
    }
}

/// Every way of the graphics backend, and devices that share the poses, write the same bytes.
#[test]
fn ways_to_draw_and_devices_change_nothing() {
    if !has_vulkan("ways_to_draw_and_devices_change_nothing") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let of_frame = ["--sequence", sequence().to_str().unwrap(), "--frame", "2"];
    let files = |name: &str, flags: &[&str]| {
        let output = folder.path().join(name);
        let done = evaluate(&output, &[&of_frame[..], flags].concat());
        succeeded(&done);
        let read = |file: &str| fs::read(output.join(file)).unwrap();
        ([read("components.csv"), read("fitness.csv")], String::from_utf8_lossy(&done.stderr).into_owned())
    };
    let (expected, _) = files("cpu", &["--backend", "cpu"]);
    let graphics = ["--backend", "graphics", "--packing", "depth", "--gather", "readback-simd"];
    let (found, told) = files("graphics", &[&graphics[..], &["--projection", "feedback"]].concat());
    assert!(found[0] == expected[0]);
    assert!(told.contains("depth-readback-simd"), "{told}");
    let ways = ["--backend", "graphics", "--primitives", "geometry", "--projection", "feedback"];
    let (found, told) = files("points", &ways);
    assert!(found[0] == expected[0]);
    // As far as the device can.
    assert!(told.contains("(max-texels"), "{told}");
    let of_mesh = ["--model", "square"];
    let (mesh, told) = files("mesh", &[&of_mesh[..], &["--backend", "graphics"]].concat());
    assert!(mesh[0] != expected[0] && !told.contains("depth-hardware"), "{told}");
    let (found, told) = files("mesh points", &[&of_mesh[..], &ways].concat());
    assert!(found[0] == mesh[0] && told.contains("(depth-hardware-texels"), "{told}");
    let (found, told) = files("shared", &["--backend", "compute", "--devices", "0,0"]);
    assert!(found[0] == expected[0]);
    assert!(told.contains("on the Vulkan devices") && told.contains("which share the poses"), "{told}");
    // Triangles of the device cover other pixels of borders.
    let (found, told) = files("hardware", &["--backend", "graphics", "--coverage", "hardware"]);
    assert!(found[0] != expected[0] && told.contains("max-hardware-texels"), "{told}");
}

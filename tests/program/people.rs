//! Several people of one sequence: `[[person]]`, each followed past the other, with a folder of her own.

use std::fs;
use std::path::Path;
use std::process::Output;

use image::{GrayImage, Luma, Rgb, RgbImage};
use pantin::body::{Body, PoseTable, Proportions};
use pantin::evaluate::{Projector, draw_quads};
use pantin::files::Overwrite;
use pantin::motion::write_points;
use pantin::sequence::write_cameras_toml;

use super::support::{pantin, refused, stderr, stdout, succeeded};
use super::walk;

const NAMES: [&str; 2] = ["anna", "ben"];

/// Pictures of two people who walk past each other, an arm's length apart, in so many frames; both are drawn `as_they_are`, made from the bodies
/// that are given.
fn write(folder: &Path, frames: usize, as_they_are: impl Fn(&Body) -> Body) {
    let given = [1750.0, 1650.0].map(|height| Body::adult(height).unwrap());
    let bodies = given.each_ref().map(as_they_are);
    let pose = |person: usize, frame: usize| {
        let body = &bodies[person];
        let names = body.dof_names();
        let index = |name: &str| names.iter().position(|dof| dof == name).unwrap();
        let (sign, phase) = ([1.0, -1.0][person], 0.4 * frame as f64 + person as f64);
        let mut pose = body.standing_pose();
        pose[index("pelvis.tx")] += sign * 720.0 / frames as f64 * (frame as f64 - 0.5 * (frames - 1) as f64);
        pose[index("pelvis.ty")] += sign * 200.0;
        pose[index("pelvis.rz")] += [0.0, std::f64::consts::PI][person];
        for (side, sign) in [("left", 1.0), ("right", -1.0)] {
            pose[index(&format!("{side}_hip.ry"))] += 0.4 * sign * phase.sin();
            pose[index(&format!("{side}_knee.ry"))] += 0.2 * (1.0 + sign * phase.cos());
            pose[index(&format!("{side}_shoulder.ry"))] -= 0.3 * sign * phase.sin();
        }
        body.clamp_to_limits(&mut pose);
        pose
    };
    let cameras = walk::cameras();
    write_cameras_toml(&folder.join("cameras.toml"), &cameras, Overwrite::Refuse).unwrap();
    let mut people = String::new();
    for (person, (name, (body, given))) in NAMES.iter().zip(bodies.iter().zip(&given)).enumerate() {
        let own = folder.join(name);
        fs::create_dir(&own).unwrap();
        let table =
            PoseTable { frames: (0..frames).collect(), poses: (0..frames).map(|frame| pose(person, frame)).collect() };
        given.save(&own.join("body.toml"), Overwrite::Refuse).unwrap();
        let start = PoseTable { frames: vec![0], poses: vec![table.poses[0].clone()] };
        start.write(&own.join("start.csv"), Overwrite::Refuse, body).unwrap();
        write_points(&own.join("truth.csv"), &body.joint_trajectory(&table, 25.0).unwrap(), Overwrite::Refuse).unwrap();
        let files =
            format!("body = \"{name}/body.toml\"\nstart = \"{name}/start.csv\"\ntruth = \"{name}/truth.csv\"\n");
        people += &format!("[[person]]\nname = \"{name}\"\n{files}");
        fs::write(folder.join(format!("{name}.toml")), files).unwrap();
    }
    fs::create_dir(folder.join("frames")).unwrap();
    let projectors = bodies.each_ref().map(|body| Projector::new(body, &cameras));
    let mut views = String::new();
    for (view, camera) in cameras.iter().enumerate() {
        let [width, height] = camera.size;
        let name = &camera.name;
        views += &format!(
            "[[view]]\ncamera = \"{name}\"\nsource = \"frames/{name}_%04d.png\"\nmask = \"frames/{name}_mask_%04d.png\"\n"
        );
        for frame in 0..frames {
            let (mut quads, mut labels) = (Vec::new(), Vec::new());
            for (person, projector) in projectors.iter().enumerate() {
                let pose: Vec<f32> = pose(person, frame).iter().map(|value| *value as f32).collect();
                quads.extend(projector.quads(&pose, view));
                labels.extend(bodies[person].parts.iter().map(|part| part.label + 40 * person as u8));
            }
            let drawn = draw_quads(&quads, &labels, width, height);
            let label = |x: u32, y: u32| drawn.bytes[(y * width + x) as usize] & 0x7f;
            let picture = RgbImage::from_fn(width, height, |x, y| match label(x, y) {
                0 => Rgb([40, 60, 50]),
                label if label > 40 => Rgb([60 + 30 * (label % 3), 80, 250 - 9 * (label - 40)]),
                label => Rgb([250 - 9 * label, 100 + 30 * (label % 5), 90]),
            });
            let mask = GrayImage::from_fn(width, height, |x, y| Luma([if label(x, y) > 0 { 255 } else { 0 }]));
            picture.save(folder.join(format!("frames/{name}_{frame:04}.png"))).unwrap();
            mask.save(folder.join(format!("frames/{name}_mask_{frame:04}.png"))).unwrap();
        }
    }
    let head = "name = \"past\"\nfps = 25.0\ncameras = \"cameras.toml\"\n";
    fs::write(folder.join("sequence.toml"), format!("{head}{people}{views}")).unwrap();
    for name in NAMES {
        let own = fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap();
        fs::write(folder.join(format!("{name}.toml")), format!("{head}{own}{views}")).unwrap();
    }
}

fn track(folder: &Path, manifest: &str, output: &str, more: &[&str]) -> Output {
    track_so(folder, manifest, output, &[&["--iterations", "8", "--passes", "forward"], more].concat())
}

fn track_so(folder: &Path, manifest: &str, output: &str, more: &[&str]) -> Output {
    let [sequence, output] = [manifest, output].map(|name| folder.join(name).to_str().unwrap().to_owned());
    let few = ["--particles", "50", "--overlay-every", "0", "--backend", "cpu"];
    pantin(&[&["track", &sequence, "-o", &output][..], &few, more].concat())
}

/// The errors that a run reports, mm.
fn errors(run: &Output) -> Vec<f64> {
    succeeded(run);
    let text = stdout(run);
    let errors = text.lines().filter_map(|line| line.strip_prefix("error "));
    errors.map(|error| error.split_whitespace().next().unwrap().parse().unwrap()).collect()
}

#[test]
fn people_made_otherwise_are_measured_beside_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let factors = [("upper arm".to_string(), 0.85), ("forearm".to_string(), 1.12), ("thigh".to_string(), 0.94)];
    let factors = factors.into_iter().collect();
    let as_they_are = Proportions::named(&factors).unwrap();
    write(folder, 24, |given| as_they_are.apply(given));
    let manifest = folder.join("sequence.toml");
    let text = fs::read_to_string(&manifest).unwrap();
    fs::write(&manifest, format!("measure_again = true\n{text}")).unwrap();
    let track = |output: &str, more: &[&str]| {
        errors(&track_so(folder, "sequence.toml", output, &[&["--iterations", "10"], more].concat()))
    };
    let given = track("given", &["--measure-again=no"]);
    let found = track("again", &[]);
    println!("as given {given:?} mm, measured again {found:?} mm");
    for name in NAMES {
        let [before, after] = ["given", "again"].map(|run| folder.join(run).join(name).join("refined_body.toml"));
        assert!(!before.exists());
        assert!(after.is_file(), "{name} was not believed to be made otherwise");
    }
    assert!(found.iter().zip(&given).all(|(found, given)| *found < 0.9 * given), "{given:?} -> {found:?} mm");
}

/// A camera stands still while they walk on: it is left out for both, and named for both.
#[test]
fn a_camera_that_stops_is_left_out_for_both() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, 14, Body::clone);
    let camera = &walk::cameras()[0].name;
    for frame in 4..14 {
        for kind in ["", "mask_"] {
            let picture = |frame: usize| folder.join(format!("frames/{camera}_{kind}{frame:04}.png"));
            fs::copy(picture(3), picture(frame)).unwrap();
        }
    }
    let run = track_so(folder, "sequence.toml", "stopped", &[]);
    let off = errors(&run);
    println!("{off:?} mm\n{}", stderr(&run));
    assert!(off.iter().all(|off| *off < 40.0), "{off:?} mm");
    assert_eq!(stderr(&run).matches(&format!("camera {camera:?} does not fit what the others show")).count(), 2);
    for name in NAMES {
        let table = fs::read_to_string(folder.join("stopped").join(name).join("confidence.csv")).unwrap();
        let left_out: Vec<bool> =
            table.lines().skip(1).map(|line| line.split(',').nth(2).unwrap().is_empty()).collect();
        assert!(!left_out[..4].contains(&true) && left_out[9..].iter().all(|left_out| *left_out), "{left_out:?}");
    }
}

#[test]
fn two_people_are_followed_past_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, 12, Body::clone);
    // One seed says little: twelve of them gave 0.95 to 1.51 times the error where each was followed alone, 1.21 on average with a standard error
    // of 0.05; nothing gained would be 1.
    let mut sums = [0.0; 2];
    for seed in 1..=12 {
        let with = ["--seed", &seed.to_string()];
        let together = errors(&track(folder, "sequence.toml", &format!("together_{seed}"), &with));
        // Where they go wrong alone they would be called lost, and what is lost counts in no error.
        let keeping = [&with[..], &["--recover", "no"]].concat();
        let alone = NAMES
            .map(|name| errors(&track(folder, &format!("{name}.toml"), &format!("alone_{name}_{seed}"), &keeping))[0]);
        println!("seed {seed}: together {together:?} mm, each alone {alone:?} mm");
        // They gave 16 to 37 mm.
        assert!(together.len() == 2 && together.iter().all(|error| *error < 40.0), "{together:?}");
        sums = [sums[0] + alone.iter().sum::<f64>(), sums[1] + together.iter().sum::<f64>()];
    }
    let [alone, together] = sums;
    assert!(alone > 1.1 * together, "{alone} alone, {together} together");

    let run = "together_1";
    // A folder each, with everything; gone on with, the same bytes, whoever was further.
    let files = |name: &str| {
        ["poses.csv", "journal.txt", "joints.csv", "confidence.csv"]
            .map(|file| fs::read(folder.join(run).join(name).join(file)).unwrap())
    };
    let whole = NAMES.map(files);
    assert!(whole[0] != whole[1]);
    for file in ["report.html", "joints.trc", "motion.bvh", "run.toml", "stages.json"] {
        assert!(NAMES.iter().all(|name| folder.join(run).join(name).join(file).is_file()), "{file}");
    }
    for (name, cut) in NAMES.iter().zip([5, 4]) {
        let path = folder.join(run).join(name).join("journal.txt");
        let journal = fs::read_to_string(&path).unwrap();
        let lines: Vec<&str> = journal.split_inclusive('\n').collect();
        fs::write(path, lines[..lines.len() - cut].concat()).unwrap();
    }
    succeeded(&track(folder, "sequence.toml", run, &["--seed", "1", "--resume"]));
    assert!(NAMES.map(files) == whole, "a run that went on differs");

    // The second pass too sees each beside the other.
    let both = errors(&track_so(folder, "sequence.toml", "both", &["--frames", "0..4", "--iterations", "4"]));
    println!("both passes {both:?} mm");
    // 8 and 11 mm with this seed.
    assert!(both.len() == 2 && both.iter().all(|error| *error < 25.0), "{both:?}");

    let edited = |from: &str, to: &str| {
        let text = fs::read_to_string(folder.join("sequence.toml")).unwrap();
        assert!(text.contains(from));
        fs::write(folder.join("edited.toml"), text.replacen(from, to, 1)).unwrap();
        track(folder, "edited.toml", "refused", &["--force"])
    };
    refused(&edited("fps = 25.0", "fps = 25.0\nbody = \"anna/body.toml\""), &["edited.toml has `body` and [[person]]"]);
    refused(
        &edited("fps = 25.0", "fps = 25.0\nstart = \"anna/start.csv\""),
        &["edited.toml has `start` and [[person]]"],
    );
    refused(&edited("name = \"ben\"", "name = \"Anna\""), &["two people are called \"Anna\""]);
    refused(
        &edited("name = \"ben\"", "name = \"../ben\""),
        &["person 2 is \"../ben\"", "a name that a folder may have"],
    );
    refused(&edited("ben/start.csv", "ben/none.csv"), &["the start of person \"ben\"", "none.csv"]);
    refused(&track(folder, "sequence.toml", "refused", &["--force", "--realtime"]), &["not tracked in real time"]);
    let start = folder.join("anna/start.csv");
    refused(
        &track(folder, "sequence.toml", "refused", &["--force", "--start", start.to_str().unwrap()]),
        &["each with a start of her own"],
    );
}

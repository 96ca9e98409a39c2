//! Scripted losses of a walking person in the synthetic room, and how well the tracker knows of them (docs/CONFIDENCE.md).

use std::collections::HashMap;
use std::fmt::Write as _;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use pantin::motion::{PointTrajectory, read_points};
use plotters::prelude::*;

use super::support::{self, succeeded};

const CAMERAS: [&str; 4] = ["cam1", "cam2", "cam3", "cam4"];
/// A frame is off when its joints are farther from the truth than this on average, mm.
const OFF: f64 = 150.0;
/// A curve each: poses with exchanged limbs or headings are off by less than the last, whatever else is farther off.
const BOUNDS: [f64; 3] = [OFF, 250.0, 400.0];
/// Per cent: from `wrong` of so much on a frame is lost, in the table and at the marks of the curves.
const MARKED: [u32; 7] = [95, 80, 50, 30, 20, 10, 5];
/// Those that are written beside the first curve, where they do not stand on each other.
const NAMED: [u32; 4] = [80, 20, 10, 5];

/// Who stands near the way of the walk.
const BYSTANDER: &str = "[[actor]]\nheight = 1850.0\n[actor.motion]\ngait = \"stand\"\nat = [900.0, 700.0]\n";

/// What happens to the pictures of some frames.
struct Script {
    name: &'static str,
    frames: Range<usize>,
    /// Cameras that it happens to.
    cameras: &'static [&'static str],
    what: What,
}

enum What {
    /// They show the empty room: the person has left, or the camera shows its last background.
    Empty,
    /// They are black: the camera is off.
    Black,
    /// They show another person beside the one who walks.
    Bystander,
    /// They show the same as all frames at the end of the walk shifted by as many: a cut, after which the person is elsewhere.
    Cut(usize),
    /// They show what they showed in the first of these frames: the camera stands still.
    Stopped,
    /// They are so many times as bright: somebody turned the light up, or the camera did.
    Brighter(f32),
}

const SCRIPTS: [Script; 8] = [
    Script { name: "undisturbed", frames: 0..0, cameras: &[], what: What::Empty },
    Script { name: "leaves and returns", frames: 30..50, cameras: &CAMERAS, what: What::Empty },
    Script { name: "one camera off", frames: 30..60, cameras: &["cam2"], what: What::Black },
    Script { name: "three cameras off", frames: 30..50, cameras: &["cam1", "cam2", "cam3"], what: What::Empty },
    Script { name: "bystander", frames: 20..70, cameras: &CAMERAS, what: What::Bystander },
    Script { name: "cut", frames: 40..65, cameras: &CAMERAS, what: What::Cut(25) },
    Script { name: "one camera stops", frames: 30..60, cameras: &["cam2"], what: What::Stopped },
    Script { name: "light turned up", frames: 30..90, cameras: &CAMERAS, what: What::Brighter(1.4) },
];

fn pantin(arguments: &[&str]) {
    succeeded(&support::pantin(arguments));
}

/// The walk of `frames` frames in a folder; `others` are more people, as TOML.
fn make(folder: &Path, frames: usize, others: &str) {
    let scene = folder.with_extension("toml");
    let walker = "[[actor]]\n[actor.motion]\ngait = \"circle\"\n";
    fs::create_dir_all(folder.parent().unwrap()).unwrap();
    fs::write(&scene, format!("frames = {frames}\n[rig]\nsize = [320, 240]\n{walker}{others}")).unwrap();
    pantin(&["synth", scene.to_str().unwrap(), "-o", folder.to_str().unwrap(), "--force"]);
}

/// A sequence after a script, from the plain walk and the one with a bystander; and the frames without a person in them.
fn play(script: &Script, walk: &Path, together: &Path, folder: &Path, frames: usize) {
    fs::create_dir_all(folder.join("frames")).unwrap();
    for name in ["body.toml", "cameras.toml", "sequence.toml", "start.csv", "truth.trc"] {
        fs::copy(walk.join(name), folder.join(name)).unwrap();
    }
    fs::create_dir_all(folder.join("plates")).unwrap();
    for camera in CAMERAS {
        let plate = format!("plates/{camera}.png");
        fs::copy(walk.join(&plate), folder.join(&plate)).unwrap();
        let black = folder.join("black.png");
        let size = image::image_dimensions(walk.join(&plate)).unwrap();
        image::RgbImage::new(size.0, size.1).save(&black).unwrap();
        for frame in 0..frames {
            let picture = |frame: usize| format!("frames/{camera}_{frame:04}.png");
            let is_hit = script.frames.contains(&frame) && script.cameras.contains(&camera);
            if let (What::Brighter(gain), true) = (&script.what, is_hit) {
                let mut seen = image::open(walk.join(picture(frame))).unwrap().to_rgb8();
                seen.iter_mut().for_each(|value| *value = (f32::from(*value) * gain).round() as u8);
                seen.save(folder.join(picture(frame))).unwrap();
                continue;
            }
            let from = match &script.what {
                What::Empty if is_hit => walk.join(&plate),
                What::Black if is_hit => black.clone(),
                What::Bystander if is_hit => together.join(picture(frame)),
                What::Cut(shift) if is_hit => walk.join(picture(frame + shift)),
                What::Stopped if is_hit => walk.join(picture(script.frames.start)),
                _ => walk.join(picture(frame)),
            };
            fs::copy(from, folder.join(picture(frame))).unwrap();
        }
    }
}

/// The frame of the walk that a frame of a script shows; none where nobody is to be seen by two cameras.
fn shown(script: &Script, frame: usize) -> Option<usize> {
    match script.what {
        _ if !script.frames.contains(&frame) => Some(frame),
        What::Cut(shift) => Some(frame + shift),
        What::Empty if script.cameras.len() >= 3 => None,
        _ => Some(frame),
    }
}

/// Mean distance of the joints in a frame of a track from those of a frame of the truth, mm; none in a gap.
fn off_by(ours: &PointTrajectory, frame: usize, truth: &PointTrajectory, true_frame: usize) -> Option<f64> {
    let distances: Vec<f64> = ours
        .names
        .iter()
        .zip(&ours.frames[frame])
        .filter_map(|(name, point)| Some(point.as_ref()?.distance(truth.frames[true_frame][truth.column(name)?]?)))
        .collect();
    (!distances.is_empty()).then(|| distances.iter().sum::<f64>() / distances.len() as f64)
}

/// A column of a track's confidence.csv.
fn column(track: &Path, name: &str) -> Vec<String> {
    let mut reader = csv::Reader::from_path(track.join("confidence.csv")).unwrap();
    let place = reader.headers().unwrap().iter().position(|known| known == name).unwrap();
    reader.records().map(|record| record.unwrap()[place].to_string()).collect()
}

/// Tracks a sequence. What the program said.
fn track(sequence: &Path, output: &Path, seed: usize, budget: [&str; 2], recover: &str) -> String {
    let [sequence, output] = [sequence, output].map(|path| path.to_str().unwrap());
    let seed = seed.to_string();
    let [particles, iterations] = budget;
    let search = ["--particles", particles, "--iterations", iterations, "--seed", &seed];
    let rest = ["--backend", "cpu", "--overlay-every", "0", "--recover", recover, "--force"];
    let done = support::pantin(&[&["track", sequence, "-o", output], &search[..], &rest[..]].concat());
    succeeded(&done);
    support::stderr(&done)
}

/// That a track is sure of every frame of the walk, and off by less than that in it, mm.
#[track_caller]
fn assert_followed(output: &Path, walk: &Path, most: f64) {
    let truth = read_points(&walk.join("truth.trc")).unwrap();
    let joints = read_points(&output.join("joints.csv")).unwrap();
    for (frame, state) in column(output, "state").iter().enumerate() {
        assert_eq!(state, "sure", "frame {frame}");
        let off = off_by(&joints, frame, &truth, frame).unwrap();
        assert!(off < most, "frame {frame} is {off} mm off");
    }
}

fn scratch(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

#[test]
fn a_person_who_leaves_is_a_gap_and_is_found_again() {
    let folder = tempfile::tempdir().unwrap();
    let [walk, played, output] = ["walk", "played", "track"].map(|name| folder.path().join(name));
    make(&walk, 24, "");
    let script = Script { name: "", frames: 5..20, cameras: &CAMERAS, what: What::Empty };
    play(&script, &walk, &walk, &played, 24);
    track(&played, &output, 1, ["150", "8"], "yes");
    let states = column(&output, "state");
    for (frame, state) in states.iter().enumerate() {
        let is_away = (5..20).contains(&frame);
        assert!(!is_away || state == "lost", "frame {frame} is {state}");
        assert!(frame >= 5 || state == "sure", "frame {frame} is {state}");
    }
    assert_eq!(states[23], "sure", "{states:?}");
    // Every file has its 24 rows, and gaps where he is away.
    let rows = |name: &str| fs::read_to_string(output.join(name)).unwrap().lines().count() - 1;
    assert_eq!((rows("poses.csv"), rows("confidence.csv")), (24, 24));
    let truth = read_points(&walk.join("truth.trc")).unwrap();
    for name in ["joints.csv", "joints.trc", "joints_opensim.trc", "markers.c3d"] {
        let points = read_points(&output.join(name)).unwrap();
        assert_eq!(points.frames.len(), 24, "{name}");
        for (frame, row) in points.frames.iter().enumerate() {
            let is_gap = row.iter().all(Option::is_none);
            assert_eq!(is_gap, states[frame] == "lost", "{name}, frame {frame}");
        }
    }
    // The motion for OpenSim has a row a frame that is no gap.
    let sure = states.iter().filter(|state| *state == "sure").count();
    for name in ["motion.mot", "motion_sd.mot"] {
        let text = fs::read_to_string(output.join(name)).unwrap();
        let (header, table) = text.split_once("endheader\n").unwrap();
        assert!(header.contains(&format!("nRows={sure}\n")) && table.lines().count() == 1 + sure, "{name}: {header}");
        let times: Vec<f64> =
            table.lines().skip(1).map(|row| row.split('\t').next().unwrap().parse().unwrap()).collect();
        let expected: Vec<f64> =
            (0..24).filter(|&frame| states[frame] == "sure").map(|frame| frame as f64 / 25.0).collect();
        assert_eq!(times, expected, "{name}");
    }
    let joints = read_points(&output.join("joints.csv")).unwrap();
    let off = off_by(&joints, 23, &truth, 23).unwrap();
    assert!(off < OFF, "found {off} mm off");
    // The file of motion holds the last pose.
    let poses: Vec<String> = fs::read_to_string(output.join("poses.csv"))
        .unwrap()
        .lines()
        .map(|l| l.split_once(',').unwrap().1.into())
        .collect();
    assert!(poses[6..21].iter().all(|pose| *pose == poses[5]), "the last sure pose stands in");

    // Going on from any frame ends with the same bytes.
    let whole: HashMap<&str, Vec<u8>> = ["poses.csv", "joints.csv", "confidence.csv", "markers.c3d"]
        .map(|name| (name, fs::read(output.join(name)).unwrap()))
        .into();
    let journal = fs::read_to_string(output.join("journal.txt")).unwrap();
    let half: Vec<&str> = journal.lines().take(12).collect();
    fs::write(output.join("journal.txt"), half.join("\n") + "\n").unwrap();
    let [sequence, out] = [&played, &output].map(|path| path.to_str().unwrap());
    let search = ["--particles", "150", "--iterations", "8", "--seed", "1"];
    let rest = ["--backend", "cpu", "--overlay-every", "0", "--recover", "yes", "--resume"];
    pantin(&[&["track", sequence, "-o", out], &search[..], &rest[..]].concat());
    for (name, bytes) in whole {
        assert!(fs::read(output.join(name)).unwrap() == bytes, "{name} is another after going on");
    }
}

/// Somebody else comes by, in most pictures beside her or before her and taller: she is neither lost nor left for him.
#[test]
fn who_comes_by_is_neither_a_loss_nor_taken_for_her() {
    let folder = tempfile::tempdir().unwrap();
    let [walk, together, played, output] = ["walk", "together", "played", "track"].map(|name| folder.path().join(name));
    make(&walk, 16, "");
    make(&together, 16, BYSTANDER);
    let script = Script { name: "", frames: 6..14, cameras: &CAMERAS, what: What::Bystander };
    play(&script, &walk, &together, &played, 16);
    track(&played, &output, 1, ["100", "8"], "yes");
    assert_followed(&output, &walk, OFF);
}

/// A camera stands still while she walks on: it is named, left out where it does not fit the others, and does not draw her aside.
#[test]
fn a_camera_that_stops_is_left_out_and_named() {
    let folder = tempfile::tempdir().unwrap();
    let [walk, played, output] = ["walk", "played", "track"].map(|name| folder.path().join(name));
    make(&walk, 26, "");
    let script = Script { name: "", frames: 4..20, cameras: &["cam2"], what: What::Stopped };
    play(&script, &walk, &walk, &played, 26);
    let said = track(&played, &output, 1, ["100", "8"], "yes");
    assert!(said.contains("camera \"cam2\" does not fit what the others show in frames"), "{said}");
    assert!(!["cam1", "cam3", "cam4"].iter().any(|camera| said.contains(&format!("camera {camera:?}"))), "{said}");
    let left_out: Vec<bool> = column(&output, "cam2.f1").iter().map(String::is_empty).collect();
    assert!(left_out[10..20].iter().all(|left_out| *left_out), "{left_out:?}");
    assert!(!left_out[..4].iter().chain(&left_out[23..]).any(|left_out| *left_out), "{left_out:?}");
    assert_followed(&output, &walk, 60.0);
}

/// The light is turned up from one frame to the next, so far that half of the room is white in the pictures.
#[test]
fn who_is_seen_in_another_light_is_not_lost() {
    let folder = tempfile::tempdir().unwrap();
    let [walk, played, output] = ["walk", "played", "track"].map(|name| folder.path().join(name));
    make(&walk, 16, "");
    let script = Script { name: "", frames: 8..16, cameras: &CAMERAS, what: What::Brighter(1.4) };
    play(&script, &walk, &walk, &played, 16);
    track(&played, &output, 1, ["100", "8"], "yes");
    assert_followed(&output, &walk, 60.0);
}

/// The numbers and the plot of docs/CONFIDENCE.md, in `target/tmp/losses`:
/// `cargo test --release --test program losses:: -- --ignored --nocapture`.
#[test]
#[ignore = "minutes; run it in release"]
fn misses_against_false_alarms() {
    let (folder, frames, seeds) = (scratch("losses"), 90, 1..=3);
    let [walk, together] = ["walk", "together"].map(|name| folder.join(name));
    make(&walk, frames, "");
    make(&together, frames, BYSTANDER);
    let truth = read_points(&walk.join("truth.trc")).unwrap();
    // The probability that the pose is wrong, and how far the frame is off: without end where there is nobody.
    let mut judged: Vec<(f64, f64)> = Vec::new();
    println!(
        "| script | N x K | off by > {OFF} mm or nobody, `--recover no` | said lost | with recovery: gaps | error of the rest, mm | off by > {OFF} mm and not a gap |"
    );
    println!("|---|---|---|---|---|---|---|");
    for script in &SCRIPTS {
        let played = folder.join("played").join(script.name);
        play(script, &walk, &together, &played, frames);
        for budget in [["300", "15"], ["100", "8"]] {
            let mut counts = [0; 4];
            let (mut sum, mut sure) = (0.0, 0);
            for seed in seeds.clone() {
                let output = folder.join("track");
                for recover in ["no", "yes"] {
                    track(&played, &output, seed, budget, recover);
                    let joints = read_points(&output.join("joints.csv")).unwrap();
                    let (wrong, states) = (column(&output, "wrong"), column(&output, "state"));
                    for frame in 0..frames {
                        let off = shown(script, frame).and_then(|real| off_by(&joints, frame, &truth, real));
                        let is_off = off.is_none_or(|off| off > OFF);
                        let is_lost = states[frame] == "lost";
                        if recover == "no" {
                            judged.push((wrong[frame].parse().unwrap(), off.unwrap_or(f64::INFINITY)));
                            counts[0] += usize::from(is_off);
                            counts[1] += usize::from(is_lost);
                        } else {
                            counts[2] += usize::from(is_lost);
                            counts[3] += usize::from(is_off && !is_lost);
                            if let (false, Some(off)) = (is_lost, off) {
                                sum += off;
                                sure += 1;
                            }
                        }
                    }
                }
            }
            let [off, said, lost, missed] = counts;
            let (name, [particles, iterations]) = (script.name, budget);
            let mean = sum / f64::from(sure.max(1));
            let without = seeds.clone().count() * (0..frames).filter(|frame| shown(script, *frame).is_none()).count();
            let without = if without > 0 { format!(" ({without} without)") } else { String::new() };
            println!(
                "| {name}{without} | {particles} x {iterations} | {off} | {said} | {lost} | {mean:.1} | {missed} |"
            );
        }
    }
    let curves = BOUNDS.map(|bound| (bound, rates(&judged, bound)));
    let mut text = "off_by_mm,wrong,misses,false_alarms\n".to_string();
    for (bound, rates) in &curves {
        for (percent, [misses, alarms]) in rates.iter().enumerate() {
            writeln!(text, "{bound},{},{misses:.4},{alarms:.4}", percent as f64 / 100.0).unwrap();
        }
    }
    fs::write(folder.join("roc.csv"), text).unwrap();
    let farthest_first = || curves.iter().rev();
    let columns = farthest_first().map(|(bound, _)| format!(" misses, off by > {bound} mm | false alarms |"));
    println!(
        "\n| lost from this `wrong` on |{}\n|---|{}",
        columns.collect::<String>(),
        "---|---|".repeat(BOUNDS.len())
    );
    for percent in MARKED {
        let cells = farthest_first().map(|(_, rates)| {
            let [misses, alarms] = rates[percent as usize].map(|rate| rate * 100.0);
            format!(" {misses:.1} % | {alarms:.1} % |")
        });
        println!("| {:.2} |{}", f64::from(percent) / 100.0, cells.collect::<String>());
    }
    draw(&folder.join("roc.svg"), &curves);
    let (_, farthest) = &curves[BOUNDS.len() - 1];
    let best = farthest.iter().map(|[misses, alarms]| misses + alarms).fold(2.0, f64::min);
    assert!(best < 0.3, "misses and false alarms add up to {best} at best");
}

/// Where frames count as lost from a `wrong` of 0 to 100 % on: the share of those off by more than `bound` that pass for sure, and of the others that
/// count as lost.
fn rates(judged: &[(f64, f64)], bound: f64) -> Vec<[f64; 2]> {
    let rate = |percent| {
        let least = f64::from(percent) / 100.0;
        let share = |is_off: bool| {
            let all = judged.iter().filter(|(_, off)| (*off > bound) == is_off);
            let lost = all.clone().filter(|(wrong, _)| *wrong >= least).count();
            lost as f64 / all.count().max(1) as f64
        };
        [1.0 - share(true), share(false)]
    };
    (0..=100).map(rate).collect()
}

fn draw(path: &Path, curves: &[(f64, Vec<[f64; 2]>)]) {
    let root = SVGBackend::new(path, (520, 440)).into_drawing_area();
    root.fill(&WHITE).unwrap();
    let mut chart = ChartBuilder::on(&root)
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(50)
        .build_cartesian_2d(0.0..1.0, 0.0..1.0)
        .unwrap();
    chart.configure_mesh().light_line_style(WHITE).x_desc("false alarms").y_desc("misses").draw().unwrap();
    for ((bound, rates), colour) in curves.iter().zip([BLUE, RED, BLACK]) {
        chart
            .draw_series(LineSeries::new(rates.iter().map(|[misses, alarms]| (*alarms, *misses)), colour))
            .unwrap()
            .label(format!("off by more than {bound} mm"))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour));
        let marks = MARKED.map(|percent| {
            let [misses, alarms] = rates[percent as usize];
            let is_named = *bound == OFF && NAMED.contains(&percent);
            let name = if is_named { format!("{:.2}", f64::from(percent) / 100.0) } else { String::new() };
            EmptyElement::at((alarms, misses))
                + Circle::new((0, 0), 3, colour.filled())
                + Text::new(name, (6, -12), ("sans-serif", 12))
        });
        chart.draw_series(marks).unwrap();
    }
    chart.configure_series_labels().border_style(BLACK).background_style(WHITE).draw().unwrap();
    root.present().unwrap();
}

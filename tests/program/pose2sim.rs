//! `pantin pose2sim` from outside: projects of Pose2Sim with numbered pictures and with videos, what they inherit, and what is wrong with them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, SystemTime};

use image::{Rgb, RgbImage};
use pantin::body::HALPE26;
use pantin::motion::read_points;
use pantin::sequence::{LargeGaps, Pose2SimTrial, pose2sim_trials};
use tempfile::TempDir;

use super::support::{has_ffmpeg, pantin, refused, stderr, stdout, succeeded};
use super::walk;

/// What a session says, and nothing that a trial changes.
const SESSION: &str = "[project]\nmulti_person = false\nparticipant_height = 'auto'\nframe_rate = 25\nframe_range = [0, 2]\n\
    exclude_from_batch = ['Trial_2']\n[pose]\npose_model = 'Body_with_feet'\n[triangulation]\ninterp_if_gap_smaller_than = 7\n\
    fill_large_gaps_with = 'nan'\n";

/// A session with two trials of the same step: pictures, one calibration for both, plates and the body beside it.
struct Session {
    folder: TempDir,
}

impl Session {
    fn new() -> Self {
        let session = Self { folder: tempfile::tempdir().unwrap() };
        let source = session.path("source");
        fs::create_dir(&source).unwrap();
        walk::write(&source);
        session.write("session/Config.toml", SESSION);
        session.write("session/Trial_1/Config.toml", "[project]\nframe_range = [1, 5]\n");
        session.write("session/Trial_2/Config.toml", "[project]\nmulti_person = true\n");
        session.write("session/Calibration/notes.txt", "on a Monday");
        fs::copy(source.join("cameras.toml"), session.path("session/Calibration/Calib_scene.toml")).unwrap();
        fs::create_dir(session.path("plates")).unwrap();
        for camera in walk::cameras() {
            let videos = session.path("session/Trial_1/videos").join(&camera.name);
            fs::create_dir_all(&videos).unwrap();
            for frame in 0..walk::FRAMES {
                let name = format!("{}_{frame:04}.png", camera.name);
                fs::copy(source.join("frames").join(&name), videos.join(&name)).unwrap();
            }
            let plate = RgbImage::from_pixel(camera.size[0], camera.size[1], Rgb([40, 60, 50]));
            plate.save(session.path("plates").join(format!("{}.png", camera.name))).unwrap();
        }
        session
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn text(&self, name: &str) -> String {
        self.path(name).to_str().unwrap().to_string()
    }

    fn write(&self, name: &str, text: &str) {
        let file = self.path(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, text).unwrap();
    }

    /// The command on a folder of it, with the body and a first pose that are known.
    fn run(&self, project: &str, more: &[&str]) -> Output {
        let (body, start) = (self.text("source/body.toml"), self.text("source/start.csv"));
        let plates = self.text("plates");
        let known = ["--body", &body, "--start", &start, "--plates", &plates, "--recover", "no"];
        self.run_alone(project, &[&known[..], more].concat())
    }

    fn run_alone(&self, project: &str, more: &[&str]) -> Output {
        let quick = ["--particles", "24", "--iterations", "3", "--overlay-every", "0", "--backend", "cpu"];
        pantin(&[&["pose2sim", &self.text(project)], &quick[..], more].concat())
    }

    fn trials(&self) -> Vec<Pose2SimTrial> {
        pose2sim_trials(&self.path("session")).unwrap()
    }

    #[track_caller]
    fn refuses(&self, parts: &[&str]) {
        let error = format!("{:#}", pose2sim_trials(&self.path("session")).unwrap_err());
        for part in parts {
            assert!(error.contains(part), "`{error}` lacks `{part}`");
        }
        assert_eq!(error.lines().count(), 1, "{error}");
    }
}

#[test]
fn a_session_is_tracked_and_written_as_pose2sim_writes_it() {
    let session = Session::new();
    let done = session.run("session", &[]);
    succeeded(&done);
    let said = stderr(&done);
    assert!(said.contains("Calib_scene.toml") && said.contains("cam1 filmed videos/cam1/cam1_%04d.png"), "{said}");
    assert!(!session.path("session/Trial_2/pantin").exists(), "the session excludes it");
    let trial = session.path("session/Trial_1");
    let file = trial.join("pose-3d/Trial_1_1-4.trc");
    assert!(stdout(&done).contains("4 frames of 22 points"), "{}", stdout(&done));
    let text = fs::read_to_string(&file).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "PathFileType\t4\t(X/Y/Z)\tTrial_1_1-4.trc");
    assert_eq!(lines[2], "25\t25\t4\t22\tm\t25\t1\t4");
    assert_eq!(lines[3].trim_end().split('\t').skip(2).step_by(3).collect::<Vec<_>>(), HALPE26);
    assert!(lines[5].starts_with("1\t0.040000\t"), "{}", lines[5]);
    assert_eq!(lines.len(), 5 + 4);

    // Metres, y up: (y, z, x) of the world.
    let points = read_points(&file).unwrap().y_up_to_z_up();
    let joints = read_points(&trial.join("pantin/track/joints.csv")).unwrap();
    let column = |names: &[String], name: &str| names.iter().position(|other| other == name).unwrap();
    for (ours, theirs) in [("RKnee", "right_knee"), ("LWrist", "left_wrist"), ("Head", "head_top")] {
        for (points, joints) in points.frames.iter().zip(&joints.frames) {
            let [a, b] =
                [points[column(&HALPE26.map(Into::into), ours)], joints[column(&joints_names(&trial), theirs)]];
            assert!(a.unwrap().distance(b.unwrap()) < 1e-2, "{ours}: {a:?} and {b:?}");
        }
    }

    // Nothing is replaced unasked, and what is foreign never.
    refused(&session.run("session/Trial_1", &[]), &["Trial_1_1-4.trc exists", "--force"]);
    let again = session.run("session/Trial_1", &["--resume"]);
    succeeded(&again);
    assert!(stdout(&again).contains("Trial_1_1-4.trc is there"), "{}", stdout(&again));
    session.write("session/Trial_1/pose-3d/Trial_1_0-99_filt_butterworth.trc", "foreign");
    session.write("session/Trial_1/pantin/notes.txt", "foreign");
    let forced = session.run("session/Trial_1", &["--force"]);
    succeeded(&forced);
    assert!(stderr(&forced).contains("Trial_1_0-99_filt_butterworth.trc too"), "{}", stderr(&forced));
    assert_eq!(fs::read_to_string(&file).unwrap(), text, "the same bytes");
    for foreign in ["pose-3d/Trial_1_0-99_filt_butterworth.trc", "pantin/notes.txt"] {
        assert_eq!(fs::read_to_string(trial.join(foreign)).unwrap(), "foreign");
    }
}

fn joints_names(trial: &Path) -> Vec<String> {
    read_points(&trial.join("pantin/track/joints.csv")).unwrap().names
}

#[test]
fn only_what_is_missing_is_asked_for() {
    let session = Session::new();
    refused(
        &session.run_alone("session", &[]),
        &["Trial_1/Config.toml: project.participant_height is 'auto'", "--height MM", "--body FILE"],
    );
    let plates = session.text("plates");
    fs::remove_file(session.path("plates/cam3.png")).unwrap();
    refused(&session.run_alone("session", &["--height", "1750", "--plates", &plates]), &["plates holds no cam3.png"]);
    let start = session.text("source/start.csv");
    refused(&session.run_alone("session", &["--height", "1750", "--start", &start]), &["--start", "--body FILE"]);
    session.write("session/Config.toml", &SESSION.replace("frame_rate = 25", "frame_rate = 'auto'"));
    refused(&session.run("session", &[]), &["project.frame_rate is 'auto'", "--fps HZ"]);
    assert!(!session.path("session/Trial_1/pantin").exists(), "all that is said before anything is written");
    assert!(!session.path("session/Trial_1/pose-3d").exists());
}

/// What fails after the manifest was written is no reason to ask for --force; a run that was stopped is gone on with.
#[test]
fn a_second_try_needs_no_force_and_a_stopped_run_is_gone_on_with() {
    let session = Session::new();
    let plate = session.path("plates/cam0.png");
    RgbImage::new(20, 20).save(&plate).unwrap();
    refused(&session.run("session", &[]), &["Trial_1: ", "cam0.png is 20x20 pixels"]);
    RgbImage::from_pixel(160, 120, Rgb([40, 60, 50])).save(&plate).unwrap();
    succeeded(&session.run("session", &[]));
    let trial = session.path("session/Trial_1");
    let points = trial.join("pose-3d/Trial_1_1-4.trc");
    let text = fs::read(&points).unwrap();
    fs::remove_file(&points).unwrap();
    refused(&session.run("session", &[]), &["track is not empty", "--force"]);
    let journal = trial.join("pantin/track/journal.txt");
    let lines = fs::read_to_string(&journal).unwrap();
    let half: String = lines.lines().take(2).map(|line| format!("{line}\n")).collect();
    fs::write(&journal, half).unwrap();
    succeeded(&session.run("session", &["--resume"]));
    assert_eq!(fs::read(&points).unwrap(), text, "the same bytes as in one go");
}

/// The height comes from the configuration, body and first pose from the pictures.
#[test]
fn a_project_that_says_all_needs_no_more_than_plates() {
    let session = Session::new();
    session.write("session/Trial_1/Config.toml", "[project]\nparticipant_height = 1.75\nframe_range = [0, 1]\n");
    // Six frames are too few to learn the empty scene from.
    refused(
        &session.run_alone("session", &[]),
        &["neither a background picture nor masks", "to measure a person with"],
    );
    let done = session.run_alone("session", &["--plates", &session.text("plates")]);
    succeeded(&done);
    assert!(session.path("session/Trial_1/pantin/track/found_body.toml").is_file());
    // A body that was measured in one second is measured again while tracking, where there are frames enough.
    let said = stderr(&done);
    assert!(said.contains("not measured again: the first pass tells of the body in 1 of its frames"), "{said}");
    let points = read_points(&session.path("session/Trial_1/pose-3d/Trial_1_0-0.trc")).unwrap().y_up_to_z_up();
    let of = |name: &str| points.frames[0][HALPE26.iter().position(|other| *other == name).unwrap()].unwrap();
    println!("head at {:.0}, heel at {:.0}, hip at {:.0} mm", of("Head").z, of("RHeel").z, of("Hip").z);
    // 1750, 25 and 873 mm of a person of 1750.
    assert!((of("Head").z - 1750.0).abs() < 25.0, "the head is at {} mm", of("Head").z);
    assert!(of("RHeel").z.abs() < 60.0 && (of("Hip").z - 873.0).abs() < 40.0);
}

#[test]
fn the_deeper_file_wins_and_the_rest_is_inherited() {
    let session = Session::new();
    let [trial] = &session.trials()[..] else { panic!("one trial") };
    assert_eq!((trial.frames, trial.fps, trial.height), (Some([1, 5]), Some(25.0), None));
    assert_eq!((trial.longest_line, trial.large_gaps), (7, LargeGaps::Nan));
    assert!(!trial.has_other_points());
    session.write(
        "session/Trial_1/Config.toml",
        "[project]\nparticipant_height = [1.72]\nframe_range = 'all'\n[pose]\npose_model = 'BODY_25B'\n\
         [triangulation]\nfill_large_gaps_with = 'last_value'\ninterpolation = 'none'\n",
    );
    // A trial by itself has its session too.
    let [trial] = &pose2sim_trials(&session.path("session/Trial_1")).unwrap()[..] else { panic!("one trial") };
    assert_eq!((trial.frames, trial.fps, trial.height), (None, Some(25.0), Some(1720.0)));
    assert_eq!((trial.longest_line, trial.large_gaps), (0, LargeGaps::LastValue));
    assert!(trial.has_other_points());
    // A level between them, without a file of its own or with one.
    fs::create_dir(session.path("session/Anna")).unwrap();
    fs::rename(session.path("session/Trial_1"), session.path("session/Anna/Trial_1")).unwrap();
    assert_eq!(session.trials()[0].fps, Some(25.0));
    session.write("session/Anna/Config.toml", "[project]\nframe_rate = 50.0\nparticipant_height = 1.6\n");
    let trials = session.trials();
    assert_eq!((trials.len(), trials[0].fps, trials[0].height), (1, Some(50.0), Some(1720.0)));
    assert_eq!(trials[0].name, "Trial_1");
    assert!(trials[0].calibration.ends_with("session/Calibration/Calib_scene.toml"));
}

#[test]
fn the_newest_calibration_nearest_to_the_trial_is_taken() {
    let session = Session::new();
    let of = |name: &str| session.path("session").join(name);
    fs::copy(of("Calibration/Calib_scene.toml"), of("Calibration/a.toml")).unwrap();
    let old = SystemTime::now() - Duration::from_secs(3600);
    fs::File::options().append(true).open(of("Calibration/Calib_scene.toml")).unwrap().set_modified(old).unwrap();
    let trial = &session.trials()[0];
    assert!(trial.calibration.ends_with("a.toml"), "{}", trial.calibration.display());
    assert!(trial.told().contains("not ") && trial.told().contains("Calib_scene.toml"), "{}", trial.told());
    fs::create_dir(of("Trial_1/calib-of-it")).unwrap();
    fs::rename(of("Calibration/a.toml"), of("Trial_1/calib-of-it/b.toml")).unwrap();
    assert!(session.trials()[0].calibration.ends_with("calib-of-it/b.toml"));
}

#[test]
fn cameras_go_by_name_else_by_order() {
    let session = Session::new();
    let pairs = || -> Vec<(String, String)> {
        session.trials()[0].views.iter().map(|view| (view.camera.clone(), view.name.clone())).collect()
    };
    assert!(pairs().iter().all(|(camera, recording)| camera == recording) && pairs().len() == 4);
    let videos = session.path("session/Trial_1/videos");
    for (old, new) in [("cam0", "view12"), ("cam1", "view3"), ("cam2", "view7"), ("cam3", "view9")] {
        fs::rename(videos.join(old), videos.join(new)).unwrap();
    }
    let expected = [("cam0", "view3"), ("cam1", "view7"), ("cam2", "view9"), ("cam3", "view12")];
    assert_eq!(pairs(), expected.map(|(camera, name)| (camera.to_string(), name.to_string())));
    fs::remove_dir_all(videos.join("view12")).unwrap();
    session.refuses(&["Calib_scene.toml holds 4 cameras", "3 recordings"]);
}

#[test]
fn what_is_wrong_with_a_project_is_one_sentence() {
    let session = Session::new();
    let missing = pose2sim_trials(&session.path("nowhere")).unwrap_err().to_string();
    assert!(missing.contains("there is no folder"), "{missing}");
    let bare = pose2sim_trials(&session.path("plates")).unwrap_err().to_string();
    assert!(bare.contains("has no Config.toml"), "{bare}");
    for (line, parts) in [
        ("participant_height = 1720", ["project.participant_height is 1720", "metres, 0.5 to 2.5"]),
        ("participant_height = 'tall'", ["is 'tall'", "'auto' or one person's height"]),
        ("participant_height = [1.7, 1.6]", ["is [1.7, 1.6]", "one person's height"]),
        ("frame_rate = 'fast'", ["project.frame_rate is 'fast'", "a positive number"]),
        ("frame_rate = -60", ["project.frame_rate is -60", "a positive number"]),
        ("frame_range = [5, 2]", ["project.frame_range is [5, 2]", "[first, end]"]),
        ("frame_range = [1]", ["project.frame_range is [1]", "[first, end]"]),
        ("multi_person = 'no'", ["project.multi_person is 'no'", "true or false"]),
        ("multi_person = true", ["project.multi_person is true", "one person"]),
        ("frame_range = [1, 5", ["Config.toml, line 2", ""]),
    ] {
        session.write("session/Trial_1/Config.toml", &format!("[project]\n{line}\n"));
        session.refuses(&[&["Trial_1/Config.toml"], &parts[..]].concat());
    }
    // The file that said it is named, not the one that inherits it.
    session.write("session/Trial_1/Config.toml", "");
    session.write("session/Config.toml", &SESSION.replace("'nan'", "'noughts'"));
    session.refuses(&["session/Config.toml: triangulation.fill_large_gaps_with is 'noughts'", "'last_value'"]);
    session.write("session/Config.toml", &SESSION.replace("['Trial_2']", "['Trial_1', 'Trial_2']"));
    session.refuses(&["exclude_from_batch names all 2 trials"]);
    session.write("session/Config.toml", SESSION);
    fs::rename(session.path("session/Calibration"), session.path("session/cameras")).unwrap();
    session.refuses(&["there is no calibration in", "Trial_1 or ", "expected a folder like `calibration`"]);
    fs::rename(session.path("session/cameras"), session.path("session/Calibration")).unwrap();
    fs::remove_dir_all(session.path("session/Trial_1/videos")).unwrap();
    session.refuses(&["Trial_1 has no folder `videos`"]);
}

#[test]
fn a_rate_that_nobody_says_is_that_of_the_videos() {
    if !has_ffmpeg("a_rate_that_nobody_says_is_that_of_the_videos") {
        return;
    }
    let session = Session::new();
    session.write("session/Config.toml", &SESSION.replace("frame_rate = 25", "frame_rate = 'auto'"));
    let videos = session.path("session/Trial_1/videos");
    let film = |camera: &str, rate: &str| {
        let pictures = videos.join(camera).join(format!("{camera}_%04d.png"));
        let mut command = Command::new("ffmpeg");
        command.args(["-v", "error", "-y", "-framerate", rate, "-i"]).arg(pictures);
        command.args(["-pix_fmt", "yuv420p", "-c:v", "mpeg4", "-q:v", "2"]).arg(videos.join(format!("{camera}.mp4")));
        assert!(command.status().unwrap().success());
    };
    for camera in ["cam0", "cam1", "cam2", "cam3"] {
        film(camera, "30000/1001");
    }
    let trial = &session.trials()[0];
    assert_eq!(trial.fps, Some(30.0), "rounded, as Pose2Sim rounds it");
    assert!(trial.views[0].source.ends_with("videos/cam0.mp4"));
    succeeded(&session.run("session", &[]));
    let text = fs::read_to_string(session.path("session/Trial_1/pose-3d/Trial_1_1-4.trc")).unwrap();
    assert!(text.contains("\n30\t30\t4\t22\tm\t"), "{text}");
    film("cam3", "50");
    session.refuses(&["cam3.mp4 has 50 frames a second", "cam0.mp4 has 30", "one rate"]);
}

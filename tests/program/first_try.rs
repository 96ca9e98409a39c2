//! The way from videos to a first track, line by line as the README and the guide write it.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use super::support::{has_ffmpeg, pantin, pantin_in, refused_in, stderr, stdout, succeeded};

const FRAMES: usize = 24;

/// Videos of a walk in `videos/`, called after their cameras, and `cameras.toml`.
fn film(folder: &Path) {
    let scene = folder.join("scene.toml");
    let text = format!(
        "name = \"film\"\nframes = {FRAMES}\n[output]\npictures = \"video\"\n[rig]\nsize = [160, 120]\n\
         [[actor]]\nheight = 1750.0\nmotion = {{ gait = \"straight\", stride_time = 1.2 }}\n"
    );
    fs::write(&scene, text).unwrap();
    let made = folder.join("made");
    succeeded(&pantin(&["synth", scene.to_str().unwrap(), "-o", made.to_str().unwrap()]));
    fs::rename(made.join("videos"), folder.join("videos")).unwrap();
    fs::rename(made.join("cameras.toml"), folder.join("cameras.toml")).unwrap();
}

/// Runs a line in a shell that knows the program.
fn run(folder: &Path, line: &str) -> Output {
    let program = Path::new(env!("CARGO_BIN_EXE_pantin")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    Command::new("sh").args(["-c", line]).env("PATH", path).current_dir(folder).output().unwrap()
}

/// The lines of the first block of commands after a heading that begin with the program's name, without what is said of them.
fn lines(document: &str, heading: &str) -> Vec<String> {
    let section = &document[document.find(heading).unwrap()..];
    let section = &section[..section[3..].find("\n## ").map_or(section.len(), |end| end + 3)];
    let commands = section.lines().map(str::trim).filter(|line| line.starts_with("pantin "));
    commands.map(|line| line.split(" #").next().unwrap().trim().to_string()).collect()
}

const QUICK: [&str; 4] = ["--particles", "40", "--iterations", "2"];

/// `pantin start` with all videos of a folder.
fn start(folder: &Path, videos: &str, more: &[&str]) -> (i32, String, String) {
    let mut videos: Vec<String> = fs::read_dir(folder.join(videos))
        .unwrap()
        .map(|entry| format!("{videos}/{}", entry.unwrap().file_name().to_string_lossy()))
        .collect();
    videos.sort();
    let mut arguments = vec!["start"];
    arguments.extend(videos.iter().map(String::as_str));
    arguments.extend(["--cameras", "cameras.toml", "--height", "1750"]);
    arguments.extend(more);
    pantin_in(folder, &arguments)
}

/// What a user wrote into the manifest of `walk` is there after `start --force`, and said to be.
fn replaced_manifests_keep_what_their_user_wrote(folder: &Path, manifest: &str) {
    let path = folder.join("walk/sequence.toml");
    let camera = manifest.split("camera = \"").nth(1).unwrap().split('"').next().unwrap();
    let own = manifest.replacen("[[view]]\n", "[[view]]\ndelay = -1\norientation = \"stored\"\n", 1);
    let own = own.replace("fps = 25.0", "fps = 24.0\ntimestamps = \"ignore\"");
    let own =
        own.replacen("background = \"plates/", "background = \"../filmed_", 1) + "\n[features.shadow]\nchroma = 5\n";
    fs::copy(folder.join(format!("walk/plates/{camera}.png")), folder.join(format!("filmed_{camera}.png"))).unwrap();
    fs::write(&path, &own).unwrap();
    let (status, _, error) = start(folder, "videos", &[&["-o", "walk", "--force"], &QUICK[..]].concat());
    assert_eq!(status, 0, "{error}");
    let table = |text: &str| text.parse::<toml::Table>().unwrap();
    let made = fs::read_to_string(&path).unwrap();
    let (mut made, mut own) = (table(&made), table(&own));
    // Learnt anew, from as many frames as are left.
    for table in [&mut made, &mut own] {
        let views = table["view"].as_array_mut().unwrap();
        views.iter_mut().for_each(|view| drop(view.as_table_mut().unwrap().remove("background_doubtful")));
        views.sort_by_key(|view| view["camera"].as_str().unwrap().to_string());
    }
    assert_eq!(made, own);
    for kept in ["`fps = 24`", "`timestamps`", "[features]", "`delay`", "`orientation`", "`background` of camera"] {
        assert!(error.contains(kept), "{kept}: {error}");
    }
    fs::write(&path, manifest.to_string() + "[[person]]\nname = \"a\"\n").unwrap();
    let (status, _, error) = start(folder, "videos", &["-o", "walk", "--force"]);
    assert!(status == 1 && error.contains("sequence.toml has [[person]]"), "{error}");
    fs::write(path, manifest).unwrap();
}

/// One video upside down: `start` says so, and how to put it right.
fn pictures_upside_down_are_said(folder: &Path) {
    fs::create_dir(folder.join("turned")).unwrap();
    let mut names = Vec::new();
    for video in fs::read_dir(folder.join("videos")).unwrap() {
        let video = video.unwrap();
        names.push(video.path().file_stem().unwrap().to_string_lossy().into_owned());
        fs::copy(video.path(), folder.join("turned").join(video.file_name())).unwrap();
    }
    names.sort();
    let camera = &names[1];
    let line =
        format!("ffmpeg -v error -y -i videos/{camera}.mp4 -vf hflip,vflip -c:v mpeg4 -q:v 1 turned/{camera}.mp4");
    let done = Command::new("sh").args(["-c", &line]).current_dir(folder).output().unwrap();
    assert!(done.status.success(), "{}", stderr(&done));
    let (_, _, error) = start(folder, "turned", &[&["-o", "upside"], &QUICK[..]].concat());
    let said =
        format!("{camera} agrees with the others when its picture is turned by 180 degrees: write `orientation = 180`");
    assert!(error.contains(&said), "{error}");
    let how = format!("{camera}=180");
    let (_, _, error) =
        start(folder, "turned", &[&["-o", "upside", "--force", "--orientation", &how], &QUICK[..]].concat());
    assert!(!error.contains("agrees with the others when"), "{error}");
    let manifest = fs::read_to_string(folder.join("upside/sequence.toml")).unwrap();
    assert!(manifest.contains("orientation = 180"), "{manifest}");
}

/// Videos of different lengths are begun with as far as all go, and it is said that nothing tells when they were started.
fn lengths_may_differ(folder: &Path) {
    fs::create_dir(folder.join("hand")).unwrap();
    for (at, video) in fs::read_dir(folder.join("videos")).unwrap().enumerate() {
        let video = video.unwrap();
        let to = folder.join("hand").join(video.file_name());
        let frames = if at == 1 { 21 } else { FRAMES };
        let cut = Command::new("ffmpeg")
            .args(["-v", "error", "-i"])
            .arg(video.path())
            .args(["-frames:v", &frames.to_string(), "-c", "copy"])
            .arg(&to)
            .status();
        assert!(cut.unwrap().success());
    }
    let (status, said, error) = start(folder, "hand", &[&["-o", "by_hand"], &QUICK[..]].concat());
    assert!(status == 0 && said.contains(": 21 frames, "), "{said}{error}");
    assert!(error.contains("21 are taken, those of all"), "{error}");
    assert!(error.contains("silhouettes agree with the first pictures") || error.contains("leave open"), "{error}");
}

#[test]
fn the_lines_of_readme_and_guide_lead_to_a_track() {
    if !has_ffmpeg("the_lines_of_readme_and_guide_lead_to_a_track") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    film(folder);
    let readme = lines(include_str!("../../README.md"), "\n## Your own footage");
    let guide = include_str!("../../docs/GUIDE.md");
    let begin = lines(guide, "\n## 3. Begin");
    assert!(readme.len() >= 3 && readme[0].starts_with("pantin start "), "{readme:?}");
    assert_eq!(begin[0], readme[0], "both begin alike");
    let mut asked: Vec<String> = readme.iter().take(3).cloned().collect();
    asked.extend(lines(guide, "\n## 4. Look").into_iter().filter(|line| line.starts_with("pantin features")));
    for line in asked {
        let done = run(folder, &line);
        // What a check finds in pictures this small is no matter here.
        assert!(done.status.success() || stderr(&done).contains("checks failed"), "{line}: {}", stderr(&done));
        if line.starts_with("pantin start") {
            let said = stdout(&done);
            assert!(said.contains("look/silhouettes.png") && said.contains("pantin track walk"), "{said}");
        }
    }
    for file in
        ["walk/sequence.toml", "walk/body.toml", "walk/start.csv", "walk/look/silhouettes.png", "walk/look/body.png"]
    {
        assert!(folder.join(file).is_file(), "{file}");
    }
    let manifest = fs::read_to_string(folder.join("walk/sequence.toml")).unwrap();
    assert_eq!(manifest.matches("background = \"plates/").count(), 4, "{manifest}");
    let poses = fs::read_to_string(folder.join("result/poses.csv")).unwrap();
    assert_eq!(poses.lines().count(), 1 + FRAMES);

    replaced_manifests_keep_what_their_user_wrote(folder, &manifest);
    pictures_upside_down_are_said(folder);
    lengths_may_differ(folder);

    // What is there is kept unless told otherwise, and what cannot begin is one sentence.
    let start = |more: &[&str]| start(folder, "videos", more);
    // With filmed plates nothing is learnt; their names may say more than the camera's.
    let (status, said, error) = start(&[&["-o", "filmed", "--plates", "walk/plates"], &QUICK[..]].concat());
    assert!(status == 0 && said.contains("plate filmed"), "{said}{error}");
    let filmed = fs::read_to_string(folder.join("filmed/sequence.toml")).unwrap();
    assert_eq!(filmed.matches("background = \"../walk/plates/").count(), 4, "{filmed}");
    assert!(!folder.join("filmed/plates").exists());
    fs::create_dir(folder.join("named")).unwrap();
    for plate in fs::read_dir(folder.join("walk/plates")).unwrap() {
        let plate = plate.unwrap();
        let name = format!("bg_{}", plate.file_name().to_string_lossy());
        fs::copy(plate.path(), folder.join("named").join(name)).unwrap();
    }
    let (status, said, error) = start(&[&["-o", "filmed2", "--plates", "named"], &QUICK[..]].concat());
    assert!(status == 0 && said.contains("plate filmed"), "{said}{error}");
    let (status, _, error) = start(&["-o", "none", "--plates", "videos"]);
    assert!(status == 1 && error.contains("expected a picture of the empty scene of each camera"), "{error}");
    assert!(!folder.join("none").exists(), "nothing is made where nothing can begin");
    let (status, _, error) = start(&["-o", "walk"]);
    assert!(status == 1 && error.contains("sequence.toml exists") && error.contains("--force"), "{error}");
    assert_eq!(fs::read_to_string(folder.join("walk/sequence.toml")).unwrap(), manifest);
    let first = fs::read_dir(folder.join("videos")).unwrap().next().unwrap().unwrap().path();
    fs::copy(&first, folder.join("GX0042.mp4")).unwrap();
    let first = first.to_str().unwrap();
    let with = |video: &str| {
        ["start", first, video, "--cameras", "cameras.toml", "--height", "1750", "-o", "other"].map(String::from)
    };
    let with_other = with("GX0042.mp4");
    let with_other: Vec<&str> = with_other.iter().map(String::as_str).collect();
    refused_in(folder, &with_other, "GX0042.mp4 is of no camera by its name");
    assert!(!folder.join("other").exists(), "nothing is made where nothing can begin");
    let low: Vec<&str> = with_other.iter().map(|word| if *word == "1750" { "1.75" } else { word }).collect();
    refused_in(folder, &low, "the person's height is 1.75, expected 500 to 2500 mm");
}

/// Two people are seen: one is measured and the other said, or both are measured, named and tracked together.
#[test]
fn several_people_are_begun_together() {
    if !has_ffmpeg("several_people_are_begun_together") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let scene = "name = \"two\"\nframes = 8\n[output]\npictures = \"video\"\n[rig]\nsize = [240, 180]\n\
                 [[actor]]\nheight = 1850.0\nmotion = { gait = \"straight\", at = [300.0, 200.0] }\n\
                 [[actor]]\nheight = 1600.0\nmotion = { gait = \"stand\", at = [-900.0, -700.0], heading = 90.0 }\n";
    fs::write(folder.join("scene.toml"), scene).unwrap();
    let (status, _, error) = pantin_in(folder, &["synth", "scene.toml", "-o", "made"]);
    assert_eq!(status, 0, "{error}");
    let begin = |heights: &str, more: &[&str]| {
        let mut arguments = vec!["start".to_string()];
        for camera in ["cam1", "cam2", "cam3", "cam4"] {
            arguments.push(format!("made/videos/{camera}.mp4"));
        }
        let flags = ["--cameras", "made/cameras.toml", "--plates", "made/plates", "--height", heights];
        arguments.extend(flags.iter().chain(more).map(|word| (*word).to_string()));
        arguments.extend(["--particles", "60", "--iterations", "6"].map(String::from));
        pantin_in(folder, &arguments.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let pelvis = |file: &str| -> [f64; 2] {
        let text = fs::read_to_string(folder.join(file)).unwrap();
        let row = text.lines().nth(1).unwrap().split(',').map(|value| value.parse().unwrap());
        let row: Vec<f64> = row.collect();
        [row[1], row[2]]
    };
    let first = pelvis("made/start.csv");
    let is_at = |found: [f64; 2], at: [f64; 2]| (found[0] - at[0]).hypot(found[1] - at[1]) < 150.0;

    let (status, said, error) = begin("1600", &["--at", "-900,-700", "--frames", "2..3", "-o", "one"]);
    assert_eq!(status, 0, "{error}");
    assert!(error.contains("2 people are seen in frame 2: the one at -"), "{error}");
    assert!(said.ends_with("pantin track one -o one-track --frames 2..\n"), "{said}");
    assert!(is_at(pelvis("one/start.csv"), [-900.0, -700.0]));

    let (status, said, error) = begin("1600,1850", &["--people", "2", "-o", "both"]);
    assert_eq!(status, 0, "{error}");
    assert!(said.contains("person1, both/person1:") && !error.contains("people are seen"), "{said}{error}");
    assert!(is_at(pelvis("both/person1/start.csv"), first), "the tallest is the first");
    assert!(is_at(pelvis("both/person2/start.csv"), [-900.0, -700.0]));
    let manifest = fs::read_to_string(folder.join("both/sequence.toml")).unwrap();
    assert_eq!(manifest.matches("[[person]]").count(), 2, "{manifest}");
    let track = ["track", "both", "-o", "out", "--particles", "20", "--iterations", "2", "--passes", "forward"];
    let (status, _, error) = pantin_in(folder, &track);
    assert_eq!(status, 0, "{error}");
    for person in ["person1", "person2"] {
        let poses = fs::read_to_string(folder.join("out").join(person).join("poses.csv")).unwrap();
        assert_eq!(poses.lines().count(), 1 + 8, "{person}");
    }

    for (heights, more, expected) in [
        ("1750", ["--people", "2"], "--people is 2 and --height names 1"),
        ("1750", ["--at", "4000,0"], "nobody stands within 1000 mm of 4000,0"),
        ("1750", ["--at", "left"], "expected two numbers in mm, X,Y"),
        ("1,2,3", ["--people", "3"], "the person's height is 1, expected 500 to 2500 mm"),
        (
            "1700,1700,1700",
            ["--people", "3"],
            "2 are seen apart in frame 0, expected a frame in which all stand by themselves; in none of the frames that were looked at all are seen apart",
        ),
    ] {
        let (status, _, error) = begin(heights, &[&more[..], &["-o", "none", "--force"]].concat());
        assert!(status != 0 && error.contains(expected), "{error}");
    }
}

/// Who films first and walks in then is measured where he is first seen; who named a frame is told of it.
#[test]
fn an_empty_beginning_is_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let scene = "name = \"late\"\nframes = 9\n[rig]\nsize = [240, 180]\n[[actor]]\nheight = 1750.0\nmotion = { gait = \"stand\" }\n";
    fs::write(folder.join("scene.toml"), scene).unwrap();
    let (status, _, error) = pantin_in(folder, &["synth", "scene.toml", "-o", "made"]);
    assert_eq!(status, 0, "{error}");
    let cameras = ["cam1", "cam2", "cam3", "cam4"];
    let empty = |camera: &str, frames: std::ops::Range<usize>| {
        for frame in frames {
            let [plate, picture] = [format!("plates/{camera}.png"), format!("frames/{camera}_{frame:04}.png")]
                .map(|name| folder.join("made").join(name));
            fs::copy(plate, picture).unwrap();
        }
    };
    cameras.iter().for_each(|camera| empty(camera, 0..4));
    let begin = |more: &[&str]| {
        let videos = cameras.map(|camera| format!("made/frames/{camera}_%04d.png"));
        let mut arguments = vec!["start"];
        arguments.extend(videos.iter().map(String::as_str));
        arguments.extend([
            "--cameras",
            "made/cameras.toml",
            "--plates",
            "made/plates",
            "--height",
            "1750",
            "--fps",
            "10",
        ]);
        arguments.extend(["--particles", "60", "--iterations", "6", "-o", "late", "--force"]);
        pantin_in(folder, &[&arguments[..], more].concat())
    };
    // Every second one is passed over: frames 1, 3, 5 are looked at.
    let (status, said, error) = begin(&[]);
    assert_eq!(status, 0, "{error}");
    let expected = "frame 0: 0 of 4 cameras see a silhouette, expected at least 2: measured in frame 5 instead, where somebody is seen";
    assert!(error.contains(expected), "{error}");
    assert!(said.contains("frames 5, fitness 0."), "{said}");
    assert!(said.ends_with("pantin track late -o late-track --frames 5..\n"), "{said}");
    let (status, _, error) = begin(&["--frames", "2..4"]);
    assert!(
        status == 1
            && error.contains("somebody is seen in frame 4: --frames 4..5, and --frames 4.. for `pantin track`"),
        "{error}"
    );
    // Nobody at all: one camera is not enough.
    cameras[1..].iter().for_each(|camera| empty(camera, 4..9));
    let (status, _, error) = begin(&[]);
    assert!(status == 1 && error.contains("in none of the frames that were looked at somebody is seen"), "{error}");
}

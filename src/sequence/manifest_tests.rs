use std::fs;

use super::super::turn::Turn;
use super::super::video::tests::{ffmpeg_is_here, make_video};
use super::*;

/// Three cameras three metres from the origin, looking at it, with three pictures each.
struct Scene {
    folder: tempfile::TempDir,
}

const CAMERA_SIZE: [u32; 2] = [40, 30];

pub(crate) fn camera_table(name: &str, size: [u32; 2], rotation: [f64; 3]) -> String {
    let [width, height] = size.map(f64::from);
    format!(
        "[{name}]\nname = \"{name}\"\nsize = [{width:.1}, {height:.1}]\n\
         matrix = [[{width:.1}, 0.0, {:.1}], [0.0, {width:.1}, {:.1}], [0.0, 0.0, 1.0]]\n\
         distortions = [0.0, 0.0, 0.0, 0.0]\nrotation = {rotation:?}\ntranslation = [0.0, 0.0, 3000.0]\n\n",
        (width - 1.0) / 2.0,
        (height - 1.0) / 2.0
    )
}

impl Scene {
    fn new() -> Self {
        let scene = Self { folder: tempfile::tempdir().unwrap() };
        let tables: String = (0..3)
            .map(|index| camera_table(&format!("cam0{}", index + 1), CAMERA_SIZE, [0.0, f64::from(index), 0.0]))
            .collect();
        scene.write("cameras.toml", &format!("{tables}[metadata]\nunits = \"mm\"\n"));
        scene.write("body.toml", "");
        for camera in 1..=3 {
            scene.pictures(&format!("cam0{camera}"), CAMERA_SIZE, 3);
        }
        scene
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    /// Pictures of one grey each, from number 1: ten times their number.
    fn pictures(&self, prefix: &str, [width, height]: [u32; 2], count: u8) {
        for number in 1..=count {
            let grey = image::Rgb([10 * number; 3]);
            let picture = image::RgbImage::from_pixel(width, height, grey);
            picture.save(self.path(&format!("{prefix}_{number:03}.png"))).unwrap();
        }
    }

    fn manifest(&self, head: &str, views: &[&str]) {
        let mut text =
            format!("name = \"room\"\nfps = 25.0\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\n{head}\n");
        for view in views {
            text += &format!("[[view]]\n{view}\n");
        }
        self.write("sequence.toml", &text);
    }

    fn view(camera: &str) -> String {
        format!("camera = \"{camera}\"\nsource = \"{camera}_%03d.png\"")
    }

    /// Opens with the head of the manifest and all three views.
    fn open(&self, head: &str) -> Result<Sequence> {
        let views = ["cam01", "cam02", "cam03"].map(Self::view);
        self.manifest(head, &views.each_ref().map(String::as_str));
        Sequence::open(self.folder.path())
    }

    fn error(&self, head: &str, views: &[&str]) -> String {
        self.manifest(head, views);
        format!("{:#}", Sequence::open(self.folder.path()).unwrap_err())
    }
}

#[test]
fn a_sequence_of_pictures_is_opened_and_read() {
    let scene = Scene::new();
    let sequence = scene.open("scale = 0.25").unwrap();
    assert_eq!((sequence.name.as_str(), sequence.fps, sequence.frame_count), ("room", 25.0, 3));
    assert_eq!(sequence.sizes, [[10, 8]; 3]);
    assert!(sequence.cameras.iter().all(|camera| camera.size == [10, 8]));
    assert_eq!(sequence.cameras[1].name, "cam02");
    assert_eq!(sequence.body, scene.path("body.toml"));
    let mut reader = sequence.read_frames(1..3).unwrap();
    for index in 1..3 {
        let set = reader.next_frame().unwrap().unwrap();
        assert_eq!(set.index, index);
        for picture in &set.pictures {
            assert_eq!(picture.dimensions(), (10, 8));
            assert!(picture.pixels().all(|pixel| pixel.0 == [10 * (index as u8 + 1); 3]));
        }
        assert_eq!(set.masks, [None, None, None]);
    }
    assert!(reader.next_frame().unwrap().is_none());
    assert!(sequence.read_frames(2..2).unwrap().next_frame().unwrap().is_none());
    // The manifest itself may be named too.
    assert_eq!(Sequence::open(&scene.path("sequence.toml")).unwrap().frame_count, 3);
}

#[test]
fn a_range_past_the_end_is_a_sentence() {
    let sequence = Scene::new().open("").unwrap();
    let error = format!("{:#}", sequence.read_frames(1..9).unwrap_err());
    assert!(error.contains("frames 1..9 were asked for") && error.contains("has 3 frames"), "{error}");
    #[allow(clippy::reversed_empty_ranges, reason = "what is refused is tried")]
    let backwards = sequence.read_frames(2..1);
    assert!(backwards.is_err());
    assert!(sequence.read_frames(0..usize::MAX).is_err());
}

#[test]
fn tables_for_other_rooms_are_handed_on() {
    let sequence = Scene::new().open("[objective]\nbeta = 0.4\n[features]\nblur = 2\n").unwrap();
    assert_eq!(sequence.objective.unwrap()["beta"].as_float(), Some(0.4));
    assert_eq!(sequence.features.unwrap()["blur"].as_integer(), Some(2));
}

#[test]
fn plates_and_masks_come_at_the_working_size() {
    let scene = Scene::new();
    image::RgbImage::from_pixel(40, 30, image::Rgb([90, 1, 2])).save(scene.path("full.png")).unwrap();
    image::RgbImage::from_pixel(20, 15, image::Rgb([91, 1, 2])).save(scene.path("half.png")).unwrap();
    scene.pictures("mask", [80, 60], 3);
    image::GrayImage::from_pixel(80, 60, image::Luma([200])).save(scene.path("mask_002.png")).unwrap();
    let full = Scene::view("cam01") + "\nbackground = \"full.png\"\nmask = \"mask_%03d.png\"";
    let half = Scene::view("cam02") + "\nbackground = \"half.png\"";
    scene.manifest("scale = 0.5", &[&full, &half, &Scene::view("cam03")]);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    let plates = sequence.backgrounds().unwrap();
    assert_eq!(plates[0].as_ref().unwrap(), &image::RgbImage::from_pixel(20, 15, image::Rgb([90, 1, 2])));
    assert_eq!(plates[1].as_ref().unwrap(), &image::RgbImage::from_pixel(20, 15, image::Rgb([91, 1, 2])));
    assert!(plates[2].is_none());
    // A fraction that is neither of the two sizes; then what is no fraction.
    image::RgbImage::from_pixel(8, 6, image::Rgb([92, 1, 2])).save(scene.path("half.png")).unwrap();
    let plates = sequence.backgrounds().unwrap();
    assert_eq!(plates[1].as_ref().unwrap(), &image::RgbImage::from_pixel(20, 15, image::Rgb([92, 1, 2])));
    for [width, height] in [[8, 7], [80, 60]] {
        image::RgbImage::new(width, height).save(scene.path("half.png")).unwrap();
        let sizes = format!("half.png is {width}x{height} pixels, expected 40x30");
        let error = format!("{:#}", Sequence::open(scene.folder.path()).unwrap_err());
        assert!(error.contains(&sizes) && error.contains("an exact fraction"), "{error}");
        let error = format!("{:#}", sequence.backgrounds().unwrap_err());
        assert!(error.contains(&sizes), "{error}");
    }
    let mut reader = sequence.read_frames(0..2).unwrap();
    for value in [0, 255] {
        let set = reader.next_frame().unwrap().unwrap();
        assert_eq!(set.masks[0].as_ref().unwrap(), &image::GrayImage::from_pixel(20, 15, image::Luma([value])));
        assert!(set.masks[1].is_none());
    }
}

#[test]
fn one_view_is_said() {
    let scene = Scene::new();
    assert!(scene.open("").unwrap().remarks().is_empty());
    scene.manifest("", &[&Scene::view("cam01")]);
    let remarks = Sequence::open(scene.folder.path()).unwrap().remarks();
    assert!(remarks.len() == 1 && remarks[0].contains("sequence.toml has one view"), "{remarks:?}");
}

/// What a manifest names may be anything: nothing is waited for and nothing is read without an end.
#[cfg(unix)]
#[test]
fn pipes_and_devices_are_not_opened() {
    let scene = Scene::new();
    assert!(std::process::Command::new("mkfifo").arg(scene.path("pipe")).status().unwrap().success());
    fs::create_dir(scene.path("numbered")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", scene.path("numbered/p_1.png")).unwrap();
    let view = |more: &str| format!("{}\n{more}", Scene::view("cam01"));
    for (head, view, named) in [
        ("truth = \"pipe\"", view(""), "truth is \"pipe\""),
        ("start = \"/dev/zero\"", view(""), "start is \"/dev/zero\""),
        ("", view("background = \"pipe\""), "the background of camera \"cam01\""),
        ("", view("mask = \"/dev/zero\""), "the mask of camera \"cam01\""),
        ("", view("ignore = \"pipe\""), "the ignore of camera \"cam01\""),
        ("", "camera = \"cam01\"\nsource = \"pipe\"".to_string(), "the source of camera \"cam01\""),
        ("", "camera = \"cam01\"\nsource = \"numbered/p_%d.png\"".to_string(), "p_1.png"),
    ] {
        let error = scene.error(head, &[&view]);
        assert!(error.contains(named) && error.contains("is a device, a pipe or a socket"), "{error}");
    }
    fs::remove_file(scene.path("cameras.toml")).unwrap();
    fs::rename(scene.path("pipe"), scene.path("cameras.toml")).unwrap();
    let error = scene.error("", &[&view("")]);
    assert!(error.contains("cameras is \"cameras.toml\"") && error.contains("is a device, a pipe"), "{error}");
}

#[test]
fn bad_manifests_are_sentences() {
    let scene = Scene::new();
    let view = Scene::view("cam01");
    for (head, views, expected) in [
        ("scael = 0.5", vec![view.as_str()], vec!["sequence.toml, line 5", "`scael`", "nearest known key is `scale`"]),
        ("scale = 0.0", vec![&view], vec!["scale is 0, expected 0.01 to 1"]),
        ("scale = 1.5", vec![&view], vec!["scale is 1.5"]),
        ("scale = nan", vec![&view], vec!["scale is NaN"]),
        ("scale = 1e-9", vec![&view], vec!["scale is 1e-9, expected 0.01 to 1"]),
        ("scale = 0.011", vec![&view], vec!["scale is 0.011, which leaves", "camera \"cam01\", expected 8 or more"]),
        ("", vec![], vec!["sequence.toml has no views", "[[view]]"]),
        ("", vec![&view, &view], vec!["camera \"cam01\" has two views"]),
        (
            "",
            vec!["camera = \"cam9\"\nsource = \"x.mp4\""],
            vec!["cameras.toml has no camera \"cam9\"", "the nearest is"],
        ),
        (
            "",
            vec!["camera = \"cam01\"\nsource = \"x.mp4\""],
            vec!["the source of camera \"cam01\"", "there is no file"],
        ),
        ("", vec!["camera = \"cam01\"\nsource = \"x_%d.png\""], vec!["there are no pictures", "x_%d.png"]),
        ("", vec!["camera = \"cam01\"\nsource = \"\""], vec!["the source of camera \"cam01\"", "is a folder"]),
        ("", vec!["camera = \"cam01\"\nsorce = \"x.mp4\""], vec!["line 8", "nearest known key is `source`"]),
        ("start = \"none.csv\"", vec![&view], vec!["start is \"none.csv\"", "there is no file"]),
        ("truth = \"none.trc\"", vec![&view], vec!["truth is \"none.trc\"", "there is no file"]),
        ("start = 5", vec![&view], vec!["sequence.toml, line 5"]),
    ] {
        let error = scene.error(head, &views);
        for part in expected {
            assert!(error.contains(part), "{head:?} {views:?}: {error}");
        }
    }
    for fps in ["0.0", "-25.0", "nan", "inf", "1e308", "1e-300", "0.009"] {
        let text =
            format!("name = \"a\"\nfps = {fps}\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\n[[view]]\n{view}");
        scene.write("sequence.toml", &text);
        let error = format!("{:#}", Sequence::open(scene.folder.path()).unwrap_err());
        assert!(error.contains("expected 0.01 to 100000 frames per second") && error.len() < 200, "{error}");
    }
    for (head, key) in [("truth = \".\"", "truth is \".\""), ("start = \"/dev\"", "start is \"/dev\"")] {
        let error = scene.error(head, &[&view]);
        assert!(error.contains(key) && error.contains("is a folder, expected a regular file"), "{error}");
    }
    let live = "camera = \"cam01\"\nsource = \"rtsp://host/a\"\nmask = \"a_%d.png\"";
    scene.manifest("", &[live]);
    let error = format!("{:#}", Sequence::open_live(scene.folder.path()).unwrap_err());
    assert!(error.contains("sequence.toml: camera \"cam01\" is live and has `mask`"), "{error}");
    fs::remove_file(scene.path("body.toml")).unwrap();
    assert!(scene.error("", &[&view]).contains("body is \"body.toml\", and there is no file"));
    fs::remove_file(scene.path("cameras.toml")).unwrap();
    assert!(scene.error("", &[&view]).contains("cameras is \"cameras.toml\", and there is no file"));
    let error = format!("{:#}", Sequence::open(&scene.path("nowhere")).unwrap_err());
    assert!(error.contains("nowhere"), "{error}");
}

/// A folder with a calibration a camera, which leaves the pictures' size to the pictures.
#[test]
fn calibrations_without_sizes_take_those_of_the_pictures() {
    let scene = Scene::new();
    fs::create_dir(scene.path("calibration")).unwrap();
    for camera in ["cam01", "cam02"] {
        let text = "K: [[40, 0, 19.5], [0, 40, 14.5], [0, 0, 1]]\nD: [0, 0, 0, 0]\nrvec: [0, 0, 0]\ntvec: [0, 0, 3]\n";
        scene.write(&format!("calibration/{camera}.yml"), text);
    }
    scene.manifest("", &[&Scene::view("cam01"), &Scene::view("cam02")]);
    let manifest = fs::read_to_string(scene.path("sequence.toml")).unwrap();
    scene.write("sequence.toml", &manifest.replace("\"cameras.toml\"", "\"calibration\""));
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!(sequence.cameras.iter().map(|camera| camera.size).collect::<Vec<_>>(), [CAMERA_SIZE; 2]);
    // A camera without a view has no pictures to ask.
    scene.write("calibration/cam04.yml", &fs::read_to_string(scene.path("calibration/cam01.yml")).unwrap());
    let error = format!("{:#}", Sequence::open(scene.folder.path()).unwrap_err());
    assert!(error.contains("cam04.yml: camera `cam04`: image_width and image_height are missing"), "{error}");
}

#[test]
fn a_background_that_is_doubtful_is_said_by_whoever_opens_it() {
    let scene = Scene::new();
    image::RgbImage::new(40, 30).save(scene.path("plate.png")).unwrap();
    let [one, two] = ["cam01", "cam02"].map(|camera| Scene::view(camera) + "\nbackground = \"plate.png\"");
    scene.manifest("", &[&(one.clone() + "\nbackground_doubtful = 3.25"), &(two + "\nbackground_doubtful = 0.9")]);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    let remarks = sequence.remarks();
    assert_eq!(remarks.len(), sequence.remarks_on_recordings().len() + 1, "{remarks:?}");
    let said = remarks.last().unwrap();
    assert!(
        said.contains("camera \"cam01\" was learnt and 3.2 % of it is doubtful") && said.contains("plate.png"),
        "{said}"
    );
    let error = scene.error("", &[&(one + "\nbackground_doubtful = 101")]);
    assert!(
        error.contains("camera \"cam01\" has `background_doubtful = 101`, expected it beside `background`"),
        "{error}"
    );
    let error = scene.error("", &[&(Scene::view("cam01") + "\nbackground_doubtful = 2")]);
    assert!(error.contains("expected it beside `background`"), "{error}");
}

#[test]
fn views_that_do_not_fit_together_are_sentences() {
    let scene = Scene::new();
    let one = Scene::view("cam01");
    scene.pictures("cam02", CAMERA_SIZE, 5);
    scene.pictures("big", [80, 60], 3);
    let error = scene.error("", &["camera = \"cam01\"\nsource = \"big_%03d.png\""]);
    assert!(error.contains("80x60") && error.contains("camera \"cam01\" is calibrated for 40x30"), "{error}");
    let error = scene.error("", &[&(one.clone() + "\nbackground = \"big_001.png\"")]);
    assert!(error.contains("big_001.png is 80x60 pixels, expected 40x30"), "{error}");
    scene.pictures("tall", [30, 40], 3);
    let error = scene.error("", &[&(one.clone() + "\nmask = \"tall_%03d.png\"")]);
    assert!(error.contains("has masks of 30x40 pixels, expected the shape of 40x30"), "{error}");
    let error = scene.error("", &[&(one + "\nmask = \"cam02_%03d.png\"")]);
    assert!(error.contains("camera \"cam01\" has 3 pictures and 5 masks"), "{error}");
}

#[test]
fn a_picture_that_goes_bad_later_is_found_when_read() {
    let scene = Scene::new();
    image::RgbImage::new(10, 10).save(scene.path("cam02_002.png")).unwrap();
    let sequence = scene.open("").unwrap();
    let mut reader = sequence.read_frames(0..3).unwrap();
    assert!(reader.next_frame().unwrap().is_some());
    let error = format!("{:#}", reader.next_frame().unwrap_err());
    assert!(error.contains("cam02_002.png is 10x10 pixels, expected 40x30"), "{error}");
    assert!(reader.next_frame().unwrap().is_none(), "nothing follows an error");
}

#[test]
fn a_camera_that_looks_away_is_named() {
    let scene = Scene::new();
    // All three stand around the origin; the third now looks the other way from where it stands.
    let table = camera_table("cam03", CAMERA_SIZE, [0.0, 2.0, 0.0]).replace("3000.0]", "-3000.0]");
    let tables = camera_table("cam01", CAMERA_SIZE, [0.0; 3]) + &camera_table("cam02", CAMERA_SIZE, [0.0, 1.0, 0.0]);
    scene.write("cameras.toml", &format!("{tables}{table}[metadata]\nunits = \"mm\"\n"));
    let error = format!("{:#}", scene.open("").unwrap_err());
    assert!(error.contains("camera \"cam03\" sees nothing of the place all cameras point at"), "{error}");
    // With two cameras there is no telling.
    let views = ["cam01", "cam03"].map(Scene::view);
    scene.manifest("", &views.each_ref().map(String::as_str));
    assert!(Sequence::open(scene.folder.path()).is_ok());
}

#[test]
fn what_is_ignored_is_read_with_every_frame() {
    let scene = Scene::new();
    let mask = |name: &str, [width, height]: [u32; 2], from: u32| {
        let mask = image::GrayImage::from_fn(width, height, |x, _| image::Luma([if x >= from { 200 } else { 40 }]));
        mask.save(scene.path(name)).unwrap();
    };
    mask("desk.png", CAMERA_SIZE, 30);
    (1..=3).for_each(|frame| mask(&format!("door_{frame}.png"), [80, 60], 10 * frame));
    let view = |camera: &str, ignore: &str| format!("{}\nignore = {ignore:?}", Scene::view(camera));
    let views = [view("cam01", "desk.png"), view("cam02", "door_%d.png"), Scene::view("cam03")];
    scene.manifest("scale = 0.5", &views.each_ref().map(String::as_str));
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    let mut reader = sequence.read_frames(0..3).unwrap();
    let mut frames = 0;
    while let Some(set) = reader.next_frame().unwrap() {
        frames += 1;
        assert!(set.ignored[2].is_none());
        for (view, from) in [(0, 15), (1, 5 * frames / 2)] {
            let ignored = set.ignored[view].as_ref().unwrap();
            assert_eq!(ignored.dimensions(), (20, 15));
            let expected = |x: u32| if x >= from { 255 } else { 0 };
            assert!(ignored.enumerate_pixels().all(|(x, _, pixel)| pixel[0] == expected(x)), "view {view}");
        }
    }
    assert_eq!(frames, 3);
}

#[test]
fn wrong_masks_of_what_is_ignored_are_sentences() {
    let scene = Scene::new();
    image::GrayImage::new(30, 40).save(scene.path("lying.png")).unwrap();
    for frame in [1, 2] {
        image::GrayImage::new(40, 30).save(scene.path(&format!("few_{frame}.png"))).unwrap();
    }
    for frame in [1, 3] {
        image::GrayImage::new(40, 30).save(scene.path(&format!("gap_{frame}.png"))).unwrap();
    }
    scene.write("text.png", "no picture");
    let error = |ignore: &str| scene.error("", &[&format!("{}\nignore = {ignore:?}", Scene::view("cam01"))]);
    for (ignore, parts) in [
        ("none.png", &["the ignore of camera \"cam01\"", "there is no file", "none.png: name a picture"][..]),
        ("lying.png", &["the ignore of camera \"cam01\"", "lying.png is 30x40 pixels, expected the shape of 40x30"]),
        ("few_%d.png", &["2 pictures", "few_%d.png", "one for each of the 3 frames, or one picture for all"]),
        ("gap_%d.png", &["gap_%d.png", "number 2 is missing"]),
        ("text.png", &["text.png"]),
    ] {
        let error = error(ignore);
        assert!(parts.iter().all(|part| error.contains(part)), "{ignore}: {error}");
    }
}

#[test]
fn videos_and_pictures_mix() {
    if !ffmpeg_is_here("videos_and_pictures_mix") {
        return;
    }
    let scene = Scene::new();
    make_video(&scene.path("cam02.mp4"), "40x30", 3, &["-pix_fmt", "yuv420p"]);
    make_video(&scene.path("mask.mkv"), "40x30", 3, &["-c:v", "ffv1"]);
    let video = "camera = \"cam02\"\nsource = \"cam02.mp4\"\nmask = \"mask.mkv\"";
    scene.manifest("scale = 0.5", &[&Scene::view("cam01"), video]);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    let mut reader = sequence.read_frames(0..3).unwrap();
    let mut seen = 0;
    while let Some(set) = reader.next_frame().unwrap() {
        assert_eq!(set.pictures[1].dimensions(), (20, 15));
        let mask = set.masks[1].as_ref().unwrap();
        assert!(mask.pixels().all(|pixel| [0, 255].contains(&pixel[0])) && mask.pixels().any(|pixel| pixel[0] == 255));
        seen += 1;
    }
    assert_eq!(seen, 3);
}

#[test]
fn a_dropped_reader_ends_its_threads() {
    let scene = Scene::new();
    scene.pictures("cam01", CAMERA_SIZE, 20);
    scene.manifest("", &[&Scene::view("cam01")]);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    let mut reader = sequence.read_frames(0..20).unwrap();
    reader.next_frame().unwrap();
    // Joins the thread, which is blocked on a full queue by now: this returns only if dropping unblocks it.
    drop(reader);
}

const BEAM: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/beam");

#[test]
fn the_beam_sequence_is_read_exactly() {
    let beam = Path::new(BEAM);
    if !beam.is_dir() {
        println!("SKIPPED the_beam_sequence_is_read_exactly: ../shared/data is absent");
        return;
    }
    if !ffmpeg_is_here("the_beam_sequence_is_read_exactly") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let cameras = fs::read_to_string(beam.join("cameras.toml")).unwrap();
    fs::write(folder.path().join("cameras.toml"), cameras + "\n[metadata]\nunits = \"mm\"\n").unwrap();
    fs::write(folder.path().join("body.toml"), "").unwrap();
    let mut text =
        "name = \"beam\"\nfps = 60.0\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\nscale = 0.25\n".to_string();
    for camera in ["cam01", "cam02", "cam03", "cam04"] {
        let (video, plate) = (format!("videos/{camera}.mp4"), format!("background/bg_{camera}.png"));
        text += &format!(
            "[[view]]\ncamera = {camera:?}\nsource = {:?}\nbackground = {:?}\n",
            beam.join(video),
            beam.join(plate)
        );
    }
    fs::write(folder.path().join("sequence.toml"), text).unwrap();
    let sequence = Sequence::open(folder.path()).unwrap();
    assert_eq!(sequence.frame_count, 100);
    assert_eq!(sequence.sizes, [[270, 480], [270, 480], [272, 480], [272, 480]]);
    let mut all = Vec::new();
    let mut reader = sequence.read_frames(0..100).unwrap();
    while let Some(set) = reader.next_frame().unwrap() {
        all.push(set.pictures);
    }
    assert_eq!(all.len(), 100);
    let mut part = sequence.read_frames(40..43).unwrap();
    for expected in &all[40..43] {
        assert_eq!(&part.next_frame().unwrap().unwrap().pictures, expected);
    }
    assert!(part.next_frame().unwrap().is_none());
    // The videos are not turned: away from the man, a frame is its plate.
    for (plate, picture) in sequence.backgrounds().unwrap().iter().zip(&all[0]) {
        let differences = plate.as_ref().unwrap().as_raw().iter().zip(picture.as_raw()).map(|(a, b)| a.abs_diff(*b));
        let mut sorted: Vec<u8> = differences.collect();
        sorted.sort_unstable();
        assert!(sorted[sorted.len() / 2] <= 4, "median difference {}", sorted[sorted.len() / 2]);
    }
}

/// Copies a video with a mark that players turn it by, degrees; false where this ffmpeg cannot write one.
fn mark_turned(from: &Path, to: &Path, degrees: i32) -> bool {
    let made = std::process::Command::new("ffmpeg")
        .args(["-v", "error", "-y", "-i"])
        .arg(from)
        .args(["-c", "copy", "-metadata:s:v:0", &format!("rotate={degrees}")])
        .arg(to)
        .status();
    assert!(made.unwrap().success());
    crate::sequence::probe_video(to).unwrap().turn != Turn::None
}

/// The first frame as ffmpeg shows it to people, with its size.
fn shown_by_ffmpeg(video: &Path) -> image::RgbImage {
    let picture = video.with_extension("shown.png");
    let made = std::process::Command::new("ffmpeg")
        .args(["-v", "error", "-y", "-i"])
        .arg(video)
        .args(["-frames:v", "1", "-pix_fmt", "rgb24"])
        .arg(&picture)
        .status();
    assert!(made.unwrap().success());
    image::open(picture).unwrap().into_rgb8()
}

/// The mean difference of two pictures, grey levels.
fn difference(a: &image::RgbImage, b: &image::RgbImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let sum: u64 = a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / a.as_raw().len() as f64
}

#[test]
fn videos_marked_to_be_turned_are_read_as_the_calibration_has_them() {
    if !ffmpeg_is_here("videos_marked_to_be_turned_are_read_as_the_calibration_has_them") {
        return;
    }
    let scene = Scene::new();
    // Stored lying, as telephones do; the calibration is of 40x30.
    make_video(&scene.path("lying.mp4"), "30x40", 3, &["-c:v", "mpeg4", "-q:v", "2"]);
    make_video(&scene.path("upright.mp4"), "40x30", 3, &["-c:v", "mpeg4", "-q:v", "2"]);
    let first = |more: &str, file: &str| {
        scene.manifest("", &[&format!("camera = \"cam01\"\nsource = \"{file}\"\n{more}"), &Scene::view("cam02")]);
        let sequence = Sequence::open(scene.folder.path()).unwrap();
        let picture = sequence.read_frames(0..1).unwrap().next_frame().unwrap().unwrap().pictures.swap_remove(0);
        (picture, sequence.remarks())
    };
    for degrees in [90, 180, 270] {
        let (from, file) = if degrees == 180 { ("upright.mp4", "turned.mp4") } else { ("lying.mp4", "turned.mp4") };
        if !mark_turned(&scene.path(from), &scene.path(file), degrees) {
            println!(
                "SKIPPED videos_marked_to_be_turned_are_read_as_the_calibration_has_them: ffmpeg writes marks otherwise"
            );
            return;
        }
        let (picture, remarks) = first("", file);
        // Only the rounding of colours differs; turned the other way it is another picture.
        let shown = shown_by_ffmpeg(&scene.path(file));
        let (near, far) = (difference(&picture, &shown), difference(&picture, &image::imageops::rotate180(&shown)));
        assert!(near < 15.0 && far > 4.0 * near, "{degrees}: {near} and {far}");
        assert!(remarks.len() == 1 && remarks[0].contains("when it is read, as players do: 40x30"), "{remarks:?}");
    }
    // The calibration may be of the pictures as they are stored.
    assert!(mark_turned(&scene.path("upright.mp4"), &scene.path("marked.mp4"), 90));
    let (stored, remarks) = first("", "marked.mp4");
    let (plain, none) = first("", "upright.mp4");
    assert_eq!(stored, plain);
    assert!(remarks.len() == 1 && remarks[0].contains("is read as it is stored: 40x30"), "{remarks:?}");
    assert!(none.is_empty(), "{none:?}");
    assert!(mark_turned(&scene.path("upright.mp4"), &scene.path("half.mp4"), 180));
    assert_eq!(first("orientation = \"stored\"", "half.mp4").0, plain);
    let view = |size: &str| format!("camera = \"cam02\"\nsource = \"marked.mp4\"\norientation = \"{size}\"");
    let error = scene.error("", &[&view("upright")]);
    assert!(error.contains("pictures of 30x40 pixels") && error.contains("turned by 90 degrees"), "{error}");
    let error = scene.error("", &[&view("lying")]);
    assert!(error.contains("unknown orientation `lying`") && error.contains("upright"), "{error}");
}

/// A video whose frames tell their number by their grey, without those that are missing: 8 levels a frame.
pub(in crate::sequence) fn numbered_video(path: &Path, rate: u32, frames: u32, missing: &str) {
    let made = std::process::Command::new("ffmpeg")
        .args(["-v", "error", "-y", "-f", "lavfi", "-i"])
        .arg(format!("color=size=40x30:rate={rate}:color=black,format=gray,geq=lum=8*N+8,select='not({missing})'"))
        .args(["-fps_mode", "passthrough", "-frames:v", &frames.to_string(), "-c:v", "ffv1"])
        .arg(path)
        .status();
    assert!(made.unwrap().success());
}

/// The numbers that the frames of a view's video say.
fn numbers(sequence: &Sequence, view: usize, range: std::ops::Range<usize>) -> Vec<u8> {
    let mut reader = sequence.read_frames(range).unwrap();
    let mut numbers = Vec::new();
    while let Some(set) = reader.next_frame().unwrap() {
        numbers.push((f64::from(set.pictures[view].get_pixel(20, 15)[1]) / 8.0 - 1.0).round() as u8);
    }
    numbers
}

#[test]
fn dropped_frames_are_made_up_for_and_cameras_stay_together() {
    if !ffmpeg_is_here("dropped_frames_are_made_up_for_and_cameras_stay_together") {
        return;
    }
    let scene = Scene::new();
    numbered_video(&scene.path("whole.mkv"), 25, 24, "0");
    numbered_video(&scene.path("drops.mkv"), 25, 20, "between(n,5,7)+eq(n,15)");
    let views = ["camera = \"cam01\"\nsource = \"whole.mkv\"", "camera = \"cam02\"\nsource = \"drops.mkv\""];
    scene.manifest("", &views);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    let all: Vec<u8> = (0..24).collect();
    let made_up = [0, 1, 2, 3, 4, 4, 4, 8, 8, 9, 10, 11, 12, 13, 14, 14, 16, 17, 18, 19, 20, 21, 22, 23];
    assert_eq!((sequence.frame_count, numbers(&sequence, 0, 0..24)), (24, all.clone()));
    assert_eq!(numbers(&sequence, 1, 0..24), made_up);
    assert!(sequence.views[0].picks.is_none(), "a whole video is read as ever");
    for range in [3..9, 6..8, 7..24, 15..17, 23..24] {
        assert_eq!(numbers(&sequence, 1, range.clone()), made_up[range]);
    }
    let remarks = sequence.remarks();
    assert!(
        remarks.len() == 1
            && remarks[0].contains("cam02")
            && remarks[0].contains("40.0 ms apart in the median, 160.0 ms at most, 4 missing"),
        "{remarks:?}"
    );
    // As it was before: every picture a frame, and then the lengths differ.
    let error = scene.error("timestamps = \"ignore\"", &views);
    assert!(error.contains("has 24 frames and camera \"cam02\" has 20") && error.contains("`delay = 0`"), "{error}");
    let error = scene.error("timestamps = \"nearest\"", &views);
    assert!(error.contains("unknown use of timestamps `nearest`") && error.contains("resample, ignore"), "{error}");
    // Another rate in the manifest: times are not believed unless told so.
    scene.manifest("", &views);
    let text = fs::read_to_string(scene.path("sequence.toml")).unwrap();
    scene.write("sequence.toml", &text.replace("fps = 25.0", "fps = 12.5"));
    let error = format!("{:#}", Sequence::open(scene.folder.path()).unwrap_err());
    assert!(error.contains("4 missing; every picture is taken as a frame, since `fps` is another rate"), "{error}");
    scene.manifest("timestamps = \"resample\"", &views);
    let text = fs::read_to_string(scene.path("sequence.toml")).unwrap();
    scene.write("sequence.toml", &text.replace("fps = 25.0", "fps = 12.5"));
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!(numbers(&sequence, 0, 0..12), [0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22]);
    assert_eq!(numbers(&sequence, 1, 0..12), [0, 2, 4, 4, 8, 10, 12, 14, 16, 18, 20, 22]);
    assert!(sequence.remarks()[0].contains("`fps` is 12.5 and the videos have 25.000"), "{:?}", sequence.remarks());
}

#[test]
fn rates_that_differ_are_said_with_names_and_resampled_where_asked() {
    if !ffmpeg_is_here("rates_that_differ_are_said_with_names_and_resampled_where_asked") {
        return;
    }
    let scene = Scene::new();
    numbered_video(&scene.path("a.mkv"), 25, 24, "0");
    numbered_video(&scene.path("b.mkv"), 50, 24, "0");
    let views = ["camera = \"cam01\"\nsource = \"a.mkv\"", "camera = \"cam02\"\nsource = \"b.mkv\""];
    scene.manifest("", &views);
    let remarks = Sequence::open(scene.folder.path()).unwrap().remarks();
    assert!(
        remarks.len() == 1 && remarks[0].contains("`fps` is 25") && remarks[0].contains("cam02 50.000"),
        "{remarks:?}"
    );
    scene.manifest("timestamps = \"resample\"", &views);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!(sequence.frame_count, 13, "as long as the shorter: {:?}", sequence.remarks());
    assert_eq!(numbers(&sequence, 0, 0..13), (0..13).collect::<Vec<u8>>());
    assert_eq!(numbers(&sequence, 1, 0..12), (0..24).step_by(2).collect::<Vec<u8>>());
    assert!(sequence.remarks().iter().any(|remark| remark.contains("cam01 24, cam02 13")), "{:?}", sequence.remarks());
    numbered_video(&scene.path("b.mkv"), 50, 20, "0");
    let error = scene.error("", &views);
    assert!(error.contains("25.000 and 50.000 frames a second: `timestamps = \"resample\"`"), "{error}");
    scene.manifest("timestamps = \"ignore\"", &[views[1]]);
    assert_eq!(Sequence::open(scene.folder.path()).unwrap().remarks().len(), 1, "one view alone is said");
}

#[test]
fn a_camera_that_was_started_late_is_put_right_by_one_key() {
    let scene = Scene::new();
    scene.pictures("cam02", CAMERA_SIZE, 5);
    scene.pictures("mask", CAMERA_SIZE, 5);
    let late = Scene::view("cam02") + "\nmask = \"mask_%03d.png\"\ndelay = 2";
    scene.manifest("", &[&Scene::view("cam01"), &late]);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!((sequence.frame_count, sequence.remarks()), (3, vec![]));
    let mut reader = sequence.read_frames(1..3).unwrap();
    for frame in 1..3 {
        let set = reader.next_frame().unwrap().unwrap();
        assert_eq!(set.pictures[0].get_pixel(0, 0)[0], 10 * (frame + 1));
        assert_eq!(set.pictures[1].get_pixel(0, 0)[0], 10 * (frame + 3));
    }
    // One that is early leaves out what the others saw before.
    scene.manifest("", &[&Scene::view("cam01"), &(Scene::view("cam03") + "\ndelay = -1.2")]);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!(sequence.frame_count, 2);
    let set = sequence.read_frames(0..1).unwrap().next_frame().unwrap().unwrap();
    assert_eq!([0, 1].map(|view: usize| set.pictures[view].get_pixel(0, 0)[0]), [20, 10]);
    let remarks = sequence.remarks();
    assert!(
        remarks[0].contains("frame 0 lies 1.2 frames (0.048 s) after") && remarks[0].contains("\"cam03\""),
        "{remarks:?}"
    );
    assert!(remarks[1].contains("cam01 2, cam03 3"), "{remarks:?}");
    assert_eq!(sequence.notes(), remarks, "nothing is amiss");
    // All as late or as early as each other are not late.
    for delay in [7, -7] {
        let both = ["cam01", "cam03"].map(|camera| format!("{}\ndelay = {delay}", Scene::view(camera)));
        scene.manifest("", &both.each_ref().map(String::as_str));
        let sequence = Sequence::open(scene.folder.path()).unwrap();
        assert_eq!((sequence.frame_count, sequence.remarks()), (3, vec![]));
    }
    let of =
        |delay: &str| scene.error("", &[&Scene::view("cam01"), &format!("{}\ndelay = {delay}", Scene::view("cam03"))]);
    assert!(of("3").contains("camera \"cam03\" has no frame"), "{}", of("3"));
    assert!(of("nan").contains("the delay of camera \"cam03\" is NaN"), "{}", of("nan"));
    assert!(of("1e9").contains("expected at most 100000 frames"), "{}", of("1e9"));
}

#[test]
fn views_of_different_lengths_are_taken_as_far_as_all_go_and_said() {
    let scene = Scene::new();
    scene.pictures("cam02", CAMERA_SIZE, 5);
    scene.manifest("", &[&Scene::view("cam01"), &Scene::view("cam02")]);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!(sequence.frame_count, 3);
    let remarks = sequence.remarks();
    assert!(remarks.len() == 2 && remarks[0].contains("cam01 3, cam02 5"), "{remarks:?}");
    assert!(remarks[1].contains("look for the delay") && sequence.notes() == &remarks[..1], "{remarks:?}");
    // What the lengths make likely is a guess, and too short a stretch makes none.
    assert!(sequence.likely_delays().is_empty());
    scene.pictures("cam01", CAMERA_SIZE, 20);
    scene.pictures("cam02", CAMERA_SIZE, 25);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!(sequence.likely_delays(), [[-5.0, 0.0]]);
    let delayed = sequence.delayed(&[-5.0, 0.0]).unwrap();
    assert_eq!((delayed.frame_count, delayed.views[0].delay), (20, -5.0));
    let set = delayed.read_frames(1..2).unwrap().next_frame().unwrap().unwrap();
    assert_eq!([0, 1].map(|view: usize| set.pictures[view].get_pixel(0, 0)[0]), [20, 70]);
    assert!(sequence.delayed(&[0.0, 60.0]).is_err());
}

#[test]
fn videos_that_filmed_as_long_at_other_rates_are_taken_by_their_times() {
    if !ffmpeg_is_here("videos_that_filmed_as_long_at_other_rates_are_taken_by_their_times") {
        return;
    }
    let scene = Scene::new();
    numbered_video(&scene.path("a.mkv"), 25, 12, "0");
    numbered_video(&scene.path("b.mkv"), 50, 20, "0");
    let views = ["camera = \"cam01\"\nsource = \"a.mkv\"", "camera = \"cam02\"\nsource = \"b.mkv\""];
    scene.manifest("", &views);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!(numbers(&sequence, 0, 0..10), (0..10).collect::<Vec<u8>>());
    assert_eq!(numbers(&sequence, 1, 0..10), (0..20).step_by(2).collect::<Vec<u8>>());
    let remarks = sequence.remarks();
    assert!(
        remarks.iter().any(|remark| remark.contains("cam02 50.000") && remark.contains("nearest in time")),
        "{remarks:?}"
    );
}

#[test]
fn videos_that_begin_at_different_times_are_said() {
    if !ffmpeg_is_here("videos_that_begin_at_different_times_are_said") {
        return;
    }
    let scene = Scene::new();
    let from = |name: &str, first: &str, made: &str| {
        let time = format!("creation_time={made}");
        make_video(&scene.path(name), "40x30", 6, &["-c:v", "mpeg4", "-metadata", &time, "-output_ts_offset", first]);
    };
    from("a.ts", "0", "2024-05-01T10:00:00Z");
    from("b.ts", "0.12", "2024-05-01T10:00:00Z");
    let views = ["camera = \"cam01\"\nsource = \"a.ts\"", "camera = \"cam02\"\nsource = \"b.ts\""];
    scene.manifest("", &views);
    let remarks = Sequence::open(scene.folder.path()).unwrap().remarks();
    assert!(remarks.len() == 1 && remarks[0].contains("cam02 0.120 s (`delay = -3`)"), "{remarks:?}");
    from("a.mp4", "0", "2024-05-01T10:00:00Z");
    from("b.mp4", "0", "2024-05-01T10:00:35Z");
    let views = views.map(|view| view.replace(".ts", ".mp4"));
    scene.manifest("", &views.each_ref().map(String::as_str));
    let remarks = Sequence::open(scene.folder.path()).unwrap().remarks();
    assert!(remarks.len() == 1 && remarks[0].contains("cam01 at 2024-05-01T10:00:00"), "{remarks:?}");
    scene.manifest("", &[&views[0], &(views[1].clone() + "\ndelay = 0")]);
    assert!(Sequence::open(scene.folder.path()).unwrap().remarks().is_empty());
}

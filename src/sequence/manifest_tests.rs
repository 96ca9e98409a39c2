use std::fs;

use super::super::video::tests::{ffmpeg_is_here, make_video};
use super::*;

/// Three cameras three metres from the origin, looking at it, with three pictures each.
pub(super) struct Scene {
    pub(super) folder: tempfile::TempDir,
}

pub(super) const CAMERA_SIZE: [u32; 2] = [40, 30];

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
    pub(super) fn new() -> Self {
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

    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(super) fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    /// Pictures of one grey each, from number 1: ten times their number.
    pub(super) fn pictures(&self, prefix: &str, [width, height]: [u32; 2], count: u8) {
        for number in 1..=count {
            let grey = image::Rgb([10 * number; 3]);
            let picture = image::RgbImage::from_pixel(width, height, grey);
            picture.save(self.path(&format!("{prefix}_{number:03}.png"))).unwrap();
        }
    }

    pub(super) fn manifest(&self, head: &str, views: &[&str]) {
        let mut text =
            format!("name = \"room\"\nfps = 25.0\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\n{head}\n");
        for view in views {
            text += &format!("[[view]]\n{view}\n");
        }
        self.write("sequence.toml", &text);
    }

    pub(super) fn view(camera: &str) -> String {
        format!("camera = \"{camera}\"\nsource = \"{camera}_%03d.png\"")
    }

    /// Opens with the head of the manifest and all three views.
    pub(super) fn open(&self, head: &str) -> Result<Sequence> {
        let views = ["cam01", "cam02", "cam03"].map(Self::view);
        self.manifest(head, &views.each_ref().map(String::as_str));
        Sequence::open(self.folder.path())
    }

    pub(super) fn error(&self, head: &str, views: &[&str]) -> String {
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

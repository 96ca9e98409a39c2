//! Plates learnt from whole recordings: `pantin plate`, and what every command does where no plate is given.

use std::fs;
use std::path::Path;

use image::{GrayImage, RgbImage};

use super::support::{has_ffmpeg, pantin, refused, shared, stderr, stdout, succeeded};

/// A person who stands for a while and then walks across a room, drawn by `pantin synth`; the pictures come with exact masks and plates.
fn scene(folder: &Path) {
    let scene = folder.join("scene.toml");
    let text = "name = \"across\"\nframes = 40\n[output]\nmasks = true\n[rig]\nsize = [160, 120]\n\
                [[actor]]\nmotion = { gait = \"straight\", stride_time = 1.2 }\n";
    fs::write(&scene, text).unwrap();
    succeeded(&pantin(&["synth", scene.to_str().unwrap(), "-o", folder.join("made").to_str().unwrap()]));
}

/// Mean and largest difference of two pictures, grey levels, where a picture is not 0.
fn off(a: &RgbImage, b: &RgbImage, wanted: &GrayImage) -> (f64, u8) {
    let (mut sum, mut count, mut most) = (0.0, 0.0, 0);
    for ((a, b), wanted) in a.pixels().zip(b.pixels()).zip(wanted.pixels()) {
        if wanted[0] > 0 {
            let off = (0..3).map(|channel| a[channel].abs_diff(b[channel])).max().unwrap();
            (sum, count, most) = (sum + f64::from(off), count + 1.0, most.max(off));
        }
    }
    assert!(count > 0.0);
    (sum / count, most)
}

#[test]
fn a_plate_is_learnt_from_a_walk_without_a_ghost() {
    let folder = tempfile::tempdir().unwrap();
    scene(folder.path());
    let made = folder.path().join("made");
    let camera = fs::read_dir(made.join("frames")).unwrap().next().unwrap().unwrap().file_name().into_string().unwrap();
    let camera = camera.rsplit_once('_').unwrap().0.to_string();
    let frames = made.join(format!("frames/{camera}_%04d.png"));
    let (plate, sure) = (folder.path().join("plate.png"), folder.path().join("sure.png"));
    let [plate_name, sure_name, frames] = [&plate, &sure, &frames].map(|path| path.to_str().unwrap());
    let done = pantin(&["plate", frames, "-o", plate_name, "--sure", sure_name]);
    succeeded(&done);
    assert!(stdout(&done).contains("learnt the empty scene from 40 of 40 pictures"), "{}", stdout(&done));

    let open = |path: &Path| image::open(path).unwrap().to_rgb8();
    let mask = |frame: usize| image::open(made.join(format!("masks/{camera}_{frame:04}.png"))).unwrap().to_luma8();
    // Everywhere that the person ever was.
    let mut track = mask(0);
    for frame in 1..40 {
        track.pixels_mut().zip(mask(frame).pixels()).for_each(|(sum, one)| sum[0] = sum[0].max(one[0]));
    }
    let truth = fs::read_dir(made.join("plates")).unwrap().map(|entry| entry.unwrap().path());
    let truth = truth.into_iter().find(|path| path.to_string_lossy().contains(&camera)).unwrap();
    let (mean, _) = off(&open(&plate), &open(&truth), &track);
    let ghost = off(&open(&made.join(format!("frames/{camera}_0000.png"))), &open(&truth), &mask(0)).0;
    println!("plate error on the person's way {mean:.2} grey levels; a ghost would be {ghost:.1}");
    // 1.23 and 105 on these pictures.
    assert!(mean < 1.6 && ghost > 60.0 * mean, "{mean} {ghost}");
    let sure = image::open(&sure).unwrap().to_luma8();
    assert_eq!(sure.dimensions(), track.dimensions());

    refused(&pantin(&["plate", frames, "-o", plate_name]), &["plate.png exists", "--force"]);
    refused(&pantin(&["plate", frames, "-o", "plate.JPG"]), &["plate.JPG", "expected a name that ends in .png"]);
    let none = folder.path().join("none.mp4");
    refused(
        &pantin(&["plate", none.to_str().unwrap(), "-o", sure_name, "--force"]),
        &["none.mp4", "numbered pictures"],
    );

    // The same by itself in a manifest without plates and masks: what is seen of the first frame is the person.
    let manifest = fs::read_to_string(made.join("sequence.toml")).unwrap();
    let bare: String = manifest
        .lines()
        .filter(|line| !line.starts_with("mask") && !line.starts_with("background"))
        .map(|line| format!("{line}\n"))
        .collect();
    fs::write(made.join("sequence.toml"), bare).unwrap();
    let look = folder.path().join("look");
    let [made_name, look_name] = [&made, &look].map(|path| path.to_str().unwrap());
    let done = pantin(&["features", made_name, "--frames", "0..1", "-o", look_name]);
    succeeded(&done);
    let seen = image::open(look.join(format!("{camera}/silhouette_000000.png"))).unwrap().to_luma8();
    let truth = mask(0);
    let (mut both, mut either) = (0.0, 0.0);
    for (a, b) in seen.pixels().zip(truth.pixels()) {
        both += f64::from(u8::from(a[0] > 0 && b[0] > 0));
        either += f64::from(u8::from(a[0] > 0 || b[0] > 0));
    }
    println!("the first silhouette overlaps the exact one by {:.3}", both / either);
    assert!(both / either > 0.75, "{}", both / either);
    let done = pantin(&["check", made_name]);
    assert!(stdout(&done).contains("learnt background") && !stderr(&done).contains("neither"), "{}", stdout(&done));
}

/// A real recording whose person never leaves the beam: it is said where.
#[test]
fn who_never_leaves_is_told_apart() {
    let name = "who_never_leaves_is_told_apart";
    let Some(data) = shared(name, "beam/videos") else { return };
    if !has_ffmpeg(name) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let small = folder.path().join("cam03_%04d.png");
    // Small pictures, made once: the test is of the plate and not of its size.
    let made = std::process::Command::new("ffmpeg")
        .args(["-v", "error", "-i"])
        .arg(data.join("cam03.mp4"))
        .args(["-vf", "select=not(mod(n\\,3)),scale=136:240", "-fps_mode", "passthrough"])
        .arg(&small)
        .status()
        .unwrap();
    assert!(made.success());
    let plate = folder.path().join("plate.png");
    let done = pantin(&["plate", small.to_str().unwrap(), "-o", plate.to_str().unwrap()]);
    succeeded(&done);
    let said = stderr(&done);
    assert!(
        said.contains("hardly ever seen empty") || said.contains("no look that is there clearly longest"),
        "{said}"
    );
}

//! `pantin texture` from the outside.

use std::path::Path;
use std::process::Output;

use super::support::{program, stderr as message, stdout};

fn texture(arguments: &[&str], folder: &Path) -> Output {
    program().arg("texture").args(arguments).current_dir(folder).output().unwrap()
}

#[test]
fn materials_are_listed_drawn_and_shown_on_objects() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| {
        let output = texture(arguments, folder.path());
        assert!(output.status.success(), "{arguments:?}: {}", message(&output));
        stdout(&output)
    };
    let open = |name: &str| image::open(folder.path().join(name)).unwrap();
    assert_eq!(run(&["--list"]).lines().count(), 12);
    run(&["marble", "-o", "m.png", "--size", "40x30", "--seed", "3", "--depth", "16"]);
    let picture = open("m.png");
    assert_eq!((picture.width(), picture.height(), picture.color()), (40, 30, image::ColorType::Rgb16));
    run(&["wood", "-o", "h.png", "--size", "20x20", "--height-map"]);
    assert_eq!(open("h.png").color(), image::ColorType::L8);
    // A tile's ends are neighbours: no farther apart than neighbours inside are.
    run(&["clouds", "-o", "t.png", "--size", "64x64", "--tile"]);
    let tile = open("t.png").into_rgb8();
    let step =
        |a: u32, b: u32| (0..64).map(|y| tile.get_pixel(a, y).0[0].abs_diff(tile.get_pixel(b, y).0[0])).max().unwrap();
    assert!(step(63, 0) <= (0..63).map(|x| step(x, x + 1)).max().unwrap() + 8, "{}", step(63, 0));
    for object in ["sphere", "cube", "plane", "person"] {
        run(&["brick", "-o", "o.png", "--size", "48x36", "--preview", object, "--force"]);
        let shown = open("o.png").into_rgb8();
        let background = *shown.get_pixel(0, 0);
        let share = shown.pixels().filter(|pixel| **pixel != background).count() as f64 / (48.0 * 36.0);
        assert!((0.05..0.8).contains(&share), "{object}: {share}");
    }
}

#[test]
fn an_example_grows_the_same_on_both_backends() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = |name: &'static str| ["brick", "-o", name, "--size", "48x40", "--scale", "1.6"];
    assert!(texture(&arguments("example.png"), folder.path()).status.success());
    let grow = |output: &str, more: &[&str]| {
        let example = ["--example", "example.png", "-o", output, "--size", "60x50", "--patch", "16", "--overlap", "4"];
        texture(&[&example[..], more].concat(), folder.path())
    };
    let grown = grow("a.png", &["--decomposition", "d.png", "--resynthesised", "r.png", "--delta-max", "0.005"]);
    assert!(grown.status.success(), "{}", message(&grown));
    for name in ["a.png", "d.png", "r.png"] {
        assert_eq!(image::image_dimensions(folder.path().join(name)).unwrap(), (60, 50), "{name}");
    }
    let device = grow("b.png", &["--delta-max", "0.005", "--backend", "device"]);
    if !device.status.success() && std::env::var_os("PANTIN_NEEDS_VULKAN").is_none() {
        println!("SKIPPED the device of an_example_grows_the_same_on_both_backends: {}", message(&device));
        return;
    }
    assert!(device.status.success(), "{}", message(&device));
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(read("a.png"), read("b.png"));
}

#[test]
fn parameters_are_listed_as_they_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| {
        let output = texture(arguments, folder.path());
        assert!(output.status.success(), "{arguments:?}: {}", message(&output));
        stdout(&output)
    };
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    for line in run(&["--list"]).lines() {
        let name = line.split_whitespace().next().unwrap();
        let defaults = run(&[name, "--defaults"]);
        std::fs::write(folder.path().join("all.toml"), &defaults).unwrap();
        run(&[name, "-o", "plain.png", "--size", "24x24", "--force"]);
        run(&[name, "-o", "listed.png", "--size", "24x24", "--params", "all.toml", "--force"]);
        assert_eq!(read("plain.png"), read("listed.png"), "{name}: {defaults}");
        // The documents have every one of them.
        let table: toml::Table = defaults.parse().unwrap();
        let documented = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/TEXTURE.md")).unwrap();
        let row = documented.lines().find(|line| line.starts_with(&format!("| `{name}` |"))).unwrap_or_default();
        for key in table.keys() {
            assert!(row.contains(&format!("`{key}")), "{name}: {key} is not in docs/TEXTURE.md");
        }
    }
    assert!(run(&["sun", "--defaults"]) == run(&["lava", "--defaults"]));
}

/// An example may be any picture; what is no picture, or is cut short, is a sentence.
#[test]
fn examples_come_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let example = image::RgbImage::from_fn(24, 24, |x, y| {
        image::Rgb([(x * 9) as u8, (y * 9) as u8, if (x / 6 + y / 6) % 2 == 0 { 200 } else { 20 }])
    });
    let mut grown = Vec::new();
    for end in ["png", "bmp", "tiff", "webp", "gif", "jpg"] {
        let (from, to) = (format!("e.{end}"), format!("{end}.png"));
        example.save(folder.path().join(&from)).unwrap();
        let done = texture(
            &["--example", &from, "-o", &to, "--size", "32x32", "--patch", "12", "--overlap", "4"],
            folder.path(),
        );
        assert!(done.status.success(), "{end}: {}", message(&done));
        grown.push(std::fs::read(folder.path().join(&to)).unwrap());
        let bytes = std::fs::read(folder.path().join(&from)).unwrap();
        std::fs::write(folder.path().join(&from), &bytes[..bytes.len() / 4]).unwrap();
        let failed = texture(&["--example", &from, "-o", "x.png"], folder.path());
        let message = message(&failed);
        assert!(
            failed.status.code() == Some(1) && message.contains(&from) && message.trim().lines().count() == 1,
            "{end}: {message}"
        );
    }
    assert!(grown[..4].iter().all(|same| *same == grown[0]), "formats without loss give one texture");
}

#[test]
fn bad_requests_are_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("p.toml"), "vien = [1.0, 0.0, 0.0]\n").unwrap();
    std::fs::write(folder.path().join("text.png"), "no picture").unwrap();
    for (arguments, expected) in [
        (
            &["marbel", "-o", "x.png"][..],
            "unknown material `marbel`, the nearest is `marble` (known: clouds, lava, marble, granite, wood, timber, brick",
        ),
        (&["marble", "-o", "x.png", "--size", "0x9"], "a picture of 0 x 9 pixels"),
        (&["marble", "-o", "x.png", "--params", "p.toml"], "nearest known key is `vein`"),
        (&["marbel", "--defaults"], "unknown material `marbel`, the nearest is `marble`"),
        (&["marble", "-o", "x.png", "--scale", "nan"], "a picture of NaN units"),
        (&["marble", "-o", "x.png", "--preview", "sphere", "--person", "a.glb"], "--person is for --preview person"),
        (&["marble", "-o", "x.png", "--preview", "person", "--person", "a.glb"], "a.glb"),
        (&["marble", "-o", "x.jpg", "--size", "20x20"], "x.jpg is called as if it were no PNG"),
        (&["--example", "nowhere.png", "-o", "x.png"], "nowhere.png"),
        (&["--example", "text.png", "-o", "x.png"], "text.png"),
        (&["--example", "text.png", "-o", "x.png", "--preview", "cube"], "means nothing with --example"),
    ] {
        let failed = texture(arguments, folder.path());
        let message = message(&failed);
        assert_eq!(failed.status.code(), Some(1), "{arguments:?}: {message}");
        assert!(message.contains(expected) && message.trim().lines().count() == 1, "{arguments:?}: {message}");
        assert!(!folder.path().join("x.png").exists(), "{arguments:?} wrote something");
    }
}

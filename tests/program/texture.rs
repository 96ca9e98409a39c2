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
    for object in ["sphere", "cube", "plane", "person", "surface"] {
        run(&["brick", "-o", "o.png", "--size", "48x36", "--preview", object, "--force"]);
        let shown = open("o.png").into_rgb8();
        let background = *shown.get_pixel(0, 0);
        let share = shown.pixels().filter(|pixel| **pixel != background).count() as f64 / (48.0 * 36.0);
        assert!((0.05..0.8).contains(&share), "{object}: {share}");
    }
}

/// What makes a picture of a material, flat, its heights and on objects, by each way of noise, with the processor's bytes on a device;
/// each way has a picture of its own.
#[test]
fn materials_are_the_same_on_both_backends() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = |name: &str, arguments: &[&str]| {
        let arguments = [arguments, &["-o", name, "--size", "57x43", "--depth", "16", "--force"]].concat();
        texture(&arguments, folder.path())
    };
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    for arguments in [
        &["grass", "--tile"][..],
        &["marble", "--noise", "tables"],
        &["marble", "--noise", "volume"],
        &["marble"],
        &["skin", "--height-map", "--offset", "-3,2.5,1"],
        &["fractal", "--preview", "surface"],
        &["fabric", "--preview", "sphere", "--scale", "9"],
        &["timber", "--preview", "person"],
    ] {
        assert!(drawn("cpu.png", arguments).status.success());
        let device = drawn("device.png", &[arguments, &["--backend", "device"]].concat());
        if !device.status.success() && std::env::var_os("PANTIN_NEEDS_VULKAN").is_none() {
            println!("SKIPPED materials_are_the_same_on_both_backends: {}", message(&device));
            return;
        }
        assert!(device.status.success(), "{}", message(&device));
        assert_eq!(read("cpu.png"), read("device.png"), "{arguments:?}");
    }
    let ways = ["arithmetic", "tables", "volume"].map(|way| {
        assert!(drawn("way.png", &["lava", "--noise", way]).status.success());
        read("way.png")
    });
    assert!(ways[0] != ways[1] && ways[1] != ways[2] && ways[0] != ways[2]);
}

/// A terrain takes its colours from a picture; what has no bands, and what no way of noise can do, is said.
#[test]
fn palettes_and_noise_that_make_no_sense_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| {
        texture(&[arguments, &["-o", "o.png", "--size", "40x30", "--force"]].concat(), folder.path())
    };
    let red = image::RgbImage::from_fn(32, 8, |x, _| image::Rgb([(8 * x) as u8, 0, 0]));
    red.save(folder.path().join("red.png")).unwrap();
    std::fs::write(folder.path().join("p.toml"), "[map]\nshading = 0.0\nisolines = 0.0\n").unwrap();
    let output = run(&["terrain", "--palette", "red.png", "--params", "p.toml"]);
    assert!(output.status.success(), "{}", message(&output));
    let picture = image::open(folder.path().join("o.png")).unwrap().into_rgb8();
    assert!(picture.pixels().all(|pixel| pixel[1] == 0 && pixel[2] == 0));
    let reds = picture.pixels().map(|pixel| pixel[0]);
    assert!(reds.clone().max().unwrap() > reds.min().unwrap() + 60);
    for (arguments, expected) in [
        (
            &["marble", "--palette", "red.png"][..],
            "--palette is for materials with bands of colour by height (fractal, terrain)",
        ),
        (&["terrain", "--palette", "none.png"], "none.png"),
        (&["marble", "--noise", "volume", "--tile"], "expected arithmetic or tables"),
        (&["marble", "--noise", "tabels"], "the nearest is `tables`"),
        (&["--example", "red.png", "--noise", "tables"], "--noise means nothing with --example"),
    ] {
        let output = run(arguments);
        assert!(!output.status.success(), "{arguments:?}");
        assert!(message(&output).contains(expected), "{arguments:?}: {}", message(&output));
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

/// Several examples, a mask, patches whose sides differ, and holes, by picture and by opacity: known pixels stay, and both backends
/// write one file.
#[test]
fn holes_are_filled_from_several_examples() {
    let folder = tempfile::tempdir().unwrap();
    let save = |name: &str, picture: image::DynamicImage| picture.save(folder.path().join(name)).unwrap();
    let pixel = |x: u32, y: u32| [(40 + x % 8 * 20) as u8, (50 + y % 4 * 30) as u8, 90];
    let is_hole = |x: u32, y: u32| (20..33).contains(&x) && (14..25).contains(&y);
    let colour = |x: u32, y: u32| image::Rgb(if is_hole(x, y) { [255, 0, 255] } else { pixel(x, y) });
    let shade = |x: u32, y: u32| image::Luma([if is_hole(x, y) { 0 } else { 255 }]);
    save("e.png", image::RgbImage::from_fn(56, 40, colour).into());
    save("holes.png", image::GrayImage::from_fn(56, 40, shade).into());
    let with_opacity = |x: u32, y: u32| {
        let image::Rgb([r, g, b]) = colour(x, y);
        image::Rgba([r, g, b, shade(x, y).0[0]])
    };
    save("clear.png", image::RgbaImage::from_fn(56, 40, with_opacity).into());
    save("other.png", image::RgbImage::from_fn(30, 30, |x, y| image::Rgb([(x * 8) as u8, 200, (y * 8) as u8])).into());
    save("half.png", image::GrayImage::from_fn(30, 30, |x, _| image::Luma([if x < 15 { 255 } else { 0 }])).into());
    let run = |arguments: &[&str], output: &str| {
        let done = texture(&[arguments, &["-o", output]].concat(), folder.path());
        assert!(done.status.success(), "{arguments:?}: {}", message(&done));
        std::fs::read(folder.path().join(output)).unwrap()
    };
    let filled = run(&["--example", "e.png", "--inpaint", "holes.png", "--patch", "16x8"], "filled.png");
    let picture = image::load_from_memory(&filled).unwrap().into_rgb8();
    assert_eq!(picture.dimensions(), (56, 40));
    // The pattern repeats, so what belongs in the hole is known.
    assert!(picture.enumerate_pixels().all(|(x, y, found)| found.0 == pixel(x, y)));
    assert!(
        filled == run(&["--example", "clear.png", "--inpaint-channel", "a", "--patch", "16x8"], "clear_filled.png")
    );
    let several = ["--example", "e.png", "--example", "other.png", "--mask", "ALL", "--mask", "half.png"];
    let grown = ["--size", "48x40", "--patch", "4x16", "--delta-max", "0.005", "--seed", "3"];
    let other = ["--example", "e.png", "--example", "other.png", "--mask", "IGNORE", "--inpaint", "holes.png"];
    let requests = [[&several[..], &grown].concat(), [&other[..], &["--delta-pixel", "0.01"]].concat()];
    for (i, request) in requests.iter().enumerate() {
        let here = run(request, &format!("here{i}.png"));
        let picture = image::load_from_memory(&here).unwrap().into_rgb8();
        if i == 1 {
            assert!(picture.enumerate_pixels().all(|(x, y, found)| is_hole(x, y) || found.0 == pixel(x, y)));
            assert!(picture.get_pixel(26, 19).0[1] > 150, "the hole has nothing of the other example");
        }
        let there = [&request[..], &["--backend", "device", "-o", "there.png", "--force"]].concat();
        let device = texture(&there, folder.path());
        if !device.status.success() && std::env::var_os("PANTIN_NEEDS_VULKAN").is_none() {
            println!("SKIPPED the device of holes_are_filled_from_several_examples: {}", message(&device));
            continue;
        }
        assert!(device.status.success(), "{}", message(&device));
        assert!(here == std::fs::read(folder.path().join("there.png")).unwrap(), "{request:?}");
    }
}

#[test]
fn bad_holes_and_masks_are_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let save = |name: &str, size: u32, value: u8| {
        image::GrayImage::from_pixel(size, size, image::Luma([value])).save(folder.path().join(name)).unwrap();
    };
    save("e.png", 12, 120);
    save("small.png", 9, 255);
    save("dark.png", 12, 0);
    let example = ["--example", "e.png", "-o", "x.png"];
    for (arguments, status, expected) in [
        (&["--mask", "small.png"][..], 1, "the mask small.png has 9 x 9 pixels, expected the 12 x 12 of e.png"),
        (
            &["--inpaint", "small.png"],
            1,
            "the picture of holes small.png has 9 x 9 pixels, expected the 12 x 12 of e.png",
        ),
        (&["--mask", "dark.png"], 1, "the mask is dark all over"),
        (&["--mask", "IGNORE"], 1, "the mask is dark all over"),
        (&["--inpaint", "dark.png"], 1, "nothing of the example is known"),
        (&["--inpaint-channel", "a"], 1, "e.png has no transparency"),
        (&["--mask", "ALL", "--mask", "ALL"], 1, "2 masks for 1 examples, expected at most one for each"),
        (&["--inpaint", "nowhere.png"], 1, "nowhere.png"),
        (&["--example", "nowhere.png"], 1, "nowhere.png"),
        (&["--patch", "24"], 1, "patches of 24 pixels a side, expected powers of two"),
        (&["--patch", "16x0"], 1, "patches of 16 x 0 pixels, expected powers of two"),
        (&["--mask="], 2, "a value is required for '--mask"),
        (&["--patch", "wide"], 2, "expected a side in pixels, 32 say, or a width and a height, 32x16 say"),
        (&["--inpaint", "dark.png", "--size", "12x12"], 2, "--size"),
        (&["--inpaint-channel", "x"], 2, "unknown channel `x`"),
    ] {
        let failed = texture(&[&example[..], arguments].concat(), folder.path());
        let message = message(&failed);
        assert_eq!(failed.status.code(), Some(status), "{arguments:?}: {message}");
        assert!(message.contains(expected), "{arguments:?}: {message}");
        assert!(status == 2 || message.trim().lines().count() == 1, "{arguments:?}: {message}");
        assert!(!folder.path().join("x.png").exists(), "{arguments:?} wrote something");
    }
    let failed = texture(&["marble", "-o", "x.png", "--patch", "16x8"], folder.path());
    assert!(message(&failed).contains("--patch means nothing without --example"));
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
            &["--example", &from, "-o", &to, "--size", "32x32", "--patch", "16", "--overlap", "4"],
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
        (
            &["marble", "-o", "x.png", "--preview", "sphere", "--person", "a.glb"],
            "--person means nothing without --preview person",
        ),
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

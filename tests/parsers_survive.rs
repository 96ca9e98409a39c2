//! Every parser of a file that a user can hand in, given damaged files: whatever comes, it answers with something valid
//! or with one sentence that starts with the file's name. The seeds are those of the fuzz targets in `tests/fuzz`.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use std::path::Path;

use pantin::body::{Body, PoseTable, RetargetSettings, parse_body};
use pantin::calibrate::{parse_pairs, parse_tracks};
use pantin::motion::{
    DeepMimicSkeleton, parse_amc, parse_asf, parse_bvh, parse_c3d, parse_deepmimic, parse_deepmimic_skeleton,
    parse_points_csv, parse_trc,
};
use pantin::sequence::{check_manifest, parse_cameras_toml, parse_opencv_xml, parse_opencv_yaml, parse_qualisys};
use pantin::study::Study;
use pantin::synth::Scene;
use proptest::prelude::*;

/// One kind of damage; places are fractions of the file's length.
#[derive(Clone, Debug)]
enum Damage {
    Truncate(f64),
    Flip(f64, u8),
    Overwrite(f64, &'static [u8]),
    Insert(f64, &'static [u8]),
    /// A stretch of the file, copied to another place.
    Repeat(f64, f64, f64),
    Remove(f64, f64),
    /// Two words (between blanks, tabs, commas or line ends) change places.
    SwapWords(f64, f64),
    ReplaceWord(f64, &'static [u8]),
}

const WORDS: [&[u8]; 26] = [
    b"nan",
    b"inf",
    b"-1",
    b"0",
    b"1e308",
    b"-1e-308",
    b"99999999999999999999",
    b"4294967295",
    b"65536",
    b"",
    b"\t",
    b",",
    b"\n",
    b"\r\n",
    b"\"",
    b"{",
    b"}",
    b"[",
    b"]",
    b"=",
    b"\0",
    b"\xff\xff",
    b"\xef\xbb\xbf",
    b"\x7f\xff\x7f\xff",
    b"frame",
    "é".as_bytes(),
];

fn damage() -> impl Strategy<Value = Damage> {
    let place = 0.0..1.0f64;
    let word = proptest::sample::select(&WORDS[..]);
    prop_oneof![
        place.clone().prop_map(Damage::Truncate),
        (place.clone(), any::<u8>()).prop_map(|(at, bits)| Damage::Flip(at, bits)),
        (place.clone(), word.clone()).prop_map(|(at, word)| Damage::Overwrite(at, word)),
        (place.clone(), word.clone()).prop_map(|(at, word)| Damage::Insert(at, word)),
        (place.clone(), 0.0..0.3, place.clone()).prop_map(|(from, length, to)| Damage::Repeat(from, length, to)),
        (place.clone(), 0.0..0.3).prop_map(|(from, length)| Damage::Remove(from, length)),
        (place.clone(), place.clone()).prop_map(|(a, b)| Damage::SwapWords(a, b)),
        (place, word).prop_map(|(at, word)| Damage::ReplaceWord(at, word)),
    ]
}

fn word_at(bytes: &[u8], at: usize) -> std::ops::Range<usize> {
    let separates = |byte: &u8| matches!(byte, b' ' | b'\t' | b',' | b'\n' | b'\r');
    let from = bytes[..at].iter().rposition(separates).map_or(0, |place| place + 1);
    let to = bytes[at..].iter().position(separates).map_or(bytes.len(), |length| at + length);
    from..to
}

fn apply(damage: &Damage, bytes: &mut Vec<u8>) {
    let length = bytes.len();
    let place = |fraction: f64| (fraction * length as f64) as usize;
    match *damage {
        Damage::Truncate(at) => bytes.truncate(place(at)),
        _ if length == 0 => {}
        Damage::Flip(at, bits) => bytes[place(at)] ^= bits,
        Damage::Overwrite(at, word) => {
            let end = (place(at) + word.len()).min(length);
            bytes.splice(place(at)..end, word.iter().copied());
        }
        Damage::Insert(at, word) => {
            bytes.splice(place(at)..place(at), word.iter().copied());
        }
        Damage::Repeat(from, part, to) => {
            let piece = bytes[place(from)..place((from + part).min(1.0))].to_vec();
            bytes.splice(place(to)..place(to), piece);
        }
        Damage::Remove(from, part) => {
            bytes.drain(place(from)..place((from + part).min(1.0)));
        }
        Damage::SwapWords(a, b) => {
            let (mut a, mut b) = (word_at(bytes, place(a)), word_at(bytes, place(b)));
            if a.start > b.start {
                std::mem::swap(&mut a, &mut b);
            }
            if a.end <= b.start {
                let (first, second) = (bytes[a.clone()].to_vec(), bytes[b.clone()].to_vec());
                bytes.splice(b, first);
                bytes.splice(a, second);
            }
        }
        Damage::ReplaceWord(at, word) => {
            let range = word_at(bytes, place(at));
            bytes.splice(range, word.iter().copied());
        }
    }
}

/// Parses as the readers do: `Ok(())` when what was read is valid.
type Parser = fn(&[u8]) -> anyhow::Result<()>;

const NAME: &str = "damaged file";

fn text(bytes: &[u8]) -> std::borrow::Cow<'_, str> {
    String::from_utf8_lossy(bytes)
}

fn leg() -> Body {
    parse_body(include_str!("fuzz/seeds/body/leg.toml"), "leg.toml").unwrap()
}

/// The folder of seeds, and the parser.
const PARSERS: [(&str, Parser); 18] = [
    ("c3d", |bytes| parse_c3d(bytes, NAME)?.check()),
    ("trc", |bytes| parse_trc(&text(bytes), NAME)?.check()),
    ("csv", |bytes| parse_points_csv(&text(bytes), NAME)?.check()),
    ("bvh", |bytes| {
        let motion = parse_bvh(&text(bytes), NAME)?;
        motion.check()?;
        // Far ends are refused here, with a sentence that the file's reader completes with its name.
        motion.to_points().map(|_| ()).map_err(|error| error.context(NAME))
    }),
    ("asf", |bytes| parse_asf(&text(bytes), NAME).map(|_| ())),
    ("amc", |bytes| {
        let skeleton = parse_asf(include_str!("fuzz/seeds/asf/leg.asf"), "leg.asf")?;
        parse_amc(&text(bytes), NAME, &skeleton, 120.0)?.check()
    }),
    ("deepmimic", |bytes| {
        let motion = parse_deepmimic(&text(bytes), NAME, &DeepMimicSkeleton::humanoid())?;
        motion.check()?;
        // What is read is a whole person: it fits the default body or is refused, whatever its numbers.
        Body::adult(1750.0)?
            .retarget(&motion, &RetargetSettings::default(), 30.0, 2)
            .map(|_| ())
            .map_err(|error| error.context(NAME))
    }),
    ("character", |bytes| parse_deepmimic_skeleton(&text(bytes), NAME).map(|_| ())),
    ("scene", |bytes| {
        let scene: Scene = pantin::files::parse_toml(&text(bytes), NAME)?;
        scene.check().map_err(|error| error.context(NAME))
    }),
    ("body", |bytes| {
        let body = parse_body(&text(bytes), NAME)?;
        body.world_from_bones(&body.standing_pose()).map(|_| ())
    }),
    ("poses", |bytes| {
        let body = leg();
        let table = PoseTable::parse(bytes, NAME, &body)?;
        table.poses.iter().try_for_each(|pose| body.check_pose(pose))
    }),
    ("cameras", |bytes| parse_cameras_toml(&text(bytes), NAME).map(|_| ())),
    ("qualisys", |bytes| parse_qualisys(&text(bytes), NAME).map(|_| ())),
    // One folder for both spellings of the format: each seed is read by its own parser, damaged or not.
    ("opencv", |bytes| {
        let text = text(bytes);
        let is_xml = text.trim_start().starts_with('<');
        if is_xml { parse_opencv_xml(&text, NAME) } else { parse_opencv_yaml(&text, NAME) }.map(|_| ())
    }),
    ("study", |bytes| Study::parse(&text(bytes), NAME)?.runs().map(|_| ())),
    ("pairs", |bytes| parse_pairs(&text(bytes), NAME, 1.0).map(|_| ())),
    ("tracks", |bytes| parse_tracks(&text(bytes), NAME).map(|_| ())),
    ("sequence", |bytes| check_manifest(&text(bytes), NAME)),
];

fn seeds(format: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/seeds").join(format);
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files.iter().map(|file| std::fs::read(file).unwrap()).collect()
}

#[test]
fn the_seeds_are_read() {
    for (format, parse) in PARSERS {
        let seeds = seeds(format);
        assert!(!seeds.is_empty(), "{format}");
        for seed in seeds {
            parse(&seed).unwrap_or_else(|error| panic!("{format}: {error:#}"));
        }
    }
}

/// One sentence: the file's name first, one line, of a length that a person reads.
fn answers(format: &str, parse: Parser, bytes: &[u8]) -> Result<(), TestCaseError> {
    if let Err(error) = parse(bytes) {
        let message = format!("{error:#}");
        prop_assert!(message.starts_with(NAME), "{format}: {message}");
        prop_assert!(message.lines().count() == 1, "{format}: {message:?}");
        prop_assert!(message.chars().count() < 600, "{format}: {message:?}");
    }
    Ok(())
}

/// What a parser's own message once carried over from the file: line ends, and numbers without an end.
#[test]
fn a_quoted_piece_keeps_the_line() {
    let cases = [
        ("opencv", "units>mm", "units>m\nm"),
        ("opencv", "</opencv_storage", "</opencv_storage\n<"),
        ("qualisys", "</calibration", "</calibration\n<"),
        ("bvh", "OFFSET 0", "OFFSET 1e300"),
    ];
    for (format, whole, damaged) in cases {
        let text = String::from_utf8(seeds(format).swap_remove(0)).unwrap().replacen(whole, damaged, 1);
        let (_, parse) = PARSERS.iter().find(|(name, _)| *name == format).unwrap();
        assert!(parse(text.as_bytes()).is_err(), "{format}: {text}");
        answers(format, *parse, text.as_bytes()).unwrap();
    }
}

#[test]
fn every_truncation_is_answered() {
    for (format, parse) in PARSERS {
        for seed in seeds(format) {
            for length in 0..seed.len() {
                answers(format, parse, &seed[..length]).unwrap();
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn every_damage_is_answered(damages in proptest::collection::vec(damage(), 1..6)) {
        for (format, parse) in PARSERS {
            for mut bytes in seeds(format) {
                damages.iter().for_each(|damage| apply(damage, &mut bytes));
                answers(format, parse, &bytes)?;
            }
        }
    }
}

//! Files of motion, tables and pictures, damaged: cut, bytes turned over, words replaced, lines doubled.

use super::case::{Case, Spoilt};
use super::ground::{Ground, Sound};

/// Words that stand in for others.
const WORDS: [&[u8]; 12] =
    [b"nan", b"inf", b"-1", b"1e308", b"1e-308", b"99999999999999999999", b"", b"\xff\xff", b"\t", b"\"", b"0", b"-"];

/// Cases of each file.
const OF_EACH: usize = 45;

pub(super) fn cases(ground: &Ground) -> Vec<Case> {
    let convert = |from: &'static [&'static str]| Sound { arguments: from, output: Some("out.csv") };
    let files: [(&str, Sound); 9] = [
        ("truth.c3d", convert(&["convert", "truth.c3d", "out.csv"])),
        ("truth.trc", convert(&["convert", "truth.trc", "out.csv"])),
        ("joints.csv", convert(&["convert", "joints.csv", "out.csv"])),
        ("walk.bvh", convert(&["convert", "walk.bvh", "out.csv"])),
        ("walk.bvh", Sound { arguments: &["score", "walk.bvh", "--truth", "truth.trc"], output: None }),
        (
            "pairs.csv",
            Sound {
                arguments: &["calibrate", "pairs.csv", "-o", "out.toml", "--size", "640x480"],
                output: Some("out.toml"),
            },
        ),
        (
            "made/start.csv",
            Sound {
                arguments: &["evaluate", "--sequence", "made", "--frame", "1", "--poses", "made/start.csv"],
                output: None,
            },
        ),
        (
            "made/frames/cam2_0001.png",
            Sound { arguments: &["features", "made", "-o", "out", "--frames", "1..2"], output: Some("out") },
        ),
        ("made/cameras.toml", Sound { arguments: &["check", "made", "--samples", "1"], output: None }),
    ];
    let mut cases = Vec::new();
    for (file, sound) in &files {
        let whole = ground.bytes(file);
        let mut random = Random(whole.len() as u64 + 1);
        for index in 0..OF_EACH {
            let (what, bytes) = damaged(&whole, index, &mut random);
            cases.push(Case::of_file("damaged bytes", what, sound, file, Spoilt::Holds(bytes)));
        }
    }
    cases
}

fn damaged(whole: &[u8], index: usize, random: &mut Random) -> (&'static str, Vec<u8>) {
    let mut bytes = whole.to_vec();
    match index % 5 {
        0 => {
            bytes.truncate(random.below(whole.len()));
            ("cut", bytes)
        }
        1 => {
            for _ in 0..1 + index / 5 {
                let at = random.below(bytes.len());
                bytes[at] ^= 1 << random.below(8);
            }
            ("bits turned over", bytes)
        }
        2 => {
            // The beginning says most.
            let at = random.below(bytes.len().min(600));
            let word = WORDS[random.below(WORDS.len())];
            bytes.splice(at..(at + word.len().max(1)).min(whole.len()), word.iter().copied());
            ("a word replaced at its beginning", bytes)
        }
        3 => {
            let from = random.below(bytes.len());
            let to = (from + random.below(200)).min(bytes.len());
            let piece = bytes[from..to].to_vec();
            bytes.splice(from..from, piece);
            ("a piece doubled", bytes)
        }
        _ => {
            let at = random.below(bytes.len());
            let begin = bytes[..at].iter().rposition(|byte| b", \t\n".contains(byte)).map_or(0, |place| place + 1);
            let end =
                bytes[at..].iter().position(|byte| b", \t\n".contains(byte)).map_or(bytes.len(), |length| at + length);
            let word = WORDS[random.below(WORDS.len())];
            bytes.splice(begin..end.max(begin), word.iter().copied());
            ("a word replaced", bytes)
        }
    }
}

/// Numbers that look drawn by lot and are the same on every run.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        // splitmix64
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % end.max(1) as u64) as usize
    }
}

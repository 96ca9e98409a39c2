//! Hundreds of odd and hostile inputs over the commands: whatever comes, the program ends in time with its result or with one sentence that
//! names the file or the option, and writes nothing outside its output folder.
//!
//! `cargo test --test program hostile:: -- --ignored --nocapture` tries them all and prints counts by kind and outcome; an ordinary run has
//! every so manyth of them. `PANTIN_HOSTILE` names the commands that alone are tried: `fit,start`.

mod bytes;
mod case;
mod files;
mod ground;
mod texts;
mod values;
mod videos;

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use case::Case;
use ground::Ground;

/// Of the cases an ordinary run has one in so many.
const ONE_IN: usize = 16;
/// Fewer are no list of cases.
const FEWEST: usize = 500;

/// All cases, each kind by itself.
fn cases(ground: &Ground) -> Vec<Case> {
    let mut cases = files::cases(ground);
    cases.extend(texts::cases(ground));
    cases.extend(bytes::cases(ground));
    cases.extend(values::cases(ground));
    cases.extend(videos::cases(ground));
    cases
}

/// Runs cases on two threads; counts by kind and outcome, and what was wrong.
fn run(ground: &Ground, cases: &[&Case]) -> (BTreeMap<(&'static str, &'static str), usize>, Vec<String>) {
    let (counts, wrong) = (Mutex::new(BTreeMap::new()), Mutex::new(Vec::new()));
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let outcome = case.run(ground).unwrap_or_else(|fault| {
                        wrong.lock().unwrap().push(format!("{}: {}\n    {fault}", case.kind, case.told()));
                        "wrong"
                    });
                    *counts.lock().unwrap().entry((case.kind, outcome)).or_insert(0) += 1;
                }
            });
        }
    });
    (counts.into_inner().unwrap(), wrong.into_inner().unwrap())
}

fn hold(one_in: usize) {
    let ground = Ground::new();
    let cases = cases(&ground);
    assert!(cases.len() >= FEWEST, "{} cases", cases.len());
    let named = std::env::var("PANTIN_HOSTILE").ok();
    let is_named = |case: &&Case| {
        named.as_ref().is_none_or(|named| {
            named.split(',').any(|command| case.arguments.first().is_some_and(|own| own == command))
        })
    };
    let chosen: Vec<&Case> = cases.iter().filter(is_named).step_by(one_in).collect();
    let (counts, wrong) = run(&ground, &chosen);
    println!("{} of {} cases", chosen.len(), cases.len());
    for ((kind, outcome), count) in &counts {
        println!("{kind:>28} {outcome:<10} {count:5}");
    }
    assert!(wrong.is_empty(), "{} of {} cases:\n{}", wrong.len(), chosen.len(), wrong.join("\n"));
}

#[test]
fn some_hostile_inputs_are_answered() {
    hold(ONE_IN);
}

#[test]
#[ignore = "minutes long: all cases"]
fn all_hostile_inputs_are_answered() {
    hold(1);
}

//! What every benchmark here is made of: rows that take turns, and one table of their medians.
//!
//! `cargo bench --bench NAME -- WORD` measures the rows whose names hold that word; `cargo test` runs every row once.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark ends where something fails, and prints a table"
)]
#![allow(dead_code, reason = "no benchmark uses all of it")]

use std::hint::black_box;
use std::time::{Duration, Instant};

use pantin::bench::{Round, interleaved};

/// Rounds of a row at most, and the time after which it has had its share.
const ROUNDS: usize = 40;
const SHARE: Duration = Duration::from_secs(2);
/// What is quicker is repeated within a round: alone it would mostly wake its threads and fill caches.
const ROUND_MS: f64 = 10.0;

/// Whether this is `cargo bench`.
pub(crate) fn is_measuring() -> bool {
    std::env::args().any(|argument| argument == "--bench")
}

/// Whether the rows of that name were asked for.
pub(crate) fn is_wanted(name: &str) -> bool {
    let mut words = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).peekable();
    words.peek().is_none() || words.any(|word| name.contains(&word))
}

/// Times by name, in a line.
pub(crate) fn in_a_line(times: &[(String, f64)]) -> String {
    times.iter().map(|(name, ms)| format!("{name} {ms:.3}")).collect::<Vec<_>>().join(", ")
}

struct Row<'a> {
    name: String,
    work: f64,
    run: Box<dyn FnMut() + 'a>,
}

/// Rows to measure beside each other.
pub(crate) struct Table<'a> {
    title: String,
    unit: &'static str,
    beside: &'static [&'static str],
    rows: Vec<Row<'a>>,
}

impl<'a> Table<'a> {
    /// An empty table; the work of its rows is counted in units of that name.
    pub(crate) fn new(title: impl Into<String>, unit: &'static str) -> Self {
        Self { title: title.into(), unit, beside: &[], rows: Vec::new() }
    }

    /// The same with a column for each of these rows: how many times as fast as that one every row is.
    pub(crate) fn beside(self, names: &'static [&'static str]) -> Self {
        Self { beside: names, ..self }
    }

    /// Adds a row of so much work a call, if it was asked for.
    pub(crate) fn row<T>(&mut self, name: impl Into<String>, work: usize, mut run: impl FnMut() -> T + 'a) {
        let name = name.into();
        if is_wanted(&name) {
            let run = Box::new(move || drop(black_box(run())));
            self.rows.push(Row { name, work: work as f64, run });
        }
    }

    /// Measures all rows and prints the table, or runs each once.
    pub(crate) fn run(mut self) {
        if !is_measuring() {
            self.rows.iter_mut().for_each(|row| (row.run)());
            return println!("{}: {} rows ran once", self.title, self.rows.len());
        }
        let repeats: Vec<usize> = self.rows.iter_mut().map(|row| repeats(&mut row.run)).collect();
        let mut rounds: Vec<Round<'_>> = Vec::new();
        for (row, &repeats) in self.rows.iter_mut().zip(&repeats) {
            rounds.push(Box::new(move || {
                (0..repeats).for_each(|_| (row.run)());
                Ok(())
            }));
        }
        let times: Vec<[f64; 3]> = interleaved(&mut rounds, ROUNDS, SHARE)
            .into_iter()
            .map(|times| times.unwrap())
            .zip(&repeats)
            .map(|(times, &repeats)| [times.median, times.min, times.max].map(|ms| ms / repeats as f64))
            .collect();
        drop(rounds);
        let median = |name: &str| self.rows.iter().position(|row| row.name == name).map_or(f64::NAN, |at| times[at][0]);
        print!("\n{}\n{:50} {:>10} {:>10} {:>10}", self.title, "", "ms", "min", "max");
        print!(" {:>14} {:>14} {:>10}", format!("us/{}", self.unit), format!("M{}s/s", self.unit), "a second");
        self.beside.iter().for_each(|name| print!(" {:>10}", format!("x {name}")));
        println!();
        for (row, [ms, least, most]) in self.rows.iter().zip(&times) {
            print!("{:50} {ms:10.4} {least:10.4} {most:10.4}", row.name);
            print!(" {:14.4} {:14.3} {:10.1}", ms * 1e3 / row.work, row.work / ms * 1e-3, 1e3 / ms);
            self.beside.iter().for_each(|name| print!(" {:10.1}", median(name) / ms));
            println!();
        }
    }
}

/// How often to run it for a round of some length.
fn repeats(run: &mut dyn FnMut()) -> usize {
    // The first call makes rooms and touches memory; where it alone is a round's length, the next ones will be about that.
    let timed = |run: &mut dyn FnMut()| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64() * 1e3
    };
    let first = timed(run);
    let ms = if first < 10.0 * ROUND_MS { timed(run) } else { first };
    (ROUND_MS / ms).ceil().clamp(1.0, 1e6) as usize
}

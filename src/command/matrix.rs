//! `pantin matrix`: hardware structures for products of matrices of integers.

use std::path::PathBuf;

use anyhow::{Result, anyhow, ensure};
use serde_json::json;

use super::output::{put, say};
use super::progress::ProgressBar;
use crate::files::{OutputFolder, Overwrite};
use crate::matrix::{
    Multiplier, Rate, Square, Structure, StructureName, StructureRow, SurveySettings, UnitKind, Weights,
};
use crate::report::{XyLine, xy_chart};

/// Sizes and bits that plots go over.
const SIZES: [usize; 6] = [2, 4, 6, 8, 12, 16];
const WIDTHS: [u32; 6] = [4, 8, 12, 16, 20, 24];

/// Rows of a matrix at most: every structure is simulated bit by bit.
const MOST: usize = 32;

/// Compare hardware structures that multiply n x n matrices of r-bit integers: each is simulated bit by bit and cycle by cycle,
/// checked against the product of the integers, and its cycles, parts, links and efficiency are counted (docs/MATRIX.md).
#[derive(clap::Args, Debug)]
pub(super) struct MatrixArgs {
    /// Rows and columns of the matrices, 1 to 32
    #[arg(long, value_name = "N", default_value_t = 8)]
    n: usize,
    /// Bits of an element, two's complement, 2 to 32
    #[arg(long, value_name = "R", default_value_t = 8)]
    bits: u32,
    /// Bits of an element that a cycle takes, where a structure has that choice
    #[arg(long, value_name = "H", default_value_t = 1)]
    group: u32,
    /// Only these: an arrangement, a unit, or ARRANGEMENT/UNIT, recursive say
    #[arg(long, value_name = "NAME")]
    structure: Option<String>,
    /// Only structures with these partial products
    #[arg(long, value_name = "NAME")]
    multiplier: Option<Multiplier>,
    /// Data to keep up with: channels, bits of each at a time, how often a second, and cycles of the structure a second
    #[arg(long, value_name = "CHANNELS,BITS,HZ,CLOCK", value_parser = parse_rate)]
    rate: Option<Rate>,
    /// What gates, lengths of links and pins weigh in an efficiency
    #[arg(long, value_name = "GATES,LINKS,PINS", default_value = "1,1,1", value_parser = parse_weights)]
    weights: Weights,
    /// Seed of the elements that are multiplied
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Write matrix.csv and plots over n and over the bits there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Write into a folder that holds something already
    #[arg(long, requires = "output")]
    force: bool,
}

fn numbers<const N: usize>(text: &str, expected: &str) -> Result<[f64; N], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| format!("expected {expected}"))
}

fn parse_rate(text: &str) -> Result<Rate, String> {
    let [channels, bits, data_hz, clock_hz] = numbers(text, "four numbers, 8,12,1e6,50e6 say")?;
    Rate { channels, bits, data_hz, clock_hz }.checked().map_err(|error| error.to_string())
}

fn parse_weights(text: &str) -> Result<Weights, String> {
    let [gates, links, pins] = numbers(text, "three numbers, 1,0.5,10 say")?;
    let sane = |weight: f64| (0.0..1e15).contains(&weight);
    if [gates, links, pins].into_iter().all(sane) && gates + links + pins > 0.0 {
        return Ok(Weights { gates, links, pins });
    }
    Err("expected numbers from 0 on, of which one is more".to_string())
}

/// Runs the command.
///
/// # Errors
/// When there are no such matrices or structures, a structure is wrong, or a file cannot be written.
pub(super) fn run(args: &MatrixArgs) -> Result<()> {
    ensure!((1..=MOST).contains(&args.n), "--n {}: expected 1 to {MOST} rows", args.n);
    // What the integers refuse is refused before anything is simulated.
    Square::filled(args.n, args.bits, 0)?;
    ensure!((1..=args.bits).contains(&args.group), "--group {}: expected 1 to the {} bits", args.group, args.bits);
    let chosen =
        Chosen { args, name: args.structure.as_deref().map(StructureName::new).transpose()?.unwrap_or_default() };
    let rows = || -> Result<Vec<_>> {
        let rows = chosen.rows(args.n, args.bits)?;
        ensure!(!rows.is_empty(), "no structure has that arrangement, unit and multiplier: see docs/MATRIX.md");
        Ok(rows)
    };
    let overwrite = Overwrite::forced(args.force);
    let rows = match &args.output {
        Some(path) => OutputFolder::filled(path, overwrite, |folder| {
            let rows = rows()?;
            chosen.write_all(&rows, folder)?;
            Ok(rows)
        })?,
        None => rows()?,
    };
    if args.json {
        say!("{}", serde_json::to_string_pretty(&json!({ "rows": rows }))?);
    } else {
        print_table(&rows);
        if let Some(path) = &args.output {
            say!("wrote matrix.csv and plots to {}", path.display());
        }
    }
    let wrong: Vec<&str> = rows.iter().filter(|row| !row.exact).map(|row| row.structure.as_str()).collect();
    if wrong.is_empty() { Ok(()) } else { Err(anyhow!("not the product of the integers: {}", wrong.join(", "))) }
}

struct Chosen<'a> {
    args: &'a MatrixArgs,
    name: StructureName,
}

impl Chosen<'_> {
    fn structures(&self, n: usize, bits: u32) -> Vec<Structure> {
        let wanted = |structure: &Structure| {
            self.name.means(structure) && self.args.multiplier.is_none_or(|it| it == structure.unit.multiplier)
        };
        let group = self.args.group.min(bits);
        Structure::all(n, bits, group).into_iter().filter(wanted).collect()
    }

    fn rows(&self, n: usize, bits: u32) -> Result<Vec<StructureRow>> {
        let MatrixArgs { weights, rate, seed, .. } = *self.args;
        let settings = SurveySettings { weights, rate, seed };
        self.structures(n, bits).iter().map(|structure| StructureRow::new(structure, &settings)).collect()
    }

    /// The table, and plots of it over n and over the bits.
    fn write_all(&self, own: &[StructureRow], folder: &OutputFolder) -> Result<()> {
        let (n, bits) = (self.args.n, self.args.bits);
        let mut progress = ProgressBar::of("matrix", "size", SIZES.len() + WIDTHS.len());
        let mut over = |sizes: &[(usize, u32)]| -> Result<Vec<StructureRow>> {
            let mut rows = Vec::new();
            for &(n, bits) in sizes {
                // Wide elements of large matrices have sums beyond 64 bits.
                if Square::filled(n, bits, 0).is_ok() {
                    rows.extend(self.rows(n, bits)?);
                }
                progress.advance();
            }
            Ok(rows)
        };
        let over_n = over(&SIZES.map(|n| (n, bits)))?;
        let over_bits = over(&WIDTHS.map(|bits| (n, bits)))?;
        drop(progress);
        for (file, rows, label, x) in [
            ("n", &over_n, "n, rows and columns", (|row| row.n as f64) as fn(&StructureRow) -> f64),
            ("bits", &over_bits, "r, bits of an element", |row| f64::from(row.bits)),
        ] {
            for (name, what, y) in PLOTS {
                let svg = xy_chart(label, what, &lines(rows, x, y), [900, 620])?;
                folder.write(&format!("{name}_over_{file}.svg"), |out| Ok(out.write_all(svg.as_bytes())?))?;
            }
        }
        let mut all = own.to_vec();
        all.extend(over_n.into_iter().chain(over_bits));
        all.dedup();
        folder.write("matrix.csv", |out| write_csv(out, &all))
    }
}

type Value = fn(&StructureRow) -> f64;

/// Plots: file, label, what. Costs differ by powers of ten, so their logarithms are plotted.
const PLOTS: [(&str, &str, Value); 7] = [
    ("cycles", "log10 of cycles", |row| (row.cycles as f64).log10()),
    ("partial_products", "log10 of partial products at once", |row| (row.partial_products as f64).log10()),
    ("adders", "log10 of adders", |row| (row.adders as f64).log10()),
    ("registers", "log10 of registers", |row| (row.registers as f64).log10()),
    ("gates", "log10 of gates", |row| (row.gates as f64).log10()),
    ("links", "log10 of length of links", |row| (row.link_length as f64).log10()),
    ("efficiency", "efficiency, 1e-6", |row| row.efficiency * 1e6),
];

/// A line for each structure, or, where they are more than a plot has colours, for each arrangement with two units that are most
/// unlike.
fn lines(rows: &[StructureRow], x: Value, y: Value) -> Vec<XyLine> {
    let mut lines: Vec<XyLine> = Vec::new();
    let shown = |row: &StructureRow| {
        let unit = row.structure.rsplit('/').next().unwrap_or_default();
        let usual = [(UnitKind::Recursive, Multiplier::Bit), (UnitKind::NonRecursive, Multiplier::Booth)];
        usual.iter().any(|(kind, multiplier)| kind.name() == unit && *multiplier == row.multiplier)
    };
    let few =
        rows.iter().map(|row| (&row.structure, row.multiplier)).collect::<std::collections::HashSet<_>>().len() <= 8;
    for row in rows.iter().filter(|row| few || shown(row)) {
        let name = format!("{} {}", row.structure, row.multiplier);
        let point = [x(row), y(row), 0.0];
        match lines.iter_mut().find(|line| line.name == name) {
            Some(line) => line.points.push(point),
            None => lines.push(XyLine { name, points: vec![point] }),
        }
    }
    lines
}

fn write_csv(out: &mut dyn std::io::Write, rows: &[StructureRow]) -> Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    let heads = "structure,multiplier,n,bits,group,cycles,partial_products,adders,registers,pins,links,efficiency,exact,\
                 partial_products_formed,adder_bits,register_bits,link_length,kinds,gates,period,time,operations,intake";
    writer.write_record(heads.split(','))?;
    for row in rows {
        let cells = serde_json::to_value(row)?;
        let cell = |name: &str| match &cells[name] {
            serde_json::Value::String(text) => text.clone(),
            other => other.to_string(),
        };
        writer.write_record(heads.split(',').map(cell))?;
    }
    Ok(writer.flush()?)
}

fn print_table(rows: &[StructureRow]) {
    let first = &rows[0];
    say!("{0} x {0} matrices of {1} bits; efficiency in operations / (gate delay x cost), 1e-6", first.n, first.bits);
    put!(
        "{:38} {:10} {:>5} {:>8} {:>8} {:>7} {:>9} {:>7}",
        "structure",
        "multiplier",
        "group",
        "cycles",
        "partial",
        "adders",
        "registers",
        "pins"
    );
    put!(" {:>7} {:>9} {:>10} {:>6}", "links", "gates", "efficiency", "exact");
    say!("{}", if first.rate.is_some() { "  keeps up  clock needed  group needed" } else { "" });
    for row in rows {
        put!(
            "{:38} {:10} {:>5} {:>8} {:>8}",
            row.structure,
            row.multiplier,
            row.group,
            row.cycles,
            row.partial_products
        );
        put!(" {:>7} {:>9} {:>7} {:>7}", row.adders, row.registers, row.pins, row.links);
        put!(" {:>9} {:>10.2} {:>6}", row.gates, row.efficiency * 1e6, if row.exact { "yes" } else { "NO" });
        if let Some(fit) = &row.rate {
            let group = fit.group_needed.map_or_else(|| "-".to_string(), |group| group.to_string());
            put!("  {:>8}  {:>9.3} MHz  {group:>12}", if fit.keeps_up { "yes" } else { "no" }, fit.clock_needed * 1e-6);
        }
        say!("");
    }
}

//! Structures that multiply matrices, Y = A B: units side by side, fed cycle by cycle (METHOD B5).

use anyhow::{Result, anyhow, ensure};

use super::parts::Parts;
use super::square::{Square, check_pair};
use super::unit::{Unit, UnitKind, UnitPlan};
use crate::files::{Choice, choices};

choices! {
    /// How units share a product of matrices.
    "arrangement" pub enum Arrangement {
        /// one unit, n^2 rows by columns one after the other
        "sequential" Sequential,
        /// n units, a column of Y at a time; an element of B goes to all units at once
        "parallel-serial-global" Global,
        /// n units, a column of Y at a time; each passes B on to the next, a cycle later
        "parallel-serial-local" Local,
        /// n^2 units, each with an element of Y
        "parallel-parallel" Parallel,
    }
}

/// A structure: units, and how they are arranged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Structure {
    /// How units share the product.
    pub arrangement: Arrangement,
    /// The units.
    pub unit: UnitPlan,
}

/// What a simulation gave.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Simulated {
    /// Y, row by row.
    pub product: Vec<i64>,
    /// Cycles from the first element in to the last one out.
    pub cycles: usize,
    /// Partial products that were formed.
    pub formed: usize,
}

/// Lines from ports to units, or from unit to unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Links {
    /// How many lines of one bit.
    pub count: usize,
    /// Their lengths added up; a unit's side is 1.
    pub length: usize,
}

impl Structure {
    /// Every structure for matrices of that size, arrangement by arrangement.
    pub fn all(n: usize, bits: u32, group: u32) -> Vec<Self> {
        let mut all = Vec::new();
        for arrangement in Arrangement::ALL {
            for kind in UnitKind::ALL {
                for &multiplier in kind.multipliers() {
                    let unit = UnitPlan::new(kind, multiplier, [n, bits as usize, group as usize]);
                    all.push(Self { arrangement, unit });
                }
            }
        }
        all
    }

    /// `arrangement/unit`.
    pub fn name(&self) -> String {
        format!("{}/{}", self.arrangement, self.unit.kind)
    }

    fn n(&self) -> usize {
        self.unit.n
    }

    fn units(&self) -> usize {
        match self.arrangement {
            Arrangement::Sequential => 1,
            Arrangement::Global | Arrangement::Local => self.n(),
            Arrangement::Parallel => self.n() * self.n(),
        }
    }

    /// Rows by columns that a unit does.
    fn passes(&self) -> usize {
        self.n() * self.n() / self.units()
    }

    /// Cycles a product where one follows the other.
    pub fn steady_cycles(&self) -> usize {
        self.passes() * self.unit.beats()
    }

    /// Row and column of Y that a pass of a unit gives.
    fn element(&self, unit: usize, pass: usize) -> [usize; 2] {
        let n = self.n();
        match self.arrangement {
            Arrangement::Sequential => [pass % n, pass / n],
            Arrangement::Global | Arrangement::Local => [unit, pass],
            Arrangement::Parallel => [unit / n, unit % n],
        }
    }

    /// Columns of B that come in side by side, and rows of A.
    fn ports(&self) -> [usize; 2] {
        match self.arrangement {
            Arrangement::Sequential => [1, 1],
            Arrangement::Global | Arrangement::Local => [1, self.n()],
            Arrangement::Parallel => [self.n(), self.n()],
        }
    }

    /// What all of it is built of.
    pub fn parts(&self) -> Parts {
        let mut parts = self.unit.parts().times(self.units());
        let [columns, _] = self.ports();
        parts.adders(self.unit.bits + 1, self.unit.pair_adders() * columns);
        if self.arrangement == Arrangement::Local {
            let [_, column] = self.unit.line_bits();
            parts.registers(column as u32, self.n() - 1);
        }
        parts
    }

    /// Pins: lines in for A and B, lines out for what is done at once of Y.
    pub fn pins(&self) -> usize {
        let [columns, rows] = self.ports();
        let [row, column] = self.unit.line_bits();
        // Sums of pairs are made inside.
        let made = self.unit.pair_adders() * (self.unit.bits as usize + 1);
        columns * (column - made) + rows * row + self.units() * self.unit.sum_bits() as usize
    }

    /// Lines between ports and units, units standing in a row or a square.
    pub fn links(&self) -> Links {
        let n = self.n();
        let [row, column] = self.unit.line_bits();
        // A line to all units of a row of them is tapped at each: 1, 2, ... n sides away.
        let to_all = n * (n + 1) / 2;
        let (count, length) = match self.arrangement {
            Arrangement::Sequential => (row + column, row + column),
            Arrangement::Global => (n * (row + column), n * row + to_all * column),
            Arrangement::Local => (n * (row + column), n * (row + column)),
            Arrangement::Parallel => (n * n * (row + column), n * to_all * (row + column)),
        };
        Links { count, length }
    }

    /// Multiplies cycle by cycle, every bit as the hardware would have it.
    ///
    /// # Errors
    /// When the matrices are not of the structure's size and bits.
    pub fn simulate(&self, a: &Square, b: &Square) -> Result<Simulated> {
        check_pair(a, b)?;
        let (n, plan) = (self.n(), self.unit);
        ensure!(
            a.n() == n && a.bits() == plan.bits,
            "matrices of {0} x {0} elements of {1} bits in a structure for {n} x {n} of {2} bits",
            a.n(),
            a.bits(),
            plan.bits
        );
        let columns: Vec<Vec<i64>> = (0..n).map(|column| b.column(column)).collect();
        let beats = plan.beats();
        let time = self.steady_cycles();
        let mut units = vec![Unit::new(plan); self.units()];
        let mut done = vec![0_usize; units.len()];
        // Between units that pass B on: what each had in the cycle before, with the number of its beat.
        let mut passed: Vec<Option<(usize, Vec<u64>)>> = vec![None; units.len()];
        let mut product = vec![0_i64; n * n];
        let mut cycles = 0;
        while done.iter().any(|&passes| passes < self.passes()) {
            let mut sent: Vec<Option<(usize, Vec<u64>)>> = vec![None; units.len()];
            for (index, unit) in units.iter_mut().enumerate() {
                let from_port = |at: usize| {
                    let [_, column] = self.element(index, at / beats);
                    (at, plan.column_lines(&columns[column], at % beats))
                };
                let arriving = match self.arrangement {
                    Arrangement::Local if index > 0 => passed[index - 1].take(),
                    _ => (cycles < time).then(|| from_port(cycles)),
                };
                let sum = match &arriving {
                    Some((at, column)) => {
                        let [row, _] = self.element(index, at / beats);
                        let row = plan.row_lines(a.row(row), at % beats);
                        unit.clock(Some((at % beats, &row, column)))
                    }
                    None => unit.clock(None),
                };
                sent[index] = arriving;
                if let Some(sum) = sum {
                    let [row, column] = self.element(index, done[index]);
                    product[row * n + column] = sum as i64;
                    done[index] += 1;
                }
            }
            passed = sent;
            cycles += 1;
        }
        Ok(Simulated { product, cycles, formed: units.iter().map(|unit| unit.formed).sum() })
    }
}

/// Part of a name that `--structure` takes: an arrangement, a unit, or both with `/` between.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StructureName {
    arrangement: Option<Arrangement>,
    unit: Option<UnitKind>,
}

impl StructureName {
    /// Reads it.
    ///
    /// # Errors
    /// When it is neither.
    pub fn new(name: &str) -> Result<Self> {
        let arrangement = Arrangement::named;
        let unit = UnitKind::named;
        if let Some((first, second)) = name.split_once('/') {
            return Ok(Self { arrangement: Some(arrangement(first)?), unit: Some(unit(second)?) });
        }
        // `sequential` is both: the arrangement then, since a unit can be named behind it.
        if let Ok(arrangement) = arrangement(name) {
            return Ok(Self { arrangement: Some(arrangement), unit: None });
        }
        let names = |all: Vec<&str>| all.join(", ");
        unit(name).map(|unit| Self { arrangement: None, unit: Some(unit) }).map_err(|_| {
            anyhow!(
                "unknown structure `{name}`, expected an arrangement ({}), a unit ({}), or ARRANGEMENT/UNIT",
                names(crate::files::names::<Arrangement>()),
                names(crate::files::names::<UnitKind>())
            )
        })
    }

    /// Whether it means that structure.
    pub fn means(&self, structure: &Structure) -> bool {
        self.arrangement.is_none_or(|it| it == structure.arrangement)
            && self.unit.is_none_or(|it| it == structure.unit.kind)
    }
}

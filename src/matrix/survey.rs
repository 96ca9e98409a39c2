//! Structures beside each other: simulated, counted, and fitted to a rate of data (METHOD B5).

use anyhow::{Result, ensure};
use serde::Serialize;

use super::partial::Multiplier;
use super::square::{Square, integer_product};
use super::structure::Structure;

/// What gates, lengths of links and pins weigh in an efficiency.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Weights {
    /// k1, of a gate.
    pub gates: f64,
    /// k2, of a line as long as a unit.
    pub links: f64,
    /// k3, of a pin.
    pub pins: f64,
}

impl Default for Weights {
    fn default() -> Self {
        Self { gates: 1.0, links: 1.0, pins: 1.0 }
    }
}

/// Data that come in: B's elements, while A stays.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rate {
    /// k, channels.
    pub channels: f64,
    /// g, bits a channel brings at a time.
    pub bits: f64,
    /// F_d, times a second.
    pub data_hz: f64,
    /// F_k, cycles of the structure a second.
    pub clock_hz: f64,
}

impl Rate {
    /// A rate that makes sense.
    ///
    /// # Errors
    /// When one of the numbers is not above 0 and below 1e15.
    pub fn checked(self) -> Result<Self> {
        for (name, value) in
            [("channels", self.channels), ("bits", self.bits), ("data rate", self.data_hz), ("clock", self.clock_hz)]
        {
            ensure!(
                value > 0.0 && value < 1e15,
                "the rate's {name} are {value}, expected a number above 0 and below 1e15"
            );
        }
        Ok(self)
    }

    /// Bits that come in a second, k g F_d.
    pub fn incoming(&self) -> f64 {
        self.channels * self.bits * self.data_hz
    }
}

/// How a structure keeps up with a rate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// Bits a second that come in, k g F_d.
    pub incoming: f64,
    /// Bits a second that the structure takes, F_k m h.
    pub taken: f64,
    /// Whether it keeps up.
    pub keeps_up: bool,
    /// The clock at which it just would, Hz.
    pub clock_needed: f64,
    /// The fewest bits of an element a cycle with which it keeps up at the given clock; none where not even all of them do.
    pub group_needed: Option<u32>,
}

/// A structure's costs, and whether it is right.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StructureRow {
    /// Arrangement and unit.
    pub structure: String,
    /// Its partial products.
    pub multiplier: Multiplier,
    /// n, rows and columns.
    pub n: usize,
    /// r, bits of an element.
    pub bits: u32,
    /// h, bits of an element that a cycle takes.
    pub group: u32,
    /// Cycles from the first element in to the last one out, as simulated.
    pub cycles: usize,
    /// Partial products that are made at once.
    pub partial_products: usize,
    /// Adders, of two or three words.
    pub adders: usize,
    /// Registers.
    pub registers: usize,
    /// Pins, Y.
    pub pins: usize,
    /// Lines between ports and units.
    pub links: usize,
    /// R / (t (k1 gates + k2 length + k3 pins)).
    pub efficiency: f64,
    /// Whether the simulated products equal those of the integers, at drawn elements and at the extremes.
    pub exact: bool,
    /// Partial products of a product of matrices, as simulated.
    pub partial_products_formed: usize,
    /// Full adders.
    pub adder_bits: u64,
    /// Bits of registers.
    pub register_bits: u64,
    /// Lengths of the links added up, sides of a unit: Q.
    pub link_length: usize,
    /// Kinds of part, s.
    pub kinds: usize,
    /// Gates, sum_i W_i d_i.
    pub gates: u64,
    /// Gate delays of a cycle.
    pub period: u32,
    /// t, gate delays of a product.
    pub time: f64,
    /// R, additions of a product: n^2 of n r.
    pub operations: f64,
    /// m h, bits of B that a cycle takes where one product follows the other.
    pub intake: f64,
    /// With a rate: whether the structure keeps up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate: Option<Fit>,
}

/// What a survey takes into account.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurveySettings {
    /// Weights of an efficiency.
    pub weights: Weights,
    /// Data to keep up with.
    pub rate: Option<Rate>,
    /// Seed of the elements that are multiplied.
    pub seed: u64,
}

/// Bits of B that a cycle takes where one product follows the other.
fn intake(structure: &Structure) -> f64 {
    let elements = structure.unit.n * structure.unit.n;
    elements as f64 * f64::from(structure.unit.bits) / structure.steady_cycles() as f64
}

fn fit(structure: &Structure, rate: &Rate) -> Fit {
    let (incoming, taken) = (rate.incoming(), rate.clock_hz * intake(structure));
    let unit = structure.unit;
    let with_group = |group: u32| {
        let unit = super::UnitPlan::new(unit.kind, unit.multiplier, [unit.n, unit.bits as usize, group as usize]);
        Structure { unit, ..*structure }
    };
    let keeps_up = |group: &u32| rate.clock_hz * intake(&with_group(*group)) >= incoming;
    Fit {
        incoming,
        taken,
        keeps_up: taken >= incoming,
        clock_needed: incoming / intake(structure),
        group_needed: (1..=unit.bits).find(keeps_up).map(|group| with_group(group).unit.group),
    }
}

impl StructureRow {
    /// Simulates a structure and counts what it costs.
    ///
    /// # Errors
    /// When there are no matrices of that size and bits.
    pub fn new(structure: &Structure, settings: &SurveySettings) -> Result<Self> {
        let unit = structure.unit;
        let (n, bits) = (unit.n, unit.bits);
        let least = -(1_i64 << (bits - 1));
        let drawn = |seed| Square::drawn(n, bits, seed);
        let pairs = [
            (drawn(settings.seed)?, drawn(!settings.seed)?),
            (Square::filled(n, bits, least)?, Square::filled(n, bits, least)?),
            (Square::filled(n, bits, least)?, Square::filled(n, bits, -1 - least)?),
        ];
        let (mut exact, mut cycles, mut formed) = (true, 0, 0);
        for (a, b) in &pairs {
            let simulated = structure.simulate(a, b)?;
            exact &= simulated.product == integer_product(a, b)?;
            (cycles, formed) = (simulated.cycles, simulated.formed);
        }
        let (parts, links, weights) = (structure.parts(), structure.links(), settings.weights);
        let operations = (n * n * n) as f64 * f64::from(bits);
        let time = cycles as f64 * f64::from(unit.period());
        let cost = weights.gates * parts.gates() as f64
            + weights.links * links.length as f64
            + weights.pins * structure.pins() as f64;
        Ok(Self {
            structure: structure.name(),
            multiplier: unit.multiplier,
            n,
            bits,
            group: unit.group,
            cycles,
            partial_products: parts.partial_products,
            adders: parts.adder_count(),
            registers: parts.register_count(),
            pins: structure.pins(),
            links: links.count,
            efficiency: operations / (time * cost),
            exact,
            partial_products_formed: formed,
            adder_bits: parts.adder_bits(),
            register_bits: parts.register_bits(),
            link_length: links.length,
            kinds: parts.kinds(),
            gates: parts.gates(),
            period: unit.period(),
            time,
            operations,
            intake: intake(structure),
            rate: settings.rate.as_ref().map(|rate| fit(structure, rate)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Arrangement, UnitKind, UnitPlan};
    use super::*;

    fn recursive(arrangement: Arrangement, group: usize) -> Structure {
        Structure { arrangement, unit: UnitPlan::new(UnitKind::Recursive, Multiplier::Bit, [4, 8, group]) }
    }

    /// By hand for n = 4, r = 8, h = 1, one unit: 128 cycles; 4 x 8 ANDs, adders of 3 x 11 + 18 bits, a register of 18; 4 words
    /// and 4 bits in, 18 out; a cycle passes a register (2), an AND (1), two carry-save levels and ripples of 11 and 18 (2 each).
    #[test]
    fn an_efficiency_by_hand() {
        let row = StructureRow::new(&recursive(Arrangement::Sequential, 1), &SurveySettings::default()).unwrap();
        assert!(row.exact);
        assert_eq!((row.cycles, row.gates, row.pins, row.link_length), (128, 32 + 5 * 51 + 6 * 18, 54, 36));
        assert_eq!(row.period, 2 + 1 + 2 * (2 + 11 + 18));
        let expected = 512.0 / (128.0 * 65.0 * (395.0 + 36.0 + 54.0));
        assert!((row.efficiency - expected).abs() < 1e-12, "{} {expected}", row.efficiency);
        let weights = Weights { gates: 0.0, links: 0.0, pins: 2.0 };
        let pins = SurveySettings { weights, ..SurveySettings::default() };
        let row = StructureRow::new(&recursive(Arrangement::Sequential, 1), &pins).unwrap();
        assert!((row.efficiency - 512.0 / (128.0 * 65.0 * 108.0)).abs() < 1e-12);
    }

    /// 4 channels of 8 bits at 1 MHz are 32 Mbit/s. n units take m h = 4 bits a cycle with h = 1: 8 MHz are needed.
    #[test]
    fn a_rate_is_fitted() {
        let rate = Rate { channels: 4.0, bits: 8.0, data_hz: 1e6, clock_hz: 5e6 }.checked().unwrap();
        let settings = SurveySettings { rate: Some(rate), ..SurveySettings::default() };
        let fit = |structure| StructureRow::new(&structure, &settings).unwrap().rate.unwrap();
        let one = fit(recursive(Arrangement::Global, 1));
        assert_eq!((one.incoming, one.taken, one.keeps_up), (32e6, 20e6, false));
        assert_eq!((one.clock_needed, one.group_needed), (8e6, Some(2)));
        assert!(fit(recursive(Arrangement::Global, 2)).keeps_up);
        // A single unit takes a quarter of that: 4 bits of every element a cycle are 4 x 5e6 x 4 / 4 = 20 Mbit/s, 8 are 40.
        assert_eq!(fit(recursive(Arrangement::Sequential, 1)).group_needed, Some(8));
        let too_much = Rate { data_hz: 1e9, ..rate };
        let settings = SurveySettings { rate: Some(too_much), ..settings };
        let row = StructureRow::new(&recursive(Arrangement::Sequential, 1), &settings).unwrap();
        assert_eq!(row.rate.unwrap().group_needed, None);
        let none = Rate { channels: 0.0, ..rate };
        assert!(none.checked().unwrap_err().to_string().contains("channels are 0"));
    }
}

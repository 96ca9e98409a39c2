//! What hardware is built of, counted.

use std::collections::BTreeMap;

/// Gates of a full adder: two exclusive ors, two ands, an or.
const FULL_ADDER_GATES: u64 = 5;
/// Gates of a bit of a register: an edge-triggered D flip-flop of six NANDs.
const REGISTER_GATES: u64 = 6;

/// Parts by kind and width.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parts {
    /// What makes partial products: how many are made at once.
    pub partial_products: usize,
    /// Gates of these.
    pub partial_gates: u64,
    /// Adders by width.
    pub adders: BTreeMap<u32, usize>,
    /// Registers by width.
    pub registers: BTreeMap<u32, usize>,
}

impl Parts {
    pub(super) fn partials(&mut self, count: usize, gates: u32) {
        self.partial_products += count;
        self.partial_gates += count as u64 * u64::from(gates);
    }

    pub(super) fn adders(&mut self, width: u32, count: usize) {
        if count > 0 && width > 0 {
            *self.adders.entry(width).or_default() += count;
        }
    }

    pub(super) fn registers(&mut self, width: u32, count: usize) {
        if count > 0 && width > 0 {
            *self.registers.entry(width).or_default() += count;
        }
    }

    /// So many of them.
    pub(super) fn times(mut self, count: usize) -> Self {
        self.partial_products *= count;
        self.partial_gates *= count as u64;
        self.adders.values_mut().chain(self.registers.values_mut()).for_each(|number| *number *= count);
        self
    }

    /// Adders of any width.
    pub fn adder_count(&self) -> usize {
        self.adders.values().sum()
    }

    /// Full adders.
    pub fn adder_bits(&self) -> u64 {
        bits(&self.adders)
    }

    /// Registers of any width.
    pub fn register_count(&self) -> usize {
        self.registers.values().sum()
    }

    /// Bits of registers.
    pub fn register_bits(&self) -> u64 {
        bits(&self.registers)
    }

    /// Kinds of part: partial products, and adders and registers of each width.
    pub fn kinds(&self) -> usize {
        usize::from(self.partial_products > 0) + self.adders.len() + self.registers.len()
    }

    /// Gates of all: sum_i W_i d_i of METHOD B5.
    pub fn gates(&self) -> u64 {
        self.partial_gates + FULL_ADDER_GATES * self.adder_bits() + REGISTER_GATES * self.register_bits()
    }
}

fn bits(of: &BTreeMap<u32, usize>) -> u64 {
    of.iter().map(|(&width, &count)| u64::from(width) * count as u64).sum()
}

//! Units that multiply a row by a column, y = sum_k a_k b_k, clocked cycle by cycle (METHOD B5).

use super::adders::{AdderTree, RippleAdder, extended, mask, signed};
use super::partial::{Digit, Multiplier, PICK_GATES, Partials, add_partials, digit};
use super::parts::Parts;
use super::square::sum_bits;
use crate::files::choices;

choices! {
    /// How a unit adds up the products of a row and a column.
    "unit of a structure" pub enum UnitKind {
        /// one multiplier and an accumulator, an element after the other
        "sequential" Sequential,
        /// all partial products of all elements in one tree, a cycle in all
        "non-recursive" NonRecursive,
        /// some bits of every element of the column a cycle, accumulated with a shift
        "recursive" Recursive,
        /// both row and column bit by bit, partial products registered before they are added
        "bit-serial" BitSerial,
        /// elements of the column added in pairs beforehand, of which two bits of the row pick one
        "pair-sums" PairSums,
    }
}

impl UnitKind {
    /// The multipliers that it can be made with.
    pub fn multipliers(self) -> &'static [Multiplier] {
        use Multiplier::{Bit, Booth, SerialLsb, SerialMsb};
        match self {
            Self::Sequential => &[Bit, Booth, SerialMsb, SerialLsb],
            Self::NonRecursive | Self::Recursive => &[Bit, Booth],
            Self::BitSerial => &[SerialMsb, SerialLsb],
            Self::PairSums => &[Bit],
        }
    }
}

/// What kind of unit, for rows of `n` numbers of `bits` bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnitPlan {
    /// How it adds up.
    pub kind: UnitKind,
    /// Its partial products.
    pub multiplier: Multiplier,
    /// Elements of a row.
    pub n: usize,
    /// Bits of an element.
    pub bits: u32,
    /// Bits of an element that are taken in a cycle.
    pub group: u32,
}

impl UnitPlan {
    /// A plan with the next group that the unit can have: Booth's is even, the serial multiplier's with the most significant bit
    /// first is one bit, and a unit that is not recursive takes all of them.
    pub fn new(kind: UnitKind, multiplier: Multiplier, [n, bits, group]: [usize; 3]) -> Self {
        let (bits, group) = (bits as u32, group as u32);
        let group = match (kind, multiplier) {
            (UnitKind::NonRecursive, _) => bits.next_multiple_of(multiplier.step()),
            (_, Multiplier::SerialMsb) => 1,
            _ => group.next_multiple_of(multiplier.step()),
        };
        Self { kind, multiplier, n, bits, group }
    }

    /// Groups of an element.
    fn digits(&self) -> u32 {
        self.bits.div_ceil(self.group)
    }

    /// Bits of an element whose sign fills its last group.
    fn total(&self) -> u32 {
        self.digits() * self.group
    }

    /// Cycles in which a row and a column are taken in.
    pub fn beats(&self) -> usize {
        let elements = if self.kind == UnitKind::Sequential { self.n } else { 1 };
        elements * self.digits() as usize
    }

    /// Cycles from the last beat to the sum, beyond the beat's own.
    pub(super) fn latency(&self) -> usize {
        usize::from(self.kind == UnitKind::BitSerial)
    }

    fn is_serial(&self) -> bool {
        matches!(self.multiplier, Multiplier::SerialMsb | Multiplier::SerialLsb)
    }

    /// Elements that a beat has something of.
    fn lanes(&self) -> usize {
        if self.kind == UnitKind::Sequential { 1 } else { self.n }
    }

    /// Partial products of a cycle.
    fn partial_products(&self) -> usize {
        let a_lane = (self.group / self.multiplier.step()) as usize;
        match self.kind {
            UnitKind::PairSums => self.n.div_ceil(2) * a_lane,
            _ if self.is_serial() => 2 * self.lanes() * a_lane,
            _ => self.lanes() * a_lane,
        }
    }

    /// Bits of the sum.
    pub fn sum_bits(&self) -> u32 {
        sum_bits(self.n, self.bits)
    }

    /// Bits of a partial product.
    fn partial_width(&self) -> u32 {
        match self.kind {
            UnitKind::NonRecursive => self.sum_bits(),
            UnitKind::PairSums => self.bits + 1 + self.group,
            _ if self.is_serial() => self.total() + self.group,
            _ => self.bits + self.group,
        }
    }

    fn tree(&self) -> AdderTree {
        let words = self.partial_products();
        if self.kind == UnitKind::NonRecursive {
            // With Booth's digits every word may lack a one, and a tree has a place for all but one of them.
            let spare = usize::from(self.multiplier == Multiplier::Booth);
            return AdderTree { operands: words + spare, width: self.sum_bits() };
        }
        AdderTree { operands: words, width: self.partial_width() + words.next_power_of_two().trailing_zeros() }
    }

    /// The adder that accumulates what the tree gives; none where the tree has everything.
    fn accumulator(&self) -> Option<RippleAdder> {
        let width = match (self.kind, self.multiplier) {
            (UnitKind::NonRecursive, _) => return None,
            (_, Multiplier::SerialLsb) => self.tree().width + 1,
            (UnitKind::Sequential, _) => 2 * self.bits,
            _ => self.sum_bits(),
        };
        Some(RippleAdder { width })
    }

    /// Bits that the row sends at a beat, and the column.
    pub(super) fn line_bits(&self) -> [usize; 2] {
        let (bits, group) = (self.bits as usize, self.group as usize);
        let lanes = self.lanes();
        let below = usize::from(self.multiplier == Multiplier::Booth);
        match self.kind {
            UnitKind::PairSums => [self.n * group, self.n * bits + self.n / 2 * (bits + 1)],
            UnitKind::NonRecursive => [self.n * bits; 2],
            _ if self.is_serial() => [lanes * group; 2],
            _ => [lanes * bits, lanes * (group + below)],
        }
    }

    /// Adders that add the elements of a column in pairs.
    pub(super) fn pair_adders(&self) -> usize {
        if self.kind == UnitKind::PairSums { self.n / 2 } else { 0 }
    }

    /// The element and the group that a beat of it has, the most significant group being the last.
    fn place(&self, beat: usize) -> (usize, u32) {
        let digits = self.digits();
        let at = beat as u32 % digits;
        let group = if self.multiplier == Multiplier::SerialLsb { at } else { digits - 1 - at };
        (beat / digits as usize, group)
    }

    fn digit_of(&self, multiplier: Multiplier, number: i64, group: u32) -> u64 {
        digit(multiplier, number, group * self.group, self.group, self.total()).bits
    }

    fn elements<'a>(&self, of: &'a [i64], beat: usize) -> &'a [i64] {
        if self.kind == UnitKind::Sequential { &of[self.place(beat).0..][..1] } else { of }
    }

    /// What a row sends at a beat.
    pub(super) fn row_lines(&self, row: &[i64], beat: usize) -> Vec<u64> {
        let (_, group) = self.place(beat);
        let whole = !self.is_serial() && self.kind != UnitKind::PairSums;
        let line = |&number: &i64| match whole {
            true => number as u64 & mask(self.bits) as u64,
            false => self.digit_of(self.multiplier, number, group),
        };
        self.elements(row, beat).iter().map(line).collect()
    }

    /// What a column sends at a beat; with pair sums its elements and then their sums.
    pub(super) fn column_lines(&self, column: &[i64], beat: usize) -> Vec<u64> {
        if self.kind == UnitKind::PairSums {
            let word = |number: i64| number as u128 & mask(self.bits + 1);
            let adder = RippleAdder { width: self.bits + 1 };
            let sums = column.chunks_exact(2).map(|pair| adder.add(word(pair[0]), word(pair[1]), false));
            return column.iter().map(|&number| word(number)).chain(sums).map(|word| word as u64).collect();
        }
        let (_, group) = self.place(beat);
        let digits = self.elements(column, beat).iter().map(|&number| self.digit_of(self.multiplier, number, group));
        digits.collect()
    }

    /// What it is built of.
    pub(super) fn parts(&self) -> Parts {
        let mut parts = Parts::default();
        let words = self.partial_products();
        let gates = if self.kind == UnitKind::PairSums { PICK_GATES } else { self.multiplier.gates() };
        // The word that is chosen or not is as wide as its operand; sign and shift are wires.
        let operand = match self.kind {
            UnitKind::PairSums => self.bits + 1,
            _ if self.is_serial() => self.total(),
            _ if self.multiplier == Multiplier::Booth => self.bits + 1,
            _ => self.bits,
        };
        parts.partials(words, operand * gates);
        parts.adders(self.tree().width, self.tree().adders());
        if let Some(adder) = self.accumulator() {
            parts.adders(adder.width, 1);
            parts.registers(adder.width, 1);
        }
        if self.is_serial() {
            parts.registers(self.total(), 2 * self.lanes());
        }
        if self.multiplier == Multiplier::SerialLsb {
            parts.registers(self.total() - self.group, usize::from(self.digits() > 1));
        }
        match self.kind {
            UnitKind::Sequential => {
                parts.adders(self.sum_bits(), 1);
                parts.registers(self.sum_bits(), 1);
            }
            UnitKind::NonRecursive => parts.registers(self.sum_bits(), 1),
            UnitKind::BitSerial => parts.registers(self.partial_width(), words),
            UnitKind::Recursive | UnitKind::PairSums => {}
        }
        parts
    }

    /// Gate delays of a cycle: a register, a partial product, the tree and what accumulates; in the bit-serial unit, whose
    /// partial products are registered, the longest of them.
    pub(super) fn period(&self) -> u32 {
        const REGISTER: u32 = 2;
        const FULL_ADDER: u32 = 2;
        let partial = match (self.kind, self.multiplier) {
            (UnitKind::PairSums, _) => 2,
            (_, Multiplier::Booth) => 3,
            _ => 1,
        };
        let mut adding = self.tree().depth() + self.accumulator().map_or(0, |adder| adder.width);
        if self.kind == UnitKind::Sequential {
            adding += self.sum_bits();
        }
        match self.kind {
            UnitKind::BitSerial => REGISTER.max(partial).max(FULL_ADDER * adding),
            _ => REGISTER + partial + FULL_ADDER * adding,
        }
    }
}

/// A unit at work: the contents of its registers.
#[derive(Clone, Debug)]
pub(super) struct Unit {
    plan: UnitPlan,
    row: Vec<u128>,
    column: Vec<u128>,
    waiting: Option<(usize, Partials)>,
    accumulated: u128,
    low: u128,
    sum: u128,
    /// Partial products formed so far.
    pub(super) formed: usize,
}

impl Unit {
    pub(super) fn new(plan: UnitPlan) -> Self {
        let lanes = plan.lanes();
        let registers = if plan.is_serial() { lanes } else { 0 };
        let (row, column) = (vec![0; registers], vec![0; registers]);
        Self { plan, row, column, waiting: None, accumulated: 0, low: 0, sum: 0, formed: 0 }
    }

    /// A cycle: takes a beat with what row and column send, if there is one, and gives a sum when it is done.
    pub(super) fn clock(&mut self, beat: Option<(usize, &[u64], &[u64])>) -> Option<i128> {
        let formed = beat.map(|(index, row, column)| (index, self.partials(index, row, column)));
        let ready = match self.plan.latency() {
            0 => formed,
            _ => std::mem::replace(&mut self.waiting, formed),
        };
        ready.and_then(|(index, partials)| self.accumulate(index, &partials))
    }

    fn partials(&mut self, beat: usize, row: &[u64], column: &[u64]) -> Partials {
        let plan = self.plan;
        let width = plan.partial_width();
        let (_, group) = plan.place(beat);
        let is_top = group + 1 == plan.digits();
        let digit = |bits| Digit { bits, group: plan.group, is_top };
        let mut partials = Partials::default();
        if plan.kind == UnitKind::PairSums {
            let (elements, sums) = column.split_at(plan.n);
            for (pair, picks) in row.chunks(2).enumerate() {
                for shift in 0..plan.group {
                    let bit = |of: usize| picks.get(of).is_some_and(|word| word >> shift & 1 == 1);
                    let picked = match (bit(0), bit(1)) {
                        (false, false) => 0,
                        (true, false) => elements[2 * pair],
                        (false, true) => elements[2 * pair + 1],
                        (true, true) => sums[pair],
                    };
                    let word = extended(u128::from(picked), plan.bits + 1, width) << shift & mask(width);
                    partials.push(word, is_top && shift + 1 == plan.group, width);
                }
            }
        } else if plan.is_serial() {
            let place = group * plan.group;
            let total = plan.total();
            let is_first = beat.is_multiple_of(plan.digits() as usize);
            for (lane, (&a, &b)) in row.iter().zip(column).enumerate() {
                if is_first {
                    (self.row[lane], self.column[lane]) = (0, 0);
                }
                self.column[lane] |= u128::from(b) << place;
                // a_i B_i + b_i A_(i-1)
                add_partials(&mut partials, plan.multiplier, (self.column[lane], total), digit(a), width);
                add_partials(&mut partials, plan.multiplier, (self.row[lane], total), digit(b), width);
                self.row[lane] |= u128::from(a) << place;
            }
        } else {
            for (&a, &b) in row.iter().zip(column) {
                add_partials(&mut partials, plan.multiplier, (u128::from(a), plan.bits), digit(b), width);
            }
        }
        self.formed += partials.words.len();
        partials
    }

    fn accumulate(&mut self, beat: usize, partials: &Partials) -> Option<i128> {
        let plan = self.plan;
        let tree = plan.tree();
        let wide = |&word: &u128| extended(word, plan.partial_width(), tree.width);
        let mut words: Vec<u128> = partials.words.iter().map(wide).collect();
        words.resize(tree.operands, 0);
        let (sum, ones) = tree.add(&words, partials.ones);
        debug_assert!(ones <= 1, "{plan:?} has no place for {ones} ones");
        let total = plan.sum_bits();
        let digits = plan.digits() as usize;
        let (is_first, is_last) = (beat.is_multiple_of(digits), beat % digits + 1 == digits);
        let product = if let Some(adder) = plan.accumulator() {
            let width = adder.width;
            let before = match (is_first, plan.multiplier) {
                (true, _) => 0,
                (_, Multiplier::SerialLsb) => (signed(self.accumulated, width) >> plan.group) as u128 & mask(width),
                _ => self.accumulated << plan.group & mask(width),
            };
            self.accumulated = adder.add(before, extended(sum, tree.width, width), ones == 1);
            if plan.multiplier == Multiplier::SerialLsb {
                let place = plan.place(beat).1 * plan.group;
                let low = if is_first { 0 } else { self.low };
                self.low = low | (self.accumulated & mask(plan.group)) << place;
                low.wrapping_add((signed(self.accumulated, width) << place) as u128) & mask(total)
            } else {
                extended(self.accumulated, width, total)
            }
        } else {
            sum
        };
        if plan.kind != UnitKind::Sequential {
            return is_last.then(|| signed(product, total));
        }
        if is_last {
            let element = beat / digits;
            let before = if element == 0 { 0 } else { self.sum };
            self.sum = RippleAdder { width: total }.add(before, product, false);
            return (element + 1 == plan.n).then(|| signed(self.sum, total));
        }
        None
    }
}

//! Partial products: what a multiplier adds up (METHOD B5).

use super::adders::{extended, mask};
use crate::files::choices;

choices! {
    /// How a * b is cut into partial products.
    "multiplier" pub enum Multiplier {
        /// one bit of b a partial product, the most significant first and negative
        "bit" Bit,
        /// modified Booth recoding: groups of three bits that overlap by one, digits from -2 to 2
        "booth" Booth,
        /// both operands bit by bit, the most significant first
        "serial-msb" SerialMsb,
        /// both operands some bits a cycle, the least significant first
        "serial-lsb" SerialLsb,
    }
}

/// Gates that make one bit of a partial product: an AND; one of five multiples and its inverse; one of four words.
pub(super) const AND_GATES: u32 = 1;
pub(super) const BOOTH_GATES: u32 = 5;
pub(super) const PICK_GATES: u32 = 4;

impl Multiplier {
    /// Bits of b that a partial product stands for.
    pub fn step(self) -> u32 {
        if self == Self::Booth { 2 } else { 1 }
    }

    /// Gates for one bit of a partial product.
    pub(super) fn gates(self) -> u32 {
        if self == Self::Booth { BOOTH_GATES } else { AND_GATES }
    }
}

/// Partial products, and how many ones are missing from them: an inverted word is a negative one less one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Partials {
    pub(super) words: Vec<u128>,
    pub(super) ones: usize,
}

impl Partials {
    /// Takes a word, as its negative where wanted, by inverting its bits.
    pub(super) fn push(&mut self, word: u128, negative: bool, width: u32) {
        self.words.push(if negative { !word & mask(width) } else { word });
        self.ones += usize::from(negative);
    }
}

/// A digit of b: `group` bits of it, and for Booth the bit below.
#[derive(Clone, Copy, Debug)]
pub(super) struct Digit {
    /// The bits; Booth's lower neighbour is the lowest one.
    pub(super) bits: u64,
    /// How many, without the neighbour.
    pub(super) group: u32,
    /// Whether the highest bit is that of the sign.
    pub(super) is_top: bool,
}

/// The digit of `group` bits from bit `low` on of a number of `total` bits, which its sign fills up.
pub(super) fn digit(multiplier: Multiplier, number: i64, low: u32, group: u32, total: u32) -> Digit {
    let number = i128::from(number);
    let bits = match multiplier {
        Multiplier::Booth => (number << 1 >> low) as u64 & mask(group + 1) as u64,
        _ => (number >> low) as u64 & mask(group) as u64,
    };
    Digit { bits, group, is_top: low + group == total }
}

/// Adds the partial products of `a`, a word of `a_width` bits, and a digit, each of `width` bits.
pub(super) fn add_partials(
    to: &mut Partials,
    multiplier: Multiplier,
    (a, a_width): (u128, u32),
    digit: Digit,
    width: u32,
) {
    let a = extended(a, a_width, width);
    if multiplier == Multiplier::Booth {
        for shift in (0..digit.group).step_by(2) {
            // K = -2 b_(g+1) + b_g + b_(g-1)
            let three = digit.bits >> shift & 7;
            let multiple = match three {
                0 | 7 => 0,
                3 | 4 => 2 * a,
                _ => a,
            };
            // -0 is 0: inverting it and adding the one would be right as well, but takes a gate more.
            to.push(multiple << shift & mask(width), three > 3 && three < 7, width);
        }
        return;
    }
    for shift in 0..digit.group {
        let bit = digit.bits >> shift & 1 == 1;
        let word = if bit { a << shift & mask(width) } else { 0 };
        to.push(word, bit && digit.is_top && shift + 1 == digit.group, width);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::adders::signed;
    use super::*;

    proptest! {
        /// Digits from the top down, each taken with its partial products, give a * b; Booth has half as many.
        #[test]
        fn partial_products_add_up(a in -2048_i64..2048, b in -2048_i64..2048, group in 1_u32..6, booth: bool) {
            let (multiplier, group) =
                if booth { (Multiplier::Booth, 2 * group) } else { (Multiplier::Bit, group) };
            let digits = 12_u32.div_ceil(group);
            let mut sum = 0_i128;
            for index in (0..digits).rev() {
                let mut partials = Partials::default();
                let digit = digit(multiplier, b, index * group, group, digits * group);
                add_partials(&mut partials, multiplier, (a as u128 & mask(12), 12), digit, 40);
                prop_assert_eq!(partials.words.len() as u32, group / multiplier.step());
                let words: i128 = partials.words.iter().map(|&word| signed(word, 40)).sum();
                sum = (sum << group) + words + partials.ones as i128;
            }
            prop_assert_eq!(sum, i128::from(a * b));
        }
    }

    #[test]
    fn booth_digits_are_the_table_s() {
        // The three bits of a group, and K.
        for (three, k) in [(0, 0), (1, 1), (2, 1), (3, 2), (4, -2), (5, -1), (6, -1), (7, 0)] {
            let mut partials = Partials::default();
            let digit = Digit { bits: three, group: 2, is_top: true };
            add_partials(&mut partials, Multiplier::Booth, (5, 8), digit, 16);
            assert_eq!(signed(partials.words[0], 16) + partials.ones as i128, 5 * k, "group {three:03b}");
        }
    }
}

//! Adders and registers, bit by bit: words of two's complement held in the lower bits of a `u128`, each adder made of full
//! adders, one a bit.

/// All bits of a width.
pub(super) fn mask(width: u32) -> u128 {
    if width >= 128 { u128::MAX } else { (1 << width) - 1 }
}

/// A word of some width as the number it stands for.
pub(super) fn signed(word: u128, width: u32) -> i128 {
    let unused = 128 - width;
    ((word << unused) as i128) >> unused
}

/// A word made wider (or narrower) with its sign kept.
pub(super) fn extended(word: u128, from: u32, to: u32) -> u128 {
    signed(word, from) as u128 & mask(to)
}

/// A full adder on every bit: what stays there, and what is carried to the next.
fn full_adders(a: u128, b: u128, c: u128) -> (u128, u128) {
    (a ^ b ^ c, (a & b) | (a & c) | (b & c))
}

/// An adder of two words whose carry ripples from bit to bit.
#[derive(Clone, Copy, Debug)]
pub(super) struct RippleAdder {
    pub(super) width: u32,
}

impl RippleAdder {
    pub(super) fn add(self, a: u128, b: u128, carry_in: bool) -> u128 {
        let mut carry = u128::from(carry_in);
        let mut sum = 0;
        for bit in 0..self.width {
            let (here, next) = full_adders(a >> bit & 1, b >> bit & 1, carry);
            sum |= here << bit;
            carry = next;
        }
        sum
    }
}

/// An adder of many words: carry-save adders make two of three until two are left, and a ripple adder adds these. Every carry
/// that is moved up leaves a free lowest bit, into which the tree takes a one: what is missing from a negative word that only had
/// its bits inverted.
#[derive(Clone, Copy, Debug)]
pub(super) struct AdderTree {
    pub(super) operands: usize,
    pub(super) width: u32,
}

impl AdderTree {
    /// The sum of the words and of so many ones: all that find a place. The rest of the ones comes back.
    pub(super) fn add(self, words: &[u128], mut ones: usize) -> (u128, usize) {
        debug_assert_eq!(words.len(), self.operands);
        let all = mask(self.width);
        let mut rows: Vec<u128> = words.iter().map(|word| word & all).collect();
        let mut take = || {
            let taken = ones.min(1);
            ones -= taken;
            taken as u128
        };
        while rows.len() > 2 {
            let mut next = Vec::with_capacity(rows.len());
            for three in rows.chunks(3) {
                match *three {
                    [a, b, c] => {
                        let (sum, carry) = full_adders(a, b, c);
                        next.extend([sum, (carry << 1 | take()) & all]);
                    }
                    _ => next.extend_from_slice(three),
                }
            }
            rows = next;
        }
        let sum = match *rows {
            [a, b] => RippleAdder { width: self.width }.add(a, b, take() == 1),
            [a] => a,
            _ => 0,
        };
        (sum, ones)
    }

    /// Adders of two or three words that it is made of.
    pub(super) fn adders(self) -> usize {
        self.operands.saturating_sub(1)
    }

    /// Full adders that a sum passes one after the other.
    pub(super) fn depth(self) -> u32 {
        let (mut rows, mut levels) = (self.operands, 0);
        while rows > 2 {
            rows -= rows / 3;
            levels += 1;
        }
        if rows == 2 { levels + self.width } else { levels }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_tree_adds_what_fits(numbers in prop::collection::vec(-100_000_i64..100_000, 1..40), share in 0.0..1.0_f64) {
            let tree = AdderTree { operands: numbers.len(), width: 24 };
            let ones = (share * numbers.len() as f64) as usize;
            let words: Vec<u128> = numbers.iter().map(|&number| number as u128 & mask(24)).collect();
            let (sum, left) = tree.add(&words, ones);
            prop_assert_eq!(left, ones.saturating_sub(numbers.len() - 1));
            prop_assert_eq!(signed(sum, 24), numbers.iter().sum::<i64>() as i128 + (ones - left) as i128);
        }

        #[test]
        fn a_ripple_adder_is_modular(a in any::<u128>(), b in any::<u128>(), carry: bool, width in 1_u32..128) {
            let sum = RippleAdder { width }.add(a & mask(width), b & mask(width), carry);
            prop_assert_eq!(sum, a.wrapping_add(b).wrapping_add(u128::from(carry)) & mask(width));
        }
    }

    #[test]
    fn words_keep_their_sign() {
        assert_eq!((signed(0b1000, 4), signed(0b0111, 4)), (-8, 7));
        assert_eq!(extended(0b1000, 4, 8), 0b1111_1000);
        assert_eq!(extended(u128::MAX, 128, 3), 0b111);
    }

    #[test]
    fn a_tree_is_as_deep_as_its_levels() {
        let depth = |operands| AdderTree { operands, width: 10 }.depth();
        assert_eq!([1, 2, 3, 4, 6, 9].map(depth), [0, 10, 11, 12, 13, 14]);
    }
}

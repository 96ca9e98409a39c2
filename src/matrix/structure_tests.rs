//! Every structure beside the product of the integers, and its costs beside the formulas of METHOD B5.
#![allow(clippy::unwrap_used, reason = "a test or benchmark stops at the first surprise, and prints")]

use proptest::prelude::*;

use super::*;

fn check(structure: &Structure, a: &Square, b: &Square) {
    let simulated = structure.simulate(a, b).unwrap();
    assert_eq!(simulated.product, integer_product(a, b).unwrap(), "{structure:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn every_structure_has_the_product_of_the_integers(n in 1_usize..=8, bits in 2_u32..=17, group in 1_u32..=17, seed: u64) {
        let (a, b) = (Square::drawn(n, bits, seed).unwrap(), Square::drawn(n, bits, !seed).unwrap());
        for structure in Structure::all(n, bits, group.min(bits)) {
            check(&structure, &a, &b);
        }
    }
}

/// The least and the largest elements in every combination, at sizes where sums are exactly as wide as can be.
#[test]
fn signed_extremes_are_exact() {
    for (n, bits, group) in
        [(1, 2, 1), (1, 2, 2), (2, 2, 1), (4, 3, 1), (4, 4, 4), (5, 6, 2), (8, 8, 3), (4, 31, 5), (1, 32, 7)]
    {
        let (least, largest) = (-(1_i64 << (bits - 1)), (1_i64 << (bits - 1)) - 1);
        for x in [least, -1, 0, 1, largest] {
            for y in [least, -1, largest] {
                let (a, b) = (Square::filled(n, bits, x).unwrap(), Square::filled(n, bits, y).unwrap());
                for structure in Structure::all(n, bits, group) {
                    check(&structure, &a, &b);
                }
            }
        }
    }
}

/// A wrong bit in an operand shows in what is compared above.
#[test]
fn a_turned_bit_is_seen() {
    let (a, b) = (Square::drawn(3, 6, 1).unwrap(), Square::drawn(3, 6, 2).unwrap());
    let mut elements = a.elements().to_vec();
    elements[4] ^= 1;
    let other = Square::new(3, 6, elements).unwrap();
    for structure in Structure::all(3, 6, 2) {
        assert_ne!(structure.simulate(&other, &b).unwrap().product, integer_product(&a, &b).unwrap(), "{structure:?}");
    }
}

fn of(arrangement: Arrangement, kind: UnitKind, multiplier: Multiplier, n: usize, bits: u32, group: u32) -> Structure {
    Structure { arrangement, unit: UnitPlan::new(kind, multiplier, [n, bits as usize, group as usize]) }
}

/// Cycles and partial products as METHOD B5 says them, over n, r and h; simulated, not worked out.
#[test]
fn cycles_and_partial_products_are_the_formulas() {
    use Arrangement::{Global, Local, Parallel, Sequential};
    for n in 1..7_usize {
        for r in [2_u32, 3, 5, 8] {
            for h in [1, 2, 3].map(|h: u32| h.min(r)) {
                let (a, b) = (Square::drawn(n, r, 5).unwrap(), Square::drawn(n, r, 6).unwrap());
                let (even, r_) = (h.next_multiple_of(2), r as usize);
                let groups = r.div_ceil(h) as usize;
                let booth_groups = r.div_ceil(even) as usize;
                // Unit, multiplier; cycles and partial products of a row by a column.
                let units = [
                    (UnitKind::Sequential, Multiplier::Bit, n * groups, n * groups * h as usize),
                    (UnitKind::Sequential, Multiplier::Booth, n * booth_groups, n * booth_groups * even as usize / 2),
                    (UnitKind::Sequential, Multiplier::SerialMsb, n * r_, n * 2 * r_),
                    (UnitKind::Sequential, Multiplier::SerialLsb, n * groups, n * 2 * groups * h as usize),
                    (UnitKind::NonRecursive, Multiplier::Bit, 1, n * r_),
                    (UnitKind::NonRecursive, Multiplier::Booth, 1, n * r.div_ceil(2) as usize),
                    (UnitKind::Recursive, Multiplier::Bit, groups, n * groups * h as usize),
                    (UnitKind::Recursive, Multiplier::Booth, booth_groups, n * booth_groups * even as usize / 2),
                    (UnitKind::BitSerial, Multiplier::SerialMsb, r_, n * 2 * r_),
                    (UnitKind::BitSerial, Multiplier::SerialLsb, groups, n * 2 * groups * h as usize),
                    (UnitKind::PairSums, Multiplier::Bit, groups, n.div_ceil(2) * groups * h as usize),
                ];
                for (kind, multiplier, beats, partials) in units {
                    let latency = usize::from(kind == UnitKind::BitSerial);
                    for (arrangement, cycles) in [
                        (Sequential, n * n * beats),
                        (Global, n * beats),
                        (Local, n * beats + n - 1),
                        (Parallel, beats),
                    ] {
                        let structure = of(arrangement, kind, multiplier, n, r, h);
                        let simulated = structure.simulate(&a, &b).unwrap();
                        assert_eq!(simulated.cycles, cycles + latency, "{structure:?}");
                        assert_eq!(simulated.formed, n * n * partials, "{structure:?}");
                    }
                }
            }
        }
    }
}

/// What single structures are made of, counted by hand for n = 4 and r = 8.
#[test]
fn parts_are_those_counted_by_hand() {
    let parts = |kind, multiplier, group| of(Arrangement::Sequential, kind, multiplier, 4, 8, group).parts();
    // 4 words of 9 bits and two more for their sum; a result of 2 x 8 + 2 bits.
    let recursive = parts(UnitKind::Recursive, Multiplier::Bit, 1);
    assert_eq!((recursive.partial_products, recursive.partial_gates), (4, 32));
    assert_eq!(recursive.adders, [(11, 3), (18, 1)].into());
    assert_eq!(recursive.registers, [(18, 1)].into());
    assert_eq!(recursive.gates(), 32 + 5 * (33 + 18) + 6 * 18);
    // n r words, then n r / 2 with Booth.
    assert_eq!(parts(UnitKind::NonRecursive, Multiplier::Bit, 1).adders, [(18, 31)].into());
    assert_eq!(parts(UnitKind::NonRecursive, Multiplier::Booth, 2).adders, [(18, 16)].into());
    // Two words instead of four, and two adders for the pairs.
    let pairs = parts(UnitKind::PairSums, Multiplier::Bit, 1);
    assert_eq!(pairs.partial_products, 2);
    assert_eq!(pairs.adders, [(9, 2), (11, 1), (18, 1)].into());
    // A multiplier: one word, its accumulator of 16 bits, and the sum's.
    let one = parts(UnitKind::Sequential, Multiplier::Bit, 1);
    assert_eq!((one.adders, one.registers), ([(16, 1), (18, 1)].into(), [(16, 1), (18, 1)].into()));
    // Registers for the operands so far (2 x 4), and for the partial products (8).
    let serial = parts(UnitKind::BitSerial, Multiplier::SerialMsb, 1);
    assert_eq!(serial.registers, [(8, 8), (9, 8), (18, 1)].into());
    let local = of(Arrangement::Local, UnitKind::Sequential, Multiplier::Bit, 4, 8, 1);
    let global = of(Arrangement::Global, UnitKind::Sequential, Multiplier::Bit, 4, 8, 1);
    assert_eq!(local.parts().register_bits(), global.parts().register_bits() + 3);
    // A line of A to each unit, and one of B: 8 + 1 bits; four long ones, or four short ones.
    assert_eq!(global.links(), Links { count: 36, length: 32 + 10 });
    assert_eq!(local.links(), Links { count: 36, length: 36 });
    assert_eq!(global.pins(), 1 + 4 * 8 + 4 * 18);
}

#[test]
fn structures_are_named_by_arrangement_or_unit() {
    let count = |name: &str| {
        let name = StructureName::new(name).unwrap();
        Structure::all(4, 8, 1).iter().filter(|structure| name.means(structure)).count()
    };
    assert_eq!(
        ["sequential", "recursive", "parallel-parallel/recursive", "sequential/sequential"].map(count),
        [11, 8, 2, 4]
    );
    let error = StructureName::new("systolic").unwrap_err().to_string();
    assert!(error.contains("unknown structure `systolic`") && error.contains("pair-sums"), "{error}");
    let wrong = of(Arrangement::Sequential, UnitKind::Recursive, Multiplier::Bit, 4, 8, 1);
    let square = Square::filled(4, 7, 1).unwrap();
    assert!(wrong.simulate(&square, &square).unwrap_err().to_string().contains("in a structure for 4 x 4 of 8 bits"));
}

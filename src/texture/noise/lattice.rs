//! What stands on the points of the integer lattice: a 32-bit word for each, by arithmetic or from tables.

/// Words of lattice points. A point's word is built axis by axis, so that neighbours share the work.
pub trait Lattice: Copy + Send + Sync {
    /// The cell that stands for `cell` along `axis`: another one where the lattice repeats itself.
    fn wrapped(&self, axis: usize, cell: i32) -> i32;
    /// The first axis' share of a word.
    fn first(&self, cell: i32) -> u32;
    /// A share with that of a further axis (1 to 3).
    fn join(&self, share: u32, axis: usize, cell: i32) -> u32;
    /// The word: its upper bits are the well mixed ones.
    fn word(&self, share: u32) -> u32;
    /// The lattice of octave number `octave`, unlike that of the others.
    fn octave(&self, octave: u32) -> Self;
}

/// Odd numbers with bits all over, one an axis.
const AXES: [u32; 4] = [0x9E37_79B1, 0x85EB_CA77, 0xC2B2_AE3D, 0x27D4_EB2F];
const MIX: u32 = 0x2C1B_3C6D;
/// The golden ratio's bits: seeds of octaves.
const GOLDEN: u32 = 0x9E37_79B9;

/// A well mixed word of a number (two rounds of multiply and shift): seeds, tables, dice.
pub fn mixed(number: u64) -> u32 {
    let mut x = number ^ 0x6A09_E667_F3BC_C908;
    for _ in 0..2 {
        x = (x ^ (x >> 32)).wrapping_mul(0xD6E8_FEB8_6659_FD93);
    }
    (x ^ (x >> 32)) as u32
}

/// Words by arithmetic: no memory, no period below 2^32 along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HashLattice {
    /// What tells lattices apart, already mixed.
    pub seed: u32,
}

impl HashLattice {
    /// The lattice of a seed.
    pub fn new(seed: u64) -> Self {
        Self { seed: mixed(seed) }
    }
}

impl Lattice for HashLattice {
    #[inline(always)]
    fn wrapped(&self, _: usize, cell: i32) -> i32 {
        cell
    }

    #[inline(always)]
    fn first(&self, cell: i32) -> u32 {
        self.seed ^ (cell as u32).wrapping_mul(AXES[0])
    }

    #[inline(always)]
    fn join(&self, share: u32, axis: usize, cell: i32) -> u32 {
        share ^ (cell as u32).wrapping_mul(AXES[axis])
    }

    #[inline(always)]
    fn word(&self, share: u32) -> u32 {
        (share ^ (share >> 15)).wrapping_mul(MIX)
    }

    #[inline(always)]
    fn octave(&self, octave: u32) -> Self {
        Self { seed: self.seed ^ octave.wrapping_mul(GOLDEN) }
    }
}

/// Entries of a table.
pub const TABLE: usize = 256;

/// A permutation of 0..=255 and a word for each: what Perlin's first implementations look up. It repeats every 256 cells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tables {
    /// The permutation.
    pub order: [u32; TABLE],
    /// The words.
    pub words: [u32; TABLE],
}

impl Tables {
    /// Shuffled tables of a seed.
    pub fn new(seed: u64) -> Self {
        let stream = u64::from(mixed(seed)) << 32;
        let mut order: [u32; TABLE] = std::array::from_fn(|i| i as u32);
        for last in (1..TABLE).rev() {
            let die = (u64::from(mixed(stream | last as u64)) * (last as u64 + 1)) >> 32;
            order.swap(last, die as usize);
        }
        Self { order, words: std::array::from_fn(|i| mixed(stream | (TABLE + i) as u64)) }
    }
}

/// Words from [`Tables`].
#[derive(Clone, Copy, Debug)]
pub struct TableLattice<'a> {
    /// The tables.
    pub tables: &'a Tables,
    /// Moved on from octave to octave.
    pub shift: u32,
}

impl<'a> TableLattice<'a> {
    /// The lattice of tables.
    pub fn new(tables: &'a Tables) -> Self {
        Self { tables, shift: 0 }
    }
}

impl Lattice for TableLattice<'_> {
    #[inline(always)]
    fn wrapped(&self, _: usize, cell: i32) -> i32 {
        cell
    }

    #[inline(always)]
    fn first(&self, cell: i32) -> u32 {
        self.tables.order[((cell as u32).wrapping_add(self.shift) & 255) as usize]
    }

    #[inline(always)]
    fn join(&self, share: u32, _: usize, cell: i32) -> u32 {
        self.tables.order[(share.wrapping_add(cell as u32) & 255) as usize]
    }

    #[inline(always)]
    fn word(&self, share: u32) -> u32 {
        self.tables.words[(share & 255) as usize]
    }

    #[inline(always)]
    fn octave(&self, octave: u32) -> Self {
        Self { shift: self.shift.wrapping_add(octave.wrapping_mul(GOLDEN) >> 24), ..*self }
    }
}

/// A lattice that repeats itself: period in cells per axis, 0 where it does not. The lattice of [`super::Octaves`] is given
/// without one; octaves find their own periods from the size of the tile.
#[derive(Clone, Copy, Debug)]
pub struct Periodic<L> {
    /// What is repeated.
    pub lattice: L,
    /// Cells.
    pub period: [i32; 4],
}

/// `cell` modulo `period`; a period below 1 is none.
#[inline(always)]
fn modulo(cell: i32, period: i32) -> i32 {
    if period < 1 { cell } else { cell.rem_euclid(period) }
}

impl<L: Lattice> Lattice for Periodic<L> {
    #[inline(always)]
    fn wrapped(&self, axis: usize, cell: i32) -> i32 {
        modulo(cell, self.period[axis])
    }

    #[inline(always)]
    fn first(&self, cell: i32) -> u32 {
        self.lattice.first(cell)
    }

    #[inline(always)]
    fn join(&self, share: u32, axis: usize, cell: i32) -> u32 {
        self.lattice.join(share, axis, cell)
    }

    #[inline(always)]
    fn word(&self, share: u32) -> u32 {
        self.lattice.word(share)
    }

    #[inline(always)]
    fn octave(&self, octave: u32) -> Self {
        Self { lattice: self.lattice.octave(octave), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn word(lattice: &impl Lattice, cell: [i32; 3]) -> u32 {
        lattice.word(lattice.join(lattice.join(lattice.first(cell[0]), 1, cell[1]), 2, cell[2]))
    }

    /// Chi squared of the pairs (upper four bits here, upper four bits `step` away) over a block of the lattice.
    fn pair_statistic(lattice: &impl Lattice, step: [i32; 3]) -> f64 {
        let mut counts = [0_u32; 256];
        let mut pairs = 0_u32;
        for x in -20..20 {
            for y in -20..20 {
                for z in -20..20 {
                    let here = word(lattice, [x, y, z]) >> 28;
                    let there = word(lattice, [x + step[0], y + step[1], z + step[2]]) >> 28;
                    counts[(16 * here + there) as usize] += 1;
                    pairs += 1;
                }
            }
        }
        let expected = f64::from(pairs) / 256.0;
        counts.iter().map(|&count| (f64::from(count) - expected).powi(2) / expected).sum()
    }

    #[test]
    fn neighbours_are_independent() {
        // A full finaliser (three shifts, two products) over the same points measures 338 on average and 447 at most.
        for step in [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [2, 0, 0], [1, 1, 1]] {
            for seed in 0..4 {
                let statistic = pair_statistic(&HashLattice::new(seed), step);
                assert!(statistic < 450.0, "step {step:?}, seed {seed}: {statistic}");
            }
        }
        // A plain multiple of the cell number fails this test, as it should.
        #[derive(Clone, Copy)]
        struct Plain;
        impl Lattice for Plain {
            fn wrapped(&self, _: usize, cell: i32) -> i32 {
                cell
            }
            fn first(&self, cell: i32) -> u32 {
                cell as u32
            }
            fn join(&self, share: u32, axis: usize, cell: i32) -> u32 {
                share.wrapping_add((cell as u32) << (8 * axis))
            }
            fn word(&self, share: u32) -> u32 {
                share.wrapping_mul(GOLDEN)
            }
            fn octave(&self, _: u32) -> Self {
                Self
            }
        }
        assert!(pair_statistic(&Plain, [1, 0, 0]) > 1000.0);
    }

    #[test]
    fn tables_hold_a_permutation_of_their_seed() {
        let tables = Tables::new(5);
        let mut sorted = tables.order;
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(i, &entry)| entry == i as u32));
        assert_ne!(tables.order, Tables::new(6).order);
        let lattice = TableLattice::new(&tables);
        assert_eq!(word(&lattice, [3, -4, 5]), word(&lattice, [3 + 256, -4 - 512, 5 + 256]));
    }

    #[test]
    fn periods_hold_at_negative_and_extreme_cells() {
        let lattice = Periodic { lattice: HashLattice::new(1), period: [5, 0, 7, 1] };
        for cell in [i32::MIN, -11, -5, -1, 0, 4, 5, i32::MAX] {
            assert!((0..5).contains(&lattice.wrapped(0, cell)), "{cell}");
            assert_eq!(lattice.wrapped(1, cell), cell);
            assert_eq!(lattice.wrapped(3, cell), 0);
        }
        assert_eq!(lattice.wrapped(0, -1), 4);
    }
}

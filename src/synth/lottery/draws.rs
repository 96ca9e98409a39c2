//! Quantities drawn from a seed by their names: each is a hash of (seed, name), so that another one, added later, changes
//! none of those there were.

use super::super::hash::hash;

/// The draws of one seed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Draws {
    seed: u64,
}

impl Draws {
    pub(super) fn new(seed: u64) -> Self {
        Self { seed }
    }

    /// A number in [0, 1).
    pub(super) fn unit(self, name: &str) -> f64 {
        // FNV-1a over the name, mixed with the seed in either half.
        let of_name = name.bytes().fold(0xcbf2_9ce4_8422_2325, |state: u64, byte| {
            (state ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        let of_seed = (u64::from(hash(self.seed)) << 32) | u64::from(hash(self.seed ^ 0x6c6f_7474_6572_7921));
        f64::from(hash(of_name ^ of_seed)) / 4_294_967_296.0
    }

    /// A number between two, to the ten-thousandth, so that scene.toml is read easily.
    pub(super) fn between(self, name: &str, [low, high]: [f64; 2]) -> f64 {
        ((low + (high - low) * self.unit(name)) * 1e4).round() / 1e4
    }

    /// A whole number between two, both included.
    pub(super) fn whole(self, name: &str, [low, high]: [u32; 2]) -> u32 {
        low + (self.unit(name) * f64::from(high - low + 1)) as u32
    }

    /// A number about a middle, rarely far from it: the mean of three draws.
    pub(super) fn about(self, name: &str, [low, high]: [f64; 2]) -> f64 {
        let of = |part: &str| self.between(&format!("{name}/{part}"), [low, high]);
        ((of("a") + of("b") + of("c")) / 3.0 * 1e4).round() / 1e4
    }

    /// Whether something with this chance happens.
    pub(super) fn chance(self, name: &str, of: f64) -> bool {
        self.unit(name) < of
    }

    /// One of several, by their weights.
    pub(super) fn one_of<T: Copy>(self, name: &str, choices: &[(f64, T)]) -> Option<T> {
        let whole: f64 = choices.iter().map(|(weight, _)| weight).sum();
        let mut left = self.unit(name) * whole;
        let drawn = choices.iter().find(|(weight, _)| {
            left -= weight;
            left < 0.0
        });
        drawn.or(choices.last()).map(|(_, choice)| *choice)
    }

    /// One of several equals.
    pub(super) fn among<'a, T>(self, name: &str, choices: &'a [T]) -> Option<&'a T> {
        choices.get((self.unit(name) * choices.len() as f64) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_seeds_are_unlike_and_even() {
        let names: Vec<String> = (0..2000).map(|i| format!("quantity {i}")).collect();
        for seed in [0, 1, 2, 1 << 40] {
            let mean = names.iter().map(|name| Draws::new(seed).unit(name)).sum::<f64>() / names.len() as f64;
            assert!((mean - 0.5).abs() < 0.03, "{mean}");
        }
        let over_seeds = (0..2000).map(|seed| Draws::new(seed).unit("height"));
        assert!((over_seeds.sum::<f64>() / 2000.0 - 0.5).abs() < 0.03);
        assert_ne!(Draws::new(1).unit("a"), Draws::new(1).unit("b"));
        assert_eq!(Draws::new(1).unit("a"), Draws::new(1).unit("a"));
    }

    #[test]
    fn choices_come_as_often_as_their_weights_say() {
        let count =
            (0..4000).filter(|seed| Draws::new(*seed).one_of("x", &[(3.0, 'a'), (1.0, 'b')]) == Some('b')).count();
        assert!((850..1150).contains(&count), "{count}");
        assert_eq!(Draws::new(1).among::<u8>("none", &[]), None);
        assert_eq!(Draws::new(1).one_of::<u8>("none", &[]), None);
        let whole: Vec<u32> = (0..200).map(|seed| Draws::new(seed).whole("n", [2, 4])).collect();
        assert!(whole.iter().all(|n| (2..=4).contains(n)) && whole.contains(&2) && whole.contains(&4));
    }
}

//! Counted colours, and the densities that they make.

use crate::features::likelihood::{ColourBin, LOG_STEPS};

/// How often each colour was seen.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Colours {
    counts: Vec<f32>,
    total: f32,
}

impl Default for Colours {
    fn default() -> Self {
        Self { counts: vec![0.0; ColourBin::COUNT], total: 0.0 }
    }
}

/// Pixels from which on a class's own colours are believed more than those of the whole person.
const ENOUGH: f32 = 100.0;

impl Colours {
    pub(super) fn add(&mut self, colour: ColourBin) {
        self.counts[colour.index()] += 1.0;
        self.total += 1.0;
    }

    /// Counts what was seen so far `kept` times.
    pub(super) fn fade(&mut self, kept: f32) {
        self.counts.iter_mut().for_each(|count| *count *= kept);
        self.total *= kept;
    }

    pub(super) fn join(&mut self, other: &Self) {
        self.counts.iter_mut().zip(&other.counts).for_each(|(count, other)| *count += other);
        self.total += other.total;
    }

    pub(super) fn total(&self) -> f32 {
        self.total
    }

    /// How alike two sets of colours are, from 0 to 1: the sum of the geometric means of their shares (Bhattacharyya), smoothed.
    pub(super) fn likeness(&self, other: &Self) -> f32 {
        let [own, other] = [self, other].map(|colours| (colours.smoothed(), colours.total.max(1e-6)));
        own.0.iter().zip(&other.0).map(|(a, b)| (a / own.1 * (b / other.1)).sqrt()).sum()
    }

    /// The log density of every colour over the uniform one, of which `unknown` is mixed in; a class of which little was seen borrows from
    /// `whole`.
    pub(super) fn table(&self, unknown: f32, whole: Option<&Self>) -> LogTable {
        let borrowed = whole.map_or(0.0, |_| (ENOUGH / (ENOUGH + self.total)).powi(2));
        let mix = |own: Vec<f32>, whole: Option<Vec<f32>>| match whole {
            Some(whole) => {
                own.iter().zip(whole).map(|(own, whole)| (1.0 - borrowed) * own + borrowed * whole).collect()
            }
            None => own,
        };
        let logarithm = |density: f32| (density.ln() * LOG_STEPS).round() as i16;
        let density = |share: f32| (1.0 - unknown) * share * ColourBin::COUNT as f32 + unknown;
        let colours = mix(shares(self), whole.map(shares));
        let greys = mix(luma_shares(self), whole.map(luma_shares));
        let grey = |share: f32| (1.0 - unknown) * share * ColourBin::SIDE as f32 + unknown;
        let greys: Vec<i16> = greys.into_iter().map(|share| logarithm(grey(share))).collect();
        LogTable {
            colours: colours.into_iter().map(|share| logarithm(density(share))).collect(),
            greys: ColourBin::all().map(|colour| greys[colour.luma()]).collect(),
        }
    }

    /// Spread by 1 2 1 along each channel, sum unchanged.
    fn smoothed(&self) -> Vec<f32> {
        let mut from = self.counts.clone();
        let mut to = from.clone();
        for stride in [1, ColourBin::SIDE, ColourBin::SIDE * ColourBin::SIDE] {
            for (at, sum) in to.iter_mut().enumerate() {
                let place = at / stride % ColourBin::SIDE;
                let before = if place == 0 { at } else { at - stride };
                let after = if place == ColourBin::SIDE - 1 { at } else { at + stride };
                *sum = 0.25 * (from[before] + 2.0 * from[at] + from[after]);
            }
            std::mem::swap(&mut from, &mut to);
        }
        from
    }
}

/// Shares of colours; uniform where nothing was seen.
fn shares(colours: &Colours) -> Vec<f32> {
    if colours.total < 1.0 {
        return vec![1.0 / ColourBin::COUNT as f32; ColourBin::COUNT];
    }
    let mut shares = colours.smoothed();
    shares.iter_mut().for_each(|share| *share /= colours.total);
    shares
}

/// Shares of the steps of luma, spread by 1 2 1; uniform where nothing was seen.
fn luma_shares(colours: &Colours) -> Vec<f32> {
    if colours.total < 1.0 {
        return vec![1.0 / ColourBin::SIDE as f32; ColourBin::SIDE];
    }
    let mut sums = [0.0; ColourBin::SIDE];
    ColourBin::all().zip(&colours.counts).for_each(|(colour, count)| sums[colour.luma()] += count);
    let spread = |at: usize| sums[at.saturating_sub(1)] + 2.0 * sums[at] + sums[(at + 1).min(ColourBin::SIDE - 1)];
    (0..ColourBin::SIDE).map(|at| 0.25 * spread(at) / colours.total).collect()
}

/// The log density of every colour over the uniform one, in steps of 1/[`LOG_STEPS`]; and for cameras that see in grey, of its luma.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LogTable {
    colours: Vec<i16>,
    greys: Vec<i16>,
}

impl LogTable {
    /// Every colour alike.
    pub(super) fn uniform() -> Self {
        Self { colours: vec![0; ColourBin::COUNT], greys: vec![0; ColourBin::COUNT] }
    }

    /// The values by a colour's index, for a camera that sees in grey or one that does not.
    #[inline]
    pub(super) fn values(&self, is_grey: bool) -> &[i16] {
        if is_grey { &self.greys } else { &self.colours }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn densities_sum_to_one() {
        let mut colours = Colours::default();
        for at in 0..500_u32 {
            colours.add(ColourBin::of([(at % 256) as u8, 7, (at * 31 % 256) as u8]));
        }
        let table = colours.table(0.15, None);
        let sum: f64 = table.values(false).iter().map(|&log| f64::from(log) / 64.0).map(f64::exp).sum();
        assert!((sum / ColourBin::COUNT as f64 - 1.0).abs() < 0.01, "{sum}");
        let of = |is_grey: bool, colour: [u8; 3]| table.values(is_grey)[ColourBin::of(colour).index()];
        assert!(of(false, [0, 7, 0]) > 0 && of(false, [255; 3]) < 0);
        // Whatever the colour, a grey camera has seen as much of its luma.
        let greys: f64 = (0..16_u8).map(|step| (f64::from(of(true, [16 * step; 3])) / 64.0).exp()).sum();
        assert!((greys / 16.0 - 1.0).abs() < 0.02 && of(true, [255; 3]) < 0 && of(true, [40; 3]) > 0, "{greys}");
        assert_eq!(Colours::default().table(0.35, None), LogTable::uniform());
    }

    #[test]
    fn likeness_is_one_of_the_same_and_small_of_others() {
        let (mut red, mut blue) = (Colours::default(), Colours::default());
        for _ in 0..50 {
            red.add(ColourBin::of([200, 20, 20]));
            blue.add(ColourBin::of([20, 20, 200]));
        }
        assert!((red.likeness(&red) - 1.0).abs() < 1e-3 && red.likeness(&blue) < 0.01);
        let mut both = red.clone();
        both.join(&blue);
        assert!((0.6..0.8).contains(&red.likeness(&both)), "{}", red.likeness(&both));
        both.fade(0.5);
        assert_eq!(both.total(), 50.0);
    }
}

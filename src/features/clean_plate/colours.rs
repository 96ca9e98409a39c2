//! The colours of one pixel over time, and which of them is there most.

/// Colours no farther than this from each other, grey levels in RGB, are one colour with a camera's noise.
const RADIUS: i32 = 24;
/// A rival is at least this far away.
const APART: i32 = 45;
/// Colours that are tried as the middle of the most frequent one.
const TRIED: usize = 24;

/// The colours of a pixel, a plane a channel, and which count.
pub(super) struct Colours {
    planes: [Vec<i16>; 3],
    counts: Vec<bool>,
    members: Vec<usize>,
    around: Vec<i16>,
}

impl Colours {
    /// Room for so many.
    pub(super) fn new(capacity: usize) -> Self {
        let plane = || Vec::with_capacity(capacity);
        Self {
            planes: [plane(), plane(), plane()],
            counts: Vec::with_capacity(capacity),
            members: Vec::with_capacity(capacity),
            around: plane(),
        }
    }

    /// Takes a pixel's colours, each with whether it counts.
    pub(super) fn take(&mut self, colours: impl Iterator<Item = ([i16; 3], bool)>) {
        self.planes.iter_mut().for_each(Vec::clear);
        self.counts.clear();
        for (colour, counts) in colours {
            self.planes.iter_mut().zip(colour).for_each(|(plane, value)| plane.push(value));
            self.counts.push(counts);
        }
    }

    /// The colour that is there most often, and how often. Where fewer than `least` colours count, all do, and none is said to
    /// have been seen.
    pub(super) fn dominant(&mut self, least: usize) -> ([u8; 3], usize) {
        let counting = self.counts.iter().filter(|counts| **counts).count();
        let is_seen = counting >= least.max(1);
        if !is_seen {
            self.counts.fill(true);
        }
        let mut centre = self.densest(if is_seen { counting } else { self.counts.len() });
        centre = self.median_around(centre);
        let seen = if is_seen { self.near(centre, RADIUS) } else { 0 };
        (centre.map(|value| value.clamp(0, 255) as u8), seen)
    }

    /// How often the most frequent colour is there that is another than `colour`, of all that there are.
    pub(super) fn rival(&mut self, colour: [u8; 3]) -> usize {
        let centre = colour.map(i16::from);
        let mut others = 0;
        for at in 0..self.counts.len() {
            self.counts[at] = self.distance(at, centre) >= APART * APART;
            others += usize::from(self.counts[at]);
        }
        if others == 0 {
            return 0;
        }
        let densest = self.densest(others);
        let centre = self.median_around(densest);
        self.near(centre, RADIUS)
    }

    fn distance(&self, at: usize, centre: [i16; 3]) -> i32 {
        let off = |channel: usize| i32::from(self.planes[channel][at] - centre[channel]);
        off(0) * off(0) + off(1) * off(1) + off(2) * off(2)
    }

    /// How many that count lie within `radius`.
    fn near(&self, centre: [i16; 3], radius: i32) -> usize {
        let [r, g, b] = &self.planes;
        let mut near = 0;
        for (((&r, &g), &b), &counts) in r.iter().zip(g).zip(b).zip(&self.counts) {
            let [r, g, b] = [r - centre[0], g - centre[1], b - centre[2]].map(i32::from);
            near += i32::from(counts & (r * r + g * g + b * b <= radius * radius));
        }
        near as usize
    }

    /// Of some colours that count, of which there are `counting`, the one with most others round it.
    fn densest(&self, counting: usize) -> [i16; 3] {
        let every = counting.div_ceil(TRIED).max(1);
        let mut best = ([0; 3], 0);
        for at in (0..self.counts.len()).filter(|&at| self.counts[at]).step_by(every) {
            let centre = [0, 1, 2].map(|channel: usize| self.planes[channel][at]);
            let near = self.near(centre, RADIUS);
            if near > best.1 {
                best = (centre, near);
            }
            // No other colour can be there more often.
            if 2 * near > counting {
                break;
            }
        }
        best.0
    }

    /// The median, channel by channel, of what lies round a colour: a shadow that passes hardly moves it.
    fn median_around(&mut self, centre: [i16; 3]) -> [i16; 3] {
        let mut median = centre;
        self.members.clear();
        for at in 0..self.counts.len() {
            if self.counts[at] && self.distance(at, centre) <= RADIUS * RADIUS {
                self.members.push(at);
            }
        }
        for (channel, median) in median.iter_mut().enumerate() {
            self.around.clear();
            self.around.extend(self.members.iter().map(|&at| self.planes[channel][at]));
            let middle = self.around.len() / 2;
            if !self.around.is_empty() {
                *median = *self.around.select_nth_unstable(middle).1;
            }
        }
        median
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(colours: &[([i16; 3], bool)]) -> Colours {
        let mut taken = Colours::new(colours.len());
        taken.take(colours.iter().copied());
        taken
    }

    #[test]
    fn the_most_frequent_colour_is_no_mixture_of_two_as_bright() {
        // Red and green of one brightness; a brightness alone would lead to their mean.
        let mut colours = vec![([180, 60, 60], true); 5];
        colours.extend([([40, 130, 60], true); 4]);
        colours.extend([([185, 62, 58], true); 2]);
        let mut colours = of(&colours);
        assert_eq!(colours.dominant(1), ([180, 60, 60], 7));
        assert_eq!(colours.rival([180, 60, 60]), 4);
    }

    #[test]
    fn what_does_not_count_is_left_out_and_too_little_is_not_seen() {
        let mut colours: Vec<_> = (0..20).map(|at| ([200, 20, 20], at == 0)).collect();
        colours.extend([([90, 90, 90], true); 6]);
        assert_eq!(of(&colours).dominant(3), ([90, 90, 90], 6));
        assert_eq!(of(&colours).dominant(10), ([200, 20, 20], 0));
        assert_eq!(of(&[]).dominant(1), ([0; 3], 0));
    }
}

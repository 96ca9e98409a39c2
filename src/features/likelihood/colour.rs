//! Colours in coarse steps.

/// A colour in 16 steps a channel, as one number below [`Self::COUNT`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ColourBin(u16);

impl ColourBin {
    /// Steps a channel.
    pub const SIDE: usize = 16;
    /// How many there are.
    pub const COUNT: usize = Self::SIDE * Self::SIDE * Self::SIDE;

    /// The bin of a pixel.
    #[inline]
    pub fn of([r, g, b]: [u8; 3]) -> Self {
        Self(u16::from(r >> 4) << 8 | u16::from(g >> 4) << 4 | u16::from(b >> 4))
    }

    /// The step of its luma among [`Self::SIDE`].
    pub fn luma(self) -> usize {
        let [r, g, b] = [self.0 >> 8, self.0 >> 4 & 15, self.0 & 15].map(usize::from);
        (299 * r + 587 * g + 114 * b + 500) / 1000
    }

    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..Self::COUNT as u16).map(Self)
    }

    /// Its place in a table of [`Self::COUNT`] values, in which blue changes fastest.
    #[inline]
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// The bins of pixels of three bytes, compiled for the wider vectors too.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub(super) fn find_bins(rgb: &[u8], bins: &mut Vec<ColourBin>) {
    bins.clear();
    bins.extend(rgb.as_chunks::<3>().0.iter().map(|&pixel| ColourBin::of(pixel)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_are_sixteen_a_channel() {
        assert_eq!(ColourBin::of([255; 3]).index(), ColourBin::COUNT - 1);
        assert_eq!(ColourBin::of([15, 15, 15]).index(), 0);
        assert_eq!(ColourBin::of([16, 0, 0]).index(), 256);
        assert_eq!(ColourBin::of([0, 32, 48]).index(), 2 * 16 + 3);
        let pixels: Vec<u8> = (0..3 * 301).map(|at| (at * 37 % 256) as u8).collect();
        let mut bins = vec![ColourBin(9); 5];
        find_bins(&pixels, &mut bins);
        assert_eq!(bins, pixels.chunks(3).map(|p| ColourBin::of([p[0], p[1], p[2]])).collect::<Vec<_>>());
        assert_eq!([[0; 3], [100; 3], [255; 3], [0, 255, 0]].map(|pixel| ColourBin::of(pixel).luma()), [0, 6, 15, 9]);
        assert!(ColourBin::all().enumerate().all(|(at, bin)| bin.index() == at));
    }
}

//! The region of interest: where in a picture the person is, with room for the motion of one frame (METHOD A5.6).

/// A half-open rectangle of pixels: columns `x0..x1`, rows `y0..y1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Region {
    /// First column.
    pub x0: u32,
    /// First row.
    pub y0: u32,
    /// One past the last column.
    pub x1: u32,
    /// One past the last row.
    pub y1: u32,
}

impl Region {
    /// A whole picture.
    pub fn whole(width: u32, height: u32) -> Self {
        Self { x0: 0, y0: 0, x1: width, y1: height }
    }

    /// The region with `margin` pixels more on every side, cut at the borders of a `width` × `height` picture.
    pub fn enlarged(self, margin: u32, width: u32, height: u32) -> Self {
        Self {
            x0: self.x0.saturating_sub(margin),
            y0: self.y0.saturating_sub(margin),
            x1: self.x1.saturating_add(margin).min(width),
            y1: self.y1.saturating_add(margin).min(height),
        }
    }

    /// Width, pixels.
    pub fn width(self) -> u32 {
        self.x1.saturating_sub(self.x0)
    }

    /// Height, pixels.
    pub fn height(self) -> u32 {
        self.y1.saturating_sub(self.y0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enlarging_stops_at_the_borders() {
        let region = Region { x0: 5, y0: 2, x1: 10, y1: 20 };
        assert_eq!(region.enlarged(4, 100, 22), Region { x0: 1, y0: 0, x1: 14, y1: 22 });
        assert_eq!(region.enlarged(u32::MAX, 100, 22), Region::whole(100, 22));
        assert_eq!((region.width(), region.height()), (5, 18));
    }
}

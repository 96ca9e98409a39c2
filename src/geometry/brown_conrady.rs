//! The Brown-Conrady lens of OpenCV, Pose2Sim, anipose and Qualisys files (METHOD A2).

use glam::{DMat2, DVec2};

/// Intrinsics of the Brown-Conrady model: pixels from the distorted normalised coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrownConrady {
    /// Focal lengths, pixels.
    pub focal: DVec2,
    /// Principal point, pixels.
    pub centre: DVec2,
    /// Radial coefficients k1 k2 k3.
    pub radial: [f64; 3],
    /// Tangential coefficients p1 p2.
    pub tangential: [f64; 2],
}

impl BrownConrady {
    /// The squared undistorted radius (normalised coordinates) where r (1 + k1 r^2 + k2 r^4 + k3 r^6) stops being
    /// monotone; infinity where it never does. A point beyond has no image. A coefficient that is not a number leaves
    /// no radius at all: 0.
    pub fn max_radius_squared(&self) -> f64 {
        let [k1, k2, k3] = self.radial;
        if !self.radial.iter().all(|k| k.is_finite()) {
            return 0.0;
        }
        // The slope over t = r^2, and where it turns: between its turning points it is monotone, so the first of them
        // (or the end) where it is not positive has the smallest root just before it.
        let [a, b, c] = [3.0 * k1, 5.0 * k2, 7.0 * k3];
        let slope = |t: f64| 1.0 + t * (a + t * (b + t * c));
        let mut turns = turning_points(a, b, c);
        turns.sort_by(f64::total_cmp);
        let mut low = 0.0;
        for turn in turns {
            if turn > low && turn.is_finite() {
                if slope(turn) < 0.0 {
                    return sign_change(slope, low, turn);
                }
                low = turn;
            }
        }
        // Past the last turning point the slope only falls if its leading coefficient is negative.
        let leading = [c, b, a].into_iter().find(|&k| k != 0.0);
        if leading.is_none_or(|k| k > 0.0) {
            return f64::INFINITY;
        }
        let mut high = if low > 0.0 { 2.0 * low } else { 1.0 };
        while slope(high) >= 0.0 {
            low = high;
            high *= 2.0;
            if !high.is_finite() {
                return f64::INFINITY;
            }
        }
        sign_change(slope, low, high)
    }

    /// Normalised undistorted coordinates (x/z, y/z) to normalised distorted ones. None past
    /// [`Self::max_radius_squared`] and for what is not a number.
    pub fn distort(&self, undistorted: DVec2) -> Option<DVec2> {
        // Written so that a NaN fails all tests.
        let squared = undistorted.length_squared();
        let on_branch = self.rises_up_to(squared) || squared <= self.max_radius_squared();
        let distorted = self.map(undistorted);
        (on_branch && distorted.is_finite()).then_some(distorted)
    }

    /// The inverse of [`Self::distort`], by Newton's method with step halving to some 1e-14. None where no point of the
    /// branch has that image.
    pub fn undistort(&self, distorted: DVec2) -> Option<DVec2> {
        if !distorted.is_finite() {
            return None;
        }
        let limit = self.max_radius_squared();
        let scale = distorted.length();
        let mut guess = self.radial_inverse(distorted, limit);
        let mut residual = self.map(guess) - distorted;
        for _ in 0..100 {
            if residual.length() <= 1e-15 * scale {
                break;
            }
            let step = self.jacobian(guess).inverse() * residual;
            if !step.is_finite() {
                break;
            }
            let halved = (0..40).map(|halvings| guess - step * 0.5_f64.powi(halvings)).find_map(|next| {
                let next_residual = self.map(next) - distorted;
                (next_residual.length() < residual.length()).then_some((next, next_residual))
            });
            let Some(better) = halved else { break };
            (guess, residual) = better;
        }
        // A point on the branch's very end may land a rounding past it.
        let on_branch = guess.length_squared() <= limit * (1.0 + 1e-9);
        (on_branch && residual.length() <= 1e-10 * (scale + 1e-3)).then_some(guess)
    }

    /// Normalised distorted coordinates to pixels.
    pub fn to_pixel(&self, distorted: DVec2) -> DVec2 {
        self.focal * distorted + self.centre
    }

    /// Pixels to normalised distorted coordinates.
    pub fn from_pixel(&self, pixel: DVec2) -> DVec2 {
        (pixel - self.centre) / self.focal
    }

    /// Whether the slope is surely positive up to a squared radius: by the coefficients' sizes alone, which nearly every point of a
    /// picture passes and which costs a hundredth of [`Self::max_radius_squared`].
    fn rises_up_to(&self, squared: f64) -> bool {
        let [a, b, c] = [3.0 * self.radial[0].abs(), 5.0 * self.radial[1].abs(), 7.0 * self.radial[2].abs()];
        squared * (a + squared * (b + squared * c)) < 0.999
    }

    fn map(&self, at: DVec2) -> DVec2 {
        let [k1, k2, k3] = self.radial;
        let [p1, p2] = self.tangential;
        let r2 = at.length_squared();
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        let xy2 = 2.0 * at.x * at.y;
        DVec2::new(
            at.x * radial + p1 * xy2 + p2 * (r2 + 2.0 * at.x * at.x),
            at.y * radial + p1 * (r2 + 2.0 * at.y * at.y) + p2 * xy2,
        )
    }

    /// The derivative of [`Self::map`].
    fn jacobian(&self, at: DVec2) -> DMat2 {
        let [k1, k2, k3] = self.radial;
        let [p1, p2] = self.tangential;
        let r2 = at.length_squared();
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        // Twice the derivative of the radial factor by r^2.
        let bend = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3));
        let cross = at.x * at.y * bend + 2.0 * (p1 * at.x + p2 * at.y);
        DMat2::from_cols(
            DVec2::new(radial + at.x * at.x * bend + 2.0 * p1 * at.y + 6.0 * p2 * at.x, cross),
            DVec2::new(cross, radial + at.y * at.y * bend + 6.0 * p1 * at.y + 2.0 * p2 * at.x),
        )
    }

    /// Where the radial part alone would have that image to some 1e-12, or the end of the branch: Newton's method in two dimensions starts
    /// there.
    fn radial_inverse(&self, distorted: DVec2, limit: f64) -> DVec2 {
        let wanted = distorted.length();
        if wanted == 0.0 {
            return DVec2::ZERO;
        }
        let [k1, k2, k3] = self.radial;
        let image = |r: f64| r * (1.0 + r * r * (k1 + r * r * (k2 + r * r * k3)));
        let slope = |r: f64| 1.0 + r * r * (3.0 * k1 + r * r * (5.0 * k2 + r * r * 7.0 * k3));
        let (mut low, mut high) = (0.0, limit.sqrt());
        if high.is_infinite() {
            high = wanted.max(1.0);
            while image(high) < wanted && high < 1e100 {
                high *= 2.0;
            }
        }
        // The image rises between the two, so a step that leads out of them is replaced by their middle.
        let mut at = if wanted < high { wanted } else { 0.5 * (low + high) };
        for _ in 0..60 {
            let missing = wanted - image(at);
            if missing > 0.0 {
                low = at
            } else {
                high = at
            }
            let next = at + missing / slope(at);
            if (next - at).abs() <= 1e-12 * at {
                return distorted * (next / wanted);
            }
            at = if low < next && next < high { next } else { 0.5 * (low + high) };
        }
        distorted * (high / wanted)
    }
}

/// Where 1 + a t + b t^2 + c t^3 turns; NaN or infinite for a turning point that there is not.
fn turning_points(a: f64, b: f64, c: f64) -> [f64; 2] {
    if c == 0.0 {
        return [-a / (2.0 * b), f64::NAN];
    }
    // The form without cancellation; a negative discriminant has the root NaN.
    let q = -(b + (b * b - 3.0 * a * c).sqrt().copysign(b));
    [q / (3.0 * c), a / q]
}

/// Where a function that is not negative at `low` and negative at `high` changes its sign, to the last bit.
fn sign_change(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return low;
        }
        if f(middle) >= 0.0 { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn lens(radial: [f64; 3], tangential: [f64; 2]) -> BrownConrady {
        BrownConrady { focal: DVec2::new(1200.0, 1190.0), centre: DVec2::new(320.0, 240.0), radial, tangential }
    }

    #[test]
    fn the_branch_ends_at_the_smallest_root() {
        // 1 - 0.9 t: k1 = -0.3.
        assert!((lens([-0.3, 0.0, 0.0], [0.0; 2]).max_radius_squared() - 1.0 / 0.9).abs() < 1e-15);
        // (1 - t)(1 - t/2)(1 - t/4) has its smallest root at 1.
        let [a, b, c] = [-1.75, 0.875, -0.125];
        let end = lens([a / 3.0, b / 5.0, c / 7.0], [0.0; 2]).max_radius_squared();
        assert!((end - 1.0).abs() < 1e-14, "{end}");
        // (1 - t)(1 - t/1.0001): two roots a step of 0.01 would jump over.
        let end = lens([(-1.0 - 1.0 / 1.0001) / 3.0, 1.0 / 1.0001 / 5.0, 0.0], [0.0; 2]).max_radius_squared();
        assert!((end - 1.0).abs() < 1e-9, "{end}");
        // A root beyond any search window, one very near, and none.
        assert!((lens([-1e-6, 0.0, 0.0], [0.0; 2]).max_radius_squared() * 3e-6 - 1.0).abs() < 1e-12);
        assert!((lens([0.0, 0.0, -1e12], [0.0; 2]).max_radius_squared() - (1.0 / 7e12_f64).cbrt()).abs() < 1e-15);
        assert_eq!(lens([0.1, 0.0, 0.0], [0.0; 2]).max_radius_squared(), f64::INFINITY);
        assert_eq!(lens([0.0; 3], [0.0; 2]).max_radius_squared(), f64::INFINITY);
        assert_eq!(lens([-0.05, 0.14, 0.0], [0.0; 2]).max_radius_squared(), f64::INFINITY);
        assert_eq!(lens([f64::NAN, 0.0, 0.0], [0.0; 2]).max_radius_squared(), 0.0);
    }

    proptest! {
        #[test]
        fn the_slope_is_positive_before_the_end_and_zero_there(k in prop::array::uniform3(-2.0..2.0_f64)) {
            let slope = |t: f64| 1.0 + t * (3.0 * k[0] + t * (5.0 * k[1] + t * 7.0 * k[2]));
            let end = lens(k, [0.0; 2]).max_radius_squared();
            let reach = end.min(1e4);
            for step in 0..1000 {
                prop_assert!(slope(reach * f64::from(step) / 1000.0) >= 0.0, "{end}");
                let squared = f64::from(step) / 100.0;
                prop_assert!(squared <= end || !lens(k, [0.0; 2]).rises_up_to(squared), "{squared} {end}");
            }
            if end.is_finite() {
                prop_assert!(slope(end).abs() < 1e-9 * (1.0 + end.powi(3)), "{end} {}", slope(end));
            }
        }

        #[test]
        fn the_jacobian_is_the_finite_difference(
            k in prop::array::uniform3(-0.5..0.5_f64), p in prop::array::uniform2(-0.01..0.01_f64),
            x in -1.0..1.0_f64, y in -1.0..1.0_f64,
        ) {
            let (lens, at, h) = (lens(k, p), DVec2::new(x, y), 1e-6);
            let jacobian = lens.jacobian(at);
            for (axis, column) in [(DVec2::X, jacobian.x_axis), (DVec2::Y, jacobian.y_axis)] {
                let difference = (lens.map(at + axis * h) - lens.map(at - axis * h)) / (2.0 * h);
                prop_assert!((difference - column).length() < 1e-8, "{difference} {column}");
            }
        }
    }
}

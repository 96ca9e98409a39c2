//! Durations counted in buckets of equal ratio: quantiles of any number of them in constant memory.

use std::time::Duration;

/// Ratio of the borders of a bucket: a quantile is known to half a per cent.
const BUCKET: f64 = 1.01;
/// Buckets from a nanosecond to over a day.
const BUCKETS: usize = 3300;

/// Durations by how long they are; in ms towards the outside.
#[derive(Clone, Debug)]
pub(super) struct Histogram {
    count: u64,
    total: Duration,
    min: Duration,
    max: Duration,
    buckets: Vec<u64>,
}

impl Default for Histogram {
    fn default() -> Self {
        Self { count: 0, total: Duration::ZERO, min: Duration::MAX, max: Duration::ZERO, buckets: vec![0; BUCKETS] }
    }
}

impl Histogram {
    /// One more.
    pub(super) fn add(&mut self, time: Duration) {
        self.count += 1;
        self.total += time;
        self.min = self.min.min(time);
        self.max = self.max.max(time);
        let bucket = (time.as_nanos().max(1) as f64).ln() / BUCKET.ln();
        self.buckets[(bucket as usize).min(BUCKETS - 1)] += 1;
    }

    /// How many there are.
    pub(super) fn count(&self) -> u64 {
        self.count
    }

    /// Their sum, ms.
    pub(super) fn total(&self) -> f64 {
        ms(self.total)
    }

    /// The duration that a share of `share` does not exceed, ms; 0 where there is none.
    pub(super) fn quantile(&self, share: f64) -> f64 {
        if self.count == 0 {
            return 0.0;
        }
        let (min, max) = (ms(self.min), ms(self.max));
        let wanted = share * self.count as f64;
        if wanted <= 0.0 {
            return min;
        }
        if share >= 1.0 {
            return max;
        }
        let mut seen = 0;
        let bucket = self.buckets.iter().position(|count| {
            seen += count;
            seen as f64 >= wanted
        });
        (BUCKET.powf(bucket.unwrap_or(0) as f64 + 0.5) * 1e-6).clamp(min, max)
    }
}

fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_right_to_a_per_cent() {
        let mut histogram = Histogram::default();
        assert_eq!((histogram.quantile(0.5), histogram.count()), (0.0, 0));
        (1..=1000).rev().for_each(|ms| histogram.add(Duration::from_millis(ms)));
        assert_eq!((histogram.quantile(0.0), histogram.quantile(1.0), histogram.total()), (1.0, 1000.0, 500_500.0));
        for (share, expected) in [(0.5, 500.0), (0.9, 900.0), (0.99, 990.0)] {
            let found = histogram.quantile(share);
            assert!((found / expected - 1.0).abs() < 0.01, "{found} instead of {expected}");
        }
    }
}

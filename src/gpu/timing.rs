//! How long passes took, by name, and when, on the host's clock.

use std::time::{Duration, Instant};

use super::work::Work;

/// A moment on the device's clock and on the host's.
#[derive(Clone, Copy, Debug)]
pub struct ClockPair {
    /// Device time, nanoseconds from an arbitrary start.
    pub device_ns: f64,
    /// The same moment on the host.
    pub host: Instant,
}

/// The bits of a timestamp that count.
pub(super) fn tick_mask(bits: u32) -> u64 {
    if bits >= 64 { u64::MAX } else { (1 << bits) - 1 }
}

/// Ticks of a clock of so many bits, without the places where it began anew: each counted on from the first, less than half of the
/// clock's range away from it.
pub(super) fn unwrapped(ticks: &[u64], bits: u32) -> Vec<f64> {
    let mask = tick_mask(bits);
    let first = ticks.first().copied().unwrap_or_default() & mask;
    let of = |tick: u64| {
        let on = (tick & mask).wrapping_sub(first) & mask;
        let back = first.wrapping_sub(tick & mask) & mask;
        if on <= back { first as f64 + on as f64 } else { first as f64 - back as f64 }
    };
    ticks.iter().map(|&tick| of(tick)).collect()
}

/// What a recording measures of its passes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Timing {
    /// Nothing.
    #[default]
    Off,
    /// Start and end of every pass, where the device has timestamps.
    Stamps,
    /// That, and how many invocations and primitives it ran, where the device counts them.
    Statistics,
}

/// One pass of a finished recording.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTiming {
    /// The name it was recorded under.
    pub name: String,
    /// When it began, nanoseconds on the device's clock ([`super::Device::clock`]).
    pub start_ns: f64,
    /// When it ended.
    pub end_ns: f64,
    /// What it ran.
    pub statistics: Option<PassStatistics>,
    /// What its stages did, on a device that counts it ([`super::Inspect::Work`]).
    pub work: Option<Work>,
}

impl PassTiming {
    /// How long it took, milliseconds.
    pub fn ms(&self) -> f64 {
        (self.end_ns - self.start_ns) * 1e-6
    }
}

/// Counts of a pass, of the stages it had.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PassStatistics {
    /// Vertex stage invocations.
    pub vertices: u64,
    /// Primitives that reached the rasteriser.
    pub primitives: u64,
    /// Fragment stage invocations.
    pub fragments: u64,
    /// Compute stage invocations.
    pub compute: u64,
}

/// Sums the times of passes by name, in the order of their first appearance: name, milliseconds, how often.
pub fn by_name(timings: &[PassTiming]) -> Vec<(String, f64, usize)> {
    let mut sums: Vec<(String, f64, usize)> = Vec::new();
    for timing in timings {
        match sums.iter_mut().find(|(name, ..)| *name == timing.name) {
            Some((_, ms, count)) => {
                *ms += timing.ms();
                *count += 1;
            }
            None => sums.push((timing.name.clone(), timing.ms(), 1)),
        }
    }
    sums
}

/// A pass on the host's time axis.
#[derive(Clone, Debug, PartialEq)]
pub struct DevicePass {
    /// The name it was recorded under.
    pub name: String,
    /// When it began.
    pub start: Instant,
    /// How long it took.
    pub duration: Duration,
    /// What it ran.
    pub statistics: Option<PassStatistics>,
    /// What its stages did, on a device that counts it ([`super::Inspect::Work`]).
    pub work: Option<Work>,
}

/// Brings the passes of a submission to the host's clock, by a pair of moments on both clocks where there is one. Without, and
/// where that would have the device end later than `end`, when the host had waited for it, the last pass ends at `end`. The device's
/// clock begins anew after `range_ns`.
pub(super) fn on_host_clock(
    timings: &[PassTiming],
    clock: Option<ClockPair>,
    range_ns: f64,
    end: Instant,
) -> Vec<DevicePass> {
    let last_ns = timings.iter().map(|timing| timing.end_ns).fold(f64::NEG_INFINITY, f64::max);
    let before_end = |ns: f64| end.checked_sub(Duration::from_nanos(ns.max(0.0) as u64)).unwrap_or(end);
    // How long before `end` the last pass ended, by the clocks.
    let slack_ns = clock.map_or(0.0, |clock| {
        let end_ns = if end >= clock.host {
            clock.device_ns + end.duration_since(clock.host).as_nanos() as f64
        } else {
            clock.device_ns - clock.host.duration_since(end).as_nanos() as f64
        };
        let slack = end_ns - last_ns;
        let slack = slack - range_ns * (slack / range_ns).round();
        slack.max(0.0)
    });
    timings
        .iter()
        .map(|timing| DevicePass {
            name: timing.name.clone(),
            start: before_end(last_ns - timing.start_ns + slack_ns),
            duration: Duration::from_nanos((timing.end_ns - timing.start_ns).max(0.0) as u64),
            statistics: timing.statistics,
            work: timing.work,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timing(start_ns: f64, end_ns: f64) -> PassTiming {
        PassTiming { name: "pass".into(), start_ns, end_ns, statistics: None, work: None }
    }

    #[test]
    fn passes_come_to_the_host_clock() {
        let origin = Instant::now() + Duration::from_secs(10);
        let at = |us: u64| origin + Duration::from_micros(us);
        let timings = [timing(5_000_000.0, 5_010_000.0), timing(5_010_000.0, 5_040_000.0)];
        let starts =
            |clock, end| on_host_clock(&timings, clock, 1e12, end).iter().map(|pass| pass.start).collect::<Vec<_>>();
        assert_eq!(starts(None, at(100)), [at(60), at(70)], "the last pass ends at the end");
        // Device time 5_000_000 ns is the host's 20 us, whichever moment the pair was taken at.
        let pair = |us: u64, device_ns| Some(ClockPair { device_ns, host: at(us) });
        assert_eq!(starts(pair(20, 5_000_000.0), at(100)), [at(20), at(30)]);
        assert_eq!(starts(pair(520, 5_500_000.0), at(100)), [at(20), at(30)]);
        // A clock by which the device would end after the host has seen it end is wrong.
        assert_eq!(starts(pair(90, 5_000_000.0), at(100)), [at(60), at(70)]);
        let passes = on_host_clock(&[timing(7.0, 5.0)], None, 1e12, at(1));
        assert_eq!((passes[0].duration, passes[0].start <= at(1)), (Duration::ZERO, true));
        assert!(on_host_clock(&[], None, 1e12, at(1)).is_empty());
        // A clock of 10 ms: it began anew between the pair and the passes, or between these and the pair.
        let starts = |device_ns| on_host_clock(&timings, pair(20, device_ns), 1e7, at(100))[0].start;
        assert_eq!([starts(15_000_000.0), starts(-5_000_000.0)], [at(20); 2]);
    }

    #[test]
    fn ticks_go_on_where_their_clock_begins_anew() {
        assert_eq!(unwrapped(&[0xf0, 0xff, 0x05], 8), [240.0, 255.0, 261.0]);
        assert_eq!(unwrapped(&[0xab_0002, 0xcd_00fe], 8), [2.0, -2.0], "bits above are noise; a little back is back");
        assert_eq!(unwrapped(&[u64::MAX, 1], 64), [u64::MAX as f64, u64::MAX as f64 + 2.0]);
        assert!(unwrapped(&[], 36).is_empty());
        assert_eq!(tick_mask(36), 0xf_ffff_ffff);
    }
}

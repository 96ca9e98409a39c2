//! How long passes took, by name.

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

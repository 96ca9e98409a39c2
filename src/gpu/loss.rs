//! The errors of a device that callers act upon: fall back to the processor, or split the work.

use std::fmt;
use std::time::Duration;

/// The device is gone: a crash of its driver, a reset, its removal, or a pass without end. Nothing more can be run on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceLost {
    /// Name of the device.
    pub device: String,
    /// The last pass that had begun, where a breadcrumb tells.
    pub pass: Option<String>,
    /// How long it had not got on, where it was given up and not known to be gone.
    pub given_up_after: Option<Duration>,
}

impl fmt::Display for DeviceLost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { device, pass, given_up_after } = self;
        match given_up_after {
            Some(after) => write!(f, "the device {device} was given up after {after:?} at work")?,
            None => write!(f, "the device {device} was lost")?,
        }
        match pass {
            Some(pass) => write!(f, " in pass {pass}"),
            None => write!(f, " in a pass that no breadcrumb names (PANTIN_BREADCRUMBS=1 leaves them)"),
        }
    }
}

impl std::error::Error for DeviceLost {}

/// A resource does not fit: smaller batches may.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutOfMemory {
    /// Name of the resource.
    pub resource: String,
    /// Bytes asked for.
    pub asked: u64,
    /// Bytes that would have fitted.
    pub available: u64,
}

impl fmt::Display for OutOfMemory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} needs {:.1} MiB of device memory, {:.1} MiB would fit",
            self.resource,
            self.asked as f64 / 1_048_576.0,
            self.available as f64 / 1_048_576.0
        )
    }
}

impl std::error::Error for OutOfMemory {}

//! Who makes the features of a run: the processor, or the device that searches.

use anyhow::{Result, bail};

use super::{Backend, FeaturesOn, TrackSettings};
use crate::evaluate::Evaluator;
use crate::features::FeatureSettings;
use crate::gpu::{Device, DeviceKind};

/// Who makes them, and what the user should know about that.
pub(super) struct FeaturesMade {
    /// The device that makes and holds them; the processor without.
    pub(super) device: Option<Device>,
    /// A clause, for those who chose a backend on a device.
    pub(super) note: Option<String>,
}

impl FeaturesMade {
    /// By the processor, as ever.
    pub(super) fn by_processor() -> Self {
        Self { device: None, note: None }
    }

    /// Chooses for a run with this evaluator.
    ///
    /// # Errors
    /// When a device is asked for and cannot make them.
    pub(super) fn choose(
        settings: &TrackSettings,
        features: &FeatureSettings,
        evaluator: &dyn Evaluator,
    ) -> Result<Self> {
        let asked = settings.features_on;
        if asked == FeaturesOn::Cpu {
            return Ok(Self::by_processor());
        }
        let name = evaluator.name();
        let is_shared = settings.devices.len() > 1;
        let draws_there = matches!(Backend::from_name(name)?, Backend::Compute | Backend::Graphics);
        let device = match held_back(settings, features) {
            _ if is_shared => Err("several devices share the poses".to_string()),
            _ if !draws_there => Err(format!("the backend {name} is on none")),
            Some(why) => Err(why.to_string()),
            None => evaluator.holder().cloned().ok_or_else(|| "poses are compared on the host".to_string()),
        };
        match (device, asked) {
            (Err(why), FeaturesOn::Device) => {
                bail!("the features cannot be made on a device ({why}): expected --features auto or cpu")
            }
            // Without a device there is nothing to say.
            (Err(_), _) if !draws_there && !is_shared => Ok(Self::by_processor()),
            (Err(why), _) => {
                Ok(Self { device: None, note: Some(format!("the processor makes the features, since {why}")) })
            }
            (Ok(device), FeaturesOn::Auto) if !makes_features(device.facts().kind) => {
                Ok(Self { device: None, note: Some(format!("the processor makes the features, since {SOFTWARE}")) })
            }
            (Ok(device), _) => Ok(Self {
                device: Some(device),
                note: Some("the device makes the features and holds them".to_string()),
            }),
        }
    }
}

/// Why a device that the processor computes itself makes no features: four views took it 163 ms where the processor took 3
/// (docs/FEATURES.md).
const SOFTWARE: &str = "the device is a part of it, and slower at them";

/// Whether devices of a kind make features unless somebody says otherwise.
pub fn makes_features(kind: DeviceKind) -> bool {
    kind != DeviceKind::Cpu
}

/// What of a run needs observations on the host.
fn held_back(settings: &TrackSettings, features: &FeatureSettings) -> Option<&'static str> {
    if settings.realtime.is_some() {
        return Some("a run in real time makes those of each view by itself");
    }
    features.kept_from_device()
}

//! The device of the crate's own tests.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use super::{Device, DeviceSettings, Instance, Validation, ValidationLog, test_turn};

/// A device under full validation, when no other test has such a one, and its log; none where there is no Vulkan, which is a failure where PANTIN_NEEDS_VULKAN is set.
/// PANTIN_TEST_VALIDATION=off does without the layer, for machines that do not have it.
pub(crate) fn device(test: &str, settings: DeviceSettings) -> Option<(Device, ValidationLog)> {
    device_under(Validation::Synchronisation, test, settings)
}

/// The same with other validation.
pub(crate) fn device_under(
    validation: Validation,
    test: &str,
    settings: DeviceSettings,
) -> Option<(Device, ValidationLog)> {
    let without = std::env::var_os("PANTIN_TEST_VALIDATION").is_some_and(|value| value == "off");
    let validation = if without { Validation::Off } else { validation };
    if validation != Validation::Off {
        test_turn::take();
    }
    match Instance::open(validation) {
        Ok(instance) => Some((Device::open(&instance, settings).unwrap(), instance.validation_log())),
        Err(error) => {
            assert!(std::env::var_os("PANTIN_NEEDS_VULKAN").is_none(), "{error:#}");
            println!("SKIPPED {test}: {error:#}");
            None
        }
    }
}

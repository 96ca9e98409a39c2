//! The device of the tests that need one.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

#[path = "../../src/gpu/test_turn.rs"]
mod turn;

use pantin::gpu::{Device, DeviceSettings, Instance, Validation, ValidationLog};

/// A device under full validation, when no other test has such a one, and its log; none where there is no Vulkan, which is a failure where PANTIN_NEEDS_VULKAN is set.
pub(crate) fn device(test: &str, settings: DeviceSettings) -> Option<(Device, ValidationLog)> {
    device_under(Validation::Synchronisation, test, settings)
}

/// The same with other validation.
pub(crate) fn device_under(
    validation: Validation,
    test: &str,
    settings: DeviceSettings,
) -> Option<(Device, ValidationLog)> {
    if validation != Validation::Off {
        turn::take();
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

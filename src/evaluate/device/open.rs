//! Which device the backends work on, and how it is opened.

use std::env;
use std::path::PathBuf;

use anyhow::{Context as _, Result, anyhow, bail};

use crate::gpu::{Breadcrumbs, Device, DeviceSettings, Instance, Validation};

/// Opens Vulkan as the environment asks: `PANTIN_VALIDATION` is `core` or `sync` for the Khronos validation layer, and what that
/// says of an evaluation is the evaluation's error.
///
/// # Errors
/// When there is no Vulkan on this machine, or the variable holds something else.
pub fn open_instance() -> Result<Instance> {
    let validation = match env::var("PANTIN_VALIDATION").as_deref() {
        Err(env::VarError::NotPresent) | Ok("") => Validation::Off,
        Ok("core") => Validation::Core,
        Ok("sync") => Validation::Synchronisation,
        other => bail!("PANTIN_VALIDATION is {}, expected core or sync", shown(other)),
    };
    Instance::open(validation)
}

/// The device settings that the environment asks for: `PANTIN_DEVICE` is a device's number in Vulkan's list, otherwise the best one
/// is taken. Compiled pipelines are kept under `$XDG_CACHE_HOME/pantin`, or `~/.cache/pantin`.
///
/// With `PANTIN_BREADCRUMBS` every pass leaves a mark, so that the loss of the device is told with the pass.
///
/// `PANTIN_LOSE_DEVICE_AFTER` is a number of passes after which the device counts as lost: the fault that tests inject.
///
/// # Errors
/// When a variable holds no number.
pub fn device_settings() -> Result<DeviceSettings> {
    let number = |name: &str| match env::var(name).as_deref() {
        Err(env::VarError::NotPresent) | Ok("") => Ok(None),
        Ok(text) if text.bytes().all(|byte| byte.is_ascii_digit()) => {
            text.parse::<u32>().map(Some).with_context(|| format!("{name} is {text}"))
        }
        other => Err(anyhow!("{name} is {}, expected a number from 0 on", shown(other))),
    };
    Ok(DeviceSettings {
        index: number("PANTIN_DEVICE")?.map(|index| index as usize),
        lose_after_passes: number("PANTIN_LOSE_DEVICE_AFTER")?.map(u64::from),
        breadcrumbs: match env::var_os("PANTIN_BREADCRUMBS") {
            Some(value) if !value.is_empty() => Breadcrumbs::Always,
            _ => Breadcrumbs::default(),
        },
        pipeline_cache: cache_folder(),
        ..DeviceSettings::default()
    })
}

/// Opens the device that all backends of this process work on.
///
/// # Errors
/// As [`open_instance`] and [`device_settings`]; and when there is no usable device. The sentence says what to install.
pub fn open_device() -> Result<Device> {
    Device::open(&open_instance()?, device_settings()?)
}

/// The same where nothing is drawn with the graphics pipeline: on a queue for compute alone where there is one.
///
/// # Errors
/// As [`open_device`].
pub(crate) fn open_compute_device() -> Result<Device> {
    Device::open(&open_instance()?, DeviceSettings { graphics: false, ..device_settings()? })
}

/// Opens the devices of those numbers in Vulkan's list, one for each number, the same one several times where it stands several
/// times; without numbers the one of [`open_device`].
///
/// # Errors
/// As [`open_device`].
pub(crate) fn open_devices(indices: &[usize], graphics: bool) -> Result<Vec<Device>> {
    let (instance, settings) = (open_instance()?, DeviceSettings { graphics, ..device_settings()? });
    if indices.is_empty() {
        return Ok(vec![Device::open(&instance, settings)?]);
    }
    let open = |&index: &usize| Device::open(&instance, DeviceSettings { index: Some(index), ..settings.clone() });
    indices.iter().map(open).collect()
}

fn shown(value: std::result::Result<&str, &env::VarError>) -> String {
    value.map_or_else(|_| "not valid Unicode".to_string(), |text| format!("`{text}`"))
}

/// None where the user has no home: pipelines are then compiled in every run.
pub(super) fn cache_folder() -> Option<PathBuf> {
    // The base-directory convention has relative paths ignored.
    let absolute = |name: &str| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let base = absolute("XDG_CACHE_HOME").or_else(|| Some(absolute("HOME")?.join(".cache")))?;
    Some(base.join("pantin"))
}

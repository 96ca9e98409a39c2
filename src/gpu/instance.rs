//! The Vulkan loader, found at run time, and an instance without any window.

use std::ffi::CStr;
use std::sync::Arc;

use anyhow::{Context as _, Result, anyhow, bail};
use ash::{ext, khr, vk};

use super::lock::loader;
use super::validation::{Validation, ValidationLog};

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// A Vulkan instance.
#[derive(Clone)]
pub struct Instance {
    pub(super) shared: Arc<InstanceShared>,
}

pub(super) struct InstanceShared {
    /// Held because the functions of `raw` lie in the library it loaded.
    pub(super) entry: ash::Entry,
    pub(super) raw: ash::Instance,
    pub(super) log: ValidationLog,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    pub(super) has_debug_utils: bool,
}

impl std::fmt::Debug for Instance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Instance").finish_non_exhaustive()
    }
}

impl Instance {
    /// Loads Vulkan and makes an instance.
    ///
    /// # Errors
    /// When there is no Vulkan loader on this machine, it is older than 1.3, or the validation layer was asked for and is
    /// not installed.
    pub fn open(validation: Validation) -> Result<Self> {
        let _alone = loader();
        // SAFETY: the loader is a system library whose initialisers are sound to run; it stays loaded as long as `entry`.
        let entry = unsafe { ash::Entry::load() }.map_err(|error| {
            anyhow!("there is no Vulkan on this machine ({error}): install a driver with its loader (libvulkan1)")
        })?;
        // SAFETY: takes no arguments but out-pointers that ash supplies.
        let version = unsafe { entry.try_enumerate_instance_version() }
            .context("the Vulkan loader does not tell its version")?
            .unwrap_or(vk::API_VERSION_1_0);
        if version < vk::API_VERSION_1_3 {
            bail!(
                "the Vulkan loader is version {}.{}, expected 1.3 or later",
                vk::api_version_major(version),
                vk::api_version_minor(version)
            );
        }
        // SAFETY: as above.
        let extensions = unsafe { entry.enumerate_instance_extension_properties(None) }
            .context("the Vulkan loader does not list its extensions")?;
        let has = |wanted: &CStr| {
            extensions.iter().any(|extension| extension.extension_name_as_c_str().is_ok_and(|name| name == wanted))
        };
        let has_debug_utils = has(ext::debug_utils::NAME);
        // Without being asked the loader leaves out implementations on top of another interface, such as Apple's.
        let lists_portable = has(khr::portability_enumeration::NAME);
        let mut layers = Vec::new();
        if validation != Validation::Off {
            // SAFETY: as above.
            let found = unsafe { entry.enumerate_instance_layer_properties() }
                .context("the Vulkan loader does not list its layers")?;
            if !found.iter().any(|layer| layer.layer_name_as_c_str().is_ok_and(|name| name == VALIDATION_LAYER)) {
                bail!(
                    "the validation layer {} is not installed (Debian package vulkan-validationlayers)",
                    VALIDATION_LAYER.to_string_lossy()
                );
            }
            layers.push(VALIDATION_LAYER.as_ptr());
        }

        let log = ValidationLog::default();
        let application = vk::ApplicationInfo::default()
            .application_name(c"pantin")
            .engine_name(c"pantin")
            .api_version(vk::API_VERSION_1_3);
        let names: Vec<_> =
            [(has_debug_utils, ext::debug_utils::NAME), (lists_portable, khr::portability_enumeration::NAME)]
                .into_iter()
                .filter_map(|(has, name)| has.then_some(name.as_ptr()))
                .collect();
        let flags = if lists_portable {
            vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR
        } else {
            vk::InstanceCreateFlags::empty()
        };
        let mut messenger = log.messenger();
        let enabled = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
        let mut info = vk::InstanceCreateInfo::default()
            .flags(flags)
            .application_info(&application)
            .enabled_layer_names(&layers)
            .enabled_extension_names(&names);
        if validation != Validation::Off && has_debug_utils {
            // Chained, the messenger also hears of faults in making and destroying the instance.
            info = info.push_next(&mut messenger);
        }
        if validation == Validation::Synchronisation {
            info = info.push_next(&mut features);
        }
        // SAFETY: everything `info` points to lives until the call returns; the log outlives the instance (InstanceShared).
        let raw = unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
            vk::Result::ERROR_INCOMPATIBLE_DRIVER => {
                anyhow!("Vulkan finds no driver on this machine: install one (Debian: mesa-vulkan-drivers)")
            }
            _ => anyhow!("Vulkan makes no instance on this machine ({result})"),
        })?;
        let messenger = if validation != Validation::Off && has_debug_utils {
            let functions = ext::debug_utils::Instance::new(&entry, &raw);
            // SAFETY: the extension is enabled; the log lives in the same struct and is dropped after the messenger.
            let handle = unsafe { functions.create_debug_utils_messenger(&log.messenger(), None) };
            handle.ok().map(|handle| (functions, handle))
        } else {
            None
        };
        Ok(Self { shared: Arc::new(InstanceShared { entry, raw, log, messenger, has_debug_utils }) })
    }

    /// The validation log. It stays readable after the instance and all devices are gone.
    pub fn validation_log(&self) -> ValidationLog {
        self.shared.log.clone()
    }
}

impl Drop for InstanceShared {
    fn drop(&mut self) {
        let _alone = loader();
        // SAFETY: devices hold this struct, so none is left; the messenger belongs to the instance and goes first.
        unsafe {
            if let Some((functions, messenger)) = &self.messenger {
                functions.destroy_debug_utils_messenger(*messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

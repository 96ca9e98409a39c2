//! The validation log: what the Khronos layer says, collected so that a test can assert that it said nothing.

use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::{Result, bail};
use ash::vk;

/// How much the validation layer checks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Validation {
    /// No layer.
    #[default]
    Off,
    /// The core rules.
    Core,
    /// The core rules and synchronisation.
    Synchronisation,
}

/// The messages of the validation layer that mean a fault: errors, and warnings of its validation kind. What it says of
/// performance is left out.
#[derive(Clone, Debug, Default)]
pub struct ValidationLog {
    messages: Arc<Mutex<Vec<String>>>,
}

impl ValidationLog {
    /// What was said so far, oldest first.
    pub fn messages(&self) -> Vec<String> {
        self.messages.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Holds the program to it.
    ///
    /// # Errors
    /// When something was said: the first message.
    pub fn check(&self) -> Result<()> {
        match self.messages().first() {
            Some(message) => bail!("the Vulkan validation layer finds a fault: {message}"),
            None => Ok(()),
        }
    }

    /// The create info of a messenger that writes here. The log must outlive the messenger: the instance keeps both.
    pub(super) fn messenger(&self) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
        vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(
                vk::DebugUtilsMessageSeverityFlagsEXT::ERROR | vk::DebugUtilsMessageSeverityFlagsEXT::WARNING,
            )
            .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
            .pfn_user_callback(Some(receive))
            .user_data(Arc::as_ptr(&self.messages).cast_mut().cast())
    }
}

/// Called by the layer, on whatever thread the offending call was made.
unsafe extern "system" fn receive(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    log: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: `log` is the mutex that the instance keeps alive longer than its messenger; `data` is valid for the call,
    // and its message is a nul-terminated string or null.
    unsafe {
        let log = &*log.cast::<Mutex<Vec<String>>>();
        let message = match data.as_ref().map(|data| data.p_message) {
            Some(text) if !text.is_null() => CStr::from_ptr(text).to_string_lossy().into_owned(),
            _ => "a message without text".to_string(),
        };
        let severity =
            if severity.contains(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR) { "error" } else { "warning" };
        log.lock().unwrap_or_else(PoisonError::into_inner).push(format!("{severity}: {message}"));
    }
    vk::FALSE
}

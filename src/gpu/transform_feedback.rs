//! The functions of VK_EXT_transform_feedback, for which ash has types but no wrapper.

use ash::vk;

/// Its commands.
#[derive(Clone, Copy)]
pub(super) struct FeedbackFunctions {
    pub(super) bind_buffers: vk::PFN_vkCmdBindTransformFeedbackBuffersEXT,
    pub(super) begin: vk::PFN_vkCmdBeginTransformFeedbackEXT,
    pub(super) end: vk::PFN_vkCmdEndTransformFeedbackEXT,
}

impl FeedbackFunctions {
    /// The functions of a device on which the extension is enabled.
    pub(super) fn load(instance: &ash::Instance, device: &ash::Device) -> Option<Self> {
        let address = |name: &std::ffi::CStr| {
            // SAFETY: the device is open and the name is nul-terminated.
            unsafe { (instance.fp_v1_0().get_device_proc_addr)(device.handle(), name.as_ptr()) }
        };
        let bind_buffers = address(c"vkCmdBindTransformFeedbackBuffersEXT")?;
        let begin = address(c"vkCmdBeginTransformFeedbackEXT")?;
        let end = address(c"vkCmdEndTransformFeedbackEXT")?;
        // SAFETY: the loader gives the functions of these names, whose types the registry fixes.
        unsafe {
            Some(Self {
                bind_buffers: std::mem::transmute::<
                    unsafe extern "system" fn(),
                    vk::PFN_vkCmdBindTransformFeedbackBuffersEXT,
                >(bind_buffers),
                begin: std::mem::transmute::<unsafe extern "system" fn(), vk::PFN_vkCmdBeginTransformFeedbackEXT>(
                    begin,
                ),
                end: std::mem::transmute::<unsafe extern "system" fn(), vk::PFN_vkCmdEndTransformFeedbackEXT>(end),
            })
        }
    }
}

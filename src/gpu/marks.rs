//! Marks that passes leave at next to no cost, so that the loss of a device is told with the pass.

use std::ptr::without_provenance;

use ash::{amd, nv, vk};

/// The extension that leaves them.
pub(super) enum Marks {
    /// VK_AMD_buffer_marker: words of a buffer, which can be read at any time.
    Words(amd::buffer_marker::Device),
    /// VK_NV_device_diagnostic_checkpoints: the driver keeps them, and tells them of a device that is lost.
    Checkpoints(nv::device_diagnostic_checkpoints::DeviceFn),
}

/// A pass of a recording as a checkpoint. Recordings have numbers of their own, and a device runs several at a time.
fn checkpoint(recording: u64, pass: usize) -> usize {
    /// More passes than a recording holds.
    const PASSES: usize = 1 << 16;
    recording as usize * PASSES + pass
}

impl Marks {
    /// Records that a pass begins, where the driver keeps the marks.
    pub(super) fn set_checkpoint(&self, commands: vk::CommandBuffer, recording: u64, pass: usize) {
        if let Self::Checkpoints(functions) = self {
            // SAFETY: recording, outside of rendering, on a device with the extension, whose driver keeps the marker as a number.
            unsafe { (functions.cmd_set_checkpoint_nv)(commands, without_provenance(checkpoint(recording, pass))) };
        }
    }

    /// The last pass of a recording that a lost device began on this queue, which nobody else uses meanwhile; none where others do not know.
    pub(super) fn last_begun(&self, queue: vk::Queue, recording: u64) -> Option<usize> {
        let Self::Checkpoints(functions) = self else { return None };
        let mut count = 0;
        // SAFETY: the queue is one of a device with the extension, which is lost; so for the call below, with room for `count`.
        unsafe { (functions.get_queue_checkpoint_data_nv)(queue, &raw mut count, std::ptr::null_mut()) };
        let mut found = vec![vk::CheckpointDataNV::default(); count as usize];
        // SAFETY: as above.
        unsafe { (functions.get_queue_checkpoint_data_nv)(queue, &raw mut count, found.as_mut_ptr()) };
        found.truncate(count as usize);
        // One a stage of the pipeline, of which the first is the farthest.
        let own = checkpoint(recording, 0)..checkpoint(recording + 1, 0);
        let markers = found.iter().map(|data| data.p_checkpoint_marker.addr());
        markers.filter(|marker| own.contains(marker)).max().map(|marker| marker - own.start)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test stops at the first surprise, and prints")]

    use std::ffi::c_void;
    use std::sync::Mutex;

    use super::*;
    use crate::gpu::test_device::device;
    use crate::gpu::{Device, DeviceSettings, Memory, Recording, Timing};

    /// What was recorded, in order.
    static RECORDED: Mutex<Vec<usize>> = Mutex::new(Vec::new());

    unsafe extern "system" fn record(_: vk::CommandBuffer, marker: *const c_void) {
        RECORDED.lock().unwrap().push(marker.addr());
    }

    /// Tells of a device that was lost with the first pass of the second recording begun, behind the three of the first.
    unsafe extern "system" fn tell(_: vk::Queue, count: *mut u32, data: *mut vk::CheckpointDataNV<'_>) {
        let recorded = RECORDED.lock().unwrap();
        let told = [recorded[3], recorded[2], recorded[1]];
        // SAFETY: the caller gives room for as many as were told before.
        unsafe {
            if !data.is_null() {
                for (place, marker) in told.iter().enumerate() {
                    (*data.add(place)).p_checkpoint_marker = std::ptr::without_provenance_mut(*marker);
                }
            }
            *count = told.len() as u32;
        }
    }

    fn fills(device: &Device, passes: usize) -> Recording {
        let buffer = device.buffer::<u32>("filled", 4, Memory::Device).unwrap();
        let mut recorder = device.recorder(Timing::Off).unwrap();
        (0..passes).for_each(|pass| recorder.fill(&format!("fill {pass}"), &buffer, 1).unwrap());
        recorder.finish().unwrap()
    }

    #[test]
    fn checkpoints_tell_the_pass_of_each_recording_once_the_device_is_lost() {
        let functions = || nv::device_diagnostic_checkpoints::DeviceFn {
            cmd_set_checkpoint_nv: record,
            get_queue_checkpoint_data_nv: tell,
        };
        let settings = DeviceSettings {
            lower: Some(|it| it.buffer_markers = false),
            checkpoints: Some(functions),
            ..DeviceSettings::default()
        };
        let Some((device, log)) = device("checkpoints_tell_the_pass", settings) else { return };
        let mut recordings = [3, 2, 1].map(|passes| fills(&device, passes));
        recordings.iter_mut().for_each(|recording| recording.run().unwrap());
        assert_eq!(RECORDED.lock().unwrap().len(), 6, "a pass leaves one mark");
        let begun = recordings.each_ref().map(Recording::last_pass_begun);
        assert_eq!(begun, [None; 3], "while it is at work nobody is asked");
        let begun = recordings.each_ref().map(Recording::last_pass_begun_by_lost);
        assert_eq!(begun, [Some(2), Some(0), None]);
        drop((recordings, device));
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}

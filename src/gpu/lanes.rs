//! The ways into a device: two, each with a timeline that says how far the device has come there. Each leads to a queue of its own
//! where the device has two, else both lead to the same one.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard};

use ash::vk;

use super::capability::QueuePlace;
use super::lock::lock;

/// How many there are.
pub(super) const LANES: usize = 2;
/// The one that everything takes that asks for no other.
pub(super) const MAIN: usize = 0;
/// The one beside it ([`super::Device::beside`]).
pub(super) const BESIDE: usize = 1;

/// How far each lane is to have come: values of their timelines.
pub(super) type LastUse = [AtomicU64; LANES];

/// A way in.
pub(super) struct Lane {
    /// The family of its queue.
    pub(super) family: u32,
    pub(super) timestamp_bits: u32,
    /// Its queue, among those of the device.
    queue: usize,
    pub(super) timeline: vk::Semaphore,
    /// Value the timeline takes when its last submission is done.
    pub(super) submitted: AtomicU64,
}

/// All of them.
pub(super) struct Lanes {
    queues: Vec<Mutex<vk::Queue>>,
    lanes: [Lane; LANES],
}

impl Lanes {
    /// Over one or two queues, at these places.
    pub(super) fn new(queues: &[(QueuePlace, vk::Queue)], timelines: [vk::Semaphore; LANES]) -> Self {
        let lane = |lane: usize| {
            let queue = lane.min(queues.len() - 1);
            let QueuePlace { family, timestamp_bits, .. } = queues[queue].0;
            Lane { family, timestamp_bits, queue, timeline: timelines[lane], submitted: AtomicU64::new(0) }
        };
        Self { queues: queues.iter().map(|(_, queue)| Mutex::new(*queue)).collect(), lanes: [lane(MAIN), lane(BESIDE)] }
    }

    pub(super) fn of(&self, lane: usize) -> &Lane {
        &self.lanes[lane]
    }

    pub(super) fn all(&self) -> &[Lane; LANES] {
        &self.lanes
    }

    /// A lane's queue, for the caller alone while it is held.
    pub(super) fn queue(&self, lane: usize) -> MutexGuard<'_, vk::Queue> {
        lock(&self.queues[self.lanes[lane].queue])
    }

    /// All queues, for what stops the whole device.
    pub(super) fn every_queue(&self) -> Vec<MutexGuard<'_, vk::Queue>> {
        self.queues.iter().map(lock).collect()
    }

    /// The families of the queues, each once.
    pub(super) fn families(&self) -> Vec<u32> {
        let mut families: Vec<u32> = self.lanes.iter().map(|lane| lane.family).collect();
        families.dedup();
        families
    }
}

/// Takes note of what uses something on a lane.
pub(super) fn note_use(last_use: &LastUse, lane: usize, value: u64) {
    last_use[lane].store(value, Ordering::Relaxed);
}

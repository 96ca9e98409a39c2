//! Which passes must wait for which, and no more than that: derived from what each reads and writes, and where.

use std::collections::HashMap;
use std::ops::{BitOr, BitOrAssign};

use ash::vk;

/// Where in the device a pass reads and writes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Stages(u8);

impl Stages {
    /// Copies and fills.
    pub(super) const TRANSFER: Self = Self(1);
    /// Compute stages.
    pub(super) const COMPUTE: Self = Self(2);
    /// Workgroup counts read from a buffer.
    pub(super) const INDIRECT: Self = Self(4);
    /// The graphics pipeline, its counts, attachments and transform feedback.
    pub(super) const GRAPHICS: Self = Self(8);

    fn holds(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    fn is_none(self) -> bool {
        self.0 == 0
    }

    /// Vulkan's stages, what is written there and what is read or written there.
    pub(super) fn scopes(self) -> (vk::PipelineStageFlags2, vk::AccessFlags2, vk::AccessFlags2) {
        use vk::{AccessFlags2 as Access, PipelineStageFlags2 as Stage};
        let all = [
            (Self::TRANSFER, Stage::ALL_TRANSFER, Access::TRANSFER_WRITE, Access::TRANSFER_READ),
            (Self::COMPUTE, Stage::COMPUTE_SHADER, Access::SHADER_WRITE, Access::SHADER_READ | Access::UNIFORM_READ),
            (Self::INDIRECT, Stage::DRAW_INDIRECT, Access::NONE, Access::INDIRECT_COMMAND_READ),
            (Self::GRAPHICS, Stage::ALL_GRAPHICS, Access::MEMORY_WRITE, Access::MEMORY_READ),
        ];
        let own = all.into_iter().filter(|(stages, ..)| self.holds(*stages));
        own.fold(Default::default(), |(stages, written, touched), (_, stage, writes, reads)| {
            (stages | stage, written | writes, touched | writes | reads)
        })
    }
}

impl BitOr for Stages {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for Stages {
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

/// What a pass does with a resource. Resources are told apart by a number of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Use {
    pub(super) resource: u64,
    pub(super) writes: bool,
}

/// A barrier: what comes behind waits in `behind` for what was done in `ahead`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Barrier {
    pub(super) ahead: Stages,
    pub(super) behind: Stages,
}

/// What became of a resource.
#[derive(Clone, Copy, Debug, Default)]
struct Touched {
    /// Where it was last written.
    written: Stages,
    /// Where that is known by a barrier.
    known: Stages,
    /// Where it was read since.
    read: Stages,
    /// Where a barrier waits for those reads.
    awaited: Stages,
}

/// What was read and written so far, and which barriers stand behind it.
#[derive(Debug, Default)]
pub(super) struct Hazards {
    touched: HashMap<u64, Touched>,
}

impl Hazards {
    /// The barrier that a pass of these uses in `stages` needs: it reads or writes what was written, or writes what was read, and
    /// no barrier before has served that.
    pub(super) fn must_wait(&mut self, uses: &[Use], stages: Stages) -> Option<Barrier> {
        let mut ahead = Stages::default();
        for used in uses {
            let Some(own) = self.touched.get(&used.resource) else { continue };
            if !own.known.holds(stages) {
                ahead |= own.written;
            }
            if used.writes && !own.awaited.holds(stages) {
                ahead |= own.read;
            }
        }
        if !ahead.is_none() {
            for own in self.touched.values_mut() {
                if ahead.holds(own.written) {
                    own.known |= stages;
                }
                if ahead.holds(own.read) {
                    own.awaited |= stages;
                }
            }
        }
        for used in uses {
            let own = self.touched.entry(used.resource).or_default();
            if used.writes {
                *own = Touched { written: stages, ..Touched::default() };
            } else {
                own.read |= stages;
                own.awaited = Stages::default();
            }
        }
        (!ahead.is_none()).then_some(Barrier { ahead, behind: stages })
    }

    /// Forgets everything: a barrier of all stages was made for another reason.
    pub(super) fn clear(&mut self) {
        self.touched.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COMPUTE: Stages = Stages::COMPUTE;
    const TRANSFER: Stages = Stages::TRANSFER;
    const GRAPHICS: Stages = Stages::GRAPHICS;

    const fn read(resource: u64) -> Use {
        Use { resource, writes: false }
    }

    const fn write(resource: u64) -> Use {
        Use { resource, writes: true }
    }

    fn barrier(ahead: Stages, behind: Stages) -> Option<Barrier> {
        Some(Barrier { ahead, behind })
    }

    #[test]
    fn only_conflicts_wait() {
        let mut hazards = Hazards::default();
        assert_eq!(hazards.must_wait(&[write(1)], COMPUTE), None);
        assert_eq!(hazards.must_wait(&[write(2), read(3)], COMPUTE), None, "other resources");
        assert_eq!(hazards.must_wait(&[read(1)], COMPUTE), barrier(COMPUTE, COMPUTE), "read after write");
        assert_eq!(hazards.must_wait(&[read(2)], COMPUTE), None, "the same barrier served it");
        assert_eq!(hazards.must_wait(&[read(1)], COMPUTE), None, "read after read");
        assert_eq!(hazards.must_wait(&[write(1)], COMPUTE), barrier(COMPUTE, COMPUTE), "write after read");
        assert_eq!(hazards.must_wait(&[write(1)], COMPUTE), barrier(COMPUTE, COMPUTE), "write after write");
    }

    #[test]
    fn a_pass_that_waits_is_itself_remembered() {
        let mut hazards = Hazards::default();
        hazards.must_wait(&[write(1)], COMPUTE);
        assert!(hazards.must_wait(&[read(1), write(2)], COMPUTE).is_some());
        assert!(hazards.must_wait(&[read(2)], COMPUTE).is_some());
    }

    #[test]
    fn one_pass_may_use_a_resource_twice() {
        let mut hazards = Hazards::default();
        assert_eq!(hazards.must_wait(&[read(1), write(1)], COMPUTE), None);
        assert!(hazards.must_wait(&[read(1)], COMPUTE).is_some());
        hazards.clear();
        assert_eq!(hazards.must_wait(&[write(1), read(1)], COMPUTE), None);
        assert!(hazards.must_wait(&[write(1)], COMPUTE).is_some());
    }

    #[test]
    fn a_barrier_serves_the_stages_it_names_alone() {
        let mut hazards = Hazards::default();
        hazards.must_wait(&[write(1), write(2)], TRANSFER);
        hazards.must_wait(&[write(3)], COMPUTE);
        assert_eq!(hazards.must_wait(&[read(1)], COMPUTE), barrier(TRANSFER, COMPUTE));
        assert_eq!(hazards.must_wait(&[read(2)], COMPUTE), None, "the same barrier served it");
        assert_eq!(hazards.must_wait(&[read(2)], GRAPHICS), barrier(TRANSFER, GRAPHICS), "but not there");
        assert_eq!(hazards.must_wait(&[read(3)], COMPUTE), barrier(COMPUTE, COMPUTE), "nor what compute wrote");
        let counts = COMPUTE | Stages::INDIRECT;
        assert_eq!(hazards.must_wait(&[read(1)], counts), barrier(TRANSFER, counts), "nor for counts");
        // Readers in two places hold a writer up.
        assert_eq!(hazards.must_wait(&[write(2)], TRANSFER), barrier(TRANSFER | COMPUTE | GRAPHICS, TRANSFER));
        assert_eq!(hazards.must_wait(&[read(2)], COMPUTE), barrier(TRANSFER, COMPUTE));
    }

    #[test]
    fn a_later_read_is_not_served_by_an_earlier_barrier() {
        let mut hazards = Hazards::default();
        hazards.must_wait(&[read(1), write(2)], COMPUTE);
        assert!(hazards.must_wait(&[read(2)], TRANSFER).is_some());
        assert_eq!(hazards.must_wait(&[read(1)], COMPUTE), None);
        assert_eq!(hazards.must_wait(&[write(1)], TRANSFER), barrier(COMPUTE, TRANSFER));
    }
}

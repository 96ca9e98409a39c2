//! Invocations of the workgroups of stages that take any number.

use anyhow::{Result, ensure};

use crate::evaluate::shaders::{COMPARE_GROUP, MOST_COMPARE_GROUP, PROJECT_GROUP};

/// Invocations of a workgroup, by stage. The integers are the same, the time is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct StageGroups {
    /// Of the projection, which takes whole images of a part an invocation.
    pub(crate) project: u32,
    /// Of the comparison of a framebuffer.
    pub(crate) compare: u32,
}

impl Default for StageGroups {
    fn default() -> Self {
        Self { project: PROJECT_GROUP, compare: COMPARE_GROUP }
    }
}

impl StageGroups {
    /// Fewest of the comparison: the first 16 begin a tile's sums and bits of codes, one each.
    pub(crate) const LEAST_COMPARE: u32 = 64;

    /// Holds them to what a body of so many parts takes, and a device of workgroups of `most` invocations.
    pub(super) fn check(self, parts: u32, most: u32) -> Result<()> {
        let (least, most_project) = (parts, most.min(PROJECT_GROUP));
        ensure!(
            (least..=most_project).contains(&self.project),
            "workgroups of {} invocations project, expected {least} to {most_project}",
            self.project
        );
        let (least, most) = (Self::LEAST_COMPARE, most.min(MOST_COMPARE_GROUP));
        ensure!(
            self.compare.is_power_of_two() && (least..=most).contains(&self.compare),
            "workgroups of {} invocations compare, expected a power of two from {least} to {most}",
            self.compare
        );
        Ok(())
    }
}

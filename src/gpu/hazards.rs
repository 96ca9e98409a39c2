//! Which passes must wait for which: derived from what each reads and writes.

use std::collections::HashMap;

/// What a pass does with a resource. Resources are told apart by a number of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Use {
    pub(super) resource: u64,
    pub(super) writes: bool,
}

/// What was read and written since the last barrier.
#[derive(Debug, Default)]
pub(super) struct Hazards {
    /// Resource to whether it was written.
    touched: HashMap<u64, bool>,
}

impl Hazards {
    /// Whether a pass of these uses must wait for what came before: it reads or writes what was written, or writes what was
    /// read. The passes before are then forgotten, since one barrier makes it wait for all of them.
    pub(super) fn must_wait(&mut self, uses: &[Use]) -> bool {
        let conflict = uses.iter().any(|used| match self.touched.get(&used.resource) {
            Some(&was_written) => was_written || used.writes,
            None => false,
        });
        if conflict {
            self.touched.clear();
        }
        for used in uses {
            *self.touched.entry(used.resource).or_default() |= used.writes;
        }
        conflict
    }

    /// Forgets everything: a barrier was made for another reason.
    pub(super) fn clear(&mut self) {
        self.touched.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn read(resource: u64) -> Use {
        Use { resource, writes: false }
    }

    const fn write(resource: u64) -> Use {
        Use { resource, writes: true }
    }

    #[test]
    fn only_conflicts_wait() {
        let mut hazards = Hazards::default();
        assert!(!hazards.must_wait(&[write(1)]));
        assert!(!hazards.must_wait(&[write(2), read(3)]), "other resources");
        assert!(hazards.must_wait(&[read(1)]), "read after write");
        assert!(!hazards.must_wait(&[read(2)]), "the same barrier served it");
        assert!(!hazards.must_wait(&[read(1)]), "read after read");
        assert!(hazards.must_wait(&[write(1)]), "write after read");
        assert!(hazards.must_wait(&[write(1)]), "write after write");
    }

    #[test]
    fn a_pass_that_waits_is_itself_remembered() {
        let mut hazards = Hazards::default();
        hazards.must_wait(&[write(1)]);
        assert!(hazards.must_wait(&[read(1), write(2)]));
        assert!(hazards.must_wait(&[read(2)]));
    }

    #[test]
    fn one_pass_may_use_a_resource_twice() {
        let mut hazards = Hazards::default();
        assert!(!hazards.must_wait(&[read(1), write(1)]));
        assert!(hazards.must_wait(&[read(1)]));
    }
}

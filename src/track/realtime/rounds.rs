//! Frames of a run in real time: they go on over the rounds of a loop.

use std::ops::Range;

/// The frames of one round.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Rounds {
    range: Range<usize>,
}

impl Rounds {
    /// Rounds of a range that holds a frame at least.
    pub(super) fn of(range: Range<usize>) -> Self {
        Self { range }
    }

    /// The frames of a round.
    pub(super) fn range(&self) -> Range<usize> {
        self.range.clone()
    }

    fn split(&self, frame: usize) -> [usize; 2] {
        let (position, length) = (frame.saturating_sub(self.range.start), self.range.len().max(1));
        [position / length, position % length]
    }

    /// A frame of the run as the sequence counts it.
    pub(super) fn in_sequence(&self, frame: usize) -> usize {
        self.range.start + self.split(frame)[1]
    }

    /// Whether two frames lie in one round.
    pub(super) fn are_together(&self, one: usize, other: usize) -> bool {
        self.split(one)[0] == self.split(other)[0]
    }

    /// Frames from the start of its round up to and with this one.
    pub(super) fn since_start(&self, frame: usize) -> usize {
        self.split(frame)[1] + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_go_on_over_the_rounds() {
        let rounds = Rounds::of(10..14);
        assert_eq!([10, 13, 14, 21].map(|frame| rounds.in_sequence(frame)), [10, 13, 10, 13]);
        assert!(rounds.are_together(10, 13) && !rounds.are_together(13, 14));
        assert_eq!([10, 13, 14].map(|frame| rounds.since_start(frame)), [1, 4, 1]);
    }
}

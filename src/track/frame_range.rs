//! `A..B`: which frames.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use anyhow::{Result, anyhow, ensure};

/// Frames from `start` up to but not including `end`; an open side is that of the sequence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FrameRange {
    /// The first frame, from 0.
    pub start: Option<usize>,
    /// The frame after the last.
    pub end: Option<usize>,
}

impl FrameRange {
    /// A single frame.
    pub const fn one(frame: usize) -> Self {
        Self { start: Some(frame), end: Some(frame + 1) }
    }

    /// The frames of a sequence of `frame_count`; `name` stands for it in messages.
    ///
    /// # Errors
    /// When the range is empty or reaches past the last frame.
    pub fn within(self, frame_count: usize, name: &str) -> Result<Range<usize>> {
        let (start, end) = (self.start.unwrap_or(0), self.end.unwrap_or(frame_count));
        ensure!(end <= frame_count, "frames {self} reach past the end of {name}, which has frames 0..{frame_count}");
        ensure!(start < end, "frames {self} are no frames of {name}, which has frames 0..{frame_count}");
        Ok(start..end)
    }
}

impl FromStr for FrameRange {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let wrong = || anyhow!("`{text}` is no range of frames, expected A..B, A.. or ..B with whole numbers from 0");
        let (start, end) = text.split_once("..").ok_or_else(wrong)?;
        let side = |text: &str| -> Result<Option<usize>> {
            if text.is_empty() { Ok(None) } else { text.parse().map(Some).map_err(|_| wrong()) }
        };
        let range = Self { start: side(start)?, end: side(end)? };
        if let (Some(start), Some(end)) = (range.start, range.end) {
            ensure!(start < end, "the range of frames {text} is empty, expected A..B with A smaller than B");
        }
        Ok(range)
    }
}

impl fmt::Display for FrameRange {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = |side: Option<usize>| side.map_or_else(String::new, |frame| frame.to_string());
        write!(out, "{}..{}", side(self.start), side(self.end))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_half_open() {
        let within = |text: &str| text.parse::<FrameRange>().and_then(|range| range.within(100, "beam"));
        assert_eq!(within("3..7").unwrap(), 3..7);
        assert_eq!(within("3..").unwrap(), 3..100);
        assert_eq!(within("..7").unwrap(), 0..7);
        assert_eq!(within("..").unwrap(), 0..100);
        for (text, sentence) in [
            ("7", "`7` is no range of frames, expected A..B"),
            ("3-7", "no range"),
            ("-1..7", "no range"),
            ("1..2..3", "no range"),
            ("99999999999999999999999..", "no range"),
            ("7..3", "the range of frames 7..3 is empty"),
            ("3..101", "frames 3..101 reach past the end of beam, which has frames 0..100"),
            ("100..", "frames 100.. are no frames of beam"),
        ] {
            let error = format!("{:#}", within(text).unwrap_err());
            assert!(error.contains(sentence), "{error}");
        }
    }
}

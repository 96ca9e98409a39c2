//! `--frames A..B`: frames A to B - 1, counted from 0; either end may be left out.

use std::ops::Range;
use std::str::FromStr;

use anyhow::{Result, anyhow, bail};

/// A range of frames as typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRange {
    first: usize,
    end: Option<usize>,
}

impl FrameRange {
    /// The frames of a sequence of `count` frames.
    ///
    /// # Errors
    /// When the range reaches past the last frame.
    pub fn within(self, count: usize) -> Result<Range<usize>> {
        let end = self.end.unwrap_or(count);
        if self.first >= end || end > count {
            bail!(
                "--frames {}..{end} holds no frames of a sequence of {count}, expected a range within 0..{count}",
                self.first
            );
        }
        Ok(self.first..end)
    }
}

impl FromStr for FrameRange {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let wrong = || anyhow!("{text:?} is no range of frames, expected A..B with A smaller than B, like 0..100");
        let (first, end) = text.split_once("..").ok_or_else(wrong)?;
        let number = |text: &str| text.trim().parse::<usize>().map_err(|_| wrong());
        let first = if first.trim().is_empty() { 0 } else { number(first)? };
        let end = if end.trim().is_empty() { None } else { Some(number(end)?) };
        if end.is_some_and(|end| end <= first) {
            return Err(wrong());
        }
        Ok(Self { first, end })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_as_typed() {
        let range = |text: &str| text.parse::<FrameRange>().unwrap().within(100).unwrap();
        assert_eq!([range("0..100"), range("5..6"), range("90.."), range("..3")], [0..100, 5..6, 90..100, 0..3]);
        for wrong in ["5", "5..5", "9..2", "-1..3", "a..b", "0..1e3", "", "1...4", "0..99999999999999999999999"] {
            let error = wrong.parse::<FrameRange>().unwrap_err().to_string();
            assert!(error.contains("expected A..B"), "{wrong}: {error}");
        }
        let error = "50..101".parse::<FrameRange>().unwrap().within(100).unwrap_err().to_string();
        assert!(error.contains("50..101") && error.contains("0..100"), "{error}");
    }
}

//! A run in real time that lets every frame wait for some after it (`--delay`).

use std::time::Instant;

use anyhow::Result;

use super::Run;
use crate::track::feed::Prepared;
use crate::track::journal::FrameResult;
use crate::track::progress::FrameDone;
use crate::track::timings::{Span, Thread};

impl Run<'_> {
    /// Takes note of a frame's result, from which the next search starts, lets it wait, and gives out those that waited for it.
    pub(super) fn delay(&mut self, prepared: Prepared, result: FrameResult) -> Result<FrameDone> {
        let start = Instant::now();
        let frame = prepared.index;
        let goes_on = self.frames.last().is_some_and(|before| self.pace.follows(before.frame, frame));
        if !goes_on {
            self.give_out_all()?;
        }
        let confidence = self.judge(&result);
        self.learn(&prepared, &result)?;
        if let Some(delayed) = &mut self.delayed {
            if !goes_on {
                delayed.begin_anew();
            }
            delayed.push(prepared, result.clone(), confidence.is_lost);
        }
        let mean_error = self.give_out_until(frame)?;
        self.timings.record("output", Thread::Search, frame, Span::since(start))?;
        Ok(self.done_with(result, &confidence, mean_error))
    }

    /// Gives out all that have waited long enough when frame `last` is searched; the mean error up to them.
    fn give_out_until(&mut self, last: usize) -> Result<Option<f64>> {
        let mut mean_error = None;
        while let Some(delayed) = &mut self.delayed {
            let Some((prepared, result)) = delayed.next(last, &mut self.plan, &self.probe)? else { break };
            self.give_out(&prepared, &result)?;
            mean_error = self.error_up_to(&result);
        }
        Ok(mean_error)
    }

    /// Gives out all that wait; those that cannot be searched again as they are.
    pub(super) fn give_out_all(&mut self) -> Result<()> {
        let searched = self.give_out_until(usize::MAX);
        while let Some((prepared, result)) = self.delayed.as_mut().and_then(|delayed| delayed.give_up()) {
            self.give_out(&prepared, &result)?;
        }
        searched.map(drop)
    }
}

//! Poses on their way out, and what they go out by.

use std::cell::OnceCell;
use std::sync::Arc;

use anyhow::Result;
use serde::Serialize;

use super::lines::Lines;
use super::pose::LivePose;

/// A pose for every outlet, and the line that says it, made once for those that want it.
pub(crate) struct Outgoing<'a> {
    pub(crate) pose: &'a LivePose,
    lines: &'a Lines,
    line: OnceCell<Arc<str>>,
}

impl<'a> Outgoing<'a> {
    pub(crate) fn new(pose: &'a LivePose, lines: &'a Lines) -> Self {
        Self { pose, lines, line: OnceCell::new() }
    }

    /// The pose as a line of JSON, its end included.
    ///
    /// # Errors
    /// When a value cannot be written.
    pub(super) fn line(&self) -> Result<Arc<str>> {
        if let Some(line) = self.line.get() {
            return Ok(Arc::clone(line));
        }
        let line: Arc<str> = self.lines.line(self.pose)?.into();
        Ok(Arc::clone(self.line.get_or_init(|| line)))
    }
}

/// What poses go out by. Dropping it ends it.
pub(crate) trait Outlet: Send {
    /// Where poses can be had, for the user.
    fn address(&self) -> String;

    /// Hands a pose on. It does not wait for who receives it.
    ///
    /// # Errors
    /// When the pose cannot be written as what goes out; a receiver who is gone is none.
    fn send(&mut self, pose: &Outgoing<'_>) -> Result<()>;

    /// Ends it, and tells what it did.
    fn finish(self: Box<Self>) -> SentSummary;
}

/// What became of the poses of a run that were sent somewhere.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SentSummary {
    /// Where to, as the user named it.
    pub to: String,
    /// Receivers that connected, whether or not they stayed; none where nobody has to connect.
    pub receivers: Option<u64>,
    /// Poses sent, to all of them together.
    pub sent: u64,
    /// Poses that a receiver was too slow for, or that could not be sent.
    pub dropped: u64,
}

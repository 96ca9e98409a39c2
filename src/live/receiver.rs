//! A connection that is written to for as long as a run lasts, however slowly it takes what it gets.

use std::io::{ErrorKind, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use super::outlet::SentSummary;
use super::slot::Slot;

/// How long a write may take before it is looked whether the run is over.
const PATIENCE: Duration = Duration::from_millis(100);
/// How long a receiver may take for what waits for it when the run is over.
const GRACE: Duration = Duration::from_secs(1);

/// What became of the poses for all receivers of a kind.
#[derive(Default)]
pub(super) struct Counts {
    pub(super) receivers: AtomicU64,
    pub(super) sent: AtomicU64,
    pub(super) dropped: AtomicU64,
}

impl Counts {
    /// What they come to, for those who connected to `to`.
    pub(super) fn summary(&self, to: &str) -> SentSummary {
        let [receivers, sent, dropped] =
            [&self.receivers, &self.sent, &self.dropped].map(|count| count.load(Ordering::Relaxed));
        SentSummary { to: to.to_string(), receivers: Some(receivers), sent, dropped }
    }
}

/// Lines on their way to a receiver.
pub(super) type Lines = Slot<Arc<str>>;

/// Makes a connection ready to be written to; false where it is gone already.
pub(super) fn make_ready(stream: &TcpStream) -> bool {
    stream.set_write_timeout(Some(PATIENCE)).is_ok() && stream.set_nodelay(true).is_ok()
}

/// What became of a line.
enum Written {
    Whole,
    /// The receiver left.
    Gone,
    /// The receiver did not take it, and the run has been over for long.
    Late,
}

/// Writes lines until the run ends or the receiver is gone, and counts those that are poses.
pub(super) fn write_all(mut stream: TcpStream, lines: &Lines, counts: &Counts, is_pose: impl Fn(&str) -> bool) {
    while let Ok(Some(line)) = lines.take() {
        match write_line(&mut stream, line.as_bytes(), lines) {
            Written::Whole => counts.sent.fetch_add(u64::from(is_pose(&line)), Ordering::Relaxed),
            Written::Gone => break,
            Written::Late => {
                counts.dropped.fetch_add(1 + lines.close() as u64, Ordering::Relaxed);
                break;
            }
        };
    }
    lines.close();
    let _ = stream.shutdown(Shutdown::Both);
}

/// Writes a whole line however slowly it is taken.
fn write_line(stream: &mut TcpStream, line: &[u8], lines: &Lines) -> Written {
    let mut rest = line;
    let mut end: Option<Instant> = None;
    while !rest.is_empty() {
        match stream.write(rest) {
            Ok(0) => return Written::Gone,
            Ok(count) => rest = &rest[count..],
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                if lines.has_ended() && end.get_or_insert_with(Instant::now).elapsed() > GRACE {
                    return Written::Late;
                }
            }
            Err(_) => return Written::Gone,
        }
    }
    Written::Whole
}

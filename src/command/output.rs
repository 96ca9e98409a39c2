//! What is said on the standard streams. A reader who leaves (a closed pipe) ends it quietly and the work goes on; a stream that takes no more
//! (a full disk) is told of once the work is done. The library's own macros for this would panic.

use std::fmt;
use std::io::{self, ErrorKind, Write};
use std::sync::{Mutex, PoisonError};

/// A stream's end, once it has come.
struct Ended {
    /// Whether nothing is said any more.
    silent: bool,
    /// Why, where nobody chose it.
    reason: Option<io::Error>,
}

static OUTPUT: Mutex<Ended> = Mutex::new(Ended { silent: false, reason: None });
static MESSAGES: Mutex<Ended> = Mutex::new(Ended { silent: false, reason: None });

impl Ended {
    fn after(&mut self, written: io::Result<()>) {
        if let Err(error) = written {
            self.silent = true;
            self.reason = (error.kind() != ErrorKind::BrokenPipe).then_some(error);
        }
    }
}

fn give(stream: &Mutex<Ended>, writer: &mut impl Write, bytes: &[u8]) {
    let mut ended = stream.lock().unwrap_or_else(PoisonError::into_inner);
    if !ended.silent {
        ended.after(writer.write_all(bytes));
    }
}

/// Standard output as a writer that never fails: what cannot be written is told of by [`finish`].
pub(super) struct Output;

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        give(&OUTPUT, &mut io::stdout(), bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Results, for [`say`] and [`put`].
pub(super) fn result(text: fmt::Arguments<'_>, end: &str) {
    give(&OUTPUT, &mut io::stdout(), format!("{text}{end}").as_bytes());
}

/// Messages, for [`tell`].
pub(super) fn message(text: fmt::Arguments<'_>) {
    give(&MESSAGES, &mut io::stderr(), format!("{text}\n").as_bytes());
}

/// Writes what is still held back, and says whether a stream took less than all without its reader having left.
pub(super) fn finish() -> bool {
    let mut output = OUTPUT.lock().unwrap_or_else(PoisonError::into_inner);
    if !output.silent {
        output.after(io::stdout().flush());
    }
    let reason = output.reason.take();
    drop(output);
    if let Some(error) = &reason {
        message(format_args!("pantin: standard output takes no more: {error}; expected room for all results"));
    }
    reason.is_some() || MESSAGES.lock().unwrap_or_else(PoisonError::into_inner).reason.is_some()
}

/// A line of results on standard output.
macro_rules! say {
    ($($text:tt)*) => { $crate::command::output::result(format_args!($($text)*), "\n") };
}

/// Results on standard output, without the end of their line.
macro_rules! put {
    ($($text:tt)*) => { $crate::command::output::result(format_args!($($text)*), "") };
}

/// A line of messages on standard error.
macro_rules! tell {
    ($($text:tt)*) => { $crate::command::output::message(format_args!($($text)*)) };
}

pub(super) use {put, say, tell};

//! A program whose output is read: ffmpeg and ffprobe as other processes, ended with their readers.

use std::fmt;
use std::io::{BufRead, BufReader, ErrorKind};
use std::process::{Child, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use anyhow::{Context, Result, anyhow, bail};

/// Ends a decoder from another thread.
#[derive(Debug)]
pub(super) struct Stopper(Arc<Mutex<Child>>);

impl Stopper {
    pub(super) fn stop(&self) {
        // Fails only when the program has ended already.
        let _ = lock(&self.0).kill();
    }
}

/// A child is never left half changed, so a lock that a dying thread held is as good as any.
pub(super) fn lock(child: &Mutex<Child>) -> MutexGuard<'_, Child> {
    child.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A running program whose output we read; killed when dropped.
#[derive(Debug)]
pub(super) struct Process {
    pub(super) child: Arc<Mutex<Child>>,
    pub(super) output: ChildStdout,
    /// Drains what the program complains about, so that it never blocks on a full pipe, and keeps the last line.
    complaints: Option<JoinHandle<String>>,
    /// Lines it complained with.
    complained: Arc<AtomicU64>,
}

impl Process {
    pub(super) fn spawn(mut command: Command) -> Result<Self> {
        let program = command.get_program().to_string_lossy().into_owned();
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|error| missing_program(&program, &error))?;
        let (Some(output), Some(errors)) = (child.stdout.take(), child.stderr.take()) else {
            bail!("cannot read the output of `{program}`");
        };
        let complained = Arc::new(AtomicU64::new(0));
        let count = Arc::clone(&complained);
        let complaints = thread::spawn(move || {
            let mut last = String::new();
            let mut errors = BufReader::new(errors);
            let mut line = Vec::new();
            while errors.read_until(b'\n', &mut line).is_ok_and(|read| read > 0) {
                let text = String::from_utf8_lossy(&line).trim().to_string();
                if !text.is_empty() {
                    last = text;
                    count.fetch_add(1, Ordering::Relaxed);
                }
                line.clear();
            }
            last
        });
        Ok(Self { child: Arc::new(Mutex::new(child)), output, complaints: Some(complaints), complained })
    }

    /// What ends it from another thread.
    pub(super) fn stopper(&self) -> Stopper {
        Stopper(Arc::clone(&self.child))
    }

    /// Ends it when [`Watch::heard`] is not called for so long.
    ///
    /// # Errors
    /// When no thread can be started.
    pub(super) fn watch(&self, longest_silence: Duration) -> Result<Watch> {
        let (heard, hears) = channel();
        let stopper = self.stopper();
        let watch = move || loop {
            match hears.recv_timeout(longest_silence) {
                Ok(()) => {}
                Err(RecvTimeoutError::Disconnected) => return false,
                Err(RecvTimeoutError::Timeout) => {
                    stopper.stop();
                    return true;
                }
            }
        };
        let thread = thread::Builder::new().name("watch".into()).spawn(watch).context("cannot start a thread")?;
        Ok(Watch { heard: Some(heard), thread: Some(thread) })
    }

    /// The number of lines it has complained with so far, to read from another thread.
    pub(super) fn complained(&self) -> Arc<AtomicU64> {
        Arc::clone(&self.complained)
    }

    /// Ends the program (it normally has ended by itself) and says how it went.
    pub(super) fn finish(&mut self) -> Ended {
        // Its output is closed by now, so this waits for no more than the program's own farewell.
        let status = lock(&self.child).wait().ok();
        let last_line = self.complaints.take().and_then(|thread| thread.join().ok()).unwrap_or_default();
        Ended { status, last_line }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let mut child = lock(&self.child);
        // Both fail only when the program has ended already.
        let _ = child.kill();
        let _ = child.wait();
        drop(child);
        if let Some(thread) = self.complaints.take() {
            let _ = thread.join();
        }
    }
}

/// Ends a program that is silent for too long.
pub(super) struct Watch {
    /// Closed when the watch is over.
    heard: Option<Sender<()>>,
    thread: Option<JoinHandle<bool>>,
}

impl Watch {
    /// It has said something.
    pub(super) fn heard(&self) {
        if let Some(heard) = &self.heard {
            // Fails only when the program has been ended.
            let _ = heard.send(());
        }
    }

    /// Ends the watch and says whether it ended the program.
    pub(super) fn has_stopped_it(mut self) -> bool {
        drop(self.heard.take());
        self.thread.take().and_then(|thread| thread.join().ok()).unwrap_or(false)
    }
}

/// How a program ended, and the last line it complained with.
pub(super) struct Ended {
    status: Option<ExitStatus>,
    last_line: String,
}

impl Ended {
    pub(super) fn success(&self) -> bool {
        self.status.is_some_and(|status| status.success())
    }
}

impl fmt::Display for Ended {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.status, self.last_line.as_str()) {
            (Some(status), "") => write!(f, "ffmpeg gave no reason ({status})"),
            (None, "") => write!(f, "ffmpeg gave no reason"),
            (_, line) => write!(f, "ffmpeg says {line:?}"),
        }
    }
}

pub(super) fn missing_program(program: &str, error: &std::io::Error) -> anyhow::Error {
    if error.kind() == ErrorKind::NotFound {
        anyhow!(
            "the program `{program}` was not found, and videos are read with it: install ffmpeg (apt install ffmpeg, \
             brew install ffmpeg, winget install ffmpeg) so that it is on the PATH, or give pictures (frames/cam_%04d.png)"
        )
    } else {
        anyhow!("cannot start `{program}`: {error}")
    }
}

//! A port that others connect to.

use std::io::ErrorKind;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use anyhow::{Context, Result, anyhow};

/// Between two looks for somebody who connects.
const LOOK_INTERVAL: Duration = Duration::from_millis(10);

/// The thread that accepts connections. Dropping it ends it.
pub(super) struct Listener {
    address: SocketAddr,
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Listener {
    /// Listens on a port (0 for any that is free) and hands on who connects; `what` names it in messages.
    ///
    /// # Errors
    /// One sentence that begins with `what`: a host that is not known or not this machine, a port that is taken or reserved.
    pub(super) fn start(
        what: &str,
        host: &str,
        port: u16,
        mut take: impl FnMut(TcpStream) + Send + 'static,
    ) -> Result<Self> {
        let listener = TcpListener::bind((host, port)).map_err(|error| match error.kind() {
            ErrorKind::AddrInUse => anyhow!("{what}: port {port} is taken by another program, expected a free one"),
            ErrorKind::AddrNotAvailable => anyhow!(
                "{what}: {host} is no address of this machine, expected one to listen on: 127.0.0.1 for this machine alone, 0.0.0.0 \
                 for its network too"
            ),
            ErrorKind::PermissionDenied => anyhow!("{what}: port {port} is reserved, expected one from 1024 on"),
            _ => unknown_host(what, host, &error),
        })?;
        let cannot = || format!("{what}: cannot listen");
        let address = listener.local_addr().with_context(cannot)?;
        listener.set_nonblocking(true).with_context(cannot)?;
        let is_over = Arc::new(AtomicBool::new(false));
        let thread = {
            let is_over = Arc::clone(&is_over);
            thread::Builder::new().name("listen".to_string()).spawn(move || {
                while !is_over.load(Ordering::Relaxed) {
                    match listener.accept() {
                        // What accepts without waiting may hand on connections that do not wait either.
                        Ok((stream, _)) if stream.set_nonblocking(false).is_ok() => take(stream),
                        _ => thread::sleep(LOOK_INTERVAL),
                    }
                }
            })
        };
        Ok(Self { address, is_over, thread: Some(thread.with_context(cannot)?) })
    }

    /// Where it listens.
    pub(super) fn address(&self) -> SocketAddr {
        self.address
    }
}

impl Drop for Listener {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// The sentence for a host without an address.
pub(super) fn unknown_host(what: &str, host: &str, error: &std::io::Error) -> anyhow::Error {
    anyhow!(
        "{what}: the host `{host}` is not known ({error}), expected a name or a number that this machine can resolve"
    )
}

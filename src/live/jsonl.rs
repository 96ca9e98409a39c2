//! Poses as lines of JSON over TCP, to whoever is connected.

use std::net::TcpStream;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

use anyhow::Result;

use super::destination::Destination;
use super::listener::Listener;
use super::outlet::{Outgoing, Outlet, SentSummary};
use super::receiver::{Counts, Lines, make_ready, write_all};
use super::slot::Slot;

/// Lines that wait for a receiver: one or two seconds' worth.
const ROOM: usize = 64;
/// Receivers at a time; more are turned away.
const MOST_RECEIVERS: usize = 16;

/// Whoever is connected, a queue each.
type Receivers = Arc<Mutex<Vec<Receiver>>>;

struct Receiver {
    lines: Arc<Lines>,
    thread: JoinHandle<()>,
}

/// The lines of a run, for those who connect.
pub(super) struct LineServer {
    to: String,
    listener: Option<Listener>,
    receivers: Receivers,
    counts: Arc<Counts>,
}

impl LineServer {
    /// Listens on the address of a destination.
    ///
    /// # Errors
    /// As [`Listener::start`].
    pub(super) fn open(destination: &Destination) -> Result<Self> {
        let to = destination.to_string();
        let (receivers, counts) = (Receivers::default(), Arc::<Counts>::default());
        let listener = {
            let (receivers, counts) = (Arc::clone(&receivers), Arc::clone(&counts));
            let take = move |stream| receive(stream, &receivers, &counts);
            Listener::start(&to, &destination.host, destination.port, take)?
        };
        Ok(Self { to, listener: Some(listener), receivers, counts })
    }

    fn end(&mut self) {
        self.listener = None;
        let receivers = std::mem::take(&mut *lock(&self.receivers));
        receivers.iter().for_each(|receiver| receiver.lines.finish(Ok(())));
        for receiver in receivers {
            let _ = receiver.thread.join();
        }
    }
}

impl Outlet for LineServer {
    fn address(&self) -> String {
        let address = self.listener.as_ref().map_or_else(|| self.to.clone(), |listener| listener.address().to_string());
        format!("poses as lines of JSON: connect to {address} (TCP)")
    }

    fn send(&mut self, pose: &Outgoing<'_>) -> Result<()> {
        let mut receivers = lock(&self.receivers);
        if receivers.is_empty() {
            return Ok(());
        }
        let line = pose.line()?;
        receivers.retain(|receiver| match receiver.lines.put(Arc::clone(&line)) {
            Ok(passed_over) => {
                self.counts.dropped.fetch_add(u64::from(passed_over.is_some()), Ordering::Relaxed);
                true
            }
            // It is gone; its thread has ended by itself.
            Err(_) => false,
        });
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> SentSummary {
        self.end();
        self.counts.summary(&self.to)
    }
}

impl Drop for LineServer {
    fn drop(&mut self) {
        self.end();
    }
}

fn lock(receivers: &Receivers) -> MutexGuard<'_, Vec<Receiver>> {
    // A list of whole receivers whatever a thread died of.
    receivers.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Takes a receiver in, with a thread that writes to it.
fn receive(stream: TcpStream, receivers: &Receivers, counts: &Arc<Counts>) {
    let mut receivers = lock(receivers);
    receivers.retain(|receiver| !receiver.thread.is_finished());
    if receivers.len() >= MOST_RECEIVERS || !make_ready(&stream) {
        return;
    }
    let lines: Arc<Lines> = Arc::new(Slot::with_room(ROOM));
    let (queue, own) = (Arc::clone(&lines), Arc::clone(counts));
    if let Ok(thread) =
        thread::Builder::new().name("lines".to_string()).spawn(move || write_all(stream, &queue, &own, |_| true))
    {
        counts.receivers.fetch_add(1, Ordering::Relaxed);
        receivers.push(Receiver { lines, thread });
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufRead, BufReader};
    use std::net::SocketAddr;
    use std::time::{Duration, Instant};

    use super::*;
    use crate::body::Body;
    use crate::live::lines::Lines as Format;
    use crate::live::pose::tests::posed;

    fn server(destination: &str) -> Result<Box<LineServer>> {
        Ok(Box::new(LineServer::open(&destination.parse()?)?))
    }

    /// Connects, and waits until the server has so many receivers.
    fn connect(server: &LineServer, receivers: u64) -> TcpStream {
        let stream = TcpStream::connect(address(server)).unwrap();
        let begin = Instant::now();
        while server.counts.receivers.load(Ordering::Relaxed) < receivers {
            assert!(begin.elapsed() < Duration::from_secs(20), "nobody was taken in");
            thread::sleep(Duration::from_millis(1));
        }
        stream
    }

    fn address(server: &LineServer) -> SocketAddr {
        server.listener.as_ref().unwrap().address()
    }

    fn frames(stream: TcpStream) -> Vec<u64> {
        let lines = BufReader::new(stream).lines();
        lines
            .map(|line| serde_json::from_str::<serde_json::Value>(&line.unwrap()).unwrap()["frame"].as_u64().unwrap())
            .collect()
    }

    #[test]
    fn a_receiver_that_reads_nothing_holds_nobody_up() {
        const POSES: usize = 5000;
        let body = Body::adult(1750.0).unwrap();
        let lines = Format::new(&body);
        let mut server = server("jsonl://127.0.0.1:0").unwrap();
        assert!(server.address().contains(&address(&server).to_string()), "{}", server.address());
        let mut live = posed(&body, 0, body.standing_pose());
        server.send(&Outgoing::new(&live, &lines)).unwrap();
        let mute = connect(&server, 1);
        let quick = connect(&server, 2);
        let reader = thread::spawn(move || frames(quick));
        let mut longest = Duration::ZERO;
        for frame in 1..=POSES {
            live.frame = frame;
            let begin = Instant::now();
            server.send(&Outgoing::new(&live, &lines)).unwrap();
            longest = longest.max(begin.elapsed());
            if frame.is_multiple_of(32) {
                thread::sleep(Duration::from_millis(2));
            }
        }
        let SentSummary { to, receivers, sent, dropped } = server.finish();
        let frames = reader.join().unwrap();
        println!("{} lines to the quick one, {dropped} dropped, the longest send took {longest:?}", frames.len());
        assert_eq!((to.as_str(), receivers), ("jsonl://127.0.0.1:0", Some(2)));
        assert!(frames.is_sorted_by(|a, b| a < b) && frames.last() == Some(&(POSES as u64)), "{:?}", frames.last());
        assert_eq!(sent + dropped, 2 * POSES as u64, "every line went or was counted");
        assert!(dropped > POSES as u64 / 5 && frames.len() > POSES / 2, "{dropped} {}", frames.len());
        drop(mute);
    }

    #[test]
    fn receivers_come_and_go() {
        let body = Body::adult(1750.0).unwrap();
        let lines = Format::new(&body);
        let mut server = server("jsonl://localhost:0").unwrap();
        let mut live = posed(&body, 0, body.standing_pose());
        for round in 1..=3 {
            let stream = connect(&server, round);
            live.frame = round as usize;
            server.send(&Outgoing::new(&live, &lines)).unwrap();
            let mut line = String::new();
            BufReader::new(stream).read_line(&mut line).unwrap();
            assert!(line.starts_with(&format!("{{\"frame\":{round},")), "{line}");
            // The receiver leaves; what is sent until that is noticed goes nowhere.
            (0..3).for_each(|_| server.send(&Outgoing::new(&live, &lines)).unwrap());
        }
        let SentSummary { receivers, sent, dropped, .. } = server.finish();
        assert!(receivers == Some(3) && sent >= 3 && dropped == 0, "{receivers:?} {sent} {dropped}");
    }

    #[test]
    fn an_address_that_cannot_be_listened_on_is_a_sentence() {
        let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        let port = taken.local_addr().unwrap().port();
        for (destination, part) in [
            (
                format!("jsonl://127.0.0.1:{port}"),
                format!("port {port} is taken by another program, expected a free one"),
            ),
            ("jsonl://192.0.2.7:0".to_string(), "192.0.2.7 is no address of this machine".to_string()),
            ("jsonl://no-such-host.invalid:0".to_string(), "the host `no-such-host.invalid` is not known".to_string()),
        ] {
            let Err(error) = server(&destination) else { panic!("{destination} was opened") };
            let sentence = error.to_string();
            assert!(sentence.starts_with(&destination) && sentence.contains(&part), "{sentence}");
        }
    }
}

//! A page on this machine that shows a run at work: it listens on the loopback alone, can be read and nothing else, and gets poses as
//! server-sent events and the newest overlays as pictures.

mod http;

use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use anyhow::Result;

use self::http::Refusal;
use super::listener::Listener;
use super::outlet::{Outgoing, Outlet, SentSummary};
use super::receiver::{Counts, Lines, make_ready, write_all};
use super::slot::Slot;

/// How the event of a pose begins.
const POSE: &str = "event: pose";
/// Events that wait for a browser.
const ROOM: usize = 32;
/// Connections at a time.
const MOST_CONNECTIONS: usize = 32;
/// Between two sets of overlays.
const PICTURE_INTERVAL: Duration = Duration::from_millis(500);

/// The newest overlays, for whoever looks.
#[derive(Default)]
pub(crate) struct Board {
    /// The queues of the browsers that look.
    watchers: Mutex<Vec<Arc<Lines>>>,
    pictures: Mutex<Pictures>,
    connections: AtomicUsize,
    is_over: AtomicBool,
}

#[derive(Default)]
struct Pictures {
    /// A JPEG a view.
    views: Vec<Arc<[u8]>>,
    /// When the last were asked for.
    asked: Option<Instant>,
}

impl Board {
    /// Whether it is time for new overlays: somebody looks, and the last were asked for a while ago. Whoever hears yes makes them.
    pub(crate) fn wants_pictures(&self) -> bool {
        if lock(&self.watchers).is_empty() {
            return false;
        }
        let mut pictures = lock(&self.pictures);
        let is_time = pictures.asked.is_none_or(|asked| asked.elapsed() >= PICTURE_INTERVAL);
        if is_time {
            pictures.asked = Some(Instant::now());
        }
        is_time
    }

    /// Shows the overlays of a frame, a JPEG a view.
    pub(crate) fn show(&self, frame: usize, views: Vec<Vec<u8>>) {
        lock(&self.pictures).views = views.into_iter().map(Arc::from).collect();
        self.tell(&format!("event: views\ndata: {frame}\n\n").into());
    }

    /// Hands an event to every browser; how many lost an older one by it.
    fn tell(&self, event: &Arc<str>) -> u64 {
        let mut dropped = 0;
        lock(&self.watchers).retain(|watcher| match watcher.put(Arc::clone(event)) {
            Ok(passed_over) => {
                dropped += u64::from(passed_over.is_some());
                true
            }
            Err(_) => false,
        });
        dropped
    }
}

/// Everything behind these is whole whatever a thread died of.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The server of the page.
pub(crate) struct PageServer {
    url: String,
    board: Arc<Board>,
    counts: Arc<Counts>,
    listener: Option<Listener>,
    threads: Arc<Mutex<Vec<JoinHandle<()>>>>,
}

impl PageServer {
    /// Serves a page on a port of the loopback, 0 for any that is free.
    ///
    /// # Errors
    /// One sentence when the port is taken or reserved.
    pub(crate) fn open(port: u16, page: String) -> Result<Self> {
        let board = Arc::<Board>::default();
        let (counts, threads) = (Arc::<Counts>::default(), Arc::<Mutex<Vec<JoinHandle<()>>>>::default());
        let listener = {
            let (board, counts, threads) = (Arc::clone(&board), Arc::clone(&counts), Arc::clone(&threads));
            let page: Arc<str> = page.into();
            Listener::start(&format!("--live {port}"), "127.0.0.1", port, move |stream| {
                let (board, counts, page) = (Arc::clone(&board), Arc::clone(&counts), Arc::clone(&page));
                let mut threads = lock(&threads);
                threads.retain(|thread| !thread.is_finished());
                let work = move || {
                    let before = board.connections.fetch_add(1, Ordering::Relaxed);
                    // Who leaves in the middle of an answer is answered no further.
                    let _ = serve(stream, &board, &counts, &page, before < MOST_CONNECTIONS);
                    board.connections.fetch_sub(1, Ordering::Relaxed);
                };
                threads.extend(thread::Builder::new().name("page".to_string()).spawn(work));
            })?
        };
        let url = format!("http://{}/", listener.address());
        Ok(Self { url, board, counts, listener: Some(listener), threads })
    }

    /// Where overlays are shown.
    pub(crate) fn board(&self) -> Arc<Board> {
        Arc::clone(&self.board)
    }

    fn end(&mut self) {
        self.listener = None;
        self.board.is_over.store(true, Ordering::Relaxed);
        self.board.tell(&"event: end\ndata: 0\n\n".into());
        for watcher in std::mem::take(&mut *lock(&self.board.watchers)) {
            watcher.finish(Ok(()));
        }
        for thread in std::mem::take(&mut *lock(&self.threads)) {
            let _ = thread.join();
        }
    }
}

impl Outlet for PageServer {
    fn address(&self) -> String {
        format!("live page: {}", self.url)
    }

    fn send(&mut self, pose: &Outgoing<'_>) -> Result<()> {
        if lock(&self.board.watchers).is_empty() {
            return Ok(());
        }
        let event = format!("{POSE}\ndata: {}\n", pose.line()?).into();
        self.counts.dropped.fetch_add(self.board.tell(&event), Ordering::Relaxed);
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> SentSummary {
        self.end();
        self.counts.summary(&self.url)
    }
}

impl Drop for PageServer {
    fn drop(&mut self) {
        self.end();
    }
}

/// Answers a connection's one request.
fn serve(mut stream: TcpStream, board: &Board, counts: &Counts, page: &str, has_room: bool) -> std::io::Result<()> {
    let port = stream.local_addr()?.port();
    stream.set_write_timeout(Some(Duration::from_secs(5)))?;
    let path = match http::read_request(&mut stream, port, &board.is_over)? {
        Ok(path) if has_room => path,
        Ok(_) => return http::refuse(&mut stream, Refusal::Busy),
        Err(refusal) => return http::refuse(&mut stream, refusal),
    };
    match path.as_str() {
        "/" => http::answer(&mut stream, "text/html; charset=utf-8", page.as_bytes()),
        "/events" => {
            http::begin_events(&mut stream)?;
            if make_ready(&stream) {
                let events: Arc<Lines> = Arc::new(Slot::with_room(ROOM));
                let mut watchers = lock(&board.watchers);
                if board.is_over.load(Ordering::Relaxed) {
                    return Ok(());
                }
                watchers.push(Arc::clone(&events));
                drop(watchers);
                counts.receivers.fetch_add(1, Ordering::Relaxed);
                write_all(stream, &events, counts, |event| event.starts_with(POSE));
            }
            Ok(())
        }
        other => {
            let view = other.strip_prefix("/view/").and_then(|view| view.parse::<usize>().ok());
            let picture = view.and_then(|view| lock(&board.pictures).views.get(view).cloned());
            match picture {
                Some(picture) => http::answer(&mut stream, "image/jpeg", &picture),
                None => http::refuse(&mut stream, Refusal::Unknown),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufRead, BufReader, Read, Write};

    use super::*;
    use crate::body::Body;
    use crate::live::lines::Lines as Format;
    use crate::live::pose::tests::posed;

    fn address(server: &PageServer) -> std::net::SocketAddr {
        server.listener.as_ref().unwrap().address()
    }

    fn ask(server: &PageServer, method: &str, path: &str, host: &str) -> TcpStream {
        let mut stream = TcpStream::connect(address(server)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        write!(stream, "{method} {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        stream
    }

    fn answer(server: &PageServer, method: &str, path: &str, host: &str) -> String {
        let mut bytes = Vec::new();
        ask(server, method, path, host).read_to_end(&mut bytes).unwrap();
        String::from_utf8_lossy(&bytes).into_owned()
    }

    #[test]
    fn the_page_is_read_and_nothing_else() {
        let server = PageServer::open(0, "<p>page</p>".to_string()).unwrap();
        let own = address(&server).to_string();
        assert!(address(&server).ip().is_loopback(), "{own}");
        let page = answer(&server, "GET", "/", &own);
        assert!(page.starts_with("HTTP/1.1 200 OK\r\n") && page.ends_with("\r\n\r\n<p>page</p>"), "{page}");
        assert!(
            page.contains("Content-Security-Policy: default-src 'none'") && !page.contains("Access-Control"),
            "{page}"
        );
        let begins = |text: String, with: &str| assert!(text.starts_with(with), "{text}");
        begins(answer(&server, "POST", "/", &own), "HTTP/1.1 405 Method Not Allowed\r\nAllow: GET\r\n");
        begins(answer(&server, "DELETE", "/view/0", &own), "HTTP/1.1 405 ");
        begins(answer(&server, "GET", "/", "rebound.example"), "HTTP/1.1 403 Forbidden");
        begins(answer(&server, "GET", "/events", "rebound.example"), "HTTP/1.1 403 Forbidden");
        begins(answer(&server, "GET", "/etc/passwd", &own), "HTTP/1.1 404 Not Found");
        begins(answer(&server, "GET", "/view/../0", &own), "HTTP/1.1 404 Not Found");
        begins(answer(&server, "GET", "/view/0", &own), "HTTP/1.1 404 Not Found");
        server.board.show(7, vec![b"jpeg".to_vec()]);
        assert!(answer(&server, "GET", "/view/0?7", &own).ends_with("\r\n\r\njpeg"));
        begins(answer(&server, "GET", "/view/1", &own), "HTTP/1.1 404 Not Found");
    }

    #[test]
    fn events_come_while_the_run_goes_on_and_end_with_it() {
        let body = Body::adult(1750.0).unwrap();
        let format = Format::new(&body);
        let mut server = Box::new(PageServer::open(0, String::new()).unwrap());
        assert!(!server.board.wants_pictures(), "nobody looks");
        let own = address(&server).to_string();
        let mut events = BufReader::new(ask(&server, "GET", "/events", &own)).lines();
        while !server.board.wants_pictures() {
            thread::sleep(Duration::from_millis(1));
        }
        assert!(!server.board.wants_pictures(), "not again so soon");
        let live = posed(&body, 3, body.standing_pose());
        server.send(&Outgoing::new(&live, &format)).unwrap();
        server.board.show(3, vec![Vec::new()]);
        let mut next = |with: &str| loop {
            let line = events.next().unwrap().unwrap();
            if line.starts_with(with) {
                return line;
            }
        };
        next("Content-Type: text/event-stream");
        next("event: pose");
        let line = next("data: ");
        let read: serde_json::Value = serde_json::from_str(line.strip_prefix("data: ").unwrap()).unwrap();
        assert_eq!(read["frame"], 3);
        next("event: views");
        assert_eq!(next("data: "), "data: 3");
        let summary = server.finish();
        next("event: end");
        assert_eq!((summary.receivers, summary.sent, summary.dropped), (Some(1), 1, 0), "{summary:?}");
    }

    #[test]
    fn a_taken_port_is_a_sentence() {
        let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        let port = taken.local_addr().unwrap().port();
        let Err(error) = PageServer::open(port, String::new()) else { panic!("it is taken") };
        let expected = format!("--live {port}: port {port} is taken by another program, expected a free one");
        assert_eq!(error.to_string(), expected);
    }
}

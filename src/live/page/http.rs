//! As much of HTTP as a page on this machine needs: the head of a request read and judged, an answer written. The head is taken apart by
//! httparse; servers that come as a crate keep back what is streamed until a buffer is full, or bring a run-time of their own.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Longest head of a request, bytes.
const LONGEST_HEAD: usize = 16 * 1024;
/// Most lines of a head.
const MOST_HEADERS: usize = 64;
/// How long a request may take to arrive.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(5);
/// How long is waited for more of it before it is looked whether the run is over: browsers connect ahead of what they may ask.
const PATIENCE: Duration = Duration::from_millis(100);

/// Why a request is not answered as it hopes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    /// What came is no request.
    Malformed,
    /// It asks by another name than this machine's: a page from elsewhere whose name was made to lead here.
    OtherHost,
    /// Nothing can be changed here.
    OtherMethod,
    /// There is nothing of that name.
    Unknown,
    /// Too many ask at a time.
    Busy,
}

impl Refusal {
    fn status(self) -> &'static str {
        match self {
            Self::Malformed => "400 Bad Request",
            Self::OtherHost => "403 Forbidden",
            Self::OtherMethod => "405 Method Not Allowed\r\nAllow: GET",
            Self::Unknown => "404 Not Found",
            Self::Busy => "503 Service Unavailable",
        }
    }

    fn sentence(self) -> &'static str {
        match self {
            Self::Malformed => "This is no request of HTTP/1.1.\n",
            Self::OtherHost => "This page is for this machine alone: ask for 127.0.0.1 or localhost.\n",
            Self::OtherMethod => "This page can be read, and nothing else: ask with GET.\n",
            Self::Unknown => "There is nothing of that name here.\n",
            Self::Busy => "Too many are looking at once.\n",
        }
    }
}

/// Reads a request that is to be answered: what it asks for, without a query.
///
/// # Errors
/// Outside when the connection fails, inside when the request is refused.
pub(super) fn read_request(
    stream: &mut TcpStream,
    port: u16,
    is_over: &AtomicBool,
) -> io::Result<Result<String, Refusal>> {
    stream.set_read_timeout(Some(PATIENCE))?;
    let begin = Instant::now();
    let mut head = Vec::new();
    let mut piece = [0; 2048];
    while !head.windows(4).any(|end| end == b"\r\n\r\n") {
        let count = match stream.read(&mut piece) {
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                if begin.elapsed() > REQUEST_TIMEOUT || is_over.load(Ordering::Relaxed) {
                    return Err(error);
                }
                continue;
            }
            read => read?,
        };
        if count == 0 || head.len() + count > LONGEST_HEAD {
            return Ok(Err(Refusal::Malformed));
        }
        head.extend_from_slice(&piece[..count]);
    }
    Ok(asked_for(&head, port))
}

/// What the head of a request asks for.
fn asked_for(head: &[u8], port: u16) -> Result<String, Refusal> {
    let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
    let mut request = httparse::Request::new(&mut headers);
    match request.parse(head) {
        Ok(httparse::Status::Complete(_)) => {}
        _ => return Err(Refusal::Malformed),
    }
    let hosts: Vec<&[u8]> =
        request.headers.iter().filter(|header| header.name.eq_ignore_ascii_case("host")).map(|it| it.value).collect();
    let [host] = hosts.as_slice() else { return Err(Refusal::Malformed) };
    let own = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}"));
    if !own.iter().any(|own| own.as_bytes().eq_ignore_ascii_case(host)) {
        return Err(Refusal::OtherHost);
    }
    if request.method != Some("GET") {
        return Err(Refusal::OtherMethod);
    }
    let path = request.path.ok_or(Refusal::Malformed)?;
    Ok(path.split('?').next().unwrap_or_default().to_string())
}

/// Lines of every head: nothing is kept, guessed, framed or fetched from elsewhere.
const ALWAYS: &str = "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
    Cross-Origin-Resource-Policy: same-origin\r\nContent-Security-Policy: default-src 'none'; img-src 'self'; connect-src 'self'; \
    style-src 'unsafe-inline'; script-src 'unsafe-inline'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'\r\n\
    Connection: close\r\n";

/// Writes a whole answer.
///
/// # Errors
/// When the connection fails.
pub(super) fn answer(stream: &mut TcpStream, kind: &str, body: &[u8]) -> io::Result<()> {
    let head = format!("HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n{ALWAYS}\r\n", body.len());
    stream.write_all(head.as_bytes())?;
    stream.write_all(body)
}

/// Writes the head of an answer that goes on.
///
/// # Errors
/// When the connection fails.
pub(super) fn begin_events(stream: &mut TcpStream) -> io::Result<()> {
    let head = format!("HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\n{ALWAYS}\r\nretry: 1000\n\n");
    stream.write_all(head.as_bytes())
}

/// Writes why there is no answer.
///
/// # Errors
/// When the connection fails.
pub(super) fn refuse(stream: &mut TcpStream, refusal: Refusal) -> io::Result<()> {
    let (status, sentence) = (refusal.status(), refusal.sentence());
    let kind = "text/plain; charset=utf-8";
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n{ALWAYS}\r\n{sentence}",
        sentence.len()
    );
    stream.write_all(head.as_bytes())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn only_this_machine_is_answered() {
        let asked = |head: &str| asked_for(head.replace('\n', "\r\n").as_bytes(), 8123);
        assert_eq!(asked("GET /view/0?7 HTTP/1.1\nHost: 127.0.0.1:8123\n\n"), Ok("/view/0".to_string()));
        assert_eq!(asked("GET / HTTP/1.1\nhost: LOCALHOST:8123\nX: y\n\n"), Ok("/".to_string()));
        for (head, refusal) in [
            ("GET / HTTP/1.1\nHost: evil.example:8123\n\n", Refusal::OtherHost),
            ("GET / HTTP/1.1\nHost: 127.0.0.1\n\n", Refusal::OtherHost),
            ("GET / HTTP/1.1\nHost: 127.0.0.1:81230\n\n", Refusal::OtherHost),
            ("POST / HTTP/1.1\nHost: evil.example:8123\n\n", Refusal::OtherHost),
            ("GET / HTTP/1.1\n\n", Refusal::Malformed),
            ("GET / HTTP/1.1\nHost: 127.0.0.1:8123\nHost: localhost:8123\n\n", Refusal::Malformed),
            ("POST / HTTP/1.1\nHost: 127.0.0.1:8123\n\n", Refusal::OtherMethod),
            ("HEAD / HTTP/1.1\nHost: 127.0.0.1:8123\n\n", Refusal::OtherMethod),
            ("OPTIONS * HTTP/1.1\nHost: 127.0.0.1:8123\n\n", Refusal::OtherMethod),
            ("hello\n\n", Refusal::Malformed),
        ] {
            assert_eq!(asked(head), Err(refusal), "{head}");
        }
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            let _ = asked_for(&bytes, 80);
        }
    }
}

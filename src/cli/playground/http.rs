//! As much of HTTP/1.1 as a page of this machine needs: one request a connection, small, and of no
//! other origin.

use std::io::{self, Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

pub(super) const PAGE: &str = "text/html; charset=utf-8";
pub(super) const SCRIPT: &str = "text/javascript; charset=utf-8";
pub(super) const STYLE: &str = "text/css; charset=utf-8";
pub(super) const JSON: &str = "application/json";
pub(super) const PLAIN: &str = "text/plain; charset=utf-8";
const BYTES: &str = "application/octet-stream";

/// Bytes of a request before its body.
const MOST_HEAD: usize = 16 << 10;
/// Its headers.
const MOST_HEADERS: usize = 64;
/// Connections that are answered at the same time; others wait in the system's queue.
const MOST_CONNECTIONS: usize = 32;
/// Who says nothing for so long has gone.
const PATIENCE: Duration = Duration::from_secs(10);

/// A request.
pub(super) struct Asked<'a> {
    pub(super) method: &'a str,
    /// The target, without what follows a question mark.
    pub(super) path: &'a str,
    pub(super) body: &'a [u8],
}

/// What is answered.
pub(super) struct Answer {
    status: &'static str,
    kind: &'static str,
    body: Vec<u8>,
}

impl Answer {
    pub(super) fn text(kind: &'static str, text: &str) -> Self {
        Self {
            status: "200 OK",
            kind,
            body: text.as_bytes().to_vec(),
        }
    }

    pub(super) fn bytes(body: Vec<u8>) -> Self {
        Self {
            status: "200 OK",
            kind: BYTES,
            body,
        }
    }

    /// There is one, and nothing in it.
    pub(super) fn empty() -> Self {
        Self::refused("204 No Content")
    }

    /// There is no such thing.
    pub(super) fn none() -> Self {
        Self::refused("404 Not Found")
    }

    /// The request makes no sense.
    pub(super) fn wrong() -> Self {
        Self::refused("400 Bad Request")
    }

    fn refused(status: &'static str) -> Self {
        Self {
            status,
            kind: PLAIN,
            body: Vec::new(),
        }
    }
}

/// Answers until the program ends, each connection on a thread with so much stack; bodies have at most
/// `most` bytes.
pub(super) fn serve(
    listener: &TcpListener,
    port: u16,
    stack: usize,
    most: usize,
    answer: &(dyn Fn(&Asked<'_>) -> Answer + Sync),
) {
    let open = AtomicUsize::new(0);
    std::thread::scope(|threads| {
        // A browser that hangs up is no reason to stop.
        for stream in listener.incoming().flatten() {
            while open.load(Ordering::Acquire) >= MOST_CONNECTIONS {
                std::thread::sleep(Duration::from_millis(5));
            }
            open.fetch_add(1, Ordering::AcqRel);
            let open = &open;
            let work = move || {
                let _ = converse(&stream, port, most, answer);
                open.fetch_sub(1, Ordering::AcqRel);
            };
            let builder = std::thread::Builder::new().stack_size(stack);
            if builder.spawn_scoped(threads, work).is_err() {
                open.fetch_sub(1, Ordering::AcqRel);
            }
        }
    });
}

fn converse(
    mut stream: &TcpStream,
    port: u16,
    most: usize,
    answer: &dyn Fn(&Asked<'_>) -> Answer,
) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let said = heard(&mut stream, port, most, answer)?;
    let Answer { status, kind, body } = said;
    // Nothing from elsewhere, and nobody else shows the page in theirs.
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
         Connection: close\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
         Cross-Origin-Resource-Policy: same-origin\r\nContent-Security-Policy: default-src 'self'; \
         style-src 'self' 'unsafe-inline'; img-src 'self' blob: data:; frame-ancestors 'none'\r\n\r\n",
        body.len()
    )?;
    stream.write_all(&body)?;
    stream.flush()
}

fn heard(
    stream: &mut &TcpStream,
    port: u16,
    most: usize,
    answer: &dyn Fn(&Asked<'_>) -> Answer,
) -> io::Result<Answer> {
    let mut bytes = Vec::new();
    let mut room = [0; 8 << 10];
    loop {
        let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
        let mut request = httparse::Request::new(&mut headers);
        let head = match request.parse(&bytes) {
            Ok(httparse::Status::Complete(head)) => head,
            Ok(httparse::Status::Partial) if bytes.len() < MOST_HEAD => {
                let read = stream.read(&mut room)?;
                if read == 0 {
                    return Ok(Answer::wrong());
                }
                bytes.extend_from_slice(&room[..read]);
                continue;
            }
            _ => return Ok(Answer::wrong()),
        };
        let header = |name: &str| {
            let mut found = request.headers.iter();
            let found = found.find(|header| header.name.eq_ignore_ascii_case(name))?;
            std::str::from_utf8(found.value).ok()
        };
        if !is_own(header("host"), header("origin"), port) {
            return Ok(Answer::refused("403 Forbidden"));
        }
        let length = header("content-length").unwrap_or("0").parse::<usize>();
        let Ok(length) = length else {
            return Ok(Answer::wrong());
        };
        if length > most {
            return Ok(Answer::refused("413 Content Too Large"));
        }
        let (Some(method), Some(target)) = (request.method, request.path) else {
            return Ok(Answer::wrong());
        };
        let [method, target] = [method, target].map(str::to_owned);
        let mut body = bytes.split_off(head);
        let missing = length.saturating_sub(body.len());
        body.truncate(length);
        let read = stream.take(missing as u64).read_to_end(&mut body)?;
        if read < missing {
            return Ok(Answer::wrong());
        }
        return Ok(answer(&Asked {
            method: &method,
            path: target.split('?').next().unwrap_or_default(),
            body: &body,
        }));
    }
}

/// Whether a request is for this machine by its own name, and from a page that it served. Another
/// site's page may send requests here, and its name may lead here.
fn is_own(host: Option<&str>, origin: Option<&str>, port: u16) -> bool {
    let hosts = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    let known = |name: &str| hosts.iter().any(|host| host == name);
    let from = |origin: &str| origin.strip_prefix("http://").is_some_and(known);
    host.is_some_and(known) && origin.is_none_or(from)
}

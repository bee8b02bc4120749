//! The part of HTTP/1.1 that a page on this machine needs: one small request per connection, and none
//! of another origin.

use std::io::{self, Read as _, Write as _};
use std::net::{Ipv4Addr, Ipv6Addr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

pub(super) const PAGE: &str = "text/html; charset=utf-8";
pub(super) const SCRIPT: &str = "text/javascript; charset=utf-8";
pub(super) const STYLE: &str = "text/css; charset=utf-8";
pub(super) const JSON: &str = "application/json";
pub(super) const PLAIN: &str = "text/plain; charset=utf-8";
const BYTES: &str = "application/octet-stream";

/// Most bytes of a request before its body.
const MOST_HEAD: usize = 16 << 10;
/// Most headers of a request.
const MOST_HEADERS: usize = 64;
/// Most connections that are answered at the same time; others wait in the system's queue.
const MOST_CONNECTIONS: usize = 32;
/// Time without a byte after which a connection counts as gone.
const PATIENCE: Duration = Duration::from_secs(10);

/// A request to answer.
pub(super) struct Asked<'a> {
    pub(super) method: &'a str,
    /// The target, without its query string.
    pub(super) path: &'a str,
    pub(super) body: &'a [u8],
}

/// The response to a request.
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

    /// Returns the response for a resource without content.
    pub(super) fn empty() -> Self {
        Self::refused("204 No Content")
    }

    /// Returns the response for a resource that does not exist.
    pub(super) fn not_found() -> Self {
        Self::refused("404 Not Found")
    }

    /// Returns the response for a malformed request.
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

/// Answers requests until the program ends. Each connection runs on a thread with a stack of `stack` bytes;
/// bodies have at most `most` bytes.
pub(super) fn serve(
    listener: &TcpListener,
    port: u16,
    stack: usize,
    most: usize,
    answer: &(dyn Fn(&Asked<'_>) -> Answer + Sync),
) {
    let open = AtomicUsize::new(0);
    std::thread::scope(|threads| {
        // A failed connection does not stop the server.
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
    // The page loads nothing from elsewhere, and no other page may frame it.
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
        let headers = |name: &'static str| {
            let all = request.headers.iter();
            let named = all.filter(move |header| header.name.eq_ignore_ascii_case(name));
            named.map(|header| header.value)
        };
        if !is_own(headers("host"), headers("origin"), port) {
            return Ok(Answer::refused("403 Forbidden"));
        }
        let header = |name| {
            let value = headers(name).next()?;
            std::str::from_utf8(value).ok()
        };
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

/// Port of `http://` URLs that name none: browsers leave it out of `Host` and `Origin`.
const DEFAULT_PORT: u16 = 80;

/// True if a request names this server as its host, exactly once, and comes from no page but this
/// server's. A page of another site may send requests here, and the name of another site may resolve
/// to this machine (DNS rebinding), so the server trusts no name other than `localhost`.
fn is_own<'a>(
    mut hosts: impl Iterator<Item = &'a [u8]>,
    mut origins: impl Iterator<Item = &'a [u8]>,
    port: u16,
) -> bool {
    let known = |name: &[u8]| std::str::from_utf8(name).is_ok_and(|name| is_here(name, port));
    let from = |origin: &[u8]| {
        let (scheme, host) = origin.split_at_checked(7).unwrap_or_default();
        scheme.eq_ignore_ascii_case(b"http://") && known(host)
    };
    let (host, second) = (hosts.next(), hosts.next());
    host.is_some_and(known) && second.is_none() && origins.all(from)
}

/// True if `authority`, as `host` or `host:port`, is this machine at `port`: `localhost` or a loopback
/// address, in the spellings that RFC 3986 (3.2.2, 6.2.3) has for one host.
fn is_here(authority: &str, port: u16) -> bool {
    let bracketed = authority.strip_prefix('[');
    let (host, after) =
        if let Some((address, after)) = bracketed.and_then(|rest| rest.split_once(']')) {
            let address = address.parse::<Ipv6Addr>();
            (address.is_ok_and(|address| address.is_loopback()), after)
        } else {
            let name = &authority[..authority.find(':').unwrap_or(authority.len())];
            let after = &authority[name.len()..];
            let name = name.strip_suffix('.').unwrap_or(name);
            let address = name.parse::<Ipv4Addr>();
            let is_loopback = address.is_ok_and(|address| address.is_loopback());
            (is_loopback || name.eq_ignore_ascii_case("localhost"), after)
        };
    let digits = after.strip_prefix(':').or(after.is_empty().then_some(""));
    let asked = match digits {
        Some("") => Some(DEFAULT_PORT),
        Some(digits) if digits.bytes().all(|digit| digit.is_ascii_digit()) => digits.parse().ok(),
        _ => None,
    };
    host && asked == Some(port)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answered(host: &str, origin: Option<&str>, port: u16) -> bool {
        let hosts = std::iter::once(host.as_bytes());
        is_own(hosts, origin.into_iter().map(str::as_bytes), port)
    }

    /// The WHATWG URL standard serialises a host and an origin without the scheme's default port.
    #[test]
    fn browsers_that_leave_port_80_out_are_answered() {
        for host in ["127.0.0.1", "localhost", "LocalHost", "localhost.", "[::1]"] {
            let origin = format!("http://{host}");
            assert!(answered(host, None, 80), "{host}");
            assert!(answered(host, Some(&origin), 80), "{host}");
            assert!(answered(&format!("{host}:80"), Some(&origin), 80), "{host}");
            assert!(answered(&format!("{host}:"), Some(&origin), 80), "{host}");
            // A name without a port means port 80, and no other.
            assert!(!answered(host, None, 8000), "{host}");
            assert!(
                !answered(&format!("{host}:8000"), Some(&origin), 8000),
                "{host}"
            );
        }
    }

    #[test]
    fn this_machine_has_several_names_at_any_port() {
        for host in [
            "127.0.0.1:8000",
            "localhost:8000",
            "LOCALHOST:8000",
            "localhost.:8000",
            "127.0.0.1.:8000",
            "[::1]:8000",
            "[0:0:0:0:0:0:0:1]:8000",
        ] {
            assert!(answered(host, None, 8000), "{host}");
            assert!(
                answered(host, Some(&format!("http://{host}")), 8000),
                "{host}"
            );
            assert!(
                answered(host, Some(&format!("HTTP://{host}")), 8000),
                "{host}"
            );
            assert!(
                !answered(host, Some(&format!("https://{host}")), 8000),
                "{host}"
            );
            assert!(!answered(host, None, 80), "{host}");
        }
    }

    #[test]
    fn names_that_others_may_own_are_refused() {
        for host in [
            "",
            ":80",
            ".",
            "..",
            "example.org",
            "localhost.example.org",
            "evil.localhost",
            "127.0.0.1.example.org",
            "localhost..",
            "localhost@example.org",
            "localhost:80:80",
            "localhost:+80",
            "localhost:080x",
            "localhost:65616",
            "0.0.0.0",
            "10.0.0.1",
            "127.1",
            "[::]",
            "[::1",
            "::1",
            "[::1]x",
            "[::1].:80",
            "[::1%1]",
            "[example.org]",
            " localhost",
        ] {
            assert!(!answered(host, None, 80), "{host:?}");
            let origin = format!("http://{host}");
            assert!(!answered("localhost", Some(&origin), 80), "{host:?}");
        }
        for origin in [
            "null",
            "",
            "localhost",
            "http:/localhost",
            "file://",
            "ftp://localhost",
        ] {
            assert!(!answered("localhost", Some(origin), 80), "{origin:?}");
        }
        let none = std::iter::empty::<&[u8]>;
        let own = || std::iter::once(&b"localhost"[..]);
        assert!(is_own(own(), none(), 80));
        assert!(!is_own(none(), none(), 80));
        assert!(!is_own(own().chain([&b"example.org"[..]]), none(), 80));
        assert!(!is_own(own(), std::iter::once(&b"http://\xff"[..]), 80));
        let both = [&b"http://localhost"[..], b"http://example.org"];
        assert!(!is_own(own(), both.into_iter(), 80));
    }
}

//! Serves the book over HTTP, on this machine alone: browsers do not load modules from files.

use crate::check::decoded;
use anyhow::Result;
use std::io::{BufRead as _, BufReader, ErrorKind, Write as _};
use std::net::{TcpListener, TcpStream};
use std::path::{Component, Path};

/// Serves a folder until it is interrupted.
pub(crate) fn serve(folder: &Path, port: u16) -> Result<()> {
    let listener = listen(port)?;
    println!("http://{}/ (Ctrl-C ends it)", listener.local_addr()?);
    answer_all(&listener, folder);
    Ok(())
}

/// Answers all requests for files of a folder, each in a thread of its own, until the process ends.
pub(crate) fn answer_all(listener: &TcpListener, folder: &Path) {
    // A failed connection does not stop the server.
    for stream in listener.incoming().flatten() {
        let folder = folder.to_owned();
        std::thread::spawn(move || {
            let _ = answer(&stream, &folder);
        });
    }
}

/// Opens a port of this machine; 0 is any free one.
pub(crate) fn listen(port: u16) -> Result<TcpListener> {
    TcpListener::bind(("127.0.0.1", port)).map_err(|error| {
        let what = match error.kind() {
            ErrorKind::AddrInUse => {
                format!("port {port} is taken: `cargo book serve PORT` takes another")
            }
            _ => format!("cannot listen on port {port}"),
        };
        anyhow::Error::new(error).context(what)
    })
}

fn answer(mut stream: &TcpStream, folder: &Path) -> std::io::Result<()> {
    let mut lines = BufReader::new(stream).lines();
    let request = lines.next().transpose()?.unwrap_or_default();
    while lines
        .next()
        .transpose()?
        .is_some_and(|line| !line.is_empty())
    {}
    let found = asked(&request).and_then(|path| {
        let content = std::fs::read(folder.join(&path)).ok()?;
        Some((path, content))
    });
    let Some((path, content)) = found else {
        return write!(
            stream,
            "HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"
        );
    };
    write!(
        stream,
        "HTTP/1.1 200 OK\r\nContent-Type: {}\r\nContent-Length: {}\r\n\
         Cache-Control: no-store\r\nConnection: close\r\n\r\n",
        kind(&path),
        content.len()
    )?;
    stream.write_all(&content)
}

/// Returns the path of the requested file below the served folder; `None` if it would be elsewhere.
fn asked(request: &str) -> Option<String> {
    let target = request.strip_prefix("GET ")?.split(' ').next()?;
    let path = decoded(target.split(['?', '#']).next()?);
    let path = path.trim_start_matches('/');
    let inside = Path::new(path)
        .components()
        .all(|part| matches!(part, Component::Normal(_)));
    if !inside {
        return None;
    }
    if path.is_empty() || path.ends_with('/') {
        Some(format!("{path}index.html"))
    } else {
        Some(path.to_owned())
    }
}

fn kind(path: &str) -> &'static str {
    match path.rsplit('.').next().unwrap_or_default() {
        "html" => "text/html; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "json" => "application/json",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "woff2" => "font/woff2",
        "wasm" => "application/wasm",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read as _;

    /// Returns the answer of a folder's server to a request line.
    fn answered(folder: &Path, request: &str) -> String {
        let listener = listen(0).unwrap();
        let mut client = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        write!(client, "{request}\r\nHost: x\r\n\r\n").unwrap();
        let (server, _) = listener.accept().unwrap();
        answer(&server, folder).unwrap();
        drop(server);
        let mut text = String::new();
        client.read_to_string(&mut text).unwrap();
        text
    }

    #[test]
    fn files_of_the_folder_are_served_and_no_others() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("book");
        std::fs::create_dir_all(folder.join("a b")).unwrap();
        for (name, text) in [
            ("secret.html", "secret"),
            ("book/index.html", "top"),
            ("book/a b/index.html", "inner"),
            ("book/a b/café.html", "coffee"),
        ] {
            std::fs::write(root.path().join(name), text).unwrap();
        }
        for (target, text) in [
            ("/", "top"),
            ("/index.html?x=1#y", "top"),
            ("/a%20b/", "inner"),
            ("/a%20b/caf%C3%A9.html", "coffee"),
        ] {
            let said = answered(&folder, &format!("GET {target} HTTP/1.1"));
            assert!(said.starts_with("HTTP/1.1 200 OK\r\nContent-Type: text/html"));
            assert!(said.ends_with(&format!("\r\n\r\n{text}")), "{said}");
        }
        for request in [
            "GET /../secret.html HTTP/1.1",
            "GET /%2e%2e/secret.html HTTP/1.1",
            "GET /..%2Fsecret.html HTTP/1.1",
            "GET /a%20b/../../secret.html HTTP/1.1",
            "GET /none.html HTTP/1.1",
            "GET /index.html%00 HTTP/1.1",
            "POST /index.html HTTP/1.1",
            "",
        ] {
            let said = answered(&folder, request);
            assert!(said.starts_with("HTTP/1.1 404 "), "{request}: {said}");
        }
    }

    #[test]
    fn what_is_outside_is_not_even_looked_for() {
        for target in ["/../x", "/%2e%2e/x", "/..%2fx", "/a/../x", "/a/%2E./x"] {
            assert_eq!(asked(&format!("GET {target} HTTP/1.1")), None, "{target}");
        }
        // Escapes are decoded only once, and no path begins at the file system's root.
        for (target, path) in [("/%252e/x", "%2e/x"), ("//etc/passwd", "etc/passwd")] {
            let asked = asked(&format!("GET {target} HTTP/1.1"));
            assert_eq!(asked.as_deref(), Some(path));
        }
    }

    #[test]
    fn a_port_is_said_to_be_taken_if_it_is() {
        let first = listen(0).unwrap();
        let port = first.local_addr().unwrap().port();
        let error = listen(port).unwrap_err();
        let expected = format!("port {port} is taken: `cargo book serve PORT` takes another");
        assert_eq!(error.to_string(), expected);
    }
}

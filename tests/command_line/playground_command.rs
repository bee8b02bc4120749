//! Tests of `qrt playground`: its responses, and the requests that it refuses.

use crate::common::command::Folder;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Child, Stdio};

const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const SCENE: &str = "
name: \"tri\u{e4}ngle\"
camera: { perspective: { eye: [0.3, 0.3, 3], target: [0.3, 0.3, 0], vfov: 40 } }
film: { width: 4, height: 4 }
materials: { lamp: { emitter: { radiance: [1, 0.5, 0.25] } } }
geometry: [{ mesh: { obj: part.obj, material: lamp } }]
sampling: { path_bits: 4 }
";

/// The running command.
struct Served {
    child: Child,
    port: u16,
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A status, and a body.
type Response = (u16, Vec<u8>);

impl Served {
    fn new(folder: &Folder, arguments: &[&str]) -> Self {
        let mut command = folder.command(&[&["playground"], arguments].concat());
        let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        let out = child.stdout.take().unwrap();
        BufReader::new(out).read_line(&mut line).unwrap();
        let port = line
            .strip_prefix("http://127.0.0.1:")
            .and_then(|rest| rest.split('/').next()?.parse().ok());
        let port = port.unwrap_or_else(|| panic!("{line}"));
        Self { child, port }
    }

    fn send(&self, bytes: &[u8]) -> Response {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        // The server may answer, and close, before all is sent.
        let _ = stream.write_all(bytes);
        let mut response = Vec::new();
        let _ = stream.read_to_end(&mut response);
        let text = String::from_utf8_lossy(&response).into_owned();
        let status = text.split(' ').nth(1).and_then(|word| word.parse().ok());
        let head = response.windows(4).position(|four| four == b"\r\n\r\n");
        let body = head.map_or(response.len(), |head| head + 4);
        (status.unwrap_or(0), response[body..].to_vec())
    }

    fn get(&self, path: &str) -> Response {
        let port = self.port;
        self.send(format!("GET {path} HTTP/1.1\r\nHost: localhost:{port}\r\n\r\n").as_bytes())
    }

    fn post(&self, headers: &str, body: &str) -> Response {
        let length = body.len();
        let request =
            format!("POST /call HTTP/1.1\r\n{headers}Content-Length: {length}\r\n\r\n{body}");
        self.send(request.as_bytes())
    }

    /// Returns the index of an answer, and its numbers.
    fn call(&self, session: &str, name: &str, numbers: &str, text: &str) -> (String, Vec<f64>) {
        let port = self.port;
        let own = format!("Host: 127.0.0.1:{port}\r\nOrigin: http://127.0.0.1:{port}\r\n");
        let body = [session, name, numbers, text].join("\n");
        let (status, answer) = self.post(&own, &body);
        assert_eq!(status, 200);
        let length = u64::from_le_bytes(*answer.first_chunk().unwrap()) as usize;
        let index = String::from_utf8(answer[8..8 + length].to_vec()).unwrap();
        let numbers = answer[8 + length.next_multiple_of(8)..].as_chunks().0;
        let numbers = numbers.iter().map(|bytes| f64::from_le_bytes(*bytes));
        (index, numbers.collect())
    }
}

fn folder() -> Folder {
    let folder = Folder::with("scene.yaml", SCENE);
    std::fs::write(folder.path("part.obj"), MESH).unwrap();
    folder
}

#[test]
fn a_scene_is_served_with_its_files_and_answered() {
    let folder = folder();
    let served = Served::new(&folder, &["scene.yaml"]);
    let (status, page) = served.get("/");
    let page = String::from_utf8(page).unwrap();
    assert_eq!(status, 200);
    // Follow all names in the page, and all names in those files.
    let mut waiting: Vec<String> = vec![page];
    let mut seen = Vec::new();
    while let Some(text) = waiting.pop() {
        let quoted = text.split(['"', '\'', '`']);
        let named = quoted.filter_map(|word| {
            let name = word
                .strip_prefix("./")
                .or(word.strip_prefix("interactive/"))?;
            let kind = name.rsplit('.').next();
            matches!(kind, Some("js" | "css")).then(|| name.to_owned())
        });
        for name in named.collect::<Vec<_>>() {
            if !seen.contains(&name) {
                let (status, text) = served.get(&format!("/interactive/{name}"));
                assert_eq!(status, 200, "{name}");
                waiting.push(String::from_utf8(text).unwrap());
                seen.push(name);
            }
        }
    }
    assert!(seen.len() >= 8, "{seen:?}");
    assert_eq!(served.get("/interactive/scene.yaml").1, SCENE.as_bytes());
    let schema = served.get("/interactive/scene.schema.json").1;
    assert!(
        String::from_utf8(schema)
            .unwrap()
            .contains("\"title\": \"qrt scene\"")
    );

    let (index, numbers) = served.call("a", "check", "", SCENE);
    assert!(
        index.contains("\"valid\":[0]") && numbers[0] == 1.0,
        "{index}"
    );
    served.call("a", "open", "0 0 0 1", SCENE);
    let (index, radiance) = served.call("a", "trace", "0 16 4", "");
    assert!(index.contains("\"radiance\":[2,48]"), "{index}");
    let sum = |channel: usize| radiance[2..].iter().skip(channel).step_by(3).sum::<f64>();
    assert!(sum(0) > 0.5 && (sum(0) - 4.0 * sum(2)).abs() < 1e-12);
    // Another session has another picture, and files are those of the folder alone.
    let (index, _) = served.call("b", "trace", "0 16 4", "");
    assert!(index.contains("no picture is open"), "{index}");
    let outside = SCENE.replace("part.obj", "../part.obj");
    let (index, _) = served.call("b", "check", "", &outside);
    assert!(
        index.contains("QRT") && index.contains("outside"),
        "{index}"
    );
}

#[test]
fn examples_are_there_without_a_scene() {
    let folder = Folder::new();
    let served = Served::new(&folder, &[]);
    assert_eq!(served.get("/interactive/scene.yaml").0, 204);
    let (index, _) = served.call("a", "examples", "", "");
    assert!(
        index.contains("lit-box") && index.contains("knot"),
        "{index}"
    );
    let (index, _) = served.call("a", "example", "", "knot");
    let text: String = serde_json::from_str::<serde_json::Value>(&index).unwrap()["text"]
        .as_str()
        .unwrap()
        .to_owned();
    let (index, numbers) = served.call("a", "check", "", &text);
    assert_eq!(numbers[0], 1.0, "{index}");
}

#[test]
fn nobody_else_is_answered_and_nothing_breaks_it() {
    let folder = folder();
    let served = Served::new(&folder, &["scene.yaml"]);
    let port = served.port;
    let body = "a\ncheck\n\nname: 7";
    // A name of another site that resolves to this machine, and a page of another site.
    for headers in [
        "Host: example.org\r\n".to_owned(),
        format!("Host: example.org:{port}\r\n"),
        "Host: 127.0.0.1\r\n".to_owned(),
        String::new(),
        format!("Host: 127.0.0.1:{port}\r\nOrigin: https://example.org\r\n"),
        format!("Host: 127.0.0.1:{port}\r\nOrigin: null\r\n"),
    ] {
        assert_eq!(served.post(&headers, body).0, 403, "{headers}");
    }
    for host in ["[::1]", "LocalHost", "localhost.", "127.0.0.1"] {
        let own = format!("Host: {host}:{port}\r\nOrigin: http://{host}:{port}\r\n");
        assert_eq!(served.post(&own, body).0, 200, "{host}");
    }
    let own = format!("Host: 127.0.0.1:{port}\r\n");
    assert_eq!(served.post(&own, body).0, 200);
    let twice = format!("{own}Host: example.org\r\n");
    assert_eq!(served.post(&twice, body).0, 403);
    for (wrong, status) in [
        ("", 400),
        ("a\ncheck\n1", 400),
        ("a\ncheck\none\n", 400),
        ("\ncheck\n\n", 400),
    ] {
        assert_eq!(served.post(&own, wrong).0, status, "{wrong:?}");
    }
    let long = "s".repeat(65);
    assert_eq!(served.post(&own, &format!("{long}\ncheck\n\n")).0, 400);
    let huge = format!("POST /call HTTP/1.1\r\n{own}Content-Length: 99999999999\r\n\r\n");
    assert_eq!(served.send(huge.as_bytes()).0, 413);
    let unreadable = format!("POST /call HTTP/1.1\r\n{own}Content-Length: -1\r\n\r\n");
    assert_eq!(served.send(unreadable.as_bytes()).0, 400);
    assert_eq!(served.send(b"\x00\xff\r\n\r\n").0, 400);
    let endless = format!("GET / HTTP/1.1\r\nX: {}", "x".repeat(20_000));
    assert_eq!(served.send(endless.as_bytes()).0, 400);
    for path in [
        "/../scene.yaml",
        "/interactive/../../part.obj",
        "/part.obj",
        "/call",
    ] {
        assert_eq!(served.get(path).0, 404, "{path}");
    }
    // The oldest session is forgotten first.
    served.call("first", "open", "0 0 0 1", SCENE);
    for number in 0..64 {
        served.call(&number.to_string(), "examples", "", "");
    }
    let (index, _) = served.call("first", "trace", "0 1 1", "");
    assert!(index.contains("no picture is open"), "{index}");
    let (index, _) = served.call("63", "trace", "0 1 1", "");
    assert!(index.contains("no picture is open"), "{index}");
}

/// The test is skipped if port 80 is taken or not allowed.
#[test]
fn at_port_80_the_printed_address_is_answered() {
    if std::net::TcpListener::bind(("127.0.0.1", 80)).is_err() {
        return;
    }
    let folder = folder();
    let served = Served::new(&folder, &["scene.yaml", "--port", "80"]);
    let own = "Host: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\n";
    assert_eq!(served.post(own, "a\ncheck\n\nname: 7").0, 200);
    let other = "Host: 127.0.0.1\r\nOrigin: http://127.0.0.1:8000\r\n";
    assert_eq!(served.post(other, "a\ncheck\n\nname: 7").0, 403);
}

#[test]
fn what_cannot_be_served_says_why() {
    let folder = folder();
    let none = folder.fails(2, &["playground", "none.yaml"]);
    assert!(none.contains("none.yaml"), "{none}");
    let served = Served::new(&folder, &[]);
    let port = served.port.to_string();
    let taken = folder.fails(1, &["playground", "--port", &port]);
    assert!(taken.contains(&format!("port {port}")), "{taken}");
}

//! `qrt playground`: edits a scene in a browser.

mod http;

use super::failure::Failure;
use super::terminal;
use clap::Args;
use http::{Answer, Asked};
use qrt_lab::playground::Playground;
use qrt_scene::front::{Files, MAX_BYTES};
use std::collections::VecDeque;
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

#[path = "../../../scenes-yaml/examples.rs"]
mod examples;

/// Try a scene in the browser: its picture, its errors and its cost while it is written
///
/// The page and all that it needs come from this machine, which answers no other. What is written in
/// the editor stays there: nothing is saved.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt playground                 begin with an example
  qrt playground box.yaml        begin with box.yaml; meshes are those of its folder
  qrt playground --port 8000     at http://127.0.0.1:8000/")]
pub(crate) struct PlaygroundArgs {
    /// The scene to begin with, a YAML file [default: one of the examples]
    #[arg(value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// The port to listen on [default: one that is free]
    #[arg(
        long,
        value_name = "PORT",
        default_value_t = 0,
        hide_default_value = true
    )]
    port: u16,
}

/// Most playgrounds kept for open pages; the least recently used one is dropped.
const MOST_SESSIONS: usize = 64;
/// Bytes of stack of a thread, for the compiler of circuits.
const STACK: usize = 64 << 20;
/// The longest name of a session, in bytes.
const LONGEST_SESSION: usize = 64;

/// The page and its assets.
const PAGE: &str = include_str!("page.html");
const ASSETS: &[(&str, &str, &str)] = &[
    ("page.js", http::SCRIPT, include_str!("page.js")),
    ("page.css", http::STYLE, include_str!("page.css")),
    (
        "figures.css",
        http::STYLE,
        include_str!("../../../book/interactive/figures.css"),
    ),
    (
        "playground.css",
        http::STYLE,
        include_str!("../../../book/interactive/playground.css"),
    ),
    (
        "playground.js",
        http::SCRIPT,
        include_str!("../../../book/interactive/playground.js"),
    ),
    (
        "playground-engine.js",
        http::SCRIPT,
        include_str!("../../../book/interactive/playground-engine.js"),
    ),
    (
        "playground-complete.js",
        http::SCRIPT,
        include_str!("../../../book/interactive/playground-complete.js"),
    ),
    (
        "answer.js",
        http::SCRIPT,
        include_str!("../../../book/interactive/answer.js"),
    ),
    (
        "parts.js",
        http::SCRIPT,
        include_str!("../../../book/interactive/parts.js"),
    ),
    (
        "codemirror.js",
        http::SCRIPT,
        include_str!("../../../book/interactive/codemirror.js"),
    ),
];

/// A playground with the name that the worker of a page gave it.
type Session<'a> = (String, Arc<Mutex<Playground<'a>>>);

/// State of the server.
struct Served<'a> {
    /// The scene to begin with.
    scene: Option<String>,
    examples: &'a [(&'a str, &'a str)],
    files: Files<'a>,
    schema: String,
    sessions: Mutex<VecDeque<Session<'a>>>,
}

pub(crate) fn run(args: &PlaygroundArgs) -> Result<(), Failure> {
    let scene = args.scene.as_deref().map(read).transpose()?;
    let folder = args.scene.as_deref().and_then(Path::parent);
    let served = Served {
        // A scene of the user's own has the files of its folder, not the examples.
        examples: if scene.is_some() {
            &[]
        } else {
            examples::EXAMPLES
        },
        files: match folder {
            Some(folder) => Files::of_folder(folder),
            None => Files::held(examples::FILES),
        },
        scene,
        schema: qrt_scene::schema::text(),
        sessions: Mutex::default(),
    };
    let failed = |error: std::io::Error| {
        let port = args.port;
        Failure::Job(format!("cannot listen on port {port}: {error}"))
    };
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, args.port)).map_err(failed)?;
    let port = listener.local_addr().map_err(failed)?.port();
    terminal::print(&format!(
        "http://127.0.0.1:{port}/ is the playground (Ctrl-C ends it)\n"
    ))?;
    http::serve(&listener, port, STACK, MAX_BYTES as usize, &|asked| {
        served.answer(asked)
    });
    Ok(())
}

/// Reads the scene's text. The scene may be invalid, because the user is about to change it.
fn read(path: &Path) -> Result<String, Failure> {
    let cannot =
        |error: &dyn std::fmt::Display| Failure::Usage(format!("{}: {error}", path.display()));
    let length = std::fs::metadata(path).map_err(|error| cannot(&error))?;
    if !length.is_file() || length.len() > MAX_BYTES {
        return Err(cannot(&"not a file of at most 16 MiB"));
    }
    std::fs::read_to_string(path).map_err(|error| cannot(&error))
}

impl<'a> Served<'a> {
    fn answer(&self, asked: &Asked<'_>) -> Answer {
        match (asked.method, asked.path) {
            ("GET", "/") => Answer::text(http::PAGE, PAGE),
            ("GET", "/interactive/scene.schema.json") => Answer::text(http::JSON, &self.schema),
            ("GET", "/interactive/scene.yaml") => match &self.scene {
                Some(scene) => Answer::text(http::PLAIN, scene),
                None => Answer::empty(),
            },
            ("GET", path) => {
                let name = path.strip_prefix("/interactive/").unwrap_or_default();
                let asset = ASSETS.iter().find(|(own, ..)| *own == name);
                asset.map_or_else(Answer::not_found, |(_, kind, text)| {
                    Answer::text(kind, text)
                })
            }
            ("POST", "/call") => self.call(asked.body).unwrap_or_else(Answer::wrong),
            _ => Answer::not_found(),
        }
    }

    /// Answers a call: the session, the call's name, its numbers, each on a line, and the text after them.
    fn call(&self, body: &[u8]) -> Option<Answer> {
        let body = std::str::from_utf8(body).ok()?;
        let mut lines = body.splitn(4, '\n');
        let [session, name, numbers, text] =
            [lines.next()?, lines.next()?, lines.next()?, lines.next()?];
        let numbers = numbers.split_ascii_whitespace().map(str::parse);
        let numbers: Vec<f64> = numbers.collect::<Result<_, _>>().ok()?;
        if session.is_empty() || session.len() > LONGEST_SESSION {
            return None;
        }
        let playground = self.session(session);
        let answer = lock(&playground).call(name, &numbers, text);
        let index = answer.index();
        let mut bytes = Vec::with_capacity(16 + index.len() + 8 * answer.numbers().len());
        bytes.extend((index.len() as u64).to_le_bytes());
        bytes.extend(index.as_bytes());
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        for number in answer.numbers() {
            bytes.extend(number.to_le_bytes());
        }
        Some(Answer::bytes(bytes))
    }

    /// Returns the playground `name`, and makes it the most recently used.
    fn session(&self, name: &str) -> Arc<Mutex<Playground<'a>>> {
        let mut sessions = lock(&self.sessions);
        let known = sessions.iter().position(|(own, _)| own == name);
        let session = known
            .and_then(|place| sessions.remove(place))
            .unwrap_or_else(|| {
                let playground = Playground::new(self.examples, self.files);
                (name.to_owned(), Arc::new(Mutex::new(playground)))
            });
        let playground = Arc::clone(&session.1);
        sessions.push_back(session);
        if sessions.len() > MOST_SESSIONS {
            sessions.pop_front();
        }
        playground
    }
}

fn lock<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

//! Runs a page, from its first block to its last, in a folder of its own.

use super::console::{Command, commands};
use super::scenes::{self, Verdict};
use crate::book::page::{Fence, Page, bless};
use crate::common::command::Folder;
use std::fs;
use std::path::Path;
use std::process::{self, Stdio};

/// The result of a page.
pub(crate) struct Outcome {
    /// The corrected text of the page.
    pub(crate) text: String,
    /// Faults of the page, each with its place.
    pub(crate) failures: Vec<String>,
    /// Number of commands that were run.
    pub(crate) commands: usize,
    /// Number of scenes that were checked.
    pub(crate) scenes: usize,
}

/// Runs all commands of a page and checks all of its scenes.
pub(crate) fn page(page: &Page) -> Outcome {
    let folder = Folder::new();
    copy(Path::new("scenes-yaml"), &folder.path("scenes-yaml"));
    let mut outcome = Outcome {
        text: String::new(),
        failures: Vec::new(),
        commands: 0,
        scenes: 0,
    };
    let fences = page.fences();
    let mut at = 0;
    for (i, fence) in fences.iter().enumerate() {
        match fence.language() {
            "console" => {
                let body = console(page, fence, &folder, &mut outcome);
                outcome.text.push_str(&page.text[at..fence.range.start]);
                outcome.text.push_str(&body);
                at = fence.range.end;
            }
            "yaml" => {
                outcome.scenes += 1;
                let next = fences.get(i + 1);
                let told = scene(fence, next, &folder);
                let told = told.map_err(|what| format!("{}: {what}", page.at(fence.line)));
                outcome.failures.extend(told.err());
            }
            _ => {}
        }
    }
    outcome.text.push_str(&page.text[at..]);
    outcome
}

/// Runs a block's commands; returns the block's corrected text.
fn console(page: &Page, fence: &Fence, folder: &Folder, outcome: &mut Outcome) -> String {
    let commands = match commands(&fence.body) {
        Ok(commands) => commands,
        Err(what) => {
            outcome
                .failures
                .push(format!("{}: {what}", page.at(fence.line)));
            return page.text[fence.range.clone()].to_owned();
        }
    };
    let mut body = String::new();
    for command in commands {
        outcome.commands += 1;
        let said = say(&command, folder);
        match command.check(&said) {
            Err(_) if bless() && !command.elides() => body += &command.rewritten(&said),
            told => {
                body += &command.as_shown();
                let line = fence.line + 1 + command.line;
                let told = told.map_err(|difference| {
                    format!("{}: `{}`\n{difference}", page.at(line), command.text)
                });
                outcome.failures.extend(told.err());
            }
        }
    }
    let indent = " ".repeat(fence.indent);
    let lines = body.lines().map(|line| match line {
        "" => "\n".to_owned(),
        _ => format!("{indent}{line}\n"),
    });
    lines.collect()
}

/// Returns the output of a command on standard output and standard error, in the order of writing.
fn say(command: &Command, folder: &Folder) -> String {
    let bin = Path::new(env!("CARGO_BIN_EXE_qrt")).parent().unwrap();
    let path = std::env::var("PATH").unwrap_or_default();
    let output = process::Command::new("sh")
        .arg("-c")
        .arg(format!("exec 2>&1\n{}", command.text))
        .current_dir(folder.path(""))
        // The caller's environment must not affect the page: no colours, no width of a terminal.
        .env_clear()
        .env("PATH", format!("{}:{path}", bin.display()))
        .env("LC_ALL", "C.UTF-8")
        .stdin(Stdio::null())
        .output()
        .unwrap();
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Checks a block of YAML, and saves it where its first line names a file.
fn scene(fence: &Fence, next: Option<&Fence>, folder: &Folder) -> Result<(), String> {
    let wrong = match &*fence.info {
        "yaml" => false,
        "yaml,wrong" => true,
        info => return Err(format!("`{info}` is neither `yaml` nor `yaml,wrong`")),
    };
    let (scene, name) = match scenes::file(&fence.body) {
        Some((name, true)) => {
            let file = folder.path(name);
            let old = fs::read_to_string(&file).map_err(|_| format!("there is no `{name}` yet"))?;
            (scenes::replaced(&old, &fence.body), Some(name))
        }
        Some((name, false)) => (fence.body.clone(), Some(name)),
        None => (scenes::completed(&fence.body), None),
    };
    if let Some(name) = name {
        fs::write(folder.path(name), &scene).unwrap();
    }
    // Paths of meshes are relative to `scenes-yaml`.
    let meshes = folder.path("scenes-yaml");
    match (
        scenes::judge(&scene, name.unwrap_or("scene.yaml"), &meshes),
        wrong,
    ) {
        (Verdict::Accepted, false) => Ok(()),
        (Verdict::Accepted, true) => Err("this scene is accepted, although it is `wrong`".into()),
        (Verdict::Refused(report), false) => Err(format!("this scene is refused:\n{report}")),
        (Verdict::Refused(report), true) => match next.filter(|next| next.language() == "text") {
            Some(text) => scenes::is_told(&report, &text.body),
            None if next.is_some_and(|next| next.language() == "console") => Ok(()),
            None => Err("a wrong scene is followed by its report".into()),
        },
    }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let target = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &target);
        } else {
            fs::copy(&path, &target).unwrap();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn failures(text: &str) -> Vec<String> {
        page(&Page::new("page.md", text)).failures
    }

    #[test]
    fn commands_of_a_page_see_the_files_of_those_before_them() {
        let text = "\
```console
$ qrt new box > said; ls
box.yaml
said
scenes-yaml
```

Then:

```console
$ qrt render box.yaml --set nothing=1; echo $?
error[QRT0120]: unknown key `nothing` in the scene
...
2
```
";
        let outcome = page(&Page::new("page.md", text));
        assert!(outcome.failures.is_empty(), "{:?}", outcome.failures);
        assert_eq!((outcome.commands, &*outcome.text), (2, text));
        assert_eq!(outcome.scenes, 0);
    }

    #[test]
    fn an_untrue_listing_is_told_with_its_place() {
        let text = "Words.\n\n```console\n$ qrt --version\nqrt 99.0\n```\n";
        let told = failures(text);
        assert_eq!(told.len(), 1);
        for part in [
            "book/src/page.md:4: `qrt --version`",
            "- qrt 99.0",
            "+ qrt ",
        ] {
            assert!(told[0].contains(part), "{}", told[0]);
        }
    }

    #[test]
    fn a_scene_that_is_refused_or_wrongly_accepted_is_told() {
        let right = "```yaml\nfilm: { width: 3, height: 2 }\n```\n";
        assert_eq!(failures(right), [""; 0]);
        assert_eq!(page(&Page::new("page.md", right)).scenes, 1);
        assert_eq!(failures(&right.replace("yaml", "yaml,wrong")).len(), 1);
        let wrong = right.replace("width", "widht");
        assert!(failures(&wrong)[0].contains("QRT0120"));
        // A block marked `wrong` must be followed by its report.
        let wrong = wrong.replace("yaml", "yaml,wrong");
        assert!(failures(&wrong)[0].contains("followed by its report"));
        let report = "```text\nerror[QRT0121]: something else\n```\n";
        assert_eq!(failures(&format!("{wrong}{report}")).len(), 1);
        assert_eq!(failures(&right.replace("yaml", "yaml,maybe")).len(), 1);
    }

    #[test]
    fn a_named_scene_is_a_file_for_the_commands_below() {
        let text = "\
```yaml
# dark.yaml
name: dark
camera: { perspective: { eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 } }
film: { width: 1, height: 1 }
materials: {}
geometry: []
```

```yaml
# in dark.yaml
film: { width: 2, height: 1 }
budget: { qubits: 7 }
```

```console
$ grep -v '^#' dark.yaml
name: dark
camera: { perspective: { eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 } }
film: { width: 2, height: 1 }
materials: {}
geometry: []
budget: { qubits: 7 }
```
";
        assert_eq!(failures(text), [""; 0]);
        assert_eq!(failures(&text.replace("# in dark", "# in other")).len(), 2);
    }
}

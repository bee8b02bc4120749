//! Quoting of commands for a POSIX shell, for messages that suggest a command.

use std::borrow::Cow;
use std::path::Path;

/// Quotes one word of a command line if a shell would otherwise change it.
///
/// ```
/// use qrt_lab::shell::word;
/// assert_eq!(word("box.yaml"), "box.yaml");
/// assert_eq!(word("a b.yaml"), "'a b.yaml'");
/// assert_eq!(word("it's"), r"'it'\''s'");
/// ```
pub fn word(text: &str) -> Cow<'_, str> {
    let plain = |letter: char| letter.is_alphanumeric() || "_-./:,=@%+".contains(letter);
    // At the beginning of a word, some shells expand `~` and `=`.
    if !text.is_empty() && !text.starts_with('=') && text.chars().all(plain) {
        Cow::Borrowed(text)
    } else {
        Cow::Owned(format!("'{}'", text.replace('\'', r"'\''")))
    }
}

/// Quotes a file's name so that no command takes it for an option.
///
/// ```
/// use qrt_lab::shell::file;
/// assert_eq!(file("-a b.xml".as_ref()), "'./-a b.xml'");
/// ```
pub fn file(path: &Path) -> String {
    let text = path.to_string_lossy();
    if text.starts_with('-') {
        word(&format!("./{text}")).into_owned()
    } else {
        word(&text).into_owned()
    }
}

/// Formats a command of qrt, for example `qrt render`, with a file as its last argument.
///
/// ```
/// use qrt_lab::shell::command;
/// assert_eq!(command("qrt render", "a b.yaml".as_ref()), "qrt render 'a b.yaml'");
/// assert_eq!(command("qrt render", "-y.yaml".as_ref()), "qrt render -- -y.yaml");
/// ```
pub fn command(command: &str, file: &Path) -> String {
    let text = file.to_string_lossy();
    let end_of_options = if text.starts_with('-') { "-- " } else { "" };
    format!("{command} {end_of_options}{}", word(&text))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::process::Command;

    /// A shell turns the quoted word back into the original text.
    #[test]
    fn a_shell_reads_words_back() {
        for text in [
            "",
            "box.yaml",
            "a b",
            "it's",
            "'",
            "''",
            "$HOME",
            "`date`",
            "a;b",
            "a&b",
            "*",
            "?",
            "[a]",
            "{a,b}",
            "~",
            "~root",
            "#a",
            "!a",
            "a\\b",
            "a\"b",
            "a\nb",
            "\t",
            "=ls",
            "a=b",
            "(a)",
            "<a",
            "|",
            "circuit.uncompute=a:b",
            "\u{e4}\u{1f600}",
            "-n",
            "film={ width: 8, height: 8 }",
        ] {
            let script = format!("printf %s {}", word(text));
            let said = Command::new("sh").args(["-c", &script]).output().unwrap();
            assert_eq!(String::from_utf8(said.stdout).unwrap(), text, "{script}");
        }
    }
}

//! Console blocks: commands, and their output.

use super::diff::diff;

/// A line that stands for any number of lines.
const ELISION: &str = "...";

/// A command and the output that the page shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Command {
    /// The line of the command within the block, from 0.
    pub(crate) line: usize,
    /// Text after `$ `, with continuation lines.
    pub(crate) text: String,
    /// The lines below.
    pub(crate) shown: Vec<String>,
}

/// Parses the commands of a block.
///
/// # Errors
/// A block that does not begin with a command.
pub(crate) fn commands(body: &str) -> Result<Vec<Command>, String> {
    let mut commands: Vec<Command> = Vec::new();
    let mut continued = false;
    for (line, text) in body.lines().enumerate() {
        if let Some(command) = commands.last_mut().filter(|_| continued) {
            command.text.push('\n');
            command.text.push_str(text);
            continued = text.ends_with('\\');
        } else if let Some(text) = text.strip_prefix("$ ") {
            commands.push(Command {
                line,
                text: text.to_owned(),
                shown: Vec::new(),
            });
            continued = text.ends_with('\\');
        } else if let Some(command) = commands.last_mut() {
            command.shown.push(text.trim_end().to_owned());
        } else {
            return Err(format!(
                "a console block begins with `$ `, not with `{text}`"
            ));
        }
    }
    if commands.is_empty() {
        return Err("a console block without a command".to_owned());
    }
    Ok(commands)
}

impl Command {
    /// True if lines of the output are left out.
    pub(crate) fn elides(&self) -> bool {
        self.shown.iter().any(|line| line == ELISION)
    }

    /// Compares the shown output with the output `said` of the command.
    ///
    /// # Errors
    /// The lines that differ.
    pub(crate) fn check(&self, said: &str) -> Result<(), String> {
        let said: Vec<&str> = said.lines().map(str::trim_end).collect();
        let shown: Vec<&str> = self.shown.iter().map(String::as_str).collect();
        let differs = || Err(diff(&shown, &said));
        let mut parts = shown.split(|line| *line == ELISION);
        let first = parts.next().unwrap_or_default();
        let rest: Vec<&[&str]> = parts.collect();
        let Some((last, middle)) = rest.split_last() else {
            return if shown == said { Ok(()) } else { differs() };
        };
        if !said.starts_with(first) {
            return differs();
        }
        let mut left = &said[first.len()..];
        for part in middle {
            let found = (0..=left.len()).find(|&at| left[at..].starts_with(part));
            let Some(at) = found else { return differs() };
            left = &left[at + part.len()..];
        }
        if left.ends_with(last) {
            Ok(())
        } else {
            differs()
        }
    }

    /// Returns the command as the page writes it, with `said` below it.
    pub(crate) fn rewritten(&self, said: &str) -> String {
        let mut out = format!("$ {}\n", self.text);
        for line in said.lines() {
            out.push_str(line.trim_end());
            out.push('\n');
        }
        out
    }

    /// Returns the command as the page writes it, with the output that the page shows below it.
    pub(crate) fn as_shown(&self) -> String {
        self.rewritten(&self.shown.join("\n"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn command(shown: &str) -> Command {
        let block = format!("$ qrt say\n{shown}");
        commands(&block).unwrap().remove(0)
    }

    const SAID: &str = "one\ntwo\nthree   \n\nfour\nfive\n";

    #[test]
    fn what_is_shown_in_full_must_be_all_that_is_said() {
        assert_eq!(command("one\ntwo\nthree\n\nfour\nfive").check(SAID), Ok(()));
        for wrong in [
            "",
            "one\ntwo\nthree\n\nfour",
            "one\ntwo\nthree\n\nfour\nfive\nsix",
            "one\ntwo\nthree\n\nfour\nfife",
            "two\nthree\n\nfour\nfive",
            "one\ntwo\nthree\nfour\nfive",
            " one\ntwo\nthree\n\nfour\nfive",
        ] {
            assert!(command(wrong).check(SAID).is_err(), "{wrong}");
        }
        assert_eq!(command("").check(""), Ok(()));
    }

    #[test]
    fn an_elision_stands_for_lines_and_swallows_no_wrong_ones() {
        for right in [
            "...",
            "one\n...",
            "...\nfive",
            "one\n...\nfive",
            "one\n...\nthree\n\n...\nfive",
            "one\ntwo\n...\nthree\n\nfour\nfive",
        ] {
            assert_eq!(command(right).check(SAID), Ok(()), "{right}");
        }
        for wrong in [
            "...\nfour",
            "...\nsix",
            "two\n...",
            "one\n...\nthree\nfour\n...\nfive",
            "one\n...\nfour\n...\ntwo\n...\nfive",
            "one\n...\nfive\n...\nfive",
            "one\ntwo\nthree\n\nfour\nfive\n...\nfive",
        ] {
            assert!(command(wrong).check(SAID).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_difference_names_the_lines() {
        let told = command("one\ntwo\nthree\n\nfour\nsix").check(SAID);
        let told = told.unwrap_err();
        assert!(told.contains("- six\n    + five\n"), "{told}");
    }

    #[test]
    fn commands_may_follow_each_other_and_go_on_below() {
        let block = "$ qrt a \\\n    --b\nsaid\n$ qrt c\n$ qrt d\n...\n";
        let found = commands(block).unwrap();
        let texts: Vec<_> = found.iter().map(|command| &*command.text).collect();
        assert_eq!(texts, ["qrt a \\\n    --b", "qrt c", "qrt d"]);
        assert_eq!(found[0].shown, ["said"]);
        assert!(found[1].shown.is_empty() && !found[1].elides() && found[2].elides());
        assert_eq!(found[2].line, 4);
        let again: String = found.iter().map(Command::as_shown).collect();
        assert_eq!(again, block);
    }

    #[test]
    fn a_block_without_a_command_is_told() {
        assert!(commands("").is_err());
        assert!(commands("said\n$ qrt a\n").is_err());
        assert!(commands("$qrt a\n").is_err());
    }

    #[test]
    fn what_is_rewritten_is_true() {
        let written = command("old").rewritten(SAID);
        assert_eq!(commands(&written).unwrap()[0].check(SAID), Ok(()));
    }
}

//! The scenes of earlier invocations of `qrt!`.
//!
//! A macro sees its own tokens only, so this reads the file around them. Two scenes of one name
//! would be an error of the compiler for each item that `qrt!` writes for the second.

use crate::surroundings::{before, tokens};
use proc_macro2::Ident;

/// Returns the line of an earlier scene called `name`, of another `qrt!` in the scope of this one.
/// A `qrt!` or a scene with attributes is passed over, since a `cfg` may remove it.
pub(super) fn line(name: &Ident) -> Option<usize> {
    find(&before(name.span())?, &name.to_string())
}

/// A pair of brackets around the end of a text.
#[derive(Default)]
struct Scope<'t> {
    /// True for the brackets of a `qrt!` without attributes.
    is_scenes: bool,
    /// The scenes that were defined directly in these brackets, with their lines.
    scenes: Vec<(&'t str, usize)>,
    /// True if an attribute precedes the next item.
    has_attribute: bool,
}

/// Returns the line of the scene called `name` in the scope of the `qrt!` within which `text` ends.
fn find(text: &str, name: &str) -> Option<usize> {
    let tokens = tokens(text);
    let token = |at: usize| tokens.get(at).map_or("", |(token, _)| *token);
    let mut scopes = vec![Scope::default()];
    for at in 0..tokens.len() {
        let last = scopes.last_mut()?;
        match token(at) {
            "#" => last.has_attribute |= token(at + 1) == "[",
            ";" | "," => last.has_attribute = false,
            "{" | "(" | "[" => {
                let is_qrt = at >= 2 && token(at - 1) == "!" && token(at - 2) == "qrt";
                let is_scenes = is_qrt && !last.has_attribute;
                scopes.push(Scope {
                    is_scenes,
                    ..Scope::default()
                });
            }
            "}" | ")" | "]" => {
                scopes.pop();
                // An attribute ends in a bracket itself.
                if token(at) == "}" {
                    scopes.last_mut()?.has_attribute = false;
                }
            }
            "scene" if last.is_scenes && !last.has_attribute && at + 1 < tokens.len() => {
                let scene = tokens[at + 1];
                let outer = scopes.len().checked_sub(2)?;
                scopes[outer].scenes.push(scene);
            }
            _ => {}
        }
    }
    let [.., outer, own] = scopes.as_slice() else {
        return None;
    };
    let mut scenes = outer.scenes.iter().filter(|_| own.is_scenes);
    let (_, line) = scenes.find(|(scene, _)| *scene == name)?;
    Some(*line)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Searches the text before the last `Room`.
    fn found(text: &str) -> Option<usize> {
        find(&text[..text.rfind("Room").unwrap()], "Room")
    }

    #[test]
    fn a_scene_of_an_earlier_macro_in_the_same_scope_is_found() {
        for text in [
            "qrt! { scene Room { film: 8 x 8 } }\nqrt! { scene Room",
            "qrt::qrt!(pub scene Hall from \"a\"; scene Room from \"b\");\nqrt! { pub scene Room",
            "mod a { fn b() { qrt! { scene Room {} }\n{ c() } qrt! [ scene Room",
            "/* { */ qrt! { scene Room {} } // {\nconst A: char = '{'; qrt! { scene Room",
            "fn a<'b>(_: &'b str) {} qrt! { scene Room {} }\n#[cfg(c)] mod d {} qrt! { scene Room",
            "qrt! { scene Room {} }\nconst A: [&str; 2] = [r#\"\"{\"#, \"\\\"{\"]; qrt!(scene Room",
        ] {
            assert_eq!(found(text), Some(1), "{text}");
        }
        assert_eq!(
            found("\n\n/*\n*/ qrt! { scene Room {} } qrt! { scene Room"),
            Some(4)
        );
    }

    #[test]
    fn scenes_of_other_scopes_and_under_conditions_are_not_found() {
        for text in [
            "qrt! { scene Room",
            "mod a { qrt! { scene Room {} } } qrt! { scene Room",
            "qrt! { scene Room {} } mod a { qrt! { scene Room",
            "fn a() { qrt! { scene Room {} } } fn b() { qrt! { scene Room",
            "qrt! { scene RoomPath {} scene Hall {} } qrt! { scene Room",
            "#[cfg(a)] qrt! { scene Room {} } #[cfg(not(a))] qrt! { scene Room",
            "qrt! { #[cfg(a)] scene Room {} } qrt! { scene Room",
            "other! { scene Room {} } qrt! { scene Room",
            "qrt! { scene Room {} } made!(Room",
            "// qrt! { scene Room {} }\nqrt! { scene Room",
            "const A: &str = \"qrt! { scene Room {} }\"; qrt! { scene Room",
            "scene Room } } } qrt! { scene Room",
        ] {
            assert_eq!(found(text), None, "{text}");
        }
    }
}

//! Colours of vertices: read where they are wanted, and else named once.

use super::*;
use crate::Rgb;

/// The mesh of a text, with the colours of its vertices.
fn coloured(text: &str) -> Result<FileMesh, FileError> {
    let wanted = Wanted {
        colours: true,
        ..Wanted::default()
    };
    let mut library = |path: &Path| unreachable!("{}", path.display());
    let path = Path::new("dir/mesh.obj");
    parse(
        path,
        text.as_bytes(),
        wanted,
        Faces::default(),
        &mut library,
    )
}

const RED: Rgb = [1.0, 0.0, 0.0];
const GREEN: Rgb = [0.0, 1.0, 0.0];
const BLUE: Rgb = [0.0, 0.0, 1.0];
const GREY: Rgb = [0.5, 0.25, 0.125];

/// A square whose fourth vertex has an opacity, too.
const SQUARE: &str = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 0.5 0.25 0.125 0.5\n";

#[test]
fn corners_have_the_colours_of_their_vertices() {
    // A fan; indices from the end; a face before the vertices; texture coordinates and normals between.
    for faces in [
        "f 1 2 3 4\n",
        "f -4 -3 -2 -1\n",
        "f 1/1 2/1/1 3//1 4\nvt 0 0\nvn 0 0 1\n",
    ] {
        let mesh = coloured(&format!("{SQUARE}{faces}")).unwrap();
        assert_eq!(
            mesh.colours,
            [[RED, GREEN, BLUE], [RED, BLUE, GREY]],
            "{faces}"
        );
    }
    let mesh = coloured(&format!("f 4 3 2\n{SQUARE}f 1 1 2 4\n")).unwrap();
    assert_eq!(mesh.colours, [[GREY, BLUE, GREEN], [RED, GREEN, GREY]]);
}

#[test]
fn a_vertex_without_a_colour_is_refused_where_colours_are_wanted() {
    for vertex in ["v 0 0 1", "v 0 0 1 0.5"] {
        let text = format!("{SQUARE}{vertex}\nf 1 2 3\n");
        refused(coloured(&text), "QRT0353", Some(5), "no colour");
    }
    for (vertex, code, words) in [
        ("v 0 0 1 1 1.5 0", "QRT0338", "1.5"),
        ("v 0 0 1 -0.25 0 0", "QRT0338", "-0.25"),
        ("v 0 0 1 nan 0 0", "QRT0326", "nan"),
        ("v 0 0 1 red 0 0", "QRT0325", "red"),
        ("v 0 0 1 1 1 0 0.5 2", "QRT0325", "not 8"),
        ("v 0 0 1 1 0", "QRT0325", "not 5"),
    ] {
        let text = format!("{SQUARE}{vertex}\nf 1 2 3\n");
        refused(coloured(&text), code, Some(5), words);
    }
}

#[test]
fn colours_that_are_not_wanted_are_named_once_at_the_first() {
    let mesh = read(&format!("v 9 9 9\n{SQUARE}v 0 0 1 nan 7 red\nf 1 2 3 4\n")).unwrap();
    assert!(mesh.colours.is_empty());
    let notes: Vec<String> = mesh.notes.iter().map(ToString::to_string).collect();
    let [note] = &notes[..] else {
        panic!("{notes:?}");
    };
    assert!(note.starts_with("dir/mesh.obj:2: "), "{note}");
    assert!(note.contains("QRT0354"), "{note}");
    assert!(
        coloured(&format!("{SQUARE}f 1 2 3\n"))
            .unwrap()
            .notes
            .is_empty()
    );
}

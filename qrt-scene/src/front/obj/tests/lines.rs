//! Ends of statements (comments, continued lines, LF, CR LF and CR), and faces that name a corner twice.

use super::*;

const SQUARE: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";

/// The area of the square's faces, whose statements are `faces`.
#[track_caller]
fn area_of(faces: &str) -> f64 {
    area(&read(&format!("{SQUARE}{faces}")).unwrap())
}

#[test]
fn a_comment_ends_with_its_line_although_it_ends_in_a_backslash() {
    for faces in [
        "f 1 2 3 # from parts\\left\\\nf 1 3 4\n",
        "# from parts\\left\\\nf 1 2 3\nf 1 3 4\n",
        "f 1 2 3\n  #\\\nf 1 3 4\n",
        "f 1 2 3\nf 1 3 4 # the file ends here\\",
        "f 1 2 3\nf 1 3 4\n# the file ends here\\",
        "f 1 2 \\\n 3 # continued, then a comment\\\nf 1 3 4\n",
        "f 1 2 3 \\\n# a comment within a continued statement\\\nf 1 3 4\n",
        "\\\n# a comment after a backslash alone\\\nf 1 2 3\nf 1 3 4\n",
        "o part # from parts\\left\\\nf 1 2 3\nf 1 3 4\n",
        "usemtl red # from parts\\left\\\nf 1 2 3\nf 1 3 4\n",
        "vt 0 0 # texture\\\nf 1 2 3\nvn 0 0 1 #\\\nf 1 3 4\n",
    ] {
        for end in ["\n", "\r\n", "\r"] {
            let area = area_of(&faces.replace('\n', end));
            assert_eq!(area, 4.0, "{faces:?} with {end:?}");
        }
    }
    let mtl = "# made in c:\\colours\\\nnewmtl red\nKd 1 0 0 # as in c:\\red\\\nKe 2 2 2\n";
    for end in ["\n", "\r\n", "\r"] {
        let mesh = read_with(
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib a.mtl\nusemtl red\nf 1 2 3\n",
            &[("a.mtl", &mtl.replace('\n', end))],
        )
        .unwrap();
        let red = Material::from(Emitter {
            radiance: [2.0; 3],
            albedo: [1.0, 0.0, 0.0].into(),
        });
        assert_eq!(mesh.materials[0].material, Ok(red));
    }
}

#[test]
fn what_continues_a_statement_is_looked_for_in_its_last_line() {
    for (text, expected) in [
        ("a \\\nb # \\\nc", vec![(1, "a b # \\"), (3, "c")]),
        ("a \\\\\n\nb", vec![(1, "a b")]),
        ("a \\\n\nb", vec![(1, "a"), (3, "b")]),
        ("\\\n# \\\nb", vec![(3, "b")]),
        ("a \\", vec![(1, "a \\")]),
    ] {
        let found: Vec<_> = statements(text).collect();
        let found: Vec<_> = found.iter().map(|(line, text)| (*line, &**text)).collect();
        assert_eq!(found, expected, "{text:?}");
    }
}

/// Checks that a statement is not scanned again for each of its lines, which would take minutes.
#[test]
fn a_statement_of_half_a_million_lines_is_read() {
    let text = format!("g {}\n{SQUARE}f 1 2 3 4\n", "1 \\\n".repeat(1 << 19));
    assert_eq!(read(&text).unwrap().faces.len(), 2);
}

#[test]
fn lines_are_numbered_as_editors_number_them() {
    for end in ["\n", "\r\n", "\r"] {
        let at = |text: &str, line, words| {
            refused(read(&text.replace('\n', end)), "QRT0325", Some(line), words);
        };
        at("# one\n# two\n\nv 1 1 x\n", 4, "`x`");
        at("\\\n\\\nv 1 \\\n 1 1\nv 1 1 y\n", 5, "`y`");
        let nul = "v 1 1 1\n# two\n\0".replace('\n', end);
        refused(read(&nul), "QRT0322", Some(3), "not a text file");
        let mtl = "newmtl a\n\nKd 2 0 0\n".replace('\n', end);
        let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib a.mtl\nusemtl a\nf 1 2 3\n";
        let read = read_with(obj, &[("a.mtl", &mtl)]);
        refused(read, "QRT0338", Some(3), "2, which is not in [0, 1]");
    }
}

#[test]
fn a_repeated_corner_is_dropped() {
    for faces in [
        "f 1 2 3\nf 1 3 3 4",
        "f 1 2 3\nf 1 1 1 3 4",
        "f 1 2 3\nf 1 3 4 1",
        "f 1 2 3\nf 1 3 -2 4 4 -4",
        "vt 0 0\nvt 1 1\nvn 0 0 1\nf 1 2 3\nf 1/1/1 3/1/1 3/2 4//1 1",
        "f 1 2 2 3 4",
        "f 1 2 3 4 4 1 1",
        // Another vertex at the same place.
        "v 1 1 0\nf 1 2 3 5 4",
    ] {
        assert_eq!(area_of(faces), 4.0, "{faces}");
        let mesh = read(&format!("{SQUARE}{faces}")).unwrap();
        assert_eq!(mesh.faces.len(), 2, "{faces}");
    }
    for faces in ["f 1 2 2 1", "f 3 3 3 3", "f 1 1 2 2 2", "f 1 2 1"] {
        refused(
            read(&format!("{SQUARE}{faces}")),
            "QRT0343",
            Some(5),
            "no area",
        );
        let mesh = read(&format!("{SQUARE}f 1 2 3\n{faces}")).unwrap();
        assert_eq!(mesh.faces.len(), 1, "{faces}");
        let note = FileError::new(MeshFile::FlatLeftOut { count: 1 }, &mesh.files[0], 6);
        assert_eq!(mesh.notes, [note], "{faces}");
    }
}

/// A line of a file, with what may follow it.
fn line() -> impl Strategy<Value = (&'static str, &'static str)> {
    let statement = prop::sample::select(vec![
        "v 0 0 0",
        "v 1 0 0.5",
        "v 0 1 0",
        "v 1 1 1",
        "f 1 2 3",
        "f 1 3 4",
        "f 4 3 2 1",
        "f 2 2 3 4",
        "f 1 \\\n 2 \\\n 3",
        "vt 0 0",
        "vn 0 0 1",
        "o part",
        "g a b",
        "usemtl red",
        "f 1 2",
        "q",
        "# alone",
        "",
        "  ",
        "\t# indented",
    ]);
    let comment = prop::sample::select(vec!["", " # plain", " # left\\", " #\\", "\t# c:\\a\\ "]);
    (statement, comment)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn comments_and_ends_of_lines_change_nothing(
        lines in prop::collection::vec((line(), 0..3_usize), 0..12),
    ) {
        let ends = ["\n", "\r\n", "\r"];
        let (mut plain, mut mixed) = (CUBE.to_owned(), CUBE.to_owned());
        for ((statement, comment), end) in lines {
            plain += statement;
            plain += "\n";
            // Not at the line's start: a CR there would be one with the LF of an empty line.
            mixed.push_str(&format!(" {statement}{comment}\n").replace('\n', ends[end]));
        }
        let (plain, mixed) = (read(&plain), read(&mixed));
        match (plain, mixed) {
            (Ok(plain), Ok(mixed)) => prop_assert_eq!(plain.faces, mixed.faces),
            (Err(plain), Err(mixed)) => prop_assert_eq!(
                (plain.place, plain.what.description()),
                (mixed.place, mixed.what.description())
            ),
            (plain, mixed) => prop_assert!(false, "{plain:?}, but {mixed:?}"),
        }
    }
}

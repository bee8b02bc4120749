//! Compares two texts line by line.

use std::fmt::Write as _;

/// Returns the lines of both texts: lines of `expected` alone after `-`, of `found` alone after `+`;
/// of common lines, two before and after each difference.
pub(crate) fn diff(expected: &[&str], found: &[&str]) -> String {
    let (m, n) = (expected.len(), found.len());
    // Lengths of the longest common subsequences of the remaining lines.
    let mut common = vec![vec![0_usize; n + 1]; m + 1];
    for i in (0..m).rev() {
        for j in (0..n).rev() {
            common[i][j] = if expected[i] == found[j] {
                common[i + 1][j + 1] + 1
            } else {
                common[i + 1][j].max(common[i][j + 1])
            };
        }
    }
    let (mut i, mut j) = (0, 0);
    let mut lines = Vec::new();
    while i < m || j < n {
        if i < m && j < n && expected[i] == found[j] {
            lines.push((' ', expected[i]));
            (i, j) = (i + 1, j + 1);
        } else if i < m && (j == n || common[i + 1][j] >= common[i][j + 1]) {
            lines.push(('-', expected[i]));
            i += 1;
        } else {
            lines.push(('+', found[j]));
            j += 1;
        }
    }
    let near = |at: usize| {
        let about = &lines[at.saturating_sub(2)..(at + 3).min(lines.len())];
        about.iter().any(|(mark, _)| *mark != ' ')
    };
    let mut out = String::new();
    let mut skipped = false;
    for (at, (mark, line)) in lines.iter().enumerate() {
        if near(at) {
            let _ = writeln!(out, "    {mark} {line}");
        } else if !skipped {
            out.push_str("      ⋮\n");
        }
        skipped = !near(at);
    }
    out
}

#[test]
fn a_difference_is_shown_with_what_is_around_it() {
    let expected = ["a", "b", "c", "d", "e", "f"];
    let found = ["a", "b", "c", "x", "e", "f"];
    let shown = "      ⋮\n      b\n      c\n    - d\n    + x\n      e\n      f\n";
    assert_eq!(diff(&expected, &found), shown);
    assert_eq!(diff(&[], &["new"]), "    + new\n");
}

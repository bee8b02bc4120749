//! Tests of `qrt trade` from the outside.

use crate::common::command::Folder;

/// A lamp over a floor; two rays.
pub(super) const LIT: &str = "
name: lit
camera: { perspective: { eye: [0, 1, 2], target: [0, 0.4, 0], vfov: 60 } }
film: { width: 6, height: 4 }
materials:
  floor: { lambertian: { albedo: [0.8, 0.5, 0.2] } }
  lamp: { emitter: { radiance: [3, 2, 1] } }
geometry:
  - quad: { vertices: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: floor }
  - quad: { vertices: [[-1, 1.5, -1], [1, 1.5, -1], [1, 1.5, 1], [-1, 1.5, 1]], material: lamp }
sampling: { path_bits: 6, depths: [{ bits: [8, 8] }, { bits: [8, 8] }], lights: none }
precision: { fraction: 10 }
comparator: { bits: 6 }
counting: { phase_bits: 5, estimator: sine }
";

const QUICK: [&str; 6] = ["-o", "out", "--quick", "--pixels", "4", "--threads"];

fn folder() -> Folder {
    Folder::with("lit.yaml", LIT)
}

fn trade<'a>(threads: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["trade", "lit.yaml"], &QUICK[..], &[threads], more].concat()
}

/// Returns a table's lines without their seconds and checksums.
fn timeless(folder: &Folder) -> Vec<String> {
    let text = String::from_utf8(folder.read("out/trade.csv")).unwrap();
    let lines = text.lines().skip(1);
    lines
        .map(|line| line.rsplitn(3, ',').nth(2).unwrap().to_owned())
        .collect()
}

#[test]
fn a_table_plots_and_a_page_that_do_not_depend_on_threads() {
    let folder = folder();
    let said = folder.works(&trade("1", &[]));
    assert!(
        said.starts_with("lit: ") && said.contains("settings on 4 of 24 pixels"),
        "{said}"
    );
    assert!(said.ends_with("out/index.html\n"), "{said}");
    let text = String::from_utf8(folder.read("out/trade.csv")).unwrap();
    let mut lines = text.lines();
    assert!(lines.next().unwrap().starts_with("# qrt trade: version="));
    let columns = lines.next().unwrap();
    assert!(
        columns.starts_with("sweep,model,estimator,phase_bits,repetitions,sequence,path_bits,")
    );
    assert!(columns.ends_with("e_total,e_total_low,e_total_high,seconds,crc32"));
    for line in lines {
        assert_eq!(
            line.split(',').count(),
            columns.split(',').count(),
            "{line}"
        );
    }
    for file in ["counting.svg", "paths.svg", "front-toffoli.svg"] {
        let text = String::from_utf8(folder.read(&format!("out/{file}"))).unwrap();
        let drawn = roxmltree::Document::parse(&text).unwrap();
        assert_eq!(drawn.root_element().tag_name().name(), "svg");
        assert!(text.contains("prefers-color-scheme:dark"));
    }
    let once = timeless(&folder);
    let shown = picture(&folder);
    std::fs::remove_dir_all(folder.path("out")).unwrap();
    let quiet = folder.works(&trade("3", &["-q"]));
    assert!(quiet.is_empty());
    assert_eq!(timeless(&folder), once);
    assert_eq!(picture(&folder), shown);
}

/// Pages show no Markdown marks.
#[test]
fn the_page_and_the_summary_are_written_in_words() {
    // The number is long enough that a face takes more than a line.
    let folder = Folder::with("lit.yaml", &LIT.replace("1.5", "1.5000000001"));
    let said = folder.works(&trade("2", &[]));
    let page = String::from_utf8(folder.read("out/index.html")).unwrap();
    assert!(!page.contains('`'), "{}", page.split('`').nth(1).unwrap());
    assert!(page.contains("<code>cargo bench --bench equal_error</code>"));
    for text in [&said, &page] {
        assert!(
            text.contains("10 fraction bits, uncompute: keep, nearest: running"),
            "{text}"
        );
    }
    let scene = page
        .split("tabindex=\"0\">")
        .nth(1)
        .unwrap()
        .split("</pre>")
        .next()
        .unwrap();
    assert!(scene.contains("  - quad:\n      vertices:"), "{scene}");
    assert!(scene.lines().all(|line| line.trim() != "-"), "{scene}");
}

/// Returns the whole address of the page's picture of the scene.
fn picture(folder: &Folder) -> String {
    let page = String::from_utf8(folder.read("out/index.html")).unwrap();
    let start = page.find("data:image/png;base64,").expect("a picture");
    let end = page[start..].find('"').unwrap();
    assert!(end > 200, "{end} bytes");
    page[start..start + end].to_owned()
}

#[test]
fn a_table_is_gone_on_with_and_another_is_refused() {
    let folder = folder();
    folder.works(&trade("2", &["-q"]));
    let whole = folder.read("out/trade.csv");
    std::fs::write(folder.path("out/trade.csv"), &whole[..whole.len() - 40]).unwrap();
    folder.works(&trade("2", &["-q"]));
    let kept = |bytes: &[u8]| bytes[..whole.len() - 400].to_vec();
    assert_eq!(
        kept(&folder.read("out/trade.csv")),
        kept(&whole),
        "rows are not measured again"
    );
    for (more, words) in [
        (&["--seed", "1"][..], "another seed: 0, not 1"),
        (&["--set", "film.width=7"], "another scene hash"),
    ] {
        let errors = folder.fails(2, &trade("2", more));
        assert!(errors.contains(words), "{errors}");
    }
}

#[test]
fn wrong_requests_and_files_are_told_apart() {
    let folder = folder();
    std::fs::write(folder.path("taken"), "").unwrap();
    for (code, arguments, words) in [
        (2, &["missing.yaml", "-o", "out"][..], "QRT0101"),
        (2, &["lit.yaml"], "--output"),
        (2, &["lit.yaml", "-o", "taken"], "is no folder"),
        (2, &["lit.yaml", "-o", "-"], "standard output, `-`,"),
        (1, &["lit.yaml", "-o", "taken/out"], "taken/out"),
        (2, &["lit.yaml", "-o", "out", "--pixels", "0"], "--pixels"),
        (
            2,
            &["lit.yaml", "-o", "out", "--set", "film.widt=3"],
            "QRT0120",
        ),
        (
            2,
            &[
                "lit.yaml",
                "-o",
                "out",
                "--set",
                "precision.fraction=30",
                "--set",
                "camera.perspective.eye=[0, 1, 4e11]",
            ],
            "QRT06",
        ),
    ] {
        let errors = folder.fails(code, &[&["trade"], arguments].concat());
        assert!(errors.contains(words), "{arguments:?}: {errors}");
    }
    assert!(!folder.path("out/trade.csv").exists());
    assert!(!folder.path("-").exists());
}

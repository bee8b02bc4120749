//! Formulas: KaTeX converts LaTeX to HTML and MathML while the book is built.
//!
//! KaTeX is JavaScript, and runs in QuickJS. A formula takes milliseconds, so the formulas of the last
//! build are cached in a file.

use anyhow::{Context as _, Result, anyhow};
use rquickjs::{CatchResultExt as _, CaughtError, Context, Function, Runtime};
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::{Path, PathBuf};

/// KaTeX 0.19.1, as on npm. Its style sheet and fonts, of the same version, are in `book/src/katex`.
const KATEX: &str = include_str!("../katex/katex.min.js");

/// The script that calls KaTeX: for visual HTML, MathML for screen readers, and an error for
/// everything that LaTeX would refuse. It removes the source text from the MathML, which would make
/// pages larger and appear in searches, and what HTML does not need: names of spaces, and the element
/// around the source text.
const RENDER: &str = r#"(tex, display) => katex
    .renderToString(tex, { displayMode: display, output: "htmlAndMathml", strict: "error" })
    .replace(/<annotation [^>]*>[^<]*<\/annotation>/, "")
    .replace(/<\/?semantics>| xmlns="[^"]*"/g, "")
    .replaceAll(";\"", "\"")"#;

/// Renders formulas, and caches them.
pub(crate) struct Formulas {
    /// Created for the first formula that is not in the cache.
    engine: Option<Engine>,
    known: BTreeMap<String, String>,
    used: BTreeMap<String, String>,
    /// File of the cache, which later builds read.
    kept: Option<PathBuf>,
}

struct Engine {
    context: Context,
    _runtime: Runtime,
}

impl Formulas {
    /// Creates an empty cache without a file.
    pub(crate) fn new() -> Self {
        Self {
            engine: None,
            known: BTreeMap::new(),
            used: BTreeMap::new(),
            kept: None,
        }
    }

    /// Loads the cache of an earlier build from `folder`, if the same KaTeX made it.
    pub(crate) fn kept_in(folder: &Path) -> Self {
        let mut hasher = DefaultHasher::new();
        (KATEX, RENDER).hash(&mut hasher);
        let file = folder.join(format!("formulas-{:016x}.json", hasher.finish()));
        let known = std::fs::read(&file)
            .ok()
            .and_then(|bytes| serde_json::from_slice(&bytes).ok())
            .unwrap_or_default();
        Self {
            known,
            kept: Some(file),
            ..Self::new()
        }
    }

    /// Returns the HTML of a formula; the error is KaTeX's message.
    pub(crate) fn render(&mut self, tex: &str, display: bool) -> Result<String> {
        let key = format!("{}{tex}", if display { "$$" } else { "$" });
        if let Some(html) = self.used.get(&key).or_else(|| self.known.get(&key)) {
            let html = html.clone();
            self.used.insert(key, html.clone());
            return Ok(html);
        }
        let engine = match &mut self.engine {
            Some(engine) => engine,
            none => none.insert(Engine::start()?),
        };
        let html = engine.render(tex, display)?;
        self.used.insert(key, html.clone());
        Ok(html)
    }

    /// Saves the formulas that this build used, for the next build.
    pub(crate) fn save(&self) -> Result<()> {
        let Some(file) = &self.kept else {
            return Ok(());
        };
        if self.engine.is_none() && self.used.len() == self.known.len() {
            return Ok(());
        }
        if let Some(folder) = file.parent() {
            // Remove the caches of other versions of KaTeX.
            let _ = std::fs::remove_dir_all(folder);
            std::fs::create_dir_all(folder)
                .with_context(|| format!("cannot make the folder {}", folder.display()))?;
        }
        std::fs::write(file, serde_json::to_vec(&self.used)?)
            .with_context(|| format!("cannot write {}", file.display()))
    }
}

impl Engine {
    fn start() -> Result<Self> {
        let runtime = Runtime::new()?;
        runtime.set_max_stack_size(4 << 20);
        let context = Context::full(&runtime)?;
        context.with(|ctx| {
            ctx.eval::<(), _>(KATEX)
                .catch(&ctx)
                .map_err(|error| anyhow!("KaTeX does not start: {error}"))?;
            ctx.eval::<(), _>(format!("globalThis.render = {RENDER}"))
                .catch(&ctx)
                .map_err(|error| anyhow!("KaTeX does not start: {error}"))
        })?;
        Ok(Self {
            context,
            _runtime: runtime,
        })
    }

    fn render(&self, tex: &str, display: bool) -> Result<String> {
        self.context.with(|ctx| {
            let render: Function<'_> = ctx.globals().get("render")?;
            render
                .call((tex, display))
                .catch(&ctx)
                .map_err(|error| match error {
                    CaughtError::Exception(exception) => {
                        anyhow!("{}", plain(&exception.message().unwrap_or_default()))
                    }
                    other => anyhow!("{other}"),
                })
        })
    }
}

/// Removes the combining characters with which KaTeX underlines an error: few terminals show them.
fn plain(message: &str) -> String {
    message
        .chars()
        .filter(|&c| c != '\u{332}')
        .map(|c| if c == '\n' { ' ' } else { c })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_formula_becomes_html_and_mathml() {
        let mut formulas = Formulas::new();
        let html = formulas.render(r"\frac{a}{b}", false).unwrap();
        assert!(html.contains("<mfrac><mi>a</mi><mi>b</mi></mfrac>"));
        assert!(html.contains("class=\"katex-html\" aria-hidden=\"true\""));
        assert!(!html.contains("semantics") && !html.contains("xmlns"));
        assert!(!html.contains("annotation") && !html.contains("katex-display"));
        assert!(
            formulas
                .render("a", true)
                .unwrap()
                .contains("katex-display")
        );
    }

    #[test]
    fn a_bad_formula_is_refused_in_katexs_words() {
        let error = Formulas::new().render(r"a + \nothing", false).unwrap_err();
        assert!(
            error
                .to_string()
                .contains(r"Undefined control sequence: \nothing at position 5")
        );
    }

    #[test]
    fn formulas_are_kept_from_build_to_build() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("cache");
        let mut first = Formulas::kept_in(&folder);
        let html = first.render("x", false).unwrap();
        first.save().unwrap();
        let mut second = Formulas::kept_in(&folder);
        assert_eq!(second.render("x", false).unwrap(), html);
        assert!(second.engine.is_none(), "rendered again");
    }

    #[test]
    fn where_formulas_cannot_be_kept_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, "").unwrap();
        let mut formulas = Formulas::kept_in(&file.join("cache"));
        formulas.render("x", false).unwrap();
        let error = formulas.save().unwrap_err();
        let expected = format!("cannot make the folder {}", file.join("cache").display());
        assert_eq!(error.to_string(), expected);
    }
}

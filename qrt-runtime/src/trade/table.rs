//! `trade.csv`: one row a setting, written as each is finished.
//!
//! The first line names what the rows depend on; a table of anything else is refused. The second
//! names the columns, which the module above describes.

use super::band::Band;
use super::error::TradeError;
use super::setting::{KEY, Setting};
use qrt_core::oracle::CallCost;
use std::fs::{File, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Errors of a row, in their order.
pub const ERRORS: [&str; 6] = ["e_r", "e_c", "e_w", "e_t", "e_d", "e_total"];

/// Columns of figures before and after those of errors.
const FIGURES: [&str; 5] = ["queries", "toffoli", "qubits", "toffoli_x_queries", "mean"];
/// How many columns the table has.
const COLUMNS: usize = KEY.len() + FIGURES.len() + 3 * ERRORS.len() + 1;

/// A finished row of the table: one setting, and what was measured of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The setting that the row is about.
    pub setting: Setting,
    /// Queries of a pixel, all channels together.
    pub queries: f64,
    /// Qubits and Toffolis of one call of the oracle.
    pub cost: CallCost,
    /// The mean radiance over pixels and channels.
    pub mean: f64,
    /// The errors in the order of [`ERRORS`], relative to the mean.
    pub errors: [Band; ERRORS.len()],
    /// Wall time of a pixel.
    pub seconds: f64,
}

impl Row {
    /// Toffolis of all queries of a pixel.
    pub fn toffoli_x_queries(&self) -> f64 {
        self.cost.toffoli as f64 * self.queries
    }

    fn line(&self) -> String {
        let mut values = self.setting.values().to_vec();
        values.push(number(self.queries));
        values.push(self.cost.toffoli.to_string());
        values.push(self.cost.qubits.to_string());
        values.push(number(self.toffoli_x_queries()));
        values.push(number(self.mean));
        for Band { value, low, high } in self.errors {
            values.extend([value, low, high].map(number));
        }
        values.push(number(self.seconds));
        values.join(",")
    }

    /// Reads a line whose setting is known.
    fn read(setting: Setting, line: &str) -> Option<Self> {
        let cells: Vec<&str> = line.split(',').collect();
        if cells.len() != COLUMNS || cells[..KEY.len()] != setting.values() {
            return None;
        }
        let cells = &cells[KEY.len()..];
        let float = |at: usize| cells[at].parse::<f64>().ok().filter(|x| x.is_finite());
        let mut errors = [Band::default(); ERRORS.len()];
        for (k, band) in errors.iter_mut().enumerate() {
            let at = FIGURES.len() + 3 * k;
            *band = Band {
                value: float(at)?,
                low: float(at + 1)?,
                high: float(at + 2)?,
            };
        }
        Some(Self {
            setting,
            queries: float(0)?,
            cost: CallCost {
                toffoli: cells[1].parse().ok()?,
                qubits: cells[2].parse().ok()?,
            },
            mean: float(4)?,
            errors,
            seconds: float(cells.len() - 1)?,
        })
    }
}

/// Six digits; enough to be read, and the same from every run.
fn number(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else {
        format!("{value:.5e}")
    }
}

/// What the rows of a table depend on, by name.
pub(super) type Header = Vec<(&'static str, String)>;

/// A table that grows.
pub(super) struct Table {
    file: File,
    path: PathBuf,
    /// Lines that an earlier run has left, not looked up yet.
    left: Vec<String>,
}

impl Table {
    /// Goes on with the table at `path`, or begins it.
    pub(super) fn open(path: &Path, header: &Header) -> Result<Self, TradeError> {
        let failed = |source| TradeError::File {
            path: path.to_path_buf(),
            source,
        };
        let text = match std::fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(failed(error)),
        };
        let first = first_line(header);
        let columns = columns();
        // A last line without its end was cut off while it was written.
        let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
        let mut lines = whole.lines();
        let mut left = Vec::new();
        if let Some(found) = lines.next() {
            check(path, found, header)?;
            if lines.next().is_some_and(|line| line != columns) {
                let path = path.to_path_buf();
                return Err(TradeError::Unreadable { path, line: 2 });
            }
            left.extend(lines.map(str::to_owned));
        }
        let mut file = OpenOptions::new()
            .create(true)
            .truncate(false)
            .write(true)
            .open(path)
            .map_err(failed)?;
        let begun = whole.lines().count() >= 2;
        file.set_len(if begun { whole.len() as u64 } else { 0 })
            .map_err(failed)?;
        std::io::Seek::seek(&mut file, std::io::SeekFrom::End(0)).map_err(failed)?;
        if !begun {
            writeln!(file, "{first}\n{columns}").map_err(failed)?;
        }
        Ok(Self {
            file,
            path: path.to_path_buf(),
            left,
        })
    }

    /// The rows of these settings that an earlier run has left.
    pub(super) fn found(&self, settings: &[Setting]) -> Result<Vec<Option<Row>>, TradeError> {
        let mut rows = vec![None; settings.len()];
        for (number, line) in self.left.iter().enumerate() {
            let row = (settings.iter().enumerate())
                .find_map(|(at, &setting)| Some((at, Row::read(setting, line)?)));
            let Some((at, row)) = row else {
                return Err(TradeError::Unreadable {
                    path: self.path.clone(),
                    line: number + 3,
                });
            };
            rows[at] = Some(row);
        }
        Ok(rows)
    }

    /// Writes a finished row; and gives it back as it will be read again.
    pub(super) fn append(&mut self, row: &Row) -> Result<Row, TradeError> {
        let failed = |source| TradeError::File {
            path: self.path.clone(),
            source,
        };
        let line = row.line();
        writeln!(self.file, "{line}").map_err(failed)?;
        Ok(Row::read(row.setting, &line).unwrap_or(*row))
    }
}

/// `# qrt trade: scene_hash=..., seed=0`.
fn first_line(header: &Header) -> String {
    let parts: Vec<String> = header
        .iter()
        .map(|(name, value)| format!("{name}={value}"))
        .collect();
    format!("# qrt trade: {}", parts.join(", "))
}

fn columns() -> String {
    let errors = ERRORS.map(|name| format!("{name},{name}_low,{name}_high"));
    let (key, figures, errors) = (KEY.join(","), FIGURES.join(","), errors.join(","));
    format!("{key},{figures},{errors},seconds")
}

/// That the first line of a table names the same things.
fn check(path: &Path, found: &str, header: &Header) -> Result<(), TradeError> {
    let Some(parts) = found.strip_prefix("# qrt trade: ") else {
        return Err(TradeError::Unreadable {
            path: path.to_path_buf(),
            line: 1,
        });
    };
    for (name, asked) in header {
        let value = parts
            .split(", ")
            .find_map(|part| part.strip_prefix(name)?.strip_prefix('='));
        if value != Some(asked) {
            return Err(TradeError::Differs {
                path: path.to_path_buf(),
                what: name.replace('_', " "),
                found: value.unwrap_or("none").to_owned(),
                asked: asked.clone(),
            });
        }
    }
    Ok(())
}

//! `trade.csv`: one row per setting, written as soon as it is finished.
//!
//! The first line names the values that the rows depend on; a table with other values is refused.
//! The second names the columns, which the parent module describes. The last column is the CRC-32
//! of the row before it: a row with a wrong CRC-32 is damaged, and left out.

use super::band::Band;
use super::error::TradeError;
use super::setting::{KEY, Setting};
use qrt_core::oracle::CallCost;
use qrt_runtime::disk::read_regular;
use qrt_runtime::line_file::LineFile;
use std::io;
use std::path::{Path, PathBuf};

/// Errors of a row, in their order.
pub const ERRORS: [&str; 6] = ["e_r", "e_c", "e_w", "e_t", "e_d", "e_total"];

/// Indices of errors in [`ERRORS`] and in a row.
pub(super) const PATHS: usize = 0;
pub(super) const COMPARATORS: usize = 1;
pub(super) const WIDTH: usize = 2;
pub(super) const COUNTING: usize = 3;
pub(super) const DEPTH: usize = 4;
pub(super) const TOTAL: usize = 5;

/// Names of the errors on plots and pages, in the order of [`ERRORS`].
pub(super) const ERROR_NAMES: [&str; ERRORS.len()] = [
    "paths, E_R",
    "comparators, E_C",
    "width, E_W",
    "counting, E_T",
    "depth, E_D",
    "total",
];

/// Columns of figures before those of errors.
const FIGURES: [&str; 5] = ["queries", "toffoli", "qubits", "toffoli_x_queries", "mean"];
/// Number of columns of the table, without that of checksums.
const COLUMNS: usize = KEY.len() + FIGURES.len() + 3 * ERRORS.len() + 1;

/// A finished row of the table: one setting and its measurements.
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
    /// Wall time of a pixel, in seconds.
    pub seconds: f64,
}

impl Row {
    /// Toffolis of all queries of a pixel.
    pub(crate) fn toffoli_x_queries(&self) -> f64 {
        self.cost.toffoli as f64 * self.queries
    }

    /// The names and values of the row's columns, in the order of `trade.csv`, without the checksum. A value
    /// is a number, or a word.
    pub fn cells(&self) -> Vec<(String, String)> {
        let names = columns();
        let names = names.split(',').map(str::to_owned);
        names.zip(self.values()).collect()
    }

    fn line(&self) -> String {
        self.values().join(",")
    }

    fn values(&self) -> Vec<String> {
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
        values
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

/// A number with six digits: enough to be read, and the same from every run.
fn number(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else {
        format!("{value:.5e}")
    }
}

/// Names and values that the rows of a table depend on.
pub(super) type Header = Vec<(&'static str, String)>;

/// A table that rows are appended to.
pub(super) struct Table {
    /// The table's file, locked against other processes.
    file: LineFile,
    path: PathBuf,
    /// The first two lines.
    head: String,
    /// For each setting: its line.
    lines: Vec<Option<String>>,
    /// For each setting: the row that an earlier run has left.
    pub(super) found: Vec<Option<Row>>,
    /// Number of rows that were damaged.
    pub(super) damaged: usize,
}

/// The contents of a table's file.
pub(super) struct Contents {
    /// For each setting: its line.
    lines: Vec<Option<String>>,
    /// For each setting: its row.
    pub(super) rows: Vec<Option<Row>>,
    /// Number of damaged rows.
    pub(super) damaged: usize,
    /// Offset of the end of the complete lines, if the first two are complete.
    end: Option<u64>,
}

/// Reads the table of `settings` at `path`, without changing it.
pub(super) fn read(
    path: &Path,
    header: &Header,
    settings: &[Setting],
) -> Result<Contents, TradeError> {
    let bytes = read_regular(path).map_err(failed(path))?;
    Contents::read(&bytes, path, header, settings)
}

/// Checks that no two tables have different rows of a setting, apart from the time.
pub(super) fn agree(
    tables: &[(&Path, &[Option<Row>])],
    settings: &[Setting],
) -> Result<(), TradeError> {
    for (at, setting) in settings.iter().enumerate() {
        let timeless = |row: Row| Row {
            seconds: 0.0,
            ..row
        };
        let rows = tables.iter();
        let mut rows = rows.filter_map(|(path, rows)| Some((path, rows[at].map(timeless)?)));
        let Some((first, row)) = rows.next() else {
            continue;
        };
        if let Some((path, _)) = rows.find(|(_, other)| *other != row) {
            return Err(TradeError::Disagree {
                path: path.to_path_buf(),
                first: first.to_path_buf(),
                setting: setting.values().join(","),
            });
        }
    }
    Ok(())
}

impl Contents {
    fn read(
        bytes: &[u8],
        path: &Path,
        header: &Header,
        settings: &[Setting],
    ) -> Result<Self, TradeError> {
        // Bytes that are not text count as damage.
        let text = String::from_utf8_lossy(bytes);
        // A last line without its end was cut off while it was written.
        let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
        let unreadable = |line| {
            let path = path.to_path_buf();
            TradeError::Unreadable { path, line }
        };
        let mut lines = whole.lines();
        if whole.is_empty() && !head(header).as_bytes().starts_with(bytes) {
            return Err(unreadable(1));
        }
        if let Some(found) = lines.next() {
            check(path, found, header)?;
            if lines.next().is_some_and(|line| line != columns()) {
                return Err(unreadable(2));
            }
        }
        let mut contents = Self {
            lines: vec![None; settings.len()],
            rows: vec![None; settings.len()],
            damaged: 0,
            end: (whole.lines().count() >= 2).then_some(whole.len() as u64),
        };
        for (number, line) in lines.enumerate() {
            let Some(row) = checked(line) else {
                contents.damaged += 1;
                continue;
            };
            let mut rows = (settings.iter().enumerate())
                .filter_map(|(at, &setting)| Some((at, Row::read(setting, row)?)));
            let (at, row) = rows.next().ok_or_else(|| unreadable(number + 3))?;
            contents.lines[at] = Some(line.to_owned());
            contents.rows[at] = Some(row);
        }
        Ok(contents)
    }
}

impl Table {
    /// Opens the table of `settings` at `path`, or creates it. Removes damaged rows from it.
    pub(super) fn open(
        path: &Path,
        header: &Header,
        settings: &[Setting],
    ) -> Result<Self, TradeError> {
        let failed = failed(path);
        let file = LineFile::open(path).map_err(&failed)?;
        let mut file = file.ok_or_else(|| TradeError::InUse {
            path: path.to_path_buf(),
        })?;
        let bytes = file.read().map_err(&failed)?;
        let read = Contents::read(&bytes, path, header, settings)?;
        let mut table = Self {
            file,
            path: path.to_path_buf(),
            head: head(header),
            lines: read.lines,
            found: read.rows,
            damaged: read.damaged,
        };
        if table.damaged > 0 {
            table.rewrite()?;
        } else if let Some(end) = read.end {
            table.file.truncate(end).map_err(&failed)?;
        } else {
            table.file.start(&table.head).map_err(&failed)?;
        }
        Ok(table)
    }

    /// Writes a finished row durably, and returns it as it will be read again.
    pub(super) fn append(&mut self, at: usize, row: &Row) -> Result<Row, TradeError> {
        let line = row.line();
        let summed = format!("{line},{:08x}", crc32fast::hash(line.as_bytes()));
        self.write(at, summed)?;
        Ok(Row::read(row.setting, &line).unwrap_or(*row))
    }

    /// Writes the row of setting `at` as it is in another table, and returns it.
    pub(super) fn take_over(
        &mut self,
        at: usize,
        other: &Contents,
    ) -> Result<Option<Row>, TradeError> {
        if let Some(line) = &other.lines[at] {
            self.write(at, line.clone())?;
        }
        Ok(other.rows[at])
    }

    fn write(&mut self, at: usize, summed: String) -> Result<(), TradeError> {
        let appended = self.file.append(&format!("{summed}\n"));
        appended.map_err(failed(&self.path))?;
        self.lines[at] = Some(summed);
        self.keep_name()
    }

    /// Rewrites the table if its file was removed, perhaps with its folder.
    fn keep_name(&mut self) -> Result<(), TradeError> {
        let removed = self.file.is_removed().map_err(failed(&self.path))?;
        if removed {
            self.rewrite()?;
        }
        Ok(())
    }

    /// Moves rows that were measured again to their places.
    pub(super) fn finish(mut self) -> Result<(), TradeError> {
        if self.damaged > 0 {
            self.rewrite()?;
        }
        self.keep_name()
    }

    /// Rewrites the table, and continues at its end.
    fn rewrite(&mut self) -> Result<(), TradeError> {
        let mut text = self.head.clone();
        for line in self.lines.iter().flatten() {
            text.push_str(line);
            text.push('\n');
        }
        self.file.replace(&text).map_err(failed(&self.path))
    }
}

fn failed(path: &Path) -> impl Fn(io::Error) -> TradeError + use<> {
    let path = path.to_path_buf();
    move |source| TradeError::File {
        path: path.clone(),
        source,
    }
}

/// A row without its checksum, or `None` if the checksum is wrong.
pub(super) fn checked(line: &str) -> Option<&str> {
    let (row, sum) = line.rsplit_once(',')?;
    let right = format!("{:08x}", crc32fast::hash(row.as_bytes()));
    (sum == right).then_some(row)
}

/// The first two lines.
fn head(header: &Header) -> String {
    format!("{}\n{}\n", first_line(header), columns())
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
    format!("{key},{figures},{errors},seconds,crc32")
}

/// Checks that the first line of a table has the values of `header`.
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

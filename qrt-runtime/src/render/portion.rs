//! A fraction of a picture's pixels, for one of several processes.

use std::fmt;
use std::str::FromStr;

/// Portion `index` of the `count` portions of a picture, written `index/count`: `0/4` is the first
/// of four. Every pixel is in exactly one portion. The pixels of a portion are in small rectangles
/// all over the picture, so that all portions take about the same time.
///
/// ```
/// use qrt_runtime::render::Portion;
/// let last: Portion = "3/4".parse()?;
/// assert_eq!((last.index(), last.count()), (3, 4));
/// assert_eq!(last.to_string(), "3/4");
/// assert!("4/4".parse::<Portion>().is_err());
/// # Ok::<(), qrt_runtime::render::PortionError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Portion {
    index: u32,
    count: u32,
}

/// An error that a text or numbers do not name a portion.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PortionError {
    /// The text is not two numbers with a slash between them.
    #[error("`{0}` is not K/N, such as 0/4 for the first of four")]
    Text(String),
    /// The number of portions is 0.
    #[error("a picture is not cut into 0 portions")]
    None,
    /// The index is not below the number of portions.
    #[error("there is no portion {index} of {count}: they are 0/{count} to {}/{count}", .count - 1)]
    Beyond {
        /// The requested index, counted from 0.
        index: u32,
        /// Number of portions.
        count: u32,
    },
}

impl Default for Portion {
    fn default() -> Self {
        Self::WHOLE
    }
}

impl Portion {
    /// The portion that is the whole picture.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Creates portion `index`, counted from 0, of `count`.
    ///
    /// # Errors
    /// If `count` is 0, or `index` is not below `count`.
    pub fn new(index: u32, count: u32) -> Result<Self, PortionError> {
        match count {
            0 => Err(PortionError::None),
            _ if index < count => Ok(Self { index, count }),
            _ => Err(PortionError::Beyond { index, count }),
        }
    }

    /// Returns whether item `number` of a list belongs to this portion, if items are dealt one by
    /// one, like cards.
    pub fn takes(self, number: usize) -> bool {
        number % self.count as usize == self.index as usize
    }

    /// Returns the index of the portion, counted from 0.
    pub fn index(self) -> u32 {
        self.index
    }

    /// Returns the number of portions.
    pub fn count(self) -> u32 {
        self.count
    }
}

impl FromStr for Portion {
    type Err = PortionError;

    fn from_str(text: &str) -> Result<Self, PortionError> {
        let numbers = text.split_once('/').and_then(|(index, count)| {
            let number = |text: &str| text.trim().parse().ok();
            Some((number(index)?, number(count)?))
        });
        let (index, count) = numbers.ok_or_else(|| PortionError::Text(text.to_owned()))?;
        Self::new(index, count)
    }
}

impl fmt::Display for Portion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

//! A fraction of a picture's pixels, for one of several processes.

use std::fmt;
use std::str::FromStr;

/// Portion `index` of `count` that a picture is cut into, written `index/count`: `0/4` is the first of
/// four. Together the portions have every pixel once. Their pixels lie in small rectangles all over
/// the picture, so that all portions take about as long.
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

/// What is no portion of a picture.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PortionError {
    /// Not two numbers with a slash between them.
    #[error("`{0}` is not K/N, such as 0/4 for the first of four")]
    Text(String),
    /// A picture is cut into one portion at least.
    #[error("a picture is not cut into 0 portions")]
    None,
    /// There is none of this number.
    #[error("there is no portion {index} of {count}: they are 0/{count} to {}/{count}", .count - 1)]
    Beyond {
        /// The number that was asked for, from 0.
        index: u32,
        /// How many there are.
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

    /// Portion `index`, from 0, of `count`.
    ///
    /// # Errors
    /// If there is none of this number.
    pub fn new(index: u32, count: u32) -> Result<Self, PortionError> {
        match count {
            0 => Err(PortionError::None),
            _ if index < count => Ok(Self { index, count }),
            _ => Err(PortionError::Beyond { index, count }),
        }
    }

    /// Whether item `number` of a list that is dealt out one by one, as cards are, is in it.
    pub fn takes(self, number: usize) -> bool {
        number % self.count as usize == self.index as usize
    }

    /// Its number, from 0.
    pub fn index(self) -> u32 {
        self.index
    }

    /// How many portions there are.
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

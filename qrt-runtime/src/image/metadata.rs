//! Metadata of a picture: names and values that record how it was made.

use super::ImageError;

/// Prefix of every key in a file, which keeps it apart from the format's own keys.
pub(super) const PREFIX: &str = "qrt:";

/// The longest key. With [`PREFIX`] it has 31 bytes, those of an EXR attribute's short name; PNG
/// allows 79.
const LONGEST_KEY: usize = 31 - PREFIX.len();

/// Keys and values in the order in which they were set. In a file, each key is written as
/// `qrt:KEY`.
///
/// ```
/// use qrt_runtime::image::Metadata;
/// let mut metadata = Metadata::new();
/// metadata.set("seed", "7")?;
/// metadata.set("model", "real")?;
/// assert_eq!(metadata.get("seed"), Some("7"));
/// assert!(metadata.set("not a key", "").is_err());
/// # Ok::<(), qrt_runtime::image::ImageError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Metadata(Vec<(String, String)>);

impl Metadata {
    /// Creates metadata without any key.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the value of a key, and replaces an earlier value.
    ///
    /// # Errors
    /// If the key is not 1 to 27 ASCII letters, digits, `_` or `-`, or if the value contains a NUL
    /// or is not shorter than 2 GiB.
    pub fn set(&mut self, key: &str, value: impl Into<String>) -> Result<(), ImageError> {
        let allowed = |b: u8| b.is_ascii_alphanumeric() || b == b'_' || b == b'-';
        if key.is_empty() || key.len() > LONGEST_KEY || !key.bytes().all(allowed) {
            return Err(ImageError::Key {
                key: key.to_owned(),
            });
        }
        let value = value.into();
        if value.contains('\0') || i32::try_from(value.len()).is_err() {
            return Err(ImageError::Value {
                key: key.to_owned(),
            });
        }
        match self.0.iter_mut().find(|(k, _)| k == key) {
            Some((_, old)) => *old = value,
            None => self.0.push((key.to_owned(), value)),
        }
        Ok(())
    }

    /// Returns the value of a key, if the key is set.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.iter()
            .find_map(|(k, value)| (k == key).then_some(value))
    }

    /// Iterates over all keys and values.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0
            .iter()
            .map(|(key, value)| (key.as_str(), value.as_str()))
    }
}

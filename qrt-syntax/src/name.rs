//! Formats lists of names, and finds the nearest name to a misspelt one.

/// Lists `names` in backticks, with `last` before the final one: `` `a`, `b` and `c` ``.
pub fn listed<T: AsRef<str>>(names: &[T], last: &str) -> String {
    let quoted: Vec<_> = names
        .iter()
        .map(|name| format!("`{}`", name.as_ref()))
        .collect();
    match quoted.split_last() {
        None => String::new(),
        Some((only, [])) => only.clone(),
        Some((end, rest)) => format!("{} {last} {end}", rest.join(", ")),
    }
}

/// Returns the name that `text` probably misspells. The edit distance, ignoring case, is at most a
/// third of the longer one's letters, or 1 if that is more. A missing ending counts as one letter.
pub fn nearest<'a>(text: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Real names are shorter, and comparing long ones is slow.
    const LONGEST: usize = 64;
    let lower = text.to_lowercase();
    let candidates = names.into_iter().filter_map(|name| {
        let length = name.chars().count().max(lower.chars().count());
        if length > LONGEST {
            return None;
        }
        let is_start = lower.len() > 2 && name.starts_with(&lower);
        let distance = if is_start {
            1
        } else {
            strsim::osa_distance(&lower, &name.to_lowercase())
        };
        (distance <= (length / 3).max(1) && distance < length).then_some((distance, name))
    });
    candidates
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found_and_far_ones_are_not() {
        let names = ["white", "red", "green", "light"];
        assert_eq!(nearest("whit", names), Some("white"));
        assert_eq!(nearest("WHITE", names), Some("white"));
        assert_eq!(nearest("rde", names), Some("red"));
        assert_eq!(nearest("lihgt", names), Some("light"));
        assert_eq!(nearest("purple", names), None);
        assert_eq!(nearest("gre", names), Some("green"));
        assert_eq!(nearest("", names), None);
    }
}

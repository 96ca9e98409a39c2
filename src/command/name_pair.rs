//! Flags that give one thing the name of another.

/// `A=B` as two names.
pub(super) fn name_pair(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((left, right)) if !left.is_empty() && !right.is_empty() => Ok((left.to_string(), right.to_string())),
        _ => Err(format!("{text:?} is no pair, expected two names with `=` between them")),
    }
}

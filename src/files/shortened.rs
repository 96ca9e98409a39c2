//! Text from a file in a message.

/// What a message quotes from a file: damaged files hold cells, keys and names of any length, and characters that would
/// break the line.
pub fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    let text = text.trim();
    let mut short: String = text.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if text.chars().nth(LONGEST).is_some() {
        short.push('…');
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_stay_on_one_line() {
        let short = shortened(&"a\nb".repeat(100));
        assert!(!short.contains('\n') && short.ends_with('…') && short.len() < 100, "{short}");
        assert_eq!(shortened(" pelvis é "), "pelvis é");
    }
}

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

/// A message as one line that can be read: paths and names may hold line ends, codes that a terminal obeys, and thousands of letters. Of
/// words that are too long beginning and end stay, which tell paths apart.
pub fn one_line(message: &str) -> String {
    const LONGEST: usize = 300;
    let cut = |word: &str| {
        let letters: Vec<char> = word.chars().collect();
        if letters.len() <= LONGEST {
            return word.to_string();
        }
        let [begin, end] = [&letters[..LONGEST / 3], &letters[letters.len() - LONGEST / 3..]];
        begin.iter().chain(&['…']).chain(end).collect()
    };
    let words: Vec<String> = message.split(' ').map(cut).collect();
    let escaped = |c: char| if c.is_control() { c.escape_debug().to_string() } else { c.to_string() };
    words.join(" ").chars().map(escaped).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_stay_on_one_line() {
        let short = shortened(&"a\nb".repeat(100));
        assert!(!short.contains('\n') && short.ends_with('…') && short.len() < 100, "{short}");
        assert_eq!(shortened(" pelvis é "), "pelvis é");
        assert_eq!(one_line("cannot read é\n\u{1b}[2J: gone"), "cannot read é\\n\\u{1b}[2J: gone");
        let long = one_line(&format!("cannot read {}.mp4: gone", "x".repeat(5000)));
        assert!(long.starts_with("cannot read xxx") && long.ends_with("xxx.mp4: gone") && long.len() < 260, "{long}");
    }
}

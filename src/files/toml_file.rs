//! One way to read a TOML file, with one kind of error sentence.

use std::path::Path;

use anyhow::{Result, anyhow};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Limit, listed, nearest, one_line, shortened};

/// Files a person edits are small; anything larger is a mistake (a video handed over as a body, say) and reading it
/// whole would only waste memory.
const TOML: Limit = Limit { what: "a TOML file", most: 16 << 20 };

/// Reads a TOML file into `T`. Mark the structures of `T` with `#[serde(deny_unknown_fields)]`.
///
/// # Errors
/// One sentence with the file, the line, what was found and what was expected; an unknown key is named with the
/// nearest known one.
pub fn read_toml<T: DeserializeOwned>(path: &Path) -> Result<T> {
    parse_toml(&TOML.read_text(path)?, &path.display().to_string())
}

/// [`read_toml`] for text already in memory; `name` stands for the file in messages.
///
/// # Errors
/// As [`read_toml`].
pub fn parse_toml<T: DeserializeOwned>(text: &str, name: &str) -> Result<T> {
    toml::from_str(text).map_err(|error| {
        let line = error.span().map(|span| text[..span.start.min(text.len())].matches('\n').count() + 1);
        let place = line.map_or_else(|| name.to_string(), |line| format!("{name}, line {line}"));
        anyhow!("{place}: {}", one_sentence(error.message()))
    })
}

/// [`read_toml`] for a table of a file already read; `name` stands for the file and the table in messages.
///
/// # Errors
/// As [`read_toml`], with the name instead of the line.
pub fn parse_table<T: DeserializeOwned>(table: &toml::Table, name: &str) -> Result<T> {
    // By its text, so that every structure is read one way: reading a table itself is another parser for each, compiled once more.
    let read = toml::to_string(table).map_err(|error| anyhow!("{name}: {error}"))?;
    toml::from_str(&read).map_err(|error| anyhow!("{name}: {}", one_sentence(error.message())))
}

/// What a value would be as a file.
///
/// # Errors
/// When that is no table.
pub fn table_of<T: Serialize>(value: &T) -> Result<toml::Table> {
    // JSON's text has the shortest decimal of a single-precision number, TOML's would have that of its double.
    Ok(serde_json::from_str(&serde_json::to_string(value)?)?)
}

/// serde's "unknown field `x`, expected one of `a`, `b`" with the nearest known key put first.
fn one_sentence(message: &str) -> String {
    let message = one_line(&message.trim().replace('\n', ", "));
    let Some(rest) = message.strip_prefix("unknown field `") else { return message };
    let mut quoted = rest.split('`');
    let Some(found) = quoted.next() else { return message };
    let found = &shortened(found);
    // What follows alternates between text and quoted names.
    let known: Vec<&str> = quoted.skip(1).step_by(2).collect();
    match nearest(found, known.iter().copied()) {
        Some(nearest) => {
            format!("unknown key `{found}`, the nearest known key is `{nearest}` (known: {})", listed(&known))
        }
        None => format!("unknown key `{found}`, expected none here"),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[derive(serde::Deserialize, Debug)]
    #[serde(deny_unknown_fields)]
    #[allow(dead_code, reason = "only what reading says of it is looked at")]
    struct Settings {
        fps: f64,
        #[serde(default)]
        scale: f64,
    }

    #[test]
    fn an_unknown_key_names_the_nearest() {
        let error = parse_toml::<Settings>("fps = 25.0\nscael = 0.5\n", "sequence.toml").unwrap_err().to_string();
        assert!(error.contains("sequence.toml, line 2"), "{error}");
        assert!(error.contains("`scael`") && error.contains("nearest known key is `scale`"), "{error}");
    }

    #[test]
    fn a_wrong_type_names_the_line() {
        let error = parse_toml::<Settings>("\nfps = \"fast\"\n", "sequence.toml").unwrap_err().to_string();
        assert!(error.contains("line 2") && error.contains("string"), "{error}");
    }

    #[test]
    fn missing_and_broken_files() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.toml");
        assert!(format!("{:#}", read_toml::<Settings>(&path).unwrap_err()).contains("s.toml"));
        fs::write(&path, [0xff, 0xfe]).unwrap();
        assert!(format!("{:#}", read_toml::<Settings>(&path).unwrap_err()).contains("UTF-8"));
        fs::write(&path, "").unwrap();
        assert!(format!("{:#}", read_toml::<Settings>(&path).unwrap_err()).contains("missing field `fps`"));
    }
}

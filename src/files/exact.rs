//! Lists of a fixed length in files.

use serde::de::{Deserialize, Deserializer, Error};

/// Reads a list that has neither fewer nor more entries than asked for: what stands behind the last would be passed over without a word.
///
/// # Errors
/// With both numbers.
pub fn exactly<'de, D: Deserializer<'de>, T: Deserialize<'de>, const N: usize>(list: D) -> Result<[T; N], D::Error> {
    let entries = Vec::<T>::deserialize(list)?;
    let found = entries.len();
    entries.try_into().map_err(|_| D::Error::invalid_length(found, &format!("an array of length {N}").as_str()))
}

/// As [`exactly`], for a key that may be left out.
///
/// # Errors
/// As there.
pub fn exactly_if_any<'de, D: Deserializer<'de>, T: Deserialize<'de>, const N: usize>(
    list: D,
) -> Result<Option<[T; N]>, D::Error> {
    exactly(list).map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::parse_toml;

    #[derive(serde::Deserialize, Debug)]
    #[serde(deny_unknown_fields)]
    struct Place {
        #[serde(deserialize_with = "exactly")]
        at: [f64; 3],
        #[serde(default, deserialize_with = "exactly_if_any")]
        size: Option<[u32; 2]>,
    }

    #[test]
    fn neither_fewer_nor_more() {
        let place: Place = parse_toml("at = [1, 2.5, 3]", "p.toml").unwrap();
        assert_eq!((place.at, place.size), ([1.0, 2.5, 3.0], None));
        assert_eq!(parse_toml::<Place>("at = [1, 2, 3]\nsize = [4, 5]", "p.toml").unwrap().size, Some([4, 5]));
        for (text, line, found) in
            [("at = [1, 2]", 1, 2), ("at = [1, 2, 3, 4]", 1, 4), ("at = [1, 2, 3]\nsize = []", 2, 0)]
        {
            let error = parse_toml::<Place>(text, "p.toml").unwrap_err().to_string();
            assert!(
                error.starts_with(&format!("p.toml, line {line}: invalid length {found}, expected an array")),
                "{error}"
            );
        }
    }
}

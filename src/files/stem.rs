//! Names that become names of files.

/// A name with what no file's name can hold replaced by `_`. Where anything is, digits that follow from the whole name stand behind it, so
/// that `a<b` and `a>b` are still two files.
pub fn file_stem(name: &str) -> String {
    let is_free = |c: char| !c.is_control() && !"/\\:*?\"<>|".contains(c);
    let plain: String = name.chars().map(|c| if is_free(c) { c } else { '_' }).collect();
    // FNV-1a.
    let hash = name.bytes().fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    if plain == name { plain } else { format!("{plain}-{hash:08x}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_apart() {
        assert_eq!(file_stem("cam 1é"), "cam 1é");
        let [less, greater] = ["a<b", "a>b"].map(file_stem);
        assert!(less.starts_with("a_b-") && greater.starts_with("a_b-") && less != greater, "{less} {greater}");
        assert_ne!(less, file_stem("a_b"));
        assert!(!file_stem("../a\n").contains(['/', '\n']));
    }
}

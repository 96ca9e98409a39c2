//! Lists of names in a message.

use super::shortened;

/// How many names of a list a message has: more are not read.
const MOST: usize = 12;

/// Names with commas between them, the first dozen and how many more there are; each is cut as [`shortened`] cuts.
pub fn listed<T: AsRef<str>>(names: impl IntoIterator<Item = T>) -> String {
    let mut names = names.into_iter();
    let shown: Vec<String> = names.by_ref().take(MOST).map(|name| shortened(name.as_ref())).collect();
    let shown = shown.join(", ");
    match names.count() {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_and_long_names_are_cut() {
        assert_eq!(listed(["a", "b"]), "a, b");
        assert_eq!(listed(Vec::<String>::new()), "");
        let names: Vec<String> = (0..1000).map(|index| format!("n{index}{}", "x".repeat(1000))).collect();
        let list = listed(&names);
        assert!(list.starts_with("n0xxx") && list.ends_with("… and 988 more"), "{list}");
        assert!(list.chars().count() < 600, "{list}");
    }
}

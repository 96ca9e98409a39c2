//! Odd values of every option that takes one, as the commands' own help lists them.

use super::case::Case;
use super::ground::Ground;

/// Values that nobody means.
const ODD: [&str; 26] = [
    "nan",
    "inf",
    "-inf",
    "1e308",
    "1e-300",
    "1e400",
    "-1",
    "0",
    "-0.0",
    "",
    " ",
    "99999999999999999999",
    "4294967295",
    "18446744073709551615",
    "é",
    "a\nb",
    "../../x",
    "-",
    "%d",
    "[]",
    "1,2",
    "0x10",
    "1..0",
    "5..99999999",
    "nan,nan",
    "a=b",
];

/// Odd values an option is given.
const OF_EACH: usize = 5;

/// Options by name that no odd value of may be tried with: a port is opened, or it is a folder that is written into.
const PASSED_OVER: [&str; 2] = ["--live", "--send"];

pub(super) fn cases(_: &Ground) -> Vec<Case> {
    let long = "x".repeat(5000);
    let mut cases = Vec::new();
    for (at, sound) in Ground::commands().iter().enumerate() {
        let options = Ground::options(sound.arguments[0]);
        assert!(!options.is_empty(), "{}", sound.arguments[0]);
        for (place, option) in options.iter().enumerate() {
            if PASSED_OVER.contains(&option.as_str()) {
                continue;
            }
            for round in 0..OF_EACH {
                let which = (at * 7 + place * 5 + round * 11) % (ODD.len() + 1);
                let value = ODD.get(which).copied().unwrap_or(&long);
                cases.push(with(sound.arguments, sound.output, option, value));
            }
        }
    }
    cases
}

/// How a sentence may quote a value.
fn quoted(value: &str) -> [String; 3] {
    let escaped: String = value.chars().flat_map(char::escape_debug).take(30).collect();
    [value.to_string(), escaped, value.split(',').next().unwrap_or_default().to_string()]
}

/// The command with an option's value replaced, or put behind.
fn with(arguments: &[&str], output: Option<&'static str>, option: &str, value: &str) -> Case {
    let mut arguments: Vec<String> = arguments.iter().map(|argument| (*argument).to_string()).collect();
    let short = if option == "--output" { "-o" } else { option };
    match arguments.iter().position(|argument| argument == short) {
        Some(at) => arguments[at + 1] = value.to_string(),
        None => arguments.push(format!("{option}={value}")),
    }
    let name = option.trim_start_matches("--").to_string();
    // Sentences say `the stall time-out` and the like.
    let words = name.split('-').map(str::to_string).collect::<Vec<_>>();
    Case {
        kind: "value of an option",
        what: format!("{option} {value:?}"),
        arguments,
        output,
        spoilt: Vec::new(),
        names: words.into_iter().chain([name]).chain(quoted(value)).collect(),
    }
}

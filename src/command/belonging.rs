//! Options that mean something beside another one alone: a command line refuses them elsewhere, so that nobody believes they did something.

use anyhow::{Result, ensure};

/// Refuses those of the options, each with whether it was given, that mean nothing without `other`, which was not.
///
/// # Errors
/// With the first of them.
pub(super) fn refuse_without(other: &str, options: &[(&str, bool)]) -> Result<()> {
    refuse(&format!("without {other}, expected both or neither"), options)
}

/// Refuses those of the options that mean nothing with `other`, which was given.
///
/// # Errors
/// With the first of them.
pub(super) fn refuse_with(other: &str, options: &[(&str, bool)]) -> Result<()> {
    refuse(&format!("with {other}, expected one of the two"), options)
}

fn refuse(where_to: &str, options: &[(&str, bool)]) -> Result<()> {
    let given = options.iter().find(|(_, is_given)| *is_given);
    ensure!(given.is_none(), "{} means nothing {where_to}", given.map_or("", |(option, _)| option));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_given_in_vain_is_named() {
        assert!(refuse_without("--board", &[("--corners", false), ("--square", false)]).is_ok());
        let error = refuse_without("--board", &[("--corners", false), ("--square", true)]).unwrap_err().to_string();
        assert_eq!(error, "--square means nothing without --board, expected both or neither");
        let error = refuse_with("--example", &[("--params", true), ("--scale", true)]).unwrap_err().to_string();
        assert_eq!(error, "--params means nothing with --example, expected one of the two");
    }
}

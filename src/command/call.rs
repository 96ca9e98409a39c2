//! The commands as functions, for those who call the library: options by the names that they have on the command line, and results
//! instead of messages.

use std::path::PathBuf;

use anyhow::{Result, anyhow, bail, ensure};
use clap::{Arg, Args, Command};
use image::DynamicImage;

use super::check::{CheckArgs, checked};
use super::fit::{FitArgs, fitted};
use super::synth::{SynthArgs, made};
use super::texture::{TextureArgs, drawn};
use super::track::{TrackArgs, tracked};
use crate::check::CheckReport;
use crate::files::unknown;
use crate::track::{Fit, Progress, TrackSummary};

/// What an option is set to.
#[derive(Clone, Debug, PartialEq)]
pub enum OptionValue {
    /// Given or not; of an option that takes yes or no, that.
    Switch(bool),
    /// Its value as the command line takes it.
    Text(String),
    /// One after the other.
    List(Vec<String>),
}

/// Options by their names, `-` or `_` between words: `("overlay_every", Text("10"))` is `--overlay-every 10`. What stands alone on
/// the command line has a name too: `sequence`, `scene`, `material`.
pub type Options = [(String, OptionValue)];

/// `pantin track`: every person's folder and what was tracked there; one, that of `output`, where the manifest names no people.
///
/// # Errors
/// As [`crate::track::track`], and for an option that is unknown or cannot be read.
pub fn track(options: &Options, progress: &mut dyn Progress) -> Result<Vec<(PathBuf, TrackSummary)>> {
    tracked(&parsed::<TrackArgs>("track", options)?, progress)
}

/// `pantin fit`; the files named by `output` and `start_out` are written.
///
/// # Errors
/// As [`crate::track::fit`], and for an option that is unknown or cannot be read.
pub fn fit(options: &Options) -> Result<Fit> {
    fitted(&parsed::<FitArgs>("fit", options)?, &mut |_, _, _| {}, |_| {})
}

/// `pantin check`. A check that failed is no error here.
///
/// # Errors
/// As [`crate::check::check`], and for an option that is unknown or cannot be read.
pub fn check(options: &Options) -> Result<CheckReport> {
    checked(&parsed::<CheckArgs>("check", options)?, &mut |_, _, _| {})
}

/// `pantin synth`: the folder of the sequence. `progress` is told how many of how many frames are done, from any thread; its error ends
/// the work.
///
/// # Errors
/// As [`crate::synth::SyntheticSequence::write`], and for an option that is unknown or cannot be read.
pub fn synth(options: &Options, progress: &(dyn Fn(usize, usize) -> Result<()> + Sync)) -> Result<PathBuf> {
    Ok(made(&parsed::<SynthArgs>("synth", options)?, progress)?.folder)
}

/// `pantin texture`: the picture, which is written too where `output` is given.
///
/// # Errors
/// When the material or a parameter is unknown, a size makes no sense, a file cannot be read or written, or an option is unknown.
pub fn texture(options: &Options) -> Result<DynamicImage> {
    Ok(drawn(&parsed::<TextureArgs>("texture", options)?)?.picture)
}

/// The arguments of a command from its options.
fn parsed<A: Args>(name: &'static str, options: &Options) -> Result<A> {
    let command = A::augment_args(Command::new(name).no_binary_name(true).disable_help_flag(true));
    let mut words = Vec::new();
    let mut alone = Vec::new();
    for (key, value) in options {
        let arg = command.get_arguments().find(|arg| name_of(arg) == key.replace('-', "_"));
        let Some(arg) = arg else {
            let known: Vec<String> = command.get_arguments().map(name_of).collect();
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            return Err(unknown(&format!("option of {name}"), key, &known));
        };
        let takes_value = arg.get_action().takes_values();
        let values = match value {
            OptionValue::Switch(is_on) if takes_value => vec![if *is_on { "yes" } else { "no" }.to_string()],
            OptionValue::Switch(is_on) => {
                if *is_on {
                    words.push(format!("--{}", arg.get_long().unwrap_or_default()));
                }
                continue;
            }
            OptionValue::Text(text) => vec![text.clone()],
            OptionValue::List(texts) => texts.clone(),
        };
        ensure!(takes_value, "option `{key}` of {name} is {values:?}, expected true or false");
        match arg.get_long() {
            Some(long) => words.extend(values.into_iter().map(|value| format!("--{long}={value}"))),
            None => alone.extend(values),
        }
    }
    words.push("--".to_string());
    let matches = match command.try_get_matches_from(words.into_iter().chain(alone)) {
        Ok(matches) => matches,
        Err(error) => bail!("{name}: {}", sentence(&error)),
    };
    A::from_arg_matches(&matches).map_err(|error| anyhow!("{name}: {}", sentence(&error)))
}

/// What an argument is called here.
fn name_of(arg: &Arg) -> String {
    arg.get_long().map_or_else(|| arg.get_id().to_string(), |long| long.replace('-', "_"))
}

/// What the parser complains of, on one line, without its advice on usage.
fn sentence(error: &clap::Error) -> String {
    let text = error.to_string();
    let lines: Vec<&str> = text.lines().map(str::trim).take_while(|line| !line.is_empty()).collect();
    lines.join(" ").trim_start_matches("error: ").to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::track::Silent;

    fn text(key: &str, value: &str) -> (String, OptionValue) {
        (key.to_string(), OptionValue::Text(value.to_string()))
    }

    fn switch(key: &str, is_on: bool) -> (String, OptionValue) {
        (key.to_string(), OptionValue::Switch(is_on))
    }

    /// The sentence for options that `track` does not take.
    fn refused(options: &Options) -> String {
        let sentence = track(options, &mut Silent).unwrap_err().to_string();
        assert!(!sentence.contains('\n'), "{sentence}");
        sentence
    }

    #[test]
    fn options_are_those_of_the_command_line() {
        let options = [
            text("sequence", "-walk"),
            text("output", "o"),
            text("particles", "7"),
            text("overlay-every", "3"),
            switch("recover", false),
            switch("trace", true),
            switch("rerun", false),
        ];
        let args = format!("{:?}", parsed::<TrackArgs>("track", &options).unwrap());
        for part in [
            "sequence: \"-walk\"",
            "particles: 7",
            "overlay_every: Some(3)",
            "recover: false",
            "trace: true",
            "rerun: false",
        ] {
            assert!(args.contains(part), "{part} in {args}");
        }
    }

    #[test]
    fn what_is_wrong_with_an_option_is_one_sentence() {
        let run = [text("sequence", "walk"), text("output", "o")];
        let with = |option| refused(&[run[0].clone(), run[1].clone(), option]);
        let sentence = with(text("particels", "7"));
        assert!(
            sentence.starts_with(
                "unknown option of track `particels`, the nearest is `particles` (known: sequence, output, "
            ),
            "{sentence}"
        );
        let sentence = with(text("particles", "many"));
        assert_eq!(sentence, "track: invalid value 'many' for '--particles <N>': invalid digit found in string");
        assert_eq!(with(text("trace", "7")), "option `trace` of track is [\"7\"], expected true or false");
        assert!(with(text("search", "psso")).contains("unknown search `psso`, the nearest is `pso`"));
        let sentence = refused(&run[..1]);
        assert_eq!(sentence, "track: the following required arguments were not provided: --output <DIR>");
    }
}

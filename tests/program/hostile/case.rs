//! One odd input, and what the program must do with it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::ground::{Ground, Sound};
use crate::support::{NO_DRIVER, program};

/// No refusal takes longer, nor does any of the small jobs that are not refused, where nothing is optimised and a second test runs.
const LONGEST: Duration = Duration::from_secs(120);
/// A longer sentence is not read.
const LONGEST_SENTENCE: usize = 1200;

/// How a file is spoilt.
#[derive(Clone, Debug)]
pub(super) enum Spoilt {
    /// It holds these bytes.
    Holds(Vec<u8>),
    /// It is not there.
    Absent,
    /// A folder is in its place.
    Folder,
    /// It is a link to something.
    Link(&'static str),
    /// A pipe that nobody writes into.
    Pipe,
    /// It is so many bytes long, none of them written.
    Long(u64),
}

/// One odd input.
pub(super) struct Case {
    /// The kind that it is counted under.
    pub(super) kind: &'static str,
    /// What is odd, for whoever reads the test's failure.
    pub(super) what: String,
    pub(super) arguments: Vec<String>,
    /// What is written, if anything.
    pub(super) output: Option<&'static str>,
    /// Files that are spoilt.
    pub(super) spoilt: Vec<(String, Spoilt)>,
    /// What the sentence may name: one of these is enough.
    pub(super) names: Vec<String>,
}

impl Case {
    /// A sound command with one file spoilt.
    pub(super) fn of_file(kind: &'static str, what: &str, sound: &Sound, file: &str, spoilt: Spoilt) -> Self {
        Self {
            kind,
            what: what.to_string(),
            arguments: sound.arguments.iter().map(|argument| (*argument).to_string()).collect(),
            output: sound.output,
            spoilt: vec![(file.to_string(), spoilt)],
            names: Vec::new(),
        }
    }

    /// For the message of a failure.
    pub(super) fn told(&self) -> String {
        let files: Vec<&String> = self.spoilt.iter().map(|(file, _)| file).collect();
        let short = |text: &str| text.chars().take(60).collect::<String>();
        let arguments: Vec<String> = self.arguments.iter().map(|argument| short(argument)).collect();
        format!("{} {files:?}: pantin {}", self.what.chars().take(200).collect::<String>(), arguments.join(" "))
    }

    /// Runs it in a copy of the sound files; how it ended, or what was wrong with that.
    pub(super) fn run(&self, ground: &Ground) -> Result<&'static str, String> {
        let sandbox = tempfile::tempdir().unwrap();
        let work = sandbox.path().join("work");
        ground.copy_to(&work);
        for (file, spoilt) in &self.spoilt {
            spoil(&work.join(file), spoilt);
        }
        let before = seen(sandbox.path());
        let home = sandbox.path().join("home");
        let mut command = program();
        command.args(&self.arguments).current_dir(&work).envs(NO_DRIVER).env("HOME", &home);
        command.env("XDG_CACHE_HOME", home.join("cache")).env("TMPDIR", sandbox.path().join("tmp"));
        std::fs::create_dir(sandbox.path().join("tmp")).unwrap();
        let (status, error) = ended(command, sandbox.path())?;
        self.nothing_outside(sandbox.path(), &before)?;
        if error.contains("panicked") {
            return Err(error);
        }
        match status {
            Some(0) => return Ok("taken"),
            Some(2) if error.starts_with("error: ") => return Ok("misused"),
            Some(1) => {}
            _ => return Err(format!("it ended with {status:?}: {error}")),
        }
        // What was said of the work before, a line each, and the sentence.
        let sentence = error.trim_end().lines().last().unwrap_or_default();
        if error.lines().filter(|line| line.starts_with("pantin: ")).count() != 1 || !sentence.starts_with("pantin: ") {
            return Err(format!("not one sentence in the end: {error}"));
        }
        if sentence.chars().count() > LONGEST_SENTENCE || error.chars().any(|c| c.is_control() && c != '\n') {
            return Err(format!("a long sentence, or one with signs of no letter: {error:?}"));
        }
        if !self.is_named(sentence) {
            return Err(format!("it names neither a file nor an option: {sentence}"));
        }
        Ok("refused")
    }

    /// Whether a sentence says where to look.
    fn is_named(&self, sentence: &str) -> bool {
        let options = self.arguments.iter().filter(|argument| argument.starts_with("--")).map(String::as_str);
        let spoilt = self.spoilt.iter().map(|(file, _)| file.as_str());
        // A command may well name the sound file beside the spoilt one, or the folder that it was told.
        let files = self.arguments.iter().map(String::as_str).filter(|argument| argument.len() > 3);
        let mut names = options.chain(spoilt).chain(files).chain(self.names.iter().map(String::as_str));
        names.any(|name| {
            let file = Path::new(name).file_name().map(|file| file.to_string_lossy().into_owned());
            let told = name.trim_start_matches("--");
            !told.is_empty() && (sentence.contains(told) || file.is_some_and(|file| sentence.contains(&file)))
        })
    }

    /// Holds what the folder has now against what it had.
    fn nothing_outside(&self, sandbox: &Path, before: &BTreeMap<PathBuf, (u64, u64)>) -> Result<(), String> {
        let after = seen(sandbox);
        let is_own = |path: &Path| {
            let below = path.strip_prefix(sandbox.join("work")).unwrap_or(path);
            let begins = |name: &str| !name.is_empty() && below.starts_with(name);
            let value = |argument: &String| begins(argument.split_once('=').map_or(argument, |(_, value)| value));
            self.output.is_some_and(begins) || self.arguments.iter().any(|argument| begins(argument) || value(argument))
        };
        let is_kept = |path: &Path| path.starts_with(sandbox.join("home")) || path.starts_with(sandbox.join("tmp"));
        for (path, what) in &after {
            if !is_kept(path) && !is_own(path) && before.get(path) != Some(what) && !path.ends_with("stderr") {
                return Err(format!("it wrote {}", path.display()));
            }
        }
        let lost = before.keys().find(|path| !after.contains_key(*path) && !is_own(path));
        lost.map_or(Ok(()), |path| Err(format!("{} is gone", path.display())))
    }
}

/// The status and what was said, or that it took too long.
fn ended(mut command: Command, sandbox: &Path) -> Result<(Option<i32>, String), String> {
    let said = sandbox.join("stderr");
    let errors = std::fs::File::create(&said).unwrap();
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(errors).spawn().unwrap();
    let begin = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if begin.elapsed() > LONGEST {
            child.kill().unwrap();
            child.wait().unwrap();
            return Err(format!("it was still at work after {LONGEST:?}"));
        }
        std::thread::sleep(Duration::from_millis(3));
    };
    Ok((status.code(), String::from_utf8_lossy(&std::fs::read(said).unwrap()).into_owned()))
}

fn spoil(path: &Path, spoilt: &Spoilt) {
    if path.is_dir() {
        std::fs::remove_dir_all(path).unwrap();
    } else if path.exists() {
        std::fs::remove_file(path).unwrap();
    }
    match spoilt {
        Spoilt::Holds(bytes) => std::fs::write(path, bytes).unwrap(),
        Spoilt::Absent => {}
        Spoilt::Folder => std::fs::create_dir(path).unwrap(),
        Spoilt::Long(bytes) => std::fs::File::create(path).unwrap().set_len(*bytes).unwrap(),
        #[cfg(unix)]
        Spoilt::Link(target) => std::os::unix::fs::symlink(target, path).unwrap(),
        #[cfg(unix)]
        Spoilt::Pipe => assert!(Command::new("mkfifo").arg(path).status().unwrap().success()),
        #[cfg(not(unix))]
        Spoilt::Link(_) | Spoilt::Pipe => {}
    }
}

/// Every file below a folder with its length and a sum of its bytes; what is no regular file has neither.
fn seen(folder: &Path) -> BTreeMap<PathBuf, (u64, u64)> {
    let mut found = BTreeMap::new();
    let mut left = vec![folder.to_path_buf()];
    while let Some(folder) = left.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let entry = entry.unwrap();
            let kind = entry.file_type().unwrap();
            let length = entry.metadata().map_or(0, |metadata| metadata.len());
            if kind.is_dir() {
                left.push(entry.path());
            } else if kind.is_file() && length < 1 << 22 {
                let bytes = std::fs::read(entry.path()).unwrap();
                let sum = bytes.iter().fold(0_u64, |sum, byte| sum.wrapping_mul(31).wrapping_add(u64::from(*byte)));
                found.insert(entry.path(), (length, sum));
            } else {
                found.insert(entry.path(), (length, 0));
            }
        }
    }
    found
}

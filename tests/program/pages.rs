//! Completions and manual: made from the command line's own declaration, so they know every command.

use std::fs;
use std::process::{Command, Stdio};

use crate::support::*;

/// The commands that `pantin --help` lists.
fn commands() -> Vec<String> {
    let help = stdout(&pantin(&["--help"]));
    let lines = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    lines.filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help").map(String::from).collect()
}

#[test]
fn every_command_has_a_page_of_the_manual() {
    let folder = tempfile::tempdir().unwrap();
    let pages = folder.path().join("man");
    let made = pantin(&["man", "-o", pages.to_str().unwrap()]);
    assert!(made.status.success(), "{made:?}");
    let commands = commands();
    assert!(commands.len() > 15, "{commands:?}");
    for name in &commands {
        let page = fs::read_to_string(pages.join(format!("pantin-{name}.1"))).unwrap();
        assert!(page.contains(".SH SYNOPSIS") && page.contains(&format!("pantin\\-{name}")), "{name}:\n{page}");
    }
    let page = fs::read_to_string(pages.join("pantin-track.1")).unwrap();
    assert!(page.contains("\\-\\-overlay\\-every"), "{page}");
    let program = fs::read_to_string(pages.join("pantin.1")).unwrap();
    assert!(commands.iter().all(|name| program.contains(&format!("pantin\\-{name}(1)"))), "{program}");
    assert_eq!(fs::read_dir(&pages).unwrap().count(), commands.len() + 1);
    let again = pantin(&["man", "-o", pages.to_str().unwrap()]);
    assert_eq!(again.status.code(), Some(1), "a folder that holds something is kept");
}

#[test]
fn bash_completes_commands_and_choices() {
    let script = stdout(&pantin(&["completions", "bash"]));
    let completed = |words: &str| {
        let line = words.split(' ').count() - 1;
        let shell = format!(
            "{script}\nCOMP_WORDS=({words}); [ {line} -lt ${{#COMP_WORDS[@]}} ] || COMP_WORDS+=(''); COMP_CWORD={line}\n\
             _pantin pantin \"${{COMP_WORDS[$COMP_CWORD]}}\" \"${{COMP_WORDS[$((COMP_CWORD-1))]}}\"; echo \"${{COMPREPLY[@]}}\""
        );
        let done = Command::new("bash").args(["--norc", "-c", &shell]).stdin(Stdio::null()).output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        String::from_utf8(done.stdout).unwrap().trim().to_string()
    };
    assert_eq!(completed("pantin tra"), "track");
    assert_eq!(completed("pantin texture --backe"), "--backend");
    let known = completed("pantin track --backend ");
    for backend in ["auto", "reference", "cpu", "compute", "graphics"] {
        assert!(known.split(' ').any(|word| word == backend), "{known}");
    }
    for shell in ["zsh", "fish", "elvish", "powershell"] {
        assert!(stdout(&pantin(&["completions", shell])).contains("realtime"), "{shell}");
    }
    assert_eq!(pantin(&["completions", "tcsh"]).status.code(), Some(2));
}

//! `pantin completions` and `pantin man`: what a shell and a manual know of the command line, made from its own declaration.

use std::path::PathBuf;

use anyhow::Result;
use clap::Command;
use clap_mangen::Man;

use super::output::{Output, say};
use crate::files::{OutputFolder, Overwrite};

/// Print a shell's completions, to be put where it looks for them: `pantin completions bash >
/// ~/.local/share/bash-completion/completions/pantin`.
#[derive(clap::Args, Debug)]
pub(super) struct CompletionsArgs {
    /// The shell.
    #[arg(value_name = "SHELL")]
    shell: clap_complete::Shell,
}

/// Write the manual's pages, one for the program and one a command.
#[derive(clap::Args, Debug)]
pub(super) struct ManArgs {
    /// The folder to write into.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Replace what the folder holds.
    #[arg(long)]
    force: bool,
}

/// Runs `pantin completions` on the program's command line.
///
/// # Errors
/// None: what standard output does not take is told of at the end.
pub(super) fn completions(args: &CompletionsArgs, mut program: Command) -> Result<()> {
    clap_complete::generate(args.shell, &mut program, "pantin", &mut Output);
    Ok(())
}

/// Runs `pantin man` on the program's command line.
///
/// # Errors
/// When a page cannot be written.
pub(super) fn man(args: &ManArgs, program: Command) -> Result<()> {
    let output = OutputFolder::create(&args.output, Overwrite::forced(args.force))?;
    let mut program = program.disable_help_subcommand(true);
    program.build();
    let pages: Vec<Man> = std::iter::once(&program).chain(program.get_subcommands()).cloned().map(Man::new).collect();
    for page in &pages {
        output.write(&page.get_filename(), |writer| Ok(page.render(writer)?))?;
    }
    say!("wrote {} pages to {}", pages.len(), output.path().display());
    Ok(())
}

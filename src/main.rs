//! The `pantin` program: parses arguments and calls one command.

use std::process::ExitCode;

fn main() -> ExitCode {
    pantin::command::run(std::env::args_os())
}

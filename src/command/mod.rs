//! The subcommands: arguments to library calls, progress bars, messages. Nothing is computed here.

mod batch;
mod belonging;
mod bench;
mod calibrate;
mod calibrate_board;
pub mod call;
mod check;
mod convert;
mod convert_poses;
mod demo;
mod devices;
mod drawing_flags;
mod draws;
mod evaluate;
mod features;
mod fit;
mod interrupt;
mod matrix;
mod name_pair;
mod objective_flags;
mod output;
mod pages;
mod plate;
mod pose2sim;
mod progress;
mod realtime_flags;
mod score;
mod start;
mod study;
mod synth;
mod texture;
mod threads_flag;
mod track;

use std::ffi::OsString;
use std::io::ErrorKind;
use std::process::ExitCode;

use anyhow::Result;
use clap::{CommandFactory, Parser, Subcommand};

use self::output::tell;
use crate::files::one_line;

/// Markerless 3D human motion from a few calibrated cameras.
#[derive(Parser, Debug)]
#[command(name = "pantin", version, about, max_term_width = 120)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    Batch(batch::BatchArgs),
    /// Measure how fast every backend is here, side by side and stage by stage.
    Bench(bench::BenchArgs),
    /// Calibrate cameras from points known in the world and in the pictures.
    Calibrate(calibrate::CalibrateArgs),
    /// Is this sequence sane: units, up axis, cameras, silhouettes, timing; every check with its number and what to do.
    Check(check::CheckArgs),
    Completions(pages::CompletionsArgs),
    /// Convert a recording between C3D, TRC, BVH and CSV.
    Convert(convert::ConvertArgs),
    Demo(demo::DemoArgs),
    /// List the Vulkan devices, what each can do, and what --backend auto would take.
    Devices(devices::DevicesArgs),
    /// Score given poses against one frame: components and fitness.
    Evaluate(evaluate::EvaluateArgs),
    /// Measure the person: adapt body proportions to silhouettes, find first poses.
    Fit(fit::FitArgs),
    Plate(plate::PlateArgs),
    /// Measure the error of tracked points against a truth: per point, per frame, mean and standard deviation, mm.
    Score(score::ScoreArgs),
    Features(features::FeaturesArgs),
    Man(pages::ManArgs),
    Matrix(matrix::MatrixArgs),
    /// Track a project of Pose2Sim: its Config.toml, calibration and videos in, pose-3d/*.trc out.
    #[command(name = "pose2sim")]
    Pose2Sim(pose2sim::Pose2SimArgs),
    Start(start::StartArgs),
    /// Run many settings over many sequences and seeds, and compare them in tables and plots.
    Study(study::StudyArgs),
    Synth(synth::SynthArgs),
    Texture(texture::TextureArgs),
    /// Track a person through a sequence of calibrated pictures.
    Track(track::TrackArgs),
}

/// Runs the program on its arguments (the program's name first). Exit status: 0 done, 1 failed, 2 wrong usage.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            let is_full = error.print().is_err_and(|error| error.kind() != ErrorKind::BrokenPipe);
            return match (error.use_stderr(), is_full) {
                (true, _) => ExitCode::from(2),
                (false, true) => ExitCode::FAILURE,
                (false, false) => ExitCode::SUCCESS,
            };
        }
    };
    let done = dispatch(arguments.command);
    if let Err(error) = &done {
        tell!("pantin: {}", one_line(&format!("{error:#}")));
    }
    if output::finish() || done.is_err() { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

fn dispatch(command: Command) -> Result<()> {
    match command {
        Command::Batch(args) => batch::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Calibrate(args) => calibrate::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Completions(args) => pages::completions(&args, Arguments::command()),
        Command::Convert(args) => convert::run(&args),
        Command::Demo(args) => demo::run(&args),
        Command::Devices(args) => devices::run(&args),
        Command::Evaluate(args) => evaluate::run(&args),
        Command::Fit(args) => fit::run(&args),
        Command::Plate(args) => plate::run(&args),
        Command::Score(args) => score::run(&args),
        Command::Features(args) => features::run(&args),
        Command::Man(args) => pages::man(&args, Arguments::command()),
        Command::Matrix(args) => matrix::run(&args),
        Command::Pose2Sim(args) => pose2sim::run(&args),
        Command::Start(args) => start::run(&args),
        Command::Study(args) => study::run(&args),
        Command::Synth(args) => synth::run(&args),
        Command::Texture(args) => texture::run(&args),
        Command::Track(args) => track::run(&args),
    }
}

//! The program from outside, as a user runs it: what every command writes, what it refuses, and what is left when it is killed.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test says what went wrong by panicking"
)]

mod batch;
mod beam;
mod body_import;
mod calibrate;
mod calibrated;
mod check;
mod check_rigs;
mod demo;
mod devices_and_bench;
mod drawn;
mod evaluate;
mod evidence;
mod example_bodies;
mod features;
mod first_try;
mod hostile;
mod labels;
mod losses;
mod matrix;
mod measure_again;
mod observe;
mod obstacles;
mod on_device;
mod pages;
mod people;
mod plate;
mod pose2sim;
mod reliability;
mod report_in_browser;
#[cfg(feature = "rerun")]
mod rerun;
#[path = "../scene/mod.rs"]
#[allow(dead_code, reason = "the tests of evaluators take more of it")]
mod scene;
mod score_and_convert;
mod streams;
mod study;
mod support;
mod synth;
mod texture;
mod track;
mod unaided;
mod walk;

//! Every backend gives the reference's integers and fitness in every case: one table of backends ([`backends`]), one of cases
//! ([`cases`]), and beside each agreement that a change of what is seen, of a pose or of the body shows. The other files hold what only
//! one of them can do.
//!
//! Runs on whatever Vulkan device there is, under the validation layer, which must stay silent.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

mod backends;
mod cases;
mod compute;
#[path = "../device/mod.rs"]
mod device;
mod evidence;
mod found;
mod meshes;
mod processors;
#[path = "../scene/mod.rs"]
mod scene;
mod segments;

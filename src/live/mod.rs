//! What goes out while a run is at work: each pose as it is found, to whoever receives it, and a page for a browser on this machine
//! (docs/REALTIME.md). Nothing here holds the tracker up: what cannot keep up loses the oldest of what waits for it, and that is counted.

mod destination;
mod jsonl;
mod lines;
mod listener;
mod opening;
mod outlet;
mod page;
mod pose;
mod receiver;
mod slot;
mod vmc;

pub use destination::{Destination, Scheme};
pub(crate) use lines::Lines;
pub(crate) use opening::open;
pub use outlet::SentSummary;
pub(crate) use outlet::{Outgoing, Outlet};
pub(crate) use page::{Board, PageServer};
pub(crate) use pose::LivePose;
pub(crate) use slot::Slot;

//! The ways to the destinations that a run is asked for.

use anyhow::Result;

use super::destination::{Destination, Scheme};
use super::jsonl::LineServer;
use super::outlet::Outlet;

/// Opens the way to every destination.
///
/// # Errors
/// One sentence with the destination: a host that is not known, a port that is taken.
pub(crate) fn open(destinations: &[Destination]) -> Result<Vec<Box<dyn Outlet>>> {
    let open = |destination: &Destination| -> Result<Box<dyn Outlet>> {
        Ok(match destination.scheme {
            Scheme::Jsonl => Box::new(LineServer::open(destination)?),
        })
    };
    destinations.iter().map(open).collect()
}

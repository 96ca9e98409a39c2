//! The ways to the destinations that a run is asked for.

use anyhow::Result;

use super::destination::{Destination, Scheme};
use super::jsonl::LineServer;
use super::outlet::Outlet;
use super::vmc::VmcSender;
use crate::body::Body;

/// Opens the way to every destination, for poses of a body.
///
/// # Errors
/// One sentence with the destination: a host that is not known, a port that is taken, a body that it has no words for.
pub(crate) fn open(destinations: &[Destination], body: &Body) -> Result<Vec<Box<dyn Outlet>>> {
    let open = |destination: &Destination| -> Result<Box<dyn Outlet>> {
        Ok(match destination.scheme {
            Scheme::Vmc => Box::new(VmcSender::open(destination, body)?),
            Scheme::Jsonl => Box::new(LineServer::open(destination)?),
        })
    };
    destinations.iter().map(open).collect()
}

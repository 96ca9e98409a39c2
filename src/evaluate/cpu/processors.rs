//! Processors that no other worker on this machine is bound to. Two teams bound to the same ones would wait for each other while others
//! idle, so a worker is bound only where it holds its processor's claim; without one the scheduler places it.

use core_affinity::CoreId;

#[cfg(target_os = "linux")]
type Claim = std::os::unix::net::UnixDatagram;
#[cfg(not(target_os = "linux"))]
type Claim = std::convert::Infallible;

/// A processor that its holder alone is bound to.
#[derive(Debug)]
pub(super) struct Processor {
    id: CoreId,
    /// Given back by the system when it is closed, or when its process ends.
    _claim: Claim,
}

impl Processor {
    /// Binds the calling thread to it.
    pub(super) fn bind(&self) {
        core_affinity::set_for_current(self.id);
    }
}

/// At most `count` processors that nobody else has claimed. The first that this process may use is left out: the thread that shares
/// out the work runs where the scheduler wants it.
pub(super) fn claimed(count: usize) -> Vec<Processor> {
    let allowed = core_affinity::get_core_ids().unwrap_or_default().into_iter().skip(1);
    allowed.filter_map(|id| Some(Processor { id, _claim: claim(id)? })).take(count).collect()
}

/// A name that one process on the machine can have at a time: an abstract socket's, which is no file and dies with its holder.
#[cfg(target_os = "linux")]
fn claim(id: CoreId) -> Option<Claim> {
    use std::os::linux::net::SocketAddrExt;
    let name = std::os::unix::net::SocketAddr::from_abstract_name(format!("pantin-processor-{}", id.id)).ok()?;
    Claim::bind_addr(&name).ok()
}

#[cfg(not(target_os = "linux"))]
fn claim(_: CoreId) -> Option<Claim> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_processor_is_claimed_once_and_given_back() {
        // Other tests claim too, and give back when they end.
        let all = core_affinity::get_core_ids().unwrap_or_default().len();
        let first = claimed(all);
        assert!(first.len() < all.max(1), "the first processor is left out");
        assert!(claimed(all).iter().all(|other| first.iter().all(|held| held.id != other.id)));
        if let Some(held) = first.first() {
            let id = held.id;
            drop(first);
            let again = std::iter::repeat_with(|| {
                std::thread::sleep(std::time::Duration::from_millis(20));
                claimed(all)
            });
            assert!(again.take(500).any(|free| free.iter().any(|processor| processor.id == id)));
        }
    }
}

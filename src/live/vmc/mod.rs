//! Poses to an application that receives the Virtual Motion Capture protocol: OSC over UDP, a few datagrams a pose.

mod bones;

use std::net::{SocketAddr, ToSocketAddrs, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::{self, JoinHandle};

use anyhow::{Context, Result, anyhow, ensure};
use rosc::{OscBundle, OscMessage, OscPacket, OscTime, OscType, encoder};

use super::destination::Destination;
use super::listener::unknown_host;
use super::outlet::{Outgoing, Outlet, SentSummary};
use super::pose::LivePose;
use super::receiver::Counts;
use super::slot::Slot;
use crate::body::Body;
use bones::{UnityBone, UnityBones};

/// Bytes of a datagram: what every network hands on in one piece.
const LARGEST_DATAGRAM: usize = 1400;
/// Bytes of a bundle before its first message.
const BUNDLE_HEADER: usize = 16;
/// Poses that wait to be sent. UDP waits for nobody, so there are hardly ever two.
const ROOM: usize = 8;
/// The time tag of what is to be done at once.
const AT_ONCE: OscTime = OscTime { seconds: 0, fractional: 1 };

/// The datagrams of a pose.
type Datagrams = Vec<Vec<u8>>;

/// Sends the poses of a run.
pub(super) struct VmcSender {
    to: String,
    bones: UnityBones,
    poses: Arc<Slot<Datagrams>>,
    counts: Arc<Counts>,
    thread: Option<JoinHandle<()>>,
}

impl VmcSender {
    /// Makes ready to send poses of a body to a destination; whether anybody receives there is not known.
    ///
    /// # Errors
    /// One sentence with the destination: a host that is not known, port 0, a body without a bone of Unity's.
    pub(super) fn open(destination: &Destination, body: &Body) -> Result<Self> {
        let to = destination.to_string();
        ensure!(destination.port > 0, "{to}: nobody receives at port 0, expected 1 to 65535; 39539 is usual");
        let bones = UnityBones::of(body).with_context(|| to.clone())?;
        let address = resolved(&to, destination)?;
        let own: SocketAddr = if address.is_ipv4() { ([0; 4], 0).into() } else { ([0u16; 8], 0).into() };
        let cannot = || format!("{to}: cannot send");
        let socket = UdpSocket::bind(own).with_context(cannot)?;
        socket.connect(address).with_context(cannot)?;
        let (poses, counts) = (Arc::new(Slot::with_room(ROOM)), Arc::<Counts>::default());
        let (queue, own) = (Arc::clone(&poses), Arc::clone(&counts));
        let work = move || send_all(&socket, &queue, &own);
        let thread = thread::Builder::new().name("vmc".to_string()).spawn(work).with_context(cannot)?;
        Ok(Self { to, bones, poses, counts, thread: Some(thread) })
    }

    fn end(&mut self) {
        self.poses.finish(Ok(()));
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// The address of a destination, one of IPv4 first: few applications receive on others.
fn resolved(to: &str, Destination { host, port, .. }: &Destination) -> Result<SocketAddr> {
    let found = (host.as_str(), *port).to_socket_addrs().map_err(|error| unknown_host(to, host, &error))?;
    let mut found: Vec<SocketAddr> = found.collect();
    found.sort_by_key(|address| !address.is_ipv4());
    found.first().copied().ok_or_else(|| anyhow!("{to}: the host `{host}` has no address"))
}

impl Outlet for VmcSender {
    fn address(&self) -> String {
        format!("poses go to {}", self.to)
    }

    fn send(&mut self, pose: &Outgoing<'_>) -> Result<()> {
        let datagrams = datagrams(pose.pose, &self.bones.at(&pose.pose.pose)?)?;
        if let Ok(Some(_)) = self.poses.put(datagrams) {
            self.counts.dropped.fetch_add(1, Ordering::Relaxed);
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> SentSummary {
        self.end();
        // Nobody connects to be sent a datagram.
        SentSummary { receivers: None, ..self.counts.summary(&self.to) }
    }
}

impl Drop for VmcSender {
    fn drop(&mut self) {
        self.end();
    }
}

/// Sends until the run ends. A receiver that is not there (its machine may say so) is no reason to end: it may come yet.
fn send_all(socket: &UdpSocket, poses: &Slot<Datagrams>, counts: &Counts) {
    while let Ok(Some(datagrams)) = poses.take() {
        let is_sent = datagrams.iter().all(|datagram| socket.send(datagram).is_ok());
        let count = if is_sent { &counts.sent } else { &counts.dropped };
        count.fetch_add(1, Ordering::Relaxed);
    }
}

fn message(address: &str, args: Vec<OscType>) -> OscPacket {
    OscPacket::Message(OscMessage { addr: address.to_string(), args })
}

/// A transform's message: a name, a position and a quaternion.
fn transform(address: &str, name: &str, position: [f64; 3], rotation: [f64; 4]) -> OscPacket {
    let values = position.into_iter().chain(rotation).map(|value| OscType::Float(value as f32));
    message(address, [OscType::String(name.to_string())].into_iter().chain(values).collect())
}

/// A pose as bundles, each of which fits a datagram.
fn datagrams(pose: &LivePose, bones: &[UnityBone]) -> Result<Datagrams> {
    // Loaded, calibrated, the usual mode, and whether she is tracked.
    let state = [1, 3, 0, i32::from(!pose.is_lost)].map(OscType::Int);
    let mut messages = vec![
        message("/VMC/Ext/OK", state.to_vec()),
        message("/VMC/Ext/T", vec![OscType::Float(pose.time as f32)]),
        transform("/VMC/Ext/Root/Pos", "root", [0.0; 3], [0.0, 0.0, 0.0, 1.0]),
    ];
    let bones = bones.iter();
    messages.extend(bones.map(|bone| transform("/VMC/Ext/Bone/Pos", bone.name, bone.position, bone.rotation)));
    let mut datagrams = Vec::new();
    let (mut content, mut size) = (Vec::new(), BUNDLE_HEADER);
    for packet in messages {
        // Each is preceded by its length.
        let more = encoded(&packet)?.len() + 4;
        if size + more > LARGEST_DATAGRAM {
            datagrams.push(bundle(std::mem::take(&mut content))?);
            size = BUNDLE_HEADER;
        }
        size += more;
        content.push(packet);
    }
    datagrams.push(bundle(content)?);
    Ok(datagrams)
}

fn bundle(content: Vec<OscPacket>) -> Result<Vec<u8>> {
    encoded(&OscPacket::Bundle(OscBundle { timetag: AT_ONCE, content }))
}

fn encoded(packet: &OscPacket) -> Result<Vec<u8>> {
    encoder::encode(packet).map_err(|error| anyhow!("a pose cannot be written as OSC: {error:?}"))
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::live::lines::Lines;
    use crate::live::pose::tests::posed;

    fn received(socket: &UdpSocket) -> Vec<OscMessage> {
        let mut buffer = [0; 65_536];
        let size = socket.recv(&mut buffer).unwrap();
        assert!(size <= LARGEST_DATAGRAM, "{size} bytes");
        let OscPacket::Bundle(OscBundle { timetag, content }) = rosc::decoder::decode_udp(&buffer[..size]).unwrap().1
        else {
            panic!("no bundle")
        };
        assert_eq!((timetag.seconds, timetag.fractional), (0, 1));
        let messages = content.into_iter().map(|packet| match packet {
            OscPacket::Message(message) => message,
            OscPacket::Bundle(_) => panic!("a bundle in a bundle"),
        });
        messages.collect()
    }

    #[test]
    fn a_receiver_has_the_pose_in_bundles_that_fit_a_datagram() {
        let body = Body::adult(1750.0).unwrap();
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        let destination = format!("vmc://{}", socket.local_addr().unwrap()).parse().unwrap();
        let mut sender = Box::new(VmcSender::open(&destination, &body).unwrap());
        let live = LivePose { is_lost: true, ..posed(&body, 50, body.standing_pose()) };
        sender.send(&Outgoing::new(&live, &Lines::new(&body))).unwrap();
        let messages: Vec<OscMessage> = (0..2).flat_map(|_| received(&socket)).collect();
        let of = |address: &str| messages.iter().filter(|message| message.addr == address).collect::<Vec<_>>();
        assert_eq!(of("/VMC/Ext/OK")[0].args, [1, 3, 0, 0].map(OscType::Int), "she is lost");
        assert_eq!(of("/VMC/Ext/T")[0].args, [OscType::Float(2.0)]);
        assert_eq!(of("/VMC/Ext/Root/Pos").len(), 1);
        let bones = of("/VMC/Ext/Bone/Pos");
        assert_eq!(bones.len(), 17);
        for (message, bone) in bones.iter().zip(UnityBones::of(&body).unwrap().at(&live.pose).unwrap()) {
            let OscPacket::Message(expected) = transform("/VMC/Ext/Bone/Pos", bone.name, bone.position, bone.rotation)
            else {
                panic!("a bundle")
            };
            assert_eq!(message.args, expected.args);
        }
        let SentSummary { to, receivers, sent, dropped } = sender.finish();
        assert_eq!((to, receivers, sent, dropped), (destination.to_string(), None, 1, 0));
    }

    #[test]
    fn a_receiver_that_is_not_there_ends_nothing() {
        let body = Body::adult(1750.0).unwrap();
        let gone = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
        let mut sender = Box::new(VmcSender::open(&format!("vmc://{gone}").parse().unwrap(), &body).unwrap());
        let lines = Lines::new(&body);
        for frame in 0..20 {
            let live = posed(&body, frame, body.standing_pose());
            sender.send(&Outgoing::new(&live, &lines)).unwrap();
            thread::sleep(Duration::from_millis(2));
        }
        let summary = sender.finish();
        assert_eq!(summary.sent + summary.dropped, 20, "{summary:?}");
    }

    #[test]
    fn what_cannot_be_sent_to_is_a_sentence() {
        let body = Body::adult(1750.0).unwrap();
        for (destination, part) in [
            ("vmc://no-such-host.invalid:39539", "the host `no-such-host.invalid` is not known"),
            ("vmc://127.0.0.1:0", "nobody receives at port 0, expected 1 to 65535"),
        ] {
            let Err(error) = VmcSender::open(&destination.parse().unwrap(), &body) else { panic!("{destination}") };
            let sentence = error.to_string();
            assert!(sentence.starts_with(destination) && sentence.contains(part), "{sentence}");
        }
    }
}

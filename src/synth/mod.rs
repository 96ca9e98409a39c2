//! Synthetic sequences with exact truth: people, a room, cameras, noise.
//!
//! [`Scene`] says what to show, [`SyntheticSequence`] makes it: a [performance](performance::Performance) moves the bones, by a
//! [gait](gait::Gait) or a recording; a [figure](figure::Figure) of ellipsoids and capsules or with a skinned mesh hangs on
//! them; [render](render::View) draws it before the [room](room::Room) for each camera of the [rig]; shutters
//! and [sensor](noise::Sensor) record it.

pub mod actor;
mod build;
mod chroma;
mod colour;
pub mod device;
pub mod figure;
mod finish;
pub mod gait;
mod hash;
mod lottery;
mod manifest;
pub mod noise;
mod packing;
pub mod performance;
mod portrait;
mod recording;
pub mod render;
pub mod rig;
pub mod room;
mod scene;
mod sequence;
pub mod shaders;
mod shadow;
pub mod solid;
pub mod triangle;

pub use finish::{Finish, FinishParameters, FinishSettings};
pub use lottery::{Lottery, LotterySettings};
pub(crate) use manifest::FileNames;
pub use portrait::portrait;
pub use recording::Advance;
pub use scene::{
    ActorSettings, CameraSettings, Gait, Garment, LensKind, LightSettings, MotionSettings, MotionUnit, OutputSettings,
    PictureForm, RigKind, RigSettings, RoomSettings, Scene, ScenePreset, SensorSettings, StationSettings,
};
pub use sequence::SyntheticSequence;

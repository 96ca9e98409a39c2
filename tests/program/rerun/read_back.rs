//! A recording as the library of its format reads it.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use re_chunk::{Chunk, TimeInt};
use re_log_encoding::DecoderApp;
use re_log_types::{BlueprintActivationCommand, LogMsg, StoreInfo};
use re_sdk_types::{Component, ComponentDescriptor};

/// What a file holds.
pub(crate) struct Read {
    pub(crate) stores: Vec<StoreInfo>,
    /// Of the recording.
    pub(crate) chunks: Vec<Chunk>,
    /// Of the layout.
    pub(crate) layout: Vec<Chunk>,
    pub(crate) activations: Vec<BlueprintActivationCommand>,
}

impl Read {
    pub(crate) fn file(path: &Path) -> Self {
        let mut read = Self { stores: Vec::new(), chunks: Vec::new(), layout: Vec::new(), activations: Vec::new() };
        let messages = DecoderApp::decode_eager(BufReader::new(File::open(path).unwrap())).unwrap();
        for message in messages {
            match message.unwrap() {
                LogMsg::SetStoreInfo(store) => read.stores.push(store.info),
                LogMsg::ArrowMsg(store, message) => {
                    let chunk = Chunk::from_arrow_msg(&message).unwrap();
                    if store.is_recording() { read.chunks.push(chunk) } else { read.layout.push(chunk) }
                }
                LogMsg::BlueprintActivationCommand(command) => read.activations.push(command),
            }
        }
        read
    }

    /// The entities of the recording, each once, sorted.
    pub(crate) fn entities(&self) -> Vec<String> {
        let mut all: Vec<String> = self.chunks.iter().map(|chunk| chunk.entity_path().to_string()).collect();
        all.sort();
        all.dedup();
        all
    }

    /// What an entity holds of a component, row by row, with the row's time on a time-line; none for what holds always.
    pub(crate) fn rows<C: Component>(
        &self,
        entity: &str,
        component: ComponentDescriptor,
        timeline: &'static str,
    ) -> Vec<(Option<i64>, Vec<C>)> {
        let mut rows = Vec::new();
        for chunk in self.chunks.iter().filter(|chunk| chunk.entity_path().to_string() == entity) {
            let values = chunk.iter_component::<C>(component.component).map(|row| row.as_slice().to_vec());
            let times = chunk.iter_component_indices(timeline.into(), component.component);
            let times = times.map(|(time, _)| (time != TimeInt::STATIC).then(|| time.as_i64()));
            rows.extend(times.zip(values));
        }
        rows
    }

    /// The one row of what holds always.
    #[track_caller]
    pub(crate) fn always<C: Component>(&self, entity: &str, component: ComponentDescriptor) -> Vec<C> {
        let mut rows = self.rows(entity, component, "frame");
        assert_eq!(rows.len(), 1, "{entity}");
        let (time, row) = rows.remove(0);
        assert_eq!(time, None, "{entity}");
        row
    }
}

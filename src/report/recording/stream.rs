//! A recording being written: entities and their rows, as the chunks that its format is made of.

use std::io::Write;

use anyhow::{Context, Result};
use re_chunk::{Chunk, EntityPath, RowId, TimePoint};
use re_log_encoding::{CrateVersion, EncodeError, Encoder, EncodingOptions};
use re_log_types::{BlueprintActivationCommand, EntityPathPart, LogMsg, SetStoreInfo, StoreId, StoreInfo, StoreSource};
use re_sdk_types::AsComponents;

/// Rows of an entity that stand in one chunk: the viewer loads and searches whole chunks.
const ROWS: usize = 1024;

/// An entity under `parts`, which may hold any characters.
pub(super) fn entity(parts: &[&str]) -> EntityPath {
    EntityPath::new(parts.iter().map(|part| EntityPathPart::new(*part)).collect())
}

/// What is written goes into one store at a time: the recording, or the layout of its windows.
pub(super) struct Stream<'a> {
    encoder: Encoder<&'a mut dyn Write>,
    store: StoreId,
}

impl<'a> Stream<'a> {
    /// Starts with a store.
    pub(super) fn new(writer: &'a mut dyn Write, store: StoreId) -> Result<Self> {
        let options = EncodingOptions::PROTOBUF_COMPRESSED;
        let encoder = Encoder::new_eager(CrateVersion::LOCAL, options, writer).map_err(sentence)?;
        let mut stream = Self { encoder, store: store.clone() };
        stream.turn_to(store)?;
        Ok(stream)
    }

    /// Goes on with another store.
    pub(super) fn turn_to(&mut self, store: StoreId) -> Result<()> {
        let source = StoreSource::Other(concat!("pantin ", env!("CARGO_PKG_VERSION")).to_string());
        let info = StoreInfo::new(store.clone(), source);
        self.store = store;
        self.append(&LogMsg::SetStoreInfo(SetStoreInfo { row_id: RowId::new().as_tuid(), info }))
    }

    /// What holds at all times.
    pub(super) fn always(&mut self, entity: &EntityPath, what: &dyn AsComponents) -> Result<()> {
        self.rows(entity, [(TimePoint::default(), [what])])
    }

    /// What holds from a moment on, until the next row of the entity.
    pub(super) fn rows<A: AsComponents>(
        &mut self,
        entity: &EntityPath,
        rows: impl IntoIterator<Item = (TimePoint, A)>,
    ) -> Result<()> {
        let mut rows = rows.into_iter().peekable();
        while rows.peek().is_some() {
            let chunk = rows.by_ref().take(ROWS).fold(Chunk::builder(entity.clone()), |chunk, (at, row)| {
                chunk.with_serialized_batches(RowId::new(), at, row.as_serialized_batches())
            });
            let message = chunk.build().and_then(|chunk| chunk.to_arrow_msg());
            let message = message.with_context(|| format!("cannot record {entity}"))?;
            self.append(&LogMsg::ArrowMsg(self.store.clone(), message))?;
        }
        Ok(())
    }

    /// Shows the windows as the store at hand says.
    pub(super) fn activate(&mut self) -> Result<()> {
        let command = BlueprintActivationCommand::make_active(self.store.clone());
        self.append(&LogMsg::BlueprintActivationCommand(command))
    }

    /// Writes the end, without which a reader takes the file for a part of one.
    pub(super) fn finish(mut self) -> Result<()> {
        self.encoder.finish().map_err(sentence)
    }

    fn append(&mut self, message: &LogMsg) -> Result<()> {
        self.encoder.append(message).map(|_| ()).map_err(sentence)
    }
}

/// A disk's own words, without what the library puts before them.
fn sentence(error: EncodeError) -> anyhow::Error {
    match error {
        EncodeError::Write(error) => error.into(),
        other => other.into(),
    }
}

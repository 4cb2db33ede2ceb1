//! What is looked at: a model at a snapshot.

use super::error_table::ErrorTable;
use super::model::Model;
use super::world::Snapshot;

/// A model at a snapshot, as it is traced.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) model: &'a Model,
    pub(super) snapshot: &'a Snapshot,
    /// Where to look nodes up, if the table is accurate enough for this model.
    pub(super) table: Option<&'a ErrorTable>,
}

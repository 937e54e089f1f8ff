//! Reading of rigid bodies and couplings.

use super::block::BlockReader;
use crate::deck::data::{EntitySelection, Rigid, RigidNodes};
use crate::error::Result;

/// Reads rigid bodies and couplings.
#[derive(Default)]
pub(super) struct RigidReader {
    pub(super) bodies: Vec<Rigid>,
    /// A coupling whose axes have not been read yet.
    open: Option<Rigid>,
}

impl RigidReader {
    pub(super) fn rigid_body(&mut self, block: &mut BlockReader) -> Result<()> {
        let keyword = block.keyword;
        block.allow("NSET ELSET REFNODE ROTNODE")?;
        let nodes = match (keyword.get("NSET"), keyword.get("ELSET")) {
            (Some(name), _) => RigidNodes::Set(name.to_string()),
            (None, Some(name)) => RigidNodes::Elements(name.to_string()),
            (None, None) => {
                let message = "no nodes are named; write NSET=... or ELSET=...";
                return Err(block.error(message));
            }
        };
        let rigid = Rigid {
            nodes,
            reference: node_or_set(block.require("REFNODE")?),
            rotation: keyword.get("ROTNODE").map(node_or_set),
            follows: [true; 3],
            place: keyword.place,
            keyword: "RIGID BODY",
        };
        self.bodies.push(rigid);
        block.no_more()
    }

    /// Reads a coupling: the surface follows the reference node along the axes that a later
    /// `*KINEMATIC` gives.
    pub(super) fn coupling(&mut self, block: &mut BlockReader) -> Result<()> {
        let known = "REFNODE SURFACE CONSTRAINTNAME ORIENTATION";
        block.allow(known)?;
        if block.keyword.has("ORIENTATION") {
            let why = "ORIENTATION: displacements follow along x, y, z here";
            // The *KINEMATIC below still belongs to this coupling.
            block.refuse(why);
        }
        self.open = Some(Rigid {
            nodes: RigidNodes::Surface(block.require("SURFACE")?.to_string()),
            reference: node_or_set(block.require("REFNODE")?),
            rotation: None,
            follows: [false; 3],
            place: block.keyword.place,
            keyword: "COUPLING",
        });
        block.no_more()
    }

    /// Reads the first and last axis that follow, line by line; without lines all axes follow.
    pub(super) fn kinematic(&mut self, block: &mut BlockReader) -> Result<()> {
        block.allow("")?;
        let Some(mut rigid) = self.open.take() else {
            let message = "it belongs to no *COUPLING; put it below one";
            return Err(block.error(message));
        };
        let mut is_given = false;
        while let Some((_, mut row)) = block.row()? {
            let first = row.label("the first degree of freedom")? as usize;
            let last = match row.is_at_end() {
                true => first,
                false => row.label("the last degree of freedom")? as usize,
            };
            row.end()?;
            let all = first.max(1)..=last.min(3);
            all.for_each(|freedom| rigid.follows[freedom - 1] = true);
            is_given = true;
        }
        if !is_given {
            rigid.follows = [true; 3];
        }
        self.bodies.push(rigid);
        Ok(())
    }
}

/// A node given by its number, or a set given by its name.
fn node_or_set(text: &str) -> EntitySelection {
    let number = text.parse().ok();
    number.map_or_else(
        || EntitySelection::Set(text.to_string()),
        EntitySelection::Label,
    )
}

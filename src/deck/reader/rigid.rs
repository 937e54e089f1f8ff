//! Reading of rigid bodies and couplings.

use super::{Reader, fields};
use crate::deck::data::{EntitySelection, Rigid, RigidNodes};
use crate::deck::keyword::Keyword;
use crate::error::Result;

impl Reader<'_> {
    pub(super) fn rigid_body(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        keyword.allow(files, &["NSET", "ELSET", "REFNODE", "ROTNODE"])?;
        let nodes = match (keyword.get("NSET"), keyword.get("ELSET")) {
            (Some(name), _) => RigidNodes::Set(name.to_string()),
            (None, Some(name)) => RigidNodes::Elements(name.to_string()),
            (None, None) => {
                let message = "no nodes are named; write NSET=... or ELSET=...";
                return Err(keyword.error(files, message));
            }
        };
        let rigid = Rigid {
            nodes,
            reference: node_or_set(keyword.require(files, "REFNODE")?),
            rotation: keyword.get("ROTNODE").map(node_or_set),
            follows: [true; 3],
            place: keyword.place,
            keyword: "RIGID BODY",
        };
        self.deck.properties.rigid.push(rigid);
        self.no_more(keyword)
    }

    /// Reads a coupling: the surface follows the reference node along the axes that a later
    /// `*KINEMATIC` gives.
    pub(super) fn coupling(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        let known = ["REFNODE", "SURFACE", "CONSTRAINTNAME", "ORIENTATION"];
        keyword.allow(files, &known)?;
        if keyword.has("ORIENTATION") {
            let why = "ORIENTATION: displacements follow along x, y, z here";
            self.refuse(keyword, keyword.place, why);
            return self.skip();
        }
        self.coupling = Some(Rigid {
            nodes: RigidNodes::Surface(keyword.require(files, "SURFACE")?.to_string()),
            reference: node_or_set(keyword.require(files, "REFNODE")?),
            rotation: None,
            follows: [false; 3],
            place: keyword.place,
            keyword: "COUPLING",
        });
        self.no_more(keyword)
    }

    /// Reads the first and last axis that follow, line by line; without lines all axes follow.
    pub(super) fn kinematic(&mut self, keyword: &Keyword) -> Result<()> {
        keyword.allow(&self.source.files, &[])?;
        let Some(mut rigid) = self.coupling.take() else {
            let message = "it belongs to no *COUPLING; put it below one";
            return Err(keyword.error(&self.source.files, message));
        };
        let mut is_given = false;
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
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
        self.deck.properties.rigid.push(rigid);
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

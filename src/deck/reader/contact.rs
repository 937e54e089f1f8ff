//! Reading of contact pairs, the laws of contact, and ties.

use super::block::BlockReader;
use crate::deck::bodies::unsupported;
use crate::deck::data::{
    Adjust, Clearance, ContactPair, EntitySelection, Interaction, Named, Properties, Resolved,
    TiedPair,
};
use crate::error::Result;
use crate::number::exact;

/// Reads laws of contact.
#[derive(Default)]
pub(super) struct InteractionReader {
    pub(super) all: Named<Interaction>,
    /// The surface interaction to which the next keywords belong.
    current: Option<String>,
}

impl InteractionReader {
    /// Reads the name of a law.
    pub(super) fn interaction(&mut self, block: &mut BlockReader) -> Result<()> {
        block.allow("NAME PADTHICKNESS")?;
        let name = block.require("NAME")?;
        if let Some(thickness) = block.number("PADTHICKNESS")?
            && thickness != 0.0
        {
            let message = format!(
                "PAD THICKNESS={}: surfaces touch where their elements end; give 0",
                exact(thickness)
            );
            return Err(unsupported(block.error(message)));
        }
        *self.all.entry(name) = Interaction {
            place: block.keyword.place,
            stiffness: None,
        };
        self.current = Some(name.to_string());
        // A thickness out of the plane may follow; it is not used, because forces are per unit
        // thickness.
        block.skip()
    }

    /// Reads the law of contact, which is hard or linear: other laws of pressure over overlap are
    /// taken as hard contact.
    pub(super) fn behavior(&mut self, block: &mut BlockReader) -> Result<()> {
        block.allow("PRESSURE-OVERCLOSURE DIRECT PENALTY AUGMENTEDLAGRANGE NOSEPARATION")?;
        let laws = [
            "HARD",
            "LINEAR",
            "EXPONENTIAL",
            "TABULAR",
            "TIED",
            "SCALE FACTOR",
        ];
        let law = block.choice("PRESSURE-OVERCLOSURE", &laws)?;
        if law == "TIED" || block.keyword.has("NOSEPARATION") {
            block.refuse("surfaces in contact can separate: use a *TIE for surfaces that never do");
        } else if law == "LINEAR" {
            return self.slope(block);
        } else if law != "HARD" {
            let how = format!(
                "PRESSURE-OVERCLOSURE={law} is taken as hard contact: the surfaces do not overlap, \
                 and no stiffness is needed"
            );
            block.take(&how);
        }
        block.skip()
    }

    /// Reads the slope of the pressure. The further value that CalculiX accepts, a tension at large
    /// distance, has no counterpart here.
    fn slope(&mut self, block: &mut BlockReader) -> Result<()> {
        let (_, mut row) = block.one_row("the slope of the pressure over the overlap")?;
        let slope = row.number("the slope")?;
        if slope <= 0.0 {
            let message = format!("the slope is {}; it must be positive", exact(slope));
            return Err(row.place.error(message));
        }
        let name = self.current.as_deref();
        match name.and_then(|name| self.all.get_mut(name)) {
            Some(interaction) => interaction.stiffness = Some(slope),
            None => {
                let message = "it belongs to no *SURFACE INTERACTION; put it below one";
                return Err(block.error(message));
            }
        }
        let how = format!(
            "PRESSURE-OVERCLOSURE=LINEAR: soft contact of pressure {} times overlap",
            exact(slope)
        );
        block.take(&how);
        block.skip()
    }
}

/// Reads the coefficient of friction, which must be 0.
pub(super) fn friction(block: &mut BlockReader) -> Result<()> {
    let mut coefficient = f64::NAN;
    if let Some((_, mut row)) = block.row()? {
        coefficient = row.number_or("the coefficient of friction", 0.0)?;
    }
    if coefficient != 0.0 {
        block.refuse("contact is frictionless: take it out, or give the coefficient 0");
    }
    block.skip()
}

/// Reads pairs of surfaces that may touch, or that are tied.
pub(super) fn contact_pair(block: &mut BlockReader, properties: &mut Properties) -> Result<()> {
    let known = "INTERACTION TYPE SMALLSLIDING ADJUST EXTENSIONZONE HCRIT TRACKING TIED CPSET \
                 NOTHICKNESS SUPPLEMENTARYCONSTRAINTS MINIMUMDISTANCE";
    block.allow(known)?;
    if block.keyword.has("TIED") {
        return tied_contact(block, &mut properties.ties);
    }
    let interaction = block.require("INTERACTION")?.to_string();
    let adjust = match block.keyword.get("ADJUST") {
        Some(text) if text.parse::<f64>().is_ok() => {
            let why = "give a distance, 0 or more, or a set of nodes, or take it out";
            let within = distance(text).map(Adjust::Within);
            Some(within.ok_or_else(|| block.error(format!("ADJUST={text}: {why}")))?)
        }
        Some(text) => Some(Adjust::Nodes(EntitySelection::Set(text.to_string()))),
        None => None,
    };
    for (place, [slave, master]) in block.pairs()? {
        properties.contacts.push(ContactPair {
            slave,
            master,
            interaction: interaction.clone(),
            adjust: adjust.clone(),
            is_closed: false,
            place,
        });
    }
    if !block.keyword.has("SMALLSLIDING") {
        let how = "sliding is small: each node stays at what it faces in the mesh";
        block.take(how);
    }
    Ok(())
}

/// A distance that a parameter gives.
fn distance(text: &str) -> Option<f64> {
    let distance = text.parse().ok();
    distance.filter(|distance: &f64| *distance >= 0.0 && distance.is_finite())
}

/// Reads a contact pair whose surfaces stay together. It is a tie of the slave nodes within the
/// distance that `ADJUST` gives.
fn tied_contact(block: &mut BlockReader, ties: &mut Vec<TiedPair>) -> Result<()> {
    let Some(tolerance) = block.keyword.get("ADJUST").and_then(distance) else {
        let message = "TIED: give the distance within which nodes are tied, ADJUST=..., or a \
                       *TIE instead";
        return Err(block.error(message));
    };
    tied_pairs(block, ties, Some(tolerance))?;
    let how = format!(
        "TIED: a *TIE with POSITION TOLERANCE={}, in the mean over faces",
        exact(tolerance)
    );
    block.take(&how);
    Ok(())
}

/// Reads lines of a slave and a master surface that are tied.
fn tied_pairs(
    block: &mut BlockReader,
    ties: &mut Vec<TiedPair>,
    tolerance: Option<f64>,
) -> Result<()> {
    let pairs = block.pairs()?.into_iter();
    ties.extend(pairs.map(|(place, [slave, master])| TiedPair {
        slave,
        master,
        tolerance,
        place,
    }));
    Ok(())
}

/// Reads surfaces that are tied.
pub(super) fn tie(block: &mut BlockReader, ties: &mut Vec<TiedPair>) -> Result<()> {
    let cyclic = ["CYCLICSYMMETRY", "MULTISTAGE", "FLUIDPERIODIC", "CYCLIC"];
    if cyclic.iter().any(|key| block.keyword.has(key)) {
        let why = "there is no cyclic symmetry: model what repeats once, with symmetry planes";
        block.refuse(why);
        return block.skip();
    }
    let known = "NAME POSITIONTOLERANCE ADJUST TYPE NOROTATION NOTHICKNESS";
    block.allow(known)?;
    let tolerance = match block.keyword.get("POSITIONTOLERANCE") {
        Some(text) => {
            let why = || format!("POSITION TOLERANCE={text} must be a distance, 0 or more");
            Some(distance(text).ok_or_else(|| block.error(why()))?)
        }
        None => None,
    };
    let is_moved = block.choice("ADJUST", &["YES", "NO"])? == "YES";
    tied_pairs(block, ties, tolerance)?;
    let how = match is_moved {
        true => "the surfaces are tied in the mean over their faces, not node by node",
        false => {
            "the surfaces are tied in the mean over their faces, not node by node; nodes of \
             the slave surface are moved onto the master surface, ADJUST=NO or not"
        }
    };
    block.take(how);
    Ok(())
}

/// Reads pairs whose overlap Abaqus resolves over a step. Here every overlap is resolved evenly
/// over the first step, which is also what `SHRINK` requests. A given allowable interference that
/// decreases to zero leads to the same state at the end of the step.
pub(super) fn contact_interference(
    block: &mut BlockReader,
    step: Option<usize>,
    resolved: &mut Vec<Resolved>,
) -> Result<()> {
    block.allow("AMPLITUDE OP SHRINK TYPE")?;
    block.choice("OP", &["MOD", "NEW"])?;
    let is_shrink = block.keyword.has("SHRINK");
    let refused = match step {
        None => {
            return Err(block.error("it stands in no *STEP; put it in the first"));
        }
        Some(0) if block.choice("TYPE", &["CONTACT PAIR", "ELEMENT"])? == "ELEMENT" => {
            Some("TYPE=ELEMENT: contact is that of surfaces; give it to a *CONTACT PAIR")
        }
        Some(0) if block.keyword.has("AMPLITUDE") && !is_shrink => Some(
            "AMPLITUDE: an overlap is resolved evenly over the first step: give SHRINK instead",
        ),
        Some(0) => None,
        Some(_) => Some("overlaps are resolved over the first step: put it there"),
    };
    if let Some(why) = refused {
        block.refuse(why);
        return block.skip();
    }
    while let Some((place, mut row)) = block.row()? {
        let slave = row.text("the slave surface")?;
        let master = row.text("the master surface")?;
        let allowed = row.number_or("the allowable interference", 0.0)?;
        if !is_shrink && (allowed < 0.0 || !row.is_at_end()) {
            let why = "an interference that is not in the mesh is given by *CLEARANCE with a \
                       negative value, and acts along the normal: give SHRINK, or *CLEARANCE";
            block.refuse_at(place, why);
            continue;
        }
        resolved.push(Resolved {
            slave,
            master,
            place,
        });
    }
    if !is_shrink {
        let how = "the overlap of the mesh is resolved evenly over the first step, whatever \
                   the allowable interference: its end is the same";
        block.take(how);
    }
    Ok(())
}

/// Reads the distance between two surfaces.
pub(super) fn clearance(block: &mut BlockReader, clearances: &mut Vec<Clearance>) -> Result<()> {
    block.allow("MASTER SLAVE VALUE")?;
    let [master, slave] = ["MASTER", "SLAVE"].map(|key| block.require(key));
    let (master, slave) = (master?.to_string(), slave?.to_string());
    block.require("VALUE")?;
    let value = block.number("VALUE")?.unwrap_or(0.0);
    clearances.push(Clearance {
        slave,
        master,
        value,
        place: block.keyword.place,
    });
    block.no_more()
}

//! Reading of contact pairs, the laws of contact, and ties.

use super::{Reader, fields};
use crate::deck::bodies::unsupported;
use crate::deck::data::{
    Adjust, Clearance, ContactPair, EntitySelection, Interaction, Resolved, TiedPair,
};
use crate::deck::keyword::Keyword;
use crate::error::Result;
use crate::number::exact;

impl Reader<'_> {
    pub(super) fn interaction(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        keyword.allow(files, &["NAME", "PADTHICKNESS"])?;
        let name = keyword.require(files, "NAME")?;
        if let Some(thickness) = keyword.number(files, "PADTHICKNESS")?
            && thickness != 0.0
        {
            let message = format!(
                "PAD THICKNESS={}: surfaces touch where their elements end; give 0",
                exact(thickness)
            );
            return Err(unsupported(keyword.error(files, message)));
        }
        *self.deck.properties.interactions.entry(name) = Interaction {
            place: keyword.place,
            stiffness: None,
        };
        self.interaction = Some(name.to_string());
        // A thickness out of the plane may follow; it is not used, because forces are per unit
        // thickness.
        self.skip()
    }

    /// Reads the law of contact: exact complementarity, for hard contact or on a linear spring.
    pub(super) fn behavior(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        keyword.allow(
            files,
            &[
                "PRESSURE-OVERCLOSURE",
                "DIRECT",
                "PENALTY",
                "AUGMENTEDLAGRANGE",
                "NOSEPARATION",
            ],
        )?;
        let laws = [
            "HARD",
            "LINEAR",
            "EXPONENTIAL",
            "TABULAR",
            "TIED",
            "SCALE FACTOR",
        ];
        let law = keyword.choice(files, "PRESSURE-OVERCLOSURE", &laws)?;
        if law == "TIED" || keyword.has("NOSEPARATION") {
            self.refuse(
                keyword,
                keyword.place,
                "surfaces in contact can part: give those that never do a *TIE instead",
            );
        } else if law == "LINEAR" {
            return self.slope(keyword);
        } else if law != "HARD" {
            let how = format!(
                "PRESSURE-OVERCLOSURE={law} is taken as hard contact: the surfaces do not overlap, \
                 and no stiffness is needed"
            );
            self.take(keyword, keyword.place, &how);
        }
        self.skip()
    }

    /// Reads the slope of the pressure. The further value that CalculiX accepts, a tension at large
    /// distance, has no counterpart here.
    fn slope(&mut self, keyword: &Keyword) -> Result<()> {
        let line = self.one_line(keyword, "the slope of the pressure over the overlap")?;
        let mut row = fields(&self.source, keyword, line);
        let slope = row.number("the slope")?;
        if slope <= 0.0 {
            let message = format!("the slope is {}; it must be positive", exact(slope));
            return Err(row.place.error(message));
        }
        let interactions = &mut self.deck.properties.interactions;
        match self
            .interaction
            .as_deref()
            .and_then(|name| interactions.get_mut(name))
        {
            Some(interaction) => interaction.stiffness = Some(slope),
            None => {
                let message = "it belongs to no *SURFACE INTERACTION; put it below one";
                return Err(keyword.error(&self.source.files, message));
            }
        }
        let how = format!(
            "PRESSURE-OVERCLOSURE=LINEAR: soft contact of pressure {} times overlap",
            exact(slope)
        );
        self.take(keyword, keyword.place, &how);
        self.skip()
    }

    /// Reads the coefficient of friction, which must be 0.
    pub(super) fn friction(&mut self, keyword: &Keyword) -> Result<()> {
        let mut coefficient = f64::NAN;
        if let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            coefficient = row.number_or("the coefficient of friction", 0.0)?;
        }
        if coefficient != 0.0 {
            self.refuse(
                keyword,
                keyword.place,
                "contact is frictionless: take it out, or give the coefficient 0",
            );
        }
        self.skip()
    }

    pub(super) fn contact_pair(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        let known = [
            "INTERACTION",
            "TYPE",
            "SMALLSLIDING",
            "ADJUST",
            "EXTENSIONZONE",
            "HCRIT",
            "TRACKING",
            "TIED",
            "CPSET",
            "NOTHICKNESS",
            "SUPPLEMENTARYCONSTRAINTS",
            "MINIMUMDISTANCE",
        ];
        keyword.allow(files, &known)?;
        if keyword.has("TIED") {
            return self.tied_contact(keyword);
        }
        let interaction = keyword.require(files, "INTERACTION")?.to_string();
        let adjust = match keyword.get("ADJUST") {
            Some(text) => match text.parse::<f64>() {
                Ok(distance) if distance >= 0.0 && distance.is_finite() => {
                    Some(Adjust::Within(distance))
                }
                Ok(_) => {
                    let why = format!(
                        "ADJUST={text}: give a distance, 0 or more, or a set of nodes, or take it \
                         out"
                    );
                    return Err(keyword.error(files, why));
                }
                Err(_) => Some(Adjust::Nodes(EntitySelection::Set(text.to_string()))),
            },
            None => None,
        };
        let mut is_first = true;
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            let slave = row.text("the slave surface")?;
            let master = row.text("the master surface")?;
            row.end()?;
            self.deck.properties.contacts.push(ContactPair {
                slave,
                master,
                interaction: interaction.clone(),
                adjust: adjust.clone(),
                is_closed: false,
                place: line.place,
            });
            is_first = false;
        }
        if is_first {
            let message = "a line with the slave and the master surface should follow; give it";
            return Err(keyword.error(&self.source.files, message));
        }
        if !keyword.has("SMALLSLIDING") {
            let how = "sliding is small: each node stays at what it faces in the mesh";
            self.take(keyword, keyword.place, how);
        }
        Ok(())
    }

    /// Reads a contact pair whose surfaces stay together. It is a tie of the slave nodes within the
    /// distance that `ADJUST` gives.
    fn tied_contact(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        let distance = keyword.get("ADJUST").and_then(|text| text.parse().ok());
        let Some(tolerance) = distance.filter(|d: &f64| *d >= 0.0 && d.is_finite()) else {
            let message = "TIED: give the distance within which nodes are tied, ADJUST=..., or a \
                           *TIE instead";
            return Err(keyword.error(files, message));
        };
        self.tied_pairs(keyword, Some(tolerance))?;
        let how = format!(
            "TIED: a *TIE with POSITION TOLERANCE={}, in the mean over faces",
            exact(tolerance)
        );
        self.take(keyword, keyword.place, &how);
        Ok(())
    }

    /// Reads lines of a slave and a master surface that are tied.
    fn tied_pairs(&mut self, keyword: &Keyword, tolerance: Option<f64>) -> Result<()> {
        let mut is_first = true;
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            let slave = row.text("the slave surface")?;
            let master = row.text("the master surface")?;
            row.end()?;
            self.deck.properties.ties.push(TiedPair {
                slave,
                master,
                tolerance,
                place: line.place,
            });
            is_first = false;
        }
        if is_first {
            let message = "a line with the slave and the master surface should follow; give it";
            return Err(keyword.error(&self.source.files, message));
        }
        Ok(())
    }

    pub(super) fn tie(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        let cyclic = ["CYCLICSYMMETRY", "MULTISTAGE", "FLUIDPERIODIC", "CYCLIC"];
        if cyclic.iter().any(|key| keyword.has(key)) {
            let why = "there is no cyclic symmetry: model what repeats once, with symmetry planes";
            self.refuse(keyword, keyword.place, why);
            return self.skip();
        }
        let known = [
            "NAME",
            "POSITIONTOLERANCE",
            "ADJUST",
            "TYPE",
            "NOROTATION",
            "NOTHICKNESS",
        ];
        keyword.allow(files, &known)?;
        let tolerance = match keyword.get("POSITIONTOLERANCE") {
            Some(text) => match text.parse::<f64>() {
                Ok(distance) if distance >= 0.0 && distance.is_finite() => Some(distance),
                _ => {
                    let why = format!("POSITION TOLERANCE={text} must be a distance, 0 or more");
                    return Err(keyword.error(files, why));
                }
            },
            None => None,
        };
        let is_moved = keyword.choice(files, "ADJUST", &["YES", "NO"])? == "YES";
        self.tied_pairs(keyword, tolerance)?;
        let how = match is_moved {
            true => "the surfaces are tied in the mean over their faces, not node by node",
            false => {
                "the surfaces are tied in the mean over their faces, not node by node; nodes of \
                 the slave surface are moved onto the master surface, ADJUST=NO or not"
            }
        };
        self.take(keyword, keyword.place, how);
        Ok(())
    }

    /// Reads pairs whose overlap Abaqus resolves over a step. Here every overlap is resolved evenly
    /// over the first step, which `SHRINK` asks for too. A given allowable interference that
    /// decreases to zero leads to the same state at the end of the step.
    pub(super) fn contact_interference(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        keyword.allow(files, &["AMPLITUDE", "OP", "SHRINK", "TYPE"])?;
        keyword.choice(files, "OP", &["MOD", "NEW"])?;
        let is_shrink = keyword.has("SHRINK");
        let refused = match self.current_step() {
            None => {
                return Err(keyword.error(files, "it stands in no *STEP; put it in the first"));
            }
            Some(0)
                if keyword.choice(files, "TYPE", &["CONTACT PAIR", "ELEMENT"])? == "ELEMENT" =>
            {
                Some("TYPE=ELEMENT: contact is that of surfaces; give it to a *CONTACT PAIR")
            }
            Some(0) if keyword.has("AMPLITUDE") && !is_shrink => Some(
                "AMPLITUDE: an overlap is resolved evenly over the first step: give SHRINK instead",
            ),
            Some(0) => None,
            Some(_) => Some("overlaps are resolved over the first step: put it there"),
        };
        if let Some(why) = refused {
            self.refuse(keyword, keyword.place, why);
            return self.skip();
        }
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            let slave = row.text("the slave surface")?;
            let master = row.text("the master surface")?;
            let allowed = row.number_or("the allowable interference", 0.0)?;
            if !is_shrink && (allowed < 0.0 || !row.is_at_end()) {
                let why = "an interference that is not in the mesh is given by *CLEARANCE with a \
                           negative value, and acts along the normal: give SHRINK, or *CLEARANCE";
                self.refuse(keyword, line.place, why);
                continue;
            }
            self.deck.properties.resolved.push(Resolved {
                slave,
                master,
                place: line.place,
            });
        }
        if !is_shrink {
            let how = "the overlap of the mesh is resolved evenly over the first step, whatever \
                       the allowable interference: its end is the same";
            self.take(keyword, keyword.place, how);
        }
        Ok(())
    }

    pub(super) fn clearance(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        keyword.allow(files, &["MASTER", "SLAVE", "VALUE"])?;
        let [master, slave] = ["MASTER", "SLAVE"].map(|key| keyword.require(files, key));
        let (master, slave) = (master?.to_string(), slave?.to_string());
        keyword.require(files, "VALUE")?;
        let value = keyword.number(files, "VALUE")?.unwrap_or(0.0);
        self.deck.properties.clearances.push(Clearance {
            slave,
            master,
            value,
            place: keyword.place,
        });
        self.no_more(keyword)
    }
}

//! Reading of materials, sections, contact and constraints.

use super::mesh::target;
use super::{Reader, fields};
use crate::deck::data::{
    Adjust, Clearance, ContactPair, Equation, Hardening, Interaction, MaterialData, Section,
    Target, TiedPair, Transform,
};
use crate::deck::fields::Where;
use crate::deck::keyword::Keyword;
use crate::error::Result;
use crate::number::exact;

/// Largest number of terms of an equation.
const MOST_TERMS: u64 = 100_000;

impl Reader<'_> {
    pub(super) fn material(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        keyword.allow(files, &["NAME"])?;
        let name = keyword.require(files, "NAME")?;
        if self.deck.properties.materials.get(name).is_some() {
            let message = format!("a second material {name}; rename one of them");
            return Err(keyword.error(files, message));
        }
        self.deck.properties.materials.entry(name).place = keyword.place;
        self.material = Some(name.to_string());
        self.no_more(keyword)
    }

    /// The material to which a law belongs.
    pub(super) fn of_material(&mut self, keyword: &Keyword) -> Result<&mut MaterialData> {
        let name = self.material.as_deref();
        let materials = &mut self.deck.properties.materials;
        match name.and_then(|name| materials.get_mut(name)) {
            Some(material) => Ok(material),
            None => Err(keyword.error(
                &self.source.files,
                "it belongs to no *MATERIAL; put it below one",
            )),
        }
    }

    pub(super) fn elastic(&mut self, keyword: &Keyword) -> Result<()> {
        keyword.allow(&self.source.files, &["TYPE"])?;
        let types = [
            "ISO",
            "ISOTROPIC",
            "ORTHO",
            "ORTHOTROPIC",
            "ENGINEERING CONSTANTS",
            "ANISO",
            "ANISOTROPIC",
        ];
        if !keyword
            .choice(&self.source.files, "TYPE", &types)?
            .starts_with("ISO")
        {
            self.refuse(keyword, keyword.place, "elasticity is isotropic here");
            return self.skip();
        }
        let mut rows: Vec<(f64, [f64; 2])> = Vec::new();
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            let law = [
                row.number("Young's modulus")?,
                row.number("Poisson's ratio")?,
            ];
            let temperature = row.number_or("the temperature", 0.0)?;
            row.end()?;
            ascending(&row.place, rows.last().map(|last| last.0), temperature)?;
            rows.push((temperature, law));
        }
        if rows.is_empty() {
            let message = "a line with Young's modulus and Poisson's ratio should follow; give it";
            return Err(keyword.error(&self.source.files, message));
        }
        self.of_material(keyword)?.elastic = rows;
        Ok(())
    }

    pub(super) fn plastic(&mut self, keyword: &Keyword) -> Result<()> {
        keyword.allow(&self.source.files, &["HARDENING", "RATE"])?;
        let laws = ["ISOTROPIC", "KINEMATIC", "COMBINED", "JOHNSON COOK", "USER"];
        let law = keyword.choice(&self.source.files, "HARDENING", &laws)?;
        let is_kinematic = law == "KINEMATIC";
        if !(is_kinematic || law == "ISOTROPIC") || keyword.has("RATE") {
            let why = "hardening of decks is isotropic or linear kinematic, and independent of \
                       rate; back stresses that fade are `back_stresses` of a scene's material";
            self.refuse(keyword, keyword.place, why);
            return self.skip();
        }
        let mut tables: Vec<(f64, Hardening)> = Vec::new();
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            let stress = row.number("the yield stress")?;
            let strain = row.number_or("the plastic strain", 0.0)?;
            let temperature = row.number_or("the temperature", 0.0)?;
            row.end()?;
            if tables.last().is_none_or(|last| last.0 != temperature) {
                ascending(&row.place, tables.last().map(|last| last.0), temperature)?;
                tables.push((temperature, Hardening::new()));
            }
            let Some((_, rows)) = tables.last_mut() else {
                continue;
            };
            let last = rows.last().map_or(-1.0, |row| row[0]);
            if (rows.is_empty() && strain != 0.0) || strain <= last {
                return Err(row.place.error(format!(
                    "the plastic strain is {}; the first must be 0, and each greater than the one \
                     before",
                    exact(strain)
                )));
            }
            rows.push([strain, stress]);
        }
        if tables.is_empty() {
            let message = "a line with yield stress and plastic strain should follow; give it";
            return Err(keyword.error(&self.source.files, message));
        }
        if is_kinematic && !tables.iter().all(|(_, rows)| is_straight(rows)) {
            let why = "kinematic hardening of a deck is linear: give two lines, its ends";
            self.refuse(keyword, keyword.place, why);
        }
        let material = self.of_material(keyword)?;
        (material.plastic, material.is_kinematic) = (tables, is_kinematic);
        self.skip()
    }

    pub(super) fn section(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        let known = ["ELSET", "MATERIAL", "ORIENTATION", "CONTROLS", "OFFSET"];
        keyword.allow(files, &known)?;
        let elements = keyword.require(files, "ELSET")?.to_string();
        let material = keyword.require(files, "MATERIAL")?.to_string();
        if keyword.has("ORIENTATION") {
            let how = "ORIENTATION: materials are isotropic, stresses are along x, y, z";
            self.take(keyword, keyword.place, how);
        }
        if keyword.has("OFFSET") {
            let why = "OFFSET: sections of solids and of the plane have none";
            self.ignore(keyword, keyword.place, why);
        }
        let mut thickness = None;
        if let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            let given = row.number_or("the thickness", 1.0)?;
            if given <= 0.0 {
                let message = format!("the thickness is {}; it must be positive", exact(given));
                return Err(row.place.error(message));
            }
            thickness = Some(given);
        }
        self.deck.properties.sections.push(Section {
            elements,
            material,
            thickness,
            place: keyword.place,
        });
        self.skip()
    }

    pub(super) fn interaction(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        keyword.allow(files, &["NAME"])?;
        let name = keyword.require(files, "NAME")?;
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
        ];
        keyword.allow(files, &known)?;
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
                Err(_) => Some(Adjust::Nodes(Target::Set(text.to_string()))),
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

    /// Reads the number of terms, then node, degree of freedom and coefficient of each term, line
    /// by line.
    pub(super) fn equation(&mut self, keyword: &Keyword) -> Result<()> {
        keyword.allow(&self.source.files, &[])?;
        while let Some(first) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, first);
            let n = row.label("the number of terms")?;
            if !(1..=MOST_TERMS).contains(&n) {
                return Err(row.place.error(format!(
                    "{n} terms; give at least 1 and at most {MOST_TERMS}"
                )));
            }
            row.end()?;
            let mut terms = Vec::new();
            while (terms.len() as u64) < n {
                let line = self.one_line(keyword, "node, degree of freedom and coefficient")?;
                let mut row = fields(&self.source, keyword, line);
                while !row.is_at_end() {
                    let node = target(&mut row)?;
                    let freedom = row.label("the degree of freedom")? as usize;
                    terms.push((node, freedom, row.number("the coefficient")?));
                }
            }
            if terms.len() as u64 != n {
                let place = self.source.files.show(first.place);
                let message = format!(
                    "{place}: *EQUATION: {n} terms are announced, {} are given",
                    terms.len()
                );
                return Err(crate::Error::input(message));
            }
            self.deck.properties.equations.push(Equation {
                terms,
                place: first.place,
            });
        }
        Ok(())
    }

    pub(super) fn transform(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        keyword.allow(files, &["NSET", "TYPE"])?;
        let nodes = keyword.require(files, "NSET")?.to_string();
        let is_cylindrical = keyword.choice(files, "TYPE", &["R", "C"])? == "C";
        let line = self.one_line(keyword, "the coordinates of two points")?;
        let mut row = fields(&self.source, keyword, line);
        let mut points = [[0.0; 3]; 2];
        for x in points.as_flattened_mut() {
            *x = row.number_or("a coordinate", 0.0)?;
        }
        row.end()?;
        self.deck.properties.transforms.push(Transform {
            nodes,
            is_cylindrical,
            points,
            place: keyword.place,
        });
        self.no_more(keyword)
    }

    pub(super) fn initial_conditions(&mut self, keyword: &Keyword) -> Result<()> {
        match keyword.get("TYPE").map(str::to_uppercase).as_deref() {
            Some("TEMPERATURE") => {
                keyword.allow(&self.source.files, &["TYPE"])?;
                return self.temperatures(keyword, None);
            }
            _ => self.refuse(
                keyword,
                keyword.place,
                "bodies begin without stress and strain",
            ),
        }
        self.skip()
    }
}

/// Requires the temperatures of a table to be ascending.
pub(super) fn ascending(place: &Where, last: Option<f64>, temperature: f64) -> Result<()> {
    match last.filter(|last| temperature <= *last) {
        None => Ok(()),
        Some(last) => Err(place.error(format!(
            "temperature {} must be greater than {} before it",
            exact(temperature),
            exact(last)
        ))),
    }
}

/// Whether rows of plastic strain and yield stress lie on a line, within the digits of a deck.
fn is_straight(rows: &[[f64; 2]]) -> bool {
    let (Some([from, low]), Some([to, high])) = (rows.first(), rows.last()) else {
        return true;
    };
    let on_line = |strain: f64| low + (high - low) * (strain - from) / (to - from);
    let off = |[strain, stress]: &[f64; 2]| (stress - on_line(*strain)).abs();
    rows.len() <= 2 || rows.iter().all(|row| off(row) <= 1e-6 * high.abs())
}

//! Reading of materials, sections and constraints.

use super::mesh::target;
use super::{Reader, fields};
use crate::deck::bodies::unsupported;
use crate::deck::data::{HardeningRows, LinearEquation, MaterialData, Section, Transform};
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

    /// Requires that a material's law does not depend on further variables.
    ///
    /// # Errors
    /// `Unsupported`, with their number.
    pub(super) fn without_dependencies(&self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        match keyword.number(files, "DEPENDENCIES")? {
            Some(n) if n != 0.0 => {
                let message = format!(
                    "DEPENDENCIES={n}: materials depend on no field variables here; give 0, and \
                     lines without them"
                );
                Err(unsupported(keyword.error(files, message)))
            }
            _ => Ok(()),
        }
    }

    pub(super) fn elastic(&mut self, keyword: &Keyword) -> Result<()> {
        keyword.allow(&self.source.files, &["TYPE", "MODULI", "DEPENDENCIES"])?;
        self.without_dependencies(keyword)?;
        // Moduli at once and in the long run differ in viscoelastic materials alone.
        let moduli = ["LONG TERM", "INSTANTANEOUS"];
        keyword.choice(&self.source.files, "MODULI", &moduli)?;
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
        let known = ["HARDENING", "RATE", "DEPENDENCIES", "EXTRAPOLATION"];
        keyword.allow(&self.source.files, &known)?;
        self.without_dependencies(keyword)?;
        let ways = ["CONSTANT", "LINEAR"];
        let goes_on = keyword.choice(&self.source.files, "EXTRAPOLATION", &ways)? == "LINEAR";
        let laws = ["ISOTROPIC", "KINEMATIC", "COMBINED", "JOHNSON COOK", "USER"];
        let law = keyword.choice(&self.source.files, "HARDENING", &laws)?;
        let is_kinematic = law == "KINEMATIC";
        if !(is_kinematic || law == "ISOTROPIC") || keyword.has("RATE") {
            let why = "hardening of decks is isotropic or linear kinematic, and independent of \
                       rate: give HARDENING=ISOTROPIC or HARDENING=KINEMATIC with a table, \
                       without RATE";
            self.refuse(keyword, keyword.place, why);
            return self.skip();
        }
        let mut tables: Vec<(f64, HardeningRows)> = Vec::new();
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            let stress = row.number("the yield stress")?;
            let strain = row.number_or("the plastic strain", 0.0)?;
            let temperature = row.number_or("the temperature", 0.0)?;
            row.end()?;
            if tables.last().is_none_or(|last| last.0 != temperature) {
                ascending(&row.place, tables.last().map(|last| last.0), temperature)?;
                tables.push((temperature, HardeningRows::new()));
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
        if goes_on {
            tables.iter_mut().for_each(|(_, rows)| extend(rows));
        }
        let material = self.of_material(keyword)?;
        (material.plastic, material.is_kinematic) = (tables, is_kinematic);
        self.skip()
    }

    pub(super) fn section(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        let known = [
            "ELSET",
            "MATERIAL",
            "ORIENTATION",
            "CONTROLS",
            "OFFSET",
            "STACKDIRECTION",
            "LAYUP",
            "SYMMETRIC",
            "REFNODE",
            "COMPOSITE",
            "NODALTHICKNESS",
        ];
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
        if keyword.has("STACKDIRECTION") {
            let why = "STACK DIRECTION: sections are of one material, without layers";
            self.ignore(keyword, keyword.place, why);
        }
        for key in ["LAYUP", "SYMMETRIC", "REFNODE"] {
            if keyword.has(key) {
                let why = format!("{key}: without effect on a section of one material");
                self.ignore(keyword, keyword.place, &why);
            }
        }
        for (key, why) in [
            (
                "COMPOSITE",
                "layers are elements of their own, each with its material",
            ),
            (
                "NODALTHICKNESS",
                "the thickness of a plane model is one number on the next line",
            ),
        ] {
            if keyword.has(key) {
                self.refuse(keyword, keyword.place, &format!("{key}: {why}"));
                return self.skip();
            }
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

    /// Reads the number of terms, then node, degree of freedom and coefficient of each term, line
    /// by line.
    pub(super) fn equation(&mut self, keyword: &Keyword) -> Result<()> {
        keyword.allow(&self.source.files, &["REMOVE"])?;
        if keyword.has("REMOVE") {
            let why = "REMOVE: equations are the same in all steps; take it out";
            self.refuse(keyword, keyword.place, why);
            return self.skip();
        }
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
            self.deck.properties.equations.push(LinearEquation {
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

/// Plastic strain up to which a curve is continued along its last slope.
const FAR: f64 = 1e3;

/// Continues rows of plastic strain and yield stress along the slope between the last two.
fn extend(rows: &mut HardeningRows) {
    if let [.., [from, low], [to, high]] = rows[..]
        && high != low
    {
        rows.push([to + FAR, high + (high - low) / (to - from) * FAR]);
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

//! Reading of materials, sections and constraints.

use super::block::BlockReader;
use super::mesh::target;
use crate::deck::bodies::unsupported;
use crate::deck::data::{HardeningRows, LinearEquation, MaterialData, Named, Section, Transform};
use crate::deck::expansion::Expansion;
use crate::deck::fields::Where;
use crate::error::Result;
use crate::number::exact;

/// Largest number of terms of an equation.
const MOST_TERMS: u64 = 100_000;

/// Reads materials.
#[derive(Default)]
pub(super) struct MaterialReader {
    pub(super) all: Named<MaterialData>,
    /// The material to which the next keywords belong.
    current: Option<String>,
}

impl MaterialReader {
    /// Reads the name of a material.
    pub(super) fn material(&mut self, block: &mut BlockReader) -> Result<()> {
        block.allow("NAME")?;
        let name = block.require("NAME")?;
        if self.all.get(name).is_some() {
            let message = format!("a second material {name}; rename one of them");
            return Err(block.error(message));
        }
        self.all.entry(name).place = block.keyword.place;
        self.current = Some(name.to_string());
        block.no_more()
    }

    /// The material to which a law belongs.
    fn current(&mut self, block: &BlockReader) -> Result<&mut MaterialData> {
        let name = self.current.as_deref();
        let material = name.and_then(|name| self.all.get_mut(name));
        material.ok_or_else(|| block.error("it belongs to no *MATERIAL; put it below one"))
    }

    pub(super) fn elastic(&mut self, block: &mut BlockReader) -> Result<()> {
        block.allow("TYPE MODULI DEPENDENCIES")?;
        without_dependencies(block)?;
        // Instantaneous and long-term moduli differ in viscoelastic materials alone.
        let moduli = ["LONG TERM", "INSTANTANEOUS"];
        block.choice("MODULI", &moduli)?;
        let types = [
            "ISO",
            "ISOTROPIC",
            "ORTHO",
            "ORTHOTROPIC",
            "ENGINEERING CONSTANTS",
            "ANISO",
            "ANISOTROPIC",
        ];
        if !block.choice("TYPE", &types)?.starts_with("ISO") {
            block.refuse("elasticity is isotropic here");
            return block.skip();
        }
        let mut rows: Vec<(f64, [f64; 2])> = Vec::new();
        while let Some((_, mut row)) = block.row()? {
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
            return Err(block.error(message));
        }
        self.current(block)?.elastic = rows;
        Ok(())
    }

    pub(super) fn plastic(&mut self, block: &mut BlockReader) -> Result<()> {
        let known = "HARDENING RATE DEPENDENCIES EXTRAPOLATION";
        block.allow(known)?;
        without_dependencies(block)?;
        let ways = ["CONSTANT", "LINEAR"];
        let goes_on = block.choice("EXTRAPOLATION", &ways)? == "LINEAR";
        let laws = ["ISOTROPIC", "KINEMATIC", "COMBINED", "JOHNSON COOK", "USER"];
        let law = block.choice("HARDENING", &laws)?;
        let is_kinematic = law == "KINEMATIC";
        if !(is_kinematic || law == "ISOTROPIC") || block.keyword.has("RATE") {
            let why = "hardening of decks is isotropic or linear kinematic, and independent of \
                       rate: give HARDENING=ISOTROPIC or HARDENING=KINEMATIC with a table, \
                       without RATE";
            block.refuse(why);
            return block.skip();
        }
        let mut tables: Vec<(f64, HardeningRows)> = Vec::new();
        while let Some((_, mut row)) = block.row()? {
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
            return Err(block.error(message));
        }
        if is_kinematic && !tables.iter().all(|(_, rows)| is_straight(rows)) {
            let why = "kinematic hardening of a deck is linear: give two lines, its ends";
            block.refuse(why);
        }
        if goes_on {
            tables.iter_mut().for_each(|(_, rows)| extend(rows));
        }
        let material = self.current(block)?;
        (material.plastic, material.is_kinematic) = (tables, is_kinematic);
        block.skip()
    }

    pub(super) fn density(&mut self, block: &mut BlockReader) -> Result<()> {
        block.allow("DEPENDENCIES")?;
        without_dependencies(block)?;
        let value = one_value(block, "the density")?;
        self.current(block)?.density = Some(value);
        Ok(())
    }

    pub(super) fn expansion(&mut self, block: &mut BlockReader) -> Result<()> {
        block.allow("TYPE ZERO DEPENDENCIES")?;
        without_dependencies(block)?;
        block.choice("TYPE", &["ISO"])?;
        let zero = block.number("ZERO")?.unwrap_or(0.0);
        let mut rows: Vec<[f64; 2]> = Vec::new();
        while let Some((_, mut row)) = block.row()? {
            let coefficient = row.number("the coefficient of expansion")?;
            let temperature = row.number_or("the temperature", 0.0)?;
            row.end()?;
            ascending(&row.place, rows.last().map(|last| last[0]), temperature)?;
            rows.push([temperature, coefficient]);
        }
        if rows.is_empty() {
            let message = "a line with the coefficient of expansion should follow; give it";
            return Err(block.error(message));
        }
        let expansion = Expansion::new(rows, zero);
        if !expansion.is_constant() {
            let how = "by temperature: strains are exact at the times of the deck and at the ends \
                       of its steps and increments, and go straight between them";
            block.take(how);
        }
        self.current(block)?.expansion = Some(expansion);
        Ok(())
    }
}

/// Requires that a material's law does not depend on further variables.
///
/// # Errors
/// `Unsupported`, with the number of these variables.
fn without_dependencies(block: &BlockReader) -> Result<()> {
    match block.number("DEPENDENCIES")? {
        Some(n) if n != 0.0 => {
            let message = format!(
                "DEPENDENCIES={n}: materials depend on no field variables here; give 0, and \
                 lines without them"
            );
            Err(unsupported(block.error(message)))
        }
        _ => Ok(()),
    }
}

/// Reads a value that must not depend on temperature.
fn one_value(block: &mut BlockReader, what: &str) -> Result<f64> {
    let (_, mut row) = block.one_row(what)?;
    let value = row.number(what)?;
    row.number_or("the temperature", 0.0)?;
    row.end()?;
    if let Some((place, _)) = block.row()? {
        let why = format!("{what} does not depend on temperature here: give one line");
        block.refuse_at(place, &why);
    }
    block.skip()?;
    Ok(value)
}

/// Reads the material of a set of elements.
pub(super) fn section(block: &mut BlockReader, sections: &mut Vec<Section>) -> Result<()> {
    let keyword = block.keyword;
    let known = "ELSET MATERIAL ORIENTATION CONTROLS OFFSET STACKDIRECTION LAYUP SYMMETRIC \
                 REFNODE COMPOSITE NODALTHICKNESS";
    block.allow(known)?;
    let elements = block.require("ELSET")?.to_string();
    let material = block.require("MATERIAL")?.to_string();
    if keyword.has("ORIENTATION") {
        let how = "ORIENTATION: materials are isotropic, stresses are along x, y, z";
        block.take(how);
    }
    if keyword.has("OFFSET") {
        let why = "OFFSET: sections of solids and of the plane have none";
        block.ignore(why);
    }
    if keyword.has("STACKDIRECTION") {
        let why = "STACK DIRECTION: sections are of one material, without layers";
        block.ignore(why);
    }
    for key in ["LAYUP", "SYMMETRIC", "REFNODE"] {
        if keyword.has(key) {
            let why = format!("{key}: without effect on a section of one material");
            block.ignore(&why);
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
            block.refuse(&format!("{key}: {why}"));
            return block.skip();
        }
    }
    let mut thickness = None;
    if let Some((_, mut row)) = block.row()? {
        let given = row.number_or("the thickness", 1.0)?;
        if given <= 0.0 {
            let message = format!("the thickness is {}; it must be positive", exact(given));
            return Err(row.place.error(message));
        }
        thickness = Some(given);
    }
    sections.push(Section {
        elements,
        material,
        thickness,
        place: keyword.place,
    });
    block.skip()
}

/// Reads the number of terms, then node, degree of freedom and coefficient of each term, line
/// by line.
pub(super) fn equation(block: &mut BlockReader, equations: &mut Vec<LinearEquation>) -> Result<()> {
    block.allow("REMOVE")?;
    if block.keyword.has("REMOVE") {
        let why = "REMOVE: equations are the same in all steps; take it out";
        block.refuse(why);
        return block.skip();
    }
    while let Some((place, mut row)) = block.row()? {
        let n = row.label("the number of terms")?;
        if !(1..=MOST_TERMS).contains(&n) {
            return Err(row.place.error(format!(
                "{n} terms; give at least 1 and at most {MOST_TERMS}"
            )));
        }
        row.end()?;
        let mut terms = Vec::new();
        while (terms.len() as u64) < n {
            let (_, mut row) = block.one_row("node, degree of freedom and coefficient")?;
            while !row.is_at_end() {
                let node = target(&mut row)?;
                let freedom = row.label("the degree of freedom")? as usize;
                terms.push((node, freedom, row.number("the coefficient")?));
            }
        }
        if terms.len() as u64 != n {
            let message = format!("{n} terms are announced, {} are given", terms.len());
            return Err(block.source.files.error(place, "EQUATION", message));
        }
        equations.push(LinearEquation { terms, place });
    }
    Ok(())
}

/// Reads local axes.
pub(super) fn transform(block: &mut BlockReader, transforms: &mut Vec<Transform>) -> Result<()> {
    block.allow("NSET TYPE")?;
    let nodes = block.require("NSET")?.to_string();
    let is_cylindrical = block.choice("TYPE", &["R", "C"])? == "C";
    let (_, mut row) = block.one_row("the coordinates of two points")?;
    let mut points = [[0.0; 3]; 2];
    for x in points.as_flattened_mut() {
        *x = row.number_or("a coordinate", 0.0)?;
    }
    row.end()?;
    transforms.push(Transform {
        nodes,
        is_cylindrical,
        points,
        place: block.keyword.place,
    });
    block.no_more()
}

/// Requires the temperatures of a table to be ascending.
fn ascending(place: &Where, last: Option<f64>, temperature: f64) -> Result<()> {
    match last.filter(|last| temperature <= *last) {
        None => Ok(()),
        Some(last) => Err(place.error(format!(
            "temperature {} must be greater than {} before it",
            exact(temperature),
            exact(last)
        ))),
    }
}

/// Plastic strain by which a curve is continued beyond its last row, along its last slope.
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

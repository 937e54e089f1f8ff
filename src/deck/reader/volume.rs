//! Reading of loads on the volume of elements, and of the material properties that they need.

use super::mesh::target;
use super::properties::ascending;
use super::{Reader, fields};
use crate::deck::data::{Condition, ConditionKind, VolumeLoad};
use crate::deck::expansion::Expansion;
use crate::deck::fields::LineFields;
use crate::deck::keyword::Keyword;
use crate::error::Result;

impl Reader<'_> {
    pub(super) fn density(&mut self, keyword: &Keyword) -> Result<()> {
        keyword.allow(&self.source.files, &["DEPENDENCIES"])?;
        self.without_dependencies(keyword)?;
        let value = self.one_value(keyword, "the density")?;
        self.of_material(keyword)?.density = Some(value);
        Ok(())
    }

    pub(super) fn expansion(&mut self, keyword: &Keyword) -> Result<()> {
        keyword.allow(&self.source.files, &["TYPE", "ZERO", "DEPENDENCIES"])?;
        self.without_dependencies(keyword)?;
        keyword.choice(&self.source.files, "TYPE", &["ISO"])?;
        let zero = keyword.number(&self.source.files, "ZERO")?.unwrap_or(0.0);
        let mut rows: Vec<[f64; 2]> = Vec::new();
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            let coefficient = row.number("the coefficient of expansion")?;
            let temperature = row.number_or("the temperature", 0.0)?;
            row.end()?;
            ascending(&row.place, rows.last().map(|last| last[0]), temperature)?;
            rows.push([temperature, coefficient]);
        }
        if rows.is_empty() {
            let message = "a line with the coefficient of expansion should follow; give it";
            return Err(keyword.error(&self.source.files, message));
        }
        let expansion = Expansion::new(rows, zero);
        if !expansion.is_constant() {
            let how = "by temperature: strains are exact at the times of the deck and at the ends \
                       of its steps and increments, and go straight between them";
            self.take(keyword, keyword.place, how);
        }
        self.of_material(keyword)?.expansion = Some(expansion);
        Ok(())
    }

    /// Reads a value that must not depend on temperature.
    fn one_value(&mut self, keyword: &Keyword, what: &str) -> Result<f64> {
        let line = self.one_line(keyword, what)?;
        let mut row = fields(&self.source, keyword, line);
        let value = row.number(what)?;
        row.number_or("the temperature", 0.0)?;
        row.end()?;
        if let Some(line) = self.source.next_data()? {
            let why = format!("{what} does not depend on temperature here: give one line");
            self.refuse(keyword, line.place, &why);
        }
        self.skip()?;
        Ok(value)
    }

    pub(super) fn temperature(&mut self, keyword: &Keyword) -> Result<()> {
        let amplitude = self.conditions(keyword, ConditionKind::Temperature)?;
        self.temperatures(keyword, amplitude)
    }

    /// Reads lines of nodes and their temperatures.
    pub(super) fn temperatures(
        &mut self,
        keyword: &Keyword,
        amplitude: Option<String>,
    ) -> Result<()> {
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            let on = target(&mut row)?;
            let value = row.number("the temperature")?;
            row.end()?;
            self.add(Condition {
                kind: ConditionKind::Temperature,
                on,
                range: [1; 2],
                value,
                amplitude: amplitude.clone(),
                is_fixed: false,
                place: line.place,
            });
        }
        Ok(())
    }
}

/// The kind of load that a line of `*DLOAD` gives.
pub(super) enum OnVolume {
    /// A load on faces of elements.
    Face,
    /// A load on the volume, with its size.
    Load(VolumeLoad, f64),
    /// A load that brinell does not have, with the reason.
    Refused(String),
}

/// Reads a load on the volume of elements; of a load on faces nothing is read.
pub(super) fn volume_load(mut row: LineFields) -> Result<OnVolume> {
    let word = row.word();
    if word
        .first()
        .is_some_and(|first| first.eq_ignore_ascii_case(&b'P'))
        && word.len() == 2
    {
        return Ok(OnVolume::Face);
    }
    let word = super::super::fields::shown(word).to_uppercase();
    let unit = |way: [f64; 3]| {
        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
        (length > 0.0).then(|| way.map(|x| x / length))
    };
    match word.as_str() {
        "GRAV" => {
            let size = row.number("the acceleration")?;
            let way = vector(&mut row, "a component of the direction")?;
            row.end()?;
            let Some(way) = unit(way) else {
                return Err(row.place.error("the direction of GRAV has no length"));
            };
            Ok(OnVolume::Load(VolumeLoad::Acceleration(way), size))
        }
        "CENTRIF" => {
            let square = row.number("the square of the speed")?;
            let point = vector(&mut row, "a coordinate of the axis")?;
            let way = vector(&mut row, "a component of the axis")?;
            row.end()?;
            let Some(way) = unit(way).filter(|_| square >= 0.0) else {
                let message = "the axis of CENTRIF has no length, or the square of the speed is \
                               negative";
                return Err(row.place.error(message));
            };
            Ok(OnVolume::Load(VolumeLoad::Rotation([point, way]), square))
        }
        "BX" | "BY" | "BZ" | "NEWTON" => Ok(OnVolume::Refused(format!(
            "{word}: of loads on volumes GRAV and CENTRIF are there"
        ))),
        _ => Ok(OnVolume::Refused(format!(
            "{word}: of loads on elements pressures on faces, P1 to P6, GRAV and CENTRIF are there"
        ))),
    }
}

fn vector(row: &mut LineFields, what: &str) -> Result<[f64; 3]> {
    let mut out = [0.0; 3];
    for x in &mut out {
        *x = row.number_or(what, 0.0)?;
    }
    Ok(out)
}

//! Materials of the bodies of a new scene.

use super::text::toml;
use crate::cli::materials::of_list;
use crate::cli::values::{not_negative, poissons_ratio, positive};
use crate::error::{Error, Result};
use crate::files;
use crate::scene::{Material, Units};
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// Default Young's modulus [MPa].
const YOUNGS_MODULUS: f64 = 210_000.0;
const POISSONS_RATIO: f64 = 0.3;
/// Default yield stress [MPa].
const YIELD_STRESS: f64 = 500.0;
/// Default plastic modulus [MPa].
const PLASTIC_MODULUS: f64 = 2000.0;

/// The material of both bodies, or of the first.
#[derive(Debug, Args)]
pub(in crate::cli) struct First {
    /// A material from the list that `brinell materials` prints
    #[arg(
        long,
        value_name = "NAME",
        conflicts_with_all = [
            "youngs_modulus", "poissons_ratio", "yield_stress", "plastic_modulus",
            "hardening_table", "tensile_test",
        ]
    )]
    pub material: Option<String>,
    /// Young's modulus [MPa]; by default 210000
    #[arg(long, value_name = "E", value_parser = positive, allow_negative_numbers = true)]
    pub youngs_modulus: Option<f64>,
    /// Poisson's ratio; by default 0.3
    #[arg(long, value_name = "NU", value_parser = poissons_ratio, allow_negative_numbers = true)]
    pub poissons_ratio: Option<f64>,
    /// Yield stress [MPa]; by default 500 (`iso76` has no default, because the dent depends on it)
    #[arg(
        long,
        value_name = "Y",
        value_parser = positive,
        allow_negative_numbers = true,
        conflicts_with = "hardening_table"
    )]
    pub yield_stress: Option<f64>,
    /// Plastic modulus, d(yield stress)/d(plastic strain) [MPa]; 0 is perfectly plastic; by default
    /// 2000
    #[arg(long, value_name = "H", value_parser = not_negative, allow_negative_numbers = true)]
    pub plastic_modulus: Option<f64>,
    /// Hardening by a table: CSV file with a plastic strain and a stress [MPa] per line, from 0
    #[arg(long, value_name = "FILE", conflicts_with = "plastic_modulus")]
    pub hardening_table: Option<PathBuf>,
    /// Hardening by a tensile test: CSV file with engineering strain and stress [MPa] per line
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with_all = ["plastic_modulus", "hardening_table"]
    )]
    pub tensile_test: Option<PathBuf>,
}

/// Options for a second body of another material.
#[derive(Debug, Args)]
pub(in crate::cli) struct Second {
    /// Material of the second body, from the list that `brinell materials` prints
    #[arg(
        long,
        value_name = "NAME",
        conflicts_with_all = [
            "second_youngs_modulus", "second_poissons_ratio", "second_yield_stress",
            "second_plastic_modulus",
        ]
    )]
    pub second_material: Option<String>,
    /// Young's modulus of the second body [MPa]; by default that of the first
    #[arg(long, value_name = "E", value_parser = positive, allow_negative_numbers = true)]
    pub second_youngs_modulus: Option<f64>,
    /// Poisson's ratio of the second body; by default that of the first
    #[arg(long, value_name = "NU", value_parser = poissons_ratio, allow_negative_numbers = true)]
    pub second_poissons_ratio: Option<f64>,
    /// Yield stress of the second body [MPa]; by default that of the first
    #[arg(long, value_name = "Y", value_parser = positive, allow_negative_numbers = true)]
    pub second_yield_stress: Option<f64>,
    /// Plastic modulus of the second body [MPa]; by default that of the first
    #[arg(long, value_name = "H", value_parser = not_negative, allow_negative_numbers = true)]
    pub second_plastic_modulus: Option<f64>,
    /// The body that does not yield, whatever its stress
    #[arg(long, value_enum, value_name = "BODY")]
    pub elastic: Option<Which>,
}

/// One of the two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Which {
    /// The upper or inner body
    First,
    /// The lower or outer body
    Second,
}

/// A material in the form of a scene.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Made {
    /// Name of the material in the scene.
    name: String,
    /// Whether the material is in the list, so that the scene only names it.
    is_listed: bool,
    /// Moduli and yield stress in MPa.
    pub material: Material,
    /// Whether the body is kept elastic.
    is_elastic: bool,
}

impl Made {
    /// Creates a material with the given elastic constants for a body that does not yield.
    pub fn elastic_body(name: &str, youngs_modulus: f64, poissons_ratio: f64) -> Self {
        Made {
            name: name.to_string(),
            is_listed: false,
            material: Material {
                youngs_modulus,
                poissons_ratio,
                ..Material::default()
            },
            is_elastic: true,
        }
    }

    /// Returns the stress at which the body first yields, if it may yield.
    pub fn first_yield_stress(&self) -> Option<f64> {
        self.material
            .first_yield_stress()
            .filter(|_| !self.is_elastic)
    }

    /// Returns this material for a body that does not yield.
    pub fn kept_elastic(self) -> Self {
        Made {
            is_elastic: true,
            ..self
        }
    }

    /// Returns Young's modulus and Poisson's ratio.
    pub fn elastic(&self) -> [f64; 2] {
        [self.material.youngs_modulus, self.material.poissons_ratio]
    }
}

impl First {
    /// Whether a curve, a yield stress or a material of the list is given.
    pub(super) fn yields_as_given(&self) -> bool {
        let curve = self.hardening_table.is_some() || self.tensile_test.is_some();
        curve || self.material.is_some() || self.yield_stress.is_some()
    }

    /// Returns the material of the first body.
    pub(super) fn made(&self) -> Result<Made> {
        if let Some(name) = &self.material {
            return listed(name, "--material");
        }
        let hardening_table = self.hardening_table.as_deref().map(table).transpose()?;
        let tensile_test = self.tensile_test.as_deref().map(table).transpose()?;
        let by_numbers = hardening_table.is_none() && tensile_test.is_none();
        let material = Material {
            youngs_modulus: self.youngs_modulus.unwrap_or(YOUNGS_MODULUS),
            poissons_ratio: self.poissons_ratio.unwrap_or(POISSONS_RATIO),
            yield_stress: self.yield_stress.or(by_numbers.then_some(YIELD_STRESS)),
            plastic_modulus: by_numbers.then(|| self.plastic_modulus.unwrap_or(PLASTIC_MODULUS)),
            hardening_table,
            tensile_test,
            ..Material::default()
        };
        let file = self.hardening_table.as_ref().or(self.tensile_test.as_ref());
        if let Some(file) = file
            && !material
                .first_yield_stress()
                .is_some_and(|stress| stress > 0.0)
        {
            return Err(Error::input(format!(
                "{}: gives no yield stress above 0; a hardening_table begins at plastic strain 0 \
                 with the yield stress, a tensile_test with a row on the elastic line",
                file.display()
            )));
        }
        Ok(Made {
            name: "steel".to_string(),
            is_listed: false,
            material,
            is_elastic: false,
        })
    }
}

impl Second {
    /// Returns the materials of both bodies.
    pub(super) fn both(&self, first: &First) -> Result<[Made; 2]> {
        let mut first = first.made()?;
        let mut second = match &self.second_material {
            Some(name) => listed(name, "--second-material")?,
            None => self.changed(&first),
        };
        first.is_elastic = self.elastic == Some(Which::First);
        second.is_elastic = self.elastic == Some(Which::Second);
        Ok([first, second])
    }

    /// Returns the first body's material, changed by the values that are given for the second.
    fn changed(&self, first: &Made) -> Made {
        let mut made = first.clone();
        let material = &mut made.material;
        if let Some(modulus) = self.second_youngs_modulus {
            material.youngs_modulus = modulus;
        }
        if let Some(ratio) = self.second_poissons_ratio {
            material.poissons_ratio = ratio;
        }
        // A yield stress or a slope for the second body replaces the whole hardening law.
        if self.second_yield_stress.is_some() || self.second_plastic_modulus.is_some() {
            let slope = first.material.plastic_modulus_resolved().unwrap_or(0.0);
            material.yield_stress = self.second_yield_stress.or(material.first_yield_stress());
            material.plastic_modulus = Some(self.second_plastic_modulus.unwrap_or(slope));
            material.tangent_modulus = None;
            material.hardening_table = None;
            material.tensile_test = None;
        }
        if made.material != first.material {
            made.name = "second".to_string();
            made.is_listed = false;
        }
        made
    }
}

/// Returns a material of the list, in N, mm and MPa.
fn listed(name: &str, flag: &str) -> Result<Made> {
    let listed = of_list(name).map_err(|error| error.within(flag))?;
    Ok(Made {
        name: name.to_string(),
        is_listed: true,
        material: listed.material(&Units {
            length: "mm".to_string(),
            force: "N".to_string(),
            stress: "MPa".to_string(),
        })?,
        is_elastic: false,
    })
}

/// Reads two numbers per line of a CSV file, whose first line may be a heading.
fn table(path: &Path) -> Result<Vec<[f64; 2]>> {
    let text = files::read_text("read the table", path, Some(files::LARGEST_SCENE))?;
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut rows = Vec::new();
    for (index, record) in reader.records().enumerate() {
        let place = format!("{}: row {}", path.display(), index + 1);
        let damaged = |cause| Error::input(format!("{place} is damaged")).because(cause);
        let record = record.map_err(damaged)?;
        let numbers: Vec<f64> = record.iter().map_while(|cell| cell.parse().ok()).collect();
        match (<[f64; 2]>::try_from(&numbers[..]), record.len()) {
            (Ok(row), 2) => rows.push(row),
            _ if index == 0 && numbers.is_empty() => {}
            _ => {
                return Err(Error::input(format!(
                    "{place}: two numbers, strain and stress, are wanted, separated by a comma"
                )));
            }
        }
    }
    match rows.is_empty() {
        true => Err(Error::input(format!(
            "{} has no rows of numbers",
            path.display()
        ))),
        false => Ok(rows),
    }
}

/// Returns the tables of the materials, and of the bodies that are made of them.
pub(super) fn section(made: &[(&str, &Made)]) -> String {
    let mut text = String::new();
    let mut written: Vec<&str> = Vec::new();
    for (_, made) in made {
        if !made.is_listed && !written.contains(&made.name.as_str()) {
            text.push_str(&table_of(made));
            written.push(&made.name);
        }
    }
    for (body, made) in made {
        let name = format!("\"{}\"", made.name);
        let about = match made.is_listed {
            true => format!("`brinell materials {name}` has its numbers and their sources"),
            false => "plastic = false keeps a body elastic".to_string(),
        };
        let elastic = if made.is_elastic {
            "plastic = false\n"
        } else {
            ""
        };
        text.push_str(&format!(
            "[bodies.{body}]\nmaterial = {name}   # {about}\n{elastic}\n"
        ));
    }
    text
}

fn table_of(made: &Made) -> String {
    let material = &made.material;
    let mut text = format!(
        "[materials.{}]\nyoungs_modulus = {}\npoissons_ratio = {}\n",
        made.name,
        toml(material.youngs_modulus),
        toml(material.poissons_ratio)
    );
    if let Some(stress) = material.yield_stress {
        let stress = toml(stress);
        text.push_str(&format!(
            "yield_stress = {stress}             # without it the material is elastic\n"
        ));
    }
    if let Some(slope) = material.plastic_modulus {
        text.push_str(&format!(
            "plastic_modulus = {}          # slope of yield stress over plastic strain; or \
             tangent_modulus\n",
            toml(slope)
        ));
    }
    for (key, rows, what) in [
        (
            "hardening_table",
            &material.hardening_table,
            "plastic strain, yield stress",
        ),
        (
            "tensile_test",
            &material.tensile_test,
            "engineering strain and stress",
        ),
    ] {
        if let Some(rows) = rows {
            let row = |row: &[f64; 2]| format!("    [{}, {}],\n", toml(row[0]), toml(row[1]));
            let rows: String = rows.iter().map(row).collect();
            text.push_str(&format!("{key} = [   # {what}\n{rows}]\n"));
        }
    }
    text + "\n"
}

/// Returns the smallest value of a figure over the bodies that may yield.
pub(super) fn weaker(made: &[Made; 2], figure: impl Fn(f64, f64) -> f64) -> Option<f64> {
    let of = |made: &Made| {
        Some(figure(
            made.material.poissons_ratio,
            made.first_yield_stress()?,
        ))
    };
    made.iter().filter_map(of).reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<[f64; 2]>> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("curve.csv");
        std::fs::write(&path, text).unwrap();
        table(&path)
    }

    #[test]
    fn a_table_has_two_numbers_per_line() {
        let rows = read("strain, stress\n# of bar 7\n0, 400\n 0.01,450.5\n").unwrap();
        assert_eq!(rows, [[0.0, 400.0], [0.01, 450.5]]);
        for (wrong, part) in [
            ("0,400\nstrain,stress\n", "row 2: two numbers"),
            ("0,400,1\n", "row 1: two numbers"),
            ("0;400\n1;500\n", "row 2: two numbers"),
            ("strain,stress\n", "has no rows"),
        ] {
            let error = read(wrong).unwrap_err();
            assert!(error.message().contains(part), "{wrong:?}: {error}");
        }
    }
}

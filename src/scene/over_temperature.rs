//! Materials whose properties depend on the temperature, and their properties at the temperature of
//! a body.
//!
//! Each property is linear between the rows that give it, `p = p_1 + (p_2 - p_1)(T - T_1)/(T_2 -
//! T_1)`, and constant beyond them. A body has one temperature, so its elastic stiffness is
//! constant over the whole run and one factorisation is enough.

use super::{Material, MaterialRow};
use crate::interpolation::interpolate;

impl Material {
    /// The material at one temperature, with constant properties and no rows.
    pub fn at(&self, temperature: f64) -> Material {
        let of = |value: fn(&MaterialRow) -> Option<f64>| {
            let rows = self.over_temperature.iter();
            let rows: Vec<[f64; 2]> = rows
                .filter_map(|row| Some([row.temperature, value(row)?]))
                .collect();
            (!rows.is_empty()).then(|| interpolate(&rows, temperature))
        };
        Material {
            youngs_modulus: of(|row| row.youngs_modulus).unwrap_or(self.youngs_modulus),
            poissons_ratio: of(|row| row.poissons_ratio).unwrap_or(self.poissons_ratio),
            thermal_expansion: of(|row| row.thermal_expansion).or(self.thermal_expansion),
            yield_stress: of(|row| row.yield_stress).or(self.yield_stress),
            plastic_modulus: of(|row| row.plastic_modulus).or(self.plastic_modulus),
            kinematic_modulus: of(|row| row.kinematic_modulus).or(self.kinematic_modulus),
            hardening_table: self
                .table_at(temperature)
                .or_else(|| self.hardening_table.clone()),
            over_temperature: Vec::new(),
            ..self.clone()
        }
    }

    /// The hardening table interpolated between the tables of two rows, at the strains of both
    /// tables; `None` if no row has a table.
    fn table_at(&self, temperature: f64) -> Option<Vec<[f64; 2]>> {
        let rows = self.over_temperature.iter();
        let tables: Vec<(f64, &[[f64; 2]])> = rows
            .filter_map(|row| Some((row.temperature, row.hardening_table.as_deref()?)))
            .collect();
        let next = tables.partition_point(|(t, _)| *t <= temperature);
        let below = next.checked_sub(1).and_then(|k| tables.get(k));
        let (cold, warm) = match (below, tables.get(next)) {
            (None, None) => return None,
            (Some((_, rows)), None) | (None, Some((_, rows))) => return Some(rows.to_vec()),
            (Some(cold), Some(warm)) => (cold, warm),
        };
        let share = (temperature - cold.0) / (warm.0 - cold.0);
        let mut strains: Vec<f64> = cold.1.iter().chain(warm.1).map(|row| row[0]).collect();
        strains.sort_by(f64::total_cmp);
        strains.dedup();
        let stress = |strain: f64| {
            let [cold, warm] = [cold.1, warm.1].map(|rows| interpolate(rows, strain));
            cold + share * (warm - cold)
        };
        let at = strains.into_iter().map(|strain| [strain, stress(strain)]);
        Some(at.collect())
    }

    /// The lowest and the highest temperature of the material's rows; `None` if it has no rows.
    pub(crate) fn temperatures(&self) -> Option<[f64; 2]> {
        let (first, last) = (
            self.over_temperature.first()?,
            self.over_temperature.last()?,
        );
        Some([first.temperature, last.temperature])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(temperature: f64) -> MaterialRow {
        MaterialRow {
            temperature,
            ..MaterialRow::default()
        }
    }

    /// Each property is interpolated between the rows that give it; other properties are those of
    /// the material.
    #[test]
    fn properties_are_interpolated_one_by_one() {
        let material = Material {
            youngs_modulus: 200.0,
            poissons_ratio: 0.3,
            yield_stress: Some(9.0),
            density: Some(7.0),
            over_temperature: vec![
                MaterialRow {
                    youngs_modulus: Some(210.0),
                    yield_stress: Some(4.0),
                    ..row(20.0)
                },
                MaterialRow {
                    yield_stress: Some(3.0),
                    ..row(120.0)
                },
                MaterialRow {
                    youngs_modulus: Some(190.0),
                    ..row(220.0)
                },
            ],
            ..Material::default()
        };
        for (temperature, modulus, stress) in [
            (-50.0, 210.0, 4.0),
            (20.0, 210.0, 4.0),
            (70.0, 205.0, 3.5),
            (120.0, 200.0, 3.0),
            (170.0, 195.0, 3.0),
            (500.0, 190.0, 3.0),
        ] {
            let at = material.at(temperature);
            assert!((at.youngs_modulus - modulus).abs() < 1e-12, "{temperature}");
            assert_eq!(at.yield_stress, Some(stress), "{temperature}");
            assert_eq!((at.poissons_ratio, at.density), (0.3, Some(7.0)));
            assert!(at.over_temperature.is_empty());
        }
    }

    #[test]
    fn tables_are_interpolated_at_the_strains_of_both() {
        let table = |temperature, rows: &[[f64; 2]]| MaterialRow {
            hardening_table: Some(rows.to_vec()),
            ..row(temperature)
        };
        let material = Material {
            over_temperature: vec![
                table(0.0, &[[0.0, 100.0], [0.1, 200.0]]),
                table(100.0, &[[0.0, 60.0], [0.2, 80.0]]),
            ],
            ..Material::default()
        };
        assert_eq!(
            material.at(50.0).hardening_table.unwrap(),
            [[0.0, 80.0], [0.1, 135.0], [0.2, 140.0]]
        );
        assert_eq!(material.at(-1.0).hardening_table.unwrap()[1], [0.1, 200.0]);
        assert_eq!(material.at(100.0).hardening_table.unwrap()[1], [0.2, 80.0]);
    }
}

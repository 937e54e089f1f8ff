//! A tensile test as a hardening curve.

/// A row of a tensile test that the hardening curve uses, with its position in the test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TensileRow {
    /// Number of the row in the test, counted from 0.
    pub row: usize,
    /// Plastic strain and true stress.
    pub point: [f64; 2],
}

/// Plastic strain and true stress of a bar of constant volume for a row of engineering strain `e`
/// and stress `s`: `sigma = s (1 + e)`, `eps_p = ln(1 + e) - sigma/E`.
///
/// # Source
/// W. F. Hosford, *Mechanical Behavior of Materials*, Cambridge 2010, section 3.3.
fn plastic([strain, stress]: [f64; 2], youngs_modulus: f64) -> [f64; 2] {
    let true_stress = stress * (1.0 + strain);
    [strain.ln_1p() - true_stress / youngs_modulus, true_stress]
}

/// The rows that lie beyond yield: rows above the yield stress if one is given, otherwise rows with
/// a positive plastic strain.
pub(crate) fn beyond_yield(
    test: &[[f64; 2]],
    youngs_modulus: f64,
    yield_stress: Option<f64>,
) -> Vec<TensileRow> {
    let rows = test.iter().enumerate().map(|(row, &given)| TensileRow {
        row,
        point: plastic(given, youngs_modulus),
    });
    let is_elastic = |row: &TensileRow| match yield_stress {
        Some(yield_stress) => row.point[1] <= yield_stress,
        None => row.point[0] <= 0.0,
    };
    rows.skip_while(is_elastic).collect()
}

/// The point at which the curve leaves plastic strain 0: at the yield stress if one is given,
/// otherwise between the last row before yield and the first row beyond it. `None` if there is no
/// row before yield.
fn start(
    test: &[[f64; 2]],
    first: &TensileRow,
    youngs_modulus: f64,
    yield_stress: Option<f64>,
) -> Option<[f64; 2]> {
    if let Some(yield_stress) = yield_stress {
        return Some([0.0, yield_stress]);
    }
    let before = first.row.checked_sub(1)?;
    let [strain0, stress0] = plastic(*test.get(before)?, youngs_modulus);
    let [strain1, stress1] = first.point;
    let share = -strain0 / (strain1 - strain0);
    Some([0.0, stress0 + share * (stress1 - stress0)])
}

/// The curve of true stress over plastic strain; `None` if the test does not show where the
/// material yields.
pub(super) fn curve(
    test: &[[f64; 2]],
    youngs_modulus: f64,
    yield_stress: Option<f64>,
) -> Option<Vec<[f64; 2]>> {
    let rows = beyond_yield(test, youngs_modulus, yield_stress);
    let first = start(test, rows.first()?, youngs_modulus, yield_stress)?;
    let beyond = rows.into_iter().map(|row| row.point);
    Some(std::iter::once(first).chain(beyond).collect())
}

#[cfg(test)]
mod tests {
    use super::plastic;
    use crate::scene::Material;

    fn bar(test: &[[f64; 2]], yield_stress: Option<f64>) -> Material {
        Material {
            youngs_modulus: 2e5,
            poissons_ratio: 0.3,
            yield_stress,
            tensile_test: Some(test.to_vec()),
            ..Material::default()
        }
    }

    /// A bar of `sigma_y = 400 + 1000 eps_p` is pulled to true strains of up to 5 %: from the
    /// engineering values that a machine would record, the curve is recovered.
    #[test]
    fn a_test_of_a_known_bar_gives_its_curve() {
        let known = |plastic: f64| 400.0 + 1000.0 * plastic;
        let pulled = |plastic: f64| {
            let stress = known(plastic);
            let strain = (plastic + stress / 2e5).exp_m1();
            [strain, stress / (1.0 + strain)]
        };
        let mut test = vec![
            [0.0, 0.0],
            [0.001f64.exp_m1(), 200.0 / 0.001f64.exp()],
            pulled(0.0),
        ];
        test.extend([0.002, 0.01, 0.05].map(pulled));
        for (curve, yield_stress) in [
            (bar(&test, None).hardening_curve().unwrap(), 400.0),
            (bar(&test, Some(401.0)).hardening_curve().unwrap(), 401.0),
        ] {
            assert!((curve[0][1] - yield_stress).abs() < 1e-9, "{curve:?}");
            assert_eq!((curve[0][0], curve.len()), (0.0, 4), "{curve:?}");
            for (point, plastic) in curve[1..].iter().zip([0.002, 0.01, 0.05]) {
                assert!((point[0] - plastic).abs() < 1e-14, "{curve:?}");
                assert!((point[1] - known(plastic)).abs() < 1e-9, "{curve:?}");
            }
        }
    }

    /// Yield lies between the last elastic row and the first plastic one.
    #[test]
    fn yield_is_found_between_two_rows() {
        let test = [[0.001, 200.0], [0.003, 420.0]];
        let [before, after] = test.map(|row| plastic(row, 2e5));
        let curve = bar(&test, None).hardening_curve().unwrap();
        let share = before[0] / (before[0] - after[0]);
        assert_eq!(curve[0], [0.0, before[1] + share * (after[1] - before[1])]);
        // A test without an elastic row does not show where the material yields.
        assert_eq!(bar(&test[1..], None).hardening_curve(), None);
        assert_eq!(bar(&test[..1], None).hardening_curve(), None);
    }
}

//! What the meshes on the way to a demand say together: values extrapolated to an element size of zero, and how wrong these may be.
//!
//! A ladder of meshes is run for the sake of the error; the law that tells the error of the finest tells its value without it, too. Where that value is
//! known better than the mesh's own, it is the one that is reported:
//!
//! - the value is `q0` of the law `q0 + a h^p` that three meshes follow, of the order seen but at most that of the elements, which higher terms feign on
//!   coarse meshes; what converges with less than [`LEAST_ORDER`] may have no limit at all, as the pressure below a corner;
//! - its stated error is [`SHARE`] of what was extrapolated, and the deviation from the law;
//! - two meshes leave the order open: they lead to a value only where the contact is known to be a round one ([`is_round`]), up to first yield. It is that of the order of
//!   the elements, and as far off as that of first order is.
//!
//! Half widths are read off whole pairs: their errors jump with the place of the edge between two nodes ([`super::edge`]), and three of them that seem to
//! follow a law do so by chance. The same may befall what depends on them; so a value also has to agree with the one that the
//! mesh before led to, within the errors of both.
//!
//! # Source
//! L. F. Richardson, J. A. Gaunt, The deferred approach to the limit, Phil. Trans. R. Soc. A 226 (1927) 299-361, doi:10.1098/rsta.1927.0008; P. J. Roache,
//! *Verification and Validation in Computational Science and Engineering*, Hermosa 1998, chapter 5.

use super::estimate::{Estimate, flows};
use super::extrapolation::extrapolate;
use super::quantities::{Quantity, put, quantities, with_loads};
use crate::results::{Accuracy, OfMesh, QuantityError, Results};
use crate::scene::Scene;
use std::collections::BTreeMap;

/// The stated error of an extrapolated value, over what it was extrapolated by.
pub(super) const SHARE: f64 = 0.6;

/// Least order of a law. The punch's limit load has 0.97.
const LEAST_ORDER: f64 = 0.8;
/// Least order that is sought.
const LOWEST_SOUGHT: f64 = 0.4;

/// The stated error of a value that two meshes lead to, over what lies between the two orders: both do occur.
const SAFETY_OF_TWO: f64 = 1.25;

/// An extrapolated value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limit {
    pub value: f64,
    /// Its stated error, of the mesh.
    pub error: f64,
    /// The order it was extrapolated with.
    order: f64,
}

impl Limit {
    /// What is left of it beside the one that the mesh before led to; `None` where they contradict each other. Where something flows, three meshes may follow a
    /// law by chance: it is believed no further than the two agree, and half as much where there was none before.
    fn beside(self, before: Option<&Limit>, flows: bool) -> Option<Self> {
        let apart = before.map(|other| (self.value - other.value).abs());
        let most = before.map_or(f64::INFINITY, |other| self.error + other.error);
        if apart.is_some_and(|apart| apart > most) {
            return None;
        }
        let error = match apart {
            Some(apart) if flows => self.error.max(apart),
            None if flows => self.error / SHARE,
            _ => self.error,
        };
        Some(Limit { error, ..self })
    }
}

/// The limit of values `(h, q)` of a quantity, finest first, of which the `highest` order is believed; `theory` is the order of the elements. `None` where
/// they follow no law.
pub(super) fn limit(
    path: &str,
    values: &[(f64, f64)],
    highest: f64,
    theory: f64,
    is_round: bool,
) -> Option<Limit> {
    if path.ends_with("half_width") {
        return None;
    }
    let found = match values.len() {
        2 if is_round && path.starts_with("yield.") => of_two(values, theory)?,
        0..3 => return None,
        _ => of_law(values, highest, theory)?,
    };
    // Nothing that is reported changes its sign with the mesh.
    (found.value * values[0].1 > 0.0).then_some(found)
}

fn of_law(values: &[(f64, f64)], highest: f64, theory: f64) -> Option<Limit> {
    let found = extrapolate(values, [LOWEST_SOUGHT, highest])?;
    let order = found.order.filter(|p| found.regular && *p >= LEAST_ORDER)?;
    let order = order.clamp(1.0, theory);
    let law = extrapolate(values, [order, order])?;
    Some(Limit {
        value: law.limit,
        error: SHARE * law.error,
        order,
    })
}

fn of_two(values: &[(f64, f64)], theory: f64) -> Option<Limit> {
    let [first, best] = [1.0, theory].map(|order| extrapolate(values, [order, order]));
    let (first, best) = (first?.limit, best?.limit);
    Some(Limit {
        value: best,
        error: SAFETY_OF_TWO * (best - first).abs(),
        order: theory,
    })
}

/// Whether the mesh is generated round a contact of round bodies, whose load and pressure have limits.
pub(super) fn is_round(scene: &Scene) -> bool {
    scene.mesh.cylinder_on_half_plane.is_some() || scene.mesh.disc_in_plate.is_some()
}

/// Limits that a mesh led to, by quantity.
pub(super) type Limits = BTreeMap<String, Limit>;

impl Estimate {
    /// Puts each extrapolated value whose stated error is less in the place of the mesh's own, unless those of the mesh `before` contradict it. Returns
    /// the errors, the values to be reported, and the limits for the next mesh.
    pub(super) fn extrapolated(
        &self,
        results: &Results,
        before: &Limits,
    ) -> (Accuracy, Vec<(String, f64)>, Limits) {
        let mut out = self.accuracy.clone();
        let mut reported = Vec::new();
        let mut limits = Limits::new();
        let quantities = quantities(results);
        let rows = out.quantities.iter_mut().zip(&self.limits);
        for ((row, limit), quantity) in rows.zip(&quantities) {
            if let Some(limit) = limit.filter(|_| self.others.len() > 1) {
                limits.insert(row.quantity.clone(), limit);
            }
            let (Some(stated), Some(discretisation)) = (row.error, row.discretisation) else {
                continue;
            };
            let path = self.path.of(&row.quantity).unwrap_or_default();
            let state = |row: &mut QuantityError, error: f64| {
                row.error = Some(error);
                row.relative_error = (quantity.scale > 0.0).then(|| error / quantity.scale);
            };
            // The mesh's own value is known no better than its distance from where the meshes lead to.
            let off = limit.map_or(0.0, |limit| (limit.value - row.value).abs());
            let stated = stated.max(off + path.total() + row.algebraic);
            state(row, stated);
            let flows = flows(results, &row.quantity);
            let limit = limit.and_then(|limit| limit.beside(before.get(&row.quantity), flows));
            let limit = limit.as_ref();
            let increments = SHARE * path.increments.abs();
            let mesh = match limit {
                Some(limit) => limit.error,
                None => stated - path.total() - row.algebraic,
            };
            let error = mesh + path.tolerances + increments + row.algebraic;
            if !quantity.governs || error >= stated {
                continue;
            }
            row.of_mesh = Some(OfMesh {
                value: row.value,
                error: stated,
                discretisation,
            });
            row.value = limit.map_or(row.value, |limit| limit.value) + path.increments;
            state(row, error);
            row.discretisation = Some(limit.map_or(discretisation, |limit| limit.error));
            row.path = row.path.map(|_| path.tolerances + increments);
            reported.push((row.quantity.clone(), row.value));
            reported.extend(self.with_load(results, quantity, limit));
        }
        (out, reported, limits)
    }

    /// What goes with a load, by the same law.
    fn with_load(
        &self,
        results: &Results,
        load: &Quantity,
        limit: Option<&Limit>,
    ) -> Vec<(String, f64)> {
        let Some(prefix) = load.path.strip_suffix("load") else {
            return Vec::new();
        };
        let others: Vec<_> = (self.others.iter())
            .map(|(ratio, other)| (*ratio, with_loads(other)))
            .collect();
        let own = with_loads(results).into_iter();
        let own = own.filter(|(path, _)| {
            path.rsplit_once('.')
                .is_some_and(|(p, _)| prefix == format!("{p}."))
        });
        own.filter_map(|(path, value)| {
            let mut values = vec![(1.0, value)];
            for (ratio, other) in &others {
                values.push((*ratio, *other.get(&path)?));
            }
            let value = match limit {
                Some(limit) => extrapolate(&values, [limit.order, limit.order])?.limit,
                None => value,
            };
            let increments = self.path.of(&path).unwrap_or_default().increments;
            Some((path, value + increments))
        })
        .collect()
    }
}

/// Puts the values that are to be reported into the results.
pub(super) fn report(values: &[(String, f64)], results: &mut Results) {
    for (path, value) in values {
        put(results, path, *value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[(f64, f64)], theory: f64) -> Option<Limit> {
        limit("yield.load", values, 3.0, theory, false)
    }

    fn sampled(sizes: &[f64], q: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        sizes.iter().map(|&h| (h, q(h))).collect()
    }

    #[test]
    fn the_limit_of_a_law_is_known_better_than_its_values() {
        for order in [1.0, 1.5, 2.0] {
            let values = sampled(&[1.0, 1.5, 2.25], |h| 7.0 + 0.3 * h.powf(order));
            let limit = of(&values, 2.0).unwrap();
            assert!((limit.value - 7.0).abs() < 0.01, "{limit:?}");
            assert!(
                (limit.error / (SHARE * 0.3) - 1.0).abs() < 0.05,
                "{limit:?}"
            );
        }
    }

    /// Higher terms make coarse meshes converge faster than they will.
    #[test]
    fn no_more_than_the_order_of_the_elements_is_believed() {
        let values = sampled(&[1.0, 1.5, 2.0], |h| {
            7.0 + 0.1 * h.powi(2) + 0.1 * h.powi(4)
        });
        let limit = of(&values, 2.0).unwrap();
        assert_eq!(limit.order, 2.0);
        assert!((limit.value - 7.0).abs() <= limit.error, "{limit:?}");
    }

    #[test]
    fn no_limit_without_a_law() {
        assert_eq!(of(&[(1.0, 5.0), (2.0, 6.0), (2.5, 4.0)], 2.0), None);
        assert_eq!(of(&[(1.0, 5.0), (2.0, 5.0), (2.5, 5.0)], 2.0), None);
        // Through zero.
        assert_eq!(of(&[(1.0, 0.1), (2.0, 0.9), (3.0, 1.7)], 2.0), None);
        // Two meshes.
        assert_eq!(of(&[(1.0, 1.1), (2.0, 1.2)], 2.0), None);
        let values = [(1.0, 1.1), (2.0, 1.2), (3.0, 1.3)];
        assert!(of(&values, 2.0).is_some());
        assert_eq!(limit("yield.half_width", &values, 3.0, 2.0, true), None);
    }

    #[test]
    fn two_meshes_round_a_contact_leave_the_order_open() {
        for order in [1.0, 1.3, 2.0] {
            let values = sampled(&[1.0, 1.25], |h| 7.0 + 0.3 * h.powf(order));
            let found = limit("yield.load", &values, 3.0, 2.0, true).unwrap();
            assert!(
                (found.value - 7.0).abs() <= found.error + 1e-12,
                "{found:?}"
            );
            assert_eq!(limit("states.pressed.load", &values, 3.0, 2.0, true), None);
        }
    }

    /// As the pressure below a corner.
    #[test]
    fn what_grows_with_the_mesh_has_no_limit() {
        for order in [-0.4, -0.2, 0.2, 0.5] {
            let values = sampled(&[1.0, 1.5, 2.25], |h| 1.0 + h.powf(order));
            assert_eq!(of(&values, 2.0), None, "{order}");
        }
        assert_eq!(of(&sampled(&[1.0, 1.5, 2.25], |h| 2.0 - h.ln()), 2.0), None);
    }

    #[test]
    fn limits_that_contradict_each_other_are_none() {
        let limit = |value: f64, error: f64| Limit {
            value,
            error,
            order: 2.0,
        };
        let now = limit(1.0, 0.06);
        assert_eq!(now.beside(None, false), Some(now));
        assert_eq!(now.beside(None, true), Some(limit(1.0, 0.06 / SHARE)));
        assert_eq!(now.beside(Some(&limit(1.02, 0.1)), true), Some(now));
        let apart = now.beside(Some(&limit(1.1, 0.1)), true).unwrap();
        assert!((apart.error - 0.1).abs() < 1e-15);
        assert_eq!(now.beside(Some(&limit(1.1, 0.1)), false), Some(now));
        assert_eq!(now.beside(Some(&limit(1.2, 0.1)), true), None);
    }
}

//! What the meshes on the way to a demand say together: values extrapolated to an element size of zero, and how wrong these may be.
//!
//! A ladder of meshes is run for the sake of the error; the law that tells the error of the finest tells its value without it, too. Where that value is
//! known better than the mesh's own, it is the one that is reported:
//!
//! - the value is `q0` of the law `q0 + a h^p` that three meshes follow, of the order seen but at most that of the elements (of the recovered stress where all is
//!   smooth): higher terms feign more on coarse meshes. What converges with less than [`LEAST_ORDER`] may have no limit at all, as the pressure below a corner;
//! - its stated error is [`SHARE`] of what was extrapolated, and the deviation from the law; once three limits in a row agree, each with the one before,
//!   no more than the steps between them say, but a quarter of what was extrapolated at the least;
//! - two meshes leave the order open: they lead to a value only up to first yield of a contact that is known to be a round one ([`is_round`]). It is that of the
//!   order of the elements, and as far off as that of first order is.
//!
//! Half widths are read off whole pairs: their errors jump with the place of the edge between two nodes ([`super::edge`]), and three of them that seem to
//! follow a law do so by chance. The same may befall what depends on them; so a value also has to agree with the one that the
//! mesh before led to, within the errors of both.
//!
//! # Source
//! L. F. Richardson, J. A. Gaunt, The deferred approach to the limit, Phil. Trans. R. Soc. A 226 (1927) 299-361, doi:10.1098/rsta.1927.0008; P. J. Roache,
//! *Verification and Validation in Computational Science and Engineering*, Hermosa 1998, chapter 5.

use super::consistent::Reported;
use super::estimate::{Estimate, flows};
use super::extrapolation::extrapolate;
use super::quantities::{put, quantities};
use crate::results::{Accuracy, OfMesh, QuantityError, Results};
use crate::scene::Scene;
use std::collections::BTreeMap;

/// The stated error of an extrapolated value, over what it was extrapolated by.
pub(super) const SHARE: f64 = 0.6;

/// What is stated more where three meshes may follow a law by chance: without it 32 of 220 extrapolated values of states that flow, over the scenes of
/// `data/scenes` at 10, 3 and 1 %, were off by more than was stated.
const SAFETY_OF_CHANCE: f64 = 1.2;

/// Once three limits in a row agree, each with the one before, what is left of them is taken for that of first order, but for so many times the step from limit to
/// limit at the least: three in a row seldom agree by chance. Of 60 values of the scenes of `data/scenes`, run far beyond their demands, it told the error of 11,
/// and one of these was off by more than was stated, by a fifth.
const SAFETY_OF_STEPS: f64 = 1.5;

/// But so much of what was extrapolated, at the least: what is left of a law of order 0.9 that is taken for one of first order, 0.155 to 0.185 with a mesh two to three
/// times as coarse, and a third more.
const LEAST_SHARE: f64 = 0.25;
/// Laws of a lower order leave more, the same on every mesh, so that no step shows it.
const LEAST_STEADY: f64 = 0.9;

/// Least order of a law. The punch's limit load has 0.97.
const LEAST_ORDER: f64 = 0.8;
/// Least order that is sought.
const LOWEST_SOUGHT: f64 = 0.4;

/// Orders nearer than this are the same: they are sought in steps.
const ORDERS_APART: f64 = 0.1;

/// The stated error of a value that two meshes lead to, over what lies between the two orders: both do occur.
const SAFETY_OF_TWO: f64 = 1.25;

/// An extrapolated value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limit {
    pub value: f64,
    /// Its stated error, of the mesh.
    pub error: f64,
    /// The order it was extrapolated with.
    pub order: f64,
    /// Whether that is beyond the order of the elements.
    is_beyond: bool,
    /// Whether the order that was seen is too low for limits in a row to tell anything.
    is_slow: bool,
    /// What the step from the limit that the mesh before led to says of its error, where the two agree.
    left: Option<f64>,
}

impl Limit {
    /// How far it is from the one that the mesh before led to; `None` where they contradict each other.
    fn step(&self, before: &Limit) -> Option<f64> {
        let step = (self.value - before.value).abs();
        (step <= self.error + before.error).then_some(step)
    }

    /// With what the step from the limit before, that of a mesh with elements `finer` times as large, says.
    fn after(self, before: Option<&Limit>, finer: f64) -> Self {
        let of_first_order = 1.0 / (finer - 1.0).max(f64::MIN_POSITIVE);
        let step = before.and_then(|other| self.step(other));
        let left = step.map(|step| step * SAFETY_OF_STEPS.max(of_first_order));
        Limit { left, ..self }
    }

    /// What is believed of it beside the one that the mesh before led to; `None` where they contradict each other. Where something flows, or converges faster
    /// than the elements do, three meshes may follow a law by chance: it is believed no further than the two agree, and where there was none before all of what was extrapolated
    /// counts.
    /// (First yield of the tube of `nu = 0.4999`, whose coarse meshes show an order of 4.5: 2.1 % off where 0.65 % were stated.)
    /// From the third in a row on the steps between them tell more.
    fn beside(self, before: Option<&Limit>, flows: bool) -> Option<Self> {
        let step = match before {
            Some(other) => Some(self.step(other)?),
            None => None,
        };
        let by_chance = flows || self.is_beyond;
        let error = match step {
            Some(step) if by_chance => (SAFETY_OF_CHANCE * self.error).max(step),
            None if by_chance => self.error / SHARE,
            _ => self.error,
        };
        let steps = self.left.zip(before.and_then(|other| other.left));
        let error = match steps {
            Some((last, other)) if !self.is_slow => {
                let least = LEAST_SHARE / SHARE * self.error;
                error.min(last.max(other).max(least))
            }
            _ => error,
        };
        Some(Limit { error, ..self })
    }
}

/// Whether a quantity is extrapolated at all.
pub(super) fn has_limit(path: &str) -> bool {
    !path.ends_with("half_width")
}

/// The limit of values `(h, q)` of a quantity, finest first; `orders` are that of the elements, the highest that is believed of a limit, the same but for what
/// is smooth, and the highest that is sought. `None` where they follow no law.
pub(super) fn limit(
    path: &str,
    values: &[(f64, f64)],
    orders: [f64; 3],
    is_round: bool,
) -> Option<Limit> {
    if !has_limit(path) {
        return None;
    }
    let found = match values.len() {
        2 if is_round && path.starts_with("yield.") => of_two(values, orders[0])?,
        0..3 => return None,
        _ => of_law(values, orders)?,
    };
    // Nothing that is reported changes its sign with the mesh.
    (found.value * values[0].1 > 0.0).then_some(found)
}

fn of_law(values: &[(f64, f64)], orders: [f64; 3]) -> Option<Limit> {
    let [of_elements, most, highest] = orders;
    let found = extrapolate(values, [LOWEST_SOUGHT, highest])?;
    let seen = found.order.filter(|p| found.regular && *p >= LEAST_ORDER)?;
    let order = seen.clamp(1.0, most);
    let law = extrapolate(values, [order, order])?;
    Some(Limit {
        value: law.limit,
        error: SHARE * law.error,
        order,
        is_beyond: order > of_elements + ORDERS_APART,
        is_slow: seen < LEAST_STEADY,
        left: None,
    })
}

fn of_two(values: &[(f64, f64)], of_elements: f64) -> Option<Limit> {
    let [first, best] = [1.0, of_elements].map(|order| extrapolate(values, [order, order]));
    let (first, best) = (first?.limit, best?.limit);
    Some(Limit {
        value: best,
        error: SAFETY_OF_TWO * (best - first).abs(),
        order: of_elements,
        is_beyond: false,
        is_slow: false,
        left: None,
    })
}

/// Whether the mesh is generated round a contact of round bodies, whose load and pressure have limits.
pub(super) fn is_round(scene: &Scene) -> bool {
    scene.mesh.cylinder_on_half_plane.is_some() || scene.mesh.disc_in_plate.is_some()
}

/// Limits that a mesh led to, by quantity.
#[derive(Default)]
pub(super) struct Limits {
    elements: usize,
    of: BTreeMap<String, Limit>,
}

impl Estimate {
    /// Puts each extrapolated value whose stated error is less in the place of the mesh's own, unless those of the mesh `before` contradict it. Returns
    /// the errors, the values to be reported, and the limits for the next mesh.
    pub(super) fn extrapolated(
        &self,
        results: &Results,
        before: &Limits,
    ) -> (Accuracy, Reported, Limits) {
        let mut out = self.accuracy.clone();
        let mut reported = Reported::new();
        let mut limits = Limits {
            elements: results.sizes.elements,
            of: BTreeMap::new(),
        };
        let finer = (results.sizes.elements as f64 / before.elements as f64).sqrt();
        let quantities = quantities(results);
        let rows = out.quantities.iter_mut().zip(&self.limits);
        for ((row, limit), quantity) in rows.zip(&quantities) {
            let other = before.of.get(&row.quantity);
            let limit = limit.map(|limit| limit.after(other, finer));
            if let Some(limit) = limit.filter(|_| self.others.len() > 1) {
                limits.of.insert(row.quantity.clone(), limit);
            }
            let known = row.error.filter(|error| !error.is_nan());
            let (Some(stated), Some(discretisation)) = (known, row.discretisation) else {
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
            let limit = limit.and_then(|limit| limit.beside(other, flows));
            let limit = limit.as_ref();
            let increments = SHARE * path.increments.abs();
            let mesh = match limit {
                Some(limit) => limit.error,
                None => stated - path.total() - row.algebraic,
            };
            let error = mesh + path.tolerances + increments + row.algebraic;
            let value = limit.map_or(row.value, |limit| limit.value) + path.increments;
            // What round-off moves is not known better, and prescribed. Never through zero: what the increments add was seen on a coarser mesh.
            let moved = (value - row.value).abs() > row.algebraic && value * row.value > 0.0;
            if !quantity.governs || !moved || error >= stated {
                continue;
            }
            row.of_mesh = Some(OfMesh {
                value: row.value,
                error: stated,
                discretisation,
            });
            row.value = value;
            state(row, error);
            row.discretisation = Some(limit.map_or(discretisation, |limit| limit.error));
            row.path = row.path.map(|_| path.tolerances + increments);
            reported.insert(row.quantity.clone(), value);
            self.add_what_goes_with(results, &row.quantity, limit, &mut reported);
        }
        self.reconcile(results, &quantities, &mut out.quantities, &mut reported);
        (out, reported, limits)
    }
}

/// Puts the values that are to be reported into the results.
pub(super) fn report(values: &Reported, results: &mut Results) {
    for (path, value) in values {
        put(results, path, *value);
    }
}

#[cfg(test)]
mod tests {
    use super::super::path::{PathError, PathErrors};
    use super::super::quantities::pressed;
    use super::*;

    fn of(values: &[(f64, f64)], theory: f64) -> Option<Limit> {
        limit("yield.load", values, [theory, theory, 3.0], false)
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
    fn two_meshes_round_a_contact_leave_the_order_open() {
        for order in [1.0, 1.3, 2.0] {
            let values = sampled(&[1.0, 1.25], |h| 7.0 + 0.3 * h.powf(order));
            let found = limit("yield.load", &values, [2.0, 2.0, 3.0], true).unwrap();
            assert!(
                (found.value - 7.0).abs() <= found.error + 1e-12,
                "{found:?}"
            );
            assert_eq!(
                limit("states.pressed.load", &values, [2.0, 2.0, 3.0], true),
                None
            );
        }
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
        assert_eq!(
            limit("yield.half_width", &values, [2.0, 2.0, 3.0], true),
            None
        );
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
            is_beyond: false,
            is_slow: false,
            left: None,
        };
        let now = limit(1.0, 0.06);
        assert_eq!(now.beside(None, false), Some(now));
        assert_eq!(now.beside(None, true), Some(limit(1.0, 0.06 / SHARE)));
        let error = |other: f64, flows: bool| {
            now.beside(Some(&limit(other, 0.1)), flows)
                .map(|found| found.error)
        };
        assert_eq!(error(1.02, true), Some(SAFETY_OF_CHANCE * 0.06));
        assert!((error(1.1, true).unwrap() - 0.1).abs() < 1e-15);
        assert_eq!(error(1.1, false), Some(0.06));
        assert_eq!([true, false].map(|flows| error(1.2, flows)), [None; 2]);
    }

    /// From the third limit in a row that agrees with the one before the steps tell the error, which is never said to be larger for it.
    #[test]
    fn steps_from_limit_to_limit_tell_the_error() {
        let limit = |value: f64| Limit {
            value,
            error: 0.06,
            order: 1.0,
            is_beyond: false,
            is_slow: false,
            left: None,
        };
        let believed = |values: [f64; 3], finer: f64, is_slow: bool| {
            let [first, second, third] = values.map(limit);
            let second = second.after(Some(&first), finer);
            let third = Limit { is_slow, ..third }.after(Some(&second), finer);
            third.beside(Some(&second), true).map(|found| found.error)
        };
        let error = |values: [f64; 3]| believed(values, 2.0, false);
        let is = |found: Option<f64>, wanted: f64| (found.unwrap() - wanted).abs() < 1e-12;
        assert!(is(error([1.03, 1.01, 1.0]), SAFETY_OF_STEPS * 0.02));
        assert!(is(error([1.02, 1.03, 1.0]), SAFETY_OF_STEPS * 0.03));
        assert!(is(error([1.0, 1.0, 1.0]), LEAST_SHARE / SHARE * 0.06));
        let alone = SAFETY_OF_CHANCE * 0.06;
        assert!(is(error([1.06, 1.0, 1.0]), alone));
        assert!(is(error([1.3, 1.0, 1.0]), alone));
        assert_eq!(error([1.0, 1.0, 1.3]), None);
        // Near meshes, and slow convergence.
        assert!(is(believed([1.016, 1.008, 1.0], 1.25, false), 4.0 * 0.008));
        assert!(is(believed([1.03, 1.01, 1.0], 2.0, true), alone));
    }

    /// Whatever the order, from one that is hardly accepted on, the limit is as near as is said on meshes ever finer.
    #[test]
    fn limits_in_a_row_are_as_near_as_is_said() {
        for order in [0.8f64, 0.85, 0.9, 0.95, 1.0, 1.3, 1.7, 2.0] {
            for finer in [1.25f64, 1.5, 1.75, 2.0] {
                let mut before: Option<Limit> = None;
                for k in 0..6 {
                    let h = finer.powi(-k);
                    let values = sampled(&[h, 1.5 * h, 2.25 * h], |h| {
                        7.0 + 0.3 * h.powf(order) + 0.1 * h.powf(2.0 * order)
                    });
                    let found = of(&values, 2.0).map(|found| found.after(before.as_ref(), finer));
                    if let Some(found) = found {
                        let believed = found.beside(before.as_ref(), true);
                        let off = (found.value - 7.0).abs();
                        let said = believed.map_or(f64::INFINITY, |believed| believed.error);
                        assert!(off <= said, "{order} {finer} {k}: {off} {said}");
                    }
                    before = found;
                }
            }
        }
    }

    /// What three meshes say is believed to the half where a law had led there before; and everywhere else where nothing flows, of the elements' order.
    #[test]
    fn an_order_beyond_that_of_the_elements_has_to_be_seen_twice() {
        let at = |order: f64, most: f64| {
            let values = sampled(&[1.0, 1.5, 2.0], |h| 7.0 + 0.3 * h.powf(order));
            limit("yield.load", &values, [2.0, most, 5.0], false).unwrap()
        };
        let error = |found: Limit, before: Option<&Limit>, flows: bool| {
            found.beside(before, flows).unwrap().error / (SHARE * 0.3)
        };
        let is = |found: f64, wanted: f64| (found / wanted - 1.0).abs() < 0.05;
        let (second, fourth) = (at(2.0, 5.0), at(4.0, 5.0));
        assert!(is(error(second, None, false), 1.0));
        assert!(is(error(second, None, true), 1.0 / SHARE));
        assert!(is(error(fourth, None, false), 1.0 / SHARE));
        assert!(is(error(fourth, Some(&second), false), SAFETY_OF_CHANCE));
        // One that it contradicts.
        let other = Limit {
            value: 8.0,
            ..second
        };
        assert_eq!(fourth.beside(Some(&other), false), None);
    }

    /// A run with one state and its estimate, corrected for increments that add so much to load and approach.
    fn corrected(load: f64, approach: f64, increments: [f64; 2]) -> (Accuracy, Reported) {
        let results = pressed(load, approach);
        let mut accuracy = Accuracy::default();
        let mut errors = BTreeMap::new();
        for (quantity, increments) in quantities(&results).iter().zip(increments) {
            accuracy.quantities.push(QuantityError {
                quantity: quantity.path.clone(),
                value: quantity.value,
                error: Some(0.1 + increments.abs() + 1e-12),
                relative_error: None,
                discretisation: Some(0.05),
                path: Some(increments.abs()),
                algebraic: 1e-12,
                order: None,
                of_mesh: None,
            });
            let error = PathError {
                tolerances: 0.0,
                increments,
            };
            errors.insert(quantity.path.clone(), error);
        }
        let estimate = Estimate {
            accuracy,
            limits: vec![None; 2],
            others: Vec::new(),
            path: PathErrors::Estimated(errors, 0.0),
        };
        let (accuracy, reported, _) = estimate.extrapolated(&results, &Limits::default());
        (accuracy, reported)
    }

    #[test]
    fn increments_correct_what_they_change() {
        let (found, reported) = corrected(100.0, 2.0, [0.0, 0.5]);
        assert_eq!(found.quantities[0].of_mesh, None);
        let row = &found.quantities[1];
        assert_eq!((row.value, reported["states.pressed.approach"]), (2.5, 2.5));
        let own = row.of_mesh.unwrap();
        assert_eq!((own.value, own.error), (2.0, 0.6 + 1e-12));
        assert!((row.error.unwrap() - (0.1 + SHARE * 0.5)).abs() < 1e-9);
    }

    /// A prescribed load stays what is prescribed, and what is zero, or would change its sign, what the mesh gave.
    #[test]
    fn nothing_is_corrected_by_round_off_or_through_zero() {
        let (found, reported) = corrected(100.0, 0.0, [1e-13, 0.01]);
        assert!(reported.is_empty(), "{reported:?}");
        assert!(found.quantities.iter().all(|q| q.of_mesh.is_none()));
        let (_, reported) = corrected(100.0, -0.01, [0.0, 0.02]);
        assert!(reported.is_empty(), "{reported:?}");
    }
}

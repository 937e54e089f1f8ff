//! Contact figures of a state for the user: pressure, half width, arc and area of the contact,
//! total load.

use super::contact_area::{ReadPatch, patches};
use super::contact_patch::{ClosedRun, line_of};
use crate::analysis::structure::solver::Solver;
use crate::model::{AxisPoint, ContactSurface, Magnitude, Model, Pair};
use crate::results::{ContactPatch, EdgeReading, PairState, Status};

/// Pairs with forces below this fraction of the largest are about to open or have just closed: at a
/// change of contact the force is zero up to round-off or gamma, and the extent of the contact must
/// not depend on that remainder.
const VANISHING: f64 = 1e-7;
/// A force below this fraction of the run's largest is round-off in an unloaded contact.
const ROUND_OFF: f64 = 1e-13;
/// Patches whose forces differ by no more than this share belong to bodies in a row, which pass on
/// the same force; the figures are then those of the first such contact, whatever the mesh. Exact
/// equality is not required, since pressures on a curved patch add up to more than their resultant:
/// by a hundredth over 14 degrees to both sides (`t/sin t`).
const EQUAL: f64 = 0.01;

/// Contact pressures and extents at the current state.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ContactFigures {
    /// Largest pressure of a pair.
    pub max_pressure: f64,
    /// Half width of the contact patch with the largest force.
    pub half_width: f64,
    /// Area of this patch including its mirror images; in plane strain and plane stress its width.
    pub area: f64,
    /// Accuracy of the half width.
    pub half_width_reading: EdgeReading,
    /// Sum of the contact forces of the model.
    pub force: f64,
    /// Pressure at the middle of this patch (on its symmetry plane, if it has one).
    pub pole_pressure: f64,
    /// Start and end of this patch along the surface.
    pub patch: Option<[f64; 2]>,
    /// Contact that this patch belongs to.
    pub contact: usize,
    /// All patches of a solid model, the strongest first.
    pub patches: Vec<ContactPatch>,
}

impl ContactFigures {
    /// Contact figures of the current state.
    pub(in crate::analysis) fn of(solver: &Solver) -> Self {
        contact_figures(
            solver.structure.model,
            &solver.contact_forces(),
            solver.scales.force,
        )
    }

    /// Contact figures of one contact at the current state.
    pub(in crate::analysis) fn of_contact(solver: &Solver, contact: usize) -> Self {
        let model = solver.structure.model;
        let mut force = solver.contact_forces().into_owned();
        for (pair, force) in model.pairs.iter().zip(&mut force) {
            if pair.contact != contact {
                *force = 0.0;
            }
        }
        contact_figures(model, &force, solver.scales.force)
    }
}

/// Pressure of each pair: its force divided by the integral of its node's shape function, which
/// reproduces a uniform pressure exactly. Beside the axis of revolution, pressures and
/// displacements of linear elements are only of first order, whatever the weights: all errors have
/// one sign.
pub fn pressures(model: &Model, force: &[f64]) -> Vec<f64> {
    let pairs = model.pairs.iter();
    pairs.zip(force).map(|(pair, r)| r / pair.area).collect()
}

/// Extrapolates a quantity of the pairs, as an even function, to the axis of revolution; `None`
/// unless the contact reaches the axis without a pair on it.
pub(super) fn on_axis(model: &Model, contact: &ContactSurface, values: &[f64]) -> Option<f64> {
    let axis = contact.axis.as_ref()?;
    let range = contact.range.clone();
    let (near, next) = if axis.begins {
        (range.start, range.start + 1)
    } else {
        (range.end.checked_sub(1)?, range.end.checked_sub(2)?)
    };
    if !range.contains(&next) {
        return range.contains(&near).then(|| values[near]);
    }
    let squared = |k: usize| (model.pairs[k].arc - axis.pair.arc).powi(2);
    let (a, b) = (squared(near), squared(next));
    Some((b * values[near] - a * values[next]) / (b - a))
}

/// The overlap of a pair that carries a force in soft contact.
fn overlap(model: &Model, pair: usize, force: f64) -> f64 {
    let of = &model.pairs[pair];
    let stiffness = model.contacts[of.contact].stiffness;
    stiffness.map_or(0.0, |stiffness| force / (stiffness * of.area))
}

/// States of all pairs, and of the points on the axis that are no pairs. These points have no area
/// and no force, and are numbered after the pairs. Nothing holds their nodes apart: `apart` returns
/// their distance, negative if they overlap.
pub fn pair_states(
    model: &Model,
    gap: &[f64],
    force: &[f64],
    open: &[bool],
    apart: impl Fn(&AxisPoint) -> f64,
) -> Vec<PairState> {
    let pressure = pressures(model, force);
    let status = |open: bool| if open { Status::Open } else { Status::Closed };
    let mut out = Vec::with_capacity(gap.len());
    let mut number = gap.len();
    for (index, contact) in model.contacts.iter().enumerate() {
        out.extend(contact.range.clone().map(|k| PairState {
            pair: k,
            contact: model.pairs[k].contact,
            position: model.mesh.point(model.pairs[k].slave),
            gap: gap[k] - overlap(model, k, force[k]),
            force: force[k],
            area: model.pairs[k].area,
            pressure: pressure[k],
            status: status(open[k] || force[k] <= 0.0),
        }));
        let (Some(axis), Some(p)) = (&contact.axis, on_axis(model, contact, &pressure)) else {
            continue;
        };
        let place = if axis.begins {
            out.len() - contact.range.len()
        } else {
            out.len()
        };
        out.insert(
            place,
            PairState {
                pair: number,
                contact: index,
                position: model.mesh.point(axis.pair.slave),
                gap: apart(axis),
                force: 0.0,
                area: 0.0,
                pressure: p.max(0.0),
                status: status(p <= 0.0),
            },
        );
        number += 1;
    }
    out
}

/// Figures of the contact patch with the largest force; `scale` is the largest force of the run.
pub fn contact_figures(model: &Model, force: &[f64], scale: f64) -> ContactFigures {
    let pressure = pressures(model, force);
    let axis_pressures = model
        .contacts
        .iter()
        .filter_map(|c| on_axis(model, c, &pressure));
    let mut out = ContactFigures {
        max_pressure: pressure
            .iter()
            .copied()
            .chain(axis_pressures)
            .fold(0.0, f64::max),
        force: sum(force),
        ..ContactFigures::default()
    };
    let strongest = force.iter().fold(0.0f64, |m, r| m.max(*r));
    let vanishing = (VANISHING * strongest).max(ROUND_OFF * scale);
    if model.kind.is_solid() {
        return with_patches(out, patches(model, force, &pressure, vanishing));
    }
    let mut largest = 0.0;
    // A NaN does not count as a force that presses.
    let presses = |k: usize| force[k] > vanishing;
    for (index, contact) in model.contacts.iter().enumerate() {
        let line = line_of(model, contact, presses);
        let mut k = 0;
        while k < line.len() {
            if !presses(line[k].pair) {
                k += 1;
                continue;
            }
            let begin = k;
            while k < line.len() && presses(line[k].pair) {
                k += 1;
            }
            let sum: f64 = line[begin..k].iter().map(|place| force[place.pair]).sum();
            if sum > largest * (1.0 + EQUAL) {
                largest = sum;
                let patch = ClosedRun {
                    model,
                    pressure: &pressure,
                    contact,
                    line: &line,
                    begin,
                    end: k,
                };
                out.contact = index;
                read_patch(&patch, &mut out);
            }
        }
    }
    out
}

/// Reads the figures of a patch in the plane.
fn read_patch(patch: &ClosedRun, out: &mut ContactFigures) {
    let (begin, last) = (patch.begin, patch.end - 1);
    if let Some(turn) = patch.contact.turn.filter(|_| patch.is_whole()) {
        // A patch all around a closed surface has no ends.
        let from = patch.line[begin].arc;
        out.patch = Some([from, from + turn]);
        out.half_width = 0.5 * turn;
        out.area = patch.area_between([from, from + turn]);
        out.half_width_reading = EdgeReading {
            error: 0.0,
            pairs: patch.line.len() / 2,
        };
        out.pole_pressure = patch.pressure_at(from + 0.5 * turn);
        return;
    }
    let (at_begin, at_end) = (patch.is_symmetric(begin), patch.is_symmetric(last));
    let middle = match (at_begin, at_end) {
        (true, _) => patch.end_arc(begin),
        (_, true) => patch.end_arc(last),
        _ => 0.5 * (patch.end_arc(begin) + patch.end_arc(last)),
    };
    let ends = [patch.edge(begin, -1, middle), patch.edge(last, 1, middle)];
    let [from, to] = ends.map(|end| end.arc);
    out.patch = Some([from, to]);
    let half_widths = patch.half_widths();
    out.half_width = half_widths * (to - from);
    out.area = patch.area_between([from, to]);
    out.half_width_reading = EdgeReading {
        error: half_widths * (ends[0].reading + ends[1].reading),
        pairs: (half_widths * (patch.end - begin) as f64) as usize,
    };
    let beside_axis = [begin, last]
        .into_iter()
        .any(|k| patch.axis_beside(k).is_some());
    out.pole_pressure = match (at_begin, at_end) {
        _ if beside_axis => {
            let on_axis = on_axis(patch.model, patch.contact, patch.pressure);
            on_axis.unwrap_or(0.0).max(0.0)
        }
        (true, _) => patch.pressure_of(begin),
        (_, true) => patch.pressure_of(last),
        _ => patch.pressure_at(0.5 * (from + to)),
    };
}

/// Figures of solids: the half width is the smaller half axis of the strongest patch.
fn with_patches(mut out: ContactFigures, read: Vec<ReadPatch>) -> ContactFigures {
    let least = read.first().map_or(0.0, |read| read.patch.force) / (1.0 + EQUAL);
    let strong = read.iter().filter(|read| read.patch.force >= least);
    if let Some(strongest) = strong.min_by_key(|read| read.patch.contact) {
        out.half_width = strongest.patch.semi_axes[1];
        out.area = strongest.patch.area;
        out.half_width_reading = EdgeReading {
            error: strongest.reading,
            pairs: strongest.pairs,
        };
        out.pole_pressure = strongest.pole_pressure;
        out.contact = strongest.patch.contact;
    }
    out.patches = read.into_iter().map(|read| read.patch).collect();
    out
}

/// Sum of forces; 0 for an empty list, for which `Iterator::sum` returns -0.
fn sum(forces: &[f64]) -> f64 {
    forces.iter().fold(0.0, |sum, force| sum + force)
}

/// The total load of the current state. It is the size of the leading load times its factor,
/// without sign (a force is given for the whole model with its mirror images). If the leading load
/// prescribes displacements, the total load is the force that moves the nodes of the leading load.
/// If the leading load changes gaps, the total load is the force of the contacts with these gaps.
/// Without a leading load, it is the force of all contacts with interference, or of all contacts if
/// there is no interference.
pub(in crate::analysis) fn total_load_size(solver: &Solver) -> f64 {
    let model = solver.structure.model;
    let through = |acts: &dyn Fn(&Pair) -> bool| {
        let forces = solver.contact_forces();
        let acting = model.pairs.iter().zip(forces.iter());
        let sum = acting.fold(0.0, |sum, (pair, r)| if acts(pair) { sum + r } else { sum });
        sum * model.symmetry
    };
    let Some(leading) = model.leading_load() else {
        let interferes = model.pairs.iter().any(|pair| pair.interference != 0.0);
        return through(&|pair| !interferes || pair.interference != 0.0);
    };
    let load = &model.loads[leading];
    match load.measures {
        Magnitude::Displacement => solver.driving_force().unwrap_or(0.0),
        Magnitude::Gap => through(&|pair| load.gap(pair) != 0.0),
        Magnitude::Force
        | Magnitude::Stress
        | Magnitude::Temperature
        | Magnitude::Strain
        | Magnitude::Carried => solver.at.factors[leading].abs() * load.magnitude,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn model(name: &str, overrides: &[&str]) -> Model {
        let path = format!("{}/data/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
        Model::new(&Scene::load_with(path, &overrides).unwrap()).unwrap()
    }

    /// An even quadratic function of the distance from the axis is extrapolated to the axis
    /// exactly.
    #[test]
    fn the_pressure_on_the_axis_is_the_even_continuation() {
        let model = model(
            "ball_on_half_space",
            &["mesh.cylinder_on_half_plane.element=quad8"],
        );
        let contact = &model.contacts[0];
        let axis = contact
            .axis
            .as_ref()
            .expect("quadratic elements have no pair there");
        let pressure = |k: usize| 7.0 - 3.0 * (model.pairs[k].arc - axis.pair.arc).powi(2);
        let values: Vec<f64> = (0..model.pairs.len()).map(pressure).collect();
        let found = on_axis(&model, contact, &values).unwrap();
        assert!((found - 7.0).abs() <= 1e-13 * 7.0, "{found}");
        let force: Vec<f64> = (model.pairs.iter().zip(&values))
            .map(|(pair, p)| pair.area * p.max(0.0))
            .collect();
        let figures = contact_figures(&model, &force, 1.0);
        assert!((figures.pole_pressure - 7.0).abs() <= 1e-13 * 7.0);
        assert!((figures.max_pressure - 7.0).abs() <= 1e-13 * 7.0);
    }

    /// If the contact has left the axis, the extrapolated pressure is negative: the point on the
    /// axis is open and carries nothing.
    #[test]
    fn a_point_on_the_axis_carries_no_tension() {
        let model = model(
            "ball_on_half_space",
            &["mesh.cylinder_on_half_plane.element=quad8"],
        );
        let begins = model.contacts[0].axis.as_ref().unwrap().begins;
        let n = model.pairs.len();
        // Only the second pair from the axis is closed.
        let (closed, place) = if begins { (1, 0) } else { (n - 2, n) };
        let mut force = vec![0.0; n];
        force[closed] = 1.0;
        let open: Vec<bool> = force.iter().map(|f| *f == 0.0).collect();
        let pressure = pressures(&model, &force);
        assert!(on_axis(&model, &model.contacts[0], &pressure).unwrap() < 0.0);
        let states = pair_states(&model, &vec![0.5; n], &force, &open, |_| 0.5);
        let axis = &states[place];
        assert_eq!((states.len(), axis.pair), (n + 1, n));
        assert_eq!((axis.pressure, axis.status), (0.0, Status::Open));
        assert!((axis.gap - 0.5).abs() <= 1e-14);
    }

    /// For a pressure that is linear along a patch away from all planes of symmetry, the pole
    /// pressure is its value at the middle of the patch.
    #[test]
    fn the_pole_of_a_patch_off_symmetry_is_its_middle() {
        let model = model("contact_patch", &[]);
        let line = |arc: f64| 5.0 + 3.0 * arc;
        let closed = |k: &usize| (2..7).contains(k);
        let force: Vec<f64> = (0..model.pairs.len())
            .map(|k| {
                model.pairs[k].area * line(model.pairs[k].arc) * f64::from(u8::from(closed(&k)))
            })
            .collect();
        let figures = contact_figures(&model, &force, 1.0);
        let [from, to] = figures.patch.unwrap();
        let middle = 0.5 * (from + to);
        let between = (2..6).any(|k| {
            let [a, b] = [k, k + 1].map(|k| model.pairs[k].arc);
            (middle - a).abs().min((b - middle).abs()) > 0.01 * (b - a) && (a..b).contains(&middle)
        });
        assert!(between, "{middle} lies at a pair, which tests less");
        let found = figures.pole_pressure;
        assert!(
            (found - line(middle)).abs() <= 1e-12 * line(middle),
            "{found}"
        );
    }
}

//! The elements of the zone, packed for speed: strain operators without their zeros, and where
//! freedoms find displacements.
//!
//! An operator ([`Form`]) is a sixth of the numbers of the full B, which is what counts where
//! thousands of evaluations run through memory.

use crate::element::{AtPoints, Form, MAX_FREEDOMS, Points};
use crate::model::{Model, Slot};
use crate::substructure::Trailing;

/// Position of every freedom of the model in a [`Nodal`] vector.
pub struct Places {
    of_freedom: Vec<u32>,
    n_zone: usize,
    n_contact: usize,
}

impl Places {
    /// Positions for the given zone and contact freedoms.
    pub fn new(n: usize, zone: &[usize], contact: &[usize]) -> Self {
        let mut of_freedom = vec![u32::MAX; n];
        for (i, &f) in zone.iter().chain(contact).enumerate() {
            of_freedom[f] = i as u32;
        }
        Places {
            of_freedom,
            n_zone: zone.len(),
            n_contact: contact.len(),
        }
    }

    /// Number of zone and of contact freedoms.
    pub fn sizes(&self) -> (usize, usize) {
        (self.n_zone, self.n_contact)
    }
}

/// `[ zone | contact | prescribed | 0 ]`: every element freedom has a place, so that nothing is decided in a loop.
pub struct Nodal {
    values: Vec<f64>,
    n_zone: usize,
    n_contact: usize,
    /// Load and value at factor 1 of each prescribed displacement.
    prescribed: Vec<(usize, f64)>,
    factors: Vec<f64>,
}

impl Nodal {
    /// Zeros, with the prescribed displacements of a model at factors zero.
    pub fn new(model: &Model, places: &Places) -> Self {
        let prescribed: Vec<(usize, f64)> = model
            .freedoms
            .prescribed
            .iter()
            .map(|p| (p.load, p.value))
            .collect();
        Nodal {
            values: vec![0.0; places.n_zone + places.n_contact + prescribed.len() + 1],
            n_zone: places.n_zone,
            n_contact: places.n_contact,
            prescribed,
            factors: vec![0.0; model.loads.len()],
        }
    }

    /// Factors of the loads that scale the prescribed displacements from now on.
    pub fn set_factors(&mut self, factors: &[f64]) {
        self.factors.copy_from_slice(factors);
    }

    fn set(&mut self, u: &Trailing) {
        self.values[..self.n_zone].copy_from_slice(&u.zone);
        self.values[self.n_zone..self.n_zone + self.n_contact].copy_from_slice(&u.contact);
    }

    /// Takes over displacements, the prescribed ones at the current factors.
    pub fn displacements(&mut self, u: &Trailing) -> &[f64] {
        self.set(u);
        let rest = &mut self.values[self.n_zone + self.n_contact..];
        for (value, (load, at_one)) in rest.iter_mut().zip(&self.prescribed) {
            *value = self.factors[*load] * at_one;
        }
        &self.values
    }

    /// Takes over a variation: zero where displacements are prescribed.
    pub fn variation(&mut self, u: &Trailing) -> &[f64] {
        self.set(u);
        self.values[self.n_zone + self.n_contact..].fill(0.0);
        &self.values
    }

    /// Starts a sum of element forces.
    pub fn start_sum(&mut self, base: Option<&Trailing>) -> &mut [f64] {
        match base {
            Some(base) => self.set(base),
            None => self.values.fill(0.0),
        }
        &mut self.values
    }

    /// The sum on zone and contact freedoms.
    pub fn sum_into(&self, out: &mut Trailing) {
        out.zone.copy_from_slice(&self.values[..self.n_zone]);
        out.contact
            .copy_from_slice(&self.values[self.n_zone..self.n_zone + self.n_contact]);
    }
}

/// Where the displacements of a node stand in a [`Nodal`] vector, and along which axes they are:
/// `u_x = a_0 u_0 - a_1 u_1`, `u_y = a_1 u_0 + a_0 u_1`.
#[derive(Debug, Clone, Copy)]
pub struct NodalPlaces {
    places: [u32; 2],
    axis: [f64; 2],
}

impl NodalPlaces {
    /// Those of a node of a model.
    pub fn new(model: &Model, places: &Places, node: usize) -> Self {
        let none = (places.n_zone + places.n_contact) as u32;
        let fixed = none + model.freedoms.prescribed.len() as u32;
        let of = |slot| match slot {
            Slot::Free(f) => places.of_freedom[f as usize].min(fixed),
            Slot::Fixed => fixed,
            Slot::Prescribed(p) => none + p,
        };
        NodalPlaces {
            places: model.freedoms.slots[node].map(of),
            axis: model.freedoms.local(node)[0],
        }
    }

    /// The displacement of the node in global axes.
    pub fn of(&self, nodal: &[f64]) -> [f64; 2] {
        let ([u, v], [a, b]) = (self.places.map(|place| nodal[place as usize]), self.axis);
        [a * u - b * v, b * u + a * v]
    }
}

/// An element: where its numbers begin.
#[derive(Debug, Clone, Copy)]
pub struct Packed {
    /// Index in the mesh.
    pub element: u32,
    /// Body.
    pub body: u32,
    /// Number of points.
    pub n_points: u8,
    form: Form,
    first_value: usize,
    first_place: usize,
    turns: (u32, u32),
}

/// A node whose freedoms lie along turned axes.
#[derive(Debug, Clone, Copy)]
struct Turn {
    node: u8,
    axis: [f64; 2],
}

/// Elements one after the other.
#[derive(Default)]
pub struct GatheredElements {
    /// The elements, in the order given.
    pub list: Vec<Packed>,
    /// The operator of each element.
    values: Vec<f64>,
    places: Vec<u32>,
    turns: Vec<Turn>,
}

impl GatheredElements {
    /// Packs elements of a model, `points` giving where they are evaluated.
    pub fn new(
        model: &Model,
        elements: &[usize],
        places: &Places,
        points: impl Fn(usize) -> Points,
    ) -> Self {
        let mut out = GatheredElements::default();
        for &element in elements {
            out.push(model, element, places, &points(element));
        }
        out.values.shrink_to_fit();
        out.places.shrink_to_fit();
        out
    }

    fn push(&mut self, model: &Model, element: usize, places: &Places, points: &Points) {
        let first_turn = self.turns.len() as u32;
        let first_place = self.places.len();
        for (i, &node) in model.mesh.nodes(element).iter().enumerate() {
            let NodalPlaces { places, axis } = NodalPlaces::new(model, places, node as usize);
            self.places.extend(places);
            if axis != [1.0, 0.0] {
                self.turns.push(Turn {
                    node: i as u8,
                    axis,
                });
            }
        }
        self.list.push(Packed {
            element: element as u32,
            body: model.mesh.element_body[element],
            n_points: points.len() as u8,
            form: points.form(),
            first_value: self.values.len(),
            first_place,
            turns: (first_turn, self.turns.len() as u32),
        });
        self.values.extend_from_slice(points.values());
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.list.capacity() * size_of::<Packed>()
            + 8 * self.values.capacity()
            + 4 * self.places.capacity()
    }

    /// Strains at the points of element `i`, for the nodal values of a [`Nodal`].
    pub fn strains(&self, i: usize, nodal: &[f64]) -> AtPoints {
        let packed = &self.list[i];
        let mut u = [0.0; MAX_FREEDOMS];
        for (u, &place) in u.iter_mut().zip(self.places_of(packed)) {
            *u = nodal[place as usize];
        }
        for turn in self.turns_of(packed) {
            let (k, [a, b]) = (2 * turn.node as usize, turn.axis);
            (u[k], u[k + 1]) = (a * u[k] - b * u[k + 1], b * u[k] + a * u[k + 1]);
        }
        packed.form.strains(&self.values[packed.first_value..], &u)
    }

    /// `sum_g w_g B' stress` of element `i`.
    pub fn forces(&self, i: usize, stress: &AtPoints) -> [f64; MAX_FREEDOMS] {
        let packed = &self.list[i];
        let mut f = packed
            .form
            .forces(&self.values[packed.first_value..], stress);
        for turn in self.turns_of(packed) {
            let (k, [a, b]) = (2 * turn.node as usize, turn.axis);
            (f[k], f[k + 1]) = (a * f[k] + b * f[k + 1], a * f[k + 1] - b * f[k]);
        }
        f
    }

    /// Adds the forces of element `i` to nodal sums.
    pub fn scatter(&self, i: usize, force: &[f64; MAX_FREEDOMS], sums: &mut [f64]) {
        for (&place, f) in self.places_of(&self.list[i]).iter().zip(force) {
            sums[place as usize] += f;
        }
    }

    /// Marks the zone freedoms of element `i`.
    pub fn mark(&self, i: usize, marks: &mut [bool]) {
        for &place in self.places_of(&self.list[i]) {
            if let Some(mark) = marks.get_mut(place as usize) {
                *mark = true;
            }
        }
    }

    fn places_of(&self, packed: &Packed) -> &[u32] {
        &self.places[packed.first_place..][..2 * usize::from(packed.form.n_nodes)]
    }

    fn turns_of(&self, packed: &Packed) -> &[Turn] {
        &self.turns[packed.turns.0 as usize..packed.turns.1 as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::gauss_points_of;
    use crate::scene::Scene;

    /// Gathered displacements and scattered forces against the model's own axes and slots, on
    /// elements with turned contact nodes: equal to round-off, and the one the transpose of the
    /// other.
    #[test]
    fn gathered_elements_see_the_displacements_of_the_model() {
        for name in [
            "cylinder_on_half_plane",
            "disc_in_plate",
            "ball_on_half_space",
            "thick_sphere",
        ] {
            let path = format!("{}/data/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
            let scene = Scene::load(std::path::Path::new(&path)).unwrap();
            let model = Model::new(&scene).unwrap();
            let n = model.freedoms.n;
            let elements: Vec<usize> = (0..model.mesh.n_elements()).step_by(7).collect();
            let places = Places::new(n, &(0..n).collect::<Vec<_>>(), &[]);
            let gathered =
                GatheredElements::new(&model, &elements, &places, |e| gauss_points_of(&model, e));
            let mut nodal = Nodal::new(&model, &places);
            let u = Trailing {
                zone: (0..n)
                    .map(|i| ((i * 7919) % 1013) as f64 / 1013.0 - 0.5)
                    .collect(),
                contact: Vec::new(),
            };
            let factors = vec![0.0; model.loads.len()];
            let values = nodal.variation(&u).to_vec();
            let mut turned = 0;
            for (i, &e) in elements.iter().enumerate() {
                turned += gathered.turns_of(&gathered.list[i]).len();
                let points = gauss_points_of(&model, e);
                let strains = gathered.strains(i, &values);
                let expected = points.strains(&model.element_displacement(e, &u.zone, &factors));
                let size = points.values().iter().fold(0.0f64, |m, b| m.max(b.abs()));
                for (a, b) in strains.iter().flatten().zip(expected.iter().flatten()) {
                    assert!((a - b).abs() <= 64.0 * f64::EPSILON * size, "{name} {e}");
                }
                let stress: AtPoints =
                    std::array::from_fn(|g| [1.0, -2.0 + g as f64, 0.5, 0.3].map(f64::from));
                let mut sums = vec![0.0; values.len()];
                gathered.scatter(i, &gathered.forces(i, &stress), &mut sums);
                let work: f64 = sums.iter().zip(&values).map(|(f, u)| f * u).sum();
                let mut internal = 0.0;
                for (weight, (s, e)) in points.weights().zip(stress.iter().zip(&strains)) {
                    internal += weight * s.iter().zip(e).map(|(s, e)| s * e).sum::<f64>();
                }
                let terms: f64 = points.weights().map(|w| w * size).sum::<f64>() * 16.0;
                assert!(
                    (work - internal).abs() <= 64.0 * f64::EPSILON * terms,
                    "{name} {e}: {work} {internal}"
                );
            }
            assert!(
                turned > 0 || name == "thick_sphere",
                "{name}: no turned node"
            );
        }
    }
}

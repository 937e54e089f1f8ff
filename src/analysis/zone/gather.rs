//! Gathers nodal displacements for elements, and scatters element forces into nodal sums.

use crate::model::{Model, Slot};
use crate::space::Vector;
use crate::substructure::Trailing;

/// Position of each zone and contact freedom in a [`Nodal`] vector.
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

/// Nodal values in the order `[ zone | contact | prescribed | 0 ]`. Every freedom of an element has
/// a place in this vector (the zero at the end if the freedom is fixed), so that loops over
/// elements need no branches.
#[derive(Clone)]
pub struct Nodal {
    values: Vec<f64>,
    n_zone: usize,
    n_contact: usize,
    /// Load index of each prescribed displacement, and the displacement at factor 1.
    prescribed: Vec<(usize, f64)>,
    factors: Vec<f64>,
}

impl Nodal {
    /// Zeros for the freedoms of a model, with all load factors zero.
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

    /// Sets the load factors that scale the prescribed displacements from now on.
    pub fn set_factors(&mut self, factors: &[f64]) {
        self.factors.copy_from_slice(factors);
    }

    fn set(&mut self, u: &Trailing) {
        self.values[..self.n_zone].copy_from_slice(&u.zone);
        self.values[self.n_zone..self.n_zone + self.n_contact].copy_from_slice(&u.contact);
    }

    /// Takes over displacements; prescribed displacements take their values at the current factors.
    pub fn displacements(&mut self, u: &Trailing) -> &[f64] {
        self.set(u);
        let rest = &mut self.values[self.n_zone + self.n_contact..];
        for (value, (load, at_one)) in rest.iter_mut().zip(&self.prescribed) {
            *value = self.factors[*load] * at_one;
        }
        &self.values
    }

    /// The nodal values that were taken over last.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Takes over a variation of the displacements, zero on the prescribed freedoms.
    pub fn variation(&mut self, u: &Trailing) -> &[f64] {
        self.set(u);
        self.values[self.n_zone + self.n_contact..].fill(0.0);
        &self.values
    }

    /// Begins a sum of element forces, from `base` or from zero.
    pub fn start_sum(&mut self, base: Option<&Trailing>) -> &mut [f64] {
        match base {
            Some(base) => self.set(base),
            None => self.values.fill(0.0),
        }
        &mut self.values
    }

    /// The sum of forces on the prescribed freedoms.
    pub fn on_prescribed(&self) -> &[f64] {
        &self.values[self.n_zone + self.n_contact..][..self.prescribed.len()]
    }

    /// Writes the sum of forces on zone and contact freedoms into `out`.
    pub fn sum_into(&self, out: &mut Trailing) {
        out.zone.copy_from_slice(&self.values[..self.n_zone]);
        out.contact
            .copy_from_slice(&self.values[self.n_zone..self.n_zone + self.n_contact]);
    }
}

/// One term of a displacement: `coefficient` times the value at `place` of a [`Nodal`] vector.
#[derive(Debug, Clone, Copy)]
struct DisplacementPart {
    /// Number of the displacement within its element or node: node by node, in global axes.
    own: u8,
    place: u32,
    coefficient: f64,
}

/// Places of the displacements of a node in a [`Nodal`] vector.
#[derive(Debug, Clone)]
pub struct NodalPlaces {
    places: [u32; 3],
    /// Terms to be added, if the displacements are sums (on turned or coupled nodes).
    parts: Vec<DisplacementPart>,
}

impl NodalPlaces {
    /// Looks up the places of a node of a model.
    pub fn new(model: &Model, places: &Places, node: usize) -> Self {
        let none = (places.n_zone + places.n_contact) as u32;
        let fixed = none + model.freedoms.prescribed.len() as u32;
        let of = |slot| match slot {
            Slot::Free(f) => places.of_freedom[f as usize].min(fixed),
            Slot::Prescribed(p) => none + p,
            Slot::Fixed | Slot::Sum(_) => fixed,
        };
        let freedoms = &model.freedoms;
        if freedoms.is_plain(node) {
            return NodalPlaces {
                places: freedoms.slots[node].map(of),
                parts: Vec::new(),
            };
        }
        let mut parts = Vec::new();
        freedoms.each_term(node, |slot, v| {
            let components = v.into_iter().take(freedoms.per_node).enumerate();
            parts.extend(
                components
                    .filter(|(_, c)| *c != 0.0)
                    .map(|(d, c)| DisplacementPart {
                        own: d as u8,
                        place: of(slot),
                        coefficient: c,
                    }),
            );
        });
        NodalPlaces {
            places: [fixed; 3],
            parts,
        }
    }

    /// The displacement of the node in global axes.
    pub fn of(&self, nodal: &[f64]) -> Vector {
        let mut values = self.places.map(|place| nodal[place as usize]);
        for part in &self.parts {
            values[usize::from(part.own)] += part.coefficient * nodal[part.place as usize];
        }
        values
    }
}

/// An element, with the index at which its places begin.
#[derive(Debug, Clone, Copy)]
pub struct Packed {
    /// Index in the mesh.
    pub element: u32,
    /// Number of its body.
    pub body: u32,
    n_places: u8,
    first_place: usize,
    parts: (u32, u32),
}

/// Elements in a list, their places one element after the other.
#[derive(Default)]
pub struct GatheredElements {
    /// The elements, in the order given.
    pub list: Vec<Packed>,
    places: Vec<u32>,
    parts: Vec<DisplacementPart>,
    /// Number of zone and contact freedoms: places from here on are prescribed or zero.
    n_free: u32,
}

impl GatheredElements {
    /// Packs elements of a model.
    pub fn new(model: &Model, elements: &[usize], places: &Places) -> Self {
        let mut out = GatheredElements {
            n_free: (places.n_zone + places.n_contact) as u32,
            ..GatheredElements::default()
        };
        for &element in elements {
            out.push(model, element, places);
        }
        out.places.shrink_to_fit();
        out
    }

    fn push(&mut self, model: &Model, element: usize, places: &Places) {
        let first_part = self.parts.len() as u32;
        let first_place = self.places.len();
        let nodes = model.mesh.nodes(element);
        let per_node = model.freedoms.per_node;
        for (i, &node) in nodes.iter().enumerate() {
            let of_node = NodalPlaces::new(model, places, node as usize);
            self.places.extend(&of_node.places[..per_node]);
            let first = (per_node * i) as u8;
            let parts = of_node.parts.into_iter();
            self.parts.extend(parts.map(|part| DisplacementPart {
                own: first + part.own,
                ..part
            }));
        }
        self.list.push(Packed {
            element: element as u32,
            body: model.mesh.element_body[element],
            n_places: (per_node * nodes.len()) as u8,
            first_place,
            parts: (first_part, self.parts.len() as u32),
        });
    }

    /// Bytes of heap held.
    pub fn bytes(&self) -> usize {
        self.list.capacity() * size_of::<Packed>()
            + 4 * self.places.capacity()
            + self.parts.capacity() * size_of::<DisplacementPart>()
    }

    /// Displacements of the nodes of element `i` in global axes, read from the values of a
    /// [`Nodal`].
    #[inline]
    pub fn displacements<const D: usize, const N: usize>(
        &self,
        i: usize,
        nodal: &[f64],
    ) -> [[f64; D]; N] {
        let packed = &self.list[i];
        let mut out = [[0.0; D]; N];
        let flat = out.as_flattened_mut();
        for (u, &place) in flat.iter_mut().zip(self.places_of(packed)) {
            *u = nodal[place as usize];
        }
        for part in self.parts_of(packed) {
            flat[usize::from(part.own)] += part.coefficient * nodal[part.place as usize];
        }
        out
    }

    /// Adds forces on the nodes of element `i`, in global axes, to nodal sums.
    pub fn scatter<const D: usize, const N: usize>(
        &self,
        i: usize,
        force: &[[f64; D]; N],
        sums: &mut [f64],
    ) {
        let packed = &self.list[i];
        for (&place, f) in self.places_of(packed).iter().zip(force.as_flattened()) {
            sums[place as usize] += f;
        }
        for part in self.parts_of(packed) {
            let force = force.as_flattened()[usize::from(part.own)];
            sums[part.place as usize] += part.coefficient * force;
        }
    }

    /// A matrix of element `i`, moved to its zone and contact freedoms. The columns given are the
    /// forces on the nodes for a unit of each nodal displacement. Returns the places of the
    /// freedoms (ascending) and the matrix by columns.
    pub fn spread<const D: usize, const N: usize>(
        &self,
        i: usize,
        columns: &[[[f64; D]; N]],
    ) -> (Vec<u32>, Vec<f64>) {
        let packed = &self.list[i];
        let plain = self.places_of(packed).iter().enumerate();
        let plain = plain.map(|(own, &place)| (own, place, 1.0));
        let parts = self.parts_of(packed).iter();
        let parts = parts.map(|part| (usize::from(part.own), part.place, part.coefficient));
        let terms: Vec<(usize, u32, f64)> = plain
            .chain(parts)
            .filter(|term| term.1 < self.n_free)
            .collect();
        let mut places: Vec<u32> = terms.iter().map(|term| term.1).collect();
        places.sort_unstable();
        places.dedup();
        let n = places.len();
        let of = |place: u32| places.partition_point(|&other| other < place);
        let rows: Vec<usize> = terms.iter().map(|term| of(term.1)).collect();
        let mut matrix = vec![0.0; n * n];
        for (&(j, _, b), &column) in terms.iter().zip(&rows) {
            let forces = columns[j].as_flattened();
            let own = &mut matrix[column * n..(column + 1) * n];
            for (&(i, _, a), &row) in terms.iter().zip(&rows) {
                own[row] += a * b * forces[i];
            }
        }
        (places, matrix)
    }

    /// Marks the freedoms of element `i` that `marks` covers: the zone freedoms.
    pub fn mark(&self, i: usize, marks: &mut [bool]) {
        let packed = &self.list[i];
        let parts = self.parts_of(packed).iter().map(|part| part.place);
        for place in self.places_of(packed).iter().copied().chain(parts) {
            if let Some(mark) = marks.get_mut(place as usize) {
                *mark = true;
            }
        }
    }

    fn places_of(&self, packed: &Packed) -> &[u32] {
        &self.places[packed.first_place..][..usize::from(packed.n_places)]
    }

    fn parts_of(&self, packed: &Packed) -> &[DisplacementPart] {
        &self.parts[packed.parts.0 as usize..packed.parts.1 as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::{Components, Kernel};
    use crate::scene::Scene;

    /// Gathered displacements and scattered forces agree with the model's own axes and slots to
    /// round-off, on elements with turned contact nodes. Gathering and scattering are transposes of
    /// each other.
    #[test]
    fn gathered_elements_see_the_displacements_of_the_model() {
        let coarse = "mesh.cylinder_on_half_plane.resolution=4";
        for (name, change) in [
            ("cylinder_on_half_plane", coarse),
            ("disc_in_plate", "mesh.disc_in_plate.resolution=12"),
            ("ball_on_half_space", coarse),
            ("thick_sphere", "mesh.parts.0.ring.elements=[8,8]"),
        ] {
            let path = format!("{}/data/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
            let scene = Scene::load_with(path, &[change.to_string()]).unwrap();
            let model = Model::new(&scene).unwrap();
            let n = model.freedoms.n;
            let elements: Vec<usize> = (0..model.mesh.n_elements()).step_by(7).collect();
            let places = Places::new(n, &(0..n).collect::<Vec<_>>(), &[]);
            let gathered = GatheredElements::new(&model, &elements, &places);
            let mut nodal = Nodal::new(&model, &places);
            let u_free: Vec<f64> = (0..n)
                .map(|i| ((i * 7919) % 1013) as f64 / 1013.0 - 0.5)
                .collect();
            let u = Trailing {
                zone: u_free.clone(),
                contact: Vec::new(),
            };
            let factors = vec![0.0; model.loads.len()];
            let values = nodal.variation(&u).to_vec();
            let mut turned = 0;
            for (i, &e) in elements.iter().enumerate() {
                turned += gathered.parts_of(&gathered.list[i]).len();
                let moved = gathered.displacements::<2, 8>(i, &values);
                for (u, &node) in moved.iter().zip(model.mesh.nodes(e)) {
                    let expected = model
                        .freedoms
                        .displacement(node as usize, &u_free, &factors);
                    for (a, b) in u.iter().zip(expected) {
                        assert!((a - b).abs() <= 4.0 * f64::EPSILON, "{name} {e}");
                    }
                }
                let gradients = model.gradients(&Kernel::plane(model.kind), e);
                let strains = gradients.strains(&moved);
                let stress: Components =
                    std::array::from_fn(|c| std::array::from_fn(|g| c as f64 - 2.0 + g as f64));
                let mut sums = vec![0.0; values.len()];
                gathered.scatter(i, &gradients.forces(&stress), &mut sums);
                let work: f64 = sums.iter().zip(&values).map(|(f, u)| f * u).sum();
                let (mut internal, mut terms) = (0.0, 0.0);
                for (g, weight) in gradients.weights().iter().enumerate() {
                    for (s, e) in stress.iter().zip(&strains) {
                        internal += weight * s[g] * e[g];
                        terms += (weight * s[g] * e[g]).abs();
                    }
                }
                // A strain is a difference of displacements divided by the size of the element.
                let force: f64 = sums.iter().map(|f| f.abs()).sum();
                assert!(
                    (work - internal).abs() <= 64.0 * f64::EPSILON * (terms + force),
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

//! The elements of the zone, packed for speed: strain operators without their zeros, and where freedoms find
//! displacements.
//!
//! With the gradients `n_x = dN/dx`, `n_y = dN/dy`, `n_r = N/r` (axisymmetric) of a node's shape function at a point and the
//! mean dilatation `m` of the element (B-bar) the strain operator and its transpose are
//!
//! ```text
//! e_xx = sum n_x u + c,  e_yy = sum n_y v + c,  e_zz = sum n_r u + c,  g_xy = sum n_y u + n_x v
//!        c = (sum m_x u + m_y v - sum (n_x + n_r) u + n_y v)/3
//! f_x  = w (n_x s_x + n_r s_z + n_y t + m_x p),  f_y = w (n_y s_y + n_x t + m_y p)
//!        p = mean stress, s = stress less p
//! ```
//!
//! (`c` and `p` are zero without B-bar): for a quad4 about a sixth of the numbers of the full B, which is what counts
//! where thousands of evaluations run through memory.

use crate::element::{MAX_FREEDOMS, MAX_POINTS, Points};
use crate::model::{Model, Slot};
use crate::substructure::Trailing;

/// Stresses or strains at the points of an element.
pub type AtPoints = [[f64; 4]; MAX_POINTS];

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

/// An element: where its numbers begin.
#[derive(Debug, Clone, Copy)]
pub struct Packed {
    /// Index in the mesh.
    pub element: u32,
    /// Body.
    pub body: u32,
    /// Number of points.
    pub n_points: u8,
    n_nodes: u8,
    is_axisymmetric: bool,
    has_mean: bool,
    first_value: usize,
    first_place: usize,
    turns: (u32, u32),
}

/// A node whose freedoms lie along turned axes: `u_x = a_0 u_0 - a_1 u_1`, `u_y = a_1 u_0 + a_0 u_1`.
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
    /// For each element: per point weight, `n_x`, `n_y` and, axisymmetric, `n_r` of all nodes; then, with B-bar, `m_x`, `m_y`.
    values: Vec<f64>,
    places: Vec<u32>,
    turns: Vec<Turn>,
}

impl GatheredElements {
    /// Packs elements of a model, `local` giving their points in global axes.
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
        let n_nodes = points.n_freedoms / 2;
        // B-bar puts the same number into rows xx and yy of a node's other direction.
        let shift = |b: &[[f64; MAX_FREEDOMS]; 4], i: usize| [b[1][2 * i], b[0][2 * i + 1]];
        let has_mean = points
            .iter()
            .any(|p| (0..n_nodes).any(|i| shift(&p.b, i) != [0.0; 2]));
        let is_axisymmetric = model.kind == crate::scene::Kind::Axisymmetric;
        let first_turn = self.turns.len() as u32;
        let first_place = self.places.len();
        let none = (places.n_zone + places.n_contact) as u32;
        let fixed = none + model.freedoms.prescribed.len() as u32;
        for (i, &node) in model.mesh.nodes(element).iter().enumerate() {
            let node = node as usize;
            for slot in model.freedoms.slots[node] {
                self.places.push(match slot {
                    Slot::Free(f) => places.of_freedom[f as usize].min(fixed),
                    Slot::Fixed => fixed,
                    Slot::Prescribed(p) => none + p,
                });
            }
            let axis = model.freedoms.local(node)[0];
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
            n_nodes: n_nodes as u8,
            is_axisymmetric,
            has_mean,
            first_value: self.values.len(),
            first_place,
            turns: (first_turn, self.turns.len() as u32),
        });
        for point in points.iter() {
            let b = &point.b;
            self.values.push(point.weight);
            self.values.extend((0..n_nodes).map(|i| b[3][2 * i + 1]));
            self.values.extend((0..n_nodes).map(|i| b[3][2 * i]));
            if is_axisymmetric {
                self.values
                    .extend((0..n_nodes).map(|i| b[2][2 * i] - shift(b, i)[0]));
            }
        }
        if has_mean {
            // The same at every point: three times the shift plus what it replaced.
            let b = &points[0].b;
            self.values
                .extend((0..n_nodes).map(|i| b[0][2 * i] + b[1][2 * i] + b[2][2 * i]));
            self.values
                .extend((0..n_nodes).map(|i| b[0][2 * i + 1] + b[1][2 * i + 1] + b[2][2 * i + 1]));
        }
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
        match packed.n_nodes {
            3 => self.strains_of::<3>(packed, nodal),
            4 => self.strains_of::<4>(packed, nodal),
            6 => self.strains_of::<6>(packed, nodal),
            _ => self.strains_of::<8>(packed, nodal),
        }
    }

    /// `sum_g w_g B' stress` of element `i`.
    pub fn forces(&self, i: usize, stress: &AtPoints) -> [f64; MAX_FREEDOMS] {
        let packed = &self.list[i];
        match packed.n_nodes {
            3 => self.forces_of::<3>(packed, stress),
            4 => self.forces_of::<4>(packed, stress),
            6 => self.forces_of::<6>(packed, stress),
            _ => self.forces_of::<8>(packed, stress),
        }
    }

    /// Adds the forces of element `i` to nodal sums.
    pub fn scatter(&self, i: usize, force: &[f64; MAX_FREEDOMS], sums: &mut [f64]) {
        let packed = &self.list[i];
        let places = &self.places[packed.first_place..][..2 * packed.n_nodes as usize];
        for (&place, f) in places.iter().zip(force) {
            sums[place as usize] += f;
        }
    }

    fn turns_of(&self, packed: &Packed) -> &[Turn] {
        &self.turns[packed.turns.0 as usize..packed.turns.1 as usize]
    }

    fn strains_of<const N: usize>(&self, packed: &Packed, nodal: &[f64]) -> AtPoints {
        let places = &self.places[packed.first_place..][..2 * N];
        let mut u = [0.0; N];
        let mut v = [0.0; N];
        for k in 0..N {
            u[k] = nodal[places[2 * k] as usize];
            v[k] = nodal[places[2 * k + 1] as usize];
        }
        for turn in self.turns_of(packed) {
            let (k, [a, b]) = (turn.node as usize, turn.axis);
            (u[k], v[k]) = (a * u[k] - b * v[k], b * u[k] + a * v[k]);
        }
        let n_points = packed.n_points as usize;
        let stride = 1 + N * (2 + usize::from(packed.is_axisymmetric));
        let values = &self.values[packed.first_value..];
        let mean = if packed.has_mean {
            let m = &values[n_points * stride..][..2 * N];
            Some(dot::<N>(&m[..N], &u) + dot::<N>(&m[N..], &v))
        } else {
            None
        };
        let mut out = AtPoints::default();
        for (strain, point) in out
            .iter_mut()
            .zip(values.chunks_exact(stride))
            .take(n_points)
        {
            let (x, y) = (&point[1..=N], &point[1 + N..=2 * N]);
            let mut e = [
                dot::<N>(x, &u),
                dot::<N>(y, &v),
                0.0,
                dot::<N>(y, &u) + dot::<N>(x, &v),
            ];
            if packed.is_axisymmetric {
                e[2] = dot::<N>(&point[1 + 2 * N..], &u);
            }
            if let Some(mean) = mean {
                let change = (mean - (e[0] + e[1] + e[2])) / 3.0;
                for e in &mut e[..3] {
                    *e += change;
                }
            }
            *strain = e;
        }
        out
    }

    fn forces_of<const N: usize>(&self, packed: &Packed, stress: &AtPoints) -> [f64; MAX_FREEDOMS] {
        let n_points = packed.n_points as usize;
        let stride = 1 + N * (2 + usize::from(packed.is_axisymmetric));
        let values = &self.values[packed.first_value..];
        let mut fx = [0.0; N];
        let mut fy = [0.0; N];
        let mut pressure = 0.0;
        for (s, point) in stress
            .iter()
            .zip(values.chunks_exact(stride))
            .take(n_points)
        {
            let p = if packed.has_mean {
                (s[0] + s[1] + s[2]) / 3.0
            } else {
                0.0
            };
            let weight = point[0];
            let [sx, sy, sz, t] = [s[0] - p, s[1] - p, s[2] - p, s[3]].map(|s| weight * s);
            pressure += weight * p;
            let (x, y) = (&point[1..=N], &point[1 + N..=2 * N]);
            for k in 0..N {
                fx[k] += x[k] * sx + y[k] * t;
                fy[k] += y[k] * sy + x[k] * t;
            }
            if packed.is_axisymmetric {
                for (f, r) in fx.iter_mut().zip(&point[1 + 2 * N..]) {
                    *f += r * sz;
                }
            }
        }
        if packed.has_mean {
            let m = &values[n_points * stride..][..2 * N];
            for k in 0..N {
                fx[k] += m[k] * pressure;
                fy[k] += m[N + k] * pressure;
            }
        }
        for turn in self.turns_of(packed) {
            let (k, [a, b]) = (turn.node as usize, turn.axis);
            (fx[k], fy[k]) = (a * fx[k] + b * fy[k], a * fy[k] - b * fx[k]);
        }
        let mut out = [0.0; MAX_FREEDOMS];
        for k in 0..N {
            out[2 * k] = fx[k];
            out[2 * k + 1] = fy[k];
        }
        out
    }
}

fn dot<const N: usize>(a: &[f64], b: &[f64; N]) -> f64 {
    let mut sum = 0.0;
    for (a, b) in a[..N].iter().zip(b) {
        sum += a * b;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::{LocalElement, local_element};
    use crate::scene::Scene;

    /// Packed operators against the full B with its columns in local axes, on every element of a model with turned
    /// contact nodes: equal to round-off.
    #[test]
    fn packed_operators_are_b() {
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
            let packed = GatheredElements::new(&model, &elements, &places, |e| {
                LocalElement::points_of(&model, e)
            });
            let mut nodal = Nodal::new(&model, &places);
            let u = Trailing {
                zone: (0..n)
                    .map(|i| ((i * 7919) % 1013) as f64 / 1013.0 - 0.5)
                    .collect(),
                contact: Vec::new(),
            };
            let values = nodal.variation(&u).to_vec();
            for (i, &e) in elements.iter().enumerate() {
                let local = local_element(&model, e);
                let mut displacement = [0.0; MAX_FREEDOMS];
                for (d, slot) in displacement.iter_mut().zip(&local.slots) {
                    if let Slot::Free(f) = slot {
                        *d = u.zone[*f as usize];
                    }
                }
                let strains = packed.strains(i, &values);
                let mut stress = AtPoints::default();
                let mut expected = [0.0; MAX_FREEDOMS];
                let mut size = [0.0f64; 2];
                for (g, point) in local.points.iter().enumerate() {
                    let strain = point.strain(&displacement[..local.points.n_freedoms]);
                    let b = point.b.iter().flatten().fold(0.0f64, |m, b| m.max(b.abs()));
                    for (a, b_) in strain.iter().zip(&strains[g]) {
                        assert!(
                            (a - b_).abs() <= 64.0 * f64::EPSILON * b,
                            "{name} {e}: {a} {b_}"
                        );
                    }
                    stress[g] = [1.0, -2.0 + g as f64, 0.5, 0.3];
                    point.add_force(&stress[g], &mut expected);
                    size[0] = size[0].max(4.0 * b * point.weight);
                    size[1] += 1.0;
                }
                let forces = packed.forces(i, &stress);
                for (a, b) in expected.iter().zip(&forces) {
                    assert!(
                        (a - b).abs() <= 64.0 * f64::EPSILON * size[0] * size[1],
                        "{name} {e}: {a} {b}"
                    );
                }
            }
        }
    }
}

//! The elements that may yield: strains, flow rule and initial loads.
//!
//! ```text
//! eps = B u,   J = sum_g w_g B' D eps_p(eps),   dJ = sum_g w_g B' (D - D_ep) B du
//! ```
//!
//! `J` are the paper's initial loads (4.1). The plastic strains depend on the committed history, on
//! the strains at the start of the increment and on the total strain at its end. Within an
//! increment they are therefore a function of `u` alone.

use super::gather::Places;
use super::history::PointHistory;
use super::points::{Evaluation, ZoneOf};
use super::yielding::Yielding;
use crate::element::with_kernel;
use crate::model::Model;
use crate::substructure::Trailing;

/// The plastic zone of a model with its history.
pub enum Zone {
    /// Zone of a plane or axisymmetric model.
    Plane(Box<ZoneOf<2, 4, 4, 8>>),
    /// Zone of a solid.
    Solid(Box<ZoneOf<3, 6, 8, 20>>),
    /// Zone of a plane or axisymmetric model with a fully integrated body.
    FullPlane(Box<ZoneOf<2, 4, 9, 8>>),
    /// Zone of a solid with a fully integrated body.
    FullSolid(Box<ZoneOf<3, 6, 27, 20>>),
}

impl From<ZoneOf<2, 4, 4, 8>> for Zone {
    fn from(zone: ZoneOf<2, 4, 4, 8>) -> Self {
        Zone::Plane(Box::new(zone))
    }
}

impl From<ZoneOf<3, 6, 8, 20>> for Zone {
    fn from(zone: ZoneOf<3, 6, 8, 20>) -> Self {
        Zone::Solid(Box::new(zone))
    }
}

impl From<ZoneOf<2, 4, 9, 8>> for Zone {
    fn from(zone: ZoneOf<2, 4, 9, 8>) -> Self {
        Zone::FullPlane(Box::new(zone))
    }
}

impl From<ZoneOf<3, 6, 27, 20>> for Zone {
    fn from(zone: ZoneOf<3, 6, 27, 20>) -> Self {
        Zone::FullSolid(Box::new(zone))
    }
}

/// Evaluates one expression for the zone, whatever its dimension and integration rule.
macro_rules! of_zone {
    ($self:expr, $zone:ident => $body:expr) => {
        match $self {
            Zone::Plane($zone) => $body,
            Zone::Solid($zone) => $body,
            Zone::FullPlane($zone) => $body,
            Zone::FullSolid($zone) => $body,
        }
    };
}

pub(in crate::analysis) use of_zone;

/// The methods of [`ZoneOf`], for a zone of either dimension.
impl Zone {
    /// Sets up the zone of the given elements (ascending). `guard` marks the elements that are in
    /// the zone only to show when yielding reaches them. The free freedoms of the elements must be
    /// zone or contact freedoms.
    pub fn new(model: &Model, elements: &[usize], guard: &[bool], places: &Places) -> Self {
        with_kernel!(model.kind, model.formulation, model.mesh, kernel => {
            ZoneOf::new(&kernel, model, elements, guard, places).into()
        })
    }

    /// [`ZoneOf::bytes`]
    pub fn bytes(&self) -> u64 {
        of_zone!(self, zone => zone.bytes())
    }

    /// [`ZoneOf::set_factors`]
    pub fn set_factors(&mut self, factors: &[f64]) {
        of_zone!(self, zone => zone.set_factors(factors));
    }

    /// [`ZoneOf::begin_at`]
    pub fn begin_at(&mut self, u: &Trailing, factors: &[f64]) {
        of_zone!(self, zone => zone.begin_at(u, factors));
    }

    /// [`ZoneOf::evaluate`]
    pub fn evaluate(&mut self, u: &Trailing, initial_load: &mut Trailing) -> Evaluation {
        of_zone!(self, zone => zone.evaluate(u, initial_load))
    }

    /// [`ZoneOf::softening_times`]
    pub fn softening_times(&mut self, v: &Trailing, out: &mut Trailing) {
        of_zone!(self, zone => zone.softening_times(v, out));
    }

    /// [`ZoneOf::keep_softening`]
    pub fn keep_softening(&mut self) {
        of_zone!(self, zone => zone.keep_softening());
    }

    /// [`ZoneOf::forget_softening`]
    pub fn forget_softening(&mut self) {
        of_zone!(self, zone => zone.forget_softening());
    }

    /// [`ZoneOf::kept_softening_times`]
    pub fn kept_softening_times(&mut self, v: &Trailing, out: &mut Trailing) {
        of_zone!(self, zone => zone.kept_softening_times(v, out));
    }

    /// [`ZoneOf::mark_kept`]
    pub fn mark_kept(&self, marks: &mut [bool]) {
        of_zone!(self, zone => zone.mark_kept(marks));
    }

    /// [`ZoneOf::each_softening`]
    pub fn each_softening(&self, share: f64, take: impl FnMut(&[u32], &[f64])) {
        of_zone!(self, zone => zone.each_softening(share, take));
    }

    /// [`ZoneOf::is_symmetric`]
    pub fn is_symmetric(&self) -> bool {
        of_zone!(self, zone => zone.is_symmetric())
    }

    /// [`ZoneOf::mark_active`]
    pub fn mark_active(&self, marks: &mut [bool]) {
        of_zone!(self, zone => zone.mark_active(marks));
    }

    /// [`ZoneOf::is_idle`]
    pub fn is_idle(&self) -> bool {
        of_zone!(self, zone => zone.is_idle())
    }

    /// [`ZoneOf::assume_elastic`]
    pub fn assume_elastic(&mut self) {
        of_zone!(self, zone => zone.assume_elastic());
    }

    /// [`ZoneOf::commit`]
    pub fn commit(&mut self) {
        of_zone!(self, zone => zone.commit());
    }

    /// [`ZoneOf::n_points`]
    pub fn n_points(&self, elements: &[usize]) -> usize {
        of_zone!(self, zone => zone.n_points(elements))
    }

    /// [`ZoneOf::history`]
    pub fn history(&self) -> PointHistory {
        of_zone!(self, zone => zone.history())
    }

    /// [`ZoneOf::restore`]
    pub fn restore(&mut self, history: &PointHistory) {
        of_zone!(self, zone => zone.restore(history));
    }

    /// [`ZoneOf::restore_of`]
    pub fn restore_of(&mut self, elements: &[usize], history: &PointHistory) {
        of_zone!(self, zone => zone.restore_of(elements, history));
    }

    /// [`ZoneOf::on_prescribed`]
    pub fn on_prescribed(&self) -> &[f64] {
        of_zone!(self, zone => zone.on_prescribed())
    }

    /// [`ZoneOf::initial_load`]
    pub fn initial_load(&self, out: Trailing) -> Trailing {
        of_zone!(self, zone => zone.initial_load(out))
    }

    /// [`ZoneOf::extent`]
    pub fn extent(&self) -> (usize, f64) {
        of_zone!(self, zone => zone.extent())
    }

    /// [`ZoneOf::yielding`]
    pub(in crate::analysis) fn yielding(&self) -> Yielding {
        of_zone!(self, zone => zone.yielding())
    }

    /// [`ZoneOf::set_yielding`]
    pub(in crate::analysis) fn set_yielding(&mut self, record: &Yielding) -> bool {
        of_zone!(self, zone => zone.set_yielding(record))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::PlasticState;
    use crate::scene::Scene;

    const TEXT: &str = r#"
title = "block"
kind = "plane_strain"
[[mesh.parts]]
body = "block"
block = { x = [0.0, 1.0], y = [0.0, 1.0], elements = [3, 2] }
[materials.metal]
youngs_modulus = 1000.0
poissons_ratio = 0.3
yield_stress = 10.0
plastic_modulus = 50.0
[bodies.block]
material = "metal"
[[load]]
on = "block.top"
pressure = 1.0
[[support]]
on = "block.bottom"
fix = ["x", "y"]
[program]
targets = [{ load_factor = 1.0 }]
"#;

    struct Case {
        model: Model,
        elements: Vec<usize>,
        places: Places,
    }

    impl Case {
        fn new() -> Self {
            let model = Model::new(&Scene::parse(TEXT, "test").unwrap()).unwrap();
            let n = model.freedoms.n;
            Case {
                elements: (0..model.mesh.n_elements()).collect(),
                places: Places::new(n, &(0..n).collect::<Vec<_>>(), &[]),
                model,
            }
        }

        fn zone(&self) -> Zone {
            let guard = vec![false; self.elements.len()];
            Zone::new(&self.model, &self.elements, &guard, &self.places)
        }

        /// Displacements `u_y = strain x y`: beyond yield on the right, elastic on the left.
        fn bent(&self, strain: f64) -> Trailing {
            let mut u = Trailing::zeros(self.model.freedoms.n, 0);
            for (node, slots) in self.model.freedoms.slots.iter().enumerate() {
                if let crate::model::Slot::Free(f) = slots[1] {
                    let [x, y] = self.model.mesh.in_plane(node);
                    u.zone[f as usize] = strain * x * y;
                }
            }
            u
        }

        fn flow(&self, zone: &mut Zone, strain: f64) -> Evaluation {
            let mut load = Trailing::zeros(self.model.freedoms.n, 0);
            let evaluation = zone.evaluate(&self.bent(strain), &mut load);
            zone.commit();
            evaluation
        }
    }

    /// A zone whose history was restored keeps nothing of what it went through since: the points
    /// that yield next are the points that yield in a new zone.
    #[test]
    fn a_restored_history_is_all_there_is() {
        let case = Case::new();
        let mut zone = case.zone();
        let virgin = zone.history();
        assert!(case.flow(&mut zone, 0.3).yielding > 0);
        // All strains are elastic from here: nothing yields, and the last yielding is history.
        assert_eq!(case.flow(&mut zone, 0.29).yielding, 0);
        zone.restore(&virgin);
        assert_eq!(zone.extent(), (0, 0.0));
        let mut fresh = case.zone();
        let yielding = case.flow(&mut zone, 0.03);
        assert_eq!(yielding, case.flow(&mut fresh, 0.03));
        // Only some points of an element yield, so that the others show what they remember.
        let history = fresh.history();
        let points = history.points.chunks(4);
        let partly = |states: &[PlasticState<6>]| {
            let yielded = states.iter().filter(|s| s.equivalent > 0.0).count();
            yielded > 0 && yielded < states.len()
        };
        assert!(points.clone().any(partly));
        assert_eq!(zone.history(), fresh.history());
    }

    /// The element matrices add up to the matrix behind the products, both at the current state and
    /// at a state that was kept.
    #[test]
    fn element_matrices_add_up_to_the_product() {
        let case = Case::new();
        let n = case.model.freedoms.n;
        let mut zone = case.zone();
        let mut load = Trailing::zeros(n, 0);
        zone.evaluate(&case.bent(0.3), &mut load);
        let direction = case.bent(-0.02);
        let mut sum = vec![0.0; n];
        zone.each_softening(0.5, |places, matrix| {
            for (column, &j) in matrix.chunks(places.len()).zip(places) {
                for (entry, &i) in column.iter().zip(places) {
                    sum[i as usize] += entry * direction.zone[j as usize];
                }
            }
        });
        let [mut product, mut kept] = [(); 2].map(|()| Trailing::zeros(n, 0));
        zone.softening_times(&direction, &mut product);
        assert!(product.largest() > 0.0);
        for (sum, product) in sum.iter().zip(&product.zone) {
            assert!((sum - 0.5 * product).abs() <= 1e-13 * load.largest());
        }
        zone.keep_softening();
        zone.evaluate(&case.bent(0.02), &mut load);
        zone.kept_softening_times(&direction, &mut kept);
        assert_eq!(kept, product);
        let mut marks = vec![false; n];
        zone.mark_kept(&mut marks);
        let felt = kept.zone.iter().zip(&marks);
        assert!(felt.clone().all(|(force, mark)| *mark || *force == 0.0));
        zone.forget_softening();
        zone.kept_softening_times(&direction, &mut kept);
        assert_eq!(kept.largest(), 0.0);
    }

    /// After the history of a smaller zone is restored, elements outside that zone have no history,
    /// whatever they have gone through since.
    #[test]
    fn elements_outside_a_restored_zone_have_no_history() {
        let case = Case::new();
        let mut zone = case.zone();
        case.flow(&mut zone, 0.3);
        let stride = 4;
        // History of the second element of a zone of two; the first is elastic.
        let all = zone.history();
        let mut small = PointHistory {
            points: vec![PlasticState::default(); 2 * stride],
            ..PointHistory::default()
        };
        small.points[stride..].copy_from_slice(&all.points[4 * stride..5 * stride]);
        zone.restore_of(&[1, 4], &small);
        let mut expected = vec![PlasticState::default(); all.points.len()];
        expected[4 * stride..5 * stride].copy_from_slice(&small.points[stride..]);
        assert!(expected.iter().any(|s| s.equivalent > 0.0));
        assert_eq!(zone.history().points, expected);
        zone.restore_of(&[], &PointHistory::default());
        let base = zone.initial_load(Trailing::zeros(case.model.freedoms.n, 0));
        assert_eq!((zone.extent(), base.largest()), ((0, 0.0), 0.0));
    }
}

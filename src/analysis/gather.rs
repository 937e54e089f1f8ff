//! Elements of the zone and where their freedoms find displacements.

use crate::assembly::LocalElement;
use crate::element::{MAX_FREEDOMS, Points};
use crate::model::{Model, Slot};
use crate::substructure::Trailing;

/// Where an element freedom finds its displacement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Zone(u32),
    Contact(u32),
    Prescribed(u32),
    Fixed,
}

/// Position of every freedom of the model among zone and contact freedoms.
pub struct Places(Vec<Place>);

impl Places {
    /// Positions for the given zone and contact freedoms.
    pub fn new(n: usize, zone: &[usize], contact: &[usize]) -> Self {
        let mut places = vec![Place::Fixed; n];
        for (i, &f) in zone.iter().enumerate() {
            places[f] = Place::Zone(i as u32);
        }
        for (i, &f) in contact.iter().enumerate() {
            places[f] = Place::Contact(i as u32);
        }
        Places(places)
    }
}

/// An element with its strain-displacement matrices and the places of its freedoms.
pub struct GatheredElement {
    /// Index in the mesh.
    pub element: usize,
    /// Body.
    pub body: u32,
    /// Points with B in local axes.
    pub points: Points,
    places: [Place; MAX_FREEDOMS],
}

impl GatheredElement {
    /// The element in local axes, with the places of its freedoms.
    pub fn new(model: &Model, element: usize, local: LocalElement, places: &Places) -> Self {
        GatheredElement {
            element,
            body: model.mesh.element_body[element],
            points: local.points,
            places: local.slots.map(|slot| match slot {
                Slot::Free(f) => places.0[f as usize],
                Slot::Fixed => Place::Fixed,
                Slot::Prescribed(p) => Place::Prescribed(p),
            }),
        }
    }

    /// Adds an element vector to a vector on zone and contact freedoms.
    pub fn scatter(&self, force: &[f64; MAX_FREEDOMS], out: &mut Trailing) {
        for (place, f) in self.places.iter().zip(force).take(self.points.n_freedoms) {
            match *place {
                Place::Zone(i) => out.zone[i as usize] += f,
                Place::Contact(i) => out.contact[i as usize] += f,
                Place::Prescribed(_) | Place::Fixed => {}
            }
        }
    }
}

/// Prescribed displacements at the current load factors.
pub struct Prescribed {
    at_one: Vec<(usize, f64)>,
    now: Vec<f64>,
}

impl Prescribed {
    /// Those of a model, at factors zero.
    pub fn new(model: &Model) -> Self {
        let at_one: Vec<(usize, f64)> = model
            .freedoms
            .prescribed
            .iter()
            .map(|p| (p.load, p.value))
            .collect();
        Prescribed {
            now: vec![0.0; at_one.len()],
            at_one,
        }
    }

    /// Sets the factors of the loads.
    pub fn set_factors(&mut self, factors: &[f64]) {
        for (now, (load, value)) in self.now.iter_mut().zip(&self.at_one) {
            *now = factors[*load] * value;
        }
    }
}

/// Displacements to gather from.
pub struct Lookup<'a> {
    u: &'a Trailing,
    prescribed: Option<&'a Prescribed>,
}

impl<'a> Lookup<'a> {
    /// Displacements with the prescribed ones.
    pub fn new(u: &'a Trailing, prescribed: &'a Prescribed) -> Self {
        Lookup {
            u,
            prescribed: Some(prescribed),
        }
    }

    /// A variation: zero where displacements are prescribed.
    pub fn homogeneous(u: &'a Trailing) -> Self {
        Lookup {
            u,
            prescribed: None,
        }
    }

    /// Displacements of an element's freedoms.
    pub fn gather(&self, element: &GatheredElement) -> [f64; MAX_FREEDOMS] {
        element.places.map(|place| match place {
            Place::Zone(i) => self.u.zone[i as usize],
            Place::Contact(i) => self.u.contact[i as usize],
            Place::Prescribed(p) => self.prescribed.map_or(0.0, |all| all.now[p as usize]),
            Place::Fixed => 0.0,
        })
    }
}

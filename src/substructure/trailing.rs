//! Vectors on the trailing freedoms: zone and contact, the last in the order of elimination.

use crate::linalg;

/// A load or displacement on the trailing freedoms, those of zone and contact, which are eliminated
/// last. The contact freedoms are in the order of [`crate::model::ContactRows::freedoms`].
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Trailing {
    /// Values on the zone freedoms.
    pub zone: Vec<f64>,
    /// Values on the contact freedoms.
    pub contact: Vec<f64>,
}

impl Trailing {
    /// Returns a zero vector with the given numbers of freedoms.
    pub fn zeros(n_zone: usize, n_contact: usize) -> Self {
        Trailing {
            zone: vec![0.0; n_zone],
            contact: vec![0.0; n_contact],
        }
    }

    /// Iterates over the zone's values, then over the contact's.
    pub fn iter(&self) -> impl Iterator<Item = &f64> {
        self.zone.iter().chain(&self.contact)
    }

    /// Iterates mutably over the zone's values, then over the contact's.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        self.zone.iter_mut().chain(&mut self.contact)
    }

    /// Adds a multiple of another vector: `self += factor * other`.
    pub fn add(&mut self, factor: f64, other: &Trailing) {
        if factor != 0.0 {
            let add = |own: &mut [f64], other: &[f64]| {
                for (a, b) in own.iter_mut().zip(other) {
                    *a += factor * b;
                }
            };
            add(&mut self.zone, &other.zone);
            add(&mut self.contact, &other.contact);
        }
    }

    /// Scales this vector and adds another: `self = other + factor * self`.
    pub(crate) fn scale_and_add(&mut self, factor: f64, other: &Trailing) {
        for (own, other) in self.iter_mut().zip(other.iter()) {
            *own = other + factor * *own;
        }
    }

    /// Inner product of two vectors.
    pub fn dot(&self, other: &Trailing) -> f64 {
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        sum(&self.zone, &other.zone) + sum(&self.contact, &other.contact)
    }

    /// Largest absolute value; NaN if any value is NaN.
    pub fn largest(&self) -> f64 {
        let [zone, contact] = [&self.zone, &self.contact].map(|part| linalg::largest(part));
        if zone > contact || zone.is_nan() {
            zone
        } else {
            contact
        }
    }

    /// Copies the values of another vector of the same size.
    pub(crate) fn copy_from(&mut self, other: &Trailing) {
        self.zone.copy_from_slice(&other.zone);
        self.contact.copy_from_slice(&other.contact);
    }

    /// Sets all values to `value`.
    pub fn fill(&mut self, value: f64) {
        self.zone.fill(value);
        self.contact.fill(value);
    }
}

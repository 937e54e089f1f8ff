//! Dense backend.
use super::*;
/// Dense factor.
pub struct DenseCondensed {}
impl DenseCondensed {
    /// Factors.
    pub fn new(_matrix: &SymmetricCsc, _partition: &Partition, _shift: &[f64]) -> Result<Self> {
        unimplemented!()
    }
}
/// Predicts.
pub fn predict(_partition: &Partition) -> Result<Prediction> {
    unimplemented!()
}
impl Condensed for DenseCondensed {
    fn contact_stiffness(&self) -> &DMatrix<f64> {
        unimplemented!()
    }
    fn condense_load(&self, _l: &[f64], _z: &mut [f64], _c: &mut [f64]) -> Result<()> {
        unimplemented!()
    }
    fn eliminate_zone(&self, _z: &mut [f64], _c: &mut [f64]) {
        unimplemented!()
    }
    fn recover_zone(&self, _z: &mut [f64], _u: &[f64]) {
        unimplemented!()
    }
    fn recover_all(&self, _x: &mut [f64], _u: &[f64]) -> Result<()> {
        unimplemented!()
    }
    fn backward_error(&self) -> f64 {
        unimplemented!()
    }
    fn cost(&self) -> Prediction {
        unimplemented!()
    }
}

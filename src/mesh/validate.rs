//! Checks that a mesh can be computed with.
use super::Mesh;
use crate::Result;

/// x
pub fn validate(_mesh: &Mesh) -> Result<()> {
    Ok(())
}

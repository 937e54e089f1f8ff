//! How many points an element is integrated with.

use super::{Rule, Shape};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How quadratic quadrilaterals, hexahedra and prisms are integrated. Other shapes have one rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Integration {
    /// At the points where stress is most accurate: 2 x 2, 2 x 2 x 2, 3 x 2. Does not lock where
    /// the volume stays the same. A single element, or a row of them, has ways to deform that
    /// these points do not see.
    #[default]
    Reduced,
    /// At 3 x 3, 3 x 3 x 3, 3 x 3 points, as `CPE8`, `CPS8`, `CAX8`, `C3D20` and `C3D15` are in
    /// Abaqus and CalculiX: every way to deform has its stiffness. Stiffer where the volume stays
    /// the same, as it does where the material yields.
    Full,
}

impl Integration {
    /// All of them, in the order of their numbers.
    pub const ALL: [Integration; 2] = [Integration::Reduced, Integration::Full];

    /// Whether the integration is the usual one.
    pub(crate) fn is_reduced(&self) -> bool {
        *self == Integration::Reduced
    }
}

impl Shape {
    /// The rule that integrates stiffness and forces.
    pub fn rule(self, integration: Integration) -> &'static Rule {
        match integration {
            Integration::Reduced => self.reference().gauss,
            Integration::Full => self.reference().full,
        }
    }

    /// Number of points of the rule.
    pub(crate) fn n_points(self, integration: Integration) -> usize {
        self.rule(integration).len()
    }
}

//! The choice between reduced and full integration of an element.

use super::{Rule, Shape};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The integration of quadratic quadrilaterals, hexahedra and prisms. Other shapes have one rule
/// only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Integration {
    /// Reduced integration at the points where stress is most accurate: 2 x 2, 2 x 2 x 2, 3 x 2.
    /// Does not lock where the volume is preserved. A single element, or a single row of elements,
    /// has deformation modes without stiffness at these points.
    #[default]
    Reduced,
    /// Full integration at 3 x 3, 3 x 3 x 3, 3 x 3 points, as for `CPE8`, `CPS8`, `CAX8`, `C3D20`
    /// and `C3D15` in Abaqus and CalculiX: every deformation mode has stiffness. Stiffer where the
    /// volume is preserved, as it is in plastic flow.
    Full,
}

impl Integration {
    /// All choices, in the order of their numbers.
    pub const ALL: [Integration; 2] = [Integration::Reduced, Integration::Full];

    /// Whether the integration is the default one, reduced integration.
    pub(crate) fn is_reduced(&self) -> bool {
        *self == Integration::Reduced
    }
}

impl Shape {
    /// The rule that integrates stiffness and forces of the shape.
    pub fn rule(self, integration: Integration) -> &'static Rule {
        match integration {
            Integration::Reduced => self.reference().gauss,
            Integration::Full => self.reference().full,
        }
    }

    /// Number of points of the integration rule.
    pub(crate) fn n_points(self, integration: Integration) -> usize {
        self.rule(integration).len()
    }
}

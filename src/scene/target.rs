//! Targets of the load program: the conditions that are to be reached one after the other.

use super::Direction;
use crate::number::exact;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A target: exactly one of the conditions, with a name and options.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Target {
    /// Name of the state that is recorded when the target is reached.
    pub name: Option<String>,
    /// First yield, given as `yield = true`.
    #[serde(default, rename = "yield")]
    pub first_yield: bool,
    /// A load factor of the program.
    pub load_factor: Option<f64>,
    /// A contact half width, as a multiple of the half width at first yield.
    pub half_width: Option<f64>,
    /// A mean displacement of a node set or a surface.
    pub displacement: Option<DisplacementTarget>,
    /// The dent that remains after the load factor has gone back to zero from this target,
    /// including any yielding on the way back. The dent is the sum over both surfaces of the
    /// contact, or the dent of `body` alone. The target is sought while the load increases.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual_depth: Option<f64>,
    /// The sum of all contact forces, for the whole body, or the force of `contact` alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_force: Option<f64>,
    /// The area, for the whole body, of the contact patch with the largest force, or of `contact`
    /// alone; in plane models the width of the patch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_area: Option<f64>,
    /// The largest contact pressure, or the largest pressure of `contact` alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_pressure: Option<f64>,
    /// The approach of the bodies towards each other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub approach: Option<f64>,
    /// The largest equivalent plastic strain. The target is sought while the load increases.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_equivalent_plastic_strain: Option<f64>,
    /// The body to which `residual_depth` refers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// The contact to which `contact_force`, `contact_area` or `max_pressure` refers: its number in
    /// the scene, counted from 1 as in `contact.csv`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<usize>,
    /// Whether fields (VTU) are written for this state.
    #[serde(default = "super::defaults::yes")]
    pub fields: bool,
}

/// A figure of a state that a target may prescribe, in addition to half width and displacement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TargetFigure {
    /// Dent that stays after unloading.
    ResidualDepth,
    /// Force of contact.
    ContactForce,
    /// Area of contact.
    ContactArea,
    /// Largest contact pressure.
    MaxPressure,
    /// Approach of the bodies.
    Approach,
    /// Largest equivalent plastic strain.
    MaxEquivalentPlasticStrain,
}

impl TargetFigure {
    /// All figures, in the order of their declaration.
    pub const ALL: [TargetFigure; 6] = [
        TargetFigure::ResidualDepth,
        TargetFigure::ContactForce,
        TargetFigure::ContactArea,
        TargetFigure::MaxPressure,
        TargetFigure::Approach,
        TargetFigure::MaxEquivalentPlasticStrain,
    ];

    /// Key of the figure in the scene and in `summary.json`.
    pub fn key(self) -> &'static str {
        match self {
            TargetFigure::ResidualDepth => "residual_depth",
            TargetFigure::ContactForce => "contact_force",
            TargetFigure::ContactArea => "contact_area",
            TargetFigure::MaxPressure => "max_pressure",
            TargetFigure::Approach => "approach",
            TargetFigure::MaxEquivalentPlasticStrain => "max_equivalent_plastic_strain",
        }
    }

    /// Whether the figure belongs to a contact, so that the key `contact` can select one.
    pub fn is_of_contact(self) -> bool {
        matches!(
            self,
            TargetFigure::ContactForce | TargetFigure::ContactArea | TargetFigure::MaxPressure
        )
    }

    /// Whether the figure exists only in a scene with contact.
    pub fn needs_contact(self) -> bool {
        self.is_of_contact() || self == TargetFigure::ResidualDepth
    }

    /// Whether the figure comes from yielding alone, so that unloading does not reduce it.
    pub fn stays(self) -> bool {
        matches!(
            self,
            TargetFigure::ResidualDepth | TargetFigure::MaxEquivalentPlasticStrain
        )
    }
}

impl Target {
    /// The value that the target prescribes for a figure, if it does.
    pub fn value_of(&self, figure: TargetFigure) -> Option<f64> {
        match figure {
            TargetFigure::ResidualDepth => self.residual_depth,
            TargetFigure::ContactForce => self.contact_force,
            TargetFigure::ContactArea => self.contact_area,
            TargetFigure::MaxPressure => self.max_pressure,
            TargetFigure::Approach => self.approach,
            TargetFigure::MaxEquivalentPlasticStrain => self.max_equivalent_plastic_strain,
        }
    }

    /// The figures that the target prescribes, with their values; at most one in a valid scene.
    pub fn figures(&self) -> impl Iterator<Item = (TargetFigure, f64)> {
        let value = |figure| Some((figure, self.value_of(figure)?));
        TargetFigure::ALL.into_iter().filter_map(value)
    }

    /// Whether the load at which the target is reached is a result that depends on yielding or
    /// contact, which is so for a half width or a figure.
    pub fn finds_load(&self) -> bool {
        self.half_width.is_some() || self.figures().next().is_some()
    }

    /// Whether first yield must be known before the target can be sought.
    pub fn needs_first_yield(&self) -> bool {
        let stays = self.figures().any(|(figure, _)| figure.stays());
        self.first_yield || self.half_width.is_some() || stays
    }

    /// Name of the state that is recorded when this target is reached: the given name, or one made
    /// from the condition (`yield`, `alpha 1.0515`, `half width 1.5`,
    /// `displacement of top y = -0.1`, `residual depth 0.001 of flat`). `index` counts from 0 and
    /// gives a name to a target without a condition. [`super::Program::labels`] keeps repeated
    /// names apart.
    pub fn label(&self, index: usize) -> String {
        if let Some(name) = &self.name {
            name.clone()
        } else if self.first_yield {
            "yield".to_string()
        } else if let Some(alpha) = self.load_factor {
            format!("alpha {}", exact(alpha))
        } else if let Some(width) = self.half_width {
            format!("half width {}", exact(width))
        } else if let Some(target) = &self.displacement {
            format!(
                "displacement of {} {} = {}",
                target.on,
                target.direction.name(),
                exact(target.value)
            )
        } else if let Some((figure, value)) = self.figures().next() {
            let body = self.body.as_ref().map(|body| format!(" of {body}"));
            let contact = self.contact.map(|number| format!(" of contact {number}"));
            let part = body.or(contact).unwrap_or_default();
            format!("{} {}{part}", figure.key().replace('_', " "), exact(value))
        } else {
            format!("target {}", index + 1)
        }
    }
}

/// A target displacement: the mean displacement of a set reaches a value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DisplacementTarget {
    /// Node set or surface.
    pub on: String,
    /// Direction of the displacement.
    pub direction: Direction,
    /// Value of the mean displacement.
    pub value: f64,
}

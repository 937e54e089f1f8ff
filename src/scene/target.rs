//! Targets of the load program: what is to be reached next.

use super::Direction;
use crate::number::exact;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A target: exactly one of the conditions.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Target {
    /// Name of the state.
    pub name: Option<String>,
    /// `yield = true`: first yield.
    #[serde(default, rename = "yield")]
    pub first_yield: bool,
    /// A load factor of the program.
    pub load_factor: Option<f64>,
    /// A contact half width, as a multiple of that at first yield.
    pub half_width: Option<f64>,
    /// A displacement.
    pub displacement: Option<DisplacementTarget>,
    /// The dent that stays once the load factor has gone back to zero from there, on the way back
    /// yielding included: that of both surfaces together, or that of `body`. Found in loading.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual_depth: Option<f64>,
    /// The sum of all contact forces of the whole, or the force of `contact`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_force: Option<f64>,
    /// The area of the largest contact patch of the whole, or of that of `contact`; in the plane
    /// its width.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_area: Option<f64>,
    /// The largest contact pressure, or that of `contact`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_pressure: Option<f64>,
    /// The approach of the bodies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub approach: Option<f64>,
    /// The largest equivalent plastic strain. Found in loading.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_equivalent_plastic_strain: Option<f64>,
    /// The body whose `residual_depth` is meant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// The contact that is meant by `contact_force`, `contact_area` or `max_pressure`: its number
    /// in the scene, from 1, as in `contact.csv`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<usize>,
    /// Write fields (VTU) for this state?
    #[serde(default = "super::defaults::yes")]
    pub fields: bool,
}

/// A figure of a state that a target may wait for, besides half width and displacement.
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
    /// All figures, in their order.
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

    /// Whether the figure is one of a contact, of which one may be meant.
    pub fn is_of_contact(self) -> bool {
        matches!(
            self,
            TargetFigure::ContactForce | TargetFigure::ContactArea | TargetFigure::MaxPressure
        )
    }

    /// Whether only a contact has it.
    pub fn needs_contact(self) -> bool {
        self.is_of_contact() || self == TargetFigure::ResidualDepth
    }

    /// Whether yielding alone makes it: unloading does not take it back.
    pub fn stays(self) -> bool {
        matches!(
            self,
            TargetFigure::ResidualDepth | TargetFigure::MaxEquivalentPlasticStrain
        )
    }
}

impl Target {
    /// The value that it asks of a figure, if it does.
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

    /// The figures that it asks for, with their values; one at most in a scene that is valid.
    pub fn figures(&self) -> impl Iterator<Item = (TargetFigure, f64)> {
        let value = |figure| Some((figure, self.value_of(figure)?));
        TargetFigure::ALL.into_iter().filter_map(value)
    }

    /// Whether the load at which it is reached is an answer that depends on what yields or touches:
    /// a half width or a figure.
    pub fn finds_load(&self) -> bool {
        self.half_width.is_some() || self.figures().next().is_some()
    }

    /// Whether first yield is to be known for it.
    pub fn needs_first_yield(&self) -> bool {
        let stays = self.figures().any(|(figure, _)| figure.stays());
        self.first_yield || self.half_width.is_some() || stays
    }

    /// Name of the state that this target leaves: as given, else made from the condition (`yield`,
    /// `alpha 1.0515`, `half width 1.5`, `displacement of top y = -0.1`, `residual depth 0.001 of
    /// flat`). `index` counts from 0 and names a target that has none.
    /// [`super::Program::labels`] keeps repeated names apart.
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

/// A target displacement: the mean over a set reaches a value.
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

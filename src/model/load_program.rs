//! The load program of a model: names of sets, bodies and contacts are resolved.

use super::names::SceneEntry;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::scene::{Scene, Stepping, Target, TargetFigure, Unit};

/// The load program of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadProgram {
    /// Meaning of a load factor of 1.
    pub unit: Unit,
    /// How the increments are chosen. In plane stress `Auto` does not occur, because the path of
    /// plastic flow within an increment is not followed there.
    pub stepping: Stepping,
    /// Number of increments from one target to the next with `Stepping::Steps`.
    pub steps: usize,
    /// Relative error of pressure and dent that the increments of `Stepping::Auto` may cause.
    pub path_error: f64,
    /// Largest number of increments of the whole run.
    pub max_increments: usize,
    /// Relative tolerance with which events are located (paper, eqs. 4.18, 4.23).
    pub gamma: f64,
    /// Load factor up to which the interference of contacts grows; `None` if it is applied before
    /// the load factor leaves zero.
    pub interference_until: Option<f64>,
    /// Largest number of cycles.
    pub cycles: usize,
    /// Fraction of the plastic flow in the first cycle that ends the cycles.
    pub steady: f64,
    /// Load factors at which supports or prescribed displacements begin or end, ascending.
    pub support_changes: Vec<f64>,
    /// The targets, reached one after the other.
    pub targets: Vec<ProgramTarget>,
    /// The sets that every row of the history records.
    pub history: Vec<NodesOfSet>,
}

/// A target of the load program.
#[derive(Debug, Clone, PartialEq)]
pub struct ProgramTarget {
    /// Name of the state that is recorded when the target is reached.
    pub label: String,
    /// Condition that is to be reached.
    pub condition: TargetCondition,
    /// Whether the state is recorded with its fields.
    pub fields: bool,
}

/// The condition that a target of the load program sets.
#[derive(Debug, Clone, PartialEq)]
pub enum TargetCondition {
    /// First yield of any body.
    FirstYield,
    /// A load factor of the program.
    LoadFactor(f64),
    /// A contact half width, as a multiple of the half width at first yield.
    HalfWidth(f64),
    /// A figure of the state.
    Figure(FigureGoal),
    /// A mean displacement of a set.
    Displacement(DisplacementGoal),
}

/// A figure of a state with the value that a target prescribes for it.
#[derive(Debug, Clone, PartialEq)]
pub struct FigureGoal {
    /// The figure that is prescribed.
    pub figure: TargetFigure,
    /// Value of the figure at the target.
    pub value: f64,
    /// Number of the body to which the figure belongs, if the target names one.
    pub body: Option<usize>,
    /// Number of the contact to which the figure belongs, counted from 0, if the target names one.
    pub contact: Option<usize>,
}

/// A mean displacement with the value that a target prescribes for it.
#[derive(Debug, Clone, PartialEq)]
pub struct DisplacementGoal {
    /// Nodes over which the mean is taken, and the name of their set.
    pub of: NodesOfSet,
    /// Axis of the displacement, counted from 0.
    pub axis: usize,
    /// Value of the mean displacement at the target.
    pub value: f64,
}

/// The nodes of a set, with its name in the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct NodesOfSet {
    /// Name of the set.
    pub name: String,
    /// Nodes of the set; at least one.
    pub nodes: Vec<usize>,
}

impl LoadProgram {
    /// Resolves the program of a scene on a mesh.
    ///
    /// # Errors
    /// A set, body or contact that does not exist; a target without a condition, or in a direction
    /// that the model does not have.
    pub(super) fn resolve(scene: &Scene, mesh: &Mesh) -> Result<Self> {
        let program = &scene.program;
        let targets = program.targets.iter().zip(program.labels());
        let targets = targets.enumerate().map(|(index, (target, label))| {
            Ok(ProgramTarget {
                label,
                condition: TargetCondition::resolve(scene, mesh, (index, target))?,
                fields: target.fields,
            })
        });
        let targets = targets.collect::<Result<_>>()?;
        let history = program.history.iter().enumerate().map(|(index, name)| {
            let nodes = SceneEntry::of_history(scene, index).named(mesh, name)?;
            let name = name.clone();
            Ok(NodesOfSet { name, nodes })
        });
        Ok(LoadProgram {
            unit: program.unit,
            stepping: scene.stepping(),
            steps: program.steps,
            path_error: program.path_error,
            max_increments: program.max_increments,
            gamma: program.gamma,
            interference_until: program.interference_until,
            cycles: program.cycles,
            steady: program.steady,
            support_changes: scene.changes_of_support(),
            targets,
            history: history.collect::<Result<_>>()?,
        })
    }

    /// Whether first yield must be known before all targets can be sought.
    pub(crate) fn needs_first_yield(&self) -> bool {
        let needs = |target: &ProgramTarget| match &target.condition {
            TargetCondition::FirstYield | TargetCondition::HalfWidth(_) => true,
            TargetCondition::Figure(goal) => goal.figure.stays(),
            TargetCondition::LoadFactor(_) | TargetCondition::Displacement(_) => false,
        };
        self.unit == Unit::Yield || self.targets.iter().any(needs)
    }
}

impl ProgramTarget {
    /// The load factor at which the target lies, if it is given.
    pub(crate) fn load_factor(&self) -> Option<f64> {
        match self.condition {
            TargetCondition::LoadFactor(alpha) => Some(alpha),
            _ => None,
        }
    }
}

impl TargetCondition {
    fn resolve(scene: &Scene, mesh: &Mesh, (index, target): (usize, &Target)) -> Result<Self> {
        let entry = SceneEntry::of_target(scene, index);
        if target.first_yield {
            return Ok(TargetCondition::FirstYield);
        }
        if let Some(alpha) = target.load_factor {
            return Ok(TargetCondition::LoadFactor(alpha));
        }
        if let Some(multiple) = target.half_width {
            return Ok(TargetCondition::HalfWidth(multiple));
        }
        if let Some((figure, value)) = target.figures().next() {
            let goal = FigureGoal::resolve(scene, mesh, target, (figure, value));
            return goal
                .map(TargetCondition::Figure)
                .map_err(|error| entry.refused(error));
        }
        let Some(goal) = &target.displacement else {
            let why = format!("target {} has no condition", index + 1);
            return Err(entry.refused(Error::input(why)));
        };
        let axis = goal.direction.axis();
        if axis >= mesh.dimension {
            let name = goal.direction.name();
            let why = format!("a plane model has no direction {name}");
            return Err(entry.refused(Error::input(why)));
        }
        let entry = SceneEntry::of_target_displacement(scene, index);
        Ok(TargetCondition::Displacement(DisplacementGoal {
            of: NodesOfSet {
                name: goal.on.clone(),
                nodes: entry.nodes(mesh, &goal.on)?,
            },
            axis,
            value: goal.value,
        }))
    }

    /// Whether the load at which the target is reached is a result that depends on yielding or
    /// contact, which is so for a half width or a figure.
    pub(crate) fn finds_load(&self) -> bool {
        matches!(
            self,
            TargetCondition::HalfWidth(_) | TargetCondition::Figure(_)
        )
    }
}

impl FigureGoal {
    fn resolve(
        scene: &Scene,
        mesh: &Mesh,
        target: &Target,
        (figure, value): (TargetFigure, f64),
    ) -> Result<Self> {
        let body = |name: &String| {
            let number = mesh.bodies.iter().position(|body| body == name);
            number.ok_or_else(|| Error::input(format!("the mesh has no body `{name}`")))
        };
        let contact = |number: usize| {
            let index = number.checked_sub(1);
            let index = index.filter(|index| *index < scene.contact.len());
            index.ok_or_else(|| Error::input(format!("the scene has no contact {number}")))
        };
        Ok(FigureGoal {
            figure,
            value,
            body: target.body.as_ref().map(body).transpose()?,
            contact: target.contact.map(contact).transpose()?,
        })
    }
}

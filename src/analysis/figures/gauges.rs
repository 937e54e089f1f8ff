//! Additional columns of the history, if the scene asks for them: motion and force of sets of
//! nodes; approach, force and area of each contact.

use super::approaches::Approach;
use super::measure::ContactFigures;
use super::reactions;
use super::reading::Reading;
use crate::analysis::structure::solver::Solver;
use crate::error::Result;
use crate::model::{Model, NodesOfSet};
use crate::space::Vector;

/// Names of the axes in column titles.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Gauges that are read after each increment.
pub(in crate::analysis) struct Gauges {
    /// Sets whose motion and force are read.
    sets: Vec<NodesOfSet>,
    /// Approach of the bodies of each contact.
    approaches: Vec<Option<Approach>>,
}

impl Gauges {
    /// The gauges that the program asks for; `None` if it asks for none.
    pub(in crate::analysis) fn of(model: &Model) -> Option<Self> {
        let sets = &model.program.history;
        (!sets.is_empty()).then(|| Gauges {
            sets: sets.clone(),
            approaches: Approach::of_contacts(model),
        })
    }

    /// Names of the columns, in the order of [`Gauges::read`]; empty if the program asks for none.
    pub(in crate::analysis) fn columns(model: &Model) -> Vec<String> {
        let sets = &model.program.history;
        if sets.is_empty() {
            return Vec::new();
        }
        let mut out = vec!["approach".to_string()];
        for number in 1..=model.contacts.len() {
            out.extend(["approach", "force", "area"].map(|key| format!("contact_{number}.{key}")));
        }
        for NodesOfSet { name, .. } in sets {
            for key in ["displacement", "force"] {
                let axes = &AXES[..model.mesh.dimension];
                out.extend(axes.iter().map(|axis| format!("{name}.{key}_{axis}")));
            }
        }
        out
    }

    /// Reads the gauges in the current state. Costs half a full solve and the stresses of all
    /// elements.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub(in crate::analysis) fn read(&self, solver: &mut Solver) -> Result<Vec<f64>> {
        let model = solver.structure.model;
        let mut reading = Reading::of(solver);
        let displacements = reading.displacements()?;
        let stresses = reading.stresses(displacements.deformation(), false)?;
        let mut out = vec![reading.approach(&displacements.total)];
        let moved = model.nodal(&displacements.total, &solver.at.factors);
        for (contact, approach) in self.approaches.iter().enumerate() {
            let figures = ContactFigures::of_contact(solver, contact);
            let approach = approach.as_ref().map_or(f64::NAN, |a| a.at(&moved));
            out.extend([approach, figures.force * model.symmetry, figures.area]);
        }
        let forces = reactions::on_nodes(model, stresses.nodal, &solver.contact_forces());
        let d = model.mesh.dimension;
        let sum = |nodes: &[usize], of: &dyn Fn(usize) -> Vector| -> Vector {
            nodes.iter().fold([0.0; 3], |mut sum, &node| {
                let value = of(node);
                (0..d).for_each(|axis| sum[axis] += value[axis]);
                sum
            })
        };
        for NodesOfSet { nodes, .. } in &self.sets {
            let motion = sum(nodes, &|node| moved[node]);
            let force = sum(nodes, &|node| {
                std::array::from_fn(|axis| {
                    if axis < d {
                        forces[d * node + axis]
                    } else {
                        0.0
                    }
                })
            });
            out.extend(motion[..d].iter().map(|u| u / nodes.len() as f64));
            out.extend(force[..d].iter().map(|f| f * model.symmetry));
        }
        Ok(out)
    }
}

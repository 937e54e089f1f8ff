//! Values at the nodes, block by block.

use super::extrapolated::Extrapolated;
use super::mesh::Numbered;
use super::text;
use crate::model::Model;
use crate::output::slaves::Slaves;
use crate::results::{Fields, State};
use crate::scene::{FileRequest, ResultItem};
use std::io::{self, Write};

/// Values at the nodes in one state.
pub(super) struct NodalValues<'a> {
    model: &'a Model,
    state: &'a State,
    fields: &'a Fields,
    extrapolated: Option<Extrapolated>,
}

/// Values of all nodes, each of `size` components.
pub(super) struct OfNodes {
    size: usize,
    values: Vec<f64>,
}

impl<'a> NodalValues<'a> {
    pub(super) fn new(model: &'a Model, state: &'a State, fields: &'a Fields) -> Self {
        let points = fields.points.as_ref();
        NodalValues {
            model,
            state,
            fields,
            extrapolated: points.map(|points| Extrapolated::new(&model.mesh, points)),
        }
    }

    /// Returns the values of a block; `None` if the state does not have them.
    pub(super) fn of(&self, request: &FileRequest) -> Option<OfNodes> {
        let mut of_nodes = self.along_global(request.item)?;
        if !request.is_global && of_nodes.size == 3 {
            self.turn(&mut of_nodes.values);
        }
        Some(of_nodes)
    }

    /// Converts vectors of nodes with local axes to these axes.
    fn turn(&self, values: &mut [f64]) {
        let (mesh, axes) = (&self.model.mesh, &self.model.scene.requests.axes);
        for (node, vector) in values.chunks_exact_mut(3).enumerate() {
            if let Some(axes) = axes.get(&mesh.node_label(node)) {
                let along = axes.map(|axis| (0..3).map(|d| axis[d] * vector[d]).sum());
                vector.copy_from_slice(&along);
            }
        }
    }

    fn along_global(&self, item: ResultItem) -> Option<OfNodes> {
        let (model, fields) = (self.model, self.fields);
        let extrapolated = self.extrapolated.as_ref();
        match item {
            ResultItem::Displacement => Some(self.vectors(&fields.displacement, 1.0)),
            ResultItem::Force if fields.force.is_empty() => None,
            ResultItem::Force => {
                let thickness = model.scene.requests.thickness.unwrap_or(1.0);
                Some(self.vectors(&fields.force, thickness))
            }
            ResultItem::Stress => extrapolated.map(|of| self.tensors(&of.stress, 1.0)),
            ResultItem::TotalStrain => extrapolated.map(|of| self.tensors(&of.strain, 0.5)),
            ResultItem::PlasticStrain if !model.may_yield.contains(&true) => None,
            ResultItem::PlasticStrain => extrapolated.map(|of| scalars(&of.plastic_strain)),
            ResultItem::Contact => (!model.contacts.is_empty()).then(|| self.contact()),
            ResultItem::RecoveredStress if fields.nodal_stress.is_empty() => None,
            ResultItem::RecoveredStress => Some(self.tensors(&fields.nodal_stress, 1.0)),
            ResultItem::StressJump => {
                let points = fields.points.as_ref();
                let both = extrapolated.zip(points);
                both.map(|(of, points)| scalars(&of.stress_jumps(&model.mesh, points)))
            }
            ResultItem::Volume | ResultItem::Section | ResultItem::ContactForce(_) => None,
        }
    }

    fn vectors(&self, values: &[f64], factor: f64) -> OfNodes {
        let each = values.chunks_exact(self.model.mesh.dimension);
        let in_space = each.flat_map(|v| [v[0], v[1], v.get(2).copied().unwrap_or(0.0)]);
        OfNodes {
            size: 3,
            values: in_space.map(|v| factor * v).collect(),
        }
    }

    /// Returns tensors in the order xx, yy, zz, xy, yz, zx, with the last three multiplied by a
    /// factor.
    fn tensors(&self, values: &[f64], of_shear: f64) -> OfNodes {
        let each = values.chunks_exact(2 * self.model.mesh.dimension);
        let at = |t: &[f64], k: usize| t.get(k).copied().unwrap_or(0.0);
        let in_space = each.flat_map(|t| {
            let shear = |k| of_shear * at(t, k);
            [t[0], t[1], t[2], shear(3), shear(4), shear(5)]
        });
        OfNodes {
            size: 6,
            values: in_space.collect(),
        }
    }

    /// Returns gap, two slips that are not known, pressure, and two shear stresses, which are zero
    /// on frictionless surfaces.
    fn contact(&self) -> OfNodes {
        let mesh = &self.model.mesh;
        let mut values = vec![0.0; 6 * mesh.n_nodes()];
        let slaves = Slaves::new(self.model);
        for pair in &self.state.pairs {
            if let Some(node) = slaves.node(pair) {
                values[6 * node] = slaves.gap(pair);
                values[6 * node + 3] = pair.pressure;
            }
        }
        OfNodes { size: 6, values }
    }
}

fn scalars(values: &[f64]) -> OfNodes {
    OfNodes {
        size: 1,
        values: values.to_vec(),
    }
}

/// Returns the name of a block and the names of its components.
fn names(item: ResultItem) -> (&'static str, &'static [&'static str]) {
    match item {
        ResultItem::Displacement => ("DISP", &["D1", "D2", "D3"]),
        ResultItem::Stress => ("STRESS", &["SXX", "SYY", "SZZ", "SXY", "SYZ", "SZX"]),
        ResultItem::TotalStrain => ("TOSTRAIN", &["EXX", "EYY", "EZZ", "EXY", "EYZ", "EZX"]),
        ResultItem::Force => ("FORC", &["F1", "F2", "F3"]),
        ResultItem::PlasticStrain => ("PE", &["PE"]),
        ResultItem::Contact => (
            "CONTACT",
            &["COPEN", "CSLIP1", "CSLIP2", "CPRESS", "CSHEAR1", "CSHEAR2"],
        ),
        ResultItem::RecoveredStress => ("ZZSTR", &["SXX", "SYY", "SZZ", "SXY", "SYZ", "SZX"]),
        ResultItem::StressJump => ("ERROR", &["STR(%)"]),
        ResultItem::Volume | ResultItem::Section | ResultItem::ContactForce(_) => ("", &[]),
    }
}

/// Writes a block: the description of its components, and the values of some nodes.
pub(super) fn write(
    out: &mut impl Write,
    item: ResultItem,
    (numbered, nodes): (&Numbered, &[usize]),
    of_nodes: &OfNodes,
) -> io::Result<()> {
    let (name, components) = names(item);
    let n = components.len();
    // A vector has its length as an additional component, which readers compute.
    let n_listed = if n == 3 { 4 } else { n };
    writeln!(out, " -4  {name:<8}{n_listed:5}{:5}", 1)?;
    const PLACES: [[usize; 2]; 6] = [[1, 1], [2, 2], [3, 3], [1, 2], [2, 3], [3, 1]];
    for (k, component) in components.iter().enumerate() {
        let (kind, [row, column]) = match n {
            1 => (1, [0, 0]),
            3 => (2, [k + 1, 0]),
            _ => (4, PLACES[k]),
        };
        writeln!(out, " -5  {component:<8}{:5}{kind:5}{row:5}{column:5}", 1)?;
    }
    if n == 3 {
        let all = "ALL";
        writeln!(out, " -5  {all:<8}{:5}{:5}{:5}{:5}{:5}ALL", 1, 2, 0, 0, 1)?;
    }
    let mut line = String::new();
    for &node in nodes {
        line.clear();
        let values = &of_nodes.values[of_nodes.size * node..][..n];
        values
            .iter()
            .for_each(|value| text::number(*value, &mut line));
        writeln!(out, " -1{:10}{line}", numbered.label(node))?;
    }
    writeln!(out, " -3")
}

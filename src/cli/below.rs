//! `brinell view DIR --below FILE`: the stresses below the centre of a contact as a table.

use super::fresh;
use super::streams::print;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::output::{self, Recorded};
use crate::results::State;
use nalgebra::Matrix3;
use std::path::Path;

/// Largest distance of a node from the line at which the node counts as on the line, relative to
/// the size of the mesh: round-off.
const ON_LINE: f64 = 1e-9;

/// Writes a row for each state with fields and each node on the line x = 0 (in solids x = y = 0),
/// body by body: place along y (solids: z), recovered stresses, von Mises stress, largest shear.
///
/// # Errors
/// Errors of [`output::read`]; `Input` if no node lies on the line or no state has fields; `Io` if
/// the file exists already.
pub(super) fn write(dir: &Path, file: &Path) -> Result<()> {
    let within = |text: &str| Error::input(format!("{}: {text}", dir.display()));
    let recorded = output::read(dir)?;
    let nodes = on_line(&recorded.model);
    if nodes.is_empty() {
        return Err(within(
            "no node lies on the line x = 0 (in solids x = y = 0), below which a contact is taken \
             to be",
        ));
    }
    let (table, rows) = table(&recorded, &nodes)?;
    if rows == 0 {
        return Err(within(
            "no state has stresses at nodes: run with `fields = true` of its targets",
        ));
    }
    fresh::write(&[(file, &table)])?;
    print(&format!("{rows} rows written to {}\n", file.display()))
}

/// A node on the line, with its body.
struct OnLine {
    body: usize,
    node: usize,
    place: f64,
}

/// Returns the nodes on the line, body by body, from the lowest to the highest.
fn on_line(model: &Model) -> Vec<OnLine> {
    let mesh = &model.mesh;
    let along = mesh.dimension - 1;
    let points = (0..mesh.n_nodes()).map(|node| mesh.point(node));
    let size = points.flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let mut nodes = Vec::new();
    for element in 0..mesh.n_elements() {
        for &node in mesh.nodes(element) {
            let point = mesh.point(node as usize);
            if point[..along].iter().all(|x| x.abs() <= ON_LINE * size) {
                nodes.push(OnLine {
                    body: mesh.element_body[element] as usize,
                    node: node as usize,
                    place: point[along],
                });
            }
        }
    }
    nodes.sort_by(|a, b| {
        let places = a.place.total_cmp(&b.place);
        a.body.cmp(&b.body).then(places).then(a.node.cmp(&b.node))
    });
    nodes.dedup_by_key(|on_line| (on_line.body, on_line.node));
    nodes
}

/// Returns the table and its number of rows.
fn table(recorded: &Recorded, nodes: &[OnLine]) -> Result<(Vec<u8>, usize)> {
    let model = &recorded.model;
    let components = model.kind.components();
    let failed = |cause| Error::internal("a table cannot be written to memory").because(cause);
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut heading = vec!["state", "name", "alpha", "body"];
    heading.push(if model.kind.is_solid() { "z" } else { "y" });
    heading.extend(components);
    heading.extend(["von_mises", "largest_shear"]);
    writer.write_record(&heading).map_err(failed)?;
    let mut rows = 0;
    for (number, state) in (1..).zip(&recorded.results.states) {
        for on_line in nodes {
            let Some(stress) = stress(state, on_line.node, components.len()) else {
                continue;
            };
            let mut cells = vec![number.to_string(), state.name.clone()];
            cells.push(state.alpha.to_string());
            cells.push(model.mesh.bodies[on_line.body].clone());
            cells.push(on_line.place.to_string());
            cells.extend(stress.iter().map(f64::to_string));
            cells.extend(invariants(stress).map(|value| value.to_string()));
            writer.write_record(&cells).map_err(failed)?;
            rows += 1;
        }
    }
    let table = writer.into_inner();
    let table = table.map_err(|cause| {
        Error::internal("a table cannot be written to memory").because(cause.into_error())
    })?;
    Ok((table, rows))
}

/// Returns the recovered stress at a node, if the state has it.
fn stress(state: &State, node: usize, components: usize) -> Option<&[f64]> {
    let fields = state.fields.as_ref()?;
    let from = components * node;
    fields.nodal_stress.get(from..from + components)
}

/// Returns the von Mises stress, and half the difference of the largest and the smallest principal
/// stress.
fn invariants(stress: &[f64]) -> [f64; 2] {
    let mut six = [0.0; 6];
    for (component, value) in six.iter_mut().zip(stress) {
        *component = *value;
    }
    let [xx, yy, zz, xy, yz, zx] = six;
    let principal = Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz).symmetric_eigenvalues();
    let [a, b, c] = [principal[0], principal[1], principal[2]];
    let von_mises = (0.5 * ((a - b).powi(2) + (b - c).powi(2) + (c - a).powi(2))).sqrt();
    [von_mises, 0.5 * (principal.max() - principal.min())]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariants_of_known_stresses() {
        // Tension of a bar, and pure shear, in the plane and in space.
        for (stress, von_mises, shear) in [
            (&[0.0, -7.0, 0.0, 0.0][..], 7.0, 3.5),
            (&[0.0, 0.0, 0.0, 2.0], 12f64.sqrt(), 2.0),
            (&[0.0, 0.0, 0.0, 0.0, 0.0, 2.0], 12f64.sqrt(), 2.0),
            (&[3.0, 3.0, 3.0, 0.0, 0.0, 0.0], 0.0, 0.0),
        ] {
            let [found, found_shear] = invariants(stress);
            assert!((found - von_mises).abs() < 1e-12, "{stress:?}: {found}");
            assert!((found_shear - shear).abs() < 1e-12, "{stress:?}");
        }
    }
}

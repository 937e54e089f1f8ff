//! Tables of displacements, forces and stresses as `*NODE PRINT` and `*EL PRINT` of CalculiX write
//! them.
//!
//! For each state with fields and each set: displacements and forces of its nodes with their sum,
//! of node sets and surfaces; mean stresses of its elements (integration point 0), of bodies. The
//! time of a state is its load factor. Forces are what acts from outside: loads and reactions; of
//! an axisymmetric model those on the whole circle.

use crate::error::{Error, Result};
use crate::model::Model;
use crate::results::{Fields, Results};
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes the tables of all states of a run that have fields into a file.
///
/// # Errors
/// [`crate::ErrorKind::Io`] naming the file.
pub fn write_dat(path: &Path, model: &Model, results: &Results) -> Result<()> {
    let failed = |cause| Error::io("write", path, cause);
    let file = std::fs::File::create(path).map_err(failed)?;
    let mut out = BufWriter::new(file);
    write(&mut out, model, results)
        .and_then(|()| out.flush())
        .map_err(failed)
}

fn write(out: &mut impl Write, model: &Model, results: &Results) -> std::io::Result<()> {
    for state in &results.states {
        let Some(fields) = &state.fields else {
            continue;
        };
        let time = scientific(state.alpha);
        for name in model.mesh.set_names() {
            let nodes = model.mesh.set_nodes(name).unwrap_or_default();
            let of = |what: &str| format!(" {what} for set {name} and time {time}\n");
            writeln!(out, "{}", of("displacements (vx,vy,vz)"))?;
            of_nodes(out, model, &nodes, &fields.displacement)?;
            if fields.force.is_empty() {
                continue;
            }
            writeln!(out, "\n{}", of("forces (fx,fy,fz)"))?;
            of_nodes(out, model, &nodes, &fields.force)?;
            writeln!(out, "\n{}", of("total force (fx,fy,fz)"))?;
            let mut sum = [0.0; 3];
            for &node in &nodes {
                let force = vector(model, node, &fields.force);
                (0..3).for_each(|d| sum[d] += force[d]);
            }
            writeln!(out, "{:10}{}\n", "", row(&sum))?;
        }
        for (body, name) in model.mesh.bodies.iter().enumerate() {
            let head = "stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz)";
            writeln!(out, " {head} for set {name} and time {time}\n")?;
            of_elements(out, model, body, fields)?;
            writeln!(out)?;
        }
    }
    Ok(())
}

fn vector(model: &Model, node: usize, values: &[f64]) -> [f64; 3] {
    let d = model.mesh.dimension;
    let own = &values[d * node..d * (node + 1)];
    std::array::from_fn(|k| own.get(k).copied().unwrap_or(0.0))
}

fn of_nodes(
    out: &mut impl Write,
    model: &Model,
    nodes: &[usize],
    values: &[f64],
) -> std::io::Result<()> {
    for &node in nodes {
        let label = model.mesh.node_label(node);
        writeln!(out, "{label:10}{}", row(&vector(model, node, values)))?;
    }
    Ok(())
}

fn of_elements(
    out: &mut impl Write,
    model: &Model,
    body: usize,
    fields: &Fields,
) -> std::io::Result<()> {
    let mesh = &model.mesh;
    let components = if mesh.is_solid() { 6 } else { 4 };
    let own = (0..mesh.n_elements()).filter(|&e| mesh.element_body[e] as usize == body);
    for e in own {
        let stress = &fields.stress[components * e..components * (e + 1)];
        let at = |k: usize| stress.get(k).copied().unwrap_or(0.0);
        // Ours run xx, yy, zz, xy, yz, zx.
        let stress = [0, 1, 2, 3, 5, 4].map(at);
        writeln!(out, "{:10}{:4}{}", mesh.element_label(e), 0, row(&stress))?;
    }
    Ok(())
}

fn row(values: &[f64]) -> String {
    let each = values
        .iter()
        .map(|&value| format!(" {:>13}", scientific(value)));
    each.collect()
}

/// Seven digits with an exponent of two, as C prints them.
fn scientific(value: f64) -> String {
    let text = format!("{value:.6E}");
    let Some((digits, exponent)) = text.split_once('E') else {
        return text;
    };
    match exponent.strip_prefix('-') {
        Some(exponent) => format!("{digits}E-{exponent:0>2}"),
        None => format!("{digits}E+{exponent:0>2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::scientific;

    #[test]
    fn numbers_are_written_as_c_does() {
        for (value, text) in [
            (0.0, "0.000000E+00"),
            (-1.5e-7, "-1.500000E-07"),
            (2.0, "2.000000E+00"),
            (1e120, "1.000000E+120"),
        ] {
            assert_eq!(scientific(value), text);
        }
    }
}

//! The dent as both programs can be asked for it: the largest change of the gap once all loads are
//! off, that of the outermost pair taken off. (brinell's own, `residual_depth`, takes off the rigid
//! motion of each body's far boundary, which CalculiX's results do not have.)

use super::process::Failure;
use brinell::model::Model;
use std::path::Path;

/// Of pairs: gap at the start, and by how much it is wider.
pub fn beside_outermost(opened: &[(f64, f64)]) -> f64 {
    let outermost = opened.iter().max_by(|a, b| a.0.total_cmp(&b.0));
    let outermost = outermost.map_or(f64::NAN, |pair| pair.1);
    opened.iter().map(|o| o.1 - outermost).fold(0.0, f64::max)
}

/// Of the state `unloaded` in a result directory.
pub fn of_results(out: &Path, model: &Model) -> Result<f64, Failure> {
    let table = std::fs::read_to_string(out.join("contact.csv"))?;
    let mut lines = table.lines();
    let keys: Vec<&str> = lines.next().ok_or("no table")?.split(',').collect();
    let column = |key: &str| keys.iter().position(|k| *k == key).ok_or("no such column");
    let (pair, gap, name) = (column("pair")?, column("gap")?, column("name")?);
    let mut opened = Vec::new();
    for line in lines {
        let fields: Vec<&str> = line.split(',').collect();
        if fields.get(name) == Some(&"unloaded") {
            let first = model.pairs[fields[pair].parse::<usize>()? - 1].gap;
            opened.push((first, fields[gap].parse::<f64>()? - first));
        }
    }
    Ok(beside_outermost(&opened))
}

//! The estimated errors, as one table: a row per state, a column per quantity; and where the
//! bodies of closed forms end.

use super::super::table::{Column::*, Table};
use super::Report;
use crate::mesh::generate::contact_size;
use crate::number::significant;
use crate::output::ending::in_words;
use crate::output::stated_errors::StatedErrors;
use crate::results::Accuracy;
use crate::scene::Scene;

/// Where the bodies of a generated contact end: closed forms are of bodies without end.
pub(super) fn far_boundary(scene: &Scene) -> Option<String> {
    let mesh = &scene.mesh;
    let solid = (mesh.curved_bodies.as_ref()).map(|p| (p.far_size, "half axes"));
    let plane = mesh.cylinder_on_half_plane.as_ref();
    let plane = plane.map(|p| (contact_size::far_size(scene, p), "half widths"));
    let (far, of) = solid.or(plane)?;
    Some(format!(
        "Closed forms are of bodies without end; these end at {} {of} at first yield. No mesh of \
         the same `far_size` shows what that changes: twice the size does.",
        significant(far, 3)
    ))
}

impl Report {
    /// Stated errors relative to the largest size of each quantity, and the largest of each kind of
    /// error below them.
    pub(super) fn accuracy(&mut self, accuracy: &Accuracy) {
        if let Some(stated) = StatedErrors::of(accuracy, &self.labels) {
            self.stated_errors(&stated);
        }
        if let Some(demand) = &accuracy.demand {
            self.list(&in_words(demand), &demand.choices);
        }
        self.list("Error estimate", &accuracy.notes);
    }

    fn stated_errors(&mut self, stated: &StatedErrors) {
        let mut columns = vec![(Text, "may be wrong by [%]")];
        columns.extend(stated.columns.iter().map(|heading| (Number, *heading)));
        let mut table = Table::new(&columns);
        for (name, errors) in &stated.states {
            table.row([vec![name.clone()], errors.clone()].concat());
        }
        for (index, (kind, largest)) in stated.kinds.iter().enumerate() {
            let name = match index {
                0 => format!("estimated, at most: {kind}"),
                _ => kind.to_string(),
            };
            table.row([vec![format!("{name:>24}")], largest.clone()].concat());
        }
        self.section(
            "Estimated errors (% of the largest size that the quantity has in this run)",
            &table,
        );
        self.lines(&format!("  {}", stated.method));
    }
}

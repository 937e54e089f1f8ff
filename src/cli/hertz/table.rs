//! The figures of a contact as tables for a reader.

use super::sheet::{BodySheet, PeakSheet, Sheet};
use crate::cli::table::{ColumnAlignment, Table, page_width, wrap};
use crate::number::{exact, significant, trimmed};

/// Number of significant digits printed: more than any measured modulus has.
const DIGITS: usize = 6;

/// Returns the tables of both bodies, the contact and the stresses below it, with notes on their
/// meaning.
pub(super) fn text(sheet: &Sheet) -> String {
    let page = page_width();
    let title = match sheet.contact {
        "point" => "Hertz's contact: a circle",
        "ellipse" => "Hertz's contact: an ellipse",
        _ => "Hertz's contact: a line, loads per length",
    };
    let notes: String = notes(sheet)
        .iter()
        .flat_map(|note| wrap(note, page))
        .map(|line| line + "\n")
        .collect();
    format!(
        "{title}\n\n{}\n{}\n{notes}",
        bodies(sheet).render(page),
        figures(sheet).render(page)
    )
}

fn bodies(sheet: &Sheet) -> Table {
    let units = &sheet.units;
    let mut table = Table::new(&[
        (ColumnAlignment::Text, "body".to_string()),
        (
            ColumnAlignment::Number,
            format!("radii\n[{}]", units.length),
        ),
        (ColumnAlignment::Number, format!("E\n[{}]", units.stress)),
        (ColumnAlignment::Number, "nu".to_string()),
        (
            ColumnAlignment::Number,
            format!("yield stress\n[{}]", units.stress),
        ),
        (ColumnAlignment::Text, "material".to_string()),
    ]);
    for body in &sheet.bodies {
        let radius = |radius: Option<f64>| radius.map_or("flat".to_string(), exact);
        table.row([
            body.name.to_string(),
            body.radii.map(radius).join(", "),
            (body.youngs_modulus).map_or("rigid".to_string(), |e| trimmed(e, DIGITS)),
            trimmed(body.poissons_ratio, DIGITS),
            (body.yield_stress).map_or("none".to_string(), |y| trimmed(y, DIGITS)),
            body.material.clone().unwrap_or_default(),
        ]);
    }
    table
}

/// A table of named figures with units and sources.
struct FigureTable<'s> {
    sheet: &'s Sheet,
    table: Table,
}

impl FigureTable<'_> {
    fn add(&mut self, name: &str, value: f64, unit: &str, source: &str) {
        self.table.row([
            name.to_string(),
            significant(value, DIGITS),
            unit.to_string(),
            source.to_string(),
        ]);
    }

    /// Adds a stress and the depth at which it occurs.
    fn peak(&mut self, name: &str, peak: &PeakSheet, source: &str) {
        let units = &self.sheet.units;
        self.add(name, peak.stress, &units.stress, source);
        self.add("- its depth", peak.depth, &units.length, "");
    }
}

fn figures(sheet: &Sheet) -> Table {
    let columns = [
        (ColumnAlignment::Text, "figure"),
        (ColumnAlignment::Number, "value"),
        (ColumnAlignment::Text, "unit"),
        (ColumnAlignment::Text, "source"),
    ];
    let mut figures = FigureTable {
        sheet,
        table: Table::new(&columns),
    };
    of_contact(&mut figures);
    let shear = &sheet.orthogonal_shear;
    let source = "Lundberg, Palmgren 1947";
    figures.peak(
        "orthogonal shear, rolling along b",
        &shear.along_smaller,
        source,
    );
    let along_larger = shear.along_larger.as_ref();
    if let Some(along_larger) = along_larger.filter(|_| sheet.contact == "ellipse") {
        figures.peak("orthogonal shear, rolling along a", along_larger, source);
    }
    for (whose, body) in distinct(sheet) {
        of_body(&mut figures, whose, body);
    }
    figures.table
}

fn of_contact(figures: &mut FigureTable) {
    let sheet = figures.sheet;
    let units = &sheet.units;
    let (length, stress) = (units.length.as_str(), units.stress.as_str());
    let is_line = sheet.contact == "line";
    let load_unit = load_unit(sheet);
    figures.add("load", sheet.load, &load_unit, "");
    if let Some(total) = sheet.total_load {
        figures.add("load over the length", total, &units.force, "");
    }
    figures.add(
        "contact modulus E*",
        sheet.contact_modulus,
        stress,
        "Johnson p. 92",
    );
    for (name, radius) in ["relative radius R'", "relative radius R''"]
        .iter()
        .zip(sheet.relative_radii)
    {
        if let Some(radius) = radius {
            figures.add(name, radius, length, "Johnson p. 85");
        }
    }
    let (of_pressure, of_axes) = match is_line {
        true => ("Johnson (4.45)", "Johnson (4.43)"),
        false => ("Johnson sec. 4.2", "Johnson sec. 4.2"),
    };
    figures.add(
        "greatest pressure p0",
        sheet.max_pressure,
        stress,
        of_pressure,
    );
    figures.add(
        "mean pressure",
        sheet.mean_pressure,
        stress,
        "load over area",
    );
    match sheet.semi_axes {
        [Some(a), Some(b)] => {
            figures.add("half axis a", a, length, of_axes);
            figures.add("half axis b", b, length, of_axes);
            if a != b {
                figures.add("direction of a", sheet.direction, "degrees", "");
            }
        }
        [_, b] => figures.add("half width b", b.unwrap_or(0.0), length, of_axes),
    }
    if let Some(area) = sheet.area {
        figures.add("area", area, &format!("{length}^2"), "");
    }
    if let Some(approach) = sheet.approach {
        let source = match is_line {
            true => "Johnson sec. 5.6",
            false => "Johnson sec. 4.2",
        };
        figures.add("approach", approach, length, source);
    }
    if let Some(stiffness) = sheet.stiffness {
        let unit = format!("{load_unit}/{length}");
        figures.add("stiffness", stiffness, &unit, "its slope");
    }
}

fn load_unit(sheet: &Sheet) -> String {
    match sheet.contact {
        "line" => format!("{}/{}", sheet.units.force, sheet.units.length),
        _ => sheet.units.force.clone(),
    }
}

/// Returns the bodies with their names; a single entry if the same stresses arise in both.
fn distinct(sheet: &Sheet) -> Vec<(&'static str, &BodySheet)> {
    let [first, second] = &sheet.bodies;
    let inside = |body: &BodySheet| {
        let is_rigid = body.youngs_modulus.is_none();
        (body.poissons_ratio, body.yield_stress, is_rigid)
    };
    match inside(first) == inside(second) {
        true => vec![("either body", first)],
        false => vec![("first body", first), ("second body", second)],
    }
}

fn of_body(figures: &mut FigureTable, whose: &str, body: &BodySheet) {
    let sheet = figures.sheet;
    let of = |figure: &str| format!("{figure}, {whose}");
    let field = match sheet.contact {
        "line" => "McEwen 1949",
        _ => "Sackfield, Hills 1983",
    };
    if let Some(peak) = &body.largest_shear {
        figures.peak(&of("largest shear"), peak, field);
    }
    if let Some(peak) = &body.largest_von_mises {
        figures.peak(&of("largest von Mises stress"), peak, field);
    }
    if let Some(first) = &body.first_yield {
        let units = &sheet.units;
        figures.add(
            &of("load at first yield"),
            first.load,
            &load_unit(sheet),
            "von Mises",
        );
        figures.add(
            "- greatest pressure then",
            first.max_pressure,
            &units.stress,
            "",
        );
        figures.add("- its depth", first.depth, &units.length, "");
    }
}

fn notes(sheet: &Sheet) -> Vec<String> {
    let mut notes = Vec::new();
    for (whose, body) in distinct(sheet) {
        let first = body.first_yield.as_ref();
        // The tolerance is the round-off of a load that was found from the yield stress.
        if let Some(first) = first.filter(|first| sheet.load > first.load * (1.0 + 1e-9)) {
            notes.push(format!(
                "Yield of {whose} from {} {} on: beyond it these figures are of elastic bodies, \
                 and `brinell new` writes a scene for the elastic-plastic ones.",
                significant(first.load, 4),
                load_unit(sheet)
            ));
        }
    }
    if sheet.contact == "line" && sheet.approach.is_none() {
        notes.push(
            "No approach: in the plane it depends on the size of the bodies. It is counted to the \
             axis of a cylinder and to a depth (--depth) of a flat body; for a hollow one there is \
             no closed form."
                .to_string(),
        );
    }
    let of_bodies = sheet.bodies.iter().flat_map(|body| body.radii).flatten();
    let tightest = of_bodies.map(f64::abs).fold(f64::INFINITY, f64::min);
    let [large, small] = sheet.semi_axes;
    let longest = large.or(small).unwrap_or(0.0);
    notes.push(format!(
        "Elastic, without friction, and small compared with the radii: the contact reaches {} of \
         the smallest of them. Johnson: Contact Mechanics, Cambridge 1985.",
        significant(longest / tightest, 2)
    ));
    notes
}

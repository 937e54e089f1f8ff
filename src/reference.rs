//! Published and exact values compared with the computed ones, as a scene's `[[reference]]` entries
//! ask for. No code that computes, estimates or chooses uses these values.

mod place;
mod pressure;

pub use pressure::hertz_pressure;

use crate::analytical::{self, DiscInPlate, HertzEllipse, HertzLine, HertzPoint, Plane};
use crate::model::Model;
use crate::results::{ReferenceRow, Results, YieldPoint, value};
use crate::scene::{Kind, TwoBodies};

/// Stores the rows of all reference entries of the scene in its results ([`Results::reference`]).
pub fn compare(model: &Model, results: &mut Results) {
    results.reference = rows(model, results);
}

fn rows(model: &Model, results: &Results) -> Vec<ReferenceRow> {
    let mut rows = Vec::new();
    for entry in &model.scene.reference {
        if let Some(hertz) = entry.hertz_line {
            rows.extend(hertz_line(model, results, hertz.radius).unwrap_or_default());
        }
        if let Some(hertz) = entry.hertz_point {
            rows.extend(hertz_point(model, results, hertz.radius).unwrap_or_default());
        }
        if let Some(bodies) = entry.hertz_ellipse {
            rows.extend(hertz_ellipse(model, results, bodies).unwrap_or_default());
        }
        if entry.disc_in_plate.is_some() {
            rows.extend(disc_in_plate(model, results).unwrap_or_default());
        }
        let computed = || match &entry.at {
            Some(_) => place::value(model, results, entry),
            None => value(results, entry.quantity.as_ref()?),
        };
        if let (Some(quantity), Some(exact)) = (&entry.quantity, entry.value)
            && let Some(computed) = computed()
        {
            let source = entry.source.as_deref().unwrap_or("scene");
            rows.push(row(quantity, exact, computed, None, source));
        }
    }
    rows
}

fn row(
    quantity: &str,
    reference: f64,
    computed: f64,
    published: Option<f64>,
    source: &str,
) -> ReferenceRow {
    ReferenceRow {
        quantity: quantity.to_string(),
        reference,
        computed,
        ratio: computed / reference,
        published_ratio: published,
        source: source.to_string(),
    }
}

/// Returns the rows at first yield: load, largest pressure, half width and depth below the surface,
/// with the published ratios of computed to exact values.
fn at_yield(
    model: &Model,
    first: &YieldPoint,
    exact: [f64; 4],
    published: [Option<f64>; 4],
    source: &str,
) -> Vec<ReferenceRow> {
    let down = model.mesh.dimension - 1;
    let depth = ["yield.location.y", "yield.location.z"][down - 1];
    let [load, pressure, half_width, below] = exact;
    // Bodies of the same material yield alike on either side of the surface, which is at 0: the
    // exact depth takes the sign of the depth at which yield was found.
    let below = below.copysign(first.location[down]);
    let [a, b, c, d] = published;
    vec![
        row("yield.load", load, first.load, a, source),
        row(
            "yield.max_pressure",
            pressure,
            first.max_pressure,
            b,
            source,
        ),
        row("yield.half_width", half_width, first.half_width, c, source),
        row(depth, below, first.location[down], d, source),
    ]
}

/// Returns the contact modulus of the first two bodies, and Poisson's ratio and yield stress of the
/// body that yields first; `None` if a yield stress depends on depth.
fn moduli(model: &Model) -> Option<(f64, f64, f64)> {
    if model.yield_by_depth.iter().any(Option::is_some) {
        return None;
    }
    let (a, b) = (model.materials.first()?, model.materials.get(1)?);
    let modulus = analytical::contact_modulus(
        a.youngs_modulus,
        a.poissons_ratio,
        b.youngs_modulus,
        b.poissons_ratio,
    );
    let weaker = [a, b]
        .into_iter()
        .min_by(|x, y| x.yield_stress().total_cmp(&y.yield_stress()))?;
    Some((modulus, weaker.poissons_ratio, weaker.yield_stress()))
}

fn hertz_line(model: &Model, results: &Results, radius: f64) -> Option<Vec<ReferenceRow>> {
    let (modulus, nu, y) = moduli(model)?;
    let hertz = HertzLine::new(radius, modulus).ok()?;
    let exact = [
        hertz.yield_load(nu, y),
        HertzLine::yield_pressure(nu, y),
        hertz.yield_half_width(nu, y),
        hertz.yield_depth(nu, y),
    ];
    let published = [Some(0.87), Some(0.94), Some(0.98), Some(0.94)];
    let table = "Table I; Johnson, Contact Mechanics, sections 4.2 and 6.1";
    Some(at_yield(
        model,
        results.first_yield.as_ref()?,
        exact,
        published,
        table,
    ))
}

fn hertz_point(model: &Model, results: &Results, radius: f64) -> Option<Vec<ReferenceRow>> {
    let (modulus, nu, y) = moduli(model)?;
    let hertz = HertzPoint::new(radius, modulus).ok()?;
    let exact = [
        hertz.yield_load(nu, y),
        HertzPoint::yield_pressure(nu, y),
        hertz.yield_contact_radius(nu, y),
        hertz.yield_depth(nu, y),
    ];
    let source = "Johnson, Contact Mechanics, sections 3.4 and 6.1";
    Some(at_yield(
        model,
        results.first_yield.as_ref()?,
        exact,
        [None; 4],
        source,
    ))
}

fn hertz_ellipse(model: &Model, results: &Results, bodies: TwoBodies) -> Option<Vec<ReferenceRow>> {
    let (modulus, nu, y) = moduli(model)?;
    let radii = HertzEllipse::relative_radii(bodies.first, bodies.second).ok()?;
    let hertz = HertzEllipse::new(radii, modulus).ok()?;
    let load = hertz.yield_load(nu, y);
    let [a, b] = hertz.semi_axes(load);
    let exact = [
        load,
        hertz.yield_pressure(nu, y),
        a.min(b),
        hertz.yield_depth(nu, y),
    ];
    let source = "Johnson, Contact Mechanics, section 4.2; analytical::HertzEllipse";
    Some(at_yield(
        model,
        results.first_yield.as_ref()?,
        exact,
        [None; 4],
        source,
    ))
}

fn disc_in_plate(model: &Model, results: &Results) -> Option<Vec<ReferenceRow>> {
    let first = results.first_yield?;
    let radius = model.contacts.first()?.circle?.1;
    let exact = DiscInPlate::new(radius).ok()?;
    let (nu, y) = moduli(model).map(|(_, nu, y)| (nu, y))?;
    let plane = if model.kind == Kind::PlaneStress {
        Plane::Stress
    } else {
        Plane::Strain
    };
    let tension = first.load;
    let table = "Table II; integral equation of the receding contact (analytical::DiscInPlate)";
    let mut rows = vec![
        row(
            "yield.load",
            exact.yield_tension(plane, nu, y).ok()?,
            tension,
            Some(1.002),
            table,
        ),
        row(
            "yield.half_width",
            radius * exact.half_angle(),
            first.half_width,
            Some(1.0),
            table,
        ),
    ];
    if let Some(state) = results.states.first().filter(|s| s.load == tension) {
        rows.push(row(
            "states.0.pole_pressure",
            exact.pressure(0.0, tension),
            state.pole_pressure,
            None,
            table,
        ));
        if let Some([_, to]) = state.contact_arc {
            rows.push(row(
                "states.0.contact_arc.to",
                exact.half_angle().to_degrees(),
                to,
                Some(1.0),
                table,
            ));
        }
    }
    Some(rows)
}

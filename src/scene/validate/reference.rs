//! Validation of the reference values.

use super::problems::Problems;
use super::program::check_yield_known;
use crate::scene::{PlaceQuantity, Reference, Scene};

pub(super) fn check(problems: &mut Problems, scene: &Scene) {
    for (index, reference) in scene.reference.iter().enumerate() {
        let key = format!("reference.{index}");
        problems.exactly_one(
            key.as_str(),
            "reference",
            &[
                ("hertz_line", reference.hertz_line.is_some()),
                ("hertz_point", reference.hertz_point.is_some()),
                ("hertz_ellipse", reference.hertz_ellipse.is_some()),
                ("disc_in_plate", reference.disc_in_plate.is_some()),
                (
                    "quantity (with value and source)",
                    reference.quantity.is_some(),
                ),
            ],
        );
        check_place(problems, &key, reference, scene);
        let single = reference.quantity.is_some();
        for (name, given) in [
            ("value", reference.value.is_some()),
            ("source", reference.source.is_some()),
        ] {
            problems.require(
                given == single,
                format!("{key}.{name}"),
                if single {
                    format!(
                        "is missing: a single value needs quantity, value and source, and \
                         `{name}` is not given"
                    )
                } else {
                    "belongs to a `quantity`, which is not given".to_string()
                },
            );
        }
        for (name, circle, axisymmetric) in [
            ("hertz_line", reference.hertz_line, false),
            ("hertz_point", reference.hertz_point, true),
        ] {
            let Some(circle) = circle else { continue };
            problems.positive(format!("{key}.{name}.radius"), circle.radius);
            problems.require(
                scene.kind.is_axisymmetric() == axisymmetric,
                format!("{key}.{name}"),
                if axisymmetric {
                    "point contact needs kind = \"axisymmetric\""
                } else {
                    "line contact needs a plane model, this one is axisymmetric"
                },
            );
            check_yield_known(
                problems,
                &format!("{key}.{name}"),
                "values at first yield",
                scene,
            );
        }
        if reference.hertz_ellipse.is_some() {
            let key = format!("{key}.hertz_ellipse");
            problems.require(
                scene.kind.is_solid(),
                key.as_str(),
                "elliptical contact needs kind = \"solid\"",
            );
            check_yield_known(problems, &key, "values at first yield", scene);
        }
        problems.require(
            reference.disc_in_plate.is_none()
                || !(scene.kind.is_axisymmetric() || scene.kind.is_solid()),
            format!("{key}.disc_in_plate"),
            "is the solution of a plane model, this one is not",
        );
    }
}

/// Requires coordinates for a quantity at a point, and refuses them for any other quantity.
fn check_place(problems: &mut Problems, key: &str, reference: &Reference, scene: &Scene) {
    let path = reference.quantity.as_deref();
    let of_place = path.is_some_and(|path| PlaceQuantity::of(path, scene.kind).is_some());
    let n = scene.kind.dimension();
    match (&reference.at, of_place) {
        (Some(at), true) => problems.require(
            at.len() == n,
            format!("{key}.at"),
            format!("needs {n} coordinates, {} are given", at.len()),
        ),
        (None, true) => problems.problem(
            format!("{key}.quantity"),
            "is one of a place: give its coordinates, `at = [...]`",
        ),
        (Some(_), false) => problems.problem(
            format!("{key}.at"),
            format!(
                "belongs to a quantity of a place: states.NAME.pressure, .displacement_x, ..., \
                 .stress_{}, ...",
                scene.kind.components()[0]
            ),
        ),
        (None, false) => {}
    }
    if let Some(body) = &reference.body {
        problems.require(
            scene.bodies.contains_key(body),
            format!("{key}.body"),
            format!("there is no body `{body}`"),
        );
    }
}

//! Stresses over the depth below the centre of the contact, by which bearings are judged.

use super::chart::{Chart, ChartCurve, Pen};
use super::contact_frame::{ContactFrame, global};
use super::contours::TriangleSheet;
use super::patchwork::{Patchwork, seen};
use super::section::SectionPlane;
use super::titled::Titled;
use super::window::{Window, mirrors, negligible};
use crate::material::von_mises;
use crate::model::Model;
use crate::number::{significant, with_unit};
use crate::output::labels::{Labels, labelled};
use crate::results::{Fields, PairState, Results, State, Status};
use crate::space::{Vector, dot, unit};
use nalgebra::Matrix3;
use plotters::prelude::SeriesLabelPosition;

/// Depth of the curves, in half widths of the contact.
const DEPTH: f64 = 3.0;

/// Draws von Mises and largest shear stress below the centre of the contact in each of its two
/// bodies, in the state with the largest load that has fields.
pub(super) fn chart(
    model: &Model,
    results: &Results,
    labels: &Labels,
    frame: Option<&ContactFrame>,
) -> Option<Titled> {
    let with_fields = results.states.iter().filter(|s| s.contact_force > 0.0);
    let with_fields = with_fields.filter_map(|state| Some((state, state.fields.as_ref()?)));
    let (state, fields) = with_fields.max_by(|a, b| a.0.load.total_cmp(&b.0.load))?;
    let reach = DEPTH * state.half_width;
    if !(reach.is_finite() && reach > 0.0) {
        return None;
    }
    let (contact, line, patchwork) = match frame {
        Some(frame) => below_patch(model, frame, reach)?,
        None => below_line(model, state, reach)?,
    };
    let mesh = &model.mesh;
    let places = patchwork.places(mesh, None);
    let [shear, mises] = [largest_shear, mean_von_mises].map(|quantity| {
        let values =
            patchwork.of_elements(mesh, |element| quantity(fields, mesh.dimension, element));
        patchwork.sheet(places.clone(), values)
    });
    let mut curves = Vec::new();
    let mut caption = format!(
        "State \u{201c}{}\u{201d}; stresses are means of elements, at nodes of those round them.",
        state.name
    );
    // The normal points out of the second body, into the first.
    for (index, into) in [1.0, -1.0].into_iter().enumerate() {
        let surface = mesh.surfaces.get(&model.contacts[contact].names[index])?;
        let body = mesh.element_body[surface.facets.first()?.element];
        let name = &mesh.bodies[body as usize];
        let along = |sheet: &TriangleSheet| {
            let found = sheet.along(line, |point| patchwork.body(point) == body);
            over_depth(found, into, reach)
        };
        let (of_shear, of_mises) = (along(&shear), along(&mises));
        let Some(top) = highest(&of_shear) else {
            continue;
        };
        caption.push_str(&format!(
            " Largest shear stress in {name}: {} at a depth of {} ({} of the {}).",
            with_unit(&significant(top[1], 3), labels.stress()),
            with_unit(&significant(top[0], 3), labels.length()),
            significant(top[0] / state.half_width, 2),
            labels.half_width(),
        ));
        for (kind, pen, points) in [
            ("von Mises", Pen::Line, of_mises),
            ("shear", Pen::Dashed, of_shear),
        ] {
            curves.push(ChartCurve {
                label: format!("{kind}, {name}"),
                color: Some(index),
                pen,
                points,
            });
        }
    }
    (!curves.is_empty()).then(|| Titled {
        name: "below_contact".to_string(),
        title: "Stress below the centre of the contact".to_string(),
        caption,
        chart: Chart {
            labels: [
                labelled("depth", labels.length()),
                labelled("stress", labels.stress()),
            ],
            curves,
            from_zero: [true; 2],
            widened: 0.0,
            legend: SeriesLabelPosition::UpperRight,
        },
    })
}

/// Returns the points of a curve over the depth, down to `reach`, from positions along the normal;
/// `into` is the sign of the way into the body.
fn over_depth(found: Vec<[f64; 2]>, into: f64, reach: f64) -> Vec<[f64; 2]> {
    let depths = found.into_iter().map(|[s, value]| [into * s, value]);
    let mut points: Vec<_> = depths
        .filter(|p| (-0.05 * reach..=reach).contains(&p[0]))
        .collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// Returns the point of a curve with the largest value.
fn highest(points: &[[f64; 2]]) -> Option<[f64; 2]> {
    let by_value = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
    points.iter().max_by(by_value).copied()
}

type Below = (usize, [[f64; 2]; 2], Patchwork);

/// Returns the section through a patch along its first axis.
fn below_patch(model: &Model, frame: &ContactFrame, reach: f64) -> Option<Below> {
    let [cut, _] = SectionPlane::both(frame);
    let in_plane = |x: Vector| cut.axes.map(|axis| dot(axis, x));
    let (from, way) = (in_plane(frame.center), in_plane(frame.normal));
    let halves = mirrors(model);
    let mirror = cut.axes.map(|axis| global(axis).is_some_and(|d| halves[d]));
    let window = round(from, reach);
    let patchwork = cut.pieces(&model.mesh, window, mirror, &[]);
    let patchwork = patchwork.mirrored(&model.mesh, mirror, negligible(model));
    Some((frame.contact, [from, way], patchwork))
}

/// Returns the contact that carries the largest force, the line along the normal at the middle of
/// its closed pairs, and the elements round that place. If a plane of symmetry cuts the contact,
/// the middle lies on that plane.
fn below_line(model: &Model, state: &State, reach: f64) -> Option<Below> {
    let force = |contact: usize| -> f64 {
        let pairs = state.pairs.iter().filter(|p| p.contact == contact);
        pairs.map(|pair| pair.force).sum()
    };
    let contact = (0..model.contacts.len()).max_by(|&a, &b| force(a).total_cmp(&force(b)))?;
    let halves = mirrors(model);
    let small = negligible(model);
    // The point on the axis that carries no force is numbered beyond the pairs.
    let range = model.contacts[contact].range.clone();
    let is_closed = |p: &&PairState| range.contains(&p.pair) && p.status == Status::Closed;
    let closed: Vec<usize> = state
        .pairs
        .iter()
        .filter(is_closed)
        .map(|p| p.pair)
        .collect();
    let point = |pair: usize| model.mesh.point(model.pairs[pair].slave);
    let on_symmetry = |pair: &usize| {
        let is_on = |d: usize| halves[d] && point(*pair)[d].abs() <= small;
        is_on(0) || is_on(1)
    };
    let arc = |pair: usize| model.pairs[pair].arc;
    let ends = closed.iter().map(|&k| arc(k));
    let [low, high] = ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], s| {
        [l.min(s), h.max(s)]
    });
    let off = |pair: usize| (arc(pair) - 0.5 * (low + high)).abs();
    let middle = closed
        .iter()
        .copied()
        .min_by(|&a, &b| off(a).total_cmp(&off(b)));
    let middle = closed.iter().copied().find(on_symmetry).or(middle)?;
    let [x, y, _] = point(middle);
    let [nx, ny, _] = model.pairs[middle].normal;
    let mirror = [halves[0], halves[1]];
    let elements = seen(
        &model.mesh,
        [unit(0), unit(1)],
        round([x, y], reach),
        mirror,
        &[],
    );
    let patchwork =
        Patchwork::of_plane(&model.mesh, &elements).mirrored(&model.mesh, mirror, small);
    Some((contact, [[x, y], [nx, ny]], patchwork))
}

fn round(middle: [f64; 2], reach: f64) -> Window {
    Window {
        low: middle.map(|x| x - reach),
        high: middle.map(|x| x + reach),
    }
}

/// Returns the mean stress of an element, all six components.
fn mean_stress(fields: &Fields, dimension: usize, element: usize) -> [f64; 6] {
    let mut out = [0.0; 6];
    let mean = &fields.stress[2 * dimension * element..][..2 * dimension];
    out[..mean.len()].copy_from_slice(mean);
    out
}

fn mean_von_mises(fields: &Fields, dimension: usize, element: usize) -> f64 {
    von_mises(&mean_stress(fields, dimension, element))
}

/// Returns half the difference of the largest and the smallest principal stress.
fn largest_shear(fields: &Fields, dimension: usize, element: usize) -> f64 {
    let [xx, yy, zz, xy, yz, zx] = mean_stress(fields, dimension, element);
    let principal = Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz).symmetric_eigenvalues();
    0.5 * (principal.max() - principal.min())
}

// The model is too large for the dense backend.
#[cfg(all(test, any(feature = "cholmod", feature = "faer")))]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// Below an elastic line contact the largest shear is 0.300 p0 at a depth of 0.786 b (Johnson,
    /// Contact Mechanics, section 4.1(a)). With 8 elements over b the place is known to one
    /// element, and the curve, of a curvature below 1/b^2, to 1/64; the pressure to 1 %.
    #[test]
    fn the_largest_shear_of_a_line_contact_is_where_it_should_be() {
        let root = env!("CARGO_MANIFEST_DIR");
        let scene = format!("{root}/data/scenes/cylinder_on_half_plane.toml");
        let overrides = [
            "mesh.cylinder_on_half_plane.resolution=8".to_string(),
            "program.targets=[{ yield = true }]".to_string(),
        ];
        let scene = Scene::load_with(scene, &overrides).unwrap();
        let model = Model::new(&scene).unwrap();
        let mut analysis =
            crate::analysis::Analysis::new(model, crate::linalg::Backend::default()).unwrap();
        let results = analysis.run(&mut crate::progress::Silent).unwrap();
        let model = analysis.model();
        let labels = Labels::of(model);
        let titled = chart(model, &results, &labels, None).unwrap();
        let state = &results.states[0];
        let shear: Vec<&ChartCurve> = (titled.chart.curves.iter())
            .filter(|curve| curve.label.starts_with("shear"))
            .collect();
        assert_eq!(shear.len(), 2);
        for curve in shear {
            let top = curve
                .points
                .iter()
                .max_by(|a, b| a[1].total_cmp(&b[1]))
                .unwrap();
            let (depth, size) = (top[0] / state.half_width, top[1] / state.max_pressure);
            assert!(
                (depth - 0.786).abs() < 1.0 / 8.0,
                "{}: {depth}",
                curve.label
            );
            assert!(
                (size / 0.300 - 1.0).abs() < 1.0 / 64.0 + 0.01,
                "{}: {size}",
                curve.label
            );
            assert!(curve.points.is_sorted_by(|a, b| a[0] <= b[0]));
        }
        assert!(
            titled.caption.contains("of the half width"),
            "{}",
            titled.caption
        );
    }
}

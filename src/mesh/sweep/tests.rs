use super::*;
use crate::mesh::generate;
use crate::mesh::validate;
use crate::scene::Scene;
use crate::space::{difference, dot, length};
use std::f64::consts::PI;

/// A section (a block off the axis, a ring sector or a disc), made from a scene.
fn section(part: &str, shape: &str) -> Mesh {
    let text = format!(
        "kind = \"plane_strain\"\nmesh.parts = [{{ body = \"b\", element = \"{shape}\", {part} \
         }}]\n[materials.m]\nyoungs_modulus = 1.0\npoissons_ratio = 0.3\n[bodies]\nb = {{ material \
         = \"m\" }}\n[[load]]\non = \"b.outer\"\npressure = 1.0\n[program]\ntargets = [{{ \
         load_factor = 1.0 }}]\n"
    );
    let scene = Scene::parse(&text, "section").unwrap();
    generate::parts(&scene.mesh.parts.unwrap()).unwrap()
}

const RING: &str = "ring = { center = [5.0, 0.0], radius = [1.0, 2.0], elements = [2, 3] }";
const DISC: &str = "disc = { radius = 2.0, elements = 4 }";
const SHAPES: [&str; 4] = ["tri3", "tri6", "quad4", "quad8"];

/// Volume by the divergence theorem over all facets.
fn volume(mesh: &Mesh) -> f64 {
    let mut sum = 0.0;
    for element in 0..mesh.n_elements() {
        for local in 0..mesh.shapes[element].n_facets() {
            sum += flux(mesh, Facet { element, local });
        }
    }
    sum / 3.0
}

fn flux(mesh: &Mesh, facet: Facet) -> f64 {
    let points: Vec<[f64; 3]> = mesh.facet_nodes(facet).map(|n| mesh.point(n)).collect();
    let reference = mesh.facet_reference(facet);
    let at = |&(place, weight): &([f64; 3], f64)| {
        let functions = (reference.functions)(place);
        let x = (points.iter().zip(functions.values)).fold([0.0; 3], |sum, (x, value)| {
            crate::space::along(sum, value, *x)
        });
        weight * dot(reference.area(&functions, &points), x)
    };
    reference.rule.iter().map(at).sum()
}

fn of_revolution(angle: f64, elements: usize) -> Revolution {
    Revolution { angle, elements }
}

#[test]
fn a_section_becomes_a_solid_of_the_right_volume() {
    for shape in SHAPES {
        let plane = section(RING, shape);
        let solid = extruded(
            &plane,
            &Extrusion {
                depth: 3.0,
                elements: 2,
            },
        )
        .unwrap();
        validate(&solid).unwrap();
        let flat = extruded(
            &plane,
            &Extrusion {
                depth: 1.0,
                elements: 1,
            },
        )
        .unwrap();
        assert!(
            (volume(&solid) / volume(&flat) - 3.0).abs() < 1e-12,
            "{shape}"
        );
        let quadratic = ["tri6", "quad8"].contains(&shape);
        // A quarter ring has the area 3/4 pi, approximated by chords or parabolas.
        let off = volume(&flat) / (0.75 * PI) - 1.0;
        assert!(
            off.abs() < if quadratic { 1e-3 } else { 0.06 },
            "{shape} {off}"
        );
        for name in [
            "b.front", "b.back", "b.inner", "b.outer", "b.start", "b.end",
        ] {
            assert!(solid.surfaces.contains_key(name), "{shape} {name}");
        }
    }
}

/// Volume by Pappus: the area times the path of the centroid; also for closed turns and sections
/// that touch the axis.
#[test]
fn a_turned_section_has_the_volume_of_pappus() {
    for shape in SHAPES {
        let quadratic = ["tri6", "quad8"].contains(&shape);
        let plane = section(RING, shape);
        for (angle, n) in [(90.0, 4), (30.0, 2), (360.0, 16)] {
            let solid = revolved(&plane, &of_revolution(angle, n)).unwrap();
            validate(&solid).unwrap();
            // For a quarter ring about the y axis, 5 from its centre: the area is 3/4 pi, and the
            // first moment is 5 times the area plus 7/3.
            let exact = f64::to_radians(angle) * (5.0 * 0.75 * PI + 7.0 / 3.0);
            let off = volume(&solid) / exact - 1.0;
            assert!(
                off.abs() < if quadratic { 2e-3 } else { 0.09 },
                "{shape} {angle} {off}"
            );
            assert_eq!(solid.surfaces.contains_key("b.back"), angle < 360.0);
        }
        if !shape.starts_with("quad") {
            continue;
        }
        let ball = section(DISC, shape);
        let solid = revolved(&ball, &of_revolution(90.0, 4)).unwrap();
        validate(&solid).unwrap();
        let off = volume(&solid) / (4.0 / 3.0 * PI) - 1.0;
        assert!(
            off.abs() < if quadratic { 2e-3 } else { 0.12 },
            "{shape} {off}"
        );
        // The edges on the axis no longer form a surface.
        assert!(
            solid.node_sets.contains_key("b.end"),
            "{:?}",
            solid.set_names()
        );
        assert_eq!(
            solid.surfaces["b.outer"].curve,
            Some(Curve::Sphere {
                center: [0.0; 3],
                radius: 2.0,
                outward: true
            })
        );
    }
}

/// Exact shapes are swept too: every node of a surface lies on the shape, and the normals of the
/// facets are near those of the shape.
#[test]
fn surfaces_keep_their_exact_shapes() {
    for shape in SHAPES {
        let plane = section(RING, shape);
        let extrusion = Extrusion {
            depth: 1.0,
            elements: 2,
        };
        let solids = [
            extruded(&plane, &extrusion).unwrap(),
            revolved(&plane, &of_revolution(60.0, 4)).unwrap(),
        ];
        for solid in solids {
            for name in ["b.inner", "b.outer", "b.start"] {
                let surface = &solid.surfaces[name];
                let curve = surface.curve.unwrap();
                for node in solid.set_nodes(name).unwrap() {
                    if let Some((_, off)) = curve.nearest(solid.point(node)) {
                        assert!(off < 1e-14, "{shape} {name} {off}");
                    }
                }
                for &facet in &surface.facets {
                    let points: Vec<_> = solid.facet_nodes(facet).map(|n| solid.point(n)).collect();
                    let reference = solid.facet_reference(facet);
                    let at = (reference.functions)(reference.center());
                    let area = reference.area(&at, &points);
                    let middle = (points.iter().zip(at.values))
                        .fold([0.0; 3], |sum, (x, v)| crate::space::along(sum, v, *x));
                    let cosine = dot(area, curve.normal(middle)) / length(area);
                    assert!(cosine > 0.99, "{shape} {name} {cosine}");
                }
            }
        }
    }
}

#[test]
fn sections_that_cannot_be_turned_are_named() {
    let refused = |mesh: &Mesh| {
        let error = revolved(mesh, &of_revolution(90.0, 2)).unwrap_err();
        error.message().to_string()
    };
    let beyond = section(
        "disc = { radius = 2.0, angle = [0, 180], elements = 4 }",
        "quad4",
    );
    assert!(refused(&beyond).contains("beyond the axis"));
    // The disc's triangles next to the axis touch it at single corners.
    let corner = refused(&section(DISC, "tri3"));
    assert!(corner.contains("at a corner"), "{corner}");
    let mut solid = section(RING, "quad4");
    solid = revolved(&solid, &of_revolution(90.0, 2)).unwrap();
    let error = extruded(
        &solid,
        &Extrusion {
            depth: 1.0,
            elements: 1,
        },
    )
    .unwrap_err();
    assert!(error.message().contains("solid"), "{error}");
    let mut taken = section(RING, "quad4");
    let surface = taken.surfaces["b.outer"].clone();
    taken.surfaces.insert("b.back".into(), surface);
    assert!(refused(&taken).contains("`b.back`"));
}

/// In the plane of the section a revolved surface looks to the same side as the edge it came from,
/// inside a ring and outside.
#[test]
fn turned_curves_keep_the_side_that_they_look_to() {
    let circle = |center, outward| Curve::Circle {
        center,
        radius: 0.5,
        outward,
    };
    let curves = [
        (Curve::Line { normal: [1.0, 0.0] }, [2.0, 0.7]),
        (
            Curve::Line {
                normal: [-1.0, 0.0],
            },
            [2.0, 0.7],
        ),
        (
            Curve::Line {
                normal: [0.0, -1.0],
            },
            [2.0, 0.7],
        ),
        (circle([0.0, 1.0], true), [0.3, 1.4]),
        (circle([0.0, 1.0], false), [0.3, 1.4]),
        (circle([3.0, 1.0], true), [3.3, 1.4]),
        (circle([3.0, 1.0], false), [2.7, 1.4]),
    ];
    for (curve, [x, y]) in curves {
        let turned = turned_curve(curve, &[[x, y]]).expect("no cone");
        let [before, after] = [curve, turned].map(|curve| curve.normal([x, y, 0.0]));
        assert!(
            length(difference(before, after)) < 1e-15,
            "{curve:?}: {after:?}"
        );
    }
}

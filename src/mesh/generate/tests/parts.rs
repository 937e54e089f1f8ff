use super::disc::sector_area;
use super::*;
use crate::mesh::generate::parts;
use crate::scene::{Block, Disc, Part, Piece, Ring};

fn part(body: &str, element: Shape) -> Part {
    Part {
        body: body.to_string(),
        block: None,
        ring: None,
        disc: None,
        brick: None,
        element,
    }
}

fn block(body: &str, element: Shape) -> Part {
    Part {
        block: Some(Block {
            x: [-1.0, 2.0],
            y: [0.5, 1.5],
            elements: [6, 4],
            bias: [1.0, 3.0],
            pieces: vec![Piece {
                name: "loaded".to_string(),
                side: "top".to_string(),
                from: -0.5,
                to: 1.1,
            }],
        }),
        ..part(body, element)
    }
}

fn ring(body: &str, element: Shape, angle: [f64; 2], elements: [usize; 2]) -> Part {
    Part {
        ring: Some(Ring {
            center: [3.0, -1.0],
            radius: [1.0, 1.1],
            angle,
            elements,
            bias: 2.0,
        }),
        ..part(body, element)
    }
}

fn disc(body: &str, element: Shape, angle: [f64; 2], elements: usize) -> Part {
    Part {
        disc: Some(Disc {
            center: [-2.0, 0.25],
            radius: 1.0,
            angle,
            elements,
        }),
        ..part(body, element)
    }
}

#[test]
fn a_block_has_its_sides_corners_and_pieces() {
    for shape in Shape::PLANE {
        let mesh = parts(&[block("a", shape)]).unwrap();
        check_common(&mesh);
        assert!((area(&mesh, "a") - 3.0).abs() < 1e-14);
        for (name, axis, value, count) in [
            ("a.left", 0, -1.0, 4),
            ("a.right", 0, 2.0, 4),
            ("a.bottom", 1, 0.5, 6),
            ("a.top", 1, 1.5, 6),
        ] {
            let nodes = mesh.set_nodes(name).unwrap();
            assert_eq!(nodes.len(), nodes_on(count, shape));
            assert!(
                nodes.iter().all(|&n| mesh.in_plane(n)[axis] == value),
                "{name}"
            );
        }
        for (name, point) in [
            ("a.bottom_left", [-1.0, 0.5]),
            ("a.bottom_right", [2.0, 0.5]),
            ("a.top_left", [-1.0, 1.5]),
            ("a.top_right", [2.0, 1.5]),
        ] {
            assert_eq!(mesh.in_plane(mesh.node_sets[name][0]), point, "{name}");
        }
        // Elements end at -1, -0.5, 0, 0.5, 1, ...: three whole elements fit into -0.5..1.1.
        let xs: Vec<f64> = mesh
            .set_nodes("a.loaded")
            .unwrap()
            .iter()
            .map(|&n| mesh.in_plane(n)[0])
            .collect();
        assert_eq!(mesh.surfaces["a.loaded"].facets.len(), 3);
        assert!(xs.iter().all(|x| (-0.5..=1.0).contains(x)));
        assert_eq!(xs.len(), nodes_on(3, shape));
    }
}

#[test]
fn ring_sectors_are_valid_even_with_thin_layers_of_coarse_arcs() {
    for shape in Shape::PLANE {
        for (angle, elements, closed) in [
            ([0.0, 90.0], [3, 5], false),
            ([0.0, 90.0], [4, 3], false),
            ([-30.0, 200.0], [2, 7], false),
            ([0.0, 360.0], [2, 9], true),
            ([45.0, 405.0], [1, 4], true),
        ] {
            let mesh = parts(&[ring("r", shape, angle, elements)]).unwrap();
            check_common(&mesh);
            let span = (angle[1] - angle[0]).to_radians();
            let exact = sector_area(1.1, span, elements[1], shape)
                - sector_area(1.0, span, elements[1], shape);
            assert!((area(&mesh, "r") / exact - 1.0).abs() < 1e-12);
            assert_eq!(mesh.surfaces.len(), if closed { 2 } else { 4 });
            let on_inner = nodes_on(elements[1], shape) - usize::from(closed);
            assert_eq!(mesh.set_nodes("r.inner").unwrap().len(), on_inner);
            assert_eq!(mesh.set_nodes("r.outer").unwrap().len(), on_inner);
        }
    }
}

#[test]
fn discs_of_every_span_are_valid() {
    for shape in Shape::PLANE {
        for (quarters, end) in [(1usize, 90.0), (2, 180.0), (4, 360.0)] {
            for start in [0.0, 90.0, -45.0, 17.0] {
                for n in [2, 4, 10] {
                    let mesh = parts(&[disc("d", shape, [start, start + end], n)]).unwrap();
                    check_common(&mesh);
                    let exact = sector_area(1.0, f64::to_radians(end), n * quarters, shape);
                    assert!((area(&mesh, "d") / exact - 1.0).abs() < 1e-12);
                    assert_eq!(mesh.surfaces["d.outer"].facets.len(), n * quarters);
                    assert_eq!(mesh.surfaces.contains_key("d.start"), quarters < 4);
                    assert_eq!(mesh.in_plane(mesh.node_sets["d.center"][0]), [-2.0, 0.25]);
                    if quarters < 4 {
                        for name in ["d.start", "d.end"] {
                            let nodes = mesh.set_nodes(name).unwrap();
                            assert!(nodes.contains(&mesh.node_sets["d.center"][0]));
                        }
                    }
                }
            }
        }
    }
}

/// A shaft in a ring: the contact nodes of both lie at the same positions.
#[test]
fn a_disc_matches_the_ring_around_it() {
    for shape in Shape::PLANE {
        let mut outer = ring("ring", shape, [0.0, 360.0], [2, 16]);
        outer.ring.as_mut().unwrap().center = [-2.0, 0.25];
        let mesh = parts(&[disc("shaft", shape, [0.0, 360.0], 4), outer]).unwrap();
        check_common(&mesh);
        let sorted = |name: &str| {
            let mut points: Vec<[u64; 2]> = mesh
                .set_nodes(name)
                .unwrap()
                .iter()
                .map(|&n| mesh.in_plane(n).map(f64::to_bits))
                .collect();
            points.sort_unstable();
            points
        };
        assert_eq!(sorted("shaft.outer"), sorted("ring.inner"));
    }
}

#[test]
fn many_bodies_of_mixed_shapes_stay_apart() {
    let all = [
        block("a", Shape::Tri3),
        block("b", Shape::Quad8),
        ring("c", Shape::Tri6, [0.0, 180.0], [2, 8]),
        disc("d", Shape::Quad4, [0.0, 180.0], 4),
    ];
    let mesh = parts(&all).unwrap();
    check_common(&mesh);
    assert_eq!(mesh.bodies, ["a", "b", "c", "d"]);
    for one in &all {
        let alone = parts(std::slice::from_ref(one)).unwrap();
        assert_eq!(area(&alone, &one.body), area(&mesh, &one.body));
    }
}

/// Applies a change to a valid part and returns the message of the refusal.
fn refusal(mut part: Part, change: impl Fn(&mut Part)) -> String {
    change(&mut part);
    let error = parts(&[block("first", Shape::Quad4), part]).unwrap_err();
    assert_eq!(error.kind(), crate::ErrorKind::Input);
    assert!(error.message().contains("part 2 (body `"), "{error}");
    error.to_string()
}

#[test]
fn refusals_of_blocks() {
    type Change = fn(&mut Block);
    let cases: [(Change, &[&str]); 12] = [
        (|b| b.x = [1.0, 1.0], &["block.x = [1, 1]"]),
        (|b| b.x = [1.0, f64::NAN], &["block.x", "NaN"]),
        (|b| b.y = [2.0, 1.0], &["block.y = [2, 1]"]),
        (|b| b.y[1] = f64::INFINITY, &["block.y", "inf"]),
        (|b| b.elements[1] = 0, &["block.elements = 0"]),
        (|b| b.elements = [100_000; 2], &["1.000e10 elements", "5e7"]),
        (|b| b.bias[0] = -1.0, &["block.bias (x) = -1"]),
        (|b| b.x = [1e16, 1e16 + 4.0], &["block.x", "coincide"]),
        (
            |b| b.pieces[0].side = "up".into(),
            &["loaded", "\"up\"", "left, right"],
        ),
        (|b| b.pieces[0].to = -3.0, &["loaded", "[-0.5, -3]"]),
        (
            |b| b.pieces[0].to = -0.4,
            &["loaded", "no element of side top", "from -1 to 2"],
        ),
        (
            |b| b.pieces[0].name = "left".into(),
            &["`b.left` is used twice"],
        ),
    ];
    for (change, expected) in cases {
        let message = refusal(block("b", Shape::Quad4), |p| {
            change(p.block.as_mut().unwrap())
        });
        for text in expected {
            assert!(message.contains(text), "{message} lacks {text}");
        }
    }
}

#[test]
fn refusals_of_rings_and_discs() {
    type ChangeRing = fn(&mut Ring);
    let cases: [(ChangeRing, &str); 9] = [
        (|r| r.radius = [0.0, 1.0], "inner radius must be positive"),
        (|r| r.radius = [2.0, 1.0], "ring.radius = [2, 1]"),
        (|r| r.radius = [f64::NAN, 1.0], "ring.radius"),
        (|r| r.center[1] = f64::NAN, "ring.center (y) = NaN"),
        (|r| r.angle = [0.0, 400.0], "at most 360 apart"),
        (|r| r.angle = [90.0, 0.0], "ring.angle = [90, 0]"),
        (|r| r.elements = [0, 4], "ring.elements = 0"),
        (
            |r| r.angle = [0.0, 360.0],
            "ring.elements (along the angle) = 3: give at least 4",
        ),
        (|r| r.bias = 0.0, "ring.bias = 0"),
    ];
    for (change, text) in cases {
        let example = ring("r", Shape::Quad4, [0.0, 90.0], [2, 3]);
        let message = refusal(example, |p| change(p.ring.as_mut().unwrap()));
        assert!(message.contains(text), "{message} lacks {text}");
    }
    type ChangeDisc = fn(&mut Disc);
    let cases: [(ChangeDisc, &str); 6] = [
        (|d| d.radius = 0.0, "disc.radius = 0"),
        (|d| d.center[0] = f64::INFINITY, "disc.center (x) = inf"),
        (|d| d.elements = 0, "disc.elements = 0"),
        (|d| d.elements = 5, "disc.elements = 5: give an even number"),
        (|d| d.elements = usize::MAX - 1, "elements, more than"),
        (|d| d.angle = [0.0, 120.0], "90, 180 or 360 degrees apart"),
    ];
    for (change, text) in cases {
        let message = refusal(disc("d", Shape::Quad4, [0.0, 90.0], 4), |p| {
            change(p.disc.as_mut().unwrap());
        });
        assert!(message.contains(text), "{message} lacks {text}");
    }
}

#[test]
fn refusals_of_the_list_of_parts() {
    assert!(
        parts(&[])
            .unwrap_err()
            .message()
            .contains("mesh.parts is empty")
    );
    let message = refusal(block("first", Shape::Quad4), |_| {});
    assert!(message.contains("same body name"), "{message}");
    let message = refusal(block(" ", Shape::Quad4), |_| {});
    assert!(message.contains("body is empty"), "{message}");
    let message = refusal(part("none", Shape::Quad4), |_| {});
    assert!(
        message.contains("exactly one of block, brick, ring and disc"),
        "{message}"
    );
    let message = refusal(block("two", Shape::Quad4), |p| {
        p.disc = disc("", Shape::Quad4, [0.0, 90.0], 4).disc;
    });
    assert!(
        message.contains("exactly one of block, brick, ring and disc"),
        "{message}"
    );
}

/// The limit applies to all parts together, and each cell counts as two triangles.
#[test]
fn the_number_of_elements_is_limited_before_anything_is_allocated() {
    let mut half = block("b", Shape::Tri3);
    half.block.as_mut().unwrap().elements = [10_000, 2_600];
    let error = parts(&[half]).unwrap_err();
    assert!(error.message().contains("5.200e7 elements"), "{error}");
}

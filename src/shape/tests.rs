use super::*;
use nalgebra::Matrix3;

fn inside(shape: Shape) -> Vec<Place> {
    let z = if shape.dimension() == 3 { 0.17 } else { 0.0 };
    let mut places = vec![[0.21, 0.34, z], [0.0, 0.0, 0.0]];
    if !shape.is_simplex() {
        places.push([0.7, -0.4, -z]);
    }
    places
}

#[test]
fn each_function_is_one_at_its_node_and_zero_at_the_others() {
    for shape in Shape::ALL {
        let nodes = shape.reference().nodes;
        for (k, &node) in nodes.iter().enumerate() {
            for (i, value) in shape.functions(node).values.iter().enumerate() {
                assert_eq!(*value, f64::from(u8::from(i == k)), "{shape:?} {i} {k}");
            }
        }
    }
}

#[test]
fn gradients_are_derivatives_and_values_sum_to_one() {
    for shape in Shape::ALL {
        for at in inside(shape) {
            let here = shape.functions(at);
            assert!((here.values.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            for d in 0..shape.reference().dimension {
                let h = 1e-6;
                let (mut up, mut down) = (at, at);
                up[d] += h;
                down[d] -= h;
                let (a, b) = (shape.functions(up).values, shape.functions(down).values);
                for i in 0..shape.n_nodes() {
                    let slope = (a[i] - b[i]) / (2.0 * h);
                    assert!((slope - here.gradients[i][d]).abs() < 1e-9, "{shape:?} {i}");
                }
            }
        }
    }
}

#[test]
fn every_complete_polynomial_is_reproduced() {
    /// Exponents of x, y, z.
    const LINEAR: [[i32; 3]; 4] = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const QUADRATIC: [[i32; 3]; 6] = [
        [2, 0, 0],
        [0, 2, 0],
        [0, 0, 2],
        [1, 1, 0],
        [0, 1, 1],
        [1, 0, 1],
    ];
    let power = |x: f64, n: i32| if n == 0 { 1.0 } else { x.powi(n) };
    for shape in Shape::ALL {
        let nodes = shape.reference().nodes;
        let more = QUADRATIC.iter().filter(|_| shape.is_quadratic());
        let in_space = |n: &&[i32; 3]| shape.dimension() == 3 || n[2] == 0;
        for n in LINEAR.iter().chain(more).filter(in_space) {
            let value = |x: &Place| (0..3).map(|d| power(x[d], n[d])).product::<f64>();
            for at in inside(shape) {
                let functions = shape.functions(at);
                for d in 0..shape.dimension() {
                    let terms = functions.gradients.iter().zip(nodes);
                    let computed: f64 = terms.map(|(g, x)| g[d] * value(x)).sum();
                    let mut lower = *n;
                    lower[d] -= 1;
                    let exact = match lower[d] {
                        -1 => 0.0,
                        _ => {
                            let rest = (0..3).map(|e| power(at[e], lower[e])).product::<f64>();
                            f64::from(n[d]) * rest
                        }
                    };
                    assert!(
                        (computed - exact).abs() < 64.0 * f64::EPSILON,
                        "{shape:?} {n:?}: {computed} {exact}"
                    );
                }
            }
        }
    }
}

/// The shape functions of a facet are the restrictions of the element's shape functions to the
/// facet.
#[test]
fn facets_have_the_functions_of_their_element() {
    for shape in Shape::ALL {
        let ReferenceElement { nodes, facets, .. } = shape.reference();
        assert_eq!(facets.len(), shape.n_facets());
        for (k, local) in facets.iter().enumerate() {
            let facet = shape.facet_reference(k);
            assert_eq!(local.len(), facet.nodes.len());
            for place in [[0.3, 0.25, 0.0], [0.1, 0.6, 0.0]] {
                let own = (facet.functions)(place);
                let mut at = [0.0; 3];
                let mut along = [[0.0; 3]; 2];
                for (k, &node) in local.iter().enumerate() {
                    for d in 0..3 {
                        at[d] += own.values[k] * nodes[node][d];
                        for a in 0..facet.dimension() {
                            along[a][d] += own.gradients[k][a] * nodes[node][d];
                        }
                    }
                }
                let of_element = shape.functions(at);
                for (i, value) in of_element.values[..nodes.len()].iter().enumerate() {
                    let k = local.iter().position(|&node| node == i);
                    assert!((value - k.map_or(0.0, |k| own.values[k])).abs() < 1e-15);
                    let Some(k) = k else { continue };
                    for a in 0..facet.dimension() {
                        let terms = of_element.gradients[i].iter().zip(along[a]);
                        let slope: f64 = terms.map(|(g, t)| g * t).sum();
                        assert!((slope - own.gradients[k][a]).abs() < 1e-14);
                    }
                }
            }
        }
    }
}

/// Facets point outward: their areas add up to zero, and the flux of the position through them is
/// the volume times the dimension.
#[test]
fn facets_close_the_element_and_point_outward() {
    for shape in Shape::ALL {
        let row = shape.reference();
        let (mut area, mut flux) = ([0.0; 3], 0.0);
        for (k, local) in row.facets.iter().enumerate() {
            let facet = shape.facet_reference(k);
            let nodes: Vec<Place> = local.iter().map(|&k| row.nodes[k]).collect();
            for &(place, weight) in facet.rule {
                let at = (facet.functions)(place);
                let own = facet.area(&at, &nodes);
                for d in 0..3 {
                    area[d] += weight * own[d];
                    let terms = at.values.iter().zip(&nodes);
                    flux += weight * own[d] * terms.map(|(n, x)| n * x[d]).sum::<f64>();
                }
            }
        }
        let volume: f64 = row.gauss.iter().map(|(_, weight)| weight).sum();
        assert!(area.iter().all(|a| a.abs() < 1e-14), "{shape:?} {area:?}");
        let expected = row.dimension as f64 * volume;
        assert!(
            (flux - expected).abs() < 1e-14,
            "{shape:?} {flux} {expected}"
        );
    }
}

/// The middle of each edge is a node; these nodes follow the corners in the order of the edges.
/// Gmsh's order contains every node once.
#[test]
fn edges_have_their_middles_in_order() {
    for shape in Shape::ALL {
        let row = shape.reference();
        for (k, [a, b]) in row.edges.iter().enumerate().filter(|_| row.degree == 2) {
            let middle = row.nodes[row.n_corners + k];
            for d in 0..3 {
                assert_eq!(middle[d], 0.5 * (row.nodes[*a][d] + row.nodes[*b][d]));
            }
        }
        let mut order = row.gmsh_order.to_vec();
        order.sort_unstable();
        assert!(order.into_iter().eq(0..row.nodes.len()), "{shape:?}");
    }
}

#[test]
fn rules_have_the_volume_of_the_reference_element() {
    for shape in Shape::ALL {
        let row = shape.reference();
        let volume = match (shape.is_simplex(), row.dimension) {
            (true, 2) => 0.5,
            (true, _) => 1.0 / 6.0,
            _ if row.n_corners == 6 => 1.0,
            _ => 1.0 / row.unit_jacobian,
        };
        for rule in [row.gauss, row.full, row.sampling] {
            let sum: f64 = rule.iter().map(|(_, weight)| weight).sum();
            assert!(
                (sum - volume).abs() < 4.0 * f64::EPSILON * volume,
                "{shape:?}"
            );
        }
    }
}

/// Each child is the reference element at half its size, and together the children fill the
/// element. The parts of a facet have the facet's shape at half its size. The linear functions of
/// the corners agree with the places.
#[test]
fn children_are_elements_of_half_the_size_that_fill_it() {
    for shape in Shape::ALL {
        let row = shape.reference();
        let whole: f64 = row.gauss.iter().map(|(_, weight)| weight).sum();
        let parts = 1 << row.dimension;
        for cut in cuts(shape) {
            assert_eq!(cut.children.len(), parts, "{shape:?}");
            assert_eq!(cut.places[..row.nodes.len()], *row.nodes);
            let mut volume = 0.0;
            for child in &cut.children {
                let nodes: Vec<Place> = child.nodes.iter().map(|&k| cut.places[k]).collect();
                for &(at, weight) in row.gauss {
                    let jacobian = jacobian(shape, at, &nodes);
                    let expected = 1.0 / parts as f64;
                    assert!((jacobian - expected).abs() < 1e-15, "{shape:?} {child:?}");
                    volume += weight * jacobian;
                }
            }
            assert!((volume - whole).abs() < 1e-14, "{shape:?}");
            for (parts, facet) in cut.of_facet.iter().zip(row.facets) {
                assert_eq!(parts.len(), 1 << (row.dimension - 1), "{shape:?}");
                let kind = |&&[child, local]: &&[usize; 2]| {
                    cut.children[child].nodes.len() == row.nodes.len()
                        && row.facets[local].len() == facet.len()
                };
                assert_eq!(parts.iter().filter(kind).count(), parts.len());
            }
            for (place, between) in cut.places.iter().zip(&cut.between) {
                let sum: u32 = between.iter().map(|(_, part)| part).sum();
                assert_eq!(sum, WHOLE);
                for d in 0..3 {
                    let terms = between.iter();
                    let terms = terms.map(|&(k, part)| f64::from(part) * row.nodes[k][d]);
                    assert_eq!(terms.sum::<f64>(), f64::from(WHOLE) * place[d]);
                }
            }
        }
    }
}

fn jacobian(shape: Shape, at: Place, nodes: &[Place]) -> f64 {
    let mut j = Matrix3::identity();
    let n = shape.dimension();
    j.view_mut((0, 0), (n, n)).fill(0.0);
    for (gradient, node) in shape.functions(at).gradients.iter().zip(nodes) {
        for (a, b) in (0..n).flat_map(|a| (0..n).map(move |b| (a, b))) {
            j[(a, b)] += gradient[a] * node[b];
        }
    }
    j.determinant()
}

/// The shortest diagonal of a flat tetrahedron's octahedron is chosen, whatever the order of the
/// nodes.
#[test]
fn tetrahedra_are_cut_along_the_shortest_diagonal() {
    // The edges between the first two and the last two corners lie close to each other.
    let nodes = [
        [-1.0, 0.0, 0.1],
        [1.0, 0.0, 0.1],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
    ];
    let order = |[a, b, c, d]: [usize; 4]| [nodes[a], nodes[b], nodes[c], nodes[d]];
    assert_eq!(cut_of(Shape::Tet4, &order([0, 1, 2, 3])), 0);
    assert_eq!(cut_of(Shape::Tet4, &order([0, 2, 1, 3])), 1);
    assert_eq!(cut_of(Shape::Tet4, &order([0, 2, 3, 1])), 2);
}

#[test]
fn numbers_of_other_programs_name_one_shape_each() {
    for shape in Shape::ALL {
        assert_eq!(Shape::of_gmsh(shape.reference().gmsh), Some(shape));
        let same = |other: &Shape| other.reference().vtk == shape.reference().vtk;
        assert_eq!(Shape::ALL.iter().filter(|other| same(other)).count(), 1);
        assert_eq!(Shape::ALL[shape as usize], shape);
    }
    assert_eq!(Shape::of_gmsh(10), None);
}

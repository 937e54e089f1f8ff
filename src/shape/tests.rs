use super::*;

fn inside(shape: Shape) -> Vec<Place> {
    let mut places = vec![[0.21, 0.34, 0.0], [0.0, 0.0, 0.0]];
    if shape.n_corners() == 4 {
        places.push([0.7, -0.4, 0.0]);
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
    for shape in Shape::ALL {
        let nodes = shape.reference().nodes;
        for at @ [x, y, _] in inside(shape) {
            let gradients = shape.functions(at).gradients;
            let slope = |f: &dyn Fn(f64, f64) -> f64| {
                let mut sum = [0.0; 2];
                for (gradient, node) in gradients.iter().zip(nodes) {
                    for d in 0..2 {
                        sum[d] += gradient[d] * f(node[0], node[1]);
                    }
                }
                sum
            };
            let mut cases = vec![
                (slope(&|_, _| 1.0), [0.0, 0.0]),
                (slope(&|x, _| x), [1.0, 0.0]),
                (slope(&|_, y| y), [0.0, 1.0]),
            ];
            if shape.is_quadratic() {
                cases.push((slope(&|x, _| x * x), [2.0 * x, 0.0]));
                cases.push((slope(&|x, y| x * y), [y, x]));
                cases.push((slope(&|_, y| y * y), [0.0, 2.0 * y]));
            }
            for (computed, exact) in cases {
                for d in 0..2 {
                    let error = (computed[d] - exact[d]).abs();
                    assert!(
                        error < 32.0 * f64::EPSILON,
                        "{shape:?} {computed:?} {exact:?}"
                    );
                }
            }
        }
    }
}

/// The functions of a facet are those of the element on it, at `s` between its ends.
#[test]
fn facets_have_the_functions_of_their_element() {
    for shape in Shape::ALL {
        let Reference {
            nodes,
            facet,
            facets,
            ..
        } = shape.reference();
        assert_eq!(facets.len(), shape.n_facets());
        for local in *facets {
            assert_eq!(local.len(), facet.nodes.len());
            for s in [-0.3, 0.8] {
                let (values, slopes) = (facet.functions)(s);
                let mut at = [0.0; 3];
                let mut along = [0.0; 3];
                for (k, &node) in local.iter().enumerate() {
                    for d in 0..3 {
                        at[d] += values[k] * nodes[node][d];
                        along[d] += slopes[k] * nodes[node][d];
                    }
                }
                let of_element = shape.functions(at);
                for (i, value) in of_element.values[..nodes.len()].iter().enumerate() {
                    let k = local.iter().position(|&node| node == i);
                    assert!((value - k.map_or(0.0, |k| values[k])).abs() < 1e-15);
                    let gradient = of_element.gradients[i];
                    let slope: f64 = gradient.iter().zip(along).map(|(g, t)| g * t).sum();
                    if let Some(k) = k {
                        assert!((slope - slopes[k]).abs() < 1e-15);
                    }
                }
            }
        }
    }
}

#[test]
fn rules_have_the_volume_of_the_reference_element() {
    for shape in Shape::ALL {
        let row = shape.reference();
        let volume = 1.0 / row.unit_jacobian * if row.n_corners == 3 { 0.5 } else { 1.0 };
        for rule in [row.gauss, row.sampling] {
            let sum: f64 = rule.iter().map(|(_, weight)| weight).sum();
            assert!((sum - volume).abs() < 1e-15, "{shape:?}");
        }
    }
}

/// Of the reference element the nodes of the finer mesh are placed as the table says: each child is
/// the reference element at half its size (turned or not), and the parts of a facet lie on it.
#[test]
fn children_are_the_element_at_half_its_size() {
    for shape in Shape::ALL {
        let row = shape.reference();
        let mut places = row.nodes.to_vec();
        for facet in row.facets {
            for k in 0..row.refinement.on_facet {
                let s = if row.degree == 1 { 0.0 } else { k as f64 - 0.5 };
                let (values, _) = (row.facet.functions)(s);
                let mut place = [0.0; 3];
                for (value, &node) in values.iter().zip(*facet) {
                    (0..3).for_each(|d| place[d] += value * row.nodes[node][d]);
                }
                places.push(place);
            }
        }
        for terms in row.refinement.inside {
            let mut place = [0.0; 3];
            for &(weight, node) in *terms {
                (0..3).for_each(|d| place[d] += weight * places[node][d]);
            }
            places.push(place);
        }
        let mut volume = 0.0;
        for child in row.refinement.children {
            assert_eq!(child.len(), row.nodes.len());
            let nodes: Vec<Place> = child.iter().map(|&k| places[k]).collect();
            for &(at, weight) in row.gauss {
                let mut j = [[0.0; 2]; 2];
                for (gradient, node) in shape.functions(at).gradients.iter().zip(&nodes) {
                    for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        j[a][b] += gradient[a] * node[b];
                    }
                }
                let jacobian = j[0][0] * j[1][1] - j[0][1] * j[1][0];
                assert!((jacobian - 0.25).abs() < 1e-15, "{shape:?} {child:?}");
                volume += weight * jacobian;
            }
        }
        let whole: f64 = row.gauss.iter().map(|(_, weight)| weight).sum();
        assert!((volume - whole).abs() < 1e-15);
        for (parts, facet) in row.refinement.of_facet.iter().zip(row.facets) {
            let ends = |[child, local]: [usize; 2]| {
                let nodes = row.facets[local];
                [nodes[0], nodes[1]].map(|k| row.refinement.children[child][k])
            };
            let [first, last] = [ends(parts[0]), ends(parts[1])];
            assert_eq!([first[0], last[1]], [facet[0], facet[1]], "{shape:?}");
            assert_eq!(first[1], last[0], "{shape:?}");
        }
    }
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

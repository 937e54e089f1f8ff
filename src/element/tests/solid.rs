//! The kernel in space, on a hexahedron that is not in the table of shapes.

use super::*;
use crate::shape::{FacetReference, Functions, Place, Reference, Refinement};

type Solid = Gradients<3, 6, 8>;

const CORNERS: [Place; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

fn trilinear(at: Place) -> Functions {
    let mut out = Functions {
        values: [0.0; MAX_NODES],
        gradients: [[0.0; 3]; MAX_NODES],
    };
    for (k, corner) in CORNERS.iter().enumerate() {
        let factor = |d: usize| 0.5 * (1.0 + corner[d] * at[d]);
        out.values[k] = factor(0) * factor(1) * factor(2);
        for d in 0..3 {
            out.gradients[k][d] = 0.5 * corner[d] * factor((d + 1) % 3) * factor((d + 2) % 3);
        }
    }
    out
}

static TABLE: LazyLock<Table<3, 8>> = LazyLock::new(|| {
    let row = Reference {
        name: "hexahedron",
        dimension: 3,
        n_corners: 8,
        degree: 1,
        nodes: &CORNERS,
        functions: trilinear,
        gauss: &[],
        sampling: &[],
        has_mean_dilatation: true,
        checked: &[],
        unit_jacobian: 0.125,
        facet: FacetReference::ALL[0],
        facets: &[],
        refinement: Refinement {
            on_facet: 0,
            inside: &[],
            children: &[],
            of_facet: &[],
        },
        vtk: 12,
        gmsh: 5,
    };
    let rule = CORNERS.map(|corner| (corner.map(|c| c / 3f64.sqrt()), 1.0));
    Table::new(&row, &rule)
});

fn steel() -> Lame {
    super::steel(Space::PlaneStrain)
}

fn distorted() -> [[f64; 3]; 8] {
    let mut k = 0.0;
    CORNERS.map(|x| {
        x.map(|x| {
            k += 1.0;
            2.0 + x + 0.2 * f64::sin(7.0 * k)
        })
    })
}

fn moved(seed: f64) -> [[f64; 3]; 8] {
    std::array::from_fn(|k| std::array::from_fn(|d| f64::sin(seed + (3 * k + d) as f64 * 1.7)))
}

fn full_stiffness(solid: &Solid) -> Vec<f64> {
    let mut k = vec![0.0; 24 * 25 / 2];
    solid.stiffness_into(&steel(), &mut k);
    k
}

fn times(k: &[f64], u: &[[f64; 3]; 8]) -> Vec<f64> {
    let u = u.as_flattened();
    (0..24)
        .map(|i| (0..24).map(|j| k[packed(i, j)] * u[j]).sum())
        .collect()
}

#[test]
fn a_linear_field_is_exact_and_a_rigid_motion_free() {
    let x = distorted();
    let h = [[0.3, -0.2, 0.1], [0.5, 0.1, 0.7], [-0.4, 0.6, 0.2]];
    let exact = [0.3, 0.1, 0.2, 0.3, 1.3, -0.3];
    for has_mean in [false, true] {
        let solid = Solid::new(&TABLE, Space::PlaneStrain, has_mean, &x);
        let u = x.map(|x| h.map(|row| row.iter().zip(x).map(|(h, x)| h * x).sum::<f64>()));
        for (lanes, exact) in solid.strains(&u).iter().zip(exact) {
            assert!(
                lanes.iter().all(|e| (e - exact).abs() < 1e-14),
                "{lanes:?} {exact}"
            );
        }
        let turned = x.map(|[x, y, z]| [0.3 * z - 0.2 * y, 0.2 * x - 0.5 * z, 0.5 * y - 0.3 * x]);
        let k = full_stiffness(&solid);
        assert!(times(&k, &turned).iter().all(|f| f.abs() < 1e-12));
        let volume = solid.weights().iter().sum::<f64>();
        assert!(volume > 6.0 && volume < 10.0);
    }
}

/// `K u` is the force of the stress of the strain of u, with and without a mean dilatation.
#[test]
fn the_stiffness_is_force_of_stress_of_strain() {
    for has_mean in [false, true] {
        let solid = Solid::new(&TABLE, Space::PlaneStrain, has_mean, &distorted());
        let u = moved(0.4);
        let strain = solid.strains(&u);
        let mut stress = [[0.0; 8]; 6];
        for g in 0..8 {
            let at_point = steel().times(&strain.map(|lanes| lanes[g]));
            (0..6).for_each(|c| stress[c][g] = at_point[c]);
        }
        let forces = solid.forces(&stress);
        for (f, k) in forces
            .as_flattened()
            .iter()
            .zip(times(&full_stiffness(&solid), &u))
        {
            assert!((f - k).abs() < 1e-12, "{f} {k}");
        }
        // The work of the forces in another motion is that of the stresses.
        let other = moved(2.1);
        let of_other = solid.strains(&other);
        let work: f64 = (0..8)
            .map(|g| {
                let at_point = (0..6).map(|c| stress[c][g] * of_other[c][g]).sum::<f64>();
                solid.weights()[g] * at_point
            })
            .sum();
        let outer = forces.as_flattened().iter().zip(other.as_flattened());
        let outer: f64 = outer.map(|(f, u)| f * u).sum();
        assert!((work - outer).abs() < 1e-12, "{work} {outer}");
    }
}

/// A `quad4` extruded by its thickness 1 in plane strain: the forces of both layers together are
/// those of the plane element.
#[test]
fn an_extruded_plane_element_is_the_plane_element() {
    let flat = coordinates(Shape::Quad4);
    let x: [[f64; 3]; 8] = std::array::from_fn(|k| {
        let [x, y] = flat[k % 4];
        [x, y, if k < 4 { 0.0 } else { 1.0 }]
    });
    let plane = PlaneGradients::gauss(Space::PlaneStrain, Shape::Quad4, &flat);
    let solid = Solid::new(&TABLE, Space::PlaneStrain, true, &x);
    let mut in_plane = vec![0.0; 36];
    plane.stiffness_into(&steel(), &mut in_plane);
    let in_space = full_stiffness(&solid);
    for (i, j) in (0..8).flat_map(|i| (0..=i).map(move |j| (i, j))) {
        let at = |freedom: usize, layer: usize| 3 * (freedom / 2 + 4 * layer) + freedom % 2;
        let layers = [(0, 0), (0, 1), (1, 0), (1, 1)];
        let terms = layers.map(|(a, b)| in_space[packed(at(i, a), at(j, b))]);
        let sum: f64 = terms.iter().sum();
        assert!((sum - in_plane[packed(i, j)]).abs() < 1e-13, "{i} {j}");
    }
}

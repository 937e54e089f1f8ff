//! Tests of the kernel in three dimensions.

use super::*;

type Solid = Gradients<3, 6, 8, 20>;
const CORNERS: usize = 8;

fn steel() -> Lame {
    super::steel(Space::PlaneStrain)
}

/// A hexahedron with the gradients of B-bar or with plain gradients.
fn solid(has_mean: bool, x: &[[f64; 3]; 20]) -> Solid {
    let mut solid = Kernel::solid().gauss((Shape::Hex8, Integration::Reduced), x);
    solid.has_mean = has_mean;
    solid
}

fn distorted() -> [[f64; 3]; 20] {
    let mut k = 0.0;
    let mut out = [[0.0; 3]; 20];
    for (out, x) in out.iter_mut().zip(Shape::Hex8.reference().nodes) {
        *out = x.map(|x| {
            k += 1.0;
            2.0 + x + 0.2 * f64::sin(7.0 * k)
        });
    }
    out
}

fn moved(seed: f64) -> [[f64; 3]; 20] {
    let mut out = [[0.0; 3]; 20];
    for (k, u) in out.iter_mut().enumerate().take(CORNERS) {
        *u = std::array::from_fn(|d| f64::sin(seed + (3 * k + d) as f64 * 1.7));
    }
    out
}

fn full_stiffness(solid: &Solid) -> Vec<f64> {
    let mut k = vec![0.0; 24 * 25 / 2];
    solid.stiffness_into(&steel(), &mut k);
    k
}

fn times(k: &[f64], u: &[[f64; 3]; 20]) -> Vec<f64> {
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
        let solid = solid(has_mean, &x);
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

/// `K u` is the nodal force of the stress for the strain of `u`, with and without a mean
/// dilatation.
#[test]
fn the_stiffness_is_force_of_stress_of_strain() {
    for has_mean in [false, true] {
        let solid = solid(has_mean, &distorted());
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
        // The work of the nodal forces in another motion equals the work of the stresses.
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

/// A `quad4` in plane strain, extruded by a thickness of 1: the forces of both layers together are
/// those of the plane element.
#[test]
fn an_extruded_plane_element_is_the_plane_element() {
    let flat = coordinates(Shape::Quad4);
    let mut x = [[0.0; 3]; 20];
    for (k, point) in x.iter_mut().enumerate().take(CORNERS) {
        let [x, y] = flat[k % 4];
        *point = [x, y, if k < 4 { 0.0 } else { 1.0 }];
    }
    let plane = gauss(Space::PlaneStrain, Shape::Quad4, &flat);
    let solid = solid(true, &x);
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

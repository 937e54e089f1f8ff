//! Resolution where it counts: each part of a mesh as fine as its share of the error asks for.
//!
//! Uniform refinement halves every element, also those that add nothing to the error. A generated mesh has two parts that can be
//! refined alone:
//!
//! | mesh | near | far |
//! |---|---|---|
//! | `cylinder_on_half_plane`, `disc_in_plate` | round contact and first yield: `resolution` | away from them: `growth`, `far_growth` |
//! | one ring or block | along its first direction | along its second |
//!
//! What a part adds to the error of a quantity is measured, not guessed: on a coarse mesh, the pilot, the far part alone is made
//! coarser by `f`, which changes a quantity of order `p` by `f^p - 1` times what that part adds; the near part adds the rest of the
//! pilot's estimated error. An indicator of the energy norm would share alike among all distances from a line contact
//! (its energy per octave of the distance is the same), while what happens far away hardly reaches the contact.
//! For that reason, too, the growth of the elements rises with the distance ([`RISE`]).
//!
//! With `e_near` and `e_far` the errors of the pilot, elements `a` times as fine near and `b = v a` times as fine far away leave
//! `a^-p (e_near + e_far v^-p)`: of all `v` that one is taken whose mesh has the fewest elements for the error wanted.

use super::quantities::{Quantity, value_of};
use super::refinement::{MOST_GROWTH, refined};
use crate::mesh::generate;
use crate::model::contact_size;
use crate::scene::{Kind, MeshSource, Scene};

/// Power of the distance with which the logarithm of the growth rises. Stresses under a load decay with `1/r`, what a stress at distance
/// `r` adds to those at the contact with `1/r^2`: with elements of size `h = L r` the error per octave falls with `L^2/r`, its
/// price is `1/L`, and the cheapest is `L ~ r^(1/3)`. Measured (contact of a line and of a point, errors and flops over
/// powers from 0 to 0.4) the best lies at 1/4, flatly.
const RISE: f64 = 0.25;
/// What a rising growth saves far away is spent near: this power of the growth there. Measured on the contact of a line (powers from 0.5 to 1,
/// rises from 0.15 to 0.45), from 4 to 18 elements over the contact the errors of uniform meshes then cost 0.46 of their operations, and errors of load and
/// pressure are alike; 2/3 costs 0.57.
const NEAR: f64 = 0.5;
/// The same under a point, where stresses decay with `1/r^2` and the pressure on the axis governs, which the mesh beside it makes: 0.24 to 0.27 of
/// the operations for 1.3 to 8/3 in steps, flat up to 4.
const NEAR_POINT: f64 = 8.0 / 3.0;
/// The same for the disc in a plate, whose plate is a few times as wide: 0.9 of the operations at the same yield load, 0.8 where the half
/// width governs.
const NEAR_DISC: f64 = 0.93;
/// The far part of the pilot is this much coarser in the run that tells its share.
const COARSER: f64 = 1.5;
/// Ratios of far to near fineness, over that of the pilot, that are weighed: how much coarser the far part may be. It begins fine
/// ([`NEAR`]), and where a contact of a line would have it finer still, errors per operation hardly change.
const RATIOS: [f64; 4] = [0.35, 0.5, 0.71, 1.0];
/// Fewest elements along a direction of a ring or block: coarser companions must still tell something.
const FEWEST: f64 = 6.0;
/// Operations of a factorisation of a plane mesh grow with this power of its elements.
const FLOPS: f64 = 1.5;
/// Another shape than the pilot's is taken where it costs less than this share: runs of one family serve each other.
const WORTH: f64 = 0.6;

/// The scene with elements that grow faster with the distance, where its generator knows that and it does not say how.
pub(super) fn risen(scene: &Scene) -> Scene {
    let mut out = scene.clone();
    let near = match scene.kind {
        Kind::Axisymmetric => NEAR_POINT,
        _ => NEAR,
    };
    let rise = |near: f64, growth: &mut f64, far: &mut Option<f64>, distances: f64| {
        if far.is_none() && *growth > 1.0 {
            *growth = growth.powf(near).min(MOST_GROWTH);
            *far = Some(growth.powf(distances.powf(RISE)).min(MOST_GROWTH));
        }
    };
    if let Some(p) = &mut out.mesh.cylinder_on_half_plane {
        let fine = p.fine_width.max(p.fine_depth);
        rise(near, &mut p.growth, &mut p.far_growth, p.far_size / fine);
    }
    if let Some(p) = &mut out.mesh.disc_in_plate {
        rise(NEAR_DISC, &mut p.growth, &mut p.far_growth, p.far_radius);
    }
    out
}

/// `scene` with its near part `near` times as fine and its far part `far` times; `None` where the mesh has no such parts.
fn with_parts(scene: &Scene, near: f64, far: f64) -> Option<Scene> {
    let mut out = refined(scene, near)?.scene;
    let mesh = &mut out.mesh;
    // `refined` rounds to whole elements and takes the far part along: what it lacks is made up for.
    let raise = |growth: f64, made: f64| growth.powf(1.0 / (far * made)).min(MOST_GROWTH);
    if let (Some(p), Some(old)) = (
        &mut mesh.cylinder_on_half_plane,
        &scene.mesh.cylinder_on_half_plane,
    ) {
        let made = p.resolution as f64 / old.resolution as f64 / near;
        p.growth = raise(old.growth, made);
        p.far_growth = old.far_growth.map(|g| raise(g, made).max(p.growth));
    } else if let (Some(p), Some(old)) = (&mut mesh.disc_in_plate, &scene.mesh.disc_in_plate) {
        let made = p.resolution as f64 / old.resolution as f64 / near;
        p.growth = raise(old.growth, made);
        p.far_growth = old.far_growth.map(|g| raise(g, made).max(p.growth));
    } else {
        let [_, old] = directions(&mut scene.mesh.clone())?.map(|n| *n);
        let [_, new] = directions(mesh)?;
        *new = (old as f64 * far).round().max(1.0) as usize;
    }
    Some(out)
}

/// The element counts of a mesh of one ring or block.
fn directions(mesh: &mut MeshSource) -> Option<[&mut usize; 2]> {
    match mesh.parts.as_mut()?.as_mut_slice() {
        [part] => match (&mut part.block, &mut part.ring) {
            (Some(block), None) => Some(block.elements.each_mut()),
            (None, Some(ring)) => Some(ring.elements.each_mut()),
            _ => None,
        },
        _ => None,
    }
}

/// The pilot with its far part coarser, for the share of that part.
pub(super) fn far_coarser(pilot: &Scene) -> Option<Scene> {
    let out = with_parts(pilot, 1.0, 1.0 / COARSER)?;
    (elements(&out)? < elements(pilot)?).then_some(out)
}

/// Errors of a quantity on the pilot, relative to what is wanted.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    near: f64,
    far: f64,
    order: f64,
}

/// The error of a quantity on the pilot.
#[derive(Debug, Clone, Copy)]
pub(super) struct PilotError {
    /// Discretisation error.
    pub error: f64,
    /// Its order.
    pub order: f64,
    /// What of it is stated.
    pub safety: f64,
}

/// Shares of the two parts in the stated errors of the governing quantities. `far_order` is the order of the far part; `wanted` is relative to the largest
/// size of each quantity.
pub(super) fn shares(
    pilot: &[Quantity],
    errors: &[PilotError],
    far_coarser: &[Quantity],
    far_order: f64,
    wanted: f64,
) -> Vec<Share> {
    let rows = pilot.iter().zip(errors);
    rows.filter(|(quantity, _)| quantity.governs && quantity.scale > 0.0)
        .filter_map(|(quantity, told)| {
            let other = value_of(far_coarser, &quantity.path)?;
            let far = (other - quantity.value).abs() / (COARSER.powf(far_order) - 1.0);
            let unit = told.safety / (quantity.scale * wanted);
            Some(Share {
                near: (told.error - far).max(0.0) * unit,
                far: far * unit,
                order: told.order,
            })
        })
        .collect()
}

/// The pilot with its far part so much finer or coarser that, refined as a whole until the error is the wanted one, it has the fewest
/// elements; and by how much it must then be refined.
pub(super) fn balanced(pilot: &Scene, shares: &[Share], most: f64) -> Option<(Scene, f64)> {
    let factor = |ratio: f64| {
        let needed = shares
            .iter()
            .map(|s| (s.near + s.far * ratio.powf(-s.order)).powf(1.0 / s.order));
        needed.fold(0.0, f64::max)
    };
    // Compared at one error; a mesh far finer than the next would only cost time to count.
    let scale = (most / factor(1.0).max(f64::MIN_POSITIVE)).min(1.0);
    RATIOS
        .iter()
        .filter_map(|&ratio| {
            let near = factor(ratio);
            let shaped = with_parts(pilot, 1.0, ratio)?;
            let grown = with_parts(pilot, near * scale, near * scale * ratio)?;
            let few = directions(&mut shaped.mesh.clone())
                .is_some_and(|n| n.iter().any(|n| (**n as f64) < FEWEST));
            let worth = if ratio == 1.0 { WORTH } else { 1.0 };
            let price = worth * (elements(&grown)? as f64).powf(FLOPS);
            (!few || ratio == 1.0).then_some((price, shaped, near))
        })
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, shaped, near)| (shaped, near))
}

/// Elements of a generated mesh.
pub(super) fn elements(scene: &Scene) -> Option<usize> {
    generate::from_source(&scene.mesh, None, |p| contact_size::of(scene, p))
        .ok()
        .map(|mesh| mesh.n_elements())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cylinder() -> Scene {
        let text = include_str!("../../data/scenes/cylinder_on_half_plane.toml");
        risen(&Scene::parse(text, "scene.toml").unwrap())
    }

    fn share(near: f64, far: f64) -> Share {
        Share {
            near,
            far,
            order: 2.0,
        }
    }

    #[test]
    fn the_far_part_alone_is_refined() {
        let scene = cylinder();
        let finer = with_parts(&scene, 1.0, 2.0).unwrap();
        let [old, new] = [&scene, &finer].map(|s| s.mesh.cylinder_on_half_plane.clone().unwrap());
        assert_eq!(new.resolution, old.resolution);
        assert!((new.growth.powi(2) / old.growth - 1.0).abs() < 1e-12);
        let [far, near] = [new.far_growth.unwrap(), old.far_growth.unwrap()];
        assert!((far.powi(2) / near - 1.0).abs() < 1e-12 && far > new.growth);
        assert!(elements(&finer) > elements(&scene));
        assert!(elements(&far_coarser(&scene).unwrap()) < elements(&scene));
    }

    #[test]
    fn a_rising_growth_saves_elements() {
        let text = include_str!("../../data/scenes/cylinder_on_half_plane.toml");
        let scene = Scene::parse(text, "scene.toml").unwrap();
        // Fewer, though beside the contact they grow half as fast.
        assert!(elements(&cylinder()).unwrap() < elements(&scene).unwrap());
        let growth = |s: &Scene| s.mesh.cylinder_on_half_plane.as_ref().unwrap().growth;
        assert!((growth(&cylinder()).powf(1.0 / NEAR) / growth(&scene) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn resolution_goes_where_the_error_is() {
        let scene = cylinder();
        let growth = |shares: &[Share]| {
            let (shaped, factor) = balanced(&scene, shares, 2.0).unwrap();
            (shaped.mesh.cylinder_on_half_plane.unwrap().growth, factor)
        };
        let (near, factor) = growth(&[share(4.0, 0.04)]);
        // Four times the wanted error, of second order: twice as fine, little more for the coarser far part.
        assert!((2.0..2.2).contains(&factor), "{factor}");
        let (far, _) = growth(&[share(0.04, 4.0)]);
        let own = scene.mesh.cylinder_on_half_plane.as_ref().unwrap().growth;
        assert!(near > far && far == own, "{near} {far} {own}");
    }

    #[test]
    fn shares_are_told_from_a_coarser_far_part() {
        let quantity = |value: f64| Quantity {
            path: "yield.load".into(),
            value,
            scale: 10.0,
            governs: true,
        };
        // Far part 0.1 of second order: 1.5 times coarser changes it by 1.25 times that.
        let found = shares(
            &[quantity(9.7)],
            &[PilotError {
                error: 0.3,
                order: 2.0,
                safety: 1.0,
            }],
            &[quantity(9.575)],
            2.0,
            0.01,
        );
        assert!(
            (found[0].far - 1.0).abs() < 1e-9 && (found[0].near - 2.0).abs() < 1e-9,
            "{found:?}"
        );
    }

    #[test]
    fn a_ring_has_two_directions_and_a_file_none() {
        let text = include_str!("../../data/scenes/thick_cylinder.toml");
        let scene = Scene::parse(text, "scene.toml").unwrap();
        let mut finer = with_parts(&scene, 1.0, 0.5).unwrap();
        assert_eq!(directions(&mut finer.mesh).unwrap().map(|n| *n), [16, 8]);
        // Never too few for its companions.
        let (mut shaped, _) = balanced(&scene, &[share(4.0, 0.0)], 2.0).unwrap();
        assert_eq!(directions(&mut shaped.mesh).unwrap().map(|n| *n), [16, 6]);
        let text = include_str!("../../data/scenes/gmsh_blocks.toml");
        let file = Scene::parse(text, "scene.toml").unwrap();
        assert!(far_coarser(&file).is_none());
    }
}

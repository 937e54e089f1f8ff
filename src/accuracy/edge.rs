//! Where in an element a contact ends, and what that leaves of its half width.
//!
//! The edge is read off forces of whole pairs, so that its error is a share of a node spacing that depends on the place of the edge
//! between two nodes, the same on every mesh. On the disc in a plate (12 to 240 elements over the quarter circle) the contact comes out too small by
//!
//! | edge at, of a spacing | 0.06 | 0.2 to 0.45 | 0.53 | 0.6 | 0.7 | 0.75 to 0.8 | 0.85 | 0.9 | 0.98 |
//! |---|---|---|---|---|---|---|---|---|---|
//! | spacings | 0.03 | 0.014 to 0.021 | 0.03 | 0.038 | 0.06 | 0.10 to 0.106 | 0.07 | 0.06 | 0.05 |
//!
//! with uniform and with graded meshes. No order of convergence describes that, and an extrapolation over meshes sees it only by chance; but a
//! mesh can be chosen on which the edge falls where it is read best. The cylinder on a half plane has its fine mesh made to the measure of
//! the contact, with the edge at the same place of a spacing on all meshes.

use super::ladder::spacings;
use super::quantities::Quantity;
use super::refinement::CONTACT_OF_QUARTER;
use crate::mesh::Shape;
use crate::results::Results;
use crate::scene::{DiscInPlate, Kind, Scene};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

/// Node spacings within which the edge of an elastic contact is known, at best and at worst, with a fifth to spare. The stated error, its factor
/// of safety included, lies between the two.
const EDGE: [f64; 2] = [0.02, 0.125];
/// The same at best under a point, where nodes stand for rings: 0.08 with 5 elements over the contact, 0.037 with 12, 0.03 with 26 to 40.
const LEAST_UNDER_A_POINT: f64 = 0.04;
/// The same at worst where the edge is read best, with a fifth to spare.
const WELL_READ: f64 = 0.025;
/// Where the edge, as it is read, must lie for that: shares of a spacing beyond a node.
const READ_WINDOW: [f64; 2] = [0.2, 0.44];
/// Where it is aimed to lie: the reading is short by 0.02.
const AIMED_WINDOW: [f64; 2] = [0.23, 0.45];
/// How much coarser a mesh may be made for it, before a finer one is taken.
const COARSER: f64 = 0.9;
/// How much finer at most: the window comes by twice in ten elements over the quarter circle.
const FINER: f64 = 1.6;

/// The generator of a disc whose contact recedes to an angle that hardly depends on the load.
fn receding(scene: &Scene) -> Option<&DiscInPlate> {
    let disc = scene.mesh.disc_in_plate.as_ref()?;
    (disc.interference == 0.0 && disc.element == Shape::Quad4).then_some(disc)
}

/// Spacings over a contact of this half width.
fn count(disc: &DiscInPlate, half_width: f64) -> f64 {
    disc.resolution as f64 * half_width / (FRAC_PI_2 * disc.radius)
}

/// What a contact half width is off by at least and at most. Measured on `quad4` at first yield, and known where the generator sizes the elements by the
/// contact; at most where nothing has flowed yet.
pub(super) fn known(scene: &Scene, results: &Results, quantity: &Quantity) -> Option<[f64; 2]> {
    let (prefix, "half_width") = quantity.path.rsplit_once('.')? else {
        return None;
    };
    let [mut least, mut most] = EDGE;
    if scene.kind == Kind::Axisymmetric {
        least = LEAST_UNDER_A_POINT;
    }
    let at_yield = results.first_yield?.half_width;
    match (&scene.mesh.cylinder_on_half_plane, receding(scene)) {
        (Some(p), _) if p.half_width.is_none() && p.element == Shape::Quad4 => {}
        (None, Some(disc)) => {
            let place = count(disc, at_yield).fract();
            if (READ_WINDOW[0]..=READ_WINDOW[1]).contains(&place) {
                most = WELL_READ;
            }
        }
        _ => return None,
    }
    let spacing = at_yield / spacings(scene)?;
    match prefix {
        "yield" => Some([least, most].map(|e| e * spacing)),
        _ if quantity.value > 0.0 => Some([least * spacing, f64::INFINITY]),
        _ => None,
    }
}

/// Half widths closer than this share are the same.
const SAME: f64 = 1e-9;

/// What a half width is off by at least that is the same on all meshes, though its contact does not end where the surface does: the edge was found at a
/// node that these meshes share, which says no more than that it lies beside. `None` for any other.
pub(super) fn at_shared_node(results: &Results, path: &str, values: &[(f64, f64)]) -> Option<f64> {
    let (prefix, "half_width") = path.rsplit_once('.')? else {
        return None;
    };
    let own = values.first()?.1;
    let is_same = |v: &(f64, f64)| (v.1 - own).abs() <= SAME * own;
    if own <= 0.0 || values.len() < 2 || !values.iter().all(is_same) {
        return None;
    }
    let name = prefix.strip_prefix("states.")?;
    let state = results.states.iter().find(|s| s.name == name)?;
    let mut forces: BTreeMap<usize, f64> = BTreeMap::new();
    for pair in &state.pairs {
        *forces.entry(pair.contact).or_default() += pair.force;
    }
    let (&strongest, _) = forces.iter().max_by(|a, b| a.1.total_cmp(b.1))?;
    let pairs: Vec<_> = (state.pairs.iter())
        .filter(|pair| pair.contact == strongest)
        .collect();
    let edges = pairs
        .windows(2)
        .filter(|two| two[0].status != two[1].status);
    edges
        .map(|two| {
            let [a, b] = [two[0].position, two[1].position];
            (a[0] - b[0]).hypot(a[1] - b[1])
        })
        .reduce(f64::max)
}

/// The scene with about as many elements, on which the edge of the contact is read well: where the demand needs that. `half_width` is that of a
/// coarser mesh, with its scene.
pub(super) fn well_read(scene: &Scene, demand: f64, coarser: Option<(&Scene, f64)>) -> Scene {
    let mut out = scene.clone();
    let Some(disc) = receding(scene) else {
        return out;
    };
    // Another load, or other materials, leave another angle than one material under tension.
    let read = coarser.and_then(|(scene, width)| {
        let disc = receding(scene)?;
        let share = width / (FRAC_PI_2 * disc.radius);
        let off = (share - CONTACT_OF_QUARTER).abs() * disc.resolution as f64;
        (off > EDGE[1]).then_some(share)
    });
    let share = read.unwrap_or(CONTACT_OF_QUARTER);
    let n = disc.resolution;
    if EDGE[1] / (n as f64 * share) <= demand {
        return out;
    }
    let fits = |m: &usize| {
        let place = (*m as f64 * share).fract();
        (AIMED_WINDOW[0]..=AIMED_WINDOW[1]).contains(&place)
    };
    let run = coarser
        .and_then(|(scene, _)| receding(scene))
        .map_or(0, |d| d.resolution);
    let least = ((COARSER * n as f64).ceil() as usize).max(run + 1);
    let most = (FINER * n as f64) as usize;
    let even = |m: &usize| m.is_multiple_of(2);
    let below = (least..=n).rev().filter(even).find(fits);
    let Some(m) = below.or_else(|| (n..=most).filter(even).find(fits)) else {
        return out;
    };
    if let Some(level) = super::refinement::refined(scene, m as f64 / n as f64) {
        out = level.scene;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{PairState, State, Status, YieldPoint};

    fn disc(n: usize) -> Scene {
        let text = include_str!("../../data/scenes/disc_in_plate.toml");
        let mut scene = Scene::parse(text, "scene.toml").unwrap();
        scene.mesh.disc_in_plate.as_mut().unwrap().resolution = n;
        scene
    }

    fn resolution(scene: &Scene) -> usize {
        scene.mesh.disc_in_plate.as_ref().unwrap().resolution
    }

    #[test]
    fn a_mesh_is_chosen_on_which_the_edge_is_read_well() {
        // 46 elements end the contact at 0.03 of a spacing, 52 at 0.34.
        for (n, wanted) in [(22, 20), (46, 52), (68, 66), (130, 130)] {
            assert_eq!(resolution(&well_read(&disc(n), 1e-4, None)), wanted);
        }
        // Never one that was run: 38 elements have the edge at 0.29.
        let width = FRAC_PI_2 * 10.0 * CONTACT_OF_QUARTER;
        assert_eq!(resolution(&well_read(&disc(40), 1e-4, None)), 38);
        assert_eq!(
            resolution(&well_read(&disc(40), 1e-4, Some((&disc(38), width)))),
            52
        );
        // Not where the worst place is good enough, nor on a mesh of another kind.
        assert_eq!(resolution(&well_read(&disc(22), 0.03, None)), 22);
        // Another angle: a seventh of the quarter, 20 degrees of 140.
        let width = FRAC_PI_2 * 10.0 / 7.0;
        let other = well_read(&disc(70), 1e-4, Some((&disc(60), width)));
        let place = (resolution(&other) as f64 / 7.0).fract();
        assert!(
            (AIMED_WINDOW[0]..=AIMED_WINDOW[1]).contains(&place),
            "{place}"
        );
    }

    /// Results with first yield at a half width of so many spacings, and a quantity of that size.
    fn read(n: usize, spacings: f64) -> (Results, impl Fn(&str) -> Quantity) {
        let half_width = spacings / n as f64 * FRAC_PI_2 * 10.0;
        let first = YieldPoint {
            alpha: 1.0,
            load: 1.0,
            max_pressure: 1.0,
            half_width,
            location: [0.0; 2],
            body: 0,
        };
        let results = Results {
            first_yield: Some(first),
            ..Results::default()
        };
        let quantity = move |path: &str| Quantity {
            path: path.to_string(),
            value: half_width,
            scale: half_width,
            governs: true,
        };
        (results, quantity)
    }

    #[test]
    fn a_half_width_is_known_by_where_its_edge_lies() {
        let at = |n: usize, spacings: f64| {
            let (results, quantity) = read(n, spacings);
            let [_, most] = known(&disc(n), &results, &quantity("yield.half_width")).unwrap();
            most / quantity("").value * n as f64 * CONTACT_OF_QUARTER
        };
        assert!((at(52, 11.32) - WELL_READ).abs() < 1e-12);
        assert!((at(46, 9.99) - EDGE[1]).abs() < 1e-12);
        let (results, quantity) = read(52, 11.32);
        assert_eq!(known(&disc(52), &results, &quantity("yield.load")), None);
        // Later nothing is known but the least.
        let later = known(&disc(52), &results, &quantity("states.pressed.half_width")).unwrap();
        assert!(later[0] > 0.0 && later[1].is_infinite());
    }

    /// Five pairs half a millimetre apart, so many of them closed.
    #[test]
    fn an_edge_at_a_shared_node_says_no_more_than_that_it_is_near() {
        let with_closed = |closed: usize| {
            let pair = |i: usize| PairState {
                pair: i,
                contact: 0,
                position: [0.5 * i as f64, 0.0],
                gap: 0.0,
                force: f64::from(u8::from(i < closed)),
                area: 0.5,
                pressure: 0.0,
                status: if i < closed {
                    Status::Closed
                } else {
                    Status::Open
                },
            };
            let state = State {
                name: "pressed".into(),
                pairs: (0..5).map(pair).collect(),
                ..State::default()
            };
            Results {
                states: vec![state],
                ..Results::default()
            }
        };
        let path = "states.pressed.half_width";
        let same = [(1.0, 1.5), (1.5, 1.5), (2.0, 1.5)];
        let partly = with_closed(3);
        assert_eq!(at_shared_node(&partly, path, &same), Some(0.5));
        // It moves, ends where the surface does, or is another quantity.
        let moves = [(1.0, 1.5), (1.5, 1.6)];
        assert_eq!(at_shared_node(&partly, path, &moves), None);
        assert_eq!(at_shared_node(&with_closed(5), path, &same), None);
        let load = "states.pressed.load";
        assert_eq!(at_shared_node(&partly, load, &same), None);
    }
}

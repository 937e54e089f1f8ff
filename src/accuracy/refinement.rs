//! The same scene on a finer or coarser mesh of the same family.
//!
//! In a family every element size, also where elements grow with the distance, is multiplied by the same ratio `h`: a
//! growth `g` from element to element becomes `g^h`. With a fixed growth only the evenly meshed part would refine and
//! the error would level off at that of the growing part. A mesh from a file and its subdivisions are a family too.

use crate::error::Result;
use crate::mesh::{Shape, generate};
use crate::model::contact_size;
use crate::scene::{MeshSource, Part, Scene};

/// Elements over the part of the mesh that governs the result (the contact, the thickness of a part) below which a mesh tells
/// nothing about the next one.
pub(super) const FEWEST: f64 = 5.0;
/// Share of the quarter circle over which a disc in a plate stays in contact.
pub(super) const CONTACT_OF_QUARTER: f64 = 19.625 / 90.0;
/// Most by which rounding to whole elements may distort a part of the mesh against the others.
const DISTORTION: f64 = 0.2;
/// Least change of the element size that makes another level of it.
const LEAST_CHANGE: f64 = 1.15;
/// Greatest growth the generators take.
pub(super) const MOST_GROWTH: f64 = 100.0;
/// Distance between a piece's end and a node, in elements, up to which they coincide.
const ON_NODE: f64 = 1e-6;
/// Largest number that element counts are made multiples of, but for the scene's own.
const LARGEST_STEP: usize = 1000;
/// Elements over what governs the result that a coarser mesh must have to tell the error of a finer one: below, the errors of the
/// recovered stress and of the elements, of different order and sign, cancel by chance (Hertz' point contact: at five).
const TELLING: f64 = 6.0;
/// Elements from which on one finer mesh is enough beside a coarser one.
const BRACKETED: f64 = 12.0;
/// Element counts of the meshes for comparison over that of the run, most wanted first. Where the run is fine enough, coarser ones: the
/// first pair costs a quarter of it at most.
const COARSER: [f64; 6] = [
    1.0 / 2.0,
    3.0 / 8.0,
    2.0 / 3.0,
    1.0 / 4.0,
    3.0 / 4.0,
    1.0 / 3.0,
];
/// Coarser ones near the run.
const NEAR: [f64; 6] = [
    2.0 / 3.0,
    1.0 / 2.0,
    3.0 / 4.0,
    5.0 / 8.0,
    3.0 / 8.0,
    1.0 / 4.0,
];
/// One coarser and one finer.
const BRACKET: [f64; 5] = [2.0 / 3.0, 3.0 / 2.0, 3.0 / 4.0, 5.0 / 4.0, 2.0];
/// Where the run is as coarse as a mesh can be to tell anything: finer ones, which cost little then.
const FINER: [f64; 5] = [3.0 / 2.0, 2.0, 5.0 / 4.0, 3.0, 4.0];
/// Elements from which on a mesh tells something of its own error, together with finer ones; with fewer these alone say where it should be
/// ([`super::extrapolation::beside_finer`]).
const LEGIBLE: f64 = 8.0;
/// Finer ones, out of reach of what is wrong with such a mesh.
const FAR_FINER: [f64; 4] = [2.0, 3.0, 4.0, 5.0];
/// Elements up to which a mesh from a file is compared with its subdivision, and up to which with that of the subdivision: they
/// have four and sixteen times as many.
const SUBDIVIDED: [usize; 2] = [2000, 400];

/// A scene with another mesh of its family.
#[derive(Debug, Clone)]
pub struct Level {
    /// The scene.
    pub scene: Scene,
    /// Element size over that of the scene it was made from.
    pub ratio: f64,
}

/// The scene with `factor` times as many elements along each line, rounded to what the generator can make and to nodes at the ends of
/// pieces of blocks; `None` where there is no such member of the family (pieces of a block whose elements grow; a mesh from a file has
/// those that are 2, 4, ... times as fine as the file).
pub fn refined(scene: &Scene, factor: f64) -> Option<Level> {
    let mut out = scene.clone();
    let count = |n: usize, step: usize| -> usize {
        let steps = (n as f64 * factor / step as f64).round().max(1.0);
        (steps.min(1e9) as usize).saturating_mul(step)
    };
    let ratio = if let Some(p) = &mut out.mesh.cylinder_on_half_plane {
        let n = count(p.resolution, 1);
        let ratio = p.resolution as f64 / n as f64;
        p.resolution = n;
        p.growth = p.growth.powf(ratio);
        p.far_growth = p.far_growth.map(|g| g.powf(ratio).min(MOST_GROWTH));
        ratio
    } else if let Some(p) = &mut out.mesh.disc_in_plate {
        let n = count(p.resolution, 2);
        let ratio = p.resolution as f64 / n as f64;
        p.resolution = n;
        p.growth = p.growth.powf(ratio);
        p.far_growth = p.far_growth.map(|g| g.powf(ratio).min(MOST_GROWTH));
        ratio
    } else if let Some(parts) = &mut out.mesh.parts {
        let mut ratios = Vec::new();
        let family = parts.clone();
        for n in parts.iter_mut().flat_map(counts_of) {
            let new = count(*n, step(&family, *n));
            ratios.push((*n as f64 / new as f64, *n));
            *n = new;
        }
        let (ratio, _) = ratios.iter().max_by_key(|r| r.1)?;
        if ratios
            .iter()
            .any(|r| (r.0 / ratio - 1.0).abs() > DISTORTION)
        {
            return None;
        }
        let fits = |part: &Part| (0..2).all(|axis| ends_on_nodes(part, axis, None));
        if !parts.iter().all(fits) {
            return None;
        }
        *ratio
    } else {
        out.mesh.file.as_ref()?;
        let halvings = factor.log2().round();
        if (factor.log2() - halvings).abs() > ON_NODE {
            return None;
        }
        let subdivisions = out.mesh.subdivisions as f64 + halvings;
        if !(0.0..=f64::from(u16::MAX)).contains(&subdivisions) {
            return None;
        }
        out.mesh.subdivisions = subdivisions as usize;
        0.5f64.powf(halvings)
    };
    Some(Level { scene: out, ratio })
}

/// Factors by which the meshes of a study are finer than the scene's, finest first: `levels` of them from `finest`, `step` apart;
/// of a file those from the scene's own on that are 2 apart, over the same range.
pub(super) fn factors(scene: &Scene, finest: f64, step: f64, levels: usize) -> Vec<f64> {
    if scene.mesh.file.is_none() {
        return (0..levels.max(1) as i32)
            .map(|i| finest / step.powi(i))
            .collect();
    }
    let range = ((levels.max(1) - 1) as f64 * step.log2()).floor() as i32;
    (0..=range).map(|i| 2f64.powi(range - i)).collect()
}

/// The two meshes from which the error of the scene's own is extrapolated, finer one first; fewer where the family has not
/// that many. `elements` are those of the run: what a finer mesh may cost depends on them.
pub fn companions(scene: &Scene, elements: usize) -> Vec<Level> {
    let wanted: &[f64] = match governing_count(&scene.mesh) {
        Some(n) if n * COARSER[1] >= TELLING => &COARSER,
        Some(n) if n >= BRACKETED => &BRACKET,
        Some(n) if n >= LEGIBLE => &FINER,
        Some(_) => &FAR_FINER,
        None => match SUBDIVIDED.map(|most| elements <= most) {
            _ if scene.mesh.subdivisions >= 2 => &[0.5, 0.25],
            [true, _] if scene.mesh.subdivisions == 1 => &[0.5, 2.0],
            _ if scene.mesh.subdivisions == 1 => &[0.5],
            [_, true] => &[2.0, 4.0],
            [true, false] => &[2.0],
            _ => &[],
        },
    };
    chosen(scene, wanted)
}

/// The two coarser meshes nearest to those that tell most; fewer where the family has not that many.
pub fn coarser(scene: &Scene) -> Vec<Level> {
    match governing_count(&scene.mesh) {
        Some(n) if n * COARSER[1] >= FEWEST => chosen(scene, &COARSER),
        Some(_) => chosen(scene, &NEAR),
        None => chosen(scene, &[0.5, 0.25]),
    }
}

/// The first two of the wanted meshes that can be made and differ enough, finer one first.
fn chosen(scene: &Scene, wanted: &[f64]) -> Vec<Level> {
    let mut levels: Vec<Level> = Vec::new();
    for &factor in wanted {
        let Some(level) = refined(scene, factor) else {
            continue;
        };
        let differs = |other: f64| level.ratio.max(other) / level.ratio.min(other) >= LEAST_CHANGE;
        if differs(1.0)
            && levels.iter().all(|l| differs(l.ratio))
            && can_be_made(&level.scene).is_ok()
        {
            levels.push(level);
        }
        if levels.len() == 2 {
            break;
        }
    }
    levels.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    levels
}

/// Largest order of convergence that is believed for the quantities of a scene: twice the degree of the elements (what
/// functionals of smooth solutions reach) but not more than 3, which the extrapolation of rounded meshes cannot tell from less.
pub fn largest_order(scene: &Scene) -> f64 {
    if all_quadratic(scene) { 3.0 } else { 2.0 }
}

/// Whether the generator makes quadratic elements only.
pub(super) fn all_quadratic(scene: &Scene) -> bool {
    let quadratic = |shape: Shape| shape.n_nodes() > shape.n_corners();
    let mesh = &scene.mesh;
    mesh.cylinder_on_half_plane
        .as_ref()
        .is_some_and(|p| quadratic(p.element))
        || mesh
            .disc_in_plate
            .as_ref()
            .is_some_and(|p| quadratic(p.element))
        || mesh
            .parts
            .as_ref()
            .is_some_and(|p| p.iter().all(|p| quadratic(p.element)))
}

/// Elements over what governs the result.
pub(super) fn governing_count(mesh: &MeshSource) -> Option<f64> {
    if let Some(p) = &mesh.cylinder_on_half_plane {
        Some(p.resolution as f64)
    } else if let Some(p) = &mesh.disc_in_plate {
        Some(p.resolution as f64 * CONTACT_OF_QUARTER)
    } else {
        let mut parts = mesh.parts.clone()?;
        let counts = parts.iter_mut().flat_map(counts_of).map(|n| *n);
        counts.max().map(|n| n as f64)
    }
}

/// The element counts of a part: of a block along x and y.
fn counts_of(part: &mut Part) -> Vec<&mut usize> {
    let mut out = Vec::new();
    if let Some(block) = &mut part.block {
        out.extend(block.elements.iter_mut());
    }
    if let Some(ring) = &mut part.ring {
        out.extend(ring.elements.iter_mut());
    }
    if let Some(disc) = &mut part.disc {
        out.push(&mut disc.elements);
    }
    out
}

/// The number of which a count of `n` elements may become a multiple: the same for all that are `n`, because surfaces in contact face
/// each other node by node. Even counts of triangles stay even: the diagonals alternate, and at the end of an odd count lies the other one.
fn step(parts: &[Part], n: usize) -> usize {
    let fits = |part: &Part, step: usize| {
        let is_disc = part.disc.as_ref().is_some_and(|d| d.elements == n);
        let alternates = part.element.n_corners() == 3 && n.is_multiple_of(2);
        let even = !(is_disc || alternates) || step.is_multiple_of(2);
        let counts = part.block.as_ref().map(|b| b.elements);
        let on_nodes = |axis: usize| {
            counts.is_none_or(|counts| counts[axis] != n) || ends_on_nodes(part, axis, Some(step))
        };
        even && on_nodes(0) && on_nodes(1)
    };
    let mut steps = 1..n.min(LARGEST_STEP);
    steps
        .find(|&step| parts.iter().all(|part| fits(part, step)))
        .unwrap_or(n)
}

/// Whether every piece of the sides of a block along an axis begins and ends at a node, with its own number of elements along it or
/// another: else it would be longer or shorter than in the scene.
fn ends_on_nodes(part: &Part, axis: usize, elements: Option<usize>) -> bool {
    let Some(block) = &part.block else {
        return true;
    };
    let n = elements.unwrap_or(block.elements[axis]) as f64;
    let [from, to] = if axis == 0 { block.x } else { block.y };
    let along = |side: &str| usize::from(matches!(side, "left" | "right")) == axis;
    let mut pieces = block.pieces.iter().filter(|piece| along(&piece.side));
    pieces.all(|piece| {
        block.bias[axis] == 1.0
            && [piece.from, piece.to].iter().all(|end| {
                let at = (end - from) / (to - from) * n;
                (at - at.round()).abs() < ON_NODE
            })
    })
}

/// Whether the generator makes the mesh: a family ends where it refuses.
fn can_be_made(scene: &Scene) -> Result<()> {
    if scene.mesh.file.is_some() {
        return Ok(());
    }
    generate::from_source(&scene.mesh, None, |p| contact_size::of(scene, p)).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(mesh: &str) -> Scene {
        let text = format!(
            "kind = \"plane_strain\"\n{mesh}\n[materials.m]\nyoungs_modulus = 1.0\npoissons_ratio = 0.3\n\
             [bodies]\nb = {{ material = \"m\" }}\n[[load]]\non = \"b.top\"\npressure = 1.0\n\
             [program]\ntargets = [{{ load_factor = 1.0 }}]\n"
        );
        Scene::parse(&text, "test.toml").unwrap()
    }

    /// The paper's cylinder.
    fn cylinder(resolution: usize, growth: f64) -> Scene {
        let text = include_str!("../../data/scenes/cylinder_on_half_plane.toml");
        let mut scene = Scene::parse(text, "scene.toml").unwrap();
        let p = scene.mesh.cylinder_on_half_plane.as_mut().unwrap();
        (p.resolution, p.growth) = (resolution, growth);
        scene
    }

    #[test]
    fn a_level_refines_every_element_by_the_same_ratio() {
        let scene = cylinder(16, 1.21);
        let level = refined(&scene, 2.0).unwrap();
        let p = level.scene.mesh.cylinder_on_half_plane.unwrap();
        assert_eq!((p.resolution, level.ratio), (32, 0.5));
        assert!((p.growth - 1.1).abs() < 1e-15);
        let ratios: Vec<f64> = companions(&scene, 1000).iter().map(|l| l.ratio).collect();
        assert_eq!(ratios, [2.0, 16.0 / 6.0]);
    }

    #[test]
    fn a_coarse_run_is_compared_with_finer_meshes() {
        let counts = |resolution: usize| -> Vec<usize> {
            let levels = companions(&cylinder(resolution, 1.15), 1000);
            let generators = levels
                .iter()
                .filter_map(|l| l.scene.mesh.cylinder_on_half_plane.as_ref());
            generators.map(|p| p.resolution).collect()
        };
        assert_eq!(counts(4), [12, 8]);
        assert_eq!(counts(7), [21, 14]);
        assert_eq!(counts(8), [16, 12]);
        assert_eq!(counts(12), [18, 8]);
        assert_eq!(counts(16), [8, 6]);
        assert_eq!(counts(32), [16, 12]);
    }

    #[test]
    fn a_mesh_from_a_file_has_its_subdivisions() {
        let mut scene = scene("[mesh]\nfile = \"a.msh\"");
        let ratios = |scene: &Scene, elements: usize| -> Vec<f64> {
            companions(scene, elements)
                .iter()
                .map(|l| l.ratio)
                .collect()
        };
        assert_eq!(ratios(&scene, 100), [0.25, 0.5]);
        assert_eq!(ratios(&scene, 1000), [0.5]);
        assert!(ratios(&scene, 10_000).is_empty());
        assert!(refined(&scene, 0.5).is_none() && refined(&scene, 1.5).is_none());
        assert_eq!(factors(&scene, 2.0, 2f64.sqrt(), 6), [4.0, 2.0, 1.0]);
        scene.mesh.subdivisions = 2;
        assert_eq!(ratios(&scene, 10_000), [2.0, 4.0]);
        let coarser = refined(&scene, 0.5).unwrap();
        assert_eq!((coarser.scene.mesh.subdivisions, coarser.ratio), (1, 2.0));
    }

    #[test]
    fn a_piece_of_a_block_keeps_its_length() {
        let block = "[[mesh.parts]]\nbody = \"b\"\nblock = { x = [0.0, 5.0], y = [0.0, 1.0], elements = [40, 40], \
                     pieces = [{ name = \"p\", side = \"top\", from = 0.0, to = 1.0 }] }";
        let scene = scene(block);
        assert!(refined(&scene, 0.5).is_some());
        let elements = |factor: f64| -> [usize; 2] {
            let level = refined(&scene, factor).unwrap();
            level.scene.mesh.parts.unwrap()[0]
                .block
                .as_ref()
                .unwrap()
                .elements
        };
        // 16 or 121 elements over 5 would leave no node at 1; what lies beside them has the same number and keeps it.
        assert_eq!([0.4, 3.03].map(elements), [[15, 15], [120, 120]]);
        let counts: Vec<f64> = companions(&scene, 1600).iter().map(|l| l.ratio).collect();
        assert_eq!(counts, [2.0, 40.0 / 15.0]);
        let thirds = block.replace("to = 1.0", "to = 1.7");
        assert!(
            refined(&self::scene(&thirds), 0.5).is_none(),
            "1.7 lies between nodes as it is"
        );
    }

    #[test]
    fn rounding_may_not_distort_the_mesh() {
        let ring =
            "[[mesh.parts]]\nbody = \"b\"\nring = { radius = [1.0, 2.0], elements = [1, 16] }";
        assert!(refined(&scene(ring), 0.5).is_none());
    }
}

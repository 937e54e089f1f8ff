//! The other meshes of its family that a run is compared with.

use crate::mesh::generate::Family;
use crate::model::Model;
use crate::results::{EdgeReading, Results, State};
use crate::scene::Scene;

/// Element sizes of coarser meshes, over that of the run, most wanted first. The first two are near
/// enough to lie in the same range of convergence, and have 0.7 times the elements of a plane run
/// together.
const COARSER: [f64; 4] = [1.5, 2.0, 3.0, 4.0];
/// Those of finer ones, for a run that is too coarse to have coarser ones.
const FINER: [f64; 4] = [1.0 / 1.5, 0.5, 1.0 / 3.0, 0.25];
/// Least ratio of two element sizes: nearer meshes differ by how counts are rounded.
const LEAST_RATIO: f64 = 1.15;
/// Closed pairs on a side of a contact over which its edge is read: the last two, and four before
/// them from which the pressure near it is fitted ([`crate::results::EdgeReading`]).
const READABLE: usize = 6;
/// Closed pairs over the smaller half axis of a patch of solids over which its area is read: the
/// last one, two that are believed, and the middle.
const READABLE_PATCH: usize = 4;
/// The nearest coarser mesh of solids, where others cannot be read: five elements instead of six.
const NEARER: f64 = 1.2;
/// Share of a half width below which two readings of it are the same: the edge is that of a
/// surface.
const ROUND_OFF: f64 = 1e-9;
/// Elements up to which a plane run is compared with meshes of sixteen times as many, where coarser
/// ones do not suffice; beyond, four times.
const SMALL: usize = 1000;
/// Most elements of a mesh that a run of solids is compared with: in space the time grows with the
/// sixth power of the fineness.
const SOLID: usize = 16 * SMALL;
/// The same for runs on meshes from files, which have finer companions alone and in steps of two:
/// in the plane the second subdivision, in space the first one, takes 64 times the run.
const FROM_FILE: usize = 4 * SMALL;
const SOLID_FROM_FILE: usize = 2 * SMALL;

/// A scene with another mesh of its family.
#[derive(Debug, Clone)]
pub struct Level {
    /// The scene.
    pub scene: Scene,
    /// Element size over that of the scene it was made from.
    pub ratio: f64,
}

/// The scene with elements about `ratio` times as large.
///
/// # Errors
/// Why there is no such member of the family, in words.
pub fn member(scene: &Scene, ratio: f64) -> Result<Level, String> {
    if scene.start_from.is_some() {
        return Err("start_from binds the scene to the mesh of the earlier run".into());
    }
    let (mesh, ratio) = scene.mesh.member(ratio)?;
    let scene = Scene {
        mesh,
        ..scene.clone()
    };
    Ok(Level { scene, ratio })
}

/// The two meshes from which the error of a run is extrapolated, finer one first; fewer where the
/// family has not that many. Coarser ones, where every contact of the run is resolved so well that
/// its edges can still be read on them, else finer ones.
pub fn companions(scene: &Scene, results: &Results) -> Vec<Level> {
    let pairs = fewest_pairs(results);
    let elements = results.sizes.elements;
    let finest = finest(scene, elements);
    let readable = match scene.kind.is_solid() {
        true => READABLE_PATCH,
        false => READABLE,
    };
    let can_be_read = |ratio: f64| pairs.is_none_or(|n| n as f64 >= ratio * readable as f64);
    let nearer = scene.kind.is_solid().then_some(NEARER);
    let coarser = COARSER.into_iter().chain(nearer);
    let coarser = coarser.filter(|ratio| can_be_read(*ratio));
    let finer = FINER.into_iter().filter(|ratio| *ratio >= finest);
    let mut levels: Vec<Level> = Vec::new();
    for ratio in coarser.chain(finer) {
        let Ok(level) = member(scene, ratio) else {
            continue;
        };
        let differs = |other: f64| level.ratio.max(other) / level.ratio.min(other) >= LEAST_RATIO;
        // A file is subdivided in steps of two, whatever ratio is asked for.
        if scene.mesh.file.is_some() && level.ratio < finest {
            continue;
        }
        let is_new = differs(1.0) && levels.iter().all(|l| differs(l.ratio));
        if is_new && Model::new(&level.scene).is_ok() {
            levels.push(level);
        }
        if levels.len() == 2 {
            break;
        }
    }
    levels.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    levels
}

/// Least element size of companions, over that of a run with so many elements.
fn finest(scene: &Scene, elements: usize) -> f64 {
    let from_file = scene.mesh.file.is_some();
    if scene.kind.is_solid() {
        let most = if from_file { SOLID_FROM_FILE } else { SOLID };
        return (elements as f64 / most as f64).cbrt();
    }
    let most = if from_file { FROM_FILE } else { 16 * SMALL };
    if 16 * elements <= most { 0.25 } else { 0.5 }
}

/// What the estimate of errors of a run on a mesh from a file with so many elements takes, in
/// words; `None` for other meshes, and where the scene demands an accuracy.
pub fn planned(scene: &Scene, elements: usize) -> Option<String> {
    scene
        .mesh
        .file
        .as_ref()
        .filter(|_| scene.accuracy.is_none())?;
    let once = if scene.kind.is_solid() { 8 } else { 4 };
    let finest = finest(scene, elements);
    let meshes = if finest <= 0.25 {
        format!(
            "subdivided once and twice, to {once} and {} times",
            once * once
        )
    } else if finest <= 0.5 {
        format!("subdivided once, to {once} times")
    } else {
        let text = "subdivided the mesh would take many times the run: its errors are estimated by \
                    the energy norm of the recovered stress alone";
        return Some(text.to_string());
    };
    Some(format!(
        "the estimate of errors runs the mesh {meshes} its elements; `--no-estimate` leaves it out"
    ))
}

/// The fewest closed pairs on one side of a contact: at first yield and in the state that carries
/// most. `None` without contact, and where it ends with its surfaces, so that nothing is read.
fn fewest_pairs(results: &Results) -> Option<usize> {
    let first = results.first_yield.as_ref();
    let first = first.map(|y| (y.half_width, y.half_width_reading));
    let strongest = |a: &&State, b: &&State| a.contact_force.total_cmp(&b.contact_force);
    let state = results.states.iter().max_by(strongest);
    let state = state.map(|s| (s.half_width, s.half_width_reading));
    let is_read = |(width, reading): &(f64, EdgeReading)| reading.error > ROUND_OFF * width;
    let read = first.into_iter().chain(state).filter(is_read);
    read.map(|(_, reading)| reading.pairs)
        .filter(|n| *n > 0)
        .min()
}

//! The other meshes of its family that a run is compared with.

use super::effort::{Effort, work_of_finer};
use crate::mesh::generate::Family;
use crate::model::Model;
use crate::number::significant;
use crate::results::{EdgeReading, Results, State};
use crate::scene::Scene;

/// Ratios of the element sizes of coarser meshes to that of the run, the preferred ones first. The
/// first two meshes are near enough to lie in the same range of convergence; together they have 0.7
/// times the elements of a plane run.
const COARSER: [f64; 4] = [1.5, 2.0, 3.0, 4.0];
/// Ratios of the element sizes of finer meshes to that of the run, for a run that is too coarse to
/// have coarser companions.
const FINER: [f64; 4] = [1.0 / 1.5, 0.5, 1.0 / 3.0, 0.25];
/// Least ratio of two element sizes: meshes nearer to each other differ only by the rounding of
/// their numbers of elements.
const LEAST_RATIO: f64 = 1.15;
/// Number of closed pairs on a side of a contact that the reading of the contact's edge needs: the
/// last two, and the four before them, to which the pressure is fitted
/// ([`crate::results::EdgeReading`]).
pub(super) const READABLE: usize = 6;
/// Number of closed pairs over the smaller half axis of a patch of solids that the reading of its
/// area needs: the last pair, two pairs whose pressures are trusted, and the pair in the middle.
const READABLE_PATCH: usize = 4;
/// Ratio for the nearest coarser mesh of solids, if the contact cannot be read on coarser ones:
/// five elements for six.
const NEARER: f64 = 1.2;
/// Largest time that the other runs of an estimate may take together by default, as a multiple of
/// the time of the run itself.
const QUICK: f64 = 1.0;
/// Time of a run with half as many increments, over that of the run on the same mesh.
const HALF_THE_INCREMENTS: f64 = 0.5;
/// Time of the runs with twice as many increments and with other tolerances together, over that of
/// the run on the same mesh.
const MORE_INCREMENTS: f64 = 3.0;
/// Number of elements up to which a plane run is compared with meshes of sixteen times as many
/// elements, if coarser ones do not suffice. A larger run is compared with four times as many.
const SMALL: usize = 1000;
/// Most elements of a mesh with which a run of solids is compared: in space the time grows with the
/// sixth power of the fineness.
const SOLID: usize = 16 * SMALL;
/// Most elements of the finer meshes for a run on a mesh from a file, which has no coarser
/// companions and is refined by halving its elements. The second subdivision in the plane, or the
/// first in space, takes 64 times the run.
const FROM_FILE: usize = 4 * SMALL;
const SOLID_FROM_FILE: usize = 2 * SMALL;

/// A scene with another mesh of its family.
#[derive(Debug, Clone)]
pub struct Level {
    /// The scene with that mesh.
    pub scene: Scene,
    /// Element size over that of the scene from which this scene was made.
    pub ratio: f64,
}

/// Returns the scene on another mesh of its family, with elements about `ratio` times as large.
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

/// The meshes that a run is compared with.
#[derive(Debug, Clone, Default)]
pub struct Companions {
    /// At most two meshes, the finer one first.
    pub levels: Vec<Level>,
    /// Reason why there are no companions, in words.
    pub why_none: Option<String>,
}

/// Chooses the two meshes from which the error of a run is extrapolated; fewer if the family has no
/// more, or if they would take more time than the effort allows.
pub fn companions(scene: &Scene, results: &Results, effort: Effort) -> Companions {
    let readable = match scene.kind.is_solid() {
        true => READABLE_PATCH,
        false => READABLE,
    };
    let pairs = fewest_pairs(results);
    let can_be_read = |ratio: f64| pairs.is_none_or(|n| n as f64 >= ratio * readable as f64);
    match effort {
        Effort::None => Companions::default(),
        Effort::Quick => cheap(scene, can_be_read),
        Effort::Full => wanted(scene, results.sizes.elements, can_be_read),
    }
}

/// Chooses meshes whatever time they take: coarser ones on which the edges of all contacts can
/// still be read, otherwise finer ones.
fn wanted(scene: &Scene, elements: usize, can_be_read: impl Fn(f64) -> bool) -> Companions {
    let finest = finest(scene, elements);
    let nearer = scene.kind.is_solid().then_some(NEARER);
    let coarser = COARSER.into_iter().chain(nearer);
    let coarser = coarser.filter(|ratio| can_be_read(*ratio));
    let finer = FINER.into_iter().filter(|ratio| *ratio >= finest);
    let mut found = MembersFound::new(scene);
    for ratio in coarser.chain(finer) {
        // A file is subdivided in steps of two, whatever ratio is asked for.
        found.add(ratio, |level| {
            scene.mesh.file.is_none() || level.ratio >= finest
        });
        if found.levels.len() == 2 {
            break;
        }
    }
    found.companions("a run on the subdivided mesh would take many times as long")
}

/// Chooses the nearest two coarser meshes for which all further runs together take no more than
/// [`QUICK`] times the run. These include the run that estimates the path's error on the coarser
/// mesh. Meshes on which the contact can be read are preferred.
fn cheap(scene: &Scene, can_be_read: impl Fn(f64) -> bool) -> Companions {
    let mut found = MembersFound::new(scene);
    for ratio in COARSER {
        found.add(ratio, |level| level.ratio > 1.0);
    }
    let levels = std::mem::take(&mut found.levels);
    let pairs = (0..levels.len()).flat_map(|i| (i + 1..levels.len()).map(move |j| vec![i, j]));
    let choices = pairs.chain((0..levels.len()).map(|i| vec![i]));
    let share = |i: usize| share_of_run(scene, levels[i].ratio);
    let fits = |choice: &Vec<usize>| {
        let path = choice
            .last()
            .map_or(0.0, |&i| HALF_THE_INCREMENTS * share(i));
        choice.iter().map(|&i| share(i)).sum::<f64>() + path <= QUICK
    };
    let unread = |choice: &Vec<usize>| {
        let unread = choice.iter().filter(|&&i| !can_be_read(levels[i].ratio));
        (2 - choice.len(), unread.count())
    };
    let chosen = choices.filter(fits).min_by_key(unread).unwrap_or_default();
    found.levels = chosen.into_iter().map(|i| levels[i].clone()).collect();
    found.companions("finer ones would take several times the run")
}

/// Members of a mesh family found so far.
struct MembersFound<'s> {
    scene: &'s Scene,
    levels: Vec<Level>,
    /// Reason why the first missing member could not be made.
    failure: Option<String>,
}

impl<'s> MembersFound<'s> {
    fn new(scene: &'s Scene) -> Self {
        MembersFound {
            scene,
            levels: Vec::new(),
            failure: None,
        }
    }

    /// Adds the member with elements `ratio` times as large, if it differs from the run and from
    /// the other members and a model can be made of it.
    fn add(&mut self, ratio: f64, is_wanted: impl Fn(&Level) -> bool) {
        let level = member(self.scene, ratio).and_then(|level| {
            let differs =
                |other: f64| level.ratio.max(other) / level.ratio.min(other) >= LEAST_RATIO;
            let is_new = differs(1.0) && self.levels.iter().all(|l| differs(l.ratio));
            if !is_new || !is_wanted(&level) {
                return Err("the mesh has too few elements along a side".to_string());
            }
            match Model::new(&level.scene) {
                Ok(_) => Ok(level),
                Err(error) => Err(format!("elements {ratio} times as large: {error}")),
            }
        });
        match level {
            Ok(level) => self.levels.push(level),
            Err(why) => self.failure = self.failure.take().or(Some(why)),
        }
        self.levels.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    }

    fn companions(self, otherwise: &str) -> Companions {
        let why_none = match (self.levels.is_empty(), self.failure) {
            (true, Some(why)) => Some(format!("{why}; {otherwise}")),
            (true, None) => Some(otherwise.to_string()),
            (false, _) => None,
        };
        Companions {
            levels: self.levels,
            why_none,
        }
    }
}

/// Time of a run on another mesh as a fraction of the time of the run. For a coarser mesh it is the
/// ratio of the numbers of elements, which is an upper bound; for a finer mesh it is the ratio of
/// the work of the factorisations ([`work_of_finer`]).
fn share_of_run(scene: &Scene, ratio: f64) -> f64 {
    match ratio < 1.0 {
        true => work_of_finer(scene.kind, 1.0 / ratio),
        false => ratio.powi(if scene.kind.is_solid() { -3 } else { -2 }),
    }
}

/// Least element size of companions, over that of a run with this number of elements.
fn finest(scene: &Scene, elements: usize) -> f64 {
    let from_file = scene.mesh.file.is_some();
    if scene.kind.is_solid() {
        let most = if from_file { SOLID_FROM_FILE } else { SOLID };
        return (elements as f64 / most as f64).cbrt();
    }
    let most = if from_file { FROM_FILE } else { 16 * SMALL };
    if 16 * elements <= most { 0.25 } else { 0.5 }
}

/// Describes what the error estimate of a run will do and what time it will take. The description
/// is given before the run, so contacts are assumed to be readable on coarser meshes.
pub fn planned(scene: &Scene, elements: usize, effort: Effort) -> String {
    if effort == Effort::None {
        return "not estimated".to_string();
    }
    if scene.accuracy.is_some() {
        return "by the meshes on the way to the demanded accuracy".to_string();
    }
    let found = match effort {
        Effort::Full => wanted(scene, elements, |_| true),
        _ => cheap(scene, |_| true),
    };
    let ratios: Vec<f64> = found.levels.iter().map(|level| level.ratio).collect();
    let increments = match effort {
        Effort::Quick => HALF_THE_INCREMENTS,
        _ => MORE_INCREMENTS,
    };
    let coarsest = ratios.iter().copied().fold(1.0, f64::max);
    let shares: f64 = ratios.iter().map(|ratio| share_of_run(scene, *ratio)).sum();
    let share = shares + increments * share_of_run(scene, coarsest);
    let meshes = match (ratios.is_empty(), found.why_none) {
        (true, why) => format!(
            "energy norm of the stress error ({})",
            why.unwrap_or_default()
        ),
        (false, _) => {
            let ratios: Vec<String> = ratios.iter().map(|r| significant(*r, 3)).collect();
            format!("runs with elements {} times as large", ratios.join(" and "))
        }
    };
    let takes = match share > 2.0 {
        true => format!("about {} times the run", significant(share, 2)),
        false => format!("at most {} % of the run", significant(100.0 * share, 2)),
    };
    format!("{meshes}; {takes}")
}

/// The fewest closed pairs on one side of a contact, at first yield and in the state with the
/// largest contact force. `None` without contact, or if the contact ends with its surfaces, so that
/// no edge is read.
fn fewest_pairs(results: &Results) -> Option<usize> {
    let first = results.first_yield.as_ref();
    let first = first.map(|y| (y.half_width, y.half_width_reading));
    let strongest = |a: &&State, b: &&State| a.contact_force.total_cmp(&b.contact_force);
    let state = results.states.iter().max_by(strongest);
    let state = state.map(|s| (s.half_width, s.half_width_reading));
    let is_read = |(width, reading): &(f64, EdgeReading)| reading.is_of_pressures(*width);
    let read = first.into_iter().chain(state).filter(is_read);
    read.map(|(_, reading)| reading.pairs).min()
}

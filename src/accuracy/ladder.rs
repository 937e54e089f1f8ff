//! The ladder of meshes that leads to a demand: what was run on one rung judges the next.

use super::estimate::{Extent, run};
use super::grading::elements;
use super::meter::work;
use super::refinement::{FEWEST, Level, all_quadratic, governing_count, refined};
use crate::error::Result;
use crate::linalg::Backend;
use crate::progress::Observer;
use crate::results::Results;
use crate::scene::Scene;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Node spacings over what governs in the lowest run that is judged, by one rung below it.
pub(super) const PILOT: f64 = 1.4 * FEWEST;
/// The same up to first yield of a contact, where nothing flows and the edge is known to a share of an element.
const LOW: f64 = 5.0;
/// Node spacings over a contact below which its pressure and edge cannot be read off (those of the disc in a plate rounded).
const LOWEST: f64 = 3.9;
/// From so many spacings on rungs far apart tell more than near ones, and with less than so many one rung has to do: a contact edge
/// cannot be read off fewer than [`FEWEST`].
const FINE: f64 = 13.0;
const COARSE: f64 = 8.0;
/// The rungs of a mesh from a file have so many subdivisions less.
const SUBDIVISIONS_BELOW: [i32; 2] = [1, 2];
/// Least change of the element size from rung to rung.
const LEAST_CHANGE: f64 = 1.1;
/// A rung that was run already serves where its elements are so many times larger.
const REUSED: [f64; 2] = [1.25, 3.0];
/// The same from [`FINE`] spacings on.
const REUSED_FAR: [f64; 2] = [1.5, 3.0];
/// The same with contact: the largest pressure moves from the axis to pairs beside it as the mesh gets finer, and near rungs take that for
/// a lower order.
const REUSED_IN_CONTACT: [f64; 2] = [1.7, 3.4];
/// Elements up to which runs are made beside each other, two at a time on two threads: in 0.6 to 0.8 times the time. Larger factors come from OpenBLAS, whose threads
/// then get into each other's way.
const BESIDE: usize = 1000;
/// Growths that agree to so many digits make one mesh: they come by different ways.
const DIGITS: f64 = 1e9;

/// Finished runs, to be used again.
#[derive(Default)]
pub(super) struct Ladder {
    finished: Vec<Finished>,
}

/// The observer of a run beside another, told to stop when that one is.
struct Until<'s>(&'s AtomicBool);

impl Observer for Until<'_> {
    fn stop_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// A finished run.
#[derive(Clone)]
pub(super) struct Finished {
    pub scene: Scene,
    pub results: Results,
    /// That it took.
    pub seconds: f64,
    key: Scene,
}

impl Finished {
    fn new(scene: &Scene, results: Results, seconds: f64) -> Self {
        Finished {
            scene: scene.clone(),
            results,
            seconds,
            key: key(scene),
        }
    }

    fn run(
        scene: &Scene,
        backend: Backend,
        extent: Extent,
        observer: &mut dyn Observer,
    ) -> Result<Self> {
        let begun = Instant::now();
        let results = run(scene, backend, extent, observer)?;
        let seconds = begun.elapsed().as_secs_f64();
        Ok(Finished::new(scene, results, seconds))
    }
}

impl Ladder {
    /// Keeps a finished run, without its fields.
    pub(super) fn keep(&mut self, scene: &Scene, results: &Results, seconds: f64) {
        let mut results = results.clone();
        for state in &mut results.states {
            state.fields = None;
        }
        self.finished.push(Finished::new(scene, results, seconds));
    }

    fn known(&self, scene: &Scene) -> Option<&Finished> {
        let key = key(scene);
        self.finished.iter().find(|known| known.key == key)
    }

    /// The run of a scene, and the operations it took: none where it was run before.
    pub(super) fn step(
        &mut self,
        scene: &Scene,
        backend: Backend,
        extent: Extent,
        observer: &mut dyn Observer,
    ) -> Result<(Finished, f64)> {
        if let Some(known) = self.known(scene) {
            return Ok((known.clone(), 0.0));
        }
        let new = Finished::run(scene, backend, extent, observer)?;
        self.finished.push(new.clone());
        let spent = work(&new.results);
        Ok((new, spent))
    }

    /// Does `act` and runs scenes beside it on other threads, to be found by [`Ladder::step`] later. Returns what came of `act`, and the operations of those
    /// runs; one that fails is left to the step that asks for it.
    pub(super) fn beside<T>(
        &mut self,
        scenes: &[Scene],
        backend: Backend,
        extent: Extent,
        observer: &mut dyn Observer,
        act: impl FnOnce(&mut dyn Observer) -> T,
    ) -> (T, f64) {
        if rayon::current_num_threads() < 2 {
            return (act(observer), 0.0);
        }
        let new = scenes.iter().filter(|scene| self.known(scene).is_none());
        let mut runs: Vec<(&Scene, Option<Finished>)> = new.map(|scene| (scene, None)).collect();
        let stop = AtomicBool::new(false);
        let out = rayon::in_place_scope(|scope| {
            for (scene, found) in &mut runs {
                let mut until = Until(&stop);
                scope.spawn(move |_| {
                    *found = Finished::run(scene, backend, extent, &mut until).ok();
                });
            }
            let out = act(observer);
            stop.store(observer.stop_requested(), Ordering::Relaxed);
            out
        });
        let new: Vec<Finished> = runs.into_iter().filter_map(|(_, found)| found).collect();
        let spent = new.iter().map(|run| work(&run.results)).sum();
        self.finished.extend(new);
        (out, spent)
    }

    /// Runs scenes beside each other where they are all small, to be found by [`Ladder::step`] later. Returns their operations.
    pub(super) fn run_ahead(
        &mut self,
        scenes: &[Scene],
        backend: Backend,
        extent: Extent,
        observer: &mut dyn Observer,
    ) -> f64 {
        let new = scenes.iter().filter(|scene| self.known(scene).is_none());
        let new: Vec<Scene> = new.cloned().collect();
        let Some((first, rest)) = new.split_first() else {
            return 0.0;
        };
        if observer.stop_requested() || !new.iter().all(is_small) {
            return 0.0;
        }
        let (found, spent) = self.beside(rest, backend, extent, observer, |observer| {
            Finished::run(first, backend, extent, observer)
        });
        let Ok(first) = found else {
            return spent;
        };
        let all = spent + work(&first.results);
        self.finished.push(first);
        all
    }

    /// The coarsest run so far, with the same path, in which everything flows that does in `results`.
    pub(super) fn flowing(&self, scene: &Scene, results: &Results) -> Option<&Finished> {
        let same_path =
            |other: &Scene| other.program == scene.program && other.analysis == scene.analysis;
        let flows = |other: &Results| {
            let states = results.states.iter().zip(&other.states);
            results.states.len() == other.states.len()
                && states
                    .into_iter()
                    .all(|(s, o)| s.plastic_points == 0 || o.plastic_points > 0)
        };
        let known = self.finished.iter().filter(|known| {
            known.results.sizes.elements < results.sizes.elements
                && same_path(&known.scene)
                && flows(&known.results)
        });
        known.min_by_key(|known| known.results.sizes.elements)
    }

    /// The coarser meshes, two or for the lowest run one, from which a run is judged, those that were run already first. A ladder goes up
    /// from meshes so coarse that they must not lean on yet coarser ones, nor, with its price in mind, on finer ones.
    pub(super) fn rungs(&self, scene: &Scene) -> Vec<Level> {
        if scene.mesh.file.is_some() {
            let below = SUBDIVISIONS_BELOW.map(|times| 0.5f64.powi(times));
            return below
                .into_iter()
                .filter_map(|f| refined(scene, f))
                .collect();
        }
        let Some(count) = spacings(scene) else {
            return Vec::new();
        };
        let fewest = if scene.contact.is_empty() {
            FEWEST
        } else {
            LOWEST
        };
        let [near, far] = match count >= FINE {
            true if scene.contact.is_empty() => REUSED_FAR,
            true => REUSED_IN_CONTACT,
            false => REUSED,
        };
        let known = self.finished.iter().filter_map(|known| {
            let factor = spacings(&known.scene)? / count;
            let level = refined(scene, factor)?;
            let serves = (near..=far).contains(&level.ratio) && factor * count >= fewest;
            (serves && key(&level.scene) == known.key).then_some(level)
        });
        let mut known: Vec<Level> = known.collect();
        known.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
        let (most, factors) = match count {
            n if n >= FINE => (2, [1.0 / 2.0, 3.0 / 8.0, 2.0 / 3.0, 1.0 / 4.0]),
            n if n >= COARSE => (2, [2.0 / 3.0, 5.0 / 9.0, 1.0 / 2.0, 3.0 / 4.0]),
            _ => (
                known.len().clamp(1, 2),
                [6.0 / 7.0, 2.0 / 3.0, 1.0 / 2.0, 1.0 / 3.0],
            ),
        };
        let mut out: Vec<Level> = Vec::new();
        let others = factors.into_iter().filter_map(|f| refined(scene, f));
        for level in known.into_iter().chain(others) {
            let far = |other: f64| level.ratio.max(other) / level.ratio.min(other) >= LEAST_CHANGE;
            if out.len() < most
                && level.ratio > 1.0
                && far(1.0)
                && out.iter().all(|l| far(l.ratio))
                && elements(&level.scene).is_some()
            {
                out.push(level);
            }
        }
        out.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
        out
    }
}

/// How many times as fine as the scene's its file once subdivided is, the coarsest mesh of a file that is judged: by the file itself. `None`
/// for a generated mesh.
pub(super) fn once_subdivided(scene: &Scene) -> Option<f64> {
    scene.mesh.file.as_ref()?;
    Some(2.0 * 0.5f64.powi(scene.mesh.subdivisions.try_into().ok()?))
}

/// Node spacings over what governs in the lowest run of a scene that is judged.
pub(super) fn foot(scene: &Scene, extent: Extent) -> f64 {
    match extent {
        Extent::Yield if !scene.contact.is_empty() => LOW,
        _ => PILOT,
    }
}

/// Node spacings over what governs the result.
pub(super) fn spacings(scene: &Scene) -> Option<f64> {
    let each = if all_quadratic(scene) { 2.0 } else { 1.0 };
    governing_count(&scene.mesh).map(|n| each * n)
}

/// Elements along a line over those of the coarsest member of the family: node spacings over what governs, subdivisions of a file.
pub(super) fn fineness(scene: &Scene) -> Option<f64> {
    spacings(scene).or_else(|| Some(2f64.powi(scene.mesh.subdivisions.try_into().ok()?)))
}

/// Whether a run is worth making beside another.
pub(super) fn is_small(scene: &Scene) -> bool {
    elements(scene).is_some_and(|n| n <= BESIDE)
}

/// What tells scenes apart: round-off of the growths left out.
fn key(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let round = |growth: &mut f64| *growth = (*growth * DIGITS).round() / DIGITS;
    if let Some(p) = &mut scene.mesh.cylinder_on_half_plane {
        round(&mut p.growth);
        p.far_growth.iter_mut().for_each(round);
    }
    if let Some(p) = &mut scene.mesh.disc_in_plate {
        round(&mut p.growth);
        p.far_growth.iter_mut().for_each(round);
    }
    scene
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_from_a_file_is_judged_by_its_subdivisions() {
        let text = include_str!("../../data/scenes/gmsh_blocks.toml");
        let mut scene = Scene::parse(text, "scene.toml").unwrap();
        let subdivisions = |levels: &[Level]| -> Vec<usize> {
            let scenes = levels.iter().map(|l| &l.scene);
            scenes.map(|s| s.mesh.subdivisions).collect()
        };
        assert_eq!(once_subdivided(&scene), Some(2.0));
        for (times, wanted) in [(0, vec![]), (1, vec![0]), (2, vec![1, 0]), (4, vec![3, 2])] {
            scene.mesh.subdivisions = times;
            assert_eq!(subdivisions(&Ladder::default().rungs(&scene)), wanted);
        }
        assert_eq!(once_subdivided(&scene), Some(0.125));
        assert_eq!(once_subdivided(&cylinder(7)), None);
    }

    fn cylinder(n: usize) -> Scene {
        let text = include_str!("../../data/scenes/cylinder_on_half_plane.toml");
        let scene = Scene::parse(text, "scene.toml").unwrap();
        refined(&scene, n as f64 / 16.0).unwrap().scene
    }

    fn resolutions(levels: &[Level]) -> Vec<usize> {
        let meshes = levels.iter().map(|l| &l.scene.mesh);
        let generators = meshes.map(|m| m.cylinder_on_half_plane.as_ref().unwrap());
        generators.map(|p| p.resolution).collect()
    }

    #[test]
    fn rungs_come_nearer_towards_the_foot() {
        for (n, wanted) in [
            (7, vec![6]),
            (9, vec![6, 5]),
            (12, vec![8, 7]),
            (16, vec![8, 6]),
        ] {
            assert_eq!(resolutions(&Ladder::default().rungs(&cylinder(n))), wanted);
        }
    }

    #[test]
    fn what_was_run_serves_again() {
        let mut ladder = Ladder::default();
        for n in [7, 5] {
            ladder.keep(&cylinder(n), &Results::default(), 0.0);
        }
        assert_eq!(resolutions(&ladder.rungs(&cylinder(12))), [7, 5]);
        // Not where it is of another family.
        let mut other = cylinder(12);
        other.mesh.cylinder_on_half_plane.as_mut().unwrap().growth += 0.01;
        assert_eq!(resolutions(&ladder.rungs(&other)), [8, 7]);
        let mut observer = crate::progress::Silent;
        let (_, spent) = ladder
            .step(&cylinder(7), Backend::Dense, Extent::Yield, &mut observer)
            .unwrap();
        assert_eq!(spent, 0.0);
    }

    /// The same bits and the same operations as one after the other; what fails beside is told by the step.
    #[test]
    fn runs_beside_each_other_are_found_by_the_step() {
        let tube = |n: usize, load: &str| {
            let text = include_str!("../../data/scenes/thick_cylinder.toml");
            let text = text.replace("[16, 16]", &format!("[{n}, {n}]"));
            let (head, _) = text.split_once("[program]").unwrap();
            let program = format!("[program]\ntargets = [{{ load_factor = {load} }}]\n");
            Scene::parse(&(head.to_string() + &program), "scene.toml").unwrap()
        };
        let (backend, extent, mut observer) =
            (Backend::default(), Extent::Program, crate::progress::Silent);
        // The wall of the last one collapses.
        let scenes = [tube(3, "120.0"), tube(4, "150.0"), tube(2, "900.0")];
        let mut ladder = Ladder::default();
        let spent = ladder.run_ahead(&scenes, backend, extent, &mut observer);
        let mut alone = 0.0;
        for scene in &scenes[..2] {
            let (beside, more) = ladder.step(scene, backend, extent, &mut observer).unwrap();
            let (own, work) = Ladder::default()
                .step(scene, backend, extent, &mut observer)
                .unwrap();
            let bits = |run: &Finished| {
                let values = run
                    .results
                    .states
                    .iter()
                    .map(|s| (s.approach.to_bits(), s.load.to_bits()));
                values.collect::<Vec<_>>()
            };
            assert_eq!(bits(&beside), bits(&own));
            if rayon::current_num_threads() > 1 {
                assert_eq!(more, 0.0);
            }
            alone += work;
        }
        if rayon::current_num_threads() > 1 {
            assert_eq!(spent, alone);
        }
        let failed = ladder.step(&scenes[2], backend, extent, &mut observer);
        assert_eq!(
            failed.err().map(|e| e.kind()),
            Some(crate::ErrorKind::Collapse)
        );
    }
}

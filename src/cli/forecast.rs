//! Predicted durations of phases: from the size of the model, the speed of this machine as far as
//! the run has shown it, and the phases that are complete.

use crate::scene::Scene;
use std::time::Instant;

/// Seconds per freedom for making mesh and model, the assembly, a yield load, a state, and the
/// files of a state, on a processor of 2020.
const MODEL: f64 = 1.0e-6;
const ASSEMBLY: f64 = 1.3e-6;
const YIELD_LOAD: f64 = 3e-6;
const STATE: f64 = 1.0e-6;
const FILES: f64 = 1.5e-6;
/// Seconds of ordering, factorisation and condensation per freedom, per power 3/2 of the freedoms
/// (the growth of nested dissection in the plane) and per cube of the pairs (the dense matrix of
/// the contact).
const FACTORISATION: [f64; 3] = [2.5e-6, 7.75e-9, 1.2e-10];
/// Seconds of the increments per square of the pairs: each pair that closes or opens costs solves,
/// and the zone of these solves grows with the number of pairs.
const INCREMENTS: f64 = 2e-4;
/// Fraction of the run's own time that the estimate of its errors takes, in several phases of about
/// the same length.
const ESTIMATE: f64 = 0.4;
/// The shortest time that is predicted, which is the resolution of the display.
const LEAST: f64 = 0.01;
/// Number of bytes of a mesh file for each freedom.
const BYTES: f64 = 40.0;

/// The data of a run on which predictions are based.
pub(super) struct TimeForecast {
    started: Instant,
    freedoms: f64,
    pairs: f64,
    targets: f64,
    /// Factor by which this machine is slower than expected.
    slower: f64,
    /// Number of phases that have ended, and the time at which the last of them did.
    ended: f64,
    last_end: f64,
}

impl TimeForecast {
    pub fn new(started: Instant) -> Self {
        TimeForecast {
            started,
            freedoms: 0.0,
            pairs: 0.0,
            targets: 1.0,
            slower: 1.0,
            ended: 0.0,
            last_end: 0.0,
        }
    }

    /// Takes a scene whose mesh is still to be made: its size is estimated.
    pub fn scene(&mut self, scene: &Scene) {
        self.targets = scene.program.targets.len().max(1) as f64;
        let mesh = &scene.mesh;
        let square = |n: usize| (n * n) as f64;
        let mut freedoms = 0.0;
        // With elements that grow with the distance from the contact their number is proportional
        // to the square of the resolution.
        if let Some(cylinder) = &mesh.cylinder_on_half_plane {
            freedoms = 60.0 * square(cylinder.resolution);
        } else if let Some(disc) = &mesh.disc_in_plate {
            freedoms = 4.0 * square(disc.resolution);
        } else if let Some(parts) = &mesh.parts {
            for part in parts {
                let counts = (part.block.as_ref().map(|b| b.elements))
                    .or(part.ring.as_ref().map(|r| r.elements))
                    .or(part.disc.as_ref().map(|d| [d.elements; 2]));
                freedoms += counts.map_or(0.0, |[a, b]| 2.0 * a as f64 * b as f64);
            }
        } else if let Some(file) = &mesh.file {
            let folder = scene.file.as_deref().and_then(std::path::Path::parent);
            let path = folder.map_or_else(|| file.into(), |folder| folder.join(file));
            freedoms = std::fs::metadata(path).map_or(0.0, |file| file.len() as f64 / BYTES);
        }
        self.freedoms = freedoms;
    }

    /// Takes a model, whose size is known.
    pub fn model(&mut self, freedoms: usize, pairs: usize) {
        (self.freedoms, self.pairs) = (freedoms as f64, pairs as f64);
    }

    /// Takes the time that a phase took.
    pub fn learn(&mut self, phase: &str, seconds: f64) {
        (self.ended, self.last_end) = (self.ended + 1.0, self.started.elapsed().as_secs_f64());
        // On a very small model the measured time would only be the resolution of the clock.
        if phase == "assembly" && self.freedoms > 0.0 {
            self.slower = (seconds / (ASSEMBLY * self.freedoms)).clamp(0.3, 10.0);
        }
    }

    /// Predicts the seconds that a phase will take.
    pub fn seconds(&self, phase: &str) -> f64 {
        let (n, pairs) = (self.freedoms, self.pairs);
        let program = INCREMENTS * pairs * pairs + STATE * self.targets * n;
        let of_size = match phase {
            "mesh and model" => Some(MODEL * n),
            "assembly" => Some(ASSEMBLY * n),
            "factorisation" => Some(
                FACTORISATION[0] * n
                    + FACTORISATION[1] * n.powf(1.5)
                    + FACTORISATION[2] * pairs.powi(3),
            ),
            "yield load" => Some(YIELD_LOAD * n),
            "preload" => Some(INCREMENTS * pairs * pairs),
            "load program" => Some(program),
            "output" => Some(FILES * self.targets * n),
            going_on if going_on.starts_with("going on") => Some(program),
            _ => None,
        };
        let seconds = match of_size {
            Some(seconds) => self.slower * seconds,
            None if phase.starts_with("error estimate") => {
                0.25 * ESTIMATE * self.started.elapsed().as_secs_f64()
            }
            // Other phases take as long as the mean of the phases so far; the first takes about a
            // second.
            None if self.ended > 0.0 => self.last_end / self.ended,
            None => 1.0,
        };
        seconds.max(LEAST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_assembly_tells_the_speed_of_the_machine() {
        let mut forecast = TimeForecast::new(Instant::now());
        forecast.model(1_000_000, 100);
        let before = forecast.seconds("factorisation");
        // The terms are 2.5 s for the part that grows with the freedoms and 7.75 s for the fill.
        assert!((before - 10.25).abs() < 0.01, "{before}");
        forecast.learn("assembly", 2.0 * ASSEMBLY * 1e6);
        assert!((forecast.seconds("factorisation") / before - 2.0).abs() < 1e-12);
    }

    #[test]
    fn every_phase_has_a_prediction() {
        let mut forecast = TimeForecast::new(Instant::now());
        let phases = [
            "mesh and model",
            "assembly",
            "factorisation",
            "preload",
            "yield load",
            "load program",
            "going on after increment 7, load factor 0.5",
            "error estimate: coarser mesh 1 of 2",
            "output",
            "ties",
        ];
        for sizes in [[0, 0], [20_000, 50]] {
            forecast.model(sizes[0], sizes[1]);
            for phase in phases {
                let seconds = forecast.seconds(phase);
                assert!(seconds.is_finite() && seconds > 0.0, "{phase}: {seconds}");
            }
        }
    }

    #[test]
    fn the_size_of_a_mesh_is_guessed_before_it_is_made() {
        for name in [
            "cylinder_on_half_plane",
            "disc_in_plate",
            "thick_cylinder",
            "gmsh_blocks",
        ] {
            let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
            let scene = Scene::load(root.join(format!("data/scenes/{name}.toml"))).unwrap();
            let mut forecast = TimeForecast::new(Instant::now());
            forecast.scene(&scene);
            let freedoms = crate::model::Model::new(&scene).unwrap().freedoms.n as f64;
            let ratio = forecast.freedoms / freedoms;
            assert!((0.3..3.0).contains(&ratio), "{name}: {ratio}");
        }
    }
}

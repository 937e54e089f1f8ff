//! The problems on which stated errors are held against true ones: families of meshes, with values
//! that are known from closed forms or from a much finer mesh with many more increments.
//!
//! The constants of `brinell::accuracy` were looked at on the families of `calibration` alone;
//! these judge them.

use crate::support;
use brinell::accuracy::{Effort, Extent, estimate, quantities, work};
use brinell::analysis::Analysis;
use brinell::analytical::{
    DiscInPlate, HertzPoint, PinInHole, Plane, ShrinkFit, ThickCylinder, contact_modulus,
};
use brinell::linalg::Backend;
use brinell::mesh::gmsh;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::results::Results;
use brinell::scene::{MeshSource, Scene, Stepping, SurfaceCircle};
use std::collections::BTreeMap;
use std::path::Path;

/// A problem on several meshes.
pub struct Family {
    pub name: String,
    pub extent: Extent,
    /// The meshes: a name for each, coarse to fine.
    pub meshes: Vec<(String, Scene)>,
    pub truth: Truth,
}

/// What is known.
#[derive(PartialEq)]
pub enum Truth {
    /// Some quantities, exactly.
    Exact(Vec<(&'static str, f64)>),
    /// All, from a finer mesh.
    Finer(Box<Scene>),
}

/// A stated error beside the true one, both relative to the largest size of the quantity in the
/// run.
#[derive(Debug, Clone)]
pub struct Claim {
    pub family: String,
    pub mesh: String,
    pub quantity: String,
    pub kind: &'static str,
    pub stated: f64,
    pub truth: f64,
    pub order: Option<f64>,
    /// Operations of the run's estimate over those of the run.
    pub price: f64,
}

impl Claim {
    /// What kind of quantity it is.
    pub fn key(&self) -> &str {
        self.kind
    }
}

/// Differences below this are of round-off and of the reference: they judge nothing.
const SAME: f64 = 1e-6;

impl Family {
    /// The values that are known, by path.
    pub fn known(&self) -> BTreeMap<String, f64> {
        match &self.truth {
            Truth::Exact(values) => (values.iter())
                .map(|(path, value)| (path.to_string(), *value))
                .collect(),
            Truth::Finer(scene) => {
                let results = run_extent(scene, self.extent).unwrap();
                let all = quantities(&results).into_iter();
                all.map(|q| (q.path, q.value)).collect()
            }
        }
    }

    /// The claims of all its meshes beside known values; a mesh that cannot be run makes none.
    pub fn claims_beside(&self, truth: &BTreeMap<String, f64>) -> Vec<Claim> {
        let mut out = Vec::new();
        for (mesh, scene) in &self.meshes {
            let Some(results) = run_extent(scene, self.extent) else {
                println!("{} {mesh}: cannot be run", self.name);
                continue;
            };
            let backend = Backend::default();
            let effort = Effort::Quick;
            let found = estimate(scene, backend, &results, self.extent, effort, &mut Silent);
            let all = quantities(&results);
            for (quantity, row) in all.iter().zip(&found.quantities) {
                let (Some(exact), Some(stated)) = (truth.get(&row.quantity), row.relative_error)
                else {
                    continue;
                };
                let true_error = (row.value - exact).abs() / quantity.scale;
                if true_error > SAME {
                    out.push(Claim {
                        family: self.name.clone(),
                        mesh: mesh.clone(),
                        quantity: row.quantity.clone(),
                        kind: quantity.kind,
                        stated,
                        truth: true_error,
                        order: row.order,
                        price: found.work / work(&results),
                    });
                }
            }
        }
        out
    }
}

/// The claims of families; neighbours with the same finer mesh share its run.
pub fn claims_of(families: &[Family]) -> Vec<Claim> {
    let same = families.chunk_by(|a, b| a.truth == b.truth);
    same.flat_map(|same| {
        let known = same[0].known();
        let claims = same.iter().map(|family| family.claims_beside(&known));
        claims.collect::<Vec<_>>().concat()
    })
    .collect()
}

/// A run to its end; `None` where it does not get there.
pub fn run_extent(scene: &Scene, extent: Extent) -> Option<Results> {
    let mut analysis = Analysis::new(Model::new(scene).ok()?, Backend::default()).ok()?;
    let results = match extent {
        Extent::Yield => analysis.yield_load(&mut Silent),
        Extent::Program => analysis.run(&mut Silent),
    };
    results.ok().filter(|r| r.incomplete.is_none())
}

/// The scene with many increments.
pub fn stepped(mut scene: Scene, steps: usize) -> Box<Scene> {
    scene.program.stepping = Stepping::Steps;
    scene.program.steps = steps;
    Box::new(scene)
}

/// Loading far beyond yield, partly off, off.
pub const HISTORY: &str = "program.targets=[{ yield = true }, { load_factor = 1.3 }, \
                           { load_factor = 2.0 }, { name = \"peak\", load_factor = 3.0 }, \
                           { name = \"back\", load_factor = 1.5 }, \
                           { name = \"off\", load_factor = 0.0 }]";

/// A cylinder or ball on a flat with `n` elements over the contact at first yield.
pub fn on_flat(name: &str, n: usize, more: &[&str]) -> Scene {
    let resolution = format!("mesh.cylinder_on_half_plane.resolution={n}");
    let growth = 1.15f64.powf(16.0 / n as f64);
    let growth = format!("mesh.cylinder_on_half_plane.growth={growth}");
    let mut overrides = vec![
        resolution.as_str(),
        growth.as_str(),
        "materials.steel.yield_stress=50.0",
    ];
    overrides.extend(more);
    support::load(name, &overrides)
}

/// A ring of `n` by `n` elements under pressure from within.
pub fn tube(element: &str, n: usize, targets: &str) -> Scene {
    support::load(
        "thick_cylinder",
        &[
            &format!("mesh.parts.0.element={element}"),
            &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
            targets,
        ],
    )
}

pub const TUBE_HISTORY: &str = "program.targets=[{ name = \"pressed\", load_factor = 10.0 }, \
                                { yield = true }, { name = \"p130\", load_factor = 130.0 }, \
                                { name = \"p170\", load_factor = 170.0 }, \
                                { name = \"off\", load_factor = 0.0 }]";

pub const SHAPES: [&str; 4] = ["quad4", "quad8", "tri3", "tri6"];

pub fn named(counts: &[usize], scene: impl Fn(usize) -> Scene) -> Vec<(String, Scene)> {
    counts.iter().map(|n| (n.to_string(), scene(*n))).collect()
}

/// The families with closed forms that judge.
pub fn judging_exactly(folder: &Path) -> Vec<Family> {
    let mut out = vec![point_at_yield(), disc_at_yield()];
    out.extend([0.0, 2e-3, 1e-2].map(pin));
    out.push(shrink_fit());
    out.extend(["quad4", "quad8", "tri6"].map(sphere));
    out.extend(SHAPES.map(|shape| tube_from_file(shape, folder)));
    out
}

/// The families that judge by a finer mesh.
pub fn judging_by_finer_meshes() -> Vec<Family> {
    let far = "mesh.cylinder_on_half_plane.far_size=2000.0";
    let point = |n: usize| on_flat("ball_on_half_space", n, &[far, HISTORY]);
    let disc = |n: usize| disc(n, "mesh.disc_in_plate.element=quad4");
    let biaxial = |n: usize| {
        let mut scene = disc(n);
        let kirsch = scene.load[0].kirsch.as_mut().unwrap();
        kirsch.stress_y = 0.4 * kirsch.stress_x;
        scene
    };
    let bodies = |n: usize| {
        let parts = [[20, 10], [20, 4], [20, 8]].map(|[x, y]| [x * n / 4, y * n / 4]);
        let part = |i: usize| format!("mesh.parts.{i}.block.elements={:?}", parts[i]);
        support::load("three_bodies", &[&part(0), &part(1), &part(2)])
    };
    let punch = |n: usize| {
        let elements = format!("mesh.parts.0.block.elements=[{n},{n}]");
        support::load("flat_punch", &[&elements])
    };
    type OnMeshes = (&'static str, Vec<(String, Scene)>, Scene);
    let families: Vec<OnMeshes> = vec![
        (
            "Hertz point, beyond yield and off",
            named(&[4, 6, 8, 12, 16, 24], point),
            point(48),
        ),
        (
            "disc in a plate, beyond yield and off",
            named(&[20, 32, 44, 60, 90], disc),
            disc(180),
        ),
        (
            "disc, tension both ways",
            named(&[20, 32, 44, 60], biaxial),
            biaxial(180),
        ),
        (
            "three bodies, pressed and off",
            named(&[4, 8, 12], bodies),
            bodies(28),
        ),
        (
            "flat punch, to flow",
            named(&[10, 15, 20, 30, 40], punch),
            punch(120),
        ),
        ("receding layer", named(&[2, 3, 4, 6, 8], layer), layer(24)),
    ];
    let made = families.into_iter().map(|(name, meshes, finer)| Family {
        name: name.to_string(),
        extent: Extent::Program,
        meshes,
        truth: Truth::Finer(stepped(finer, 20)),
    });
    made.collect()
}

fn point_at_yield() -> Family {
    let point = HertzPoint::new(10.0, contact_modulus(210e3, 0.3, 210e3, 0.3)).unwrap();
    let far = "mesh.cylinder_on_half_plane.far_size=2000.0";
    Family {
        name: "Hertz point, first yield".to_string(),
        extent: Extent::Yield,
        meshes: named(&[4, 6, 8, 10, 12, 16, 20, 24], |n| {
            on_flat("ball_on_half_space", n, &[far])
        }),
        truth: Truth::Exact(vec![
            ("yield.load", point.yield_load(0.3, 50.0)),
            ("yield.max_pressure", HertzPoint::yield_pressure(0.3, 50.0)),
            ("yield.half_width", point.yield_contact_radius(0.3, 50.0)),
        ]),
    }
}

fn disc(n: usize, more: &str) -> Scene {
    let growth = 1.05f64.powf(90.0 / n as f64);
    support::load(
        "disc_in_plate",
        &[
            &format!("mesh.disc_in_plate.resolution={n}"),
            &format!("mesh.disc_in_plate.growth={growth}"),
            more,
        ],
    )
}

fn disc_at_yield() -> Family {
    let exact = DiscInPlate::new(10.0).unwrap();
    let load = exact.yield_tension(Plane::Stress, 0.3, 500.0).unwrap();
    let yielding = "program.targets=[{ yield = true }]";
    Family {
        name: "disc in a plate, first yield".to_string(),
        extent: Extent::Yield,
        meshes: named(&[12, 20, 30, 44, 60, 90], |n| disc(n, yielding)),
        truth: Truth::Exact(vec![
            ("yield.load", load),
            ("yield.max_pressure", exact.pressure(0.0, load)),
            ("yield.half_width", 10.0 * exact.half_angle()),
        ]),
    }
}

/// Persson's pin, with a clearance on its radius: neat, and such that the contact is 59 and 29
/// degrees to either side.
fn pin(clearance: f64) -> Family {
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    let exact = PinInHole::new(10.0, clearance, modulus).unwrap();
    let scene = |n: usize| {
        support::load(
            "pin_in_hole",
            &[
                &format!("mesh.parts.0.disc.elements={n}"),
                &format!("mesh.parts.1.ring.elements=[{},{}]", n * 5 / 4, 2 * n),
                &format!("contact.0.gap={clearance:.6}"),
                "program.targets=[{ name = \"pushed\", load_factor = 1.0 }]",
            ],
        )
    };
    Family {
        name: format!("pin in a hole, clearance {clearance}"),
        extent: Extent::Program,
        meshes: named(&[16, 24, 32, 48, 64], scene),
        truth: Truth::Exact(vec![
            (
                "states.pushed.max_pressure",
                exact.max_pressure(1000.0).unwrap(),
            ),
            (
                "states.pushed.half_width",
                10.0 * exact.half_angle(1000.0).unwrap(),
            ),
        ]),
    }
}

fn shrink_fit() -> Family {
    let ring = ThickCylinder::new(50.0, 100.0, 210e3, 0.3, Plane::Stress).unwrap();
    let exact = ShrinkFit::new(0.05, ring, 0.0, 210e3, 0.3).unwrap();
    let scene = |n: usize| {
        support::load(
            "shrink_fit",
            &[
                &format!("mesh.parts.0.disc.elements={n}"),
                &format!("mesh.parts.1.ring.elements=[{n},{n}]"),
            ],
        )
    };
    Family {
        name: "shrink fit".to_string(),
        extent: Extent::Program,
        meshes: named(&[4, 8, 12, 16, 24], scene),
        truth: Truth::Exact(vec![("states.fitted.max_pressure", exact.pressure())]),
    }
}

fn sphere(shape: &str) -> Family {
    let scene = |shape: &str, n: usize| {
        support::load(
            "thick_sphere",
            &[
                &format!("mesh.parts.0.element={shape}"),
                &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
            ],
        )
    };
    Family {
        name: format!("thick sphere, {shape}"),
        extent: Extent::Program,
        meshes: named(&[4, 6, 8, 12, 16, 24], |n| scene(shape, n)),
        truth: Truth::Finer(stepped(scene("quad8", 48), 40)),
    }
}

/// A coarse ring from a file that knows nothing of its shape, with its subdivisions.
fn tube_from_file(shape: &str, folder: &Path) -> Family {
    let scene = from_file(
        tube(shape, 6, TUBE_HISTORY),
        &folder.join(shape),
        &[
            ("tube.inner", [0.0; 2], 100.0),
            ("tube.outer", [0.0; 2], 200.0),
        ],
    );
    let subdivided = |n: usize| {
        let mut scene = scene.clone();
        scene.mesh.subdivisions = n;
        scene
    };
    Family {
        name: format!("thick cylinder from a file, {shape}"),
        extent: Extent::Program,
        meshes: named(&[0, 1, 2], subdivided),
        truth: Truth::Finer(stepped(tube("quad8", 64, TUBE_HISTORY), 40)),
    }
}

/// Writes the mesh of a scene to a file, which knows nothing of its shapes, and gives the scene
/// with that file.
pub fn from_file(mut scene: Scene, folder: &Path, circles: &[(&str, [f64; 2], f64)]) -> Scene {
    std::fs::create_dir_all(folder).unwrap();
    let file = folder.join("mesh.msh");
    let mesh = Model::new(&scene).unwrap().continuum.mesh;
    gmsh::write(&mesh, &mut std::fs::File::create(&file).unwrap()).unwrap();
    let circle = |&(on, center, radius): &(&str, [f64; 2], f64)| SurfaceCircle {
        on: on.to_string(),
        center,
        radius,
    };
    scene.mesh = MeshSource {
        file: Some(file),
        circles: circles.iter().map(circle).collect(),
        ..MeshSource::default()
    };
    scene.validate().unwrap();
    scene
}

/// An elastic layer on a stiffer base, pressed by a strip of pressure: away from it the layer lifts
/// off.
fn layer(n: usize) -> Scene {
    let (along, across) = (16 * n, 2 * n);
    support::parse(&format!(
        r#"
title = "receding layer"
kind = "plane_strain"
symmetry = 2
[[mesh.parts]]
body = "layer"
block = {{ x = [0.0, 8.0], y = [0.0, 1.0], elements = [{along}, {across}], pieces = [
    {{ name = "strip", side = "top", from = 0.0, to = 0.5 }}] }}
[[mesh.parts]]
body = "base"
block = {{ x = [0.0, 8.0], y = [-4.0, 0.0], elements = [{along}, {below}], bias = [1.0, 0.25] }}
[materials.soft]
youngs_modulus = 1000.0
poissons_ratio = 0.3
[materials.stiff]
youngs_modulus = 3000.0
poissons_ratio = 0.3
[bodies]
layer = {{ material = "soft" }}
base = {{ material = "stiff" }}
[[contact]]
first = "layer.bottom"
second = "base.top"
[[support]]
on = "layer.left"
fix = ["x"]
[[support]]
on = "base.left"
fix = ["x"]
[[support]]
on = "base.bottom"
fix = ["y"]
[[load]]
on = "layer.strip"
pressure = 1.0
[program]
targets = [{{ name = "pressed", load_factor = 1.0 }}]
"#,
        below = 4 * n
    ))
}

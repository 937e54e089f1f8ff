//! Meshes from files: subdivided, with new nodes on circles where the scene gives them, they
//! converge as generated meshes do.

use crate::accuracy::demand::reached;
use crate::accuracy::estimate::estimated;
use crate::support;
use crate::support::families::from_file;
use crate::support::msh::{Body, Msh};
use crate::support::random::Random;
use brinell::accuracy::{Effort, Extent, Knob, Plan, Study, estimate, planned, study, work};
use brinell::analytical::{Plane, ThickCylinder};
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::results::{EstimateMethod, Results};
use brinell::scene::Scene;
use std::path::Path;

fn tube(element: &str, folder: &Path, circles: &[(&str, [f64; 2], f64)]) -> Scene {
    let scene = support::load(
        "thick_cylinder",
        &[
            &format!("mesh.parts.0.element={element}"),
            "mesh.parts.0.ring.elements=[4,6]",
            "program.targets=[{ name = \"pressed\", load_factor = 60.0 }, { yield = true }]",
        ],
    );
    from_file(scene, folder, circles)
}

const CIRCLES: &[(&str, [f64; 2], f64)] = &[
    ("tube.inner", [0.0; 2], 100.0),
    ("tube.outer", [0.0; 2], 200.0),
];

/// Errors of displacement and yield load by mesh, finest first.
fn errors(found: &Study) -> Vec<[f64; 2]> {
    let tube = ThickCylinder::new(100.0, 200.0, 210e3, 0.3, Plane::Strain).unwrap();
    let mean = 8f64.sqrt() / std::f64::consts::PI;
    let exact = [
        (
            "states.pressed.approach",
            tube.displacement(100.0, 60.0, 0.0) * mean,
        ),
        ("yield.load", tube.yield_pressure(240.0)),
    ];
    // The series with loose tolerances is left out.
    let mut runs: Vec<_> = found.runs.iter().filter(|r| r.series == "mesh").collect();
    runs.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    let of = |run: &&brinell::accuracy::StudyRun| {
        exact.map(|(path, exact)| {
            let (_, value) = run.values.iter().find(|v| v.0 == path).unwrap();
            (value / exact - 1.0).abs()
        })
    };
    runs.iter().map(of).collect()
}

fn studied(scene: &Scene) -> Study {
    let plan = Plan {
        knobs: vec![Knob::Resolution],
        levels: 8,
        budget: None,
    };
    let found = study(scene, Backend::default(), &plan, &mut Silent).unwrap();
    assert!(found.left_out.is_empty(), "{:?}", found.left_out);
    found
}

#[test]
fn a_ring_from_a_file_converges_with_the_order_of_its_elements() {
    for (element, orders) in [("quad4", [2.0, 2.0]), ("quad8", [3.0, 3.0])] {
        let folder = tempfile::tempdir().unwrap();
        let found = studied(&tube(element, folder.path(), CIRCLES));
        let values: Vec<&str> = found.runs.iter().map(|r| r.value.as_str()).collect();
        for n in 0..4 {
            assert!(
                values.iter().any(|v| *v == format!("subdivisions {n}")),
                "{values:?}"
            );
        }
        let round = errors(&found);
        println!("{element} {round:?}");
        for (i, order) in orders.iter().enumerate() {
            // Over two halvings of the element size.
            let observed = (round[2][i] / round[0][i]).log2() / 2.0;
            assert!(
                observed > order - 0.25,
                "{element} {i}: {observed} of {round:?}"
            );
        }
        // Without the circles the body is the polygon of the file: refinement comes to rest at its
        // error.
        let polygon = errors(&studied(&tube(element, folder.path(), &[])));
        println!("{element} {polygon:?}");
        let rests = polygon[0][0] > 0.5 * polygon[1][0];
        assert!(
            rests && polygon[0][0] > 10.0 * round[0][0],
            "{element}: {polygon:?}"
        );
    }
}

#[test]
fn a_run_on_a_mesh_from_a_file_states_its_errors() {
    let folder = tempfile::tempdir().unwrap();
    let tube = tube("quad4", folder.path(), CIRCLES);
    let (results, accuracy) = estimated(&tube, Extent::Program);
    assert_eq!(accuracy.method, EstimateMethod::CoarserMeshes);
    let ratios: Vec<f64> = accuracy.companions.iter().map(|c| c.ratio).collect();
    assert_eq!(ratios, [0.25, 0.5]);
    let exact = ThickCylinder::new(100.0, 200.0, 210e3, 0.3, Plane::Strain)
        .unwrap()
        .yield_pressure(240.0);
    let row = accuracy
        .quantities
        .iter()
        .find(|q| q.quantity == "yield.load")
        .unwrap();
    let off = (results.first_yield.unwrap().load - exact).abs();
    // Never below the true one; that of the law of the elements' order is 4/3 of the step to the
    // next mesh, thrice that at most.
    let found = row.discretisation.unwrap() / off;
    println!("yield load of a file: {found:.2}");
    assert!((1.0..=4.0).contains(&found), "{found}");
}

/// `accuracy = x` subdivides a file as often as it takes.
#[test]
fn a_demand_chooses_how_often_a_file_is_subdivided() {
    let folder = tempfile::tempdir().unwrap();
    let tube = tube("quad4", folder.path(), CIRCLES);
    let exact = ThickCylinder::new(100.0, 200.0, 210e3, 0.3, Plane::Strain)
        .unwrap()
        .yield_pressure(240.0);
    let mut chosen = Vec::new();
    for accuracy in [0.1, 1e-3] {
        let found = reached(&tube, &accuracy.to_string(), Extent::Yield);
        let load = found.results.first_yield.unwrap().load;
        let off = load / exact - 1.0;
        println!("{accuracy}: {off:e}");
        assert!(off.abs() <= accuracy, "{accuracy}: {load} {exact}");
        chosen.push(found.scene.mesh.subdivisions);
    }
    // Judged by three meshes at least, and a hundred times less by second order: three or four
    // halvings more.
    assert!(
        chosen[0] >= 2 && chosen[1] > chosen[0] && chosen[1] <= chosen[0] + 4,
        "{chosen:?}"
    );
}

/// A file that is too large for meshes of sixteen times as many elements is subdivided once, and
/// states three times the error of the formal order; that of its path is known as elsewhere.
#[test]
fn a_large_file_is_judged_by_one_subdivision() {
    let folder = tempfile::tempdir().unwrap();
    let scene = support::load(
        "thick_cylinder",
        &[
            "mesh.parts.0.element=quad4",
            "mesh.parts.0.ring.elements=[36,36]",
            "program.targets=[{ yield = true }, { name = \"opened\", load_factor = 150.0 }]",
        ],
    );
    let scene = from_file(scene, folder.path(), CIRCLES);
    let (results, accuracy) = estimated(&scene, Extent::Program);
    let ratios: Vec<f64> = accuracy.companions.iter().map(|c| c.ratio).collect();
    assert_eq!(ratios, [0.5]);
    let exact = ThickCylinder::new(100.0, 200.0, 210e3, 0.3, Plane::Strain).unwrap();
    let off = (results.first_yield.unwrap().load - exact.yield_pressure(240.0)).abs();
    let rows = &accuracy.quantities;
    let row = |path: &str| rows.iter().find(|q| q.quantity == path).unwrap();
    assert!(row("yield.load").discretisation.unwrap() >= off);
    assert!(row("states.opened.approach").path.unwrap() > 0.0);
}

/// The contact of the paper's cylinder from a file, subdivided, is that of the generator with as
/// many elements.
#[test]
fn a_contact_from_a_file_keeps_its_pairs_and_gaps() {
    let folder = tempfile::tempdir().unwrap();
    let scene = support::load(
        "cylinder_on_half_plane",
        &[
            "mesh.cylinder_on_half_plane.resolution=4",
            "mesh.cylinder_on_half_plane.growth=1.5",
            "mesh.cylinder_on_half_plane.far_size=100.0",
            "program.targets=[{ yield = true }]",
        ],
    );
    let radius = scene.mesh.cylinder_on_half_plane.as_ref().unwrap().radius;
    let circle = [("cylinder.contact", [0.0, radius], radius)];
    let mut file = from_file(scene, folder.path(), &circle);
    let coarse = Model::new(&file).unwrap();
    file.mesh.subdivisions = 2;
    let fine = Model::new(&file).unwrap();
    assert_eq!(fine.pairs.len(), 4 * (coarse.pairs.len() - 1) + 1);
    for pair in &fine.pairs {
        let [x, ..] = fine.mesh.point(pair.slave);
        let gap = x * x / (radius + ((radius - x) * (radius + x)).sqrt());
        // Coordinates are as exact as those of the centre.
        assert!(
            (pair.gap - gap).abs() <= 4.0 * f64::EPSILON * radius,
            "{x}: {} {gap}",
            pair.gap
        );
    }
    let generated = support::load(
        "cylinder_on_half_plane",
        &[
            "mesh.cylinder_on_half_plane.resolution=16",
            "mesh.cylinder_on_half_plane.growth=1.1067",
            "mesh.cylinder_on_half_plane.far_size=100.0",
            "program.targets=[{ yield = true }]",
        ],
    );
    let load = |scene: &Scene| support::run(scene).first_yield.unwrap().load;
    let (a, b) = (load(&file), load(&generated));
    // The meshes differ where they grow; both are within the error of 16 elements, 0.1 %.
    assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
    file.mesh.subdivisions = 0;
    let found = reached(&file, "3 %", Extent::Yield);
    let c = found.results.first_yield.unwrap().load;
    assert!((c / b - 1.0).abs() < 0.03 + 1e-3, "{c} {b}");
}

/// By default no mesh from a file is subdivided for its estimate, in full it is where that takes no
/// more than 72 times the run: `planned` says which before it starts, and it is what is done.
#[test]
fn the_estimate_of_a_file_is_bounded_and_told_before() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("block.msh");
    let block = |cells: [usize; 2], solid: bool| {
        let mut msh = Msh::default();
        let body = Body {
            name: "b",
            from: 0.0,
            width: 1.0,
            cells,
            heights: [&|_| 0.0, &|_| 1.0],
            kink: None,
            grading: 1.0,
            jitter: 0.0,
        };
        let random = &mut Random::new(1);
        let (kind, held, load) = match solid {
            true => {
                body.solid(&mut msh, false, 1, random);
                ("solid", "\"x\", \"y\", \"z\"", "[0.0, 3.0, 1.0]")
            }
            false => {
                body.plane(&mut msh, false, 1, random);
                ("plane_strain", "\"x\", \"y\"", "[3.0, 1.0]")
            }
        };
        std::fs::write(&file, msh.text()).unwrap();
        support::parse(&format!(
            "kind = \"{kind}\"\nmesh.file = {file:?}\nbodies.b.material = \"m\"\n\
             support = [{{ on = \"b bottom\", fix = [{held}] }}]\n\
             load = [{{ on = \"b top\", traction = {load} }}]\n\
             [materials.m]\nyoungs_modulus = 1000.0\npoissons_ratio = 0.3\n\
             [program]\ntargets = [{{ load_factor = 1.0 }}]\n"
        ))
    };
    let estimated = |scene: &Scene, results: &Results, effort| {
        let (backend, extent) = (Backend::default(), Extent::Program);
        let accuracy = estimate(scene, backend, results, extent, effort, &mut Silent);
        let ratios: Vec<f64> = accuracy.companions.iter().map(|c| c.ratio).collect();
        (ratios, accuracy)
    };
    for (cells, solid, ratios, words) in [
        (
            [25, 10],
            false,
            &[0.25, 0.5][..],
            "0.250 and 0.500 times as large; about 75 times",
        ),
        (
            [25, 11],
            false,
            &[0.5],
            "0.500 times as large; about 11 times",
        ),
        (
            [5, 10],
            true,
            &[0.5],
            "0.500 times as large; about 67 times",
        ),
        ([5, 11], true, &[], "energy norm of the stress error"),
    ] {
        let scene = block(cells, solid);
        let elements = cells[0] * cells[1] * if solid { cells[0] } else { 1 };
        let results = support::run(&scene);
        let said = planned(&scene, elements, Effort::Full);
        assert!(said.contains(words), "{said}");
        let (found, full) = estimated(&scene, &results, Effort::Full);
        assert_eq!(found, ratios, "{cells:?}");
        let by_norm = full.method == EstimateMethod::EnergyNorm;
        assert_eq!(by_norm, ratios.is_empty());

        let said = planned(&scene, elements, Effort::Quick);
        assert!(
            said.starts_with("energy norm of the stress error (a mesh from a file"),
            "{said}"
        );
        assert!(said.ends_with("at most 50 % of the run"), "{said}");
        let (found, quick) = estimated(&scene, &results, Effort::Quick);
        assert_eq!((found, quick.method), (vec![], EstimateMethod::EnergyNorm));
        assert!(
            quick.notes[0].contains("no coarser member than the file"),
            "{:?}",
            quick.notes
        );
        assert!(
            quick.work <= work(&results),
            "{} of {}",
            quick.work,
            work(&results)
        );
        // The load is given; the approach is wrong by no more than is said.
        let [approach] = &quick.quantities[..] else {
            panic!("{:?}", quick.quantities);
        };
        let better = full.quantities[0].extrapolated;
        assert!(better.is_none_or(|b| (approach.value - b).abs() <= approach.error.unwrap()));
    }
}

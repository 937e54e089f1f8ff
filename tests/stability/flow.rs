//! Plastic flow: uniform, cyclic, at the limit load, nearly incompressible.

use crate::support::{close, healthy, largest, load, run_file, same_contact, state};
use brinell::ErrorKind;
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::mesh::Mesh;
use brinell::model::Model;
use brinell::progress::{Flow, Observer, Silent};
use brinell::results::{HistoryRow, Results, State};

/// What was computed up to the end of a run that need not complete, and the mesh.
fn as_far_as_it_goes(name: &str, overrides: &[&str]) -> (Mesh, Results) {
    let model = Model::new(&load(name, overrides)).unwrap();
    let mut analysis = Analysis::new(model, Backend::default()).unwrap();
    let results = analysis.run(&mut Silent).unwrap();
    (analysis.model().mesh.clone(), results)
}

/// Nothing elastic is left to confine the flow: the plain initial-load iteration contracts at
/// 3G/(3G + H) only, and codes stop at their limit of iterations short of equilibrium. The bar's
/// solution is exact for the elements.
#[test]
fn uniform_flow_with_every_pair_closed_is_that_of_a_bar() {
    let results = run_file("hard/all_closed", &[]);
    healthy(&results);
    close("yield", results.first_yield.unwrap().alpha, 1.0, 1.0, 1e-12);
    let strain = (600.0 - 500.0) / 1000.0;
    for name in ["plastic", "unloaded"] {
        // The forces balance to 1e-10: stress to 6e-8, strain to 6e-8 / H.
        let s = state(&results, name);
        close(
            "strain",
            s.max_equivalent_plastic_strain,
            strain,
            600.0 / 1000.0,
            1e-9,
        );
    }
    for p in &state(&results, "plastic").pairs {
        close("pressure", p.pressure, 600.0, 600.0, 1e-9);
    }
    // Both blocks, 2 x 1 each, have yielded at all 4 points of 24 elements.
    let plastic = state(&results, "plastic");
    close("plastic zone", plastic.plastic_zone_size, 4.0, 4.0, 1e-12);
    assert_eq!(plastic.plastic_points_by_body, [96, 96]);
    close(
        "unloaded",
        state(&results, "unloaded").contact_force,
        0.0,
        1200.0,
        1e-10,
    );
}

/// Flow that hardly turns, as all round a sphere, converges at once on any mesh: where the stress
/// of a point jumps by what iterations are to come to, increments are cut to nothing.
#[test]
fn flow_that_hardly_turns_converges_on_fine_meshes() {
    let fine = [
        "mesh.parts.0.element=quad8",
        "mesh.parts.0.ring.elements=[32,32]",
    ];
    for stepping in ["auto", "steps", "events"] {
        let stepping = format!("program.stepping={stepping}");
        let results = run_file("thick_sphere", &[fine[0], fine[1], &stepping]);
        healthy(&results);
        let (counts, increments) = (&results.counts, results.history.len());
        assert!(counts.plastic_iterations < 6 * increments, "{counts:?}");
        assert!(counts.trailing_solves < 30 * increments, "{counts:?}");
    }
}

/// Unloading is elastic if the flow rule sees the trial stress of the committed state, not of the
/// last iterate, and contact is reversible if gaps are total, not summed up. Events are hit within
/// gamma = 1e-8.
#[test]
fn unloading_and_reloading_comes_back_to_the_same_state() {
    let results = run_file("hard/unload_reload", &[]);
    healthy(&results);
    let (first, second) = (state(&results, "first"), state(&results, "second"));
    same_contact("reloaded", first, second, 1e-7);
    let strain = first.max_equivalent_plastic_strain;
    close(
        "strain",
        strain,
        second.max_equivalent_plastic_strain,
        strain,
        1e-7,
    );
    let below = state(&results, "below").max_equivalent_plastic_strain;
    close("strain below", strain, below, strain, 1e-7);
    assert!(state(&results, "beyond").max_equivalent_plastic_strain > 1.001 * strain);
}

/// A cylinder's contact grows with the load and shrinks without it: pairs close on the way up and
/// open on the way down, in plastic increments as in elastic ones, and each event changes the
/// number of closed pairs by those that it names.
#[test]
fn events_of_plastic_increments_say_what_happened() {
    let results = run_file("hard/unload_reload", &["program.stepping=events"]);
    let mut seen = [0, 0];
    for (before, row) in results.history.iter().zip(&results.history[1..]) {
        let (closes, opens) = (
            row.event.matches("closes").count(),
            row.event.matches("opens").count(),
        );
        let upward = row.load > before.load;
        assert!(closes == 0 || upward, "{} {}", row.increment, row.event);
        assert!(opens == 0 || !upward, "{} {}", row.increment, row.event);
        if row.plastic_points > 0 && row.iterations > 1 {
            seen[0] += closes;
        } else {
            seen[1] += closes + opens;
        }
    }
    assert!(seen[0] > 0 && seen[1] > 0, "{seen:?}");
    let closed: Vec<usize> = results.history.iter().map(|row| row.closed_pairs).collect();
    assert!(closed.iter().any(|&n| n > closed[0]), "{closed:?}");
}

/// History that is committed in the middle of an iteration ratchets: plastic strain grows from
/// cycle to cycle for ever. Here the loop closes, and the steps from cycle to cycle shrink to it.
#[test]
fn cyclic_load_closes_its_loop() {
    let results = run_file("hard/cyclic", &[]);
    healthy(&results);
    let strain = |s: &State| s.max_equivalent_plastic_strain;
    let at = |name: &str, k: usize| state(&results, &format!("{name} {k}")).clone();
    for name in ["high", "low"] {
        let growth = |k: usize| strain(&at(name, k + 1)) - strain(&at(name, k));
        assert!(
            growth(4) <= growth(1) + 1e-12,
            "{name}: {} {}",
            growth(1),
            growth(4)
        );
        close(
            name,
            strain(&at(name, 5)),
            strain(&at(name, 4)),
            strain(&at(name, 5)),
            1e-6,
        );
        same_contact(name, &at(name, 4), &at(name, 5), 1e-6);
    }
}

/// Beyond the limit load there is no equilibrium: codes cut back until they give up without a word,
/// or return the last iterate. The column carries Y exactly; the drive gives up after 12 cuts by 4
/// of the step to 1.5.
#[test]
fn the_limit_load_is_bracketed_and_reported_as_collapse() {
    let (_, results) = as_far_as_it_goes("hard/limit_load", &[]);
    assert_eq!(
        results.ending().kind(),
        Some(ErrorKind::Collapse),
        "{:?}",
        results.incomplete
    );
    assert_eq!(results.states.len(), 1);
    healthy(&results);
    let last = results.history.last().unwrap().alpha;
    let smallest_step = 0.5 * 0.25f64.powi(12);
    assert!(
        (1.0 - 1e-9..=1.0 + smallest_step).contains(&last),
        "{last:.15}"
    );
    let why = results.incomplete.unwrap().why;
    assert!(why.contains("load factor"), "{why}");
}

/// nu = 0.4999 and isochoric flow: fully integrated linear elements lock (no limit load at all),
/// selectively reduced ones may leave a checkerboard of mean stress. All shapes that claim not to
/// lock.
#[test]
fn nearly_incompressible_flow_neither_locks_nor_checkers() {
    for shape in ["quad4", "quad8", "tri6"] {
        flow_of(shape);
    }
}

fn flow_of(shape: &str) {
    let element = format!("mesh.parts.0.element={shape}");
    let (mesh, results) = as_far_as_it_goes("hard/nearly_incompressible", &[&element]);
    healthy(&results);
    let k = 240.0 / 3f64.sqrt();
    let limit = 2.0 * k * 2f64.ln();
    assert_eq!(
        results.ending().kind(),
        Some(ErrorKind::Collapse),
        "{:?}",
        results.incomplete
    );
    let last = results.history.last().unwrap().alpha;
    close("limit load", last, limit, limit, 0.01);

    // Hill's fields at p = 185 for nu = 1/2: plastic to c, elastic outside.
    let (a, b, p) = (100.0f64, 200.0f64, 185.0);
    let pressure = |c: f64| k * (2.0 * (c / a).ln() + 1.0 - c * c / (b * b));
    let (mut low, mut high) = (a, b);
    for _ in 0..60 {
        let c = 0.5 * (low + high);
        if pressure(c) < p { low = c } else { high = c }
    }
    let c = low;
    let exact = |r: f64| k * (c * c / (b * b) - if r < c { 2.0 * (c / r).ln() } else { 0.0 });
    let flow = state(&results, "flow");
    let stress = &flow.fields.as_ref().unwrap().stress;
    let mut by_radius: Vec<(f64, f64)> = Vec::new();
    for e in 0..mesh.n_elements() {
        let nodes = mesh.nodes(e);
        let radius = nodes
            .iter()
            .map(|&n| mesh.point(n as usize))
            .map(|x| x[0].hypot(x[1]))
            .sum::<f64>()
            / nodes.len() as f64;
        let mean = stress[4 * e..4 * e + 3].iter().sum::<f64>() / 3.0;
        // A checkerboard is of the size of k; linear elements of 1/12 of the wall leave about h^2
        // and the kink at c.
        close(
            &format!("{shape}: mean stress at {radius}"),
            mean,
            exact(radius),
            k,
            0.05,
        );
        by_radius.push((radius, mean));
    }
    if shape == "tri6" {
        // Triangles lie either way in a sector: no two alike.
        return;
    }
    // The mesh is the same in every sector: so is the solution, to the tolerance of the plastic
    // iteration.
    by_radius.sort_by(|x, y| x.0.total_cmp(&y.0));
    for ring in by_radius.chunks(8) {
        assert!(ring[7].0 - ring[0].0 < 1e-9);
        let spread = largest(ring.iter().map(|s| s.1 - ring[0].1));
        assert!(spread < 1e-6 * k, "{ring:?}");
    }
}

/// The axis pair of quadratic elements carries no force whatever the pressure: open and closed are
/// both right, and a code that asks which flips it for ever (or, as CalculiX, leaves it out and
/// doubles its neighbour's pressure). Here it is no pair, and the pressure is continued to the
/// axis: that of linear elements, which need no such care, in the same state of uniform stress.
#[test]
fn flow_under_contact_on_the_axis_of_quadratic_elements() {
    let (name, pressed) = (
        "hard/axis_of_quadratic_elements",
        "program.targets=[{ load_factor = 1.5 }]",
    );
    let quadratic = run_file(name, &[pressed]);
    healthy(&quadratic);
    let linear = [0, 1].map(|part| format!("mesh.parts.{part}.element=quad4"));
    let linear = run_file(name, &[pressed, &linear[0], &linear[1]]);
    healthy(&linear);
    let (a, b) = (&quadratic.states[0], &linear.states[0]);
    // Uniform pressure on a free cylinder: `(p - Y)/H` all over the lower one, of radius 2 and
    // height 0.3.
    let (p, y, h) = (
        1.5 * 60.876726527999686,
        81.72701746729727,
        980.9740668165642,
    );
    let volume = std::f64::consts::PI * 4.0 * 0.3;
    for s in [a, b] {
        let strain = (p - y) / h;
        // Forces balance to 1e-10 of the pressure.
        close(
            "strain",
            s.max_equivalent_plastic_strain,
            strain,
            p / h,
            1e-9,
        );
        close("zone", s.plastic_zone_size, volume, volume, 1e-12);
        assert_eq!(s.plastic_points_by_body[1], 0);
    }
    close(
        "force",
        a.contact_force,
        b.contact_force,
        b.contact_force,
        1e-9,
    );
    close(
        "strain",
        a.max_equivalent_plastic_strain,
        b.max_equivalent_plastic_strain,
        1e-2,
        1e-7,
    );
    let uniform = a.contact_force / (std::f64::consts::PI * 4.0);
    for pair in a.pairs.iter().chain(&b.pairs) {
        close("pressure", pair.pressure, uniform, uniform, 1e-8);
    }
    let axis = a.pairs.iter().find(|p| p.position[0] == 0.0).unwrap();
    assert_eq!((axis.area, axis.force), (0.0, 0.0));
    assert_eq!(axis.status, brinell::results::Status::Closed);
}

/// A ball of quadratic elements that flows: the pole pressure, the contact radius and the plastic
/// strain of a mesh of linear elements with as many nodes, to the error of that mesh (p and a
/// converge with h^2; resolution 6 against Hertz is 2 % off).
#[test]
fn a_ball_of_quadratic_elements_flows_like_one_of_linear_elements() {
    let targets =
        "program.targets=[{ yield = true }, { load_factor = 3.0 }, { load_factor = 0.0 }]";
    let run = |element: &str, resolution: usize| {
        run_file(
            "ball_on_half_space",
            &[
                targets,
                "mesh.cylinder_on_half_plane.far_size=60.0",
                &format!("mesh.cylinder_on_half_plane.element={element}"),
                &format!("mesh.cylinder_on_half_plane.resolution={resolution}"),
            ],
        )
    };
    let (linear, quadratic) = (run("quad4", 8), run("quad8", 4));
    healthy(&quadratic);
    for (a, b) in linear.states.iter().zip(&quadratic.states).take(2) {
        for (what, x, y) in [
            ("load", a.load, b.load),
            ("half width", a.half_width, b.half_width),
            ("max pressure", a.max_pressure, b.max_pressure),
            ("pole pressure", a.pole_pressure, b.pole_pressure),
        ] {
            close(&format!("{what} at {}", a.name), x, y, x, 0.05);
        }
    }
}

/// On the axis quadratic elements have no pair: nothing keeps the surfaces apart there, and what is
/// told is how far they are, overlap included: by the displacements of the two nodes.
#[test]
fn overlap_on_the_axis_of_quadratic_elements_is_told() {
    let results = run_file(
        "ball_on_half_space",
        &[
            "mesh.cylinder_on_half_plane.far_size=60.0",
            "mesh.cylinder_on_half_plane.element=quad8",
            "mesh.cylinder_on_half_plane.resolution=4",
            "program.targets=[{ yield = true }, { load_factor = 3.0 }, { load_factor = 0.0 }]",
        ],
    );
    let mut overlaps = 0;
    for state in &results.states {
        let axis = state.pairs.iter().find(|p| p.area == 0.0).unwrap();
        assert_eq!(axis.position[0], 0.0);
        let fields = state.fields.as_ref().unwrap();
        let model = Model::new(&load(
            "ball_on_half_space",
            &[
                "mesh.cylinder_on_half_plane.far_size=60.0",
                "mesh.cylinder_on_half_plane.element=quad8",
                "mesh.cylinder_on_half_plane.resolution=4",
            ],
        ))
        .unwrap();
        let nodes = &model.contacts[0].axis.as_ref().unwrap().pair;
        let along = |node: usize| fields.displacement[2 * node + 1];
        let apart = along(nodes.masters[0].0) - along(nodes.slave);
        close("gap", axis.gap, apart, state.approach, 1e-9);
        overlaps += usize::from(axis.gap < 0.0);
        // Small beside the dent, and no more.
        assert!(axis.gap.abs() <= 0.05 * state.approach, "{}", axis.gap);
    }
    assert!(overlaps > 0);
}

/// Two blocks under a pressure beyond yield, plane stress and next to no hardening: the tangent's
/// solve takes many steps. The nodes of closed pairs carry forces that no step sees, whose
/// round-off each multiplied, until the contact passed on another force than was applied.
#[test]
fn newton_finds_what_the_plain_iteration_finds_across_closed_pairs() {
    let pressed = |iteration: &str| {
        let results = run_file(
            "contact_patch",
            &[
                "kind=plane_stress",
                "materials.steel.yield_stress=500.0",
                "materials.steel.plastic_modulus=1000.0",
                "support=[{on=\"lower.bottom\",fix=[\"y\"]},{on=\"lower.left\",fix=[\"x\"]},\
                 {on=\"upper.left\",fix=[\"x\"]},{on=\"upper.top\",fix=[\"x\"]}]",
                "load.0.pressure=600.0",
                "program.targets=[{load_factor=1.0},{load_factor=0.0}]",
                &format!("analysis.plastic_iteration={iteration}"),
            ],
        );
        healthy(&results);
        results
    };
    let (newton, plain) = (pressed("newton"), pressed("plain"));
    for (a, b) in newton.states.iter().zip(&plain.states) {
        close("force", a.contact_force, b.contact_force, 1200.0, 1e-9);
        let strain = b.max_equivalent_plastic_strain;
        close(
            "strain",
            a.max_equivalent_plastic_strain,
            strain,
            strain,
            1e-6,
        );
        close(
            "dent",
            a.residual_depth,
            b.residual_depth,
            b.residual_depth,
            1e-6,
        );
    }
    close(
        "force",
        newton.states[0].contact_force,
        1200.0,
        1200.0,
        1e-9,
    );
}

/// Far below a load of the program that takes the contact to a hundred times its area the zone
/// still holds the place of first yield: stress near the surface falls as the pressure evens out,
/// and what it is at the largest load does not tell.
#[test]
fn first_yield_lies_in_the_zone_whatever_load_follows() {
    struct UpTo(f64);
    impl Observer for UpTo {
        fn increment(&mut self, row: &HistoryRow, _fraction: f64) -> Flow {
            if row.alpha < self.0 {
                Flow::Continue
            } else {
                Flow::Stop
            }
        }
    }
    let targets = "program.targets=[{yield=true},{load_factor=200}]";
    let scene = load("cylinder_on_half_plane", &[targets]);
    let model = Model::new(&scene).unwrap();
    let mut analysis = Analysis::new(model, Backend::default()).unwrap();
    let results = analysis.run(&mut UpTo(3.0)).unwrap();
    assert_eq!(results.ending().kind(), Some(brinell::ErrorKind::Stopped));
    let beyond = results.history.iter().filter(|row| row.alpha > 1.1);
    for row in beyond {
        assert!(row.plastic_points > 0, "nothing flows at {}", row.alpha);
    }
}

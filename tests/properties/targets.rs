//! Targets by a figure of the state: the load that is found leaves what was asked for.

use crate::support::{SMALL_BALL, load, run, run_text, try_run};
use brinell::analytical::{HertzPoint, contact_modulus};
use brinell::linalg::Backend;
use brinell::results::{Results, State};
use std::f64::consts::PI;

/// A coarse ball on a half space.
const BALL: [&str; 3] = [
    "mesh.cylinder_on_half_plane.resolution=5",
    "mesh.cylinder_on_half_plane.far_size=60",
    "mesh.cylinder_on_half_plane.contact_width=4",
];

/// The ball with a program; more overrides.
fn ball(targets: &str, more: &[&str]) -> Results {
    let targets = format!("program.targets=[{targets}]");
    let overrides: Vec<&str> = BALL
        .into_iter()
        .chain([targets.as_str()])
        .chain(more.iter().copied())
        .collect();
    run(&load("ball_on_half_space", &overrides))
}

fn relative(a: f64, b: f64) -> f64 {
    (a / b - 1.0).abs()
}

/// The figure of a state that a target asks for.
fn figure(state: &State, key: &str) -> f64 {
    brinell::results::Quantity::of(key).map_or(f64::NAN, |quantity| (quantity.in_state.get)(state))
}

/// Unloading from the load that is found leaves the dent that was asked for; and a run to the load
/// after which a dent was left finds that load again, where increments end at the same changes of
/// contact: the search goes by the loads 1, 2 and 4.
#[test]
fn the_load_that_leaves_a_dent() {
    let events = "program.stepping=events";
    let direct = ball(
        "{ load_factor = 2.0 }, { load_factor = 3.0 }, { load_factor = 0.0 }",
        &[events],
    );
    let dent = direct.states[2].residual_depth;
    assert!(dent > 0.0);
    for stepping in [events, "program.stepping=auto", "program.stepping=steps"] {
        let targets =
            format!("{{ name = \"C0\", residual_depth = {dent:e} }}, {{ load_factor = 0.0 }}");
        let found = ball(&targets, &[stepping]);
        let [pressed, off] = &found.states[..] else {
            panic!("{} states", found.states.len());
        };
        assert!(relative(off.residual_depth, dent) <= 2e-8, "{stepping}");
        assert_eq!(found.warnings, direct.warnings);
        // The path of other increments is another one, by less than its error.
        let tolerance = if stepping == events { 1e-7 } else { 2e-2 };
        let off = relative(pressed.alpha, 3.0);
        assert!(off <= tolerance, "{stepping}: {off:e}");
        assert!(!pressed.load_is_given);
    }
}

/// Where the material yields on the way back, by back stresses, what plastic strains leave at the
/// load that is found is another dent: it is what unloading leaves that is asked for.
#[test]
fn yielding_on_the_way_back_is_part_of_the_dent() {
    let dent = 1e-3;
    let targets = format!("{{ residual_depth = {dent:e} }}, {{ load_factor = 0.0 }}");
    let found = ball(
        &targets,
        &[
            "mesh.cylinder_on_half_plane.contact_width=",
            "materials.steel.tangent_modulus=",
            "materials.steel.plastic_modulus=100",
            "materials.steel.back_stresses=[[60000, 300]]",
        ],
    );
    let [pressed, off] = [0, 1].map(|k| relative(found.states[k].residual_depth, dent));
    assert!(pressed > 1e-6 && off <= 1e-8, "{pressed:e} {off:e}");
}

/// One body's dent, and one after the other, with the load off in between.
#[test]
fn dents_of_one_body_one_after_the_other() {
    let direct = ball("{ load_factor = 2.5 }, { load_factor = 0.0 }", &[]);
    let of_body = |state: &State| state.residual_depth_by_body[1];
    let [first, second] = [0.4, 0.9].map(|share| share * of_body(&direct.states[1]));
    let targets = format!(
        "{{ residual_depth = {first:e}, body = \"half_plane\" }}, {{ load_factor = 0.0 }}, \
         {{ residual_depth = {second:e}, body = \"half_plane\" }}, {{ load_factor = 0.0 }}"
    );
    let found = ball(&targets, &[]);
    let states = &found.states;
    assert!(relative(of_body(&states[1]), first) <= 2e-8);
    assert!(relative(of_body(&states[3]), second) <= 2e-8);
    assert!(states[0].alpha > 1.0 && states[2].alpha > states[0].alpha && states[2].alpha < 2.5);
    let name = &states[0].name;
    assert!(name.starts_with("residual depth ") && name.ends_with(" of half_plane"));
}

/// Each figure, elastic and beyond yield: the state has it, and the load is that of a run to it.
#[test]
fn each_figure_is_landed_on() {
    let events = "program.stepping=events";
    let direct = ball("{ load_factor = 0.7 }, { load_factor = 2.0 }", &[events]);
    for key in [
        "contact_force",
        "contact_area",
        "max_pressure",
        "approach",
        "max_equivalent_plastic_strain",
        "half_width",
    ] {
        for state in &direct.states {
            let mut wanted = figure(state, key);
            if wanted == 0.0 {
                continue;
            }
            let of = if key == "half_width" {
                direct.first_yield.unwrap().half_width
            } else {
                1.0
            };
            wanted /= of;
            let found = ball(&format!("{{ {key} = {wanted:e} }}"), &[events]);
            let got = &found.states[0];
            let off = relative(figure(got, key), wanted * of);
            assert!(off <= 1e-8, "{key} at {}: {off:e}", state.alpha);
            // Pressure and half width depend little on the load.
            let off = relative(got.alpha, state.alpha);
            assert!(off <= 1e-6, "{key} at {}: {off:e}", state.alpha);
            assert_eq!(found.warnings, direct.warnings);
        }
    }
}

/// Where the load goes back a figure that follows it is met on the way back.
#[test]
fn figures_that_follow_the_load_are_met_in_unloading_too() {
    let found = ball(
        "{ contact_force = 300.0 }, { name = \"back\", contact_force = 100.0 }, \
         { contact_force = 200.0, contact = 1 }",
        &["program.unit=load"],
    );
    let loads: Vec<f64> = found.states.iter().map(|state| state.load).collect();
    for (load, wanted) in loads.iter().zip([300.0, 100.0, 200.0]) {
        assert!(relative(*load, wanted) <= 1e-8, "{loads:?}");
    }
    assert_eq!(found.states[2].name, "contact force 200 of contact 1");
}

/// Hertz's ball: pressure, area and force of its load. Errors are those of the mesh: 5 elements
/// over the radius at yield.
#[test]
fn elastic_figures_are_those_of_hertz() {
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    let hertz = HertzPoint::new(10.0, modulus).unwrap();
    let load_of = |target: String| {
        let more = [
            "bodies.cylinder.plastic=false",
            "bodies.half_plane.plastic=false",
            "mesh.cylinder_on_half_plane.half_width=0.11",
            "program.unit=load",
            "reference=[]",
        ];
        ball(&format!("{{ {target} }}"), &more).states[0].load
    };
    let load = 15.0;
    let [pressure, area] = [
        hertz.max_pressure(load),
        PI * hertz.contact_radius(load).powi(2),
    ];
    // The load goes with the cube of the pressure, and with the 3/2 power of the area.
    assert!(relative(load_of(format!("max_pressure = {pressure}")), load) <= 0.03);
    assert!(relative(load_of(format!("contact_area = {area}")), load) <= 0.03);
    assert!(relative(load_of(format!("contact_force = {load}")), load) <= 1e-8);
}

/// A body that nothing but contact holds moves as a whole, too: its displacement and approach are
/// those that the state has.
#[test]
fn a_floating_body_is_met_where_it_is() {
    for target in [
        "approach = 0.0104",
        "displacement = { on = \"upper.top\", direction = \"y\", value = -0.0104 }",
    ] {
        let targets = format!("program.targets=[{{ {target} }}]");
        let results = run(&load("hard/floating_body", &[&targets]));
        let approach = results.states[0].approach;
        assert!(relative(approach, 0.0104) <= 1e-8, "{target}: {approach}");
    }
}

/// The displacement that is sought is along the axis that the target names: a bar in space under
/// uniaxial stress moves by `sigma L / E` along its load, and by `-nu` times as much across it.
#[test]
fn displacements_along_each_axis_in_space() {
    let [e, nu, pressure] = [1000.0, 0.3, 10.0];
    let sizes = [1.0, 2.0, 4.0];
    let held = ["left", "front", "bottom"];
    let free = ["right", "back", "top"];
    let axes = ["x", "y", "z"];
    for loaded in 0..3 {
        for sought in 0..3 {
            let moves = pressure / e * sizes[sought] * if loaded == sought { -1.0 } else { nu };
            let support = |axis: usize| {
                format!(
                    "{{ on = \"bar.{}\", fix = [\"{}\"] }}",
                    held[axis], axes[axis]
                )
            };
            let text = format!(
                "kind = \"solid\"\n\
                 support = [{}, {}, {}]\n\
                 load = [{{ on = \"bar.{}\", pressure = {pressure:.1} }}]\n\
                 [[program.targets]]\n\
                 displacement = {{ on = \"bar.{}\", direction = \"{}\", value = {:e} }}\n\
                 [materials.m]\n\
                 youngs_modulus = {e:.1}\n\
                 poissons_ratio = {nu}\n\
                 [bodies.bar]\n\
                 material = \"m\"\n\
                 [[mesh.parts]]\n\
                 body = \"bar\"\n\
                 element = \"hex8\"\n\
                 brick = {{ x = [0, 1], y = [0, 2], z = [0, 4], elements = [1, 2, 2] }}\n",
                support(0),
                support(1),
                support(2),
                free[loaded],
                free[sought],
                axes[sought],
                1.5 * moves,
            );
            let alpha = run_text(&text).states[0].alpha;
            assert!(
                relative(alpha, 1.5) <= 1e-8,
                "loaded along {}, sought along {}: {alpha}",
                axes[loaded],
                axes[sought]
            );
        }
    }
}

/// A quarter of a solid ball: force, area and dent are those of the whole.
#[test]
fn a_quarter_of_a_ball_in_space() {
    let with = |targets: String| {
        let targets = format!("program.targets=[{targets}]");
        let overrides: Vec<&str> = SMALL_BALL.into_iter().chain([targets.as_str()]).collect();
        run(&load("ball_on_flat_3d", &overrides))
    };
    let direct = with("{ load_factor = 2.0 }, { load_factor = 0.0 }".to_string());
    let dent = 0.8 * direct.states[1].residual_depth;
    let found = with(format!(
        "{{ residual_depth = {dent:e} }}, {{ load_factor = 0.0 }}"
    ));
    assert!(relative(found.states[1].residual_depth, dent) <= 2e-8);
    let pressed = &direct.states[0];
    assert!(relative(pressed.contact_force, pressed.load) <= 1e-6);
    assert!(relative(pressed.contact_area, pressed.patches[0].area) == 0.0);
    let half = 0.5 * pressed.contact_force;
    let found = with(format!("{{ contact_force = {half:e} }}"));
    assert!(relative(found.states[0].load, half) <= 1e-6);
}

/// What cannot be reached says how far it came, and ends as the run does that shows it.
#[test]
fn targets_out_of_reach_say_what_was_reached() {
    let fails = |name: &str, overrides: &[&str]| {
        let error = try_run(&load(name, overrides), Backend::default()).unwrap_err();
        (error.kind(), error.to_string())
    };
    let deep = "program.targets=[{ name = \"deep\", residual_depth = 1e3 }]";
    let (kind, text) = fails("hard/limit_load", &[deep]);
    assert_eq!(kind, brinell::ErrorKind::Collapse, "{text}");
    assert!(
        text.contains("target `deep` was not reached") && text.contains("residual_depth is"),
        "{text}"
    );
    // It has more of it already.
    let mut overrides = BALL.to_vec();
    overrides.push(
        "program.targets=[{ load_factor = 3.0 }, { name = \"late\", residual_depth = 1e-9 }]",
    );
    let (kind, text) = fails("ball_on_half_space", &overrides);
    assert_eq!(kind, brinell::ErrorKind::Analysis);
    assert!(
        text.contains("target `late`") && text.contains("already"),
        "{text}"
    );
}

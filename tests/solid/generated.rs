//! The generator of two curved bodies against Hertz's theory, against its own halves, and against
//! the axisymmetric model.

use crate::support::{either, load, run, run_file, same_figures};
use brinell::analytical::{HertzEllipse, contact_modulus};
use brinell::results::State;
use brinell::scene::Target;

fn near(value: f64, exact: f64, off: f64, what: &str) {
    assert!(
        (value / exact - 1.0).abs() < off,
        "{what}: {value} for {exact}"
    );
}

/// First yield of a circle and of ellipses: pressure, half axes, load and depth, to order h^2.
#[test]
fn first_yield_is_that_of_hertz() {
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    // With so many elements over the smaller half axis.
    let ball = either(&[3, 5][..], &[4, 6]);
    let ellipse = either(&[4][..], &[4, 6]);
    let groove = either(&[3][..], &[4, 6]);
    for (name, upper, lower, strength, sizes) in [
        ("ball_on_flat_3d", [10.0, 10.0], [0.0, 0.0], 500.0, ball),
        ("crossed_cylinders", [0.0, 4.0], [12.0, 0.0], 500.0, ellipse),
        ("ball_in_groove", [5.0, 5.0], [-5.2, 20.0], 1800.0, groove),
    ] {
        let radii = HertzEllipse::relative_radii(upper, lower).unwrap();
        let hertz = HertzEllipse::new(radii, modulus).unwrap();
        for &n in sizes {
            let resolution = format!("mesh.curved_bodies.resolution={n}");
            let mut scene = load(name, &[&resolution]);
            scene.program.targets = vec![Target {
                first_yield: true,
                ..Target::default()
            }];
            let results = run(&scene);
            let first = results.first_yield.unwrap();
            let (what, square) = (format!("{name} {n}"), 1.0 / (n * n) as f64);
            near(
                first.max_pressure,
                hertz.yield_pressure(0.3, strength),
                0.3 * square,
                &what,
            );
            // The load goes with the third power of the pressure.
            near(
                first.load,
                hertz.yield_load(0.3, strength),
                0.9 * square,
                &what,
            );
            near(
                -first.location[2],
                hertz.yield_depth(0.3, strength),
                1.2 * square,
                &what,
            );
            let patch = &results.states[0].patches[0];
            let mut axes = hertz.semi_axes(first.load);
            axes.sort_by(|a, b| b.total_cmp(a));
            // Elements along the larger half axis are up to twice as long.
            for (a, exact) in patch.semi_axes.iter().zip(axes) {
                near(*a, exact, 0.2 / n as f64, &what);
            }
            near(
                results.states[0].approach,
                hertz.approach(first.load),
                0.05,
                &what,
            );
        }
    }
}

/// Elastic contact of a ball at the load of first yield, with 3 and 6 elements (thorough: 4 and 8)
/// over the smaller half axis: pressures converge with the square of the element. (16 take minutes:
/// README, "What was verified".)
#[test]
fn the_elastic_solution_converges_to_that_of_hertz() {
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    let (name, upper, lower) = ("ball_on_flat_3d", [10.0, 10.0], [0.0, 0.0]);
    let radii = HertzEllipse::relative_radii(upper, lower).unwrap();
    let hertz = HertzEllipse::new(radii, modulus).unwrap();
    let load = hertz.yield_load(0.3, 500.0);
    let exact = hertz.max_pressure(load);
    let axes = hertz.semi_axes(load);
    let state = |n: usize| {
        let overrides = [
            format!("mesh.curved_bodies.resolution={n}"),
            format!("mesh.curved_bodies.semi_axes={axes:?}"),
            format!("load.press.plane_force.total={}", -load),
            "bodies.upper.plastic=false".to_string(),
            "bodies.lower.plastic=false".to_string(),
            "program.unit=load".to_string(),
            "program.targets=[{ load_factor = 1.0 }]".to_string(),
            "reference=[]".to_string(),
        ];
        let overrides: Vec<&str> = overrides.iter().map(String::as_str).collect();
        run_file(name, &overrides).states.remove(0)
    };
    let sizes = either([3, 6], [4, 8]);
    let states = sizes.map(state);
    let off = |of: fn(&State) -> f64| states.each_ref().map(|s| (of(s) / exact - 1.0).abs());
    for (what, [coarse, fine]) in [
        ("pole pressure", off(|s| s.pole_pressure)),
        ("largest pressure", off(|s| s.max_pressure)),
    ] {
        let order = (coarse / fine).log2();
        let [most, least] = sizes.map(|n| 0.3 / (n * n) as f64);
        assert!(
            coarse < most && fine < least,
            "{name} {what}: {coarse} {fine}, order {order}"
        );
    }
    let mut axes = axes;
    axes.sort_by(|a, b| b.total_cmp(a));
    for (state, n) in states.iter().zip(sizes.map(|n| n as f64)) {
        for (a, exact) in state.patches[0].semi_axes.iter().zip(axes) {
            near(*a, exact, 0.2 / n, name);
        }
        // The bodies end at 30 half axes, and the mesh.
        near(
            state.approach,
            hertz.approach(load),
            0.02 + 0.3 / (n * n),
            name,
        );
    }
}

/// What the whole shows of itself in a half and a quarter model is the same, plastic history and
/// unloading included.
#[test]
fn a_quarter_and_a_half_are_those_of_the_whole() {
    let run_as = |model: &str, symmetry: usize, supports: &str| {
        let overrides = [
            "mesh.curved_bodies.resolution=2",
            "mesh.curved_bodies.contact_width=2.0",
            "mesh.curved_bodies.far_size=12",
            &format!("mesh.curved_bodies.model={model}"),
            &format!("symmetry={symmetry}"),
            &format!("support={supports}"),
            "program.targets=[{ load_factor = 2.0 }, { load_factor = 0.0 }]",
            // The zones differ; displacements follow forces with a hundredfold error.
            "analysis.tolerance=1e-12",
        ];
        run_file("crossed_cylinders", &overrides)
    };
    let bottom = r#"{ on = "lower.bottom", fix = ["z"] }"#;
    let across = |axis: &str| {
        let of = |body| format!(r#"{{ on = "{body}.symmetry_{axis}", fix = ["{axis}"] }}"#);
        ["upper", "lower"].map(of).join(", ")
    };
    let (x, y) = (across("x"), across("y"));
    let quarter = run_as("quarter", 4, &format!("[{bottom}, {x}, {y}]"));
    let half = run_as("half", 2, &format!("[{bottom}, {x}]"));
    let whole = run_as("full", 1, &format!("[{bottom}]"));
    for other in [&half, &whole] {
        let firsts = [&quarter, other].map(|results| results.first_yield.unwrap());
        near(firsts[1].load, firsts[0].load, 1e-9, "first yield");
        for (a, b) in quarter.states.iter().zip(&other.states) {
            same_figures(a, b, 1.0, &quarter.states[0], 1e-9);
            for (p, q) in a.patches.iter().zip(&b.patches) {
                near(q.area, p.area, 1e-7, "area");
                near(q.semi_axes[0], p.semi_axes[0], 1e-7, "larger half axis");
            }
        }
    }
}

/// The history of a ball on a flat in space is that of the axisymmetric model: both converge, the
/// difference is of the order of the coarser mesh.
#[test]
fn the_history_of_a_ball_is_that_of_the_axisymmetric_model() {
    let fine = run_file("ball_on_half_space", &[]);
    let resolution = 4;
    let solid = run_file(
        "ball_on_flat_3d",
        &[&format!("mesh.curved_bodies.resolution={resolution}")],
    );
    let h = 1.0 / resolution as f64;
    // Load factors count from each model's own first yield.
    for (a, b) in fine.states.iter().zip(&solid.states).skip(1).take(3) {
        near(b.load, a.load, 0.3 * h * h, &a.name);
        near(b.max_pressure, a.max_pressure, 0.3 * h * h, &a.name);
        near(b.approach, a.approach, 0.03, &a.name);
        near(b.residual_depth, a.residual_depth, 3.0 * h * h, &a.name);
    }
    let [a, b] = [&fine, &solid].map(|results| results.states.last().unwrap());
    near(b.residual_depth, a.residual_depth, h * h, "dent");
    near(
        b.max_equivalent_plastic_strain,
        a.max_equivalent_plastic_strain,
        h * h,
        "plastic strain",
    );
}

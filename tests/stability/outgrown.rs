//! Contact that outgrows its candidates: generated meshes reach far enough, and where surfaces end
//! although the bodies go on, the run says so instead of giving results.

use crate::support::{close, load, parse, run, run_file, state, try_run};
use brinell::ErrorKind;
use brinell::analysis::Analysis;
use brinell::analytical::{HertzLine, contact_modulus};
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::results::Status;
use brinell::scene::Scene;

/// The last pair of every contact stays open: nothing of the contact is cut off.
fn within_candidates(scene: &Scene) -> brinell::results::Results {
    let results = run(scene);
    let model = Model::new(scene).unwrap();
    for state in &results.states {
        for end in model.contacts.iter().flat_map(|c| &c.goes_on) {
            assert_eq!(state.pairs[*end].status, Status::Open, "{}", state.name);
        }
    }
    results
}

/// Fifty times the load of first yield. Uniform meshes of 58 and 86 candidates, fine as at first
/// yield all over the contact (`fine_width = 7.07`, `fine_depth = 5.3`, resolution 8 and 12), give
/// a radius of 0.534, 1228.6 MPa and a dent of 0.00952; the radius is read to a fifth of an
/// element, 0.062 wide there. Pressure and dent are of second order: with 8, 12, 16 and 24 elements
/// they are 1.6, 0.7, 0.5 and 0.2 % off; twice that is allowed.
#[test]
fn a_ball_at_fifty_times_first_yield_is_right() {
    let scene = load(
        "ball_on_half_space",
        &[
            "mesh.cylinder_on_half_plane.resolution=8",
            "program.targets=[{yield=true},{name=\"pressed\",load_factor=50.0},\
             {name=\"unloaded\",load_factor=0.0}]",
        ],
    );
    let results = within_candidates(&scene);
    let pressed = state(&results, "pressed");
    close("radius", pressed.half_width, 0.534, 0.062, 0.2);
    let second_order = 2.0 / 64.0;
    close(
        "pressure",
        pressed.max_pressure,
        1228.6,
        1228.6,
        second_order,
    );
    let dent = state(&results, "unloaded").residual_depth;
    close("dent", dent, 0.00952, 0.00952, second_order);
}

/// The elastic line contact at ten times the load of first yield: its half width is Hertz's one.
#[test]
fn an_elastic_contact_at_ten_times_first_yield_is_that_of_hertz() {
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    let hertz = HertzLine::new(10.0, modulus).unwrap();
    let p = 10.0 * hertz.yield_load(0.3, 500.0);
    let scene = load(
        "cylinder_on_half_plane",
        &[
            "reference=[]",
            "program.unit=load",
            "program.targets=[{name=\"pressed\",load_factor=1.0}]",
            &format!("load.0.plane_force.total={:?}", -p),
            &format!(
                "mesh.cylinder_on_half_plane.half_width={:?}",
                hertz.yield_half_width(0.3, 500.0)
            ),
            "bodies.cylinder.plastic=false",
            "bodies.half_plane.plastic=false",
        ],
    );
    let results = within_candidates(&scene);
    let pressed = state(&results, "pressed");
    // The bodies are circles where Hertz has parabolas: (b/R)^2 / 8. The edge is read to an eighth
    // of an element, of 16.
    let b = hertz.half_width(p);
    let form = (b / 10.0).powi(2) / 8.0;
    close("half width", pressed.half_width, b, b, form + 1.0 / 128.0);
}

/// A strip that the user makes too short ends the run where contact reaches its end, with what was
/// computed before.
#[test]
fn a_strip_that_is_too_short_ends_the_run_at_its_end() {
    let scene = load(
        "ball_on_half_space",
        &[
            "mesh.cylinder_on_half_plane.contact_width=2.0",
            "program.stepping=events",
            "program.targets=[{yield=true},{load_factor=50.0},{load_factor=0.0}]",
        ],
    );
    let model = Model::new(&scene).unwrap();
    let &[end] = &model.contacts[0].goes_on[..] else {
        panic!("one end: {:?}", model.contacts[0]);
    };
    let results = Analysis::new(model, Backend::default())
        .and_then(|mut a| a.run(&mut Silent))
        .unwrap();
    assert_eq!(results.ending().kind(), Some(ErrorKind::Outgrown));
    assert_eq!(results.states.len(), 1, "the state at first yield is right");
    // The last increment is the one in which the last pair closes.
    let last = results.history.last().unwrap();
    assert_eq!(last.event, format!("closes: pair {}", end + 1));
    let message = results.incomplete.unwrap().why;
    for part in [
        "`cylinder.contact` on `half_plane.contact`",
        &format!("load factor {:.6}", last.alpha),
        "contact_width",
        &format!("{:.2} times as far", (50.0 / last.alpha).sqrt()),
    ] {
        assert!(message.contains(part), "{part}: {message}");
    }
}

/// With fixed steps the increment in which contact went over the end is not a result either.
#[test]
fn fixed_steps_do_not_step_over_the_end() {
    let scene = load(
        "ball_on_half_space",
        &[
            "mesh.cylinder_on_half_plane.resolution=6",
            "mesh.cylinder_on_half_plane.contact_width=2.0",
            "program.stepping=steps",
            "program.steps=4",
            "program.targets=[{yield=true},{load_factor=50.0}]",
        ],
    );
    let error = try_run(&scene, Backend::default()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Outgrown, "{error}");
}

/// Two blocks; the candidates are `piece` of the upper one's bottom, which goes on, on the whole
/// lower top.
fn blocks(width: f64, piece: f64) -> Scene {
    parse(&format!(
        "kind = \"plane_strain\"
        [[mesh.parts]]
        body = \"upper\"
        [mesh.parts.block]
        x = [0.0, {width:?}]
        y = [0.0, 1.0]
        elements = [{n}, 4]
        pieces = [{{ name = \"piece\", side = \"bottom\", from = 0.0, to = {piece:?} }}]
        [[mesh.parts]]
        body = \"lower\"
        block = {{ x = [0.0, 2.0], y = [-1.0, 0.0], elements = [8, 4] }}
        [materials.m]
        youngs_modulus = 1000.0
        poissons_ratio = 0.3
        [bodies]
        upper = {{ material = \"m\" }}
        lower = {{ material = \"m\" }}
        [[contact]]
        first = \"upper.piece\"
        second = \"lower.top\"
        [[support]]
        on = \"upper.left\"
        fix = [\"x\"]
        [[support]]
        on = \"lower.left\"
        fix = [\"x\"]
        [[support]]
        on = \"lower.bottom\"
        fix = [\"y\"]
        [[load]]
        on = \"upper.top\"
        pressure = 1.0
        [program]
        targets = [{{ load_factor = 1.0 }}]",
        n = (4.0 * width) as usize
    ))
}

#[test]
fn a_corner_of_either_body_is_no_end_and_the_middle_of_a_side_is() {
    // The whole side of a narrow block on a wide one, and of two that are equally wide: corners.
    for width in [1.0, 2.0] {
        let scene = blocks(width, width);
        assert!(Model::new(&scene).unwrap().contacts[0].goes_on.is_empty());
        run(&scene);
    }
    // Half of a side, in contact from the start: no load factor is right.
    let scene = blocks(2.0, 1.0);
    assert_eq!(Model::new(&scene).unwrap().contacts[0].goes_on.len(), 1);
    let error = try_run(&scene, Backend::default()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Outgrown);
    assert!(error.message().contains("load factor 0.000000"), "{error}");
    assert!(
        error.message().contains("make the surfaces longer"),
        "{error}"
    );
}

/// Scenes whose contact reaches a corner, a symmetry plane or the axis have no end that goes on.
#[test]
fn contact_up_to_real_ends_stays_silent() {
    for name in [
        "contact_patch",
        "disc_in_plate",
        "gmsh_blocks",
        "shrink_fit",
        "three_bodies",
    ] {
        let model = Model::new(&load(name, &[])).unwrap();
        for contact in &model.contacts {
            assert!(contact.goes_on.is_empty(), "{name}: {contact:?}");
        }
    }
    run_file("contact_patch", &[]);
}

/// Before a run: what the contact needs and what its candidates have, where these are too short.
#[test]
fn a_check_warns_of_candidates_that_end_too_soon_and_of_long_runs() {
    let of = |changes: &[&str]| {
        let scene = load("ball_on_half_space", changes);
        brinell::analysis::check(&Model::new(&scene).unwrap(), Backend::default()).unwrap()
    };
    assert!(of(&[]).notes.is_empty());
    let heavy = "program.targets=[{load_factor=50.0}]";
    assert!(of(&[heavy]).notes.is_empty());
    let short = of(&[heavy, "mesh.cylinder_on_half_plane.contact_width=3.0"]);
    // It reaches 0.534, 4.86 times as far as at first yield; sqrt(50) is a bound.
    let [note] = &short.notes[..] else {
        panic!("{:?}", short.notes)
    };
    let given = note
        .split("contact_width = ")
        .nth(1)
        .and_then(|rest| rest.split(',').next());
    let width = given.and_then(|width| width.parse::<f64>().ok()).unwrap();
    assert!((4.86..1.33 * 4.86).contains(&width), "{note}");
    // A ball pressed in beyond 0.9 of its radius.
    let deep = of(&["program.targets=[{load_factor=20000.0}]"]);
    assert!(
        deep.notes.iter().any(|n| n.contains("0.9 of the radius")),
        "{:?}",
        deep.notes
    );
    let fine = of(&[heavy, "mesh.cylinder_on_half_plane.resolution=64"]);
    assert!(fine.predicted_run_seconds > 10.0 * short.predicted_run_seconds);
    let long = of(&[heavy, "program.stepping=\"steps\"", "program.steps=1000000"]);
    assert!(
        long.notes.iter().any(|n| n.contains(" min")),
        "{:?}",
        long.notes
    );
}

/// Two contacts on one pair of sides with a hole of one element between them: what closes there
/// ends the run, it is not taken for a surface that goes on.
#[test]
fn a_hole_between_two_contacts_is_an_end() {
    let mut scene = blocks(2.0, 2.0);
    let pieces = |side: &str| {
        let piece = |name: &str, from: f64, to: f64| brinell::scene::Piece {
            name: name.into(),
            side: side.into(),
            from,
            to,
        };
        vec![piece("a", 0.0, 1.0), piece("b", 1.25, 2.0)]
    };
    let parts = scene.mesh.parts.as_mut().unwrap();
    for (part, side) in parts.iter_mut().zip(["bottom", "top"]) {
        part.block.as_mut().unwrap().pieces = pieces(side);
    }
    let contact = scene.contact.remove(0);
    for piece in ["a", "b"] {
        let mut of_piece = contact.clone();
        of_piece.first = format!("upper.{piece}");
        of_piece.second = format!("lower.{piece}");
        scene.contact.push(of_piece);
    }
    let error = try_run(&scene, Backend::default()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Outgrown, "{error}");
}

/// Area is where surfaces face each other: a punch has the same pressures whichever of the two
/// surfaces is named first.
#[test]
fn pressure_does_not_depend_on_which_surface_is_first() {
    let one = blocks(1.0, 1.0);
    let mut other = one.clone();
    for contact in &mut other.contact {
        std::mem::swap(&mut contact.first, &mut contact.second);
    }
    let (one, other) = (run(&one), run(&other));
    let pressure = one.states[0].max_pressure;
    close(
        "pressure",
        other.states[0].max_pressure,
        pressure,
        pressure,
        1e-12,
    );
}

/// How wide the contact may reach, as the warning of a strip that is too short has it, is no less
/// than it reaches, and no more than a third wider: a ball at 20 to 200 times the load of first
/// yield, whose mean pressure goes from 1.6 to 3 times the yield stress (with 1.1, that of first
/// yield, it would be up to 1.6 times wider).
#[test]
fn a_warning_says_how_wide_a_plastic_contact_becomes() {
    for (factor, yield_stress) in [(20.0, 500.0), (200.0, 500.0), (100.0, 2000.0)] {
        let targets = format!("program.targets=[{{load_factor={factor:?}}}]");
        let stress = format!("materials.steel.yield_stress={yield_stress:?}");
        let narrow = "mesh.cylinder_on_half_plane.contact_width=2.0";
        let scene = |more: &[&str]| {
            let all = [
                "mesh.cylinder_on_half_plane.resolution=6",
                "materials.steel.tangent_modulus=",
                &targets,
                &stress,
            ];
            load("ball_on_half_space", &[&all[..], more].concat())
        };
        let reached = within_candidates(&scene(&[])).states[0].half_width;
        let warnings = Model::new(&scene(&[narrow])).unwrap().warnings;
        let words = "the half width of contact may reach ";
        let said = warnings
            .iter()
            .find_map(|warning| warning.split(words).nth(1));
        let said = said.and_then(|said| said.split(';').next()?.parse::<f64>().ok());
        let ratio = said.unwrap() / reached;
        assert!(
            (1.0..1.33).contains(&ratio),
            "{factor} {yield_stress}: {ratio}"
        );
    }
}

//! Round bodies that nothing but contact holds sideways, on unlike meshes.
//!
//! Where one pair alone carries the load, it stops no motion across its normal, and no load drives
//! one: other codes drift away by round-off, or ask for springs that carry a part of the load.

use crate::support::msh::{Body, Msh};
use crate::support::random::Random;
use crate::support::{either, run_text_as_far_as_it_goes};
use brinell::results::Results;
use std::path::Path;

const HALF: f64 = 5.0;

/// A round punch, its mesh unlike that of the block under it and without a plane of symmetry; held
/// sideways by nothing, or at its top.
struct Punch {
    text: String,
    /// Length of a cell of its round face.
    cell: f64,
    /// The load, where it is a force.
    force: Option<f64>,
    radius: f64,
    is_solid: bool,
    /// The way across the push.
    sideways: [f64; 2],
}

impl Punch {
    fn across(&self, [x, y, _]: [f64; 3]) -> f64 {
        self.sideways[0] * x + self.sideways[1] * y
    }
}

fn punch(seed: u64, held: bool, folder: &Path) -> Punch {
    let mut random = Random::new(seed);
    let random = &mut random;
    let kind = random.one_of(&["plane_strain", "plane_stress", "plane_strain", "solid"]);
    let is_solid = kind == "solid";
    let radius = random.one_of(&[20.0f64, 50.0, 200.0]);
    let order = 1 + random.below(2);
    // A quadratic face from the flat to the round would bulge.
    let flat = if order == 1 {
        random.one_of(&[0.0, 0.0, 0.8])
    } else {
        0.0
    };
    let jitter = random.one_of(&[0.0, 0.0, 0.3]);
    let round = |x: f64| {
        let x = (x.abs() - flat).max(0.0);
        radius - (radius * radius - x * x).sqrt()
    };
    let mut cells = |most: usize| match is_solid {
        true => [4 + random.below(4), 2],
        false => [most - random.below(8), 4],
    };
    let [top, under, level] = [|_: f64| 8.0, |_: f64| -8.0, |_: f64| 0.0];
    let bodies = [
        Body {
            name: "block",
            from: -2.0 * HALF,
            width: 4.0 * HALF,
            cells: cells(31),
            heights: [&under, &level],
            kink: None,
            grading: 1.0,
            jitter,
        },
        Body {
            name: "punch",
            from: -HALF,
            width: 2.0 * HALF,
            cells: cells(19),
            heights: [&round, &top],
            kink: None,
            grading: 1.0,
            jitter,
        },
    ];
    let triangles = random.share() < 0.5;
    let mut msh = Msh::default();
    for body in &bodies {
        match is_solid {
            true => body.solid(&mut msh, triangles, order, random),
            false => body.plane(&mut msh, triangles, order, random),
        }
    }
    let turn = match is_solid {
        true => 0.0,
        false => random.one_of(&[0.0f64, 0.0, 90.0, 180.0]).to_radians(),
    };
    let (sin, cos) = turn.sin_cos();
    msh.map(|[x, y, z]| match is_solid {
        true => [x, y, z],
        false => [cos * x - sin * y, sin * x + cos * y, z],
    });
    let file = folder.join(format!("{seed}.msh"));
    std::fs::write(&file, msh.text()).unwrap();
    // A body that is turned can be moved along its axes by forces alone.
    let by_force = turn != 0.0 || random.share() < 0.5;
    let pressure = random.one_of(&[20.0, 100.0, 300.0]);
    let up = if is_solid { "z" } else { "y" };
    let load = match (by_force, is_solid) {
        (true, true) => format!("traction = [0.0, 0.0, {}]", -pressure),
        (true, false) => format!("traction = [{}, {}]", pressure * sin, -pressure * cos),
        (false, _) => format!("displacement = {{ {up} = -0.03 }}"),
    };
    let plastic = match random.share() < 0.4 {
        true => ", yield_stress = 400.0, plastic_modulus = 3000.0",
        false => "",
    };
    let slave = random.one_of(&["auto", "first", "second"]);
    let sideways = match is_solid {
        true => "\"x\", \"y\"",
        false if sin.abs() > 0.9 => "\"y\"",
        false => "\"x\"",
    };
    let fixed = if is_solid {
        "\"x\", \"y\", \"z\""
    } else {
        "\"x\", \"y\""
    };
    let support = match held {
        true => format!("{{ on = \"punch top\", fix = [{sideways}] }}"),
        false => String::new(),
    };
    let text = format!(
        "kind = \"{kind}\"
mesh.file = {file:?}
contact = [{{ first = \"punch bottom\", second = \"block top\", slave = \"{slave}\" }}]
materials.e = {{ youngs_modulus = 210e3, poissons_ratio = 0.3{plastic} }}
bodies = {{ block.material = \"e\", punch.material = \"e\" }}
support = [{{ on = \"block bottom\", fix = [{fixed}] }}, {support}]
load = [{{ on = \"punch top\", {load} }}]
program.targets = [{{ load_factor = 1.0 }}, {{ load_factor = 0.0 }}]
"
    );
    let cell = 2.0 * HALF / bodies[1].cells[0] as f64;
    let area = 2.0 * HALF * if is_solid { 2.0 * HALF } else { 1.0 };
    Punch {
        text,
        cell,
        force: by_force.then_some(area * pressure),
        radius,
        is_solid,
        sideways: [cos, sin],
    }
}

/// It touches where it stands: no pair of the other half of the block carries force, what it
/// carries is the load, and where it is held besides, the pressure is the same but for what the
/// sides of elements make of it. Whatever the order of the surfaces, whichever way it looks.
#[test]
fn a_round_punch_stays_where_it_is() {
    let folder = tempfile::tempdir().unwrap();
    for seed in 1..=either(20, 400) {
        let [loose, held] = [false, true].map(|held| {
            let punch = punch(seed, held, folder.path());
            let results = run_text_as_far_as_it_goes(&punch.text);
            let ending = results.ending();
            assert!(ending.kind().is_none(), "{ending:?}\n{}", punch.text);
            (punch, results)
        });
        let [pressed, off] = [0, 1].map(|i| &loose.1.states[i]);
        let twin = &held.1.states[0];
        let text = &loose.0.text;
        if let Some(force) = loose.0.force {
            // A normal at the distance x of the middle turns from the push by asin(x/R), at most at
            // the last pair that carries force.
            let carrying = pressed.pairs.iter().filter(|pair| pair.force > 0.0);
            let off = |[x, y, _]: [f64; 3]| match loose.0.is_solid {
                true => x.hypot(y),
                false => loose.0.across([x, y, 0.0]).abs(),
            };
            let far = carrying.map(|pair| off(pair.position)).fold(0.0, f64::max);
            let most = 1.0 / (1.0 - (far / loose.0.radius).powi(2)).sqrt() - 1.0;
            let share = pressed.contact_force / force - 1.0;
            assert!(
                (-1e-9..most + 1e-9).contains(&share),
                "{share} {most}\n{text}"
            );
        }
        assert!(
            off.contact_force.abs() <= 1e-9 * pressed.contact_force,
            "{text}"
        );
        let off_by = |a: f64, b: f64| (a / b - 1.0).abs();
        let pressure = off_by(pressed.max_pressure, twin.max_pressure);
        assert!(pressure < 0.05, "{pressure}\n{text}");
        // The middle of what carries force.
        let middle = |results: &Results| {
            let pairs = results.states[0].pairs.iter();
            let moment: f64 = pairs
                .clone()
                .map(|p| p.force * loose.0.across(p.position))
                .sum();
            moment / pairs.map(|p| p.force).sum::<f64>()
        };
        let middle = middle(&loose.1);
        assert!(middle.abs() < loose.0.cell, "{middle}\n{text}");
    }
}

/// Pressed down first, where nothing drives it sideways, then pushed gently to a wall that is four
/// orders of its deformation away: the wall takes the push, not what kept the block before.
#[test]
fn a_block_is_pushed_to_a_wall_far_away() {
    let text = r#"
kind = "plane_strain"
mesh.parts = [
    { body = "plate", element = "quad4", block = { x = [-3, 6], y = [-2, 0], elements = [9, 2] } },
    { body = "block", element = "quad4", block = { x = [0, 2], y = [0, 2], elements = [5, 5] } },
    { body = "wall", element = "quad4", block = { x = [4, 5], y = [0.4, 3], elements = [2, 4] } },
]
materials.s = { youngs_modulus = 210e3, poissons_ratio = 0.3 }
bodies = { plate.material = "s", block.material = "s", wall.material = "s" }
contact = [
    { first = "block.bottom", second = "plate.top" },
    { first = "block.right", second = "wall.left" },
]
support = [
    { on = "plate.bottom", fix = ["x", "y"] }, { on = "wall.right", fix = ["x", "y"] },
]
load = [
    { name = "down", on = "block.top", pressure = 20.0, history = "constant" },
    { name = "aside", on = "block.left", pressure = PUSH },
]
program.targets = [{ load_factor = 1.0 }]
"#;
    for push in [1.0, 1e-2, 1e-4] {
        let results = run_text_as_far_as_it_goes(&text.replace("PUSH", &format!("{push:?}")));
        let ending = results.ending();
        assert!(ending.kind().is_none(), "{push}: {ending:?}");
        let pairs = results.states[0].pairs.iter();
        let of_wall = pairs
            .filter(|pair| pair.contact == 1)
            .map(|pair| pair.force);
        let force: f64 = of_wall.sum();
        assert!((force / (2.0 * push) - 1.0).abs() < 1e-9, "{push}: {force}");
    }
}

/// A whole roller on a block, meshed by Gmsh and refined where they touch, that flows and is
/// unloaded: at a force of a billionth of the largest, round-off decides the statuses of the last
/// pairs, which changed without end.
#[test]
fn a_whole_roller_is_unloaded_to_the_end() {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/stability/whole_roller.msh"
    );
    let results = run_text_as_far_as_it_goes(&format!(
        r#"
title = "whole roller"
kind = "plane_strain"
mesh.file = {file:?}
mesh.refine = [{{ at = [0.00195, 0.0326], radius = 0.037, times = 7 }}]
mesh.circles = [{{ on = "ball.outer", center = [0.0, 5.0], radius = 5.0 }}]
[materials.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
yield_stress = 300.0
tangent_modulus = 5000.0
[bodies]
ball.material = "steel"
block.material = "steel"
[[contact]]
first = "ball.outer"
second = "block.top"
[[load]]
on = "ball.outer"
force = [0.0, -1.0]
[[support]]
on = "block.bottom"
fix = ["x", "y"]
[program]
unit = "yield"
targets = [{{ yield = true }}, {{ load_factor = 3.0 }}, {{ load_factor = 0.0 }}]
"#
    ));
    assert!(results.incomplete.is_none(), "{:?}", results.incomplete);
    let [_, pressed, off] = &results.states[..] else {
        panic!("{} states", results.states.len());
    };
    assert!(pressed.plastic_points > 100 && off.residual_depth > 0.0);
    let left = off.contact_force / pressed.contact_force;
    assert!(left < 1e-6, "{left:e}");
}

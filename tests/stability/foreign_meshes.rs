//! Contacts of two bodies on meshes as a mesher makes them: unlike, graded, jittered, of all
//! shapes, in every kind of model, from elastic to far beyond yield.
//!
//! Codes that follow yielding and contact at once give up where the one upsets the other: a load
//! under which all points balance, and a pair that closes meanwhile. Passing means that the default
//! settings come to the end of the program, or to a limit load that fixed increments find, too.

use crate::support::random::Random;
use crate::support::{either, parse};
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::results::Results;
use brinell::{ErrorKind, Result};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// A mesh in the words of Gmsh's format 2.2.
#[derive(Default)]
struct Msh {
    nodes: Vec<[f64; 3]>,
    /// Type, group, nodes.
    elements: Vec<(u32, usize, Vec<usize>)>,
    /// Dimension and name; the place is the number less 1.
    groups: Vec<(u32, String)>,
}

impl Msh {
    fn group(&mut self, dimension: u32, name: String) -> usize {
        self.groups.push((dimension, name));
        self.groups.len()
    }

    fn node(&mut self, x: [f64; 3]) -> usize {
        self.nodes.push(x);
        self.nodes.len()
    }

    fn text(&self) -> String {
        let mut out = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
        let _ = writeln!(out, "$PhysicalNames\n{}", self.groups.len());
        for (k, (dimension, name)) in self.groups.iter().enumerate() {
            let _ = writeln!(out, "{dimension} {} \"{name}\"", k + 1);
        }
        let _ = writeln!(out, "$EndPhysicalNames\n$Nodes\n{}", self.nodes.len());
        for (k, [x, y, z]) in self.nodes.iter().enumerate() {
            let _ = writeln!(out, "{} {x} {y} {z}", k + 1);
        }
        let _ = writeln!(out, "$EndNodes\n$Elements\n{}", self.elements.len());
        for (k, (of_type, group, nodes)) in self.elements.iter().enumerate() {
            let nodes: Vec<String> = nodes.iter().map(usize::to_string).collect();
            let nodes = nodes.join(" ");
            let _ = writeln!(out, "{} {of_type} 2 {group} {group} {nodes}", k + 1);
        }
        out + "$EndElements\n"
    }
}

/// A body over `[0, width]` (times `[0, width]`) between two heights, and how it is meshed.
struct Body<'a> {
    name: &'static str,
    width: f64,
    /// Cells along and up.
    cells: [usize; 2],
    heights: [&'a dyn Fn(f64) -> f64; 2],
    /// Where a height has a kink.
    kink: Option<f64>,
    /// Grading towards the axis.
    grading: f64,
    jitter: f64,
}

impl Body<'_> {
    /// Places along an axis, each moved by a share of its cells.
    fn places(&self, n: usize, grading: f64, kink: Option<f64>, random: &mut Random) -> Vec<f64> {
        let mut even: Vec<f64> = (0..=n)
            .map(|i| (i as f64 / n as f64).powf(grading))
            .collect();
        let still = kink.map(|kink| {
            let off = |i: &usize| (even[*i] - kink).abs();
            let nearest = (1..n).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
            even[nearest] = kink;
            nearest
        });
        let moved = |i: usize| {
            if i == 0 || i == n || still == Some(i) {
                return even[i];
            }
            let cell = (even[i + 1] - even[i]).min(even[i] - even[i - 1]);
            even[i] + self.jitter * cell * random.within(-0.5, 0.5)
        };
        (0..=n).map(moved).collect()
    }

    fn height(&self, x: f64, share: f64) -> f64 {
        (1.0 - share) * self.heights[0](x) + share * self.heights[1](x)
    }

    /// Adds the body as triangles or quadrangles of order 1 or 2, its faces and its axis.
    fn plane(&self, msh: &mut Msh, triangles: bool, order: usize, random: &mut Random) {
        let [m, n] = self.cells;
        let along = self.places(m, self.grading, self.kink.map(|k| k / self.width), random);
        let up = self.places(n, 1.0, None, random);
        let mut at = BTreeMap::new();
        // Halves of cells: nodes in the middle of edges stand between.
        let mut node = |msh: &mut Msh, [i, j]: [usize; 2]| {
            *at.entry([i, j]).or_insert_with(|| {
                let mid = |of: &[f64], k: usize| 0.5 * (of[k / 2] + of[k.div_ceil(2)]);
                let x = self.width * mid(&along, i);
                let ends = [i / 2, i.div_ceil(2)].map(|k| self.width * along[k]);
                let share = mid(&up, j);
                // Edges inside are straight, those of the faces follow them.
                let y = match j == 0 || j == 2 * n {
                    true => self.height(x, share),
                    false => 0.5 * (self.height(ends[0], share) + self.height(ends[1], share)),
                };
                msh.node([x, y, 0.0])
            })
        };
        let mut add = |msh: &mut Msh, group: usize, corners: &[[usize; 2]]| {
            let k = corners.len();
            let mut nodes: Vec<usize> = corners.iter().map(|&c| node(msh, c)).collect();
            if order == 2 {
                let edges = if k == 2 { 1 } else { k };
                for e in 0..edges {
                    let [a, b] = [corners[e], corners[(e + 1) % k]];
                    nodes.push(node(msh, [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]));
                }
            }
            let of_type = match (k, order) {
                (2, 1) => 1,
                (2, _) => 8,
                (3, 1) => 2,
                (3, _) => 9,
                (_, 1) => 3,
                _ => 16,
            };
            msh.elements.push((of_type, group, nodes));
        };
        let group = msh.group(2, self.name.to_string());
        for i in (0..2 * m).step_by(2) {
            for j in (0..2 * n).step_by(2) {
                let [a, b, c, d] = [[i, j], [i + 2, j], [i + 2, j + 2], [i, j + 2]];
                match (triangles, random.share() < 0.5) {
                    (false, _) => add(msh, group, &[a, b, c, d]),
                    (true, true) => [[a, b, c], [a, c, d]]
                        .iter()
                        .for_each(|corners| add(msh, group, corners)),
                    (true, false) => [[a, b, d], [b, c, d]]
                        .iter()
                        .for_each(|corners| add(msh, group, corners)),
                }
            }
        }
        for (side, j) in [("bottom", 0), ("top", 2 * n)] {
            let group = msh.group(1, format!("{} {side}", self.name));
            for i in (0..2 * m).step_by(2) {
                add(msh, group, &[[i, j], [i + 2, j]]);
            }
        }
        let group = msh.group(1, format!("{} axis", self.name));
        for j in (0..2 * n).step_by(2) {
            add(msh, group, &[[0, j], [0, j + 2]]);
        }
    }

    /// Adds the body as hexahedra of order 1 or 2, its faces and its planes of symmetry.
    fn solid(&self, msh: &mut Msh, order: usize, random: &mut Random) {
        let [m, n] = self.cells;
        let [x, y] = [0, 1].map(|_| self.places(m, self.grading, None, random));
        let up = self.places(n, 1.0, None, random);
        // Halves of cells: nodes in the middle of edges stand between.
        let corner = |[i, j, k]: [usize; 3]| {
            let (x, y) = (self.width * x[i / 2], self.width * y[j / 2]);
            [x, y, self.height(x.hypot(y), up[k / 2])]
        };
        let place = |at: [usize; 3]| {
            let ends = [at.map(|i| i / 2 * 2), at.map(|i| i.div_ceil(2) * 2)].map(corner);
            let [x, y, z] = std::array::from_fn(|d| 0.5 * (ends[0][d] + ends[1][d]));
            // Edges inside are straight, those of the faces follow them.
            match at[2] == 0 || at[2] == 2 * n {
                true => [x, y, self.height(x.hypot(y), up[at[2] / 2])],
                false => [x, y, z],
            }
        };
        let mut numbers = BTreeMap::new();
        let mut add = |msh: &mut Msh, group: usize, corners: &[[usize; 3]]| {
            // Of a face in turn, of a hexahedron in the order of their ends, as Gmsh has them.
            let pairs = |n: usize| (0..n).flat_map(move |b| (b + 1..n).map(move |a| [b, a]));
            let is_edge = |&[a, b]: &[usize; 2]| {
                (0..3).filter(|&d| corners[a][d] != corners[b][d]).count() == 1
            };
            let edges: Vec<[usize; 2]> = match (corners.len(), order) {
                (_, 1) => Vec::new(),
                (4, _) => (0..4).map(|k| [k, (k + 1) % 4]).collect(),
                (n, _) => pairs(n).filter(is_edge).collect(),
            };
            let middle = |[a, b]: &[usize; 2]| -> [usize; 3] {
                std::array::from_fn(|d| (corners[*a][d] + corners[*b][d]) / 2)
            };
            let all = corners.iter().copied().chain(edges.iter().map(middle));
            let nodes = all.map(|at| *numbers.entry(at).or_insert_with(|| msh.node(place(at))));
            let nodes = nodes.collect();
            let of_type = match (corners.len(), order) {
                (4, 1) => 3,
                (4, _) => 16,
                (_, 1) => 5,
                _ => 17,
            };
            msh.elements.push((of_type, group, nodes));
        };
        // The four corners of a face across an axis.
        let face = |axis: usize, at: [usize; 3]| {
            let [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
            [[0, 0], [2, 0], [2, 2], [0, 2]].map(|[on_b, on_c]| {
                let mut corner = at;
                corner[b] += on_b;
                corner[c] += on_c;
                corner
            })
        };
        let evens = |n: usize| (0..2 * n).step_by(2);
        let group = msh.group(3, self.name.to_string());
        for k in evens(n) {
            for j in evens(m) {
                for i in evens(m) {
                    let both = [k, k + 2].map(|k| face(2, [i, j, k]));
                    add(msh, group, both.as_flattened());
                }
            }
        }
        for (side, k) in [("bottom", 0), ("top", 2 * n)] {
            let group = msh.group(2, format!("{} {side}", self.name));
            for (i, j) in evens(m).flat_map(|i| evens(m).map(move |j| (i, j))) {
                add(msh, group, &face(2, [i, j, k]));
            }
        }
        for axis in 0..2 {
            let group = msh.group(2, format!("{} axis {axis}", self.name));
            for (a, k) in evens(m).flat_map(|a| evens(n).map(move |k| (a, k))) {
                let mut at = [a, a, k];
                at[axis] = 0;
                add(msh, group, &face(axis, at));
            }
        }
    }
}

const YIELD: [f64; 2] = [200.0, 800.0];

/// A body pressed onto a plate: the scene, its mesh in `folder`.
fn model(seed: u64, folder: &Path) -> String {
    let mut random = Random::new(seed);
    let random = &mut random;
    let kind = random.one_of(&[
        "plane_strain",
        "plane_stress",
        "axisymmetric",
        "plane_strain",
        "axisymmetric",
        "solid",
    ]);
    let radius = random.one_of(&[3.0f64, 5.0, 10.0, 20.0]);
    let shape = random.one_of(&["round", "round", "punch", "flat"]);
    let base = random.one_of(&[1.0, 1.5, 3.0]);
    let grading = random.one_of(&[1.0, 1.0, 1.5, 2.0]);
    let jitter = random.one_of(&[0.0, 0.3, 0.6]);
    const FLAT: f64 = 0.3;
    let round = |x: f64| radius - (radius * radius - x * x).sqrt();
    let punch = |x: f64| 2.5 * (x - FLAT).max(0.0).powi(2) / radius;
    let flat = |_: f64| 0.0;
    let bottom: &dyn Fn(f64) -> f64 = match shape {
        "round" => &round,
        "punch" => &punch,
        _ => &flat,
    };
    let is_solid = kind == "solid";
    let mut cells = || match is_solid {
        true => [2 + random.below(3), 2 + random.below(2)],
        false => [3 + random.below(8), 2 + random.below(7)],
    };
    let [top, under] = [|_: f64| 2.0, |_: f64| -3.0];
    let bodies = [
        Body {
            name: "plate",
            width: base,
            cells: cells(),
            heights: [&under, &flat],
            kink: None,
            grading,
            jitter,
        },
        Body {
            name: "upper",
            width: 1.0,
            cells: cells(),
            heights: [bottom, &top],
            kink: (shape == "punch").then_some(FLAT),
            grading,
            jitter,
        },
    ];
    let triangles = random.share() < 0.5;
    let order = 1 + random.below(2);
    // Quadratic faces across the punch's edge, where no nodes lie in space, would bulge.
    let order = if is_solid && shape == "punch" {
        1
    } else {
        order
    };
    let mut msh = Msh::default();
    for body in &bodies {
        match is_solid {
            true => body.solid(&mut msh, order, random),
            false => body.plane(&mut msh, triangles, order, random),
        }
    }
    let file = folder.join(format!("{seed}.msh"));
    std::fs::write(&file, msh.text()).unwrap();

    let up = if is_solid { "z" } else { "y" };
    let yield_stress = random.one_of(&YIELD);
    let load = match random.share() < 0.35 {
        true => {
            let down = random.one_of(&[0.003, 0.01, 0.03]) * yield_stress / 400.0;
            format!("displacement = {{ {up} = {} }}", -down)
        }
        false => {
            let pressure = random.one_of(&[0.1, 0.3, 0.6, 1.0]) * yield_stress;
            let still = if is_solid { "0.0, 0.0" } else { "0.0" };
            format!("traction = [{still}, {}]", -pressure)
        }
    };
    let axes: &[(&str, &str)] = match is_solid {
        true => &[("axis 0", "x"), ("axis 1", "y")],
        false => &[("axis", "x")],
    };
    let held = ["plate", "upper"].map(|body| {
        let on_axes = axes
            .iter()
            .map(|(axis, fix)| format!("{{ on = \"{body} {axis}\", fix = [\"{fix}\"] }}"));
        on_axes.collect::<Vec<_>>().join(", ")
    });
    let which = random.one_of(&[["p", "p"], ["p", "p"], ["p", "e"], ["e", "p"]]);
    let surfaces = match random.share() < 0.7 {
        true => ["upper bottom", "plate top"],
        false => ["plate top", "upper bottom"],
    };
    format!(
        "kind = \"{kind}\"
mesh.file = {file:?}
contact = [{{ first = \"{}\", second = \"{}\" }}]
materials.e = {{ youngs_modulus = 210e3, poissons_ratio = 0.3 }}
materials.p = {{ youngs_modulus = 210e3, poissons_ratio = 0.3, yield_stress = {yield_stress},
                plastic_modulus = {} }}
bodies = {{ plate.material = \"{}\", upper.material = \"{}\" }}
support = [{{ on = \"plate bottom\", fix = [\"{up}\"] }}, {}, {}]
load = [{{ on = \"upper top\", {load} }}]
program.targets = [{{ yield = true }}, {{ load_factor = 1.0 }}, {{ load_factor = 0.0 }}]
",
        surfaces[0],
        surfaces[1],
        random.one_of(&[0.0, 210.0, 2100.0, 21000.0]),
        which[0],
        which[1],
        held[0],
        held[1],
    )
}

/// The load factor at which a run came to its limit load; `None` where it reached its end.
fn limit(results: &Results, what: &str) -> Option<f64> {
    let kind = results.ending().kind()?;
    assert_eq!(
        kind,
        ErrorKind::Collapse,
        "{what}\n{:?}",
        results.incomplete
    );
    results.history.last().map(|row| row.alpha)
}

#[test]
fn default_settings_come_to_the_end_or_to_a_limit_load() {
    let folder = tempfile::tempdir().unwrap();
    let run = |text: &str| -> Result<Results> {
        Analysis::new(Model::new(&parse(text))?, Backend::default())?.run(&mut Silent)
    };
    let (mut yielded, mut limits) = (0, 0);
    for seed in 1..=either(100, 500) {
        let text = model(seed, folder.path());
        let results = run(&text).unwrap_or_else(|why| panic!("seed {seed}: {why}\n{text}"));
        yielded += usize::from(results.states.iter().any(|state| state.plastic_points > 0));
        if let Some(held) = limit(&results, &text) {
            limits += 1;
            let steps = text.replace("program.", "program.stepping = \"steps\"\nprogram.");
            let steps = run(&steps).unwrap_or_else(|why| panic!("seed {seed}: {why}\n{text}"));
            let other = limit(&steps, &text).expect("a limit load");
            // Known to a millionth of the step, and to the tolerance of contact.
            assert!(
                (held - other).abs() <= 1e-3 * held,
                "{held} {other}\n{text}"
            );
        }
    }
    println!("{yielded} yielded, {limits} came to a limit load");
    assert!(yielded > either(50, 250), "{yielded}");
}

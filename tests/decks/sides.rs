//! The wrong face of an element in a contact surface: noticed by name. What truly overlaps is not.

use super::with_text;
use brinell::model::Model;
use std::fmt::Write as _;

/// Two blocks of a unit width, one on the other, the upper one lowered by an overlap.
#[derive(Clone, Copy)]
struct Blocks {
    /// The type of the elements.
    kind: &'static str,
    /// Elements along each axis of the lower and of the upper one, upwards last.
    elements: [[usize; 3]; 2],
    overlap: f64,
    /// Numbers of the faces of the lower one's top row, and of the upper one's bottom row.
    faces: [usize; 2],
}

impl Blocks {
    fn is_solid(&self) -> bool {
        self.kind.starts_with("C3D")
    }

    fn is_quadratic(&self) -> bool {
        self.kind.contains("20") || self.kind.ends_with('8') && !self.is_solid()
    }

    /// The faces that look at the other body.
    fn right(&self) -> [usize; 2] {
        if self.is_solid() { [2, 1] } else { [3, 1] }
    }

    /// The number of a node on the grid of corners and middles.
    fn label(body: usize, [i, j, k]: [usize; 3]) -> usize {
        1 + i + 100 * (j + 100 * (k + 100 * body))
    }

    fn text(&self) -> String {
        let mut text = "*NODE\n".to_string();
        let solid = self.is_solid();
        let grids = self
            .elements
            .map(|[x, y, z]| [x, if solid { y } else { 0 }, z]);
        let edge = |place: [usize; 3]| place.iter().filter(|x| *x % 2 == 1).count();
        let most = usize::from(self.is_quadratic());
        for (body, grid) in grids.iter().enumerate() {
            let shift = [0.0, 1.0 - self.overlap][body];
            for (k, j, i) in places(grid.map(|n| 2 * n + 1)) {
                if edge([i, j, k]) <= most {
                    let along = |at: usize, n: usize| 0.5 * at as f64 / (n.max(1)) as f64;
                    let [x, y] = [along(i, grid[0]), along(j, grid[1])];
                    let z = along(k, grid[2]) + shift;
                    let label = Blocks::label(body, [i, j, k]);
                    match solid {
                        true => writeln!(text, "{label}, {x}, {y}, {z}").unwrap(),
                        false => writeln!(text, "{label}, {x}, {z}").unwrap(),
                    }
                }
            }
        }
        let (mut sets, mut surfaces, mut held) = (String::new(), String::new(), String::new());
        for (body, grid) in grids.iter().enumerate() {
            let (name, last) = (["LOW", "HIGH"][body], grid[2] - 1);
            writeln!(text, "*ELEMENT, TYPE={}, ELSET={name}", self.kind).unwrap();
            writeln!(surfaces, "*SURFACE, NAME={}", ["TOP", "UNDER"][body]).unwrap();
            for (k, j, i) in places([grid[0], grid[1].max(1), grid[2]]) {
                let element = Blocks::label(body, [i, j, k]);
                let own = self.nodes(body, [i, j, k]);
                let own: Vec<String> = own.iter().map(ToString::to_string).collect();
                writeln!(
                    text,
                    "{element}, {}",
                    own.join(", ").replace(", 1,", ",\n1,")
                )
                .unwrap();
                if k == [last, 0][body] {
                    writeln!(surfaces, "{element}, S{}", self.faces[body]).unwrap();
                }
            }
            writeln!(
                sets,
                "*SOLID SECTION, ELSET={name}, MATERIAL=STEEL\n*NSET, NSET=N{name}"
            )
            .unwrap();
            let height = [0, 2 * grid[2]][body];
            for (_, j, i) in places([2 * grid[0] + 1, 2 * grid[1] + 1, 1]) {
                if edge([i, j, height]) <= most {
                    writeln!(sets, "{},", Blocks::label(body, [i, j, height])).unwrap();
                }
            }
            writeln!(held, "N{name}, 1, {}", if solid { 3 } else { 2 }).unwrap();
        }
        format!(
            "{text}*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n{sets}{surfaces}\
             *SURFACE INTERACTION, NAME=HARD\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n\
             *CONTACT PAIR, INTERACTION=HARD, TYPE=SURFACE TO SURFACE\nUNDER, TOP\n\
             *BOUNDARY\n{held}*STEP\n*STATIC\n*END STEP\n"
        )
    }

    /// The nodes of an element.
    fn nodes(&self, body: usize, [i, j, k]: [usize; 3]) -> Vec<usize> {
        let solid = [[0, 0], [2, 0], [2, 2], [0, 2]];
        let mut places: Vec<[usize; 3]> = match self.is_solid() {
            true => [0, 2]
                .iter()
                .flat_map(|&z| solid.map(|[x, y]| [x, y, z]))
                .collect(),
            false => solid.map(|[x, z]| [x, 0, z]).to_vec(),
        };
        if self.is_quadratic() {
            let middle = |a: usize, b: usize| {
                std::array::from_fn(|d| usize::midpoint(places[a][d], places[b][d]))
            };
            let rows: &[[usize; 2]] = match self.is_solid() {
                true => &[
                    [0, 1],
                    [1, 2],
                    [2, 3],
                    [3, 0],
                    [4, 5],
                    [5, 6],
                    [6, 7],
                    [7, 4],
                    [0, 4],
                    [1, 5],
                    [2, 6],
                    [3, 7],
                ],
                false => &[[0, 1], [1, 2], [2, 3], [3, 0]],
            };
            let middles: Vec<[usize; 3]> = rows.iter().map(|[a, b]| middle(*a, *b)).collect();
            places.extend(middles);
        }
        let own = |[x, y, z]: [usize; 3]| Blocks::label(body, [2 * i + x, 2 * j + y, 2 * k + z]);
        places.into_iter().map(own).collect()
    }

    fn model(&self) -> brinell::Result<Model> {
        with_text(&self.text(), |scene| Model::new(&scene))
    }
}

/// All places of a grid, the last axis first.
fn places([x, y, z]: [usize; 3]) -> impl Iterator<Item = (usize, usize, usize)> {
    let rows = move |k| (0..y).flat_map(move |j| (0..x).map(move |i| (k, j, i)));
    (0..z).flat_map(rows)
}

const KINDS: [&str; 5] = ["CPE4", "CPE8", "CPS4", "C3D8", "C3D20"];
/// Meshes that match, and meshes that do not.
const MESHES: [[[usize; 3]; 2]; 2] = [[[3, 2, 2], [3, 2, 2]], [[3, 2, 2], [4, 3, 2]]];

fn refused(blocks: Blocks) -> String {
    let error = blocks.model().err();
    error
        .unwrap_or_else(|| panic!("{}", blocks.text()))
        .to_string()
}

/// Either surface has the far faces of its elements, or both have: named with what is meant.
#[test]
fn faces_that_look_away_are_named() {
    for kind in KINDS {
        for elements in MESHES {
            let right = Blocks {
                kind,
                elements,
                overlap: 0.0,
                faces: [0; 2],
            }
            .right();
            let [top, under] = right;
            for faces in [[top, top], [under, under], [under, top]] {
                let text = refused(Blocks {
                    kind,
                    elements,
                    overlap: 0.0,
                    faces,
                });
                assert!(
                    text.contains("UNDER") && text.contains("TOP"),
                    "{kind}: {text}"
                );
                assert!(!text.contains("overlap = true"), "{kind}: {text}");
                let is_both = faces == [under, top];
                if is_both && text.contains("no part of `TOP` lies opposite `UNDER`") {
                    // Farther off than faces that do not match are looked for.
                    continue;
                }
                let said = match is_both {
                    true => "look away from each other: the surfaces would overlap by 1.000,",
                    false => "looks away from",
                };
                assert!(text.contains(said), "{kind} {faces:?}: {text}");
                let is_slave = faces[1] == top;
                let wrong = if is_slave { top } else { under };
                let instead = if is_slave { under } else { top };
                let named = format!("face S{wrong} of element ");
                assert!(text.contains(&named), "{text}");
                let named = format!("face S{instead} of element ");
                let advice = text.split_once("name ").map(|(_, advice)| advice);
                assert!(advice.is_some_and(|text| text.contains(&named)), "{text}");
                let off = if is_both {
                    "by 1.000,"
                } else {
                    "lies 0.5000 behind it"
                };
                assert!(text.contains(off), "{kind}: {text}");
            }
        }
    }
}

/// One face of several.
#[test]
fn one_face_of_a_surface_that_looks_away_is_named() {
    for kind in KINDS {
        let blocks = Blocks {
            kind,
            elements: MESHES[0],
            overlap: 0.0,
            faces: [0; 2],
        };
        let [top, under] = blocks.right();
        let right = Blocks {
            faces: [top, under],
            ..blocks
        };
        right.model().unwrap();
        // The first element of the upper block.
        let element = Blocks::label(1, [0; 3]);
        let text = right.text();
        let [from, to] = [under, top].map(|face| format!("\n{element}, S{face}\n"));
        assert!(text.contains(&from), "{text}");
        let model = with_text(&text.replace(&from, &to), |scene| Model::new(&scene));
        let error = model
            .err()
            .map_or_else(String::new, |error| error.to_string());
        let named = format!("face S{top} of element {element} of `UNDER` looks away from `TOP`");
        assert!(error.contains(&named), "{kind}: {error}");
    }
}

/// Small overlaps, and such as are deeper than the elements are.
#[test]
fn what_truly_overlaps_is_an_interference() {
    for kind in KINDS {
        for elements in MESHES {
            for overlap in [0.001, 0.4] {
                let blocks = Blocks {
                    kind,
                    elements,
                    overlap,
                    faces: [0; 2],
                };
                let blocks = Blocks {
                    faces: blocks.right(),
                    ..blocks
                };
                let thin = Blocks {
                    elements: elements.map(|[x, y, _]| [x, y, 5]),
                    ..blocks
                };
                for blocks in [blocks, thin] {
                    let model = blocks
                        .model()
                        .unwrap_or_else(|error| panic!("{kind}: {error}"));
                    let most = model.pairs.iter().map(|pair| pair.interference);
                    let most = most.fold(0.0, f64::max);
                    assert!((most - overlap).abs() < 1e-9, "{kind} {overlap}: {most}");
                }
            }
        }
    }
}

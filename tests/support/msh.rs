//! Meshes as a mesher writes them: graded, jittered, of all shapes.

use super::random::Random;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A mesh in the words of Gmsh's format 2.2.
#[derive(Default)]
pub struct Msh {
    nodes: Vec<[f64; 3]>,
    /// Type, group, nodes.
    elements: Vec<(u32, usize, Vec<usize>)>,
    /// Dimension and name; the place is the number less 1.
    groups: Vec<(u32, String)>,
}

impl Msh {
    /// Moves every node.
    pub fn map(&mut self, to: impl Fn([f64; 3]) -> [f64; 3]) {
        for x in &mut self.nodes {
            *x = to(*x);
        }
    }

    fn group(&mut self, dimension: u32, name: String) -> usize {
        self.groups.push((dimension, name));
        self.groups.len()
    }

    fn node(&mut self, x: [f64; 3]) -> usize {
        self.nodes.push(x);
        self.nodes.len()
    }

    /// The file.
    pub fn text(&self) -> String {
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

/// A whole disc, whose lowest node is its first.
pub struct Disc {
    pub name: &'static str,
    pub center: [f64; 2],
    pub radius: f64,
    /// Angles of the nodes of its rings, counted from the lowest point, in turns, ascending from 0.
    pub angles: Vec<f64>,
    pub rings: usize,
}

impl Disc {
    /// Adds the disc as triangles around its centre and quadrangles (9-node ones with their centres
    /// for order 2, as Gmsh writes them), and its outline.
    pub fn plane(&self, msh: &mut Msh, order: usize) {
        let n = self.angles.len();
        let center = msh.node([self.center[0], self.center[1], 0.0]);
        let mut numbers = BTreeMap::new();
        // Halves of rings and of angles: nodes in the middle of edges stand between.
        let mut node = |msh: &mut Msh, [ring, at]: [usize; 2]| {
            let at = at % (2 * n);
            if ring == 0 {
                return center;
            }
            *numbers.entry([ring, at]).or_insert_with(|| {
                let next = self.angles.get(at.div_ceil(2)).copied().unwrap_or(1.0);
                let turn = std::f64::consts::PI * (self.angles[at / 2] + next);
                let r = self.radius * ring as f64 / (2 * self.rings) as f64;
                let [x, y] = self.center;
                msh.node([x + r * turn.sin(), y - r * turn.cos(), 0.0])
            })
        };
        let body = msh.group(2, self.name.to_string());
        let outline = msh.group(1, format!("{} outline", self.name));
        let mut add = |msh: &mut Msh, group, types: [u32; 2], nodes: &[[usize; 2]]| {
            let corners = nodes.len() / 2 + usize::from(nodes.len() == 3);
            let taken = if order == 1 { corners } else { nodes.len() };
            let nodes = nodes[..taken].iter().map(|&at| node(msh, at)).collect();
            msh.elements.push((types[order - 1], group, nodes));
        };
        for a in (0..2 * n).step_by(2) {
            for r in (0..2 * self.rings).step_by(2) {
                let [b, m] = [a + 2, a + 1];
                match r {
                    0 => {
                        let corners = [[0, 0], [2, a], [2, b]];
                        let nodes = [corners, [[1, a], [2, m], [1, b]]].concat();
                        add(msh, body, [2, 9], &nodes);
                    }
                    _ => {
                        let corners = [[r, a], [r + 2, a], [r + 2, b], [r, b]];
                        let middles = [[r + 1, a], [r + 2, m], [r + 1, b], [r, m]];
                        let nodes = [&corners[..], &middles, &[[r + 1, m]]].concat();
                        add(msh, body, [3, 10], &nodes);
                    }
                }
            }
            let outer = 2 * self.rings;
            add(
                msh,
                outline,
                [1, 8],
                &[[outer, a], [outer, a + 2], [outer, a + 1]],
            );
        }
    }
}

/// A body over `[from, from + width]` (squared in space) between two heights, and how it is meshed.
pub struct Body<'a> {
    pub name: &'static str,
    pub from: f64,
    pub width: f64,
    /// Cells along and up.
    pub cells: [usize; 2],
    pub heights: [&'a dyn Fn(f64) -> f64; 2],
    /// Where a height has a kink.
    pub kink: Option<f64>,
    /// Grading towards the axis.
    pub grading: f64,
    pub jitter: f64,
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
    pub fn plane(&self, msh: &mut Msh, triangles: bool, order: usize, random: &mut Random) {
        let [m, n] = self.cells;
        let along = self.places(m, self.grading, self.kink.map(|k| k / self.width), random);
        let up = self.places(n, 1.0, None, random);
        let mut at = BTreeMap::new();
        // Halves of cells: nodes in the middle of edges stand between.
        let mut node = |msh: &mut Msh, [i, j]: [usize; 2]| {
            *at.entry([i, j]).or_insert_with(|| {
                let mid = |of: &[f64], k: usize| 0.5 * (of[k / 2] + of[k.div_ceil(2)]);
                let x = self.from + self.width * mid(&along, i);
                let ends = [i / 2, i.div_ceil(2)].map(|k| self.from + self.width * along[k]);
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

    /// Adds the body as tetrahedra or hexahedra of order 1 or 2, its faces and its planes of
    /// symmetry.
    pub fn solid(&self, msh: &mut Msh, tetrahedra: bool, order: usize, random: &mut Random) {
        let [m, n] = self.cells;
        let [x, y] = [0, 1].map(|_| self.places(m, self.grading, None, random));
        let up = self.places(n, 1.0, None, random);
        // Halves of cells: nodes in the middle of edges stand between.
        let corner = |[i, j, k]: [usize; 3]| {
            let (x, y) = (
                self.from + self.width * x[i / 2],
                self.from + self.width * y[j / 2],
            );
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
        let mut add = |msh: &mut Msh, group: usize, cell: Cell, corners: &[[usize; 3]]| {
            let edges = match order {
                1 => Vec::new(),
                _ => cell.edges(corners),
            };
            let middle = |[a, b]: &[usize; 2]| -> [usize; 3] {
                std::array::from_fn(|d| (corners[*a][d] + corners[*b][d]) / 2)
            };
            let all = corners.iter().copied().chain(edges.iter().map(middle));
            let nodes = all.map(|at| *numbers.entry(at).or_insert_with(|| msh.node(place(at))));
            let nodes = nodes.collect();
            msh.elements.push((cell.of_type(order), group, nodes));
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
                    if tetrahedra {
                        for corners in tetrahedra_of([i, j, k]) {
                            add(msh, group, Cell::Tetrahedron, &corners);
                        }
                        continue;
                    }
                    let both = [k, k + 2].map(|k| face(2, [i, j, k]));
                    add(msh, group, Cell::Hexahedron, both.as_flattened());
                }
            }
        }
        let mut add_face = |msh: &mut Msh, group: usize, [a, b, c, d]: [[usize; 3]; 4]| {
            if tetrahedra {
                add(msh, group, Cell::Triangle, &[a, b, c]);
                add(msh, group, Cell::Triangle, &[a, c, d]);
            } else {
                add(msh, group, Cell::Quadrangle, &[a, b, c, d]);
            }
        };
        for (side, k) in [("bottom", 0), ("top", 2 * n)] {
            let group = msh.group(2, format!("{} {side}", self.name));
            for (i, j) in evens(m).flat_map(|i| evens(m).map(move |j| (i, j))) {
                add_face(msh, group, face(2, [i, j, k]));
            }
        }
        for axis in 0..2 {
            let group = msh.group(2, format!("{} axis {axis}", self.name));
            for (a, k) in evens(m).flat_map(|a| evens(n).map(move |k| (a, k))) {
                let mut at = [a, a, k];
                at[axis] = 0;
                add_face(msh, group, face(axis, at));
            }
        }
    }
}

/// A cell of a solid mesh or a face of one.
#[derive(Clone, Copy)]
enum Cell {
    Triangle,
    Quadrangle,
    Tetrahedron,
    Hexahedron,
}

impl Cell {
    /// Gmsh's number of its type.
    fn of_type(self, order: usize) -> u32 {
        match (self, order) {
            (Cell::Triangle, 1) => 2,
            (Cell::Triangle, _) => 9,
            (Cell::Quadrangle, 1) => 3,
            (Cell::Quadrangle, _) => 16,
            (Cell::Tetrahedron, 1) => 4,
            (Cell::Tetrahedron, _) => 11,
            (Cell::Hexahedron, 1) => 5,
            (Cell::Hexahedron, _) => 17,
        }
    }

    /// Its edges in Gmsh's order: of a face in turn, of a hexahedron in the order of their ends.
    fn edges(self, corners: &[[usize; 3]]) -> Vec<[usize; 2]> {
        let n = corners.len();
        let is_edge =
            |&[a, b]: &[usize; 2]| (0..3).filter(|&d| corners[a][d] != corners[b][d]).count() == 1;
        match self {
            Cell::Triangle | Cell::Quadrangle => (0..n).map(|k| [k, (k + 1) % n]).collect(),
            Cell::Tetrahedron => vec![[0, 1], [1, 2], [0, 2], [0, 3], [2, 3], [1, 3]],
            Cell::Hexahedron => {
                let pairs = (0..n).flat_map(|b| (b + 1..n).map(move |a| [b, a]));
                pairs.filter(is_edge).collect()
            }
        }
    }
}

/// The six tetrahedra of a cell, all along its diagonal: faces of neighbours match.
fn tetrahedra_of(at: [usize; 3]) -> [[[usize; 3]; 4]; 6] {
    let ways = [
        [0, 1, 2],
        [1, 2, 0],
        [2, 0, 1],
        [0, 2, 1],
        [2, 1, 0],
        [1, 0, 2],
    ];
    ways.map(|way| {
        let mut corners = [at; 4];
        for (k, &axis) in way.iter().enumerate() {
            corners[k + 1] = corners[k];
            corners[k + 1][axis] += 2;
        }
        // Every other way turns against the axes.
        let turned = [[0, 2, 1], [2, 1, 0], [1, 0, 2]].contains(&way);
        if turned {
            corners.swap(1, 2);
        }
        corners
    })
}

//! Boxes of cells, of every shape, bent by a map.

use brinell::mesh::Shape;
use brinell::model::ModelBuilder;
use std::collections::BTreeMap;

/// A point.
pub type Point = [f64; 3];

/// The six tetrahedra of a cell that share its diagonal from corner 0 to corner 6, by corners of a
/// hexahedron.
const TETRAHEDRA: [[usize; 4]; 6] = [
    [0, 1, 2, 6],
    [0, 2, 3, 6],
    [0, 3, 7, 6],
    [0, 7, 4, 6],
    [0, 4, 5, 6],
    [0, 5, 1, 6],
];

/// The two prisms of a cell that share the face of its corners 0, 2, 6 and 4.
const PRISMS: [[usize; 6]; 2] = [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]];

/// A box `[0, 1]^3` of cells whose points a map puts in their place.
pub struct Grid<'a> {
    pub name: &'a str,
    pub cells: [usize; 3],
    pub shape: Shape,
    pub map: &'a dyn Fn(Point) -> Point,
}

impl Grid<'_> {
    /// Adds nodes, elements and the surfaces `NAME.x0`, `NAME.x1`, ... `NAME.z1`.
    pub fn add(&self, builder: &mut ModelBuilder) {
        let n = self.cells.map(|n| 2 * n);
        let mut numbers: BTreeMap<[usize; 3], usize> = BTreeMap::new();
        let mut places: Vec<[usize; 3]> = Vec::new();
        let first = builder.n_nodes();
        let mut number = |at: [usize; 3]| {
            *numbers.entry(at).or_insert_with(|| {
                places.push(at);
                first + places.len() - 1
            })
        };
        let mut connectivity = Vec::new();
        let row = self.shape.reference();
        for k in 0..self.cells[2] {
            for j in 0..self.cells[1] {
                for i in 0..self.cells[0] {
                    let corner = |c: usize| {
                        let [a, b] = [[0, 0], [2, 0], [2, 2], [0, 2]][c % 4];
                        [2 * i + a, 2 * j + b, 2 * k + 2 * (c / 4)]
                    };
                    let elements: Vec<Vec<usize>> = match row.n_corners {
                        8 => vec![(0..8).collect()],
                        6 => PRISMS.map(|p| p.to_vec()).to_vec(),
                        _ => TETRAHEDRA.map(|t| t.to_vec()).to_vec(),
                    };
                    for corners in elements {
                        let corners: Vec<[usize; 3]> = corners.into_iter().map(corner).collect();
                        for node in 0..row.nodes.len() {
                            let at = match corners.get(node) {
                                Some(at) => *at,
                                None => {
                                    let [a, b] = row.edges[node - corners.len()];
                                    [0, 1, 2].map(|d| (corners[a][d] + corners[b][d]) / 2)
                                }
                            };
                            connectivity.push(number(at));
                        }
                    }
                }
            }
        }
        let coordinates: Vec<f64> = places
            .iter()
            .flat_map(|at| (self.map)([0, 1, 2].map(|d| at[d] as f64 / n[d] as f64)))
            .collect();
        builder.nodes(&coordinates).unwrap();
        builder
            .elements(self.shape, self.name, &connectivity)
            .unwrap();
        for (d, axis) in ["x", "y", "z"].into_iter().enumerate() {
            for (end, at) in [0, n[d]].into_iter().enumerate() {
                let nodes: Vec<usize> = (places.iter().enumerate())
                    .filter(|(_, place)| place[d] == at)
                    .map(|(k, _)| first + k)
                    .collect();
                let name = format!("{}.{axis}{end}", self.name);
                builder.surface_of_nodes(&name, &nodes).unwrap();
            }
        }
    }
}

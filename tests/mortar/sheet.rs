//! Rectangles of cells, of every plane shape, bent by a map.

use brinell::mesh::Shape;
use brinell::model::ModelBuilder;
use std::collections::BTreeMap;

/// A rectangle `[0, 1]^2` of cells whose points a map puts in their place.
pub struct Sheet<'a> {
    pub name: &'a str,
    pub cells: [usize; 2],
    pub shape: Shape,
    pub map: &'a dyn Fn([f64; 2]) -> [f64; 2],
}

impl Sheet<'_> {
    /// Adds nodes, elements and the surfaces `NAME.left`, `right`, `bottom`, `top`.
    pub fn add(&self, builder: &mut ModelBuilder) {
        let n = self.cells.map(|n| 2 * n);
        let mut numbers: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        let mut places: Vec<[usize; 2]> = Vec::new();
        let first = builder.n_nodes();
        let mut number = |at: [usize; 2]| {
            *numbers.entry(at).or_insert_with(|| {
                places.push(at);
                first + places.len() - 1
            })
        };
        let mut connectivity = Vec::new();
        for j in 0..self.cells[1] {
            for i in 0..self.cells[0] {
                let corner = |c: usize| {
                    let [a, b] = [[0, 0], [2, 0], [2, 2], [0, 2]][c];
                    [2 * i + a, 2 * j + b]
                };
                let elements: Vec<Vec<usize>> = match self.shape.n_corners() {
                    4 => vec![vec![0, 1, 2, 3]],
                    _ => vec![vec![0, 1, 2], vec![0, 2, 3]],
                };
                for corners in elements {
                    let corners: Vec<[usize; 2]> = corners.into_iter().map(corner).collect();
                    connectivity.extend(corners.iter().map(|&at| number(at)));
                    for k in 0..corners.len() * usize::from(self.shape.is_quadratic()) {
                        let [a, b] = [corners[k], corners[(k + 1) % corners.len()]];
                        connectivity.push(number([0, 1].map(|d| (a[d] + b[d]) / 2)));
                    }
                }
            }
        }
        let coordinates: Vec<f64> = places
            .iter()
            .flat_map(|at| (self.map)([0, 1].map(|d| at[d] as f64 / n[d] as f64)))
            .collect();
        builder.nodes(&coordinates).unwrap();
        builder
            .elements(self.shape, self.name, &connectivity)
            .unwrap();
        for (d, names) in [["left", "right"], ["bottom", "top"]]
            .into_iter()
            .enumerate()
        {
            for (name, at) in names.into_iter().zip([0, n[d]]) {
                let nodes: Vec<usize> = (places.iter().enumerate())
                    .filter(|(_, place)| place[d] == at)
                    .map(|(k, _)| first + k)
                    .collect();
                builder
                    .surface_of_nodes(&format!("{}.{name}", self.name), &nodes)
                    .unwrap();
            }
        }
    }
}

//! Stiffness matrices of elastic bodies on regular grids, for tests and benches.
//!
//! quad4 (D = 2) or hex8 (D = 3) elements of unit size, Young's modulus 1, Poisson's ratio 0.3,
//! plane strain in 2D. The last direction points up.

/// Upper triangle by columns, the same type as `brinell::linalg::SymmetricCsc`.
pub type Upper = sprs::CsMatI<f64, i64>;

/// Support of the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Support {
    /// All freedoms of the bottom are fixed.
    Bottom,
    /// The sides at the origin slide freely in the upward direction (the matrix is singular).
    Guides,
}

/// A grid of elements, whose free freedoms are numbered node by node.
pub struct Grid<const D: usize> {
    /// Number of nodes in each direction.
    pub nodes: [usize; D],
    numbers: Vec<Option<usize>>,
    /// Number of free freedoms.
    pub n: usize,
}

impl<const D: usize> Grid<D> {
    /// Makes a grid with `elements` in each direction.
    pub fn new(elements: [usize; D], support: Support) -> Self {
        let nodes = elements.map(|e| e + 1);
        let count: usize = nodes.iter().product();
        let mut n = 0;
        let mut numbers = Vec::with_capacity(count * D);
        for node in 0..count {
            let place = place(nodes, node);
            for direction in 0..D {
                let fixed = match support {
                    Support::Bottom => place[D - 1] == 0,
                    Support::Guides => direction < D - 1 && place[direction] == 0,
                };
                numbers.push((!fixed).then_some(n));
                n += usize::from(!fixed);
            }
        }
        Grid { nodes, numbers, n }
    }

    /// Free freedoms of the nodes that `chosen` selects, in the given directions, ascending.
    pub fn freedoms(
        &self,
        directions: std::ops::Range<usize>,
        chosen: impl Fn([usize; D]) -> bool,
    ) -> Vec<usize> {
        let count: usize = self.nodes.iter().product();
        (0..count)
            .filter(|&node| chosen(place(self.nodes, node)))
            .flat_map(|node| directions.clone().map(move |d| D * node + d))
            .filter_map(|index| self.numbers[index])
            .collect()
    }

    /// Stiffness matrix, with the modulus of each element given by `modulus(element place)`.
    pub fn stiffness(&self, modulus: impl Fn([usize; D]) -> f64) -> Upper {
        let element = element_stiffness::<D>();
        let corners = 1 << D;
        let count: usize = self.nodes.iter().product();
        let (mut columns, mut rows, mut values) = (vec![0i64], Vec::new(), Vec::new());
        for b in 0..count {
            let place_b = place(self.nodes, b);
            // Blocks K_ab of the nodes around b, by the node's offset (-1, 0, 1 in each direction).
            let mut blocks = vec![[[0.0; D]; D]; 3usize.pow(D as u32)];
            for lb in 0..corners {
                let Some(origin) = element_of(self.nodes, place_b, lb) else {
                    continue;
                };
                let e = modulus(origin);
                for la in 0..corners {
                    let mut offset = 0;
                    for d in (0..D).rev() {
                        offset = 3 * offset + 1 + (la >> d & 1) - (lb >> d & 1);
                    }
                    for i in 0..D {
                        for j in 0..D {
                            blocks[offset][i][j] +=
                                e * element[(D * la + i) * corners * D + D * lb + j];
                        }
                    }
                }
            }
            for j in 0..D {
                let Some(column) = self.numbers[D * b + j] else {
                    continue;
                };
                for (offset, block) in blocks.iter().enumerate() {
                    let Some(a) = neighbour(self.nodes, place_b, offset) else {
                        continue;
                    };
                    for (i, row) in block.iter().enumerate() {
                        if let Some(row_number) = self.numbers[D * a + i]
                            && row_number <= column
                        {
                            rows.push(row_number as i64);
                            values.push(row[j]);
                        }
                    }
                }
                columns.push(rows.len() as i64);
            }
        }
        Upper::new_csc((self.n, self.n), columns, rows, values)
    }
}

fn place<const D: usize>(nodes: [usize; D], mut node: usize) -> [usize; D] {
    nodes.map(|count| {
        let index = node % count;
        node /= count;
        index
    })
}

/// The element in which the node is corner `corner`; `None` if there is none.
fn element_of<const D: usize>(
    nodes: [usize; D],
    place: [usize; D],
    corner: usize,
) -> Option<[usize; D]> {
    let mut origin = place;
    for d in 0..D {
        origin[d] = origin[d].checked_sub(corner >> d & 1)?;
        if origin[d] + 1 >= nodes[d] {
            return None;
        }
    }
    Some(origin)
}

/// The node at `offset`, whose base-3 digits stand for -1, 0, 1 in each direction.
fn neighbour<const D: usize>(
    nodes: [usize; D],
    place: [usize; D],
    mut offset: usize,
) -> Option<usize> {
    let mut node = 0;
    let mut stride = 1;
    for d in 0..D {
        let index = (place[d] + offset % 3).checked_sub(1)?;
        if index >= nodes[d] {
            return None;
        }
        node += stride * index;
        stride *= nodes[d];
        offset /= 3;
    }
    Some(node)
}

/// Element stiffness `K_ai,bj = integral of lambda N_a,i N_b,j + mu N_a,j N_b,i + mu delta_ij N_a,k
/// N_b,k`, with two Gauss points in each direction.
fn element_stiffness<const D: usize>() -> Vec<f64> {
    let (modulus, ratio) = (1.0, 0.3);
    let lambda = modulus * ratio / ((1.0 + ratio) * (1.0 - 2.0 * ratio));
    let mu = modulus / (2.0 * (1.0 + ratio));
    let corners = 1usize << D;
    let size = corners * D;
    let mut k = vec![0.0; size * size];
    for point in 0..corners {
        let at = |d: usize| 0.5 + (if point >> d & 1 == 1 { 0.5 } else { -0.5 }) / 3f64.sqrt();
        let gradient = |a: usize| -> [f64; D] {
            std::array::from_fn(|i| {
                (0..D)
                    .map(|d| {
                        let up = a >> d & 1 == 1;
                        match (d == i, up) {
                            (true, true) => 1.0,
                            (true, false) => -1.0,
                            (false, true) => at(d),
                            (false, false) => 1.0 - at(d),
                        }
                    })
                    .product()
            })
        };
        for a in 0..corners {
            for b in 0..corners {
                let (g, h) = (gradient(a), gradient(b));
                let dot: f64 = g.iter().zip(&h).map(|(x, y)| x * y).sum();
                for i in 0..D {
                    for j in 0..D {
                        let own = if i == j { mu * dot } else { 0.0 };
                        k[(D * a + i) * size + D * b + j] +=
                            (lambda * g[i] * h[j] + mu * g[j] * h[i] + own) / corners as f64;
                    }
                }
            }
        }
    }
    k
}

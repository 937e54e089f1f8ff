//! The stiffness in parts, one for each MPI rank: choice of a rank's elements, and their assembly.
//!
//! A rank owns the freedoms of the nodes in its part of space ([`Mesh::shared_among`]) and
//! assembles their columns from all elements that hold one of them. The columns of all ranks
//! together equal the stiffness assembled on a single rank, to the last bit.
//!
//! [`Mesh::shared_among`]: crate::mesh::Mesh::shared_among

use super::elements::Elements;
use crate::error::{Error, Result};
use crate::linalg::mumps::{Columns, Part, Shared, World};
use crate::model::{Model, Slot};
use serde::{Deserialize, Serialize};

/// Elements and freedoms that are sent to a rank.
#[derive(Serialize, Deserialize)]
struct Share<'a> {
    elements: Elements<'a>,
    /// Whether each freedom is owned by the rank.
    owned: Vec<bool>,
}

/// Assembles the stiffness of a model, shared among all ranks.
///
/// # Errors
/// Errors reported by the ranks.
pub fn assemble(model: &Model) -> Result<Shared> {
    let mut shares = RankShares::new(model, World::join()?.size);
    Shared::new(model.freedoms.n, |rank| shares.take(rank), columns)
}

/// Shares of all ranks, made one by one.
struct RankShares<'a> {
    model: &'a Model,
    owner_of_node: Vec<u32>,
    /// Numbers of the elements that each rank assembles.
    elements: Vec<Vec<usize>>,
}

impl<'a> RankShares<'a> {
    fn new(model: &'a Model, ranks: usize) -> Self {
        let mut shares = RankShares {
            owner_of_node: model.mesh.shared_among(ranks),
            elements: vec![Vec::new(); ranks],
            model,
        };
        for e in 0..model.mesh.n_elements() {
            for slot in model.slots_of(e) {
                if let Slot::Free(f) = slot {
                    let owner = shares.owner(f as usize);
                    let list = &mut shares.elements[owner];
                    if list.last() != Some(&e) {
                        list.push(e);
                    }
                }
            }
        }
        shares
    }

    fn owner(&self, freedom: usize) -> usize {
        let (node, _) = self.model.freedoms.owners[freedom];
        self.owner_of_node[node as usize] as usize
    }

    /// Takes out the share of a rank, which can be done once.
    fn take(&mut self, rank: usize) -> Result<Part> {
        let model = self.model;
        let list = std::mem::take(&mut self.elements[rank]);
        let springs = model.freedoms.springs.iter();
        let own = springs.filter(|spring| self.owner(spring.freedom) == rank);
        let mut elements = Elements::some_of(model, &list)
            .with_springs(own.map(|spring| (spring.freedom, spring.stiffness)));
        let numbers = elements.renumber();
        let owned = numbers.iter().map(|&f| self.owner(f as usize) == rank);
        let share = Share {
            owned: owned.collect(),
            elements,
        };
        let message = postcard::to_stdvec(&share)
            .map_err(|cause| Error::internal("a part of the elements as bytes").because(cause))?;
        Ok(Part { numbers, message })
    }
}

/// Assembles the columns that a rank owns from the share sent to it.
///
/// # Errors
/// `Internal` if the share cannot be read.
pub fn columns(share: &[u8]) -> Result<Columns> {
    let Share { elements, owned } = postcard::from_bytes(share)
        .map_err(|cause| Error::internal("a part of the elements from bytes").because(cause))?;
    let continued = elements.continued();
    let both = |j: usize| continued[j] && owned[j] && owned[j - 1];
    Ok(Columns {
        matrix: elements.stiffness(|j| owned[j]),
        continued: (0..owned.len()).map(both).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// Plane, axisymmetric and solid scenes, with rotated axes, prescribed displacements and
    /// springs.
    const SCENES: [(&str, &[&str]); 6] = [
        (
            "disc_in_plate",
            &[
                "mesh.disc_in_plate.resolution=6",
                "mesh.disc_in_plate.far_radius=4.0",
            ],
        ),
        ("thick_cylinder", &["mesh.parts.0.ring.elements=[6,4]"]),
        ("flat_punch", &[]),
        (
            "fit_by_heat",
            &[
                "mesh.parts.0.disc.elements=6",
                "mesh.parts.1.ring.elements=[6,6]",
                "contact.0.stiffness=1e6",
            ],
        ),
        ("blocks_tet10", &[]),
        (
            "ball_in_groove",
            &[
                "mesh.curved_bodies.resolution=2",
                "mesh.curved_bodies.far_size=6",
                "mesh.curved_bodies.contact_width=1.5",
                "contact.0.stiffness=1e6",
            ],
        ),
    ];

    /// Each column of the whole matrix is assembled by exactly one rank, bit for bit.
    #[test]
    fn the_columns_of_all_ranks_are_those_of_one() {
        for (name, changes) in SCENES {
            let file = format!("{}/data/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
            let changes: Vec<String> = changes.iter().map(|text| text.to_string()).collect();
            let scene = Scene::load_with(file, &changes).unwrap();
            let model = Model::new(&scene).unwrap();
            let whole = super::super::all(&model).stiffness(|_| true);
            for ranks in [1, 2, 7] {
                let mut shares = RankShares::new(&model, ranks);
                let mut n_columns = 0;
                for rank in 0..ranks {
                    let part = shares.take(rank).unwrap();
                    let columns = columns(&part.message).unwrap();
                    for (j, column) in columns.matrix.outer_iterator().enumerate() {
                        if column.nnz() == 0 {
                            continue;
                        }
                        n_columns += 1;
                        let global = part.numbers[j] as usize;
                        let expected = whole.outer_view(global).unwrap();
                        assert_eq!(column.data(), expected.data(), "{name}: {global} of {rank}");
                        let rows = column.indices().iter();
                        let rows: Vec<i64> =
                            rows.map(|&i| i64::from(part.numbers[i as usize])).collect();
                        assert_eq!(rows, expected.indices());
                    }
                }
                assert_eq!(n_columns, model.freedoms.n, "{name} on {ranks}");
            }
        }
    }
}

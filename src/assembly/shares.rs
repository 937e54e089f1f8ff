//! The stiffness in parts, one for each rank: which elements a rank assembles, and how.
//!
//! A rank owns the freedoms of the nodes in its part of space (halved along its longest side again
//! and again) and assembles their columns, from all elements that hold one of them: the columns of
//! all ranks together are the stiffness as one would assemble it, to the last bit.
//!
//! # Source
//! M. J. Berger, S. H. Bokhari, *A partitioning strategy for nonuniform problems on
//! multiprocessors*, IEEE Trans. Computers C-36 (1987) 570, doi:10.1109/TC.1987.1676942.

use super::elements::Elements;
use crate::error::{Error, Result};
use crate::linalg::mumps::{Columns, Part, Shared, World};
use crate::mesh::Mesh;
use crate::model::{Model, Slot};
use serde::{Deserialize, Serialize};

/// What a rank is sent.
#[derive(Serialize, Deserialize)]
struct Share<'a> {
    elements: Elements<'a>,
    /// Whether each freedom is the rank's own.
    owned: Vec<bool>,
}

/// Assembles the stiffness of a model on all ranks.
///
/// # Errors
/// Those of the ranks.
pub fn assemble(model: &Model) -> Result<Shared> {
    let ranks = World::join()?.size;
    let owner_of_node = owners(&model.mesh, ranks);
    let owner = |freedom: usize| owner_of_node[model.freedoms.owners[freedom].0 as usize];
    let mut of_rank: Vec<Vec<usize>> = vec![Vec::new(); ranks];
    for e in 0..model.mesh.n_elements() {
        for slot in model.slots_of(e) {
            if let Slot::Free(f) = slot {
                let list = &mut of_rank[owner(f as usize) as usize];
                if list.last() != Some(&e) {
                    list.push(e);
                }
            }
        }
    }
    let part = |rank: usize| {
        let springs = model.freedoms.springs.iter();
        let own = springs.filter(|spring| owner(spring.freedom) as usize == rank);
        let mut elements = Elements::some_of(model, &std::mem::take(&mut of_rank[rank]))
            .with_springs(own.map(|spring| (spring.freedom, spring.stiffness)));
        let numbers = elements.renumber();
        let owned = numbers.iter().map(|&f| owner(f as usize) as usize == rank);
        let share = Share {
            owned: owned.collect(),
            elements,
        };
        let message = postcard::to_stdvec(&share)
            .map_err(|cause| Error::internal("a part of the elements as bytes").because(cause))?;
        Ok(Part { numbers, message })
    };
    Shared::new(model.freedoms.n, part, columns)
}

/// The columns that a rank assembles of its share.
///
/// # Errors
/// `Internal` where the share cannot be read.
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

/// The rank of each node: parts of space with as many nodes each.
fn owners(mesh: &Mesh, ranks: usize) -> Vec<u32> {
    let mut owners = vec![0; mesh.n_nodes()];
    let nodes = (0..mesh.n_nodes() as u32).collect();
    // Nodes, and the ranks among which they are to be shared.
    let mut open: Vec<(Vec<u32>, std::ops::Range<usize>)> = vec![(nodes, 0..ranks)];
    while let Some((mut nodes, ranks)) = open.pop() {
        if ranks.len() <= 1 || nodes.is_empty() {
            for &node in &nodes {
                owners[node as usize] = ranks.start as u32;
            }
            continue;
        }
        let place = |node: &u32| mesh.point(*node as usize);
        let length = |axis: usize| {
            let along = nodes.iter().map(|node| place(node)[axis]);
            let bounds = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
                [low.min(x), high.max(x)]
            });
            bounds[1] - bounds[0]
        };
        let lengths = [0, 1, 2].map(length);
        let axis = (1..3).fold(
            0,
            |best, k| if lengths[k] > lengths[best] { k } else { best },
        );
        let half = ranks.len() / 2;
        let cut = nodes.len() * half / ranks.len();
        // Of equals the one with the lower number.
        let order = |a: &u32, b: &u32| place(a)[axis].total_cmp(&place(b)[axis]).then(a.cmp(b));
        if cut > 0 {
            nodes.select_nth_unstable_by(cut, order);
        }
        let upper = nodes.split_off(cut);
        let middle = ranks.start + half;
        open.push((nodes, ranks.start..middle));
        open.push((upper, middle..ranks.end));
    }
    owners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rank_gets_its_share_of_the_nodes() {
        let mut mesh = Mesh {
            dimension: 2,
            ..Mesh::default()
        };
        for i in 0..30 {
            for j in 0..7 {
                mesh.coordinates.extend([f64::from(i), f64::from(j)]);
            }
        }
        for ranks in [1, 2, 3, 5, 8, 300] {
            let owners = owners(&mesh, ranks);
            let mut counts = vec![0usize; ranks];
            owners.iter().for_each(|&rank| counts[rank as usize] += 1);
            let (least, most) = (counts.iter().min().unwrap(), counts.iter().max().unwrap());
            assert!(most - least <= 2, "{ranks}: {counts:?}");
        }
        // The longer side is cut.
        let owners = owners(&mesh, 2);
        assert!(owners[..15 * 7].iter().all(|rank| *rank == 0));
    }
}

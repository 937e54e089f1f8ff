//! Fill-reducing ordering in the groups `[ interior | zone | contact ]`, in pure Rust.
//!
//! | candidate | how | good for |
//! |---|---|---|
//! | `AMD` | approximate minimum degree of interior and zone | plane meshes |
//! | `nested dissection` | separators of interior and zone | large and solid meshes |
//!
//! Neither method handles groups, so each group is ordered separately. Zone freedoms that touch the
//! interior come last in the zone: once the interior is eliminated, they are all coupled with one
//! another, whatever the ordering. The candidate with the fewest floating point operations is kept.
//! Both candidates order supervariables ([`Supervariables`]).
//!
//! # Source
//! P. R. Amestoy, T. A. Davis, I. S. Duff, *An approximate minimum degree ordering algorithm*,
//! SIAM J. Matrix Anal. Appl. 17 (4), 1996, doi:10.1137/S0895479894278952; G. Karypis, V. Kumar,
//! *A fast and high quality multilevel scheme for partitioning irregular graphs*, SIAM J. Sci.
//! Comput. 20 (1), 1998, doi:10.1137/S1064827595287997.

use super::elimination::Elimination;
use crate::error::{Error, Result};
use crate::linalg::sparse::{Groups, Pattern, Supervariables};
use feral_metis::{CscPattern, OrderingError};

/// Number of operations per stored entry of the matrix above which the second candidate is tried:
/// below it, finding the other ordering takes longer than it could save. Dissection takes some 10
/// microseconds a vertex, the time of 7,000 operations per entry. It saves about a third of the
/// operations in plane meshes and two thirds in solid ones.
const TRY_DISSECTION_ABOVE: f64 = 20_000.0;

/// Method by which the ordering is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum FillReduction {
    /// The candidate with the fewest floating point operations; the expensive candidate is only
    /// tried if it may save more time than it takes.
    #[default]
    Automatic,
    /// Approximate minimum degree alone.
    #[cfg_attr(not(test), allow(dead_code))]
    MinimumDegree,
    /// Nested dissection alone.
    #[cfg_attr(not(test), allow(dead_code))]
    Dissection,
}

/// A fill-reducing ordering with its cost.
pub(super) struct FaerOrdering {
    /// Name of the ordering in reports.
    pub(super) name: &'static str,
    /// Freedom of each column of the factor.
    pub(super) permutation: Vec<i64>,
    /// Number of nonzeros of each column.
    pub(super) counts: Vec<i64>,
    /// Floating point operations of the factorisation.
    pub(super) flops: f64,
}

/// Function that orders the vertices of a graph.
type Order = fn(&CscPattern) -> std::result::Result<Vec<i32>, OrderingError>;

/// Finds the ordering of a matrix with groups.
pub(super) fn choose(
    matrix: &Pattern,
    groups: &Groups,
    method: FillReduction,
) -> Result<FaerOrdering> {
    let compressed = Supervariables::find(matrix, groups);
    let entries = matrix.rows().len() as f64;
    let expensive = |order: &FaerOrdering| order.flops > TRY_DISSECTION_ABOVE * entries;
    let mut order = match method {
        FillReduction::Dissection => dissection(&compressed)?,
        _ => by_groups(&compressed, "AMD", feral_amd::amd_order)?,
    };
    if method == FillReduction::Automatic && expensive(&order) {
        let other = dissection(&compressed)?;
        if other.flops < order.flops {
            order = other;
        }
    }
    Ok(order)
}

fn dissection(compressed: &Supervariables) -> Result<FaerOrdering> {
    by_groups(compressed, "nested dissection", feral_metis::metis_order)
}

/// Orders interior and zone by `order`, appends border and contact freedoms, postorders the result,
/// and counts its operations.
fn by_groups(
    compressed: &Supervariables,
    name: &'static str,
    order: Order,
) -> Result<FaerOrdering> {
    let (pattern, groups) = (compressed.pattern(), compressed.groups());
    let sizes = compressed.sizes();
    let border = groups.border(&pattern);
    let in_zone = |j: usize| groups.of(j) == 1;
    let mut permutation = part(&pattern, order, |j| groups.of(j) == 0)?;
    permutation.extend(part(&pattern, order, |j| in_zone(j) && !border[j])?);
    let on_border = |j: &i64| in_zone(*j as usize) && border[*j as usize];
    permutation.extend((0..pattern.n() as i64).filter(on_border));
    permutation.extend((0..pattern.n() as i64).filter(|&j| groups.of(j as usize) == 2));

    let elimination = Elimination::new(&pattern, &sizes, &permutation);
    let flops = elimination.flops(&sizes, &permutation);
    let Elimination { parent, counts } = &elimination;
    let ordered = groups.postorder(&permutation, parent, counts);
    // Within a supervariable each column has one nonzero less than the one before it.
    let mut of_vertex = vec![0; pattern.n()];
    for (&vertex, &count) in permutation.iter().zip(counts) {
        of_vertex[vertex as usize] = count;
    }
    let counts = ordered.iter().flat_map(|&vertex| {
        let (count, size) = (of_vertex[vertex as usize], sizes[vertex as usize]);
        (0..size).map(move |k| count - k)
    });
    Ok(FaerOrdering {
        name,
        counts: counts.collect(),
        permutation: compressed.expand(&ordered),
        flops,
    })
}

/// Orders by `order` the vertices for which `is_in` is true; edges to other vertices do not count.
fn part(pattern: &Pattern, order: Order, is_in: impl Fn(usize) -> bool) -> Result<Vec<i64>> {
    let (local, columns, rows) = pattern.block(is_in);
    let vertices = (0..).zip(&local).filter(|(_, number)| **number >= 0);
    let vertices: Vec<i64> = vertices.map(|(vertex, _)| vertex).collect();
    let (starts, neighbours) = graph(&Pattern::from_parts(&columns, &rows))?;
    let graph = CscPattern::new(vertices.len(), &starts, &neighbours);
    let found = order(&graph.ok_or_else(|| failed(OrderingError::MalformedInput))?);
    let found = found.map_err(failed)?;
    // Anything but a permutation would lead to an index out of range later on.
    let mut is_new = vec![true; vertices.len()];
    let mut take = |place: i32| {
        let place = usize::try_from(place).ok()?;
        std::mem::take(is_new.get_mut(place)?).then(|| vertices[place])
    };
    let taken: Option<Vec<i64>> = found.iter().map(|&place| take(place)).collect();
    taken
        .filter(|taken| taken.len() == vertices.len())
        .ok_or_else(|| failed(OrderingError::Internal("not a permutation")))
}

fn failed(cause: OrderingError) -> Error {
    Error::internal(format!("the ordering failed: {cause}")).because(cause)
}

/// Neighbours of each vertex, ascending, without the vertex itself.
fn graph(pattern: &Pattern) -> Result<(Vec<i32>, Vec<i32>)> {
    let n = pattern.n();
    let edges = 2 * (pattern.rows().len() - n);
    if i32::try_from(edges).is_err() {
        return Err(Error::input(format!(
            "{edges} couplings are more than the ordering can number: use a coarser mesh"
        )));
    }
    let above = |j: usize| pattern.column(j).iter().filter(move |&&i| i as usize != j);
    let mut starts = vec![0i32; n + 1];
    for j in 0..n {
        for &i in above(j) {
            starts[i as usize + 1] += 1;
            starts[j + 1] += 1;
        }
    }
    for k in 0..n {
        starts[k + 1] += starts[k];
    }
    let mut next = starts.clone();
    let mut neighbours = vec![0i32; edges];
    for j in 0..n {
        for &i in above(j) {
            for (from, to) in [(i as usize, j), (j, i as usize)] {
                neighbours[next[from] as usize] = to as i32;
                next[from] += 1;
            }
        }
    }
    Ok((starts, neighbours))
}

//! Fill-reducing ordering in the groups `[ interior | zone | contact ]`.
//!
//! | candidate | how | good for |
//! |---|---|---|
//! | `CAMD` | approximate minimum degree, the groups as constraints | plane meshes |
//! | `nested dissection + CAMD` | separators of interior and zone as further constraints | solid meshes |
//!
//! The candidate with the fewest floating point operations is kept. Both order supervariables
//! ([`Supervariables`]).

use super::common::Common;
use super::matrix::SymmetricView;
use crate::error::{Error, Result};
use crate::linalg::sparse::{Groups, Pattern, Supervariables};
use std::ptr::null_mut;
use std::sync::{Mutex, PoisonError};
use suitesparse_sys as sys;

/// Number of operations per stored entry of the matrix above which the second candidate is tried:
/// below it, finding the other ordering takes longer than it could save.
///
/// Measured on two shared cores (`cargo bench --bench trailing -- orders`), zone of 10 %:
///
/// | body | freedoms | operations per entry, CAMD | dissection | CAMD order + rest | dissection order + rest |
/// |---|---|---|---|---|---|
/// | quad4 | 181 k | 3,800 | 2,500 | 0.13 + 0.8 s | 0.5 + 1.3 s |
/// | quad4 | 981 k | 8,500 | 6,100 | 1.2 + 5.4 s | 3.5 + 4.5 s |
/// | quad4, graded | 1,559 k | 15,400 | 5,900 | | |
/// | hex8 | 148 k | 263,000 | 87,000 | 0.5 + 40 s | 1.2 + 13 s |
const TRY_DISSECTION_ABOVE: f64 = 10_000.0;

/// Part number of a freedom that comes last in the zone, after all parts of a dissection.
const BORDER: i64 = i64::MAX;

/// Lock for METIS, which draws random numbers from the C library that all threads share. One caller
/// at a time makes sure that the same matrix always gets the same ordering.
static METIS: Mutex<()> = Mutex::new(());

/// A fill-reducing ordering with its cost.
pub(super) struct CholmodOrdering {
    /// Name of the ordering in reports.
    pub(super) name: &'static str,
    /// Freedom of each column of the factor.
    pub(super) permutation: Vec<i64>,
    flops: f64,
}

/// Method by which the ordering is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// The candidate with the fewest floating point operations; the expensive candidate is only
    /// tried if it may save more time than it takes.
    #[default]
    Automatic,
    /// Constrained approximate minimum degree.
    MinimumDegree,
    /// Nested dissection of interior and zone, then constrained minimum degree.
    Dissection,
}

/// Finds the ordering of a matrix with groups.
pub(super) fn choose(
    common: &mut Common,
    matrix: &Pattern,
    groups: &Groups,
    method: Method,
) -> Result<CholmodOrdering> {
    let compressed = Supervariables::find(matrix, groups);
    choose_for(common, &compressed, matrix.rows().len() as f64, method)
}

/// Finds the ordering of a matrix with known supervariables; `entries` is the number of entries of
/// the whole matrix.
pub(super) fn choose_for(
    common: &mut Common,
    compressed: &Supervariables,
    entries: f64,
    method: Method,
) -> Result<CholmodOrdering> {
    let (pattern, groups) = (compressed.pattern(), compressed.groups());
    // Factor from the operations on the pattern of supervariables to those on the whole matrix.
    let scale = compressed.size().powi(3);
    let is_expensive =
        |order: &CholmodOrdering| scale * order.flops > TRY_DISSECTION_ABOVE * entries;
    let mut order = match method {
        Method::Dissection => dissection(common, &pattern, groups)?,
        _ => minimum_degree(common, &pattern, groups)?,
    };
    if method == Method::Automatic && is_expensive(&order) {
        let other = dissection(common, &pattern, groups)?;
        if other.flops < order.flops {
            order = other;
        }
    }
    order.permutation = compressed.expand(&order.permutation);
    Ok(order)
}

/// Gathers the groups of an ordering, counts its operations, and postorders it.
fn complete(
    common: &mut Common,
    pattern: &Pattern,
    groups: &Groups,
    name: &'static str,
    permutation: &[i64],
) -> Result<CholmodOrdering> {
    let n = pattern.n();
    let matrix = SymmetricView::new(pattern);
    // CAMD puts rows that it finds dense last, whatever their group, so the groups are sorted.
    let mut permutation = groups.gather(permutation);
    let mut parent = vec![0i64; n];
    let mut counts = vec![0i64; n];
    let mut work = vec![0i64; 3 * n];
    let (post, rest) = work.split_at_mut(n);
    let (first, level) = rest.split_at_mut(n);
    // SAFETY: all arrays have length n; `permutation` is a permutation of 0..n.
    unsafe {
        sys::cholmod_l_analyze_ordering(
            matrix.as_ptr(),
            sys::CHOLMOD_GIVEN as i32,
            permutation.as_mut_ptr(),
            null_mut(),
            0,
            parent.as_mut_ptr(),
            post.as_mut_ptr(),
            counts.as_mut_ptr(),
            first.as_mut_ptr(),
            level.as_mut_ptr(),
            common.as_mut(),
        );
    }
    common.check("column counts", n)?;
    let flops = common.get().fl;
    let permutation = groups.postorder(&permutation, &parent, &counts);
    Ok(CholmodOrdering {
        name,
        permutation,
        flops,
    })
}

/// Finds an approximate minimum degree ordering with the groups as constraint sets.
fn minimum_degree(
    common: &mut Common,
    pattern: &Pattern,
    groups: &Groups,
) -> Result<CholmodOrdering> {
    let mut member = sets(groups, |_| 0);
    let permutation = constrained_degree(common, pattern, &mut member)?;
    complete(common, pattern, groups, "CAMD", &permutation)
}

/// Finds an ordering by nested dissection of interior and zone, followed by minimum degree within
/// each part; separators come after the parts that they separate, group after group. A single
/// elimination covers all parts, so that each is ordered by the fill that really occurs.
///
/// Zone freedoms that touch the interior are all coupled with one another once the interior is
/// eliminated, whatever the ordering: they take no part in the dissection and come last in the
/// zone.
fn dissection(common: &mut Common, pattern: &Pattern, groups: &Groups) -> Result<CholmodOrdering> {
    let border = groups.border(pattern);
    let mut parts = vec![BORDER; pattern.n()];
    for group in 0..2 {
        let is_in = |j: usize| groups.of(j) == group && !border[j];
        let (local, columns, rows) = pattern.block(is_in);
        if columns.len() < 2 {
            continue;
        }
        let part = parts_of(common, &Pattern::from_parts(&columns, &rows))?;
        for (own, &local) in parts.iter_mut().zip(&local) {
            if let Ok(local) = usize::try_from(local) {
                *own = part[local];
            }
        }
    }
    let mut member = sets(groups, |j| parts[j]);
    let permutation = constrained_degree(common, pattern, &mut member)?;
    complete(
        common,
        pattern,
        groups,
        "nested dissection + CAMD",
        &permutation,
    )
}

/// Finds the part of each column of a matrix by nested dissection; separators come after their
/// parts.
fn parts_of(common: &mut Common, block: &Pattern) -> Result<Vec<i64>> {
    let n = block.n();
    let block = SymmetricView::new(block);
    let mut permutation = vec![0i64; n];
    let mut parent = vec![0i64; n];
    let mut part = vec![0i64; n];
    let parts = {
        let _alone = METIS.lock().unwrap_or_else(PoisonError::into_inner);
        let method = &mut common.as_mut().method[0];
        // Only the parts are needed here: CAMD runs once, on all freedoms.
        let camd = std::mem::replace(&mut method.nd_camd, 0);
        // SAFETY: all arrays have length n, the order of `block`.
        let parts = unsafe {
            sys::cholmod_l_nested_dissection(
                block.as_ptr(),
                null_mut(),
                0,
                permutation.as_mut_ptr(),
                parent.as_mut_ptr(),
                part.as_mut_ptr(),
                common.as_mut(),
            )
        };
        common.as_mut().method[0].nd_camd = camd;
        parts
    };
    common.check("nested dissection", n)?;
    if parts < 0 {
        // METIS has 32-bit numbers if the distribution built it that way.
        return Err(Error::analysis(format!(
            "a graph of {n} nodes is too large for METIS: use a coarser mesh"
        )));
    }
    Ok(part)
}

/// Constraint set of each freedom: the parts of the interior, the parts of the zone, the contact
/// freedoms. CAMD requires numbers without gaps.
fn sets(groups: &Groups, part: impl Fn(usize) -> i64) -> Vec<i64> {
    let set = |(j, &group): (usize, &u8)| match group {
        2 => (2, 0),
        _ => (group, part(j)),
    };
    let sets: Vec<(u8, i64)> = groups.members().iter().enumerate().map(set).collect();
    let mut used = sets.clone();
    used.sort_unstable();
    used.dedup();
    let number = |set: &(u8, i64)| used.partition_point(|other| other < set) as i64;
    sets.iter().map(number).collect()
}

/// Orders by CAMD: freedoms of a lower set come before those of a higher set.
fn constrained_degree(
    common: &mut Common,
    pattern: &Pattern,
    member: &mut [i64],
) -> Result<Vec<i64>> {
    let n = pattern.n();
    let matrix = SymmetricView::new(pattern);
    let mut permutation = vec![0i64; n];
    // SAFETY: both arrays have length n, and the sets are numbered from 0 to at most n - 1.
    unsafe {
        sys::cholmod_l_camd(
            matrix.as_ptr(),
            null_mut(),
            0,
            member.as_mut_ptr(),
            permutation.as_mut_ptr(),
            common.as_mut(),
        );
    }
    common.check("ordering", n)?;
    Ok(permutation)
}

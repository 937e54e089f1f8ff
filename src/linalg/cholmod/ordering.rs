//! The fill-reducing order `[ interior | zone | contact ]`.
//!
//! | candidate | how | good for |
//! |---|---|---|
//! | `CAMD` | approximate minimum degree, the groups as constraints | plane meshes |
//! | `nested dissection + CAMD` | separators of the interior as further constraints | solid meshes |
//!
//! The candidate with the fewest floating point operations is kept. Both order supervariables
//! (`supervariables`).

use super::common::Common;
use super::sparse::SymmetricView;
use super::supervariables::Supervariables;
use crate::error::Result;
use crate::linalg::Partition;
use std::ptr::null_mut;
use std::sync::{Mutex, PoisonError};
use suitesparse_sys as sys;

/// The second candidate is tried where the first needs more than this many operations per stored
/// entry of the matrix: below, finding the other order takes longer than it could save.
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

/// METIS draws from the random numbers of the C library, which all threads share: one caller at a
/// time, so that the same matrix always gets the same order.
static METIS: Mutex<()> = Mutex::new(());

/// The group of each freedom: 0 interior, 1 zone, 2 contact.
pub(super) struct Groups {
    member: Vec<u8>,
    sizes: [usize; 3],
}

impl Groups {
    /// The groups of a valid partition.
    pub(super) fn new(partition: &Partition) -> Self {
        let mut member = vec![0; partition.n];
        for &freedom in &partition.zone {
            member[freedom] = 1;
        }
        for &freedom in &partition.contact {
            member[freedom] = 2;
        }
        Groups::from_members(member)
    }

    /// The groups of freedoms, each given as the number of its group.
    pub(super) fn from_members(member: Vec<u8>) -> Self {
        let mut sizes = [0; 3];
        for &group in &member {
            sizes[usize::from(group)] += 1;
        }
        Groups { member, sizes }
    }

    /// The number of a freedom's group.
    pub(super) fn of(&self, freedom: usize) -> u8 {
        self.member[freedom]
    }

    /// First column of each group, and the number of freedoms.
    pub(super) fn starts(&self) -> [usize; 4] {
        let [interior, zone, contact] = self.sizes;
        [0, interior, interior + zone, interior + zone + contact]
    }

    /// True where `permutation` lists the groups one after the other.
    pub(super) fn are_contiguous(&self, permutation: &[i64]) -> bool {
        let starts = self.starts();
        permutation.len() == starts[3]
            && (0..3).all(|group| {
                permutation[starts[group]..starts[group + 1]]
                    .iter()
                    .all(|&freedom| usize::from(self.member[freedom as usize]) == group)
            })
    }

    /// Stable sort of `permutation` by group.
    fn gather(&self, permutation: &[i64]) -> Vec<i64> {
        let mut next = self.starts();
        let mut gathered = vec![0; permutation.len()];
        for &freedom in permutation {
            let place = &mut next[usize::from(self.member[freedom as usize])];
            gathered[*place] = freedom;
            *place += 1;
        }
        gathered
    }
}

/// A fill-reducing order and what it costs.
pub(super) struct Ordering {
    /// Name for reports.
    pub(super) name: &'static str,
    /// Freedom of each column of the factor.
    pub(super) permutation: Vec<i64>,
    flops: f64,
}

/// How the order is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// The candidate with the fewest floating point operations; the dear one only where it may pay.
    #[default]
    Automatic,
    /// Constrained approximate minimum degree.
    MinimumDegree,
    /// Nested dissection of the interior, then constrained minimum degree.
    Dissection,
}

/// Finds the order.
pub(super) fn choose(
    common: &mut Common,
    matrix: &SymmetricView,
    groups: &Groups,
    method: Method,
) -> Result<Ordering> {
    let compressed = Supervariables::find(matrix, groups);
    let (pattern, groups) = (compressed.pattern(), compressed.groups());
    // As many operations has the whole matrix for one of the pattern.
    let scale = compressed.size().powi(3);
    let entries = matrix.rows().len() as f64;
    let dear = |order: &Ordering| scale * order.flops > TRY_DISSECTION_ABOVE * entries;
    let mut order = match method {
        Method::Dissection => dissection(common, &pattern, groups)?,
        _ => minimum_degree(common, &pattern, groups)?,
    };
    if method == Method::Automatic && dear(&order) {
        let other = dissection(common, &pattern, groups)?;
        if other.flops < order.flops {
            order = other;
        }
    }
    order.permutation = compressed.expand(&order.permutation);
    Ok(order)
}

/// Puts the groups of an order together, counts its operations, and postorders it.
fn complete(
    common: &mut Common,
    matrix: &SymmetricView,
    groups: &Groups,
    name: &'static str,
    permutation: &[i64],
) -> Result<Ordering> {
    let n = matrix.n();
    // Rows that CAMD finds dense it orders last whatever their group: sort.
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
    let permutation = postorder_by_group(&permutation, &parent, &counts, groups);
    Ok(Ordering {
        name,
        permutation,
        flops,
    })
}

/// Approximate minimum degree with the groups as constraint sets.
fn minimum_degree(
    common: &mut Common,
    matrix: &SymmetricView,
    groups: &Groups,
) -> Result<Ordering> {
    // CAMD wants its sets numbered without gaps.
    let mut number = [0i64; 3];
    let mut next = 0;
    for (set, &size) in number.iter_mut().zip(&groups.sizes) {
        *set = next;
        next += i64::from(size > 0);
    }
    let mut member: Vec<i64> = groups
        .member
        .iter()
        .map(|&group| number[usize::from(group)])
        .collect();
    let permutation = constrained_degree(common, matrix, &mut member)?;
    complete(common, matrix, groups, "CAMD", &permutation)
}

/// Nested dissection of the interior; then minimum degree within each part, the separators after
/// the parts they separate, then the zone, then the contact freedoms. One elimination runs through
/// all of them, so that the zone is ordered by the fill it really gets.
fn dissection(common: &mut Common, matrix: &SymmetricView, groups: &Groups) -> Result<Ordering> {
    let interior = groups.sizes[0];
    if interior == 0 {
        return minimum_degree(common, matrix, groups);
    }
    let (local, columns, rows) = interior_pattern(matrix, groups);
    let block = SymmetricView::from_parts(&columns, &rows);
    let mut permutation = vec![0i64; interior];
    let mut parent = vec![0i64; interior];
    let mut part = vec![0i64; interior];
    let parts = {
        let _alone = METIS.lock().unwrap_or_else(PoisonError::into_inner);
        let method = &mut common.as_mut().method[0];
        // Only the parts are wanted here: CAMD runs once, below, on all freedoms.
        let camd = std::mem::replace(&mut method.nd_camd, 0);
        // SAFETY: all arrays have length `interior`, the order of `block`.
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
    common.check("nested dissection", interior)?;
    let mut member: Vec<i64> = groups
        .member
        .iter()
        .zip(&local)
        .map(|(&group, &local)| match group {
            0 => part[local as usize],
            1 => parts,
            _ => parts + i64::from(groups.sizes[1] > 0),
        })
        .collect();
    let permutation = constrained_degree(common, matrix, &mut member)?;
    complete(
        common,
        matrix,
        groups,
        "nested dissection + CAMD",
        &permutation,
    )
}

/// CAMD: freedoms of a lower set come before those of a higher one.
fn constrained_degree(
    common: &mut Common,
    matrix: &SymmetricView,
    member: &mut [i64],
) -> Result<Vec<i64>> {
    let n = matrix.n();
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

/// Number of each freedom within the interior, and the pattern of the interior block.
fn interior_pattern(matrix: &SymmetricView, groups: &Groups) -> (Vec<i64>, Vec<i64>, Vec<i64>) {
    let mut local = vec![-1i64; matrix.n()];
    let mut next = 0;
    for (number, &group) in local.iter_mut().zip(&groups.member) {
        if group == 0 {
            *number = next;
            next += 1;
        }
    }
    let mut columns = Vec::with_capacity(groups.sizes[0] + 1);
    let mut rows = Vec::new();
    columns.push(0);
    for (j, bounds) in matrix.columns().windows(2).enumerate() {
        if local[j] < 0 {
            continue;
        }
        let column = &matrix.rows()[bounds[0] as usize..bounds[1] as usize];
        rows.extend(
            column
                .iter()
                .map(|&row| local[row as usize])
                .filter(|&row| row >= 0),
        );
        columns.push(rows.len() as i64);
    }
    (local, columns, rows)
}

/// Postorders the elimination tree within each group, the child with the most nonzeros last, so
/// that columns of the same structure become neighbours and form supernodes. Fill is not changed.
///
/// CHOLMOD's own postorder would follow the tree across groups: a part of the interior that hangs
/// on a contact freedom alone would come after the zone.
fn postorder_by_group(
    permutation: &[i64],
    parent: &[i64],
    counts: &[i64],
    groups: &Groups,
) -> Vec<i64> {
    const NONE: u32 = u32::MAX;
    let n = permutation.len();
    let starts = groups.starts();
    let group_end =
        |column: usize| starts[usize::from(groups.member[permutation[column] as usize]) + 1];
    // Children are put in front of their siblings, so the list ends as the reverse of this one. The
    // sort is stable: equals keep the order that the method gave them.
    let mut by_count: Vec<u32> = (0..n as u32).rev().collect();
    by_count.sort_by_key(|&column| std::cmp::Reverse(counts[column as usize]));
    let mut first_child = vec![NONE; n];
    let mut sibling = vec![NONE; n];
    for &child in &by_count {
        let up = parent[child as usize];
        if up >= 0 && (up as usize) < group_end(child as usize) {
            sibling[child as usize] = first_child[up as usize];
            first_child[up as usize] = child;
        }
    }
    let mut ordered = Vec::with_capacity(n);
    let mut stack = Vec::new();
    for (root, &up) in parent.iter().enumerate() {
        if up >= 0 && (up as usize) < group_end(root) {
            continue;
        }
        stack.push(root as u32);
        while let Some(&column) = stack.last() {
            let child = first_child[column as usize];
            if child == NONE {
                stack.pop();
                ordered.push(permutation[column as usize]);
            } else {
                first_child[column as usize] = sibling[child as usize];
                stack.push(child);
            }
        }
    }
    ordered
}

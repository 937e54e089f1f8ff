//! Groups of freedoms in an ordering `[ interior | zone | contact ]`.

use super::Pattern;
use crate::linalg::Partition;

/// Group of each freedom: 0 interior, 1 zone, 2 contact.
pub(crate) struct Groups {
    member: Vec<u8>,
    sizes: [usize; 3],
}

impl Groups {
    /// Makes the groups of a valid partition.
    pub(crate) fn new(partition: &Partition) -> Self {
        let mut member = vec![0; partition.n];
        for &freedom in &partition.zone {
            member[freedom] = 1;
        }
        for &freedom in &partition.contact {
            member[freedom] = 2;
        }
        Groups::from_members(member)
    }

    /// Makes the groups from the group number of each freedom.
    pub(crate) fn from_members(member: Vec<u8>) -> Self {
        let mut sizes = [0; 3];
        for &group in &member {
            sizes[usize::from(group)] += 1;
        }
        Groups { member, sizes }
    }

    /// For each freedom, whether it is a zone freedom that is coupled with the interior.
    pub(crate) fn border(&self, pattern: &Pattern) -> Vec<bool> {
        let mut border = vec![false; pattern.n()];
        for j in 0..pattern.n() {
            for &row in pattern.column(j) {
                let i = row as usize;
                match (self.of(i), self.of(j)) {
                    (0, 1) => border[j] = true,
                    (1, 0) => border[i] = true,
                    _ => {}
                }
            }
        }
        border
    }

    /// Number of a freedom's group.
    pub(crate) fn of(&self, freedom: usize) -> u8 {
        self.member[freedom]
    }

    /// Number of every freedom's group.
    #[cfg(feature = "cholmod")]
    pub(crate) fn members(&self) -> &[u8] {
        &self.member
    }

    /// First column of each group, followed by the number of freedoms.
    pub(crate) fn starts(&self) -> [usize; 4] {
        let [interior, zone, contact] = self.sizes;
        [0, interior, interior + zone, interior + zone + contact]
    }

    /// Whether `permutation` lists the groups one after the other.
    pub(crate) fn are_contiguous(&self, permutation: &[i64]) -> bool {
        let starts = self.starts();
        permutation.len() == starts[3]
            && (0..3).all(|group| {
                permutation[starts[group]..starts[group + 1]]
                    .iter()
                    .all(|&freedom| usize::from(self.member[freedom as usize]) == group)
            })
    }

    /// Sorts `permutation` by group, keeping the sequence within each group.
    #[cfg(feature = "cholmod")]
    pub(crate) fn gather(&self, permutation: &[i64]) -> Vec<i64> {
        let mut next = self.starts();
        let mut gathered = vec![0; permutation.len()];
        for &freedom in permutation {
            let place = &mut next[usize::from(self.member[freedom as usize])];
            gathered[*place] = freedom;
            *place += 1;
        }
        gathered
    }

    /// Postorders the elimination tree within each group, the child with the most nonzeros last, so
    /// that columns of the same structure become neighbours and form supernodes. The fill does not
    /// change.
    ///
    /// A postorder of the whole tree would cross groups: a part of the interior that depends on a
    /// contact freedom alone would come after the zone.
    pub(crate) fn postorder(
        &self,
        permutation: &[i64],
        parent: &[i64],
        counts: &[i64],
    ) -> Vec<i64> {
        const NONE: u32 = u32::MAX;
        let n = permutation.len();
        let starts = self.starts();
        let group_end =
            |column: usize| starts[usize::from(self.member[permutation[column] as usize]) + 1];
        // Children are inserted before their siblings, so each list of children ends up in the
        // reverse order of `by_count`. The sort is stable: equal counts keep the sequence of the
        // given ordering.
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
}

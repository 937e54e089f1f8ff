//! Classes of members that are joined pair by pair (union-find).

/// Disjoint classes of `0..n` (union-find; R. E. Tarjan, J. ACM 22 (1975) 215-225).
pub(crate) struct Classes {
    /// For each member a member of its class with no larger number; the first member of a class
    /// refers to itself.
    parent: Vec<u32>,
}

impl Classes {
    /// Makes classes with one member each.
    pub(crate) fn new(n: usize) -> Self {
        Classes {
            parent: (0..n as u32).collect(),
        }
    }

    /// Merges the classes of two members.
    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first(a), self.first(b));
        self.parent[a.max(b)] = a.min(b) as u32;
    }

    /// Finds the first member of a member's class, and halves the path to it.
    pub(crate) fn first(&mut self, mut member: usize) -> usize {
        loop {
            let above = self.parent[member] as usize;
            if above == member {
                return member;
            }
            let next = self.parent[above];
            self.parent[member] = next;
            member = next as usize;
        }
    }

    /// For each member the first member of its class.
    pub(crate) fn firsts(mut self) -> Vec<usize> {
        (0..self.parent.len()).map(|i| self.first(i)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_joined_has_the_first_of_all() {
        let mut classes = Classes::new(7);
        for (a, b) in [(4, 2), (6, 5), (2, 6), (1, 3)] {
            classes.join(a, b);
        }
        assert_eq!(classes.firsts(), [0, 1, 2, 1, 2, 2, 2]);
    }
}

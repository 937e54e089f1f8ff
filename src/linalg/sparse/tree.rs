//! Disjoint subtrees of an elimination tree, which different threads may solve at the same time.

use std::ops::Range;

/// Largest fraction of all work that a subtree may have: 16 pieces keep two to eight threads busy,
/// however the work is distributed over the tree.
const LARGEST_SHARE: f64 = 1.0 / 16.0;
/// Work (nonzeros) below which a subtree is not worth giving to a thread.
const SMALLEST: u64 = 20_000;

/// A postordered forest: every subtree is a contiguous range that ends with its root.
pub(crate) struct Forest<'a> {
    /// Parent of each node, `usize::MAX` for a root.
    pub(crate) parent: &'a [usize],
    /// Work of each node.
    pub(crate) work: &'a [u64],
}

impl Forest<'_> {
    /// Finds disjoint subtrees, ascending, that together hold most of the work. Each of the
    /// remaining nodes is an ancestor of subtrees or belongs to a tree too small to count. The
    /// choice depends on the tree alone, not on the number of threads. Empty if the tree is small
    /// or not postordered.
    pub(crate) fn subtrees(&self) -> Vec<Range<usize>> {
        let n = self.parent.len();
        let mut first: Vec<usize> = (0..n).collect();
        let mut work = self.work.to_vec();
        let mut size = vec![1usize; n];
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); n];
        let mut roots = Vec::new();
        for node in 0..n {
            match self.parent[node] {
                usize::MAX => roots.push(node),
                parent if parent <= node || parent >= n => return Vec::new(),
                parent => {
                    first[parent] = first[parent].min(first[node]);
                    work[parent] += work[node];
                    size[parent] += size[node];
                    children[parent].push(node);
                }
            }
        }
        let total: u64 = roots.iter().map(|&root| work[root]).sum();
        let most = ((total as f64 * LARGEST_SHARE) as u64).max(SMALLEST);
        let mut found = Vec::new();
        while let Some(node) = roots.pop() {
            if work[node] > most {
                roots.extend(&children[node]);
            } else if work[node] >= SMALLEST {
                if node + 1 - first[node] != size[node] {
                    return Vec::new();
                }
                found.push(first[node]..node + 1);
            }
        }
        found.sort_unstable_by_key(|range| range.start);
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A complete binary tree in postorder, `levels` deep, with equal work at every node.
    fn binary(levels: u32, parent: &mut Vec<usize>) -> usize {
        if levels == 0 {
            return usize::MAX;
        }
        let children = [binary(levels - 1, parent), binary(levels - 1, parent)];
        parent.push(usize::MAX);
        let node = parent.len() - 1;
        for child in children.into_iter().filter(|c| *c != usize::MAX) {
            parent[child] = node;
        }
        node
    }

    #[test]
    fn a_binary_tree_is_cut_into_its_subtrees() {
        let mut parent = Vec::new();
        binary(10, &mut parent);
        let work = vec![1_000; parent.len()];
        let forest = Forest {
            parent: &parent,
            work: &work,
        };
        let subtrees = forest.subtrees();
        // 1023 nodes: subtrees of 63 nodes are the largest below a sixteenth of them.
        assert_eq!(subtrees.len(), 16);
        assert!(subtrees.iter().all(|range| range.len() == 63));
        for range in &subtrees {
            let root = range.end - 1;
            assert!(
                range
                    .clone()
                    .all(|node| node == root || range.contains(&parent[node]))
            );
        }
        assert!(subtrees.windows(2).all(|pair| pair[0].end <= pair[1].start));
    }

    #[test]
    fn a_chain_and_a_small_tree_are_left_whole() {
        let chain: Vec<usize> = (1..100).chain([usize::MAX]).collect();
        let cut = |work: u64| {
            Forest {
                parent: &chain,
                work: &vec![work; 100],
            }
            .subtrees()
        };
        assert!(cut(10).is_empty());
        // Two threads could share no more than a sixteenth of the chain.
        assert_eq!(cut(100_000).len(), 1);
    }

    #[test]
    fn a_tree_out_of_postorder_is_left_whole() {
        // Nodes 0 and 2 are children of 3, node 1 is a child of 4, and 3 and 4 are children of 5:
        // the subtree of 3 is not contiguous, since 1 is not part of it.
        let forest = Forest {
            parent: &[3, 4, 3, 5, 5, usize::MAX],
            work: &[30_000; 6],
        };
        assert!(
            forest.subtrees().iter().all(|range| range.len() <= 1) || forest.subtrees().is_empty()
        );
    }
}

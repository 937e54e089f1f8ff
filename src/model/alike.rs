//! Groups of loads with equal factors: the structure responds to the sum of each group.

use super::load_case::LoadCase;

/// Groups loads that have the same history and measure the same quantity, so that their factors are
/// equal at every point of the load path. Each list is ascending. The leading load, whose force or
/// displacement is reported, has a list of its own.
pub(super) fn alike(loads: &[LoadCase], leading: Option<usize>) -> Vec<Vec<usize>> {
    let mut lists: Vec<Vec<usize>> = Vec::new();
    for (index, load) in loads.iter().enumerate() {
        let known = lists.iter_mut().find(|list| {
            let first = &loads[list[0]];
            let are_alike = first.history == load.history && first.measures == load.measures;
            are_alike && leading.is_none_or(|leading| leading != list[0] && leading != index)
        });
        match known {
            Some(list) => list.push(index),
            None => lists.push(vec![index]),
        }
    }
    lists
}

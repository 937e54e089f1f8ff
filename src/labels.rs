//! Finds the index of an item by the number that its file gives it.

use std::collections::HashMap;

/// Index of items by their numbers: a table if the numbers are dense, otherwise a map.
pub(crate) enum LabelIndex {
    /// Index by number; `u32::MAX` for unused numbers.
    Table(Vec<u32>),
    /// Hash map, for widely spread numbers.
    Map(HashMap<u64, u32>),
}

impl Default for LabelIndex {
    fn default() -> Self {
        LabelIndex::Table(Vec::new())
    }
}

impl LabelIndex {
    /// Indexes fewer than `u32::MAX` numbers by their position.
    ///
    /// # Errors
    /// The first number that occurs twice.
    pub(crate) fn new(labels: &[u64]) -> Result<LabelIndex, u64> {
        let largest = labels.iter().copied().max().unwrap_or(0);
        if largest <= 8 * labels.len() as u64 + 1024 {
            let mut table = vec![u32::MAX; largest as usize + 1];
            for (index, &label) in labels.iter().enumerate() {
                let entry = &mut table[label as usize];
                if *entry != u32::MAX {
                    return Err(label);
                }
                *entry = index as u32;
            }
            return Ok(LabelIndex::Table(table));
        }
        let mut map = HashMap::with_capacity(labels.len());
        for (index, &label) in labels.iter().enumerate() {
            if map.insert(label, index as u32).is_some() {
                return Err(label);
            }
        }
        Ok(LabelIndex::Map(map))
    }

    /// Index of the item with a number.
    pub(crate) fn get(&self, label: u64) -> Option<u32> {
        match self {
            LabelIndex::Table(table) => {
                let index = *table.get(usize::try_from(label).ok()?)?;
                (index != u32::MAX).then_some(index)
            }
            LabelIndex::Map(map) => map.get(&label).copied(),
        }
    }
}

//! The entities of a file of version 4.1: the physical groups of each, and the parts of a
//! partitioned mesh that the file holds.

use super::cursor::Cursor;
use crate::Result;
use std::collections::{BTreeSet, HashMap};

/// Physical tags by entity (dimension, tag).
#[derive(Debug, Default)]
pub(super) struct Entities {
    tags: HashMap<(u64, i64), Vec<u64>>,
}

impl Entities {
    /// Physical tags of an entity.
    pub(super) fn groups(&self, dimension: u64, entity: i64) -> &[u64] {
        (self.tags.get(&(dimension, entity))).map_or(&[], Vec::as_slice)
    }

    /// Reads `$Entities`.
    pub(super) fn read(&mut self, cursor: &mut Cursor) -> Result<()> {
        for (dimension, count) in read_counts(cursor)?.into_iter().enumerate() {
            for _ in 0..count {
                let tag = cursor.signed("the tag of an entity")?;
                let groups = read_groups(cursor, dimension)?;
                self.tags.insert((dimension as u64, tag), groups);
            }
        }
        Ok(())
    }

    /// Reads `$PartitionedEntities`, the pieces into which the entities were cut. A piece belongs
    /// to the groups of its entity. The interfaces between pieces have a lower dimension and belong
    /// to no group.
    pub(super) fn read_partitioned(&mut self, cursor: &mut Cursor) -> Result<()> {
        let header = cursor.at();
        let announced = cursor.count("the number of partitions")?;
        cursor.end_line()?;
        let ghosts = cursor.count("the number of ghost entities")?;
        cursor.end_line()?;
        for _ in 0..ghosts {
            cursor.signed("the tag of a ghost entity")?;
            cursor.signed("the partition of a ghost entity")?;
            cursor.end_line()?;
        }
        let mut partitions = Partitions::default();
        for (dimension, count) in read_counts(cursor)?.into_iter().enumerate() {
            for _ in 0..count {
                let tag = cursor.signed("the tag of an entity")?;
                let parent = cursor.small("the dimension of the parent entity")?;
                cursor.signed("the tag of the parent entity")?;
                let n = cursor.count("the number of partitions of an entity")?;
                let mut of_piece = 0;
                for _ in 0..n {
                    of_piece = cursor.signed("the partition of an entity")?.unsigned_abs();
                }
                let mut groups = read_groups(cursor, dimension)?;
                if parent != dimension as u64 {
                    groups.clear();
                } else if n == 1 {
                    partitions.add(of_piece);
                }
                self.tags.insert((dimension as u64, tag), groups);
            }
        }
        partitions.require_all(announced as u64, cursor, header)
    }
}

/// Reads the numbers of points, curves, surfaces and volumes.
fn read_counts(cursor: &mut Cursor) -> Result<[usize; 4]> {
    let mut counts = [0; 4];
    for (count, what) in counts.iter_mut().zip([
        "the number of points",
        "the number of curves",
        "the number of surfaces",
        "the number of volumes",
    ]) {
        *count = cursor.count(what)?;
    }
    cursor.end_line()?;
    Ok(counts)
}

/// Reads the rest of an entity after its tags, and returns its physical groups.
fn read_groups(cursor: &mut Cursor, dimension: usize) -> Result<Vec<u64>> {
    // A point has its position here, any other entity its bounding box.
    for _ in 0..if dimension == 0 { 3 } else { 6 } {
        cursor.float("a coordinate of an entity")?;
    }
    let n = cursor.count("the number of physical tags")?;
    let mut tags = Vec::new();
    for _ in 0..n {
        let tag = cursor.signed("a physical tag")?.unsigned_abs();
        if !tags.contains(&tag) {
            tags.push(tag);
        }
    }
    // The bounding entities that follow are not needed.
    if !cursor.is_binary() {
        cursor.rest_of_line();
    } else if dimension > 0 {
        for _ in 0..cursor.count("the number of bounding entities")? {
            cursor.signed("a bounding entity")?;
        }
    }
    Ok(tags)
}

/// The partitions of which a file holds elements.
#[derive(Debug, Default)]
pub(super) struct Partitions {
    held: BTreeSet<u64>,
}

impl Partitions {
    /// Records that the file has elements of a partition; 0 means no partition.
    pub(super) fn add(&mut self, partition: u64) {
        if partition != 0 {
            self.held.insert(partition);
        }
    }

    /// Requires elements of each of at least `announced` partitions if the mesh is partitioned;
    /// `at` is the place for the message. At least two partitions are required, because Gmsh never
    /// makes a single one.
    ///
    /// # Errors
    /// `Input` if a partition has no elements: the file is then one of several.
    pub(super) fn require_all(&self, announced: u64, cursor: &Cursor, at: usize) -> Result<()> {
        let Some(&largest) = self.held.last() else {
            return Ok(());
        };
        let n = announced.max(largest).max(2);
        match (1..=n).find(|partition| !self.held.contains(partition)) {
            None => Ok(()),
            Some(missing) => Err(cursor.error_at(
                at,
                format!(
                    "the mesh is partitioned, and partition {missing} is not in this file: save \
                     all of it in one (without -part_split, Mesh.PartitionSplitMeshFiles = 0)"
                ),
            )),
        }
    }
}

//! Partitioned meshes: the pieces in a file are joined, and a file that holds only some of them is
//! refused.

use super::refusals::refused;
use super::*;
use std::fmt::Write;

/// Two bodies of three squares each in a row, in version 4.1 as Gmsh writes it. Each square is a
/// partition of its own, or none. Pieces have numbers of their own, the lines between them are
/// entities that carry the group of the body, and ghost elements follow. `kept` lists the
/// partitions that the file holds.
pub(super) fn row(partitioned: bool, kept: &[usize]) -> String {
    let mut entities = String::from("$Entities\n0 2 2 0\n");
    for (tag, from) in [(1, 0), (2, 3)] {
        writeln!(
            entities,
            "{tag} {from} 0 0 {} 0 0 1 {} 0",
            from + 3,
            6 + tag
        )
        .unwrap();
    }
    for (tag, from) in [(1, 0), (2, 3)] {
        writeln!(entities, "{tag} {from} 0 0 {} 1 0 1 {tag} 0", from + 3).unwrap();
    }
    entities += "$EndEntities\n";
    let body = |square: usize| 1 + square / 3;
    if partitioned {
        let n = kept.len();
        entities += "$PartitionedEntities\n6\n1\n99 1\n";
        writeln!(entities, "1 {} {n} 0", n + 1).unwrap();
        entities += "33 1 1 2 1 2 1 0 0 1 7\n";
        for &p in kept {
            let (x, b) = (p - 1, body(p - 1));
            writeln!(
                entities,
                "{} 1 {b} 1 {p} {x} 0 0 {p} 0 0 1 {} 0",
                10 + p,
                6 + b
            )
            .unwrap();
        }
        entities += "44 2 1 2 1 2 1 0 0 1 1 0 1 1 0\n";
        for &p in kept {
            let (x, b) = (p - 1, body(p - 1));
            writeln!(entities, "{} 2 {b} 1 {p} {x} 0 0 {p} 1 0 1 {b} 0", 20 + p).unwrap();
        }
        entities += "$EndPartitionedEntities\n";
    }
    let mut out = format!(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n1 7 \"left.floor\"\n1 8 \
         \"right.floor\"\n2 1 \"left\"\n2 2 \"right\"\n$EndPhysicalNames\n{entities}"
    );
    out += "$Nodes\n1 14 1 14\n2 1 0 14\n";
    (1..=14).for_each(|node| writeln!(out, "{node}").unwrap());
    (0..14).for_each(|node| writeln!(out, "{} {} 0", node / 2, node % 2).unwrap());
    let line = usize::from(partitioned);
    let n = kept.len();
    let all = 2 * n + line;
    writeln!(out, "$EndNodes\n$Elements\n{} {all} 1 99", all).unwrap();
    let entity = |p: usize, piece: usize| if partitioned { piece + p } else { body(p - 1) };
    for &p in kept {
        writeln!(
            out,
            "1 {} 1 1\n{p} {} {}",
            entity(p, 10),
            2 * p - 1,
            2 * p + 1
        )
        .unwrap();
    }
    if partitioned {
        out += "1 44 1 1\n99 3 4\n";
    }
    for &p in kept {
        let [a, b, c, d] = [2 * p - 1, 2 * p + 1, 2 * p + 2, 2 * p];
        writeln!(out, "2 {} 3 1\n{} {a} {b} {c} {d}", entity(p, 20), 6 + p).unwrap();
    }
    out += "$EndElements\n";
    if partitioned {
        out += "$GhostElements\n1\n8 2 1 1\n$EndGhostElements\n";
    }
    out
}

pub(super) const ALL: [usize; 6] = [1, 2, 3, 4, 5, 6];

#[test]
fn pieces_of_a_mesh_are_joined_to_what_was_cut() {
    let whole = parsed(&row(false, &ALL));
    assert_eq!((whole.n_elements(), whole.bodies.len()), (6, 2));
    assert_eq!(whole.surfaces["left.floor"].facets.len(), 3);
    for text in [row(true, &ALL), row(true, &[4, 2, 6, 1, 3, 5])] {
        let mut joined = parsed(&text);
        let mut of_element: Vec<_> = (joined.element_labels.iter().zip(&joined.element_body))
            .map(|(label, body)| (*label, joined.bodies[*body as usize].clone()))
            .collect();
        of_element.sort();
        let expected: Vec<_> = (7..=12)
            .map(|label| (label, if label < 10 { "left" } else { "right" }.to_string()))
            .collect();
        assert_eq!(of_element, expected);
        for surface in joined.surfaces.values_mut() {
            assert_eq!(surface.facets.len(), 3);
        }
        // Lines between pieces are neither boundaries nor sets, although they carry the body's
        // group.
        assert_eq!(joined.surfaces.len(), 2, "{:?}", joined.surfaces.keys());
        assert_eq!(joined.node_sets.len(), whole.node_sets.len());
    }
    assert_eq!(
        format!("{:?}", parsed(&row(true, &ALL))),
        format!("{whole:?}")
    );
}

#[test]
fn one_file_of_several_is_refused() {
    for (kept, missing) in [(&ALL[..1], 2), (&ALL[1..], 1), (&ALL[..5], 6)] {
        let words = format!("partition {missing} is not in this file");
        refused(&row(true, kept), &["line 19", &words, "-part_split"]);
    }
    // Version 2.2 lists the partitions with each element: their number, then each partition.
    let both = V2
        .replace("100 3 2 4 1 ", "100 3 4 4 1 1 1 ")
        .replace("101 2 2 5 2 ", "101 2 4 5 2 1 2 ")
        .replace("102 2 2 5 2 ", "102 2 5 5 2 2 1 -2 ");
    assert_eq!(format!("{:?}", parsed(&both)), format!("{:?}", parsed(V2)));
    let one = both.replace("101 2 4 5 2 1 2 ", "101 2 4 5 2 1 1 ");
    refused(&one, &["line 23", "partition 2 is not in this file"]);
}

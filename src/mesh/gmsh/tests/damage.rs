//! Damaged files never cause a panic: they are read or refused, and a mesh that is read can be
//! validated.

use super::*;
use proptest::prelude::*;

fn survives(text: &[u8]) {
    match parse(text, "damaged.msh") {
        Ok(mesh) => {
            // A mesh that was read is consistent in itself: validation may find fault with its
            // content only.
            if let Err(error) = validate(&mesh) {
                assert!(!error.message().contains("inconsistent"), "{error}");
            }
            for surface in mesh.surfaces.values() {
                let nodes = surface::ordered_nodes(&mesh, surface).unwrap_or_default();
                assert_eq!(surface::normals(&mesh, surface, &nodes).len(), nodes.len());
            }
        }
        Err(error) => assert!(error.message().starts_with("damaged.msh, line "), "{error}"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn random_bytes(text in prop::collection::vec(any::<u8>(), 0..400)) {
        survives(&text);
        let mut with_header = b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n".to_vec();
        with_header.extend(&text);
        survives(&with_header);
    }

    #[test]
    fn a_few_bytes_changed(
        version in 0..2usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), "[0-9 .$\\-\n\"a-z]"), 1..6)
    ) {
        let mut text = [V2, V4][version].as_bytes().to_vec();
        for (place, byte) in changes {
            let at = place.index(text.len());
            text[at] = byte.as_bytes()[0];
        }
        survives(&text);
    }

    #[test]
    fn numbers_replaced(
        version in 0..2usize,
        changes in prop::collection::vec(
            (any::<prop::sample::Index>(), prop::sample::select(vec![
                "0", "1", "2", "3", "-1", "18446744073709551615", "18446744073709551616",
                "9223372036854775807", "-9223372036854775808", "1e308", "nan", "", "x",
            ])), 1..4)
    ) {
        let text = [V2, V4][version];
        let mut words: Vec<&str> = text.split_inclusive([' ', '\n']).collect();
        for (place, word) in &changes {
            let at = place.index(words.len());
            words[at] = word;
            words.insert(at + 1, " ");
        }
        survives(words.concat().as_bytes());
    }

    #[test]
    fn lines_removed_doubled_or_swapped(
        version in 0..2usize,
        changes in prop::collection::vec(
            (any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..3u8),
            1..4,
        )
    ) {
        let mut lines: Vec<&str> = [V2, V4][version].split_inclusive('\n').collect();
        for (one, other, change) in &changes {
            let (a, b) = (one.index(lines.len()), other.index(lines.len()));
            match change {
                0 => { lines.remove(a); }
                1 => lines.insert(b, lines[a]),
                _ => lines.swap(a, b),
            }
        }
        survives(lines.concat().as_bytes());
    }
}

use super::*;

pub(super) fn refused(text: &str, expected: &[&str]) -> Error {
    let error = parse(text.as_bytes(), "bad.msh").unwrap_err();
    assert!(error.message().starts_with("bad.msh, line "), "{error}");
    for part in expected {
        assert!(error.message().contains(part), "{error} lacks `{part}`");
    }
    error
}

/// Replaces the only occurrence of `old`.
fn with(text: &str, old: &str, new: &str) -> String {
    assert_eq!(text.matches(old).count(), 1, "{old}");
    text.replace(old, new)
}

#[test]
fn other_files_binary_files_and_other_versions() {
    refused("", &["line 1", "not a Gmsh mesh"]);
    refused("Point(1) = {0, 0, 0};\n", &["not a Gmsh mesh", ".geo"]);
    refused("$NOD\n1\n", &["not a Gmsh mesh"]);
    for (old, new, text) in [
        ("2.2 0 8", "2.2 1 4", "binary numbers of 4 bytes"),
        ("2.2 0 8", "4 0 8", "version 4 "),
        ("2.2 0 8", "1.0 0 8", "export the mesh as version 4.1"),
        ("2.2 0 8", "nan 0 8", "version NaN"),
    ] {
        let error = refused(&with(V2, old, new), &["line 2", text]);
        assert_eq!(error.kind(), ErrorKind::Unsupported);
    }
    // A text file that claims to be binary.
    refused(
        &with(V4, "4.1 0 8", "4.1 1 8"),
        &["line 3", "order of bytes"],
    );
    refused(
        &with(V2, "2.2 0 8", "2.2 0"),
        &["line 2", "the line ends", "size of a number"],
    );
    refused(
        &with(V2, "2.2 0 8", "new 0 8"),
        &["line 2", "expected the version, found `new`"],
    );
}

#[test]
fn element_types_that_brinell_does_not_have() {
    for (element_type, name) in [
        (7, "5-node pyramid (type 7)"),
        (21, "10-node triangle (type 21)"),
        (26, "4-node line (type 26)"),
        (93, "element (type 93)"),
    ] {
        let text = with(V2, "100 3 2 4 1", &format!("100 {element_type} 2 4 1"));
        let error = refused(&text, &["line 28", name]);
        assert_eq!(error.kind(), ErrorKind::Unsupported);
        let text = with(V4, "2 9 9 1\n3", &format!("2 9 {element_type} 1\n3"));
        let error = refused(&text, &["line 40", name]);
        assert_eq!(error.kind(), ErrorKind::Unsupported);
    }
}

#[test]
fn groups_that_are_missing_or_double() {
    refused(
        // The other element is a body, and this one is left out.
        &with(V2, "100 3 2 4 1", "100 3 2 0 1"),
        &[
            "line 24",
            "node 40 of physical point `pole` is a node of no element",
        ],
    );
    refused(
        &with(V2, "100 3 2 4 1", "100 3 0"),
        &[
            "line 24",
            "node 40 of physical point `pole` is a node of no element",
        ],
    );
    refused(
        &with(V4, "9 0 0 0 1 1 0 1 1 3", "9 0 0 0 1 1 0 0 3"),
        &["line 41", "element 3 is in no physical surface"],
    );
    refused(
        &with(V4, "9 0 0 0 1 1 0 1 1 3", "9 0 0 0 1 1 0 2 1 4 3"),
        &["line 41", "several physical surfaces (plate, 4)"],
    );
    refused(
        &with(V2, "\"pole\"", "\"bottom\""),
        &["`bottom` is the name (or number) of both"],
    );
    // Points and lines outside of groups form no sets.
    let mesh = parsed(&with(V2, "2 1 2 2 7 20 30", "2 1 2 0 7 20 30"));
    assert!(!mesh.surfaces.contains_key("soft.interface"));
}

#[test]
fn lines_and_points_that_fit_no_element() {
    refused(
        &with(V2, "3 1 2 3 8 10 20", "3 1 2 3 8 10 30"),
        &[
            "line 26",
            "node 10 to node 30",
            "`bottom`",
            "edge of no element",
        ],
    );
    refused(
        &with(V2, "3 1 2 3 8 10 20", "3 1 2 3 8 10 70"),
        &["line 26", "node 10 to node 70"],
    );
    refused(
        &with(V2, "1 15 2 1 10 40", "1 15 2 1 10 70"),
        &["line 24", "node 70", "`pole`", "no element"],
    );
    refused(
        &with(V2, "3 1 2 3 8 10 20", "3 8 2 3 8 10 20 40"),
        &["line 26", "mid-side node 40", "element 100"],
    );
    refused(
        &with(V4, "2 1 2 4 \n", "2 1 2 5 \n"),
        &["line 39", "mid-side node 5", "element 3"],
    );
}

#[test]
fn node_numbers() {
    refused(
        &with(V2, "10 20 30 40", "10 20 30 41"),
        &["line 28", "element 100 refers to node 41"],
    );
    refused(
        &with(V2, "10 20 30 40", "10 20 30 99999999999999999999"),
        &["line 28", "too large a number"],
    );
    refused(
        &with(V2, "30 1 1.0e0 0.5", "20 1 1.0e0 0.5"),
        &["node 20 is given twice"],
    );
    refused(
        &with(V4, "3\n5\n6\n0 1 0", "3\n5\n3\n0 1 0"),
        &["node 3 is given twice"],
    );
    refused(
        &with(V2, "30 1 1.0e0 0.5", "30 1 1.0e0 0.75"),
        &["node 30", "0.25", "z = 0.5"],
    );
    refused(
        &with(V2, "30 1 1.0e0 0.5", "30 1 nan 0.5"),
        &["node 30", "NaN"],
    );
    refused(
        &with(V2, "30 1 1.0e0 0.5", "30 1 1 inf"),
        &["node 30", "inf"],
    );
}

#[test]
fn malformed_lines_are_named() {
    refused(
        &with(V2, "30 1 1.0e0 0.5", "30 1 1.0e0"),
        &["line 16", "the line ends", "coordinate"],
    );
    refused(
        &with(V2, "30 1 1.0e0 0.5", "30 1 1.0e0 0.5 8"),
        &["line 16", "end of the line, found `8`"],
    );
    refused(
        &with(V2, "30 1 1.0e0 0.5", "30 1 1,0 0.5"),
        &["line 16", "found `1,0`"],
    );
    refused(
        &with(V2, "30 1 1.0e0 0.5", "-30 1 1 0.5"),
        &["line 16", "node number", "found `-30`"],
    );
    refused(
        &with(V2, "10 20 30 40", "10 20 30"),
        &["line 28", "the line ends", "node number"],
    );
    refused(
        &with(V2, "10 20 30 40", "10 20 30 40 60"),
        &["line 28", "end of the line"],
    );
    refused(
        &with(V2, "2 4 \"hard body\"", "2 4 hard body"),
        &["line 9", "double quotes"],
    );
    refused(
        &with(V2, "2 4 \"hard body\"", "2 4 \"hard"),
        &["line 9", "double quotes"],
    );
    refused(
        &with(V2, "$EndNodes", "$EndNode"),
        &["line 21", "expected $EndNodes"],
    );
    refused(
        &with(V2, "$Nodes\n7", "$Nodes\n6"),
        &["line 20", "expected $EndNodes, found `70`"],
    );
    refused(
        &with(V2, "$Nodes\n7", "$Nodes\n8"),
        &["line 21", "found `$EndNodes`"],
    );
    refused(
        &with(V2, "$Nodes\n7", "$Nodes\n100000000000"),
        &["line 13", "100000000000", "truncated"],
    );
    refused(
        &with(V4, "3 6 1 6", "3 7 1 6"),
        &["line 17", "7 nodes are announced", "hold 6"],
    );
    refused(
        &with(V4, "3 3 1 3", "3 4 1 3"),
        &["line 35", "4 elements are announced", "hold 3"],
    );
    refused(
        &with(V4, "2 9 9 1\n3", "1 5 9 1\n3"),
        &["line 40", "type 9", "dimension 1"],
    );
    refused(
        &format!("{V2}stray"),
        &["line 32", "beginning of a section", "`stray`"],
    );
}

#[test]
fn sections_that_are_missing_double_or_out_of_order() {
    let nodes = &V2[V2.find("$Nodes").unwrap()..V2.find("$Elements").unwrap()];
    let elements = &V2[V2.find("$Elements").unwrap()..];
    refused(&with(V2, nodes, ""), &["$Elements comes before $Nodes"]);
    refused(&with(V2, elements, ""), &["without a section $Elements"]);
    refused(&format!("{V2}{elements}"), &["second section $Elements"]);
    refused(
        &with(V2, nodes, &nodes.repeat(2)),
        &["second section $Nodes"],
    );
    refused(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n",
        &["without a section $Nodes"],
    );
    let lines_only = with(
        V2,
        elements,
        "$Elements\n1\n3 1 2 3 8 10 20\n$EndElements\n",
    );
    refused(&lines_only, &["no triangles or quadrilaterals"]);
}

/// A file cut off anywhere before the end of its last section is refused; the message names the
/// last line.
#[test]
fn truncated_files() {
    for text in [V2, V4] {
        let end = text.find("$EndElements").unwrap() + "$EndElements".len();
        for length in 0..end {
            let error = parse(&text.as_bytes()[..length], "cut.msh").unwrap_err();
            assert!(error.message().starts_with("cut.msh, line "), "{error}");
        }
    }
    let cut = V2.find("30 1 1.0e0").unwrap() + 4;
    refused(
        &V2[..cut],
        &["line 16", "the file ends inside $Nodes", "truncated"],
    );
    let cut = V2.find("10 20 30 40").unwrap() + 6;
    refused(
        &V2[..cut],
        &["line 28", "the file ends inside $Elements", "truncated"],
    );
    let open = format!("{V2}$NodeData\n1\n");
    refused(&open, &["the file ends inside $NodeData"]);
}

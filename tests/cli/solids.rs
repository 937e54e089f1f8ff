//! Bad input of solid scenes: named, exit code 2, nothing left behind.

use super::{Folder, brinell, scene_path, stdout};

/// Two unit cubes, one on the other; nodes 1 to 8 are the lower one's.
const CUBES: &str = include_str!("../fuzz/seeds/solid_2.msh");

const SCENE: &str = r#"
kind = "solid"
mesh.file = "mesh.msh"
contact = [{ first = "upper.bottom", second = "lower.top" }]
support = [{ on = "lower.bottom", fix = ["x", "y", "z"] }, { on = "upper.top", fix = ["x", "y"] }]
load = [{ on = "upper.top", pressure = 10.0 }]
program.targets = [{ load_factor = 1.0 }]

[materials.steel]
youngs_modulus = 1000.0
poissons_ratio = 0.3
[bodies]
lower = { material = "steel" }
upper = { material = "steel" }
"#;

/// The scene beside its mesh, in which each of `changes` (old, new) is made at its only place.
fn cubes(changes: &[(&str, &str)]) -> Folder {
    let folder = Folder::with_scene(SCENE);
    let mut mesh = CUBES.to_string();
    for (old, new) in changes {
        assert_eq!(mesh.matches(old).count(), 1, "{old:?}");
        mesh = mesh.replace(old, new);
    }
    std::fs::write(folder.path("mesh.msh"), mesh).unwrap();
    folder
}

/// The scene of a name with values put over is refused with exit code 2 and leaves nothing behind.
fn refused_with(name: &str, sets: &[&str], fragments: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let scene = scene_path(name);
    let mut arguments = vec!["run", &scene, "--quiet", "--out", out.to_str().unwrap()];
    arguments.extend(sets.iter().flat_map(|set| ["--set", set]));
    let output = brinell(&arguments);
    let stderr = String::from_utf8(output.stderr.clone()).unwrap();
    assert_eq!(output.status.code(), Some(2), "{sets:?}: {stderr}");
    for fragment in fragments {
        assert!(
            stderr.contains(fragment),
            "{sets:?}: no {fragment:?} in {stderr}"
        );
    }
    assert_eq!(stdout(&output), "");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

const LOWER: &str = "1 5 2 1 1 1 2 4 3 5 6 8 7";

#[test]
fn the_mesh_that_the_others_damage_is_taken() {
    let folder = cubes(&[]);
    let output = folder.brinell("run", &["--quiet", "--no-report", "--no-estimate"]);
    assert_eq!(output.status.code(), Some(0));
    let pressure = folder.summary()["states"][0]["max_pressure"].as_f64();
    assert!((pressure.unwrap() - 10.0).abs() < 1e-9);
}

#[test]
fn hexahedra_that_are_inverted_bent_or_flat() {
    let element = "mesh.msh: element 1 (hex8, body `lower`)";
    cubes(&[(LOWER, "1 5 2 1 1 5 6 8 7 1 2 4 3")])
        .refused(2, &[element, "inverted", "near node 5"]);
    cubes(&[("\n8 1 1 1\n", "\n8 1 1 -1\n")]).refused(2, &[element, "degenerate", "near node 1"]);
    let tops = [5, 6, 7, 8].map(|n| (n, [(n - 5) % 2, (n - 5) / 2]));
    let flat: Vec<[String; 2]> = tops
        .iter()
        .map(|(n, [x, y])| {
            [
                format!("\n{n} {x} {y} 1\n"),
                format!("\n{n} {x} {y} 1e-9\n"),
            ]
        })
        .collect();
    let mut folder_mesh = CUBES.to_string();
    for [old, new] in &flat {
        assert_eq!(folder_mesh.matches(old.as_str()).count(), 1, "{old:?}");
        folder_mesh = folder_mesh.replace(old.as_str(), new);
    }
    let folder = cubes(&[]);
    std::fs::write(folder.path("mesh.msh"), folder_mesh).unwrap();
    folder.refused(2, &[element, "is flat", "1.000e-9"]);
    refused_with(
        "square_punch",
        &["mesh.parts.0.brick.z=[0.0,1e-300]"],
        &["element 1 (hex8, body `punch`) is flat"],
    );
    refused_with(
        "square_punch",
        &["mesh.parts.0.brick.z=[1.0,0.0]"],
        &["mesh.parts.0.brick.z", "from the smaller to the larger"],
    );
}

#[test]
fn faces_without_an_element_or_a_partner() {
    // A face with a corner of the other cube.
    cubes(&[("2 3 2 2 2 1 3 4 2", "2 3 2 2 2 1 3 4 12")]).refused(
        2,
        &[
            "mesh.msh, line 35",
            "the face with the nodes 1, 3, 4, 12",
            "`lower.bottom`",
        ],
    );
    // The upper cube stands beside.
    let moved: Vec<(String, String)> = (9..17)
        .map(|n| (n, [(n - 9) % 2, (n - 9) / 2 % 2, 1 + (n - 9) / 4]))
        .map(|(n, [x, y, z])| {
            (
                format!("\n{n} {x} {y} {z}\n"),
                format!("\n{n} {} {y} {z}\n", x + 3),
            )
        })
        .collect();
    let moved: Vec<(&str, &str)> = moved.iter().map(|(a, b)| (&a[..], &b[..])).collect();
    cubes(&moved).refused(
        2,
        &[
            "contact 1 (`upper.bottom` on `lower.top`)",
            "no part of `lower.top` lies opposite `upper.bottom`",
        ],
    );
}

/// A third cube that carries the upper one's name; supports on one piece do not hold the other.
#[test]
fn a_body_in_two_pieces() {
    let nodes: String = (0..8)
        .map(|n| format!("{} {} {} {}\n", 17 + n, 5 + n % 2, n / 2 % 2, n / 4))
        .collect();
    let folder = cubes(&[
        ("$Nodes\n16\n", "$Nodes\n24\n"),
        ("$EndNodes", &format!("{nodes}$EndNodes")),
        ("$Elements\n6\n", "$Elements\n7\n"),
        (
            "$EndElements",
            "7 5 2 4 4 17 18 20 19 21 22 24 23\n$EndElements",
        ),
    ]);
    folder.refused(
        2,
        &[
            "mesh.msh: body `upper` is in several pieces",
            "node 9 at (0, 0, 1) and node 17 at (5, 0, 0)",
            "a body of its own",
        ],
    );
}

#[test]
fn pyramids_are_named_by_line() {
    cubes(&[(LOWER, "1 7 2 1 1 1 2 4 3 5")]).refused(
        2,
        &["mesh.msh, line 34", "5-node pyramid (type 7)", "tetrahedra"],
    );
}

#[test]
fn plane_meshes_in_solid_scenes_and_the_reverse() {
    refused_with(
        "gmsh_blocks",
        &["kind=solid"],
        &["the mesh is plane, kind = \"solid\" is not"],
    );
    let support = "support=[{on=\"block.bottom\",fix=[\"x\",\"y\"]}]";
    let load = "load=[{on=\"punch.top\",pressure=1.0}]";
    for kind in ["plane_strain", "plane_stress", "axisymmetric"] {
        refused_with(
            "blocks_tet10",
            &[&format!("kind={kind}"), "symmetry=1", support, load],
            &["the mesh is three-dimensional", kind],
        );
    }
    refused_with(
        "cylinder_on_half_plane",
        &["kind=solid"],
        &[
            "\"quad4\" is no element where kind = \"solid\"",
            "mesh.extrude and mesh.revolve",
        ],
    );
    refused_with(
        "cylinder_on_half_plane",
        &["mesh.extrude={depth=1.0,elements=2}"],
        &[
            "kind",
            "mesh.extrude makes a solid model",
            "kind = \"solid\"",
        ],
    );
    refused_with(
        "square_punch",
        &["kind=plane_strain"],
        &[
            "a brick is a part of a solid model",
            "\"z\" is no direction where kind = \"plane_strain\"",
        ],
    );
    refused_with(
        "cylinder_on_half_plane",
        &[
            "program.targets=[{ displacement = { on = \"cylinder.top\", direction = \"z\", value = \
             -1e-3 } }]",
        ],
        &[
            "program.targets.0.displacement.direction",
            "\"z\" is no direction where kind = \"plane_strain\"",
        ],
    );
    refused_with(
        "ball_on_flat_3d",
        &["kind=axisymmetric"],
        &["curved_bodies is a solid model"],
    );
}

/// Beyond the memory: said with the size, before anything of it is made (what does not
/// fit once it is factored ends with exit code 5).
#[test]
fn generators_beyond_the_memory() {
    let drawn = ["kind=solid", "symmetry=1"];
    for (name, sets, key) in [
        (
            "square_punch",
            vec!["mesh.parts.0.brick.elements=[100000,100000,100000]"],
            "mesh.parts",
        ),
        (
            "square_punch",
            vec!["mesh.parts.1.brick.elements=[600,600,300]"],
            "mesh.parts",
        ),
        (
            "ball_on_flat_3d",
            vec!["mesh.curved_bodies.resolution=100000"],
            "resolution",
        ),
        (
            "ball_on_flat_3d",
            vec!["mesh.curved_bodies.resolution=100"],
            "resolution",
        ),
        (
            "cylinder_on_half_plane",
            [
                &drawn[..],
                &["mesh.extrude={depth=1.0,elements=9000000000000000000}"],
            ]
            .concat(),
            "mesh.extrude",
        ),
        (
            "cylinder_on_half_plane",
            [&drawn[..], &["mesh.revolve={angle=90.0,elements=10000000}"]].concat(),
            "mesh.revolve",
        ),
    ] {
        refused_with(
            name,
            &sets,
            &[key, "the mesh would have", "elements", "ask for fewer"],
        );
    }
}

//! Bad input: each kind has a clear message, its exit code, and leaves nothing behind.

use super::{Folder, brinell, scene_path, stdout};

/// The contact patch scene with one place changed.
fn patch(old: &str, new: &str) -> Folder {
    Folder::with_changes("contact_patch", &[(old, new)])
}

/// The same with values put over, as `--set` does.
pub(super) fn refused_with(
    name: &str,
    sets: &[&str],
    more: &[&str],
    code: i32,
    fragments: &[&str],
) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let scene = scene_path(name);
    let mut arguments = vec!["run", &scene, "--quiet", "--out", out.to_str().unwrap()];
    for set in sets {
        arguments.extend(["--set", set]);
    }
    arguments.extend(more);
    let output = brinell(&arguments);
    let stderr = String::from_utf8(output.stderr.clone()).unwrap();
    assert_eq!(output.status.code(), Some(code), "{sets:?}: {stderr}");
    for fragment in fragments {
        assert!(
            stderr.contains(fragment),
            "{sets:?}: no {fragment:?} in {stderr}"
        );
    }
    assert_eq!(stdout(&output), "");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn wrong_types_and_values_of_a_material() {
    for (value, fragments) in [
        ("\"stiff\"", ["youngs_modulus", "expected a number"]),
        (
            "-210000.0",
            ["youngs_modulus", "-210000 must be greater than zero"],
        ),
        ("0.0", ["youngs_modulus", "0 must be greater than zero"]),
        ("nan", ["youngs_modulus", "not a finite number"]),
        ("inf", ["youngs_modulus", "not a finite number"]),
        ("-inf", ["youngs_modulus", "not a finite number"]),
    ] {
        let folder = patch(
            "youngs_modulus = 210000.0",
            &format!("youngs_modulus = {value}"),
        );
        folder.refused(2, &fragments);
        folder.refused(2, &["scene.toml:"]);
    }
    for value in ["0.5", "0.7", "-1.0", "nan"] {
        let folder = patch("poissons_ratio = 0.3", &format!("poissons_ratio = {value}"));
        folder.refused(2, &["materials.steel.poissons_ratio"]);
    }
}

#[test]
fn values_of_other_keys() {
    for (set, fragment) in [
        ("symmetry=0", "symmetry: 0 must be 1 (all of it is meshed)"),
        ("symmetry=-2", "symmetry"),
        ("kind=plane_strayn", "plane_strain"),
        ("program.targets=[]", "program.targets: is empty"),
        ("program.targets=[{yield=true}]", "no body can yield"),
        ("program.gamma=0.0", "program.gamma"),
        ("analysis.max_iterations=0", "analysis.max_iterations"),
        ("mesh.parts.1.block.x=[0.0,0.0]", "mesh.parts.1.block.x"),
        (
            "mesh.parts.1.block.elements=[0,4]",
            "mesh.parts.1.block.elements",
        ),
        ("contact.0.normal=[0.0,0.0]", "contact.0.normal"),
    ] {
        refused_with("contact_patch", &[set], &[], 2, &[fragment]);
    }
}

#[test]
fn unknown_keys_everywhere_are_named_with_the_likely_one() {
    for (old, new, key, meant) in [
        ("fix = [\"y\"]", "fixx = [\"y\"]", "fixx", "fix"),
        ("pressure = 10.0", "presure = 10.0", "presure", "pressure"),
        ("first = ", "frist = ", "frist", "first"),
        ("[program]", "[progam]", "progam", "program"),
    ] {
        patch(old, new).refused(
            2,
            &[
                "scene.toml:",
                &format!("unknown key `{key}`, did you mean `{meant}`?"),
            ],
        );
    }
}

#[test]
fn effects_that_brinell_has_not() {
    for (set, fragments) in [
        (
            "contact.0.friction=0.3",
            ["contact.0.friction", "no friction"],
        ),
        (
            "analysis.large_strain=true",
            [
                "analysis.large_strain",
                "strains and displacements are small",
            ],
        ),
    ] {
        refused_with("contact_patch", &[set], &[], 2, &fragments);
    }
}

#[test]
fn files_that_are_missing_or_of_another_kind() {
    refused_with(
        "contact_patch",
        &["mesh.parts=", "mesh={file=\"none.msh\"}"],
        &[],
        3,
        &["cannot read the mesh file", "none.msh", "No such file"],
    );
    refused_with(
        "contact_patch",
        &["mesh.parts=", "mesh={file=\"contact_patch.toml\"}"],
        &[],
        2,
        &["contact_patch.toml, line 1", "not a Gmsh mesh"],
    );
}

/// The Gmsh scene beside a changed copy of its mesh.
fn gmsh(old: &str, new: &str) -> Folder {
    let folder = Folder::with_changes("gmsh_blocks", &[("../meshes/two_blocks.msh", "mesh.msh")]);
    let mesh = concat!(env!("CARGO_MANIFEST_DIR"), "/data/meshes/two_blocks.msh");
    let text = std::fs::read_to_string(mesh).unwrap();
    assert_eq!(text.matches(old).count(), 1, "{old:?}");
    std::fs::write(folder.path("mesh.msh"), text.replace(old, new)).unwrap();
    folder
}

#[test]
fn duplicate_numbers_in_a_mesh_file() {
    gmsh("\n9\n10\n", "\n9\n9\n").refused(2, &["mesh.msh, line ", "9", "twice"]);
}

#[test]
fn elements_that_are_turned_inside_out_are_named() {
    // Node 13, inside the lower block, is moved out of it.
    gmsh("\n13\n14\n15\n1 -1 0\n", "\n13\n14\n15\n1 9 0\n").refused(
        2,
        &[
            "mesh.msh: element ",
            "(quad4, body `lower`)",
            "Jacobian",
            "near node ",
        ],
    );
}

#[test]
fn sets_that_are_missing_or_empty() {
    for (set, words) in [
        (
            "support.0.on=lower.botom",
            "support 1 on `lower.botom`: the mesh has no such set, did you mean `lower.bottom`?",
        ),
        (
            "contact.0.second=lower.tip",
            "contact 1 surface `lower.tip`: the mesh has no such set, did you mean `lower.top`?",
        ),
        (
            "load.0.on=upper.tp",
            "load 1 on `upper.tp`: the mesh has no such set, did you mean `upper.top`?",
        ),
        (
            "load.0.on=rim",
            "load 1 on `rim`: the mesh has no such set. It has: ",
        ),
        (
            "program.targets=[{displacement={on=\"upper.lop\",direction=\"y\",value=-1e-3}}]",
            "target 1 displacement on `upper.lop`: the mesh has no such set, did you mean \
             `upper.top`?",
        ),
    ] {
        let place = format!("error: --set {set}: {words}");
        refused_with("contact_patch", &[set], &[], 2, &[&place]);
    }
    // A piece of a side that holds no facet.
    patch(
        "block = { x = [0.0, 2.0], y = [1.0, 2.0], elements = [8, 4] }",
        "block = { x = [0.0, 2.0], y = [1.0, 2.0], elements = [8, 4], \
         pieces = [{ name = \"pad\", side = \"top\", from = 0.1, to = 0.2 }] }",
    )
    .refused(2, &["pad"]);
}

/// What is only found with the mesh is told with its line and column too.
#[test]
fn what_does_not_fit_the_mesh_is_told_with_its_place_in_the_scene() {
    // Lines of the scene that the key stands in.
    let line = |key: &str| {
        let text = std::fs::read_to_string(scene_path("contact_patch")).unwrap();
        1 + text.lines().position(|l| l.starts_with(key)).unwrap()
    };
    let place = |key: &str, column: usize| format!("scene.toml:{}:{column}: ", line(key));
    for (old, new, place, words) in [
        (
            "on = \"upper.top\"",
            "on = \"upper.up\"",
            place("on = \"upper.top\"", 1),
            "load 1 on `upper.up`",
        ),
        (
            "first = \"upper.bottom\"",
            "first = \"upper.base\"",
            place("first", 1),
            "contact 1 surface `upper.base`",
        ),
        (
            "[bodies.lower]",
            "[bodies.lowest]",
            place("[bodies.lower]", 9),
            "bodies.lowest",
        ),
        (
            "first = \"upper.bottom\"",
            "first = \"upper.left\"",
            place("[[contact]]", 1),
            "contact 1 (`upper.left` on `lower.top`)",
        ),
    ] {
        patch(old, new).refused(2, &[&format!("{place}{words}")]);
    }
    let missing = Folder::with_changes("gmsh_blocks", &[("../meshes/two_blocks.msh", "none.msh")]);
    missing.refused(
        3,
        &["scene.toml:7:1: cannot read the mesh file ", "none.msh"],
    );
    let circle = "circles = [{ on = \"lower.bottom\", radius = 1.0 }]";
    let file = "file = \"../meshes/two_blocks.msh\"\n";
    let mesh = concat!(env!("CARGO_MANIFEST_DIR"), "/data/meshes/two_blocks.msh");
    let flat = format!("file = \"{mesh}\"\n{circle}\n");
    Folder::with_changes("gmsh_blocks", &[(file, &flat)]).refused(
        2,
        &[
            "scene.toml:8:",
            "mesh.circles.0 (`lower.bottom`): node ",
            "off the circle",
        ],
    );
}

#[test]
fn a_support_across_the_axis_of_revolution() {
    refused_with(
        "contact_patch",
        &[
            "kind=axisymmetric",
            "support=[{on=\"lower.left\",fix=[\"x\"],angle=30.0}]",
        ],
        &[],
        2,
        &[
            "directions that are not at right angles",
            "the axis of revolution",
        ],
    );
}

#[test]
fn surfaces_that_do_not_face_each_other_are_named() {
    refused_with(
        "contact_patch",
        &["contact.0.first=upper.left"],
        &[],
        2,
        &[
            "contact 1 (`upper.left` on `lower.top`)",
            "no part of `lower.top` lies opposite `upper.left`",
        ],
    );
}

#[test]
fn a_slave_of_two_contacts() {
    let twice = "{ first = \"upper.bottom\", second = \"lower.top\" }";
    refused_with(
        "contact_patch",
        &[&format!("contact=[{twice},{twice}]")],
        &[],
        2,
        &["node 45 is the slave of two contacts, 1 and 2"],
    );
}

#[test]
fn bodies_that_overlap_in_the_mesh() {
    refused_with(
        "contact_patch",
        &["mesh.parts.1.block.y=[0.9,2.0]"],
        &[],
        2,
        &["nodes 54 and 45 overlap by 1.000e-1", "`overlap = true`"],
    );
}

#[test]
fn bodies_that_can_move_freely_are_named_with_the_motion() {
    // Nothing is supported and the pressure pushes both bodies down.
    refused_with(
        "contact_patch",
        &["support=[]"],
        &[],
        4,
        &[
            "bodies `lower` and `upper` can move along y together",
            "load `press` drives it",
        ],
    );
    // Nothing holds the upper body sideways.
    refused_with(
        "contact_patch",
        &[
            "support.2.on=lower.left",
            "load=[{on=\"upper.top\",traction=[1.0,-10.0]}]",
        ],
        &[],
        4,
        &["body `upper` can move along x", "add a support"],
    );
    refused_with(
        "thick_cylinder",
        &["support=[{on=\"tube.start\",fix=[\"y\"]}]"],
        &[],
        4,
        &["body `tube` can move along x"],
    );
}

#[test]
fn a_load_that_closes_nothing() {
    refused_with(
        "contact_patch",
        &["load.0.pressure=-10.0"],
        &[],
        4,
        &[
            "`upper.bottom` on `lower.top`",
            "closes no contact",
            "body `upper`",
        ],
    );
}

#[test]
fn a_support_along_a_contact_normal() {
    refused_with(
        "contact_patch",
        &["support.2.fix=[\"x\",\"y\"]"],
        &[],
        2,
        &[
            "node 46",
            "support 3 on `upper.left` acts along its contact normal",
        ],
    );
}

#[test]
fn elements_of_no_size_and_meshes_beyond_reason() {
    refused_with(
        "contact_patch",
        &["mesh.parts.1.block.x=[0.0,1e-300]"],
        &[],
        2,
        &["element 33 (quad4, body `upper`) is flat"],
    );
    for elements in ["[100000,100000]", "[9223372036854775807,4]"] {
        let set = format!("mesh.parts.1.block.elements={elements}");
        refused_with(
            "contact_patch",
            &[&set],
            &[],
            2,
            &["body `upper`", "elements, more than 5e7"],
        );
    }
    refused_with(
        "cylinder_on_half_plane",
        &["mesh.cylinder_on_half_plane.resolution=1000000"],
        &[],
        2,
        &[
            "mesh.cylinder_on_half_plane.resolution",
            "elements, more than 5e7",
        ],
    );
}

#[test]
fn a_model_that_is_too_large_for_the_dense_backend() {
    refused_with(
        "contact_patch",
        &[
            "mesh.parts.0.block.elements=[100,40]",
            "mesh.parts.1.block.elements=[100,40]",
        ],
        &["--solver", "dense"],
        2,
        &[
            "too many for the dense solver",
            "at most 6000",
            "--solver cholmod",
            "--solver faer",
        ],
    );
}

#[test]
fn a_result_directory_that_cannot_be_written_is_found_before_the_run() {
    let folder = patch(
        "elements = [8, 4] }\n\n[materials",
        "elements = [8, 4] }\n\n[materials",
    );
    let (path, in_file) = (folder.scene(), folder.path("scene.toml/out"));
    for (out, code, fragment) in [
        (path.to_str().unwrap(), 2, "scene.toml"),
        (in_file.to_str().unwrap(), 3, "scene.toml"),
        ("/proc/no/such/place", 3, "/proc"),
    ] {
        // A support on nothing would be an error too: the directory is looked at first.
        let output = brinell(&[
            "run",
            path.to_str().unwrap(),
            "--set",
            "support.0.on=nothing",
            "--out",
            out,
        ]);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{stderr}");
        assert!(
            stderr.contains(fragment) && !stderr.contains("nothing"),
            "{stderr}"
        );
    }
    assert_eq!(folder.entries(), 1);
    // A directory that is not a result of brinell is not replaced.
    std::fs::create_dir(folder.path("out")).unwrap();
    std::fs::write(folder.path("out/thesis.txt"), "years of work").unwrap();
    let output = folder.brinell("run", &[]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(std::fs::read_dir(folder.path("out")).unwrap().count(), 1);
}

#[test]
fn a_normal_that_leads_into_a_body() {
    refused_with(
        "contact_patch",
        &["contact.0.normal=[0.0, -1.0]"],
        &[],
        2,
        &[
            "contact 1 (`upper.bottom` on `lower.top`)",
            "its normal leads from `lower.top` into the body behind it",
            "reverse it, or leave it out",
        ],
    );
}

//! Rigid surfaces that are refused, with what the messages name.

use super::rigid_surfaces::{ball, block};

#[test]
fn bad_input_is_named() {
    let good = block("axisymmetric", "quad4", 4, &ball("force = [0.0, -1500.0]"));
    let sphere = "sphere = { center = [0.0, 10.0], radius = 10.0 }";
    for (old, new, fragments) in [
        (
            "center = [0.0, 10.0]",
            "center = [0.0, 9.5]",
            &["starts inside the body", "5.000e-1", "node"][..],
        ),
        (
            "center = [0.0, 10.0]",
            "center = [1.0, 10.0]",
            &["rigid.ball.sphere.center", "on the axis"],
        ),
        (
            "radius = 10.0",
            "radius = -1.0",
            &["rigid.ball.sphere.radius"],
        ),
        (
            sphere,
            "cone = { tip = [0.0, 0.0], axis = [0.0, 1.0], half_angle = 70.0, rounding = 0.0 }",
            &["rigid.ball.cone.rounding", "no bound"],
        ),
        (
            sphere,
            "cone = { tip = [0.0, 0.0], axis = [0.0, 1.0], half_angle = 70.0 }",
            &["rounding"],
        ),
        (
            sphere,
            "punch = { center = [0.0, 0.0], axis = [0.0, 1.0], radius = 1.0, fillet = 0.0 }",
            &["rigid.ball.punch.fillet"],
        ),
        (
            sphere,
            "heights = { file = \"missing.csv\" }",
            &["missing.csv"],
        ),
        (sphere, "", &["rigid.ball", "exactly one of"]),
        (
            sphere,
            "plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }",
            &["no facet", "turned round"],
        ),
        (
            "second = \"block.top\"",
            "second = \"wall\"\n[rigid.wall]\nplane = { point = [0.0, 0.0], normal = [0.0, -1.0] }",
            &["both rigid"],
        ),
        ("first = \"ball\"", "first = \"bal\"", &["touches nothing"]),
        (
            "second = \"block.top\"",
            "second = \"block.tip\"",
            &["did you mean `block.top`"],
        ),
        (
            "first = \"ball\"",
            "slave = \"first\"\nfirst = \"ball\"",
            &["contact.0.slave"],
        ),
        (
            "on = \"block.bottom\"",
            "on = \"ball\"",
            &["rigid and held"],
        ),
        (
            "force = [0.0, -1500.0]",
            "pressure = 5.0",
            &["push it by `force`"],
        ),
        (
            "force = [0.0, -1500.0]",
            "force = [1.0, -1500.0]",
            &["along r"],
        ),
        (
            "force = [0.0, -1500.0]",
            "displacement = { y = \"r\" }",
            &["load.0.displacement", "moves as one"],
        ),
    ] {
        assert!(good.contains(old), "{old}");
        let text = good.replacen(old, new, 1);
        let refused = brinell::scene::Scene::parse(&text, "bad.toml")
            .and_then(|scene| brinell::model::Model::new(&scene));
        let error = refused.map(|_| ()).expect_err(new);
        // A file that is not there is none of the input.
        let code = if new.contains("missing") { 3 } else { 2 };
        assert_eq!(error.kind().exit_code(), code, "{error}");
        for fragment in fragments {
            assert!(error.to_string().contains(fragment), "{new}: {error}");
        }
    }
}

/// A grid of three by three places, of which the one in the middle has no height.
#[test]
fn a_file_of_heights_with_a_hole_is_named_with_the_place() {
    let folder = tempfile::tempdir().unwrap();
    let places = (0..3).flat_map(|x| (0..3).map(move |y| (x, y)));
    let lines = places.filter(|place| *place != (1, 1));
    let text: String = lines.map(|(x, y)| format!("{x},{y},0.5\n")).collect();
    let file = folder.path().join("heights.csv");
    std::fs::write(&file, text).unwrap();
    let scene = format!(
        r#"kind = "solid"
[[mesh.parts]]
body = "block"
brick = {{ x = [0.0, 1.0], y = [0.0, 1.0], z = [-1.0, 0.0], elements = [2, 2, 2] }}
[materials.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
[bodies.block]
material = "steel"
[rigid.rough]
heights = {{ file = {file:?} }}
[[contact]]
first = "rough"
second = "block.top"
[[support]]
on = "block.bottom"
fix = ["x", "y", "z"]
[[load]]
on = "rough"
force = [0.0, 0.0, -1.0]
[program]
targets = [{{ load_factor = 1.0 }}]
"#
    );
    let refused = brinell::scene::Scene::parse(&scene, "rough.toml")
        .and_then(|scene| brinell::model::Model::new(&scene));
    let error = refused.map(|_| ()).unwrap_err();
    assert_eq!(error.kind().exit_code(), 2, "{error}");
    let text = error.to_string();
    assert!(
        text.contains("no height at x = 1, y = 1") && text.contains("heights.csv"),
        "{text}"
    );
}

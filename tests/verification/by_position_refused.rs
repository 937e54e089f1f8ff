//! Fields that cannot be: what is wrong is named, and where.

use brinell::ErrorKind;
use brinell::model::Model;
use brinell::scene::Scene;

#[test]
fn fields_that_cannot_be_are_named() {
    let refused = |kind: &str, contact: &str, load: &str| {
        let block = |y: &str| format!("block = {{ x = [0, 1], y = {y}, elements = [2, 2] }}");
        let [lower, upper] = [block("[0, 1]"), block("[1, 2]")];
        let text = format!(
            "kind = \"{kind}\"\n\
             [[mesh.parts]]\nbody = \"b\"\n{lower}\n[[mesh.parts]]\nbody = \"u\"\n{upper}\n\
             [[contact]]\nfirst = \"u.bottom\"\nsecond = \"b.top\"\n{contact}\n\
             [[load]]\n{load}\n\
             [materials.m]\nyoungs_modulus = 1.0\npoissons_ratio = 0.3\n\
             [bodies]\nb = {{ material = \"m\" }}\nu = {{ material = \"m\" }}\n\
             [program]\ntargets = [{{ load_factor = 1.0 }}]\n"
        );
        let scene = Scene::parse(&text, "scene.toml");
        let found = scene.and_then(|scene| Model::new(&scene).map(drop));
        let error = found.unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Input);
        error.to_string()
    };
    let press = "on = \"u.top\"\npressure = 1.0";
    for (kind, contact, load, parts) in [
        (
            "plane_strain",
            "",
            "on = \"u.top\"\npressure = \"log(x - 2)\"",
            &[
                "load 1 on `u.top`",
                "the pressure at (",
                "NaN",
                "facet of node",
            ][..],
        ),
        (
            "plane_strain",
            "",
            "on = \"u.top\"\ntraction = [\"1 / (y - y)\", 0.0]",
            &["the traction at", "inf"],
        ),
        (
            "plane_strain",
            "",
            "on = \"u.top\"\ndisplacement = { y = \"1 / x\" }",
            &["the displacement at node", "(0, 2)", "inf"],
        ),
        (
            "plane_strain",
            "",
            "on = \"u.bottom\"\ngap = \"sqrt(x - 2)\"",
            &["the gap at node", "NaN"],
        ),
        (
            "plane_strain",
            "gap = \"x - 0.5\"",
            press,
            &[
                "contact 1",
                "the gap at node",
                "is -0.5",
                "given by `interference`",
            ],
        ),
        (
            "plane_strain",
            "interference = \"0.1 - x\"",
            press,
            &["the interference at node", "given by `gap`"],
        ),
        (
            "plane_strain",
            "gap = \"t\"",
            press,
            &["contact.0.gap", "unknown name `t`", "x, y, r"],
        ),
        (
            "axisymmetric",
            "",
            "on = \"u.top\"\npressure = \"x\"",
            &["load.0.pressure", "unknown name `x`; there are r, z"],
        ),
        (
            "plane_strain",
            "",
            "on = \"u.top\"\ntraction = [\"2 * (\", 1.0]",
            &["load.0.traction.0", "is no formula"],
        ),
        (
            "plane_strain",
            "",
            "on = \"u.top\"\ntraction = [1.0]",
            &["1 components", "a vector has 2"],
        ),
        (
            "plane_strain",
            "",
            "on = \"u.top\"\ndisplacement = { y = \"q\" }",
            &["load.0.displacement.y", "unknown name `q`"],
        ),
        (
            "plane_strain",
            "",
            "on = \"u.top\"\npressure = true",
            &["a number, a formula in quotes"],
        ),
    ] {
        let error = refused(kind, contact, load);
        for part in parts {
            assert!(
                error.contains(part),
                "{contact} {load}: {part:?} is not in {error}"
            );
        }
    }
}

//! Reading of scene files: the message for each kind of mistake, overrides, and the result of
//! reading a good file.

mod overrides;

use crate::ErrorKind;
use crate::scene::{History, Kind, Material, Plastic, Scene, Target};

const GOOD: &str = r#"title = "block"
kind = "plane_strain"

[[mesh.parts]]
body = "block"
block = { x = [0.0, 1.0], y = [0.0, 1.0], elements = [2, 2] }

[materials.steel]
youngs_modulus = 210000
poissons_ratio = 0.3
yield_stress = 500.0

[bodies.block]
material = "steel"

[[support]]
on = "block.bottom"
fix = ["x", "y"]

[[load]]
name = "press"
on = "block.top"
pressure = 1.0

[program]
targets = [{ load_factor = 1.0 }, { load_factor = 2 }, { load_factor = 1.0 }]
"#;

fn load_with(overrides: &[&str]) -> crate::Result<Scene> {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), GOOD).unwrap();
    let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
    Scene::load_with(file.path(), &overrides)
}

#[test]
fn a_good_scene_is_read_with_its_defaults() {
    let scene = Scene::parse(GOOD, "good.toml").unwrap();
    assert_eq!(scene.kind, Kind::PlaneStrain);
    assert_eq!(scene.bodies["block"].plastic, Plastic::Auto);
    assert_eq!(scene.load[0].history, History::Proportional);
    assert_eq!(scene.program.gamma, 1e-8);
    assert_eq!(scene.analysis.tolerance, 1e-10);
    assert!(scene.can_yield("block") && scene.any_load_varies());
}

#[test]
fn targets_without_a_name_get_one_and_repeated_ones_a_number() {
    let scene = Scene::parse(GOOD, "good.toml").unwrap();
    let names: Vec<String> = (scene.program.targets.iter().enumerate())
        .map(|(index, target)| target.label(index))
        .collect();
    assert_eq!(names, ["alpha 1", "alpha 2", "alpha 1 (2)"]);
    let yields = Target {
        first_yield: true,
        ..Target::default()
    };
    assert_eq!(yields.label(4), "yield");
    assert_eq!(Target::default().label(4), "target 5");
}

#[test]
fn a_material_that_there_is_not_is_one_problem_for_each_body() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/data/scenes/cylinder_on_half_plane.toml"
    );
    let text = std::fs::read_to_string(path).unwrap();
    let text = text.replace("material = \"steel\"", "material = \"stell\"");
    let error = Scene::parse(&text, "bad.toml").unwrap_err().to_string();
    assert_eq!(error.lines().count(), 2, "{error}");
    for line in error.lines() {
        let meant =
            "there is no material \"stell\", did you mean \"steel\"? Known materials: steel";
        assert!(line.contains(meant), "{error}");
    }
}

/// Asserts that spoilt scenes are refused. Each row holds text to replace in the good scene, its
/// replacement, and what the message must hold.
fn refused(cases: &[(&str, &str, &[&str])]) {
    for (good, bad, fragments) in cases {
        assert!(GOOD.contains(good), "the good scene has no {good}");
        let error = Scene::parse(&GOOD.replacen(good, bad, 1), "bad.toml").unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Input, "{error}");
        for fragment in *fragments {
            assert!(
                error.message().contains(fragment),
                "{bad:?}: no {fragment:?} in {error}"
            );
        }
    }
}

#[test]
fn a_bad_scene_is_refused_with_place_key_and_advice() {
    refused(&[
        (
            "yield_stress",
            "yeild_stress",
            &[
                "bad.toml:11:1: unknown key `yeild_stress`, did you mean `yield_stress`?",
                "Known keys here (materials.steel): youngs_modulus",
            ],
        ),
        (
            "title =",
            "titel =",
            &["bad.toml:1:1: unknown key `titel`, did you mean `title`? Known keys here: title"],
        ),
        (
            "poissons_ratio",
            "zz",
            &["bad.toml:10:1: unknown key `zz`. Known keys here"],
        ),
        (
            "\"plane_strain\"",
            "\"plane_strian\"",
            &["bad.toml:2:8: kind: unknown value \"plane_strian\", did you mean \"plane_strain\"?"],
        ),
        ("\"plane_strain\"", "3", &["bad.toml:2:8: kind: wrong type"]),
        (
            "[[load]]",
            "[load]",
            &[
                "load: a single table, expected a list: write the head of one of several tables \
                 with two brackets, [[...]]",
            ],
        ),
        (
            "youngs_modulus = 210000\n",
            "",
            &["bad.toml:8:1: materials.steel: the key `youngs_modulus` is missing"],
        ),
        (
            "kind = \"plane_strain\"\n",
            "",
            &["bad.toml:1:1: the key `kind` is missing"],
        ),
        (
            "poissons_ratio = 0.3",
            "poissons_ratio = \"0.3\"",
            &[
                "bad.toml:10:18: materials.steel.poissons_ratio: wrong type: string \"0.3\", \
                 expected a number",
            ],
        ),
        (
            "elements = [2, 2]",
            "elements = [2, -2]",
            &[
                "mesh.parts.0.block.elements.1: wrong value: integer `-2`, expected a whole \
                 number, 0 or more",
            ],
        ),
    ]);
}

#[test]
fn a_wrong_value_is_refused_with_place_key_and_what_is_expected() {
    refused(&[
        (
            "x = [0.0, 1.0]",
            "x = [0.0]",
            &[
                "bad.toml:6:15: mesh.parts.0.block.x: wrong number of values: 1, expected an array \
                 of length 2",
            ],
        ),
        (
            "x = [0.0, 1.0]",
            "x = [0.0, 1.0, 2.0]",
            &["bad.toml:6:11: mesh.parts.0.block.x: wrong number of values: 3, expected 2"],
        ),
        (
            "pressure = 1.0",
            "displacement = [0.0, 1.0]",
            &["load.0.displacement: wrong type: array, expected a table with keys such as x, y"],
        ),
        (
            "[bodies.block]\nmaterial = \"steel\"",
            "[bodies]\nblock = \"steel\"",
            &["bad.toml:14:9: bodies.block: wrong type: string \"steel\", expected a table"],
        ),
        (
            "pressure = 1.0",
            "pressure = nan",
            &["bad.toml:23:12: load.0.pressure: nan is not a finite number"],
        ),
        (
            "pressure = 1.0",
            "pressure = -inf",
            &["load.0.pressure: -inf is not a finite number"],
        ),
        (
            "pressure = 1.0",
            "pressure = 1e999",
            &["load.0.pressure: 1e999 is not a finite number"],
        ),
        (
            "pressure = 1.0",
            "pressure = 1.0\nhistory = \"sometimes\"",
            &["load.0.history: wrong value: string \"sometimes\", \
               expected \"proportional\", \"constant\" or"],
        ),
        (
            "pressure = 1.0",
            "pressure = 1.0\nhistory = [[0, 1, 2]]",
            &["bad.toml:24:12: load.0.history.0: wrong number of values: 3, expected 2"],
        ),
        (
            "material = \"steel\"",
            "material = \"steel\"\nplastic = \"maybe\"",
            &[
                "bodies.block.plastic: wrong value: string \"maybe\", expected true, false \
                 or \"auto\"",
            ],
        ),
        (
            "fix = [\"x\", \"y\"]",
            "fix = [\"x\", \"y\"",
            &["bad.toml:", "not valid TOML"],
        ),
        (
            "on = \"block.bottom\"",
            "on = \"block.bottom\"\non = \"block.top\"",
            &["bad.toml:18:1: not valid TOML: duplicate key"],
        ),
        (
            "poissons_ratio = 0.3",
            "poissons_ratio = 0.5",
            &["bad.toml:10:1: materials.steel.poissons_ratio: 0.5 must lie between -1 and 0.5"],
        ),
    ]);
}

#[test]
fn all_problems_are_told_at_once_a_line_each() {
    let text = GOOD
        .replace("youngs_modulus = 210000", "youngs_modulus = -1")
        .replace("yield_stress = 500.0", "yield_stress = 0");
    let error = Scene::parse(&text, "bad.toml").unwrap_err();
    let lines: Vec<&str> = error.message().lines().collect();
    assert_eq!(
        lines,
        [
            "bad.toml:9:1: materials.steel.youngs_modulus: -1 must be greater than zero",
            "bad.toml:11:1: materials.steel.yield_stress: 0 must be greater than zero",
        ]
    );
}

#[test]
fn effects_that_brinell_has_not_are_unsupported() {
    for (good, bad, effect) in [
        ("name = \"press\"", "friction = 0.3", "friction"),
        ("poissons_ratio = 0.3", "mass = 7.8e-9", "dynamics"),
        (
            "title =",
            "finite_strain =",
            "finite strain or large deformation",
        ),
        ("title =", "nlgeom =", "finite strain or large deformation"),
        ("name = \"press\"", "time = 1", "dynamics"),
        (
            "poissons_ratio = 0.3",
            "conductivity = 45.0",
            "conduction of heat",
        ),
        ("poissons_ratio = 0.3", "damping = 0.1", "dynamics"),
        ("\"plane_strain\"", "\"3d\"", "thickness"),
    ] {
        let error = Scene::parse(&GOOD.replacen(good, bad, 1), "bad.toml").unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Unsupported, "{error}");
        let expected = format!("brinell has no {effect}");
        assert!(error.message().contains(&expected), "{bad}: {error}");
        assert!(error.message().starts_with("bad.toml:"), "{error}");
    }
}

#[test]
fn overrides_reach_every_part_of_a_scene() {
    let scene = load_with(&[
        "kind=plane_stress",
        "title = \"new, with = sign\"",
        "materials.steel.yield_stress=400",
        "materials.steel.plastic_modulus = 1e3",
        "mesh.parts.0.block.elements.1=6",
        "mesh.parts.block.element=quad8",
        "load.press.history=constant",
        "program.targets=[{ yield = true }, { load_factor = 3 }]",
        "load.0.history=[[0, 0], [1, 2]]",
        "analysis.max_iterations=17",
        "bodies.block.plastic=true",
    ])
    .unwrap();
    assert_eq!(scene.kind, Kind::PlaneStress);
    assert_eq!(scene.title, "new, with = sign");
    assert_eq!(scene.materials["steel"].yield_stress, Some(400.0));
    assert_eq!(scene.materials["steel"].plastic_modulus, Some(1000.0));
    let part = &scene.mesh.parts.as_ref().unwrap()[0];
    assert_eq!(part.block.as_ref().unwrap().elements, [2, 6]);
    assert_eq!(part.element, crate::shape::Shape::Quad8);
    // A later override wins over an earlier one.
    let table = History::Table(vec![[0.0, 0.0], [1.0, 2.0]]);
    assert_eq!(scene.load[0].history, table);
    assert_eq!(scene.program.targets.len(), 2);
    assert_eq!(scene.analysis.max_iterations, 17);
    assert_eq!(scene.bodies["block"].plastic, Plastic::Yes);
}

#[test]
fn a_wrong_override_is_named() {
    for (text, fragments) in [
        ("kind", &["--set kind: ", "no `=`"][..]),
        ("=3", &["--set =3: ", "not a key path"]),
        ("a b=3", &["--set a b=3: ", "not a key path"]),
        (
            "materials.steel.yeild_stress=400",
            &[
                "--set materials.steel.yeild_stress=400: unknown key `yeild_stress`, did you mean \
                 `yield_stress`?",
            ],
        ),
        (
            "matrials.steel.yield_stress=400",
            &["unknown key `matrials`, did you mean `materials`?"],
        ),
        (
            "support.3.on=left",
            &["`support` has no entry `3`; use an index from 0 to 0"],
        ),
        (
            "load.pull.pressure=3",
            &["`load` has no entry `pull`; use an index from 0 to 0 or a name: press"],
        ),
        (
            "contact.0.gap=0.1",
            &["--set contact.0.gap=0.1: ", "contact"],
        ),
        ("kind.x=3", &["`kind` is a value of type string"]),
        (
            "materials.steel.nonsense=",
            &["--set materials.steel.nonsense=: `materials.steel` has no key `nonsense` that"],
        ),
        (
            "load.0=",
            &["an entry of the list `load` cannot be removed"],
        ),
        ("nonsense=", &["the scene has no key `nonsense` that"]),
        ("load.0.pressure=[1", &["the value `[1` is not valid TOML"]),
        (
            "load.0.pressure=much",
            &["--set load.0.pressure=much: load.0.pressure: \"much\" has the unknown name"],
        ),
        (
            "load.0.pressure=nan",
            &["--set load.0.pressure=nan: load.0.pressure: nan is not a finite"],
        ),
        (
            "materials.steel.youngs_modulus=-5",
            &[
                "--set materials.steel.youngs_modulus=-5: materials.steel.youngs_modulus: -5 must \
                 be greater",
            ],
        ),
    ] {
        let error = load_with(&[text]).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Input, "{error}");
        for fragment in fragments {
            assert!(
                error.message().contains(fragment),
                "{text:?}: no {fragment:?} in {error}"
            );
        }
    }
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let error = Scene::load("no/such/scene.toml").unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Io);
    assert!(error.message().contains("no/such/scene.toml"), "{error}");
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), b"title = \"\xff\"").unwrap();
    let error = Scene::load(file.path()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Input);
    assert!(error.message().contains("not UTF-8"), "{error}");
}

#[test]
fn a_scene_written_as_toml_reads_back_the_same() {
    let scene = load_with(&["load.0.history=constant", "bodies.block.plastic=false"]).unwrap();
    let text = toml::to_string(&scene).unwrap();
    let again = Scene::parse(&text, "again.toml").unwrap();
    assert_eq!(toml::to_string(&again).unwrap(), text);
    assert_eq!(again.load[0].history, History::Constant);
    assert_eq!(again.bodies["block"].plastic, Plastic::No);
}

#[test]
fn the_plastic_modulus_follows_from_the_tangent_modulus() {
    let mut material = Material {
        youngs_modulus: 200.0,
        poissons_ratio: 0.3,
        yield_stress: Some(1.0),
        tangent_modulus: Some(40.0),
        ..Material::default()
    };
    // 1/Et = 1/E + 1/H: 1/40 = 1/200 + 1/50.
    assert_eq!(material.plastic_modulus_resolved(), Some(50.0));
    material.tangent_modulus = None;
    assert_eq!(material.plastic_modulus_resolved(), Some(0.0));
    material.plastic_modulus = Some(7.0);
    assert_eq!(material.plastic_modulus_resolved(), Some(7.0));
    material.yield_stress = None;
    assert_eq!(material.plastic_modulus_resolved(), None);
}

#[test]
fn the_scenes_of_the_repository_are_valid() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes");
    let mut read = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "toml") {
            let scene = Scene::load(&path).unwrap();
            assert_eq!(scene.file.as_deref(), Some(path.as_path()));
            assert!(!scene.title.is_empty(), "{}", path.display());
            let known = [
                "three_bodies.toml",
                "square_punch.toml",
                "blocks_tet10.toml",
            ];
            assert!(!scene.reference.is_empty() || known.iter().any(|n| path.ends_with(n)));
            read += 1;
        }
    }
    assert!(read >= 10, "only {read} scenes");
}

/// Every scene of the repository written as TOML is read back as itself.
#[test]
fn a_scene_survives_the_way_through_toml() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes");
    let mut seen = 0;
    for folder in [folder.join("hard"), folder] {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|e| e != "toml") {
                continue;
            }
            let text = Scene::load(&path).unwrap().to_toml().unwrap();
            let again = Scene::parse(&text, "again").unwrap_or_else(|e| panic!("{e}\n{text}"));
            assert_eq!(again.to_toml().unwrap(), text, "{}", path.display());
            seen += 1;
        }
    }
    assert!(seen > 10, "{seen}");
}

//! What is fed: each kind of input with what must hold of any outcome.

use crate::mutation::{Random, damaged};
use brinell::analysis::Analysis;
use brinell::deck::{Deck, Options};
use brinell::linalg::Backend;
use brinell::mesh::{self, Mesh, gmsh, inp};
use brinell::model::Model;
use brinell::progress::{Flow, Observer};
use brinell::results::HistoryRow;
use brinell::scene::{MeshSource, Part, Piece, Scene};
use brinell::{Error, ErrorKind, cli};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A kind of input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    Scene,
    Override,
    Mesh,
    CommandLine,
    /// A scene, run where it is small.
    Run,
    /// A deck of Abaqus or CalculiX.
    Deck,
}

impl Target {
    pub const ALL: [Target; 6] = [
        Target::Scene,
        Target::Override,
        Target::Mesh,
        Target::CommandLine,
        Target::Run,
        Target::Deck,
    ];

    /// The kind of the input of a number: of 1000, 8 are runs.
    pub fn of(number: u64) -> Target {
        match number % 1000 {
            0..400 => Target::Scene,
            400..500 => Target::Override,
            500..650 => Target::Mesh,
            650..800 => Target::Deck,
            800..992 => Target::CommandLine,
            _ => Target::Run,
        }
    }
}

/// Texts to damage.
pub struct Seeds {
    scenes: Vec<Vec<u8>>,
    /// Scenes that run in milliseconds.
    quick: Vec<Vec<u8>>,
    meshes: Vec<Vec<u8>>,
    decks: Vec<Vec<u8>>,
    lines: Vec<Vec<u8>>,
    overrides: Vec<Vec<u8>>,
    /// Scenes that meshes of the seeds belong to, plane and solid.
    blocks: [Scene; 2],
    scene_file: PathBuf,
}

const LINES: [&str; 12] = [
    "run scene.toml --out results --solver dense --threads 2 --set a.b=1 --progress json --quiet",
    "yield scene.toml --json --no-estimate --no-report --accuracy 1%",
    "check scene.toml --solver cholmod --set materials.steel.yield_stress=400",
    "accuracy scene.toml --budget 60s --levels 6 --knobs resolution,element,tolerance",
    "new ball-on-flat --radius 5 --load 300 --out ball.toml",
    "new punch --youngs-modulus 210000 --yield-stress 500 --plastic-modulus 0",
    "example disc_in_plate",
    "schema --summary",
    "view results --terminal --width 60",
    "completions bash",
    "selftest --markdown",
    "man --help -V",
];
const OVERRIDES: [&str; 8] = [
    "kind=plane_stress",
    "mesh.parts.0.block.elements=[4, 4]",
    "contact.0.interference=0.01",
    "load.press.history=constant",
    "program.targets=[{ yield = true }, { load_factor = 2.0 }]",
    "materials.steel={ youngs_modulus = 1.0, poissons_ratio = 0.3 }",
    "reference.0.source=x",
    "accuracy=1%",
];

/// The scene of the solid seeds.
const CUBES: &str = r#"
kind = "solid"
mesh.file = "solid.msh"
contact = [{ first = "upper.bottom", second = "lower.top" }]
support = [{ on = "lower.top", fix = ["x"] }, { on = "upper.bottom", direction = [1.0, 1.0, 0.0] }]
load = [{ on = "upper.bottom", pressure = 10.0 }]
program.targets = [{ load_factor = 1.0 }]
[materials.steel]
youngs_modulus = 1000.0
poissons_ratio = 0.3
[bodies]
lower = { material = "steel" }
upper = { material = "steel" }
"#;

impl Seeds {
    pub fn read() -> Seeds {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let texts = |folder: &str, ending: &str| -> Vec<Vec<u8>> {
            let mut paths: Vec<PathBuf> = std::fs::read_dir(root.join(folder))
                .unwrap()
                .map(|entry| entry.unwrap().path())
                .filter(|path| path.extension().is_some_and(|e| e == ending))
                .collect();
            paths.sort();
            paths
                .iter()
                .map(|path| std::fs::read(path).unwrap())
                .collect()
        };
        let scene = |name: &str| root.join(format!("data/scenes/{name}.toml"));
        let quick = [
            "contact_patch",
            "shrink_fit",
            "thick_cylinder",
            "three_bodies",
            "square_punch",
        ]
        .map(|name| std::fs::read_to_string(scene(name)).unwrap())
        .map(|text| {
            text.replace("[16, 16]", "[3, 3]")
                .replace("elements = 16", "elements = 3")
                .replace("[6, 6, 4]", "[2, 2, 1]")
                .replace("[18, 18, 12]", "[3, 3, 3]")
        });
        let scenes = [
            texts("data/scenes", "toml"),
            texts("data/scenes/hard", "toml"),
        ]
        .concat();
        let meshes = [
            texts("data/meshes", "msh"),
            texts("tests/fuzz/seeds", "msh"),
            // Binary ones of Gmsh.
            texts("tests/decks/programs", "msh"),
        ]
        .concat();
        let decks = [
            texts("tests/decks", "inp"),
            texts("tests/fuzz/seeds", "inp"),
            texts("tests/decks/programs", "inp"),
        ]
        .concat();
        assert!(scenes.len() > 20 && meshes.len() > 2 && decks.len() > 12);
        Seeds {
            quick: quick.map(String::into_bytes).to_vec(),
            scenes,
            meshes,
            decks,
            lines: LINES.map(|line| line.into()).to_vec(),
            overrides: OVERRIDES.map(|text| text.into()).to_vec(),
            blocks: [
                Scene::load(scene("gmsh_blocks")).unwrap(),
                Scene::parse(CUBES, "cubes.toml").unwrap(),
            ],
            scene_file: scene("contact_patch"),
        }
    }

    /// The input of a number.
    pub fn input(&self, number: u64, target: Target) -> Vec<u8> {
        let mut random = Random(number.wrapping_mul(0x2545_F491_4F6C_DD1D) ^ 6);
        let from = match target {
            Target::Scene => &self.scenes,
            Target::Override => &self.overrides,
            Target::Mesh => &self.meshes,
            Target::CommandLine => &self.lines,
            Target::Run => &self.quick,
            Target::Deck => &self.decks,
        };
        damaged(&from[random.below(from.len())], from, &mut random)
    }

    /// Feeds an input; panics where the outcome is none that may be. Says whether it was taken.
    pub fn feed(&self, target: Target, input: &[u8]) -> bool {
        match target {
            Target::Scene => read_scene(input).is_some(),
            Target::Override => self.put_over(input),
            Target::Mesh => self.mesh(input),
            Target::CommandLine => command_line(input),
            Target::Run => read_scene(input).is_some_and(|scene| run_with_patience(&scene)),
            Target::Deck => deck(input).map_err(refused).is_ok(),
        }
    }

    fn put_over(&self, input: &[u8]) -> bool {
        let text = String::from_utf8_lossy(input).into_owned();
        let loaded = Scene::load_with(&self.scene_file, &[text]);
        loaded.map_err(refused).is_ok()
    }

    fn mesh(&self, input: &[u8]) -> bool {
        let mesh = match gmsh::parse(input, "fuzz.msh") {
            Ok(mesh) => mesh,
            Err(error) => {
                // Binary parts have no lines.
                let text = error.message();
                let at = ["fuzz.msh, line ", "fuzz.msh, byte "];
                assert!(at.iter().any(|place| text.starts_with(place)), "{error}");
                refused(error);
                return false;
            }
        };
        if let Err(error) = mesh::validate(&mesh) {
            refused(error);
            return false;
        }
        written_and_read(&mesh);
        Model::from_mesh(&self.blocks[usize::from(mesh.is_solid())], mesh)
            .map_err(refused)
            .is_ok()
    }
}

/// Reads a deck, makes its scene and its mesh, and the model of both.
fn deck(input: &[u8]) -> brinell::Result<()> {
    let in_place = |error: Error| {
        assert!(error.message().contains(".inp, line "), "{error}");
        error
    };
    let deck = Deck::parse(input, "fuzz.inp").map_err(in_place)?;
    // A mesh alone needs no steps.
    let mesh = inp::mesh(&deck).map_err(in_place);
    let options = Options {
        small_strain: true,
        increments: true,
    };
    let conversion = deck.convert(options).map_err(in_place)?;
    let scene = conversion.finish("fuzz.inp", &[])?;
    let mesh = mesh?;
    mesh::validate(&mesh)?;
    written_and_read(&mesh);
    Model::from_mesh(&scene, mesh).map(drop)
}

/// A mesh survives being written.
fn written_and_read(mesh: &Mesh) {
    let mut text = Vec::new();
    if gmsh::write(mesh, &mut text).is_ok() {
        let again = gmsh::parse(&text, "again").unwrap();
        assert_eq!(again.coordinates, mesh.coordinates);
        assert_eq!(again.connectivity, mesh.connectivity);
    }
}

/// An input may be refused, but not by a fault of the program.
fn refused(error: Error) {
    assert!(error.kind() != ErrorKind::Internal, "{error}");
    assert!(!error.message().is_empty());
}

/// Reads a scene; what is read can be written and read again.
fn read_scene(input: &[u8]) -> Option<Scene> {
    let text = String::from_utf8_lossy(input);
    match Scene::parse(&text, "fuzz.toml") {
        Ok(scene) => {
            let text = scene.to_toml().unwrap();
            let again = Scene::parse(&text, "again").unwrap_or_else(|e| panic!("{e}\n{text}"));
            assert_eq!(again.to_toml().unwrap(), text);
            Some(scene)
        }
        Err(error) => {
            assert!(error.message().starts_with("fuzz.toml:"), "{error}");
            refused(error);
            None
        }
    }
}

fn command_line(input: &[u8]) -> bool {
    #[cfg(unix)]
    let word = |bytes: &[u8]| -> OsString {
        use std::os::unix::ffi::OsStringExt;
        OsString::from_vec(bytes.to_vec())
    };
    #[cfg(not(unix))]
    let word = |bytes: &[u8]| -> OsString { String::from_utf8_lossy(bytes).into_owned().into() };
    let words = input.split(|b| *b == b' ').map(word);
    match cli::check_command_line(std::iter::once("brinell".into()).chain(words)) {
        Ok(()) => true,
        Err(text) => {
            assert!(!text.is_empty());
            false
        }
    }
}

/// Stops after some increments or some time.
struct Patience {
    increments: usize,
    until: Instant,
}

impl Observer for Patience {
    fn increment(&mut self, row: &HistoryRow, _: f64) -> Flow {
        if row.increment < self.increments {
            Flow::Continue
        } else {
            Flow::Stop
        }
    }

    fn stop_requested(&self) -> bool {
        Instant::now() > self.until
    }
}

fn run_with_patience(scene: &Scene) -> bool {
    if cells(&scene.mesh) > 500.0 {
        return false;
    }
    let mut patience = Patience {
        increments: 60,
        until: Instant::now() + Duration::from_secs(2),
    };
    let outcome = Model::new(scene)
        .and_then(|model| Analysis::new(model, Backend::Dense))
        .and_then(|mut analysis| analysis.run(&mut patience));
    match outcome {
        Ok(results) => {
            // What claims to be well is made of numbers.
            if results.incomplete.is_none() && results.inaccurate.is_empty() {
                for state in &results.states {
                    let figures = [
                        state.max_pressure,
                        state.contact_force,
                        state.quality.equilibrium,
                    ];
                    assert!(
                        figures.iter().all(|f| f.is_finite()),
                        "{}: {figures:?}",
                        state.name
                    );
                }
            }
            true
        }
        Err(error) => {
            refused(error);
            false
        }
    }
}

/// A hexahedron weighs as much as so many quadrilaterals: it has twice the nodes and three times
/// the freedoms of one.
const OF_HEXAHEDRON: f64 = 6.0;

/// Quadrilateral cells of a mesh made of parts; a lot for anything else, and where cells are drawn
/// out to too many layers.
fn cells(source: &MeshSource) -> f64 {
    let of = |part: &Part| match part {
        Part {
            block: Some(block), ..
        } => block.elements.iter().map(|&n| n as f64).product(),
        Part {
            ring: Some(ring), ..
        } => ring.elements.iter().map(|&n| n as f64).product(),
        Part {
            disc: Some(disc), ..
        } => (disc.elements as f64).powi(2),
        Part {
            brick: Some(brick), ..
        } => brick.elements.iter().map(|&n| n as f64).product::<f64>() * OF_HEXAHEDRON,
        _ => 0.0,
    };
    let pieces = |part: &Part| -> usize {
        let pieces: &[Piece] = part.block.as_ref().map_or(&[], |b| &b.pieces);
        pieces.len()
    };
    let layers = match (&source.extrude, &source.revolve) {
        (None, None) => 1.0,
        (Some(extrude), _) => OF_HEXAHEDRON * extrude.elements as f64,
        (_, Some(revolve)) => OF_HEXAHEDRON * revolve.elements as f64,
    };
    match &source.parts {
        Some(parts) => parts
            .iter()
            .map(|p| layers * of(p) + pieces(p) as f64)
            .sum(),
        None => f64::INFINITY,
    }
}

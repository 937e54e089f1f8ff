//! Everything else is small: reading a mesh, starting the program, writing the results.
//!
//! `cargo bench --bench reading` prints the speed of reading a mesh of a million nodes in either
//! version of the format, as text and binary in both orders of bytes, and as a deck, the time of
//! commands that compute nothing, the share of a factorisation that forming contact rows takes, and
//! the share of a run that the stresses of its states and its files take; `-- rows` and the like
//! one of them. The figures go to `bench-results/`, a file for each part.

use brinell::analysis::Analysis;
use brinell::deck::Deck;
use brinell::linalg::Backend;
use brinell::mesh::{Mesh, Shape, gmsh, inp};
use brinell::model::Model;
use brinell::output::{self, RunHeader};
use brinell::progress::Silent;
use brinell::scene::{Direction, Scene, Support};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
/// Elements along each side of the mesh.
const SIDE: usize = 1000;

/// A name and what it measures.
type Part = (&'static str, fn() -> Result<Value, Failure>);

/// All parts, or those whose names are given.
fn main() -> Result<(), Failure> {
    let parts: [Part; 4] = [
        ("reading", reading),
        ("starting", starting),
        ("output", output),
        ("rows", rows),
    ];
    let named: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    let folder = Path::new(ROOT).join("bench-results");
    std::fs::create_dir_all(&folder)?;
    for (name, measure) in parts {
        if named.is_empty() || named.iter().any(|n| n == name) {
            let figures = measure()?;
            std::fs::write(
                folder.join(format!("{name}.json")),
                format!("{figures:#}\n"),
            )?;
        }
    }
    Ok(())
}

/// The least of several times, in seconds.
fn least<T>(times: usize, mut act: impl FnMut() -> Result<T, Failure>) -> Result<f64, Failure> {
    let mut least = f64::INFINITY;
    for _ in 0..times {
        let start = Instant::now();
        act()?;
        least = least.min(start.elapsed().as_secs_f64());
    }
    Ok(least)
}

fn reading() -> Result<Value, Failure> {
    let mesh = square();
    let mut version2 = Vec::new();
    gmsh::write(&mesh, &mut version2)?;
    let version4 = version4(&mesh)?;
    println!("| format | MB | s | MB/s |\n|---|---|---|---|");
    let mut out = Vec::new();
    let little = [binary2(&mesh, true), binary4(&mesh, true)];
    let big = [binary2(&mesh, false), binary4(&mesh, false)];
    for (name, text) in [
        ("2.2", &version2),
        ("2.2 binary", &little[0]),
        ("2.2 binary, big endian", &big[0]),
        ("4.1", &version4),
        ("4.1 binary", &little[1]),
        ("4.1 binary, big endian", &big[1]),
    ] {
        let read = gmsh::parse(text, name)?;
        assert_eq!(read.coordinates, mesh.coordinates, "read back bit for bit");
        assert_eq!(read.connectivity, mesh.connectivity);
        let seconds = least(5, || Ok(gmsh::parse(text, name)?))?;
        let size = text.len() as f64 / 1e6;
        println!(
            "| {name} | {size:.0} | {seconds:.3} | {:.0} |",
            size / seconds
        );
        out.push(json!({ "version": name, "megabytes": size, "seconds": seconds }));
    }
    let text = deck(&mesh)?;
    let read = inp::mesh(&Deck::parse(&text, "deck.inp")?)?;
    assert_eq!(read.coordinates, mesh.coordinates, "read back bit for bit");
    assert_eq!(read.connectivity, mesh.connectivity);
    let size = text.len() as f64 / 1e6;
    let parsing = least(5, || Ok(Deck::parse(&text, "deck.inp")?))?;
    let seconds = least(5, || Ok(inp::mesh(&Deck::parse(&text, "deck.inp")?)?))?;
    for (name, seconds) in [("inp, read", parsing), ("inp, with its mesh", seconds)] {
        println!(
            "| {name} | {size:.0} | {seconds:.3} | {:.0} |",
            size / seconds
        );
        out.push(json!({ "version": name, "megabytes": size, "seconds": seconds }));
    }
    Ok(out.into())
}

/// The mesh as a deck with a load.
fn deck(mesh: &Mesh) -> Result<Vec<u8>, Failure> {
    let mut text = String::from("*HEADING\nsquare\n*NODE, NSET=ALL\n");
    for node in 0..mesh.n_nodes() {
        let [x, y] = mesh.in_plane(node);
        writeln!(text, "{}, {x:?}, {y:?}, 0.", node + 1)?;
    }
    text += "*ELEMENT, TYPE=CPE4, ELSET=square\n";
    for element in 0..mesh.n_elements() {
        write!(text, "{}", element + 1)?;
        for node in mesh.nodes(element) {
            write!(text, ", {}", node + 1)?;
        }
        text.push('\n');
    }
    text += "*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n*SOLID SECTION, ELSET=square, MATERIAL=M\n";
    text += "*NSET, NSET=BASE, GENERATE\n1, 1001\n*BOUNDARY\nBASE, 1, 2\n";
    text += "*STEP\n*STATIC\n*CLOAD\n1002001, 2, 1.\n*END STEP\n";
    Ok(text.into_bytes())
}

/// Two bricks whose 5,000 and 2,500 facets do not face each other.
const BRICKS: &str = r#"
kind = "solid"
bodies = { upper = { material = "steel" }, lower = { material = "steel" } }
materials.steel = { youngs_modulus = 210e3, poissons_ratio = 0.3 }
contact = [{ first = "upper.bottom", second = "lower.top" }]
support = [{ on = "lower.bottom", fix = ["x", "y", "z"] }]
load = [{ on = "upper.top", pressure = 1.0 }]
program.targets = [{ load_factor = 1.0 }]

[[mesh.parts]]
body = "upper"
brick = { x = [0.0, 1.0], y = [0.0, 1.0], z = [1.0, 2.0], elements = [50, 50, 8] }

[[mesh.parts]]
body = "lower"
brick = { x = [0.0, 1.0], y = [0.0, 1.0], z = [0.0, 1.0], elements = [71, 71, 12] }
"#;

/// Forming the rows of surfaces that do not match, over factoring the stiffness.
fn rows() -> Result<Value, Failure> {
    let scene = Scene::parse(BRICKS, "bricks")?;
    let mut apart = scene.clone();
    apart.contact.clear();
    apart.support.push(Support {
        on: "upper.top".into(),
        fix: vec![Direction::X, Direction::Y, Direction::Z],
        ..Support::default()
    });
    let [with, without] = [&scene, &apart].map(|scene| least(3, || Ok(Model::new(scene)?)));
    let rows = with? - without?;
    let mut analysis = Analysis::new(Model::new(&scene)?, Backend::default())?;
    let results = analysis.run(&mut Silent)?;
    let phases = results
        .timings
        .iter()
        .filter(|(phase, _)| phase.contains("factor"));
    let factor: f64 = phases.map(|(_, seconds)| seconds).sum();
    let (freedoms, pairs) = (results.sizes.freedoms, analysis.model().pairs.len());
    println!("\n| freedoms | rows | rows, s | factor, s | share |\n|---|---|---|---|---|");
    let share = rows / factor;
    println!(
        "| {freedoms} | {pairs} | {rows:.3} | {factor:.2} | {:.2} % |",
        100.0 * share
    );
    Ok(json!({
        "freedoms": freedoms, "pairs": pairs, "rows": rows, "factor": factor, "share": share,
    }))
}

/// A square whose coordinates have all their digits, as generators write them.
fn square() -> Mesh {
    let n = SIDE + 1;
    let mut mesh = Mesh {
        dimension: 2,
        bodies: vec!["square".into()],
        ..Mesh::default()
    };
    for k in 0..n * n {
        let [x, y] = [k % n, k / n].map(|i| (i as f64 / SIDE as f64).powf(1.1));
        mesh.coordinates.extend([x, y]);
    }
    for corner in (0..SIDE * n).filter(|k| k % n < SIDE) {
        let nodes = [corner, corner + 1, corner + n + 1, corner + n].map(|k| k as u32);
        mesh.push_element(Shape::Quad4, 0, &nodes);
    }
    mesh
}

/// The mesh as Gmsh writes it now.
fn version4(mesh: &Mesh) -> Result<Vec<u8>, Failure> {
    let (nodes, elements) = (mesh.n_nodes(), mesh.n_elements());
    let mut text = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    text += "$PhysicalNames\n1\n2 1 \"square\"\n$EndPhysicalNames\n";
    text += "$Entities\n0 0 1 0\n1 0 0 0 1 1 0 1 1 0\n$EndEntities\n";
    writeln!(text, "$Nodes\n1 {nodes} 1 {nodes}\n2 1 0 {nodes}")?;
    for node in 0..nodes {
        writeln!(text, "{}", node + 1)?;
    }
    for node in 0..nodes {
        let [x, y] = mesh.in_plane(node);
        writeln!(text, "{x:?} {y:?} 0")?;
    }
    writeln!(
        text,
        "$EndNodes\n$Elements\n1 {elements} 1 {elements}\n2 1 3 {elements}"
    )?;
    for element in 0..elements {
        write!(text, "{}", element + 1)?;
        for node in mesh.nodes(element) {
            write!(text, " {}", node + 1)?;
        }
        text.push('\n');
    }
    text += "$EndElements\n";
    Ok(text.into_bytes())
}

/// Numbers of a binary file, in one order of bytes or the other.
struct Binary {
    bytes: Vec<u8>,
    is_little: bool,
}

impl Binary {
    /// A file that begins with its version, and the number that tells the order.
    fn new(version: &str, is_little: bool) -> Self {
        let bytes = format!("$MeshFormat\n{version} 1 8\n").into_bytes();
        let mut out = Binary { bytes, is_little };
        out.ints([1]);
        out.text("\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"square\"\n$EndPhysicalNames\n");
        out
    }

    fn text(&mut self, text: &str) {
        self.bytes.extend(text.as_bytes());
    }

    fn put<const N: usize>(&mut self, little: [u8; N]) {
        match self.is_little {
            true => self.bytes.extend(little),
            false => self.bytes.extend(little.iter().rev()),
        }
    }

    fn ints(&mut self, values: impl IntoIterator<Item = i32>) {
        values
            .into_iter()
            .for_each(|value| self.put(value.to_le_bytes()));
    }

    fn sizes(&mut self, values: impl IntoIterator<Item = usize>) {
        let values = values.into_iter();
        values.for_each(|value| self.put((value as u64).to_le_bytes()));
    }

    fn reals(&mut self, values: impl IntoIterator<Item = f64>) {
        values
            .into_iter()
            .for_each(|value| self.put(value.to_le_bytes()));
    }

    /// A node's place in space.
    fn place(&mut self, mesh: &Mesh, node: usize) {
        let [x, y] = mesh.in_plane(node);
        self.reals([x, y, 0.0]);
    }
}

/// The mesh in the binary form of version 2.2: elements in one block.
fn binary2(mesh: &Mesh, is_little: bool) -> Vec<u8> {
    let (nodes, elements) = (mesh.n_nodes(), mesh.n_elements());
    let mut out = Binary::new("2.2", is_little);
    out.text(&format!("$Nodes\n{nodes}\n"));
    for node in 0..nodes {
        out.ints([node as i32 + 1]);
        out.place(mesh, node);
    }
    out.text(&format!("\n$EndNodes\n$Elements\n{elements}\n"));
    out.ints([3, elements as i32, 2]);
    for element in 0..elements {
        out.ints([element as i32 + 1, 1, 1]);
        out.ints(mesh.nodes(element).iter().map(|node| *node as i32 + 1));
    }
    out.text("\n$EndElements\n");
    out.bytes
}

/// The mesh in the binary form of version 4.1, of one entity.
fn binary4(mesh: &Mesh, is_little: bool) -> Vec<u8> {
    let (nodes, elements) = (mesh.n_nodes(), mesh.n_elements());
    let mut out = Binary::new("4.1", is_little);
    out.text("$Entities\n");
    out.sizes([0, 0, 1, 0]);
    out.ints([1]);
    out.reals([0.0, 0.0, 0.0, 1.0, 1.0, 0.0]);
    out.sizes([1]);
    out.ints([1]);
    out.sizes([0]);
    out.text("\n$EndEntities\n$Nodes\n");
    out.sizes([1, nodes, 1, nodes]);
    out.ints([2, 1, 0]);
    out.sizes([nodes]);
    out.sizes(1..=nodes);
    (0..nodes).for_each(|node| out.place(mesh, node));
    out.text("\n$EndNodes\n$Elements\n");
    out.sizes([1, elements, 1, elements]);
    out.ints([2, 1, 3]);
    out.sizes([elements]);
    for element in 0..elements {
        out.sizes([element + 1]);
        out.sizes(mesh.nodes(element).iter().map(|node| *node as usize + 1));
    }
    out.text("\n$EndElements\n");
    out.bytes
}

fn starting() -> Result<Value, Failure> {
    println!("\n| command | ms |\n|---|---|");
    let tiny = format!("{ROOT}/data/scenes/contact_patch.toml");
    let mut out = Vec::new();
    for arguments in [
        &["--version"] as &[&str],
        &["schema"],
        &["check", &tiny],
        &["yield", "-q", "--no-estimate", &tiny],
        &["run", "-q", "--no-estimate", "--no-report", &tiny],
    ] {
        let folder = tempfile::tempdir()?;
        let seconds = least(20, || {
            let mut command = Command::new(env!("CARGO_BIN_EXE_brinell"));
            command
                .args(arguments)
                .stdout(Stdio::null())
                .stderr(Stdio::null());
            if arguments[0] == "run" {
                command.arg("--out").arg(folder.path().join("out"));
            }
            Ok(command.status()?)
        })?;
        println!("| {} | {:.1} |", arguments[0], 1e3 * seconds);
        out.push(json!({ "command": arguments[0], "milliseconds": 1e3 * seconds }));
    }
    Ok(out.into())
}

/// The cylinder of the paper with fields of one state, as a user with a large model would ask for,
/// and of all ten.
fn output() -> Result<Value, Failure> {
    println!(
        "\n| freedoms | states with fields | run, s | states, s | stresses, s | files, s | report,
        s | stresses and files |\n|---|---|---|---|---|---|---|---|"
    );
    let mut out = Vec::new();
    for one in [true, false] {
        let path = format!("{ROOT}/data/scenes/cylinder_on_half_plane.toml");
        let changes =
            ["resolution=32", "growth=1.08"].map(|c| format!("mesh.cylinder_on_half_plane.{c}"));
        let mut scene = Scene::load_with(path, &changes)?;
        for target in &mut scene.program.targets {
            target.fields = !one || target.name.as_deref() == Some("1.5 b*");
        }
        let folder = tempfile::tempdir()?;
        let start = Instant::now();
        let mut analysis = Analysis::new(Model::new(&scene)?, Backend::default())?;
        let results = analysis.run(&mut Silent)?;
        let model = analysis.model();
        let header = RunHeader::new(model, Backend::default(), 0.0);
        let computed = start.elapsed().as_secs_f64();
        output::write_without_report(&folder.path().join("a"), &header, model, &results)?;
        let total = start.elapsed().as_secs_f64();
        output::write_with_report(&folder.path().join("b"), &header, model, &results)?;
        let report = start.elapsed().as_secs_f64() - total - (total - computed);
        let seconds_of = |name: &str| -> f64 {
            let phases = results.timings.iter().filter(|(phase, _)| phase == name);
            phases.map(|(_, seconds)| seconds).sum()
        };
        let (states, stresses) = (seconds_of("states"), seconds_of("stresses"));
        let (files, with) = (total - computed, if one { 1 } else { results.states.len() });
        let share = (stresses + files) / total;
        println!(
            "| {} | {with} | {total:.2} | {states:.2} | {stresses:.2} | {files:.2} | {report:.2} | \
             {:.0} % |",
            results.sizes.freedoms,
            100.0 * share
        );
        out.push(json!({
            "freedoms": results.sizes.freedoms, "states_with_fields": with, "run": total,
            "states": states, "stresses": stresses, "files": files,
            "report": report, "share": share,
        }));
    }
    Ok(out.into())
}

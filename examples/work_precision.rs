//! The page of data/accuracy: what each digit costs, for the paper's applications and cases with
//! known answers. Run with `cargo run --release --example work_precision [-- SCENE]...` (names
//! below; all without any).

use brinell::accuracy::{Knob, Plan, QuantityStudy, Study, study};
use brinell::linalg::Backend;
use brinell::output;
use brinell::progress::Observer;
use brinell::scene::Scene;
use std::error::Error;
use std::fmt::Write;
use std::path::PathBuf;

type Outcome<T> = Result<T, Box<dyn Error>>;

/// A section of the page.
struct Case {
    name: &'static str,
    title: &'static str,
    scene: &'static str,
    overrides: &'static [&'static str],
    knobs: &'static [Knob],
    levels: usize,
    budget: f64,
    quantities: &'static [&'static str],
    /// Orders of convergence that theory has.
    theory: &'static str,
    remark: &'static str,
}

/// Twice the order of the energy norm, which is the degree of the elements or what the solution's
/// smoothness allows: the displacements beside a contact's edge go with the power 3/2 of the
/// distance.
const EDGE: &str = "2 for linear elements; for quadratic ones 4 where all is smooth, 3 behind a \
                    contact edge (twice the order of the energy norm, which the edge, where \
                    displacements go with r^(3/2), holds at 3/2 whatever the degree)";
/// The same beyond yield.
const EDGE_AND_FRONT: &str = "2 for linear elements; for quadratic ones no more than 3 behind the \
                              contact edge and between 1 and 2 where the front of the plastic zone \
                              passes through elements";

const PATH: &[Knob] = &[
    Knob::Resolution,
    Knob::Element,
    Knob::Tolerance,
    Knob::Gamma,
    Knob::Stepping,
    Knob::Algorithm,
];
const MESH: &[Knob] = &[Knob::Resolution, Knob::Element];

const CASES: [Case; 6] = [
    Case {
        name: "cylinder",
        title: "Cylinder on a half plane, loading and unloading (the paper's 5.1)",
        scene: "cylinder_on_half_plane",
        overrides: &[],
        knobs: PATH,
        levels: 5,
        budget: 240.0,
        quantities: &[
            "yield.load",
            "states.1.5 b*.max_pressure",
            "states.unloaded.residual_depth",
        ],
        theory: EDGE_AND_FRONT,
        remark: "Beyond yield the contact edge travels over yielding elements: the dent converges \
                 with an order between one and two, whatever the element. A target read off the \
                 state (1.5 b*) can be missed with the loosest tolerances.",
    },
    Case {
        name: "disc",
        title: "Disc in a plate (the paper's 5.2)",
        scene: "disc_in_plate",
        overrides: &[
            "mesh.disc_in_plate.resolution=44",
            "mesh.disc_in_plate.growth=1.10",
        ],
        knobs: PATH,
        levels: 5,
        budget: 180.0,
        quantities: &[
            "yield.load",
            "yield.half_width",
            "states.alpha 2.max_pressure",
        ],
        theory: EDGE_AND_FRONT,
        remark: "The half width is read off a contact that ends inside an element, so that its \
                 error is a share of one: first order. While it is unloaded the pressure peaks at \
                 the edge of the dent, the higher the finer the mesh: those states have no limit \
                 under refinement.",
    },
    Case {
        name: "hertz_line",
        title: "Hertz line contact, first yield",
        scene: "cylinder_on_half_plane",
        overrides: &[
            "program.targets=[{ yield = true }]",
            "materials.steel.yield_stress=50.0",
        ],
        knobs: MESH,
        levels: 6,
        budget: 120.0,
        quantities: &["yield.load", "yield.max_pressure", "yield.half_width"],
        theory: EDGE,
        remark: "Second order in load and pressure down to 1e-4, where the finite size of the \
                 bodies shows. The singular slope of the pressure at the contact edge (a square \
                 root) keeps quadratic elements from a higher one.",
    },
    Case {
        name: "hertz_point",
        title: "Hertz point contact, first yield",
        scene: "ball_on_half_space",
        overrides: &[
            "program.targets=[{ yield = true }]",
            "materials.steel.yield_stress=50.0",
            "mesh.cylinder_on_half_plane.resolution=16",
            "mesh.cylinder_on_half_plane.far_size=2000.0",
        ],
        knobs: MESH,
        levels: 6,
        budget: 120.0,
        quantities: &["yield.load", "yield.max_pressure", "yield.half_width"],
        theory: EDGE,
        remark: "With `quad4` load and pressure are right to a thousandth from six elements over \
                 the contact on, so that no order can be observed; the other elements converge \
                 with theirs.",
    },
    Case {
        name: "thick_cylinder",
        title: "Thick cylinder, perfectly plastic",
        scene: "thick_cylinder",
        overrides: &[],
        knobs: &Knob::ALL,
        levels: 6,
        budget: 120.0,
        quantities: &["yield.alpha", "states.alpha 190.approach"],
        theory: "2 for linear and 4 for quadratic elements at first yield, where all is smooth; \
                 beyond it between 1 and 2, the front of the plastic zone being inside elements",
        remark: "Quadratic elements win by a factor. The displacement near collapse is governed by \
                 increments as much as by the mesh.",
    },
    Case {
        name: "flat_punch",
        title: "Flat punch, limit load",
        scene: "flat_punch",
        overrides: &["mesh.parts.0.block.elements=[20, 20]"],
        knobs: &[Knob::Resolution, Knob::Tolerance, Knob::Stepping],
        levels: 5,
        budget: 120.0,
        quantities: &["states.flow.load"],
        theory: "1: the velocity of the exact mechanism jumps, and continuous elements smear the \
                 jump over one of theirs",
        remark: "The velocity jumps at the punch's edge: first order, with values from above, \
                 whatever else is refined.",
    },
];

/// Prints phases on standard error.
struct Printed;

impl Observer for Printed {
    fn phase(&mut self, name: &str) {
        if name.starts_with("run ") {
            eprintln!("{name}");
        }
    }
}

fn data() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("data")
}

fn main() -> Outcome<()> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    if wanted.is_empty() {
        // A process each: the memory of one study's large runs is not held against the next one's
        // small ones.
        for case in &CASES {
            let status = std::process::Command::new(std::env::current_exe()?)
                .arg(case.name)
                .status()?;
            if !status.success() {
                return Err(format!("{}: {status}", case.name).into());
            }
        }
        return Ok(());
    }
    let folder = data().join("accuracy");
    std::fs::create_dir_all(&folder)?;
    for case in CASES.iter().filter(|c| wanted.iter().any(|w| w == c.name)) {
        eprintln!("{}", case.title);
        let overrides: Vec<String> = case.overrides.iter().map(|o| o.to_string()).collect();
        let path = data().join("scenes").join(format!("{}.toml", case.scene));
        let scene = Scene::load_with(path, &overrides)?;
        let plan = Plan {
            knobs: case.knobs.to_vec(),
            levels: case.levels,
            budget: Some(case.budget),
        };
        let found = study(&scene, Backend::default(), &plan, &mut Printed)?;
        let text = section(case, &found)?;
        for name in case.quantities {
            let quantity = quantity(&found, name)?;
            std::fs::write(
                folder.join(plot_file(case, name)),
                output::plot(&found, quantity)?,
            )?;
        }
        std::fs::write(folder.join(format!("{}.md", case.name)), text)?;
    }
    Ok(())
}

fn quantity<'s>(study: &'s Study, name: &str) -> Outcome<&'s QuantityStudy> {
    let found = study.quantities.iter().find(|q| q.quantity == name);
    Ok(found.ok_or_else(|| format!("no quantity {name}"))?)
}

fn plot_file(case: &Case, quantity: &str) -> String {
    let name: String = quantity
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
        .collect();
    format!("{}_{name}.svg", case.name)
}

fn section(case: &Case, study: &Study) -> Outcome<String> {
    let mut text = String::new();
    writeln!(text, "# {}\n", case.title)?;
    let sets: String = case
        .overrides
        .iter()
        .map(|o| format!(" --set '{o}'"))
        .collect();
    let knobs: Vec<&str> = case.knobs.iter().map(|k| k.name()).collect();
    writeln!(
        text,
        "`brinell accuracy data/scenes/{}.toml --levels {} --budget {}s --knobs {}{sets}`\n",
        case.scene,
        case.levels,
        case.budget,
        knobs.join(",")
    )?;
    writeln!(text, "{}\n", case.remark)?;
    writeln!(text, "Orders in theory: {}.\n", case.theory)?;
    let turned = |knob: Knob| study.runs.iter().any(|run| run.knob == knob);
    if !turned(Knob::Tolerance) && !turned(Knob::Stepping) {
        writeln!(
            text,
            "Up to first yield nothing yields and the path is followed exactly: there are no \
             increments and no tolerances to vary.\n"
        )?;
    }
    for name in case.quantities {
        let quantity = quantity(study, name)?;
        writeln!(text, "## {name}\n\n![{name}]({})\n", plot_file(case, name))?;
        if let Some(reference) = &quantity.reference {
            writeln!(
                text,
                "- reference {:.6}, uncertain by {:.1e}: {}",
                reference.value, reference.uncertainty, reference.source
            )?;
        }
        let orders: Vec<String> = quantity
            .orders
            .iter()
            .map(|(s, o)| format!("{s} {o:.1}"))
            .collect();
        writeln!(text, "- observed orders: {}", orders.join("; "))?;
        for words in &quantity.words {
            writeln!(text, "- {words}")?;
        }
        writeln!(text)?;
    }
    let heads: Vec<&str> = case
        .quantities
        .iter()
        .map(|q| q.rsplit('.').next().unwrap_or(q))
        .collect();
    writeln!(
        text,
        "## Runs\n\n| series | setting | freedoms | time [s] | memory [MB] | operations | factor \
         [flops] | trailing solves | plastic iterations | {} |",
        heads
            .iter()
            .map(|h| format!("error of {h}"))
            .collect::<Vec<_>>()
            .join(" | ")
    )?;
    writeln!(text, "|{}", "---|".repeat(9 + heads.len()))?;
    for (i, run) in study.runs.iter().enumerate() {
        let mut errors = String::new();
        for name in case.quantities {
            let error = quantity(study, name)?.errors[i];
            write!(
                errors,
                " {} |",
                error.map_or("-".into(), |e| format!("{e:.1e}"))
            )?;
        }
        writeln!(
            text,
            "| {} | {}{} | {} | {:.2} | {} | {:.1e} | {:.1e} | {} | {} |{errors}",
            run.series,
            run.value,
            run.failed
                .as_ref()
                .map_or(String::new(), |why| format!(": {why}")),
            run.freedoms,
            run.usage.undisturbed_seconds(),
            run.usage
                .peak_memory_bytes
                .map_or("-".into(), |b| (b / 1_000_000).to_string()),
            run.work,
            run.factor[0],
            run.counts.trailing_solves,
            run.counts.plastic_iterations
        )?;
    }
    writeln!(text)?;
    for left in &study.left_out {
        writeln!(text, "Left out: {left}")?;
    }
    Ok(text)
}

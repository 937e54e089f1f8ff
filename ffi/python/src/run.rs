//! Runs and what they leave.

use crate::arrays::backend;
use crate::errors::{Raise, exception, missing};
use crate::lent::{lent, read_only};
use crate::observer::Watcher;
use crate::tables;
use crate::threads;
use brinell::ErrorKind;
use brinell::accuracy::{self, Effort, Extent};
use brinell::analysis::{self, Analysis};
use brinell::deck::{self, Options};
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::output::{self, RunHeader};
use brinell::panics::contained;
use brinell::progress::Silent;
use brinell::reference;
use brinell::results::{self, QUANTITIES, Quantity, Results};
use brinell::scene::Scene;
use numpy::PyArray1;
use pyo3::exceptions::{PyAttributeError, PyIndexError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// What is run.
pub enum Source {
    Scene(Box<Scene>),
    Model(Box<Model>),
}

/// How.
pub struct Way {
    pub backend: Backend,
    pub callback: Option<Py<PyAny>>,
    pub estimate: Effort,
    pub threads: Option<usize>,
    /// Seconds for an accuracy that the scene demands.
    pub budget: Option<f64>,
}

/// Runs a scene; see `brinell.run`, which calls this.
#[allow(clippy::too_many_arguments)] // those of the Python function
#[pyfunction]
#[pyo3(signature = (scene, is_path, overrides, solver, callback, estimate, threads, budget))]
pub fn run(
    py: Python<'_>,
    scene: &str,
    is_path: bool,
    overrides: Vec<String>,
    solver: Option<&str>,
    callback: Option<Py<PyAny>>,
    estimate: &str,
    threads: Option<i64>,
    budget: Option<f64>,
) -> PyResult<Py<RunResult>> {
    let source = Source::Scene(Box::new(read(py, scene, is_path, &overrides)?));
    let way = Way {
        backend: backend(py, solver)?,
        callback,
        estimate: Effort::from_name(estimate).raise(py)?,
        threads: threads::number(py, threads)?,
        budget,
    };
    execute(py, source, way)
}

/// The text of a new scene; see `brinell.new`, which calls this.
#[pyfunction]
pub fn new(py: Python<'_>, words: Vec<String>) -> PyResult<String> {
    let words = words.into_iter().map(OsString::from);
    contained(|| brinell::cli::new_scene(words)).raise(py)
}

/// The program; see `brinell.__main__`, which calls this. Its name comes first in `arguments`.
#[pyfunction]
pub fn main(py: Python<'_>, itself: Vec<OsString>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| brinell::cli::program_within(itself, arguments))
}

/// Reads a scene; its warnings are those of Python.
fn read(py: Python<'_>, scene: &str, is_path: bool, overrides: &[String]) -> PyResult<Scene> {
    let read = || match is_path {
        true => deck::load_with(scene, overrides, Options::default()),
        false => Scene::parse_with(scene, "scene", overrides),
    };
    let scene = contained(read).raise(py)?;
    for warning in &scene.warnings {
        py.import("warnings")?.call_method1("warn", (warning,))?;
    }
    Ok(scene)
}

/// What a run would do and cost; see `brinell.check`, which calls this.
#[pyfunction]
pub fn check<'py>(
    py: Python<'py>,
    scene: &str,
    is_path: bool,
    overrides: Vec<String>,
    solver: Option<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    let scene = read(py, scene, is_path, &overrides)?;
    let backend = backend(py, solver)?;
    let work = || contained(|| analysis::check(&Model::new(&scene)?, backend));
    let found = py.detach(work).raise(py)?;
    Ok(pythonize::pythonize(py, &found)?)
}

/// First yield alone, elastic; see `brinell.yield_load`, which calls this.
#[pyfunction]
pub fn yield_load<'py>(
    py: Python<'py>,
    scene: &str,
    is_path: bool,
    overrides: Vec<String>,
    solver: Option<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    let scene = read(py, scene, is_path, &overrides)?;
    let backend = backend(py, solver)?;
    let work = || {
        contained(|| {
            let mut analysis = Analysis::new(Model::new(&scene)?, backend)?;
            analysis.yield_load(&mut Silent)
        })
    };
    let results = py.detach(work).raise(py)?;
    Ok(pythonize::pythonize(py, &results.first_yield)?)
}

/// Runs with the interpreter released.
pub fn execute(py: Python<'_>, source: Source, way: Way) -> PyResult<Py<RunResult>> {
    crate::kernels::warn_of_slow(py);
    let mut watcher = Watcher::new(way.callback);
    let start = Instant::now();
    let (backend, budget) = (way.backend, way.budget);
    let signals = watcher.signals();
    let work = || {
        contained(|| {
            let model = match source {
                Source::Scene(scene) if scene.accuracy.is_some() => {
                    let extent = Extent::Program;
                    let found = accuracy::reach(&scene, backend, extent, budget, &mut watcher)?;
                    return Ok((found.analysis.model().clone(), found.results));
                }
                Source::Scene(scene) => Model::new(&scene)?,
                Source::Model(model) => *model,
            };
            let mut analysis = Analysis::new(model, backend)?;
            let mut results = analysis.run(&mut watcher)?;
            let model = analysis.model().clone();
            reference::compare(&model, &mut results);
            if way.estimate != Effort::None {
                let (scene, extent) = (&model.scene, Extent::Program);
                let effort = way.estimate;
                let watcher = &mut watcher;
                let found = accuracy::estimate(scene, backend, &results, extent, effort, watcher);
                results.accuracy = Some(found);
            }
            Ok((model, results))
        })
    };
    let done = py.detach(|| threads::on(way.threads, &signals, work));
    if let Some(raised) = watcher.into_raised() {
        return Err(raised);
    }
    let (model, results) = done.raise(py)?;
    let header = RunHeader::new(&model, backend, start.elapsed().as_secs_f64());
    let ending = output::ending(&results);
    let result = Py::new(py, RunResult::new(py, results, model, header)?)?;
    match ending {
        // The callback has stopped it: it knows.
        Err(short) if short.kind() == ErrorKind::Stopped => {}
        Err(short) if short.kind() == ErrorKind::Inaccurate => {
            let category = py.import("brinell._errors")?.getattr("InaccurateWarning")?;
            py.import("warnings")?
                .call_method1("warn", (short.message(), category))?;
        }
        Err(short) => {
            let result = Some(result.clone_ref(py).into_any());
            return Err(exception(py, &short, result));
        }
        Ok(()) => {}
    }
    Ok(result)
}

/// What a run computed.
///
/// Tables (`states`, `history`, `pairs` of a state) are dictionaries of columns:
/// `pandas.DataFrame(result.history)`. `len(result)` is the number of states; `result[i]` or
/// `result["name"]` is one.
#[pyclass(frozen, name = "Result", module = "brinell")]
pub struct RunResult {
    results: Arc<Results>,
    model: Arc<Model>,
    header: RunHeader,
    summary: Py<PyAny>,
}

impl RunResult {
    fn new(py: Python<'_>, results: Results, model: Model, header: RunHeader) -> PyResult<Self> {
        Ok(RunResult {
            summary: pythonize::pythonize(py, &output::summary(&header, &results))?.unbind(),
            results: Arc::new(results),
            model: Arc::new(model),
            header,
        })
    }

    fn names(&self) -> Vec<&str> {
        let states = self.results.states.iter();
        states.map(|state| state.name.as_str()).collect()
    }
}

#[pymethods]
impl RunResult {
    /// First yield as a dictionary (`alpha`, `load`, `max_pressure`, `half_width`, `location`,
    /// `body`); None where nothing yields.
    #[getter]
    fn first_yield<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize::pythonize(py, &self.results.first_yield)?)
    }

    /// Columns of figures, a row per state.
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tables::states(py, &self.results)
    }

    /// Columns of figures, a row per accepted increment.
    #[getter]
    fn history<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tables::history(py, &self.results)
    }

    /// The mesh: `coordinates` (n, 2), of a solid (n, 3), `connectivity` and `offsets`,
    /// `element_body`, `shapes`, `bodies`, `node_sets` (surfaces among them).
    #[getter]
    fn mesh<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (model, mesh) = (&self.model, &self.model.mesh);
        let table = PyDict::new(py);
        let coordinates = lent(py, model, |m| &m.mesh.coordinates[..], Some(mesh.dimension))?;
        table.set_item("coordinates", coordinates)?;
        let connectivity = lent(py, model, |m| &m.mesh.connectivity[..], None)?;
        table.set_item("connectivity", connectivity)?;
        table.set_item("offsets", lent(py, model, |m| &m.mesh.offsets[..], None)?)?;
        let bodies = lent(py, model, |m| &m.mesh.element_body[..], None)?;
        table.set_item("element_body", bodies)?;
        let shapes: Vec<&str> = mesh.shapes.iter().map(|s| s.name()).collect();
        table.set_item("shapes", shapes)?;
        table.set_item("bodies", &mesh.bodies)?;
        let sets = PyDict::new(py);
        for name in mesh.set_names() {
            let nodes = mesh.set_nodes(name).unwrap_or_default();
            let nodes = PyArray1::from_iter(py, nodes.into_iter().map(|n| n as isize));
            sets.set_item(name, read_only(nodes.into_any())?)?;
        }
        table.set_item("node_sets", sets)?;
        Ok(table)
    }

    /// What `summary.json` says, as a dictionary.
    #[getter]
    fn summary(&self, py: Python<'_>) -> Py<PyAny> {
        self.summary.clone_ref(py)
    }

    /// The worst quality figures of all states.
    #[getter]
    fn quality<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize::pythonize(py, &self.results.quality)?)
    }

    /// Things the user should know.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        let of_run = self.results.warnings.iter();
        of_run.chain(&self.model.warnings).cloned().collect()
    }

    /// Why the run ended before its program did; None where it did not.
    #[getter]
    fn incomplete(&self) -> Option<&str> {
        (self.results.incomplete.as_ref()).map(|incomplete| incomplete.why.as_str())
    }

    /// Quality figures that miss their tolerance: such results are not to be trusted.
    #[getter]
    fn inaccurate(&self) -> Vec<String> {
        self.results.inaccurate.clone()
    }

    /// Names of units of all numbers: `length`, `force`, `stress`, `load`; None where the scene does
    /// not name them.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.summary.bind(py).get_item("units")
    }

    /// A meshio mesh with the fields of a state (its number or name): needs meshio.
    #[pyo3(signature = (state = None))]
    fn to_meshio<'py>(
        slf: &Bound<'py, Self>,
        state: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let convert = slf.py().import("brinell._convert")?;
        convert.call_method1("to_meshio", (slf, state))
    }

    /// Draws a column of the history against another with matplotlib; the axes.
    #[pyo3(signature = (y = "max_pressure", x = "load", ax = None))]
    fn plot<'py>(
        slf: &Bound<'py, Self>,
        y: &str,
        x: &str,
        ax: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        slf.py()
            .import("brinell._convert")?
            .call_method1("plot", (slf, y, x, ax))
    }

    /// A key of the tables in words, with its unit: `max pressure [MPa]`.
    fn label(&self, key: &str) -> String {
        let named = Quantity::of(key).filter(|quantity| !quantity.heading.is_empty());
        named.map_or_else(
            || key.to_string(),
            |quantity| self.header.labels.name(quantity),
        )
    }

    /// The states as a table, for notebooks.
    fn _repr_html_(&self) -> String {
        let escaped = |text: &str| text.replace('&', "&amp;").replace('<', "&lt;");
        let shown = |q: &&Quantity| {
            let is_said = !q.heading.is_empty() && !q.is_detail;
            is_said
                && self
                    .results
                    .states
                    .iter()
                    .any(|s| (q.in_state.get)(s) != 0.0)
        };
        let columns: Vec<&Quantity> = QUANTITIES.iter().filter(shown).collect();
        let head: String = (columns.iter())
            .map(|q| format!("<th>{}</th>", escaped(&self.header.labels.name(q))))
            .collect();
        let row = |state: &results::State| {
            let cells = columns.iter().map(|q| {
                let value = (q.in_state.get)(state);
                format!(
                    "<td>{}</td>",
                    if q.is_count {
                        value.to_string()
                    } else {
                        six(value)
                    }
                )
            });
            let name = escaped(&state.name);
            format!("<tr><th>{name}</th>{}</tr>", cells.collect::<String>())
        };
        let rows: String = self.results.states.iter().map(row).collect();
        format!("<table><thead><tr><th>state</th>{head}</tr></thead><tbody>{rows}</tbody></table>")
    }

    /// Writes the result directory that the program writes: tables, fields, report.
    fn write(&self, py: Python<'_>, directory: PathBuf) -> PyResult<()> {
        let to: &Path = &directory;
        py.detach(|| {
            contained(|| output::write_with_report(to, &self.header, &self.model, &self.results))
        })
        .raise(py)
    }

    fn __len__(&self) -> usize {
        self.results.states.len()
    }

    fn __getitem__(&self, py: Python<'_>, which: &Bound<'_, PyAny>) -> PyResult<State> {
        let n = self.results.states.len();
        let index = if let Ok(name) = which.extract::<String>() {
            let names = self.names();
            names.iter().position(|n| *n == name).ok_or_else(|| {
                missing(
                    py,
                    &format!("there is no state {name:?}; there are {names:?}"),
                )
            })?
        } else {
            let index: isize = which.extract()?;
            let place = if index < 0 { index + n as isize } else { index };
            let place = usize::try_from(place).ok().filter(|place| *place < n);
            place.ok_or_else(|| PyIndexError::new_err(format!("state {index} of {n}")))?
        };
        Ok(State {
            results: Arc::clone(&self.results),
            index,
        })
    }

    fn __repr__(&self) -> String {
        format!(
            "<brinell.Result: {} increments, states {:?}{}>",
            self.results.history.len(),
            self.names(),
            if self.results.incomplete.is_some() {
                ", incomplete"
            } else {
                ""
            }
        )
    }
}

/// Six digits.
fn six(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_string(),
        size if (1e-3..1e6).contains(&size) => {
            let before = size.log10().floor() as i32 + 1;
            format!("{value:.*}", usize::try_from(6 - before).unwrap_or(0))
        }
        _ => format!("{value:.5e}"),
    }
}

/// The state at a target.
#[pyclass(frozen, module = "brinell")]
pub struct State {
    results: Arc<Results>,
    index: usize,
}

impl State {
    fn state(&self) -> &results::State {
        &self.results.states[self.index]
    }
}

#[pymethods]
impl State {
    /// Name, from the scene or made from the target.
    #[getter]
    fn name(&self) -> &str {
        &self.state().name
    }

    /// A quantity by its key in `summary.json`: `load`, `half_width`, `residual_depth`, ...
    fn __getattr__<'py>(&self, py: Python<'py>, key: &str) -> PyResult<Bound<'py, PyAny>> {
        let Some(quantity) = Quantity::of(key) else {
            let keys: Vec<&str> = QUANTITIES.iter().map(|quantity| quantity.key).collect();
            return Err(PyAttributeError::new_err(format!(
                "a state has no {key:?}; its quantities are {}",
                keys.join(", ")
            )));
        };
        let value = (quantity.in_state.get)(self.state());
        match quantity.is_count {
            true => Ok((value as u64).into_pyobject(py)?.into_any()),
            false => Ok(value.into_pyobject(py)?.into_any()),
        }
    }

    /// What a state has, the quantities among it.
    fn __dir__(&self) -> Vec<&'static str> {
        let own = ["name", "contact_arc", "pairs", "fields", "quality"];
        own.into_iter()
            .chain(QUANTITIES.iter().map(|quantity| quantity.key))
            .collect()
    }

    /// Begin and end of a contact on a circle, in degrees from its middle; None elsewhere.
    #[getter]
    fn contact_arc(&self) -> Option<[f64; 2]> {
        self.state().contact_arc
    }

    /// Columns of the contact pairs: `pair`, `contact`, `x`, `y`, `z`, `gap`, `force`, `area`,
    /// `pressure`, `closed`.
    #[getter]
    fn pairs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tables::pairs(py, &self.results, self.index)
    }

    /// Patches of the contact of a solid, a dictionary each: `contact`, `area`, `centroid`,
    /// `semi_axes` (the larger first), `direction` of the larger one, `max_pressure`,
    /// `mean_pressure`, `force`.
    #[getter]
    fn patches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize::pythonize(py, &self.state().patches)?)
    }

    /// Fields on the whole mesh, not copied and not to be written to: `displacement` (n_nodes, 2),
    /// `stress` (n_elements, 4) as xx, yy, zz, xy (of a solid 3 and 6, yz and zx after them),
    /// `von_mises`, `equivalent_plastic_strain`, `yielded`, `discretisation_error`, and of the nodes
    /// `nodal_stress`, `contact_pressure`, `gap`: the names of the `.vtu` files; None where the target asks for
    /// none.
    #[getter]
    fn fields<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        tables::fields(py, &self.results, self.index)
    }

    /// Quality figures, all relative.
    #[getter]
    fn quality<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize::pythonize(py, &self.state().quality)?)
    }

    fn __repr__(&self) -> String {
        format!(
            "<brinell.State {:?}: alpha {}>",
            self.state().name,
            self.state().alpha
        )
    }
}

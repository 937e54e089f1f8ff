//! Runs and what they leave.

use crate::arrays::backend;
use crate::errors::{Raise, exception, wrong};
use crate::observer::Watcher;
use crate::tables;
use brinell::accuracy::{self, Extent};
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::{Model, ModelBuilder};
use brinell::output::{self, RunHeader};
use brinell::panics::contained;
use brinell::results::{self, Results};
use brinell::scene::Scene;
use brinell::{Error, ErrorKind};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What is run.
pub enum Source {
    Scene(Box<Scene>),
    Builder(Box<ModelBuilder>),
}

/// How.
pub struct Way {
    pub backend: Backend,
    pub callback: Option<Py<PyAny>>,
    pub estimate: bool,
}

/// Runs a scene; see `brinell.run`, which calls this.
#[pyfunction]
#[pyo3(signature = (scene, is_path, overrides, solver, callback, estimate))]
pub fn run(
    py: Python<'_>,
    scene: &str,
    is_path: bool,
    overrides: Vec<String>,
    solver: Option<&str>,
    callback: Option<Py<PyAny>>,
    estimate: bool,
) -> PyResult<Py<RunResult>> {
    let read = || match is_path {
        true => Scene::load_with(scene, &overrides),
        false => Scene::parse_with(scene, "scene", &overrides),
    };
    let source = Source::Scene(Box::new(contained(read).raise(py)?));
    let way = Way {
        backend: backend(py, solver)?,
        callback,
        estimate,
    };
    execute(py, source, way)
}

/// Runs with the interpreter released.
pub fn execute(py: Python<'_>, source: Source, way: Way) -> PyResult<Py<RunResult>> {
    let mut watcher = Watcher::new(way.callback);
    let start = Instant::now();
    let backend = way.backend;
    let done = py.detach(|| {
        contained(|| {
            let model = match &source {
                Source::Scene(scene) if scene.accuracy.is_some() => {
                    let found = accuracy::reach(scene, backend, Extent::Program, &mut watcher)?;
                    return Ok((found.analysis.model().clone(), found.results));
                }
                Source::Scene(scene) => Model::new(scene)?,
                Source::Builder(builder) => builder.build()?,
            };
            let mut analysis = Analysis::new(model, backend)?;
            let mut results = analysis.run(&mut watcher)?;
            let model = analysis.model().clone();
            if way.estimate {
                let extent = Extent::Program;
                let found =
                    accuracy::estimate(&model.scene, backend, &results, extent, &mut watcher);
                results.accuracy = Some(found);
            }
            Ok((model, results))
        })
    });
    if let Some(raised) = watcher.into_raised() {
        return Err(raised);
    }
    let (model, results) = done.raise(py)?;
    let header = RunHeader::new(&model, backend, start.elapsed().as_secs_f64());
    let incomplete = results.incomplete.clone();
    let kind = results.incomplete_kind.unwrap_or(ErrorKind::Analysis);
    let inaccurate = results.inaccurate.join("\n");
    let result = Py::new(py, RunResult::new(py, results, model, header)?)?;
    match incomplete {
        Some(why) if kind != ErrorKind::Stopped => {
            let result = Some(result.clone_ref(py).into_any());
            return Err(exception(py, &Error::new(kind, why), result));
        }
        None if !inaccurate.is_empty() => {
            let category = py.import("brinell._errors")?.getattr("InaccurateWarning")?;
            py.import("warnings")?
                .call_method1("warn", (inaccurate, category))?;
        }
        _ => {}
    }
    Ok(result)
}

/// What a run computed.
///
/// Tables (`states`, `history`, `pairs` of a state) are dictionaries of columns: `pandas.DataFrame(result.history)`.
/// `len(result)` is the number of states; `result[i]` or `result["name"]` is one.
#[pyclass(frozen, name = "Result", module = "brinell")]
pub struct RunResult {
    /// Without its states.
    results: Results,
    model: Model,
    header: RunHeader,
    states: Vec<Py<State>>,
    summary: Py<PyAny>,
    mesh: Py<PyDict>,
}

impl RunResult {
    fn new(py: Python<'_>, results: Results, model: Model, header: RunHeader) -> PyResult<Self> {
        let summary = pythonize::pythonize(py, &output::summary(&header, &results))?.unbind();
        let mut results = results;
        let states = std::mem::take(&mut results.states)
            .into_iter()
            .map(|state| Py::new(py, State::new(py, state)?))
            .collect::<PyResult<_>>()?;
        let mesh = mesh(py, &model)?.unbind();
        Ok(RunResult {
            results,
            model,
            header,
            states,
            summary,
            mesh,
        })
    }
}

fn mesh<'py>(py: Python<'py>, model: &Model) -> PyResult<Bound<'py, PyDict>> {
    let mesh = &model.mesh;
    let table = PyDict::new(py);
    table.set_item(
        "coordinates",
        tables::kept(py, mesh.coordinates.clone(), Some(2))?,
    )?;
    table.set_item(
        "connectivity",
        tables::kept(py, mesh.connectivity.clone(), None)?,
    )?;
    let offsets = mesh.offsets.iter().map(|n| *n as i64).collect();
    table.set_item("offsets", tables::kept::<i64>(py, offsets, None)?)?;
    table.set_item(
        "element_body",
        tables::kept(py, mesh.element_body.clone(), None)?,
    )?;
    let shapes: Vec<&str> = mesh.shapes.iter().map(|s| s.name()).collect();
    table.set_item("shapes", shapes)?;
    table.set_item("bodies", &mesh.bodies)?;
    let sets = PyDict::new(py);
    for name in mesh.set_names() {
        let nodes = mesh.set_nodes(name).unwrap_or_default();
        let nodes = nodes.iter().map(|n| *n as i64).collect();
        sets.set_item(name, tables::kept::<i64>(py, nodes, None)?)?;
    }
    table.set_item("node_sets", sets)?;
    Ok(table)
}

#[pymethods]
impl RunResult {
    /// First yield as a dictionary (`alpha`, `load`, `max_pressure`, `half_width`, `location`, `body`); None where nothing yields.
    #[getter]
    fn first_yield<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize::pythonize(py, &self.results.first_yield)?)
    }

    /// Columns of figures, a row per state.
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let states: Vec<&results::State> = self.states.iter().map(|s| &s.get().state).collect();
        tables::states(py, &states)
    }

    /// Columns of figures, a row per accepted increment.
    #[getter]
    fn history<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tables::history(py, &self.results.history)
    }

    /// The mesh: `coordinates` (n, 2), `connectivity` and `offsets`, `element_body`, `shapes`, `bodies`, `node_sets` (surfaces among them).
    #[getter]
    fn mesh(&self, py: Python<'_>) -> Py<PyDict> {
        self.mesh.clone_ref(py)
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
        self.results.incomplete.as_deref()
    }

    /// Quality figures that miss their tolerance: such results are not to be trusted.
    #[getter]
    fn inaccurate(&self) -> Vec<String> {
        self.results.inaccurate.clone()
    }

    /// Writes the result directory that the program writes: tables, fields, report.
    fn write(&self, py: Python<'_>, directory: PathBuf) -> PyResult<()> {
        let mut results = self.results.clone();
        let states = self.states.iter().map(|s| s.get().whole(py));
        results.states = states.collect::<PyResult<_>>()?;
        let to: &Path = &directory;
        py.detach(|| {
            contained(|| output::write_with_report(to, &self.header, &self.model, &results))
        })
        .raise(py)
    }

    fn __len__(&self) -> usize {
        self.states.len()
    }

    fn __getitem__(&self, py: Python<'_>, which: &Bound<'_, PyAny>) -> PyResult<Py<State>> {
        let n = self.states.len();
        let found = if let Ok(name) = which.extract::<String>() {
            let named = |s: &&Py<State>| s.get().state.name == name;
            let found = self.states.iter().find(named);
            let names: Vec<&str> = self
                .states
                .iter()
                .map(|s| s.get().state.name.as_str())
                .collect();
            found.ok_or_else(|| {
                wrong(
                    py,
                    format!("there is no state {name:?}; there are {names:?}"),
                )
            })?
        } else {
            let index: isize = which.extract()?;
            let place = if index < 0 { index + n as isize } else { index };
            usize::try_from(place)
                .ok()
                .and_then(|place| self.states.get(place))
                .ok_or_else(|| PyIndexError::new_err(format!("state {index} of {n}")))?
        };
        Ok(found.clone_ref(py))
    }

    fn __repr__(&self) -> String {
        let names: Vec<&str> = self
            .states
            .iter()
            .map(|s| s.get().state.name.as_str())
            .collect();
        format!(
            "<brinell.Result: {} increments, states {names:?}{}>",
            self.results.history.len(),
            if self.results.incomplete.is_some() {
                ", incomplete"
            } else {
                ""
            }
        )
    }
}

/// The state at a target.
#[pyclass(frozen, module = "brinell")]
pub struct State {
    /// Without its fields.
    state: results::State,
    fields: Option<Py<PyDict>>,
}

impl State {
    fn new(py: Python<'_>, mut state: results::State) -> PyResult<Self> {
        let fields = match state.fields.take() {
            Some(fields) => Some(tables::fields(py, fields)?.unbind()),
            None => None,
        };
        Ok(State { state, fields })
    }

    /// With its fields, copied.
    fn whole(&self, py: Python<'_>) -> PyResult<results::State> {
        let mut state = self.state.clone();
        if let Some(fields) = &self.fields {
            state.fields = Some(tables::fields_of(fields.bind(py))?);
        }
        Ok(state)
    }
}

#[pymethods]
impl State {
    /// Name, from the scene or made from the target.
    #[getter]
    fn name(&self) -> &str {
        &self.state.name
    }

    /// Load factor in the program's unit.
    #[getter]
    fn alpha(&self) -> f64 {
        self.state.alpha
    }

    /// Total load.
    #[getter]
    fn load(&self) -> f64 {
        self.state.load
    }

    /// Sum of the contact forces.
    #[getter]
    fn contact_force(&self) -> f64 {
        self.state.contact_force
    }

    /// Largest contact pressure.
    #[getter]
    fn max_pressure(&self) -> f64 {
        self.state.max_pressure
    }

    /// Contact half width.
    #[getter]
    fn half_width(&self) -> f64 {
        self.state.half_width
    }

    /// The dent that stays.
    #[getter]
    fn residual_depth(&self) -> f64 {
        self.state.residual_depth
    }

    /// Displacement of the loaded surface along the load.
    #[getter]
    fn approach(&self) -> f64 {
        self.state.approach
    }

    /// Gauss points with plastic strain.
    #[getter]
    fn plastic_points(&self) -> usize {
        self.state.plastic_points
    }

    /// Largest equivalent plastic strain.
    #[getter]
    fn max_equivalent_plastic_strain(&self) -> f64 {
        self.state.max_equivalent_plastic_strain
    }

    /// Begin and end of a contact on a circle, in degrees from its middle; None elsewhere.
    #[getter]
    fn contact_arc(&self) -> Option<[f64; 2]> {
        self.state.contact_arc
    }

    /// Columns of the contact pairs: `pair`, `contact`, `x`, `y`, `gap`, `force`, `area`, `pressure`, `closed`.
    #[getter]
    fn pairs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tables::pairs(py, &self.state.pairs)
    }

    /// Fields on the whole mesh, not copied and not to be written to: `displacement` (n_nodes, 2), `stress` (n_elements, 4) as xx, yy, zz, xy,
    /// `von_mises`, `plastic_strain`, `yielded`, `error`; None where the target asks for none.
    #[getter]
    fn fields(&self, py: Python<'_>) -> Option<Py<PyDict>> {
        self.fields.as_ref().map(|fields| fields.clone_ref(py))
    }

    /// Quality figures, all relative.
    #[getter]
    fn quality<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize::pythonize(py, &self.state.quality)?)
    }

    fn __repr__(&self) -> String {
        format!(
            "<brinell.State {:?}: alpha {}>",
            self.state.name, self.state.alpha
        )
    }
}

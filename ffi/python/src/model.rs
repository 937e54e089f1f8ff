//! Models from arrays.

use crate::arrays::{backend, doubles, each_width, integers, keywords, shape, values, vectors};
use crate::errors::{Raise, wrong};
use crate::run::{RunResult, Source, Way, execute};
use crate::threads;
use brinell::accuracy::Effort;
use brinell::mesh::{Curve, Shape};
use brinell::model::{ModelBuilder, NodePair};
use brinell::panics::contained;
use brinell::scene::{
    Body, Contact, Direction, History, Kind, Load, Material, Plastic, Program, Settings, SlaveSide,
    Support, Target,
};
use brinell::space::Components;
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A model from arrays. Nodes and elements count from 0 in the order in which they were added, and
/// errors name them so. Units are the caller's, consistent (for instance N, mm, MPa).
///
/// kind: "plane_strain", "plane_stress", "axisymmetric" (coordinates are then (r, z)) or "solid"
/// (coordinates and vectors have three components). symmetry: copies of the model that make the
/// whole (2 for a half model); loads and results are those of the whole.
#[pyclass(module = "brinell")]
pub struct Model {
    builder: ModelBuilder,
    dimension: usize,
    program: Program,
}

impl Model {
    /// Changes the builder; a refused call leaves it as it was.
    fn change(
        &mut self,
        py: Python<'_>,
        act: impl FnOnce(&mut ModelBuilder) -> brinell::Result<()>,
    ) -> PyResult<()> {
        contained(|| act(&mut self.builder)).raise(py)
    }
}

/// Keywords with one more among them.
fn with<'py>(
    values: Option<&Bound<'py, PyDict>>,
    more: &[(&str, &Bound<'py, PyAny>)],
    py: Python<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let all = match values {
        Some(values) => values.copy()?,
        None => PyDict::new(py),
    };
    for (key, value) in more {
        all.set_item(key, value)?;
    }
    Ok(all)
}

#[pymethods]
impl Model {
    #[new]
    #[pyo3(signature = (kind = "plane_strain", *, symmetry = 1, title = ""))]
    fn new(py: Python<'_>, kind: &str, symmetry: usize, title: &str) -> PyResult<Self> {
        let kinds = [
            Kind::PlaneStrain,
            Kind::PlaneStress,
            Kind::Axisymmetric,
            Kind::Solid,
        ];
        let kind = kinds
            .into_iter()
            .find(|k| k.name() == kind)
            .ok_or_else(|| {
                let known = kinds.map(Kind::name).join(", ");
                wrong(
                    py,
                    format!("there is no kind {kind:?}; give one of {known}"),
                )
            })?;
        let mut builder = ModelBuilder::new(kind);
        builder.symmetry(symmetry).title(title);
        Ok(Model {
            builder,
            dimension: kind.dimension(),
            program: Program::default(),
        })
    }

    /// Number of nodes so far.
    #[getter]
    fn n_nodes(&self) -> usize {
        self.builder.n_nodes()
    }

    /// Number of elements so far.
    #[getter]
    fn n_elements(&self) -> usize {
        self.builder.n_elements()
    }

    /// Adds nodes: coordinates (n, 2), of a solid (n, 3).
    fn nodes(&mut self, py: Python<'_>, coordinates: &Bound<'_, PyAny>) -> PyResult<()> {
        let array = doubles(coordinates, "coordinates")?;
        shape(py, array.shape(), &[self.dimension], "coordinates")?;
        let coordinates = values(py, &array)?;
        self.change(py, |b| b.nodes(coordinates).map(drop))
    }

    /// Adds elements of a body: nodes (n, nodes of an element), counter-clockwise, corners first;
    /// of a solid in the order of VTK.
    ///
    /// shape: "quad4", "quad8", "tri3", "tri6"; of a solid "hex8", "hex20", "tet4", "tet10",
    /// "prism6", "prism15".
    #[pyo3(signature = (body, nodes, *, shape = "quad4"))]
    fn elements(
        &mut self,
        py: Python<'_>,
        body: &str,
        nodes: &Bound<'_, PyAny>,
        shape: &str,
    ) -> PyResult<()> {
        let shapes = Shape::ALL.into_iter();
        let mut shapes = shapes.filter(|s| s.dimension() == self.dimension);
        let known = || {
            let shapes = Shape::ALL.into_iter();
            let shapes = shapes.filter(|s| s.dimension() == self.dimension);
            shapes.map(Shape::name).collect::<Vec<_>>().join(", ")
        };
        let found = shapes.find(|s| s.name() == shape);
        let of = found.ok_or_else(|| {
            wrong(
                py,
                format!("there is no shape {shape:?}; give one of {}", known()),
            )
        })?;
        let what = format!("nodes of the elements of `{body}`");
        let nodes = integers(nodes, &what)?;
        crate::arrays::shape(py, nodes.shape(), &[of.n_nodes()], &what)?;
        each_width!(py, nodes, |nodes| self
            .change(py, |b| b.elements(of, body, nodes).map(drop)))
    }

    /// Names some nodes.
    fn node_set(&mut self, py: Python<'_>, name: &str, nodes: &Bound<'_, PyAny>) -> PyResult<()> {
        let nodes = integers(nodes, &format!("node set `{name}`"))?;
        each_width!(py, nodes, |nodes| self
            .change(py, |b| b.node_set(name, nodes).map(drop)))
    }

    /// Names a surface by facets (n, 2): element, and its facet k between corners k and k + 1.
    fn surface(&mut self, py: Python<'_>, name: &str, facets: &Bound<'_, PyAny>) -> PyResult<()> {
        let what = format!("facets of surface `{name}`");
        let facets = integers(facets, &what)?;
        shape(py, facets.shape(), &[2], &what)?;
        each_width!(py, facets, |facets| {
            let facets = facets.chunks_exact(2).map(|f| (f[0], f[1]));
            self.change(py, |b| b.surface(name, facets).map(drop))
        })
    }

    /// Names a surface by its nodes, mid-side nodes included: the facets of the boundary all whose
    /// nodes are among them.
    fn surface_of_nodes(
        &mut self,
        py: Python<'_>,
        name: &str,
        nodes: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let nodes = integers(nodes, &format!("nodes of surface `{name}`"))?;
        each_width!(py, nodes, |nodes| self
            .change(py, |b| b.surface_of_nodes(name, nodes).map(drop)))
    }

    /// States that a surface is a circle: the body lies inside, or outside of it (outward=False, a
    /// hole). Normals are then exact.
    #[pyo3(signature = (surface, center, radius, *, outward = true))]
    fn circle(
        &mut self,
        py: Python<'_>,
        surface: &str,
        center: [f64; 2],
        radius: f64,
        outward: bool,
    ) -> PyResult<()> {
        let circle = Curve::Circle {
            center,
            radius,
            outward,
        };
        self.change(py, |b| b.curve(surface, circle).map(drop))
    }

    /// Adds tables of a scene (TOML text): materials, bodies, [[contact]], [[support]], [[load]],
    /// [program], [analysis], [units], title; whatever a scene file may say but for kind, symmetry
    /// and mesh.
    fn tables(&mut self, py: Python<'_>, text: &str) -> PyResult<()> {
        let program = self.program.clone();
        self.change(py, |b| b.program(program).tables(text).map(drop))?;
        self.program = self.builder.load_program().clone();
        Ok(())
    }

    /// Names a material: youngs_modulus, poissons_ratio, and where it can yield yield_stress with
    /// plastic_modulus, tangent_modulus or hardening_table (n, 2).
    #[pyo3(signature = (name, **values))]
    fn material(
        &mut self,
        py: Python<'_>,
        name: &str,
        values: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let material: Material = keywords(&with(values, &[], py)?, &format!("material `{name}`"))?;
        self.change(py, |b| b.material(name, material).map(drop))
    }

    /// Says what a body is made of, and whether it may yield: True, False, or None (if its material
    /// can).
    #[pyo3(signature = (name, material, *, plastic = None))]
    fn body(
        &mut self,
        py: Python<'_>,
        name: &str,
        material: &str,
        plastic: Option<bool>,
    ) -> PyResult<()> {
        let body = Body {
            material: material.to_string(),
            plastic: match plastic {
                None => Plastic::Auto,
                Some(true) => Plastic::Yes,
                Some(false) => Plastic::No,
            },
            ..Body::default()
        };
        self.change(py, |b| b.body(name, body).map(drop))
    }

    /// Lets two surfaces touch.
    ///
    /// pairs: (n, 2) nodes of the first and the second surface; None to pair nodes that face each
    /// other, and to couple other surfaces by the integrals of their shape functions. gap: initial
    /// gap of all pairs, or (n) gaps of the given ones; None for the geometric gaps. normal:
    /// direction from the second body to the first, of all pairs or one for each in rows; None for
    /// the second surface's outward normals. interference: taken off every gap, gradually before
    /// the load program. slave: "first" or "second", the surface at whose nodes gaps and pressures
    /// are; "auto" for the finer one.
    #[pyo3(signature = (first, second, *, pairs = None, gap = None, normal = None, interference = 0.0, slave = "auto"))]
    #[allow(clippy::too_many_arguments)] // keywords
    fn contact(
        &mut self,
        py: Python<'_>,
        first: &str,
        second: &str,
        pairs: Option<&Bound<'_, PyAny>>,
        gap: Option<&Bound<'_, PyAny>>,
        normal: Option<&Bound<'_, PyAny>>,
        interference: f64,
        slave: &str,
    ) -> PyResult<()> {
        let mut contact = Contact {
            first: first.to_string(),
            second: second.to_string(),
            interference: interference.into(),
            slave: match slave {
                "auto" => SlaveSide::Auto,
                "first" => SlaveSide::First,
                "second" => SlaveSide::Second,
                _ => {
                    let why =
                        format!("slave is \"{slave}\"; give \"first\", \"second\" or \"auto\"");
                    return Err(wrong(py, why));
                }
            },
            ..Contact::default()
        };
        let Some(pairs) = pairs else {
            let number = gap.map(|g| g.extract::<f64>()).transpose()?;
            contact.gap = number.map(Into::into);
            let given = normal.map(|n| n.extract::<Vec<f64>>()).transpose()?;
            contact.normal = given
                .map(|n| n.try_into().map_err(|why: String| wrong(py, why)))
                .transpose()?;
            return self.change(py, |b| {
                b.contact(contact);
                Ok(())
            });
        };
        let nodes = integers(pairs, "pairs")?;
        shape(py, nodes.shape(), &[2], "pairs")?;
        let n = nodes.shape()[0];
        let count = |found: usize, what: &str| match found == n {
            true => Ok(()),
            false => Err(wrong(
                py,
                format!("{n} pairs have {found} {what}: one each is needed"),
            )),
        };
        let gaps = match gap {
            None => Vec::new(),
            Some(gap) => match gap.extract::<f64>() {
                Ok(gap) => vec![gap; n],
                Err(_) => {
                    let array = doubles(gap, "gap")?;
                    count(array.len(), "gaps")?;
                    values(py, &array)?.to_vec()
                }
            },
        };
        let normals = match normal {
            None => Vec::new(),
            Some(normal) => match normal.extract::<Vec<f64>>() {
                Ok(given) => {
                    let normal: Components =
                        given.try_into().map_err(|why: String| wrong(py, why))?;
                    vec![normal.vector(); n]
                }
                Err(_) => vectors(normal, self.dimension, "normal")?,
            },
        };
        if normal.is_some() {
            count(normals.len(), "normals")?;
        }
        each_width!(py, nodes, |nodes| self.change(py, |b| {
            let pairs = nodes.chunks_exact(2).enumerate().map(|(k, pair)| {
                let node = |node| b.node(|| format!("pair {k}: one"), node);
                Ok(NodePair {
                    first: node(pair[0])?,
                    second: node(pair[1])?,
                    normal: normals.get(k).copied(),
                    gap: gaps.get(k).copied(),
                })
            });
            let pairs = pairs.collect::<brinell::Result<Vec<_>>>()?;
            b.contact_pairs(contact, &pairs).map(drop)
        }))
    }

    /// Holds a node set or surface along "x", "y", of a solid "z", or several of them ("xy"), in
    /// axes turned counter-clockwise by `angle` degrees; or, of a solid, along any one
    /// direction=(x, y, z). From the load factor `since` on the nodes are held where they then are;
    /// until=(held, free) lets them go: the support forces are taken away between the two.
    #[pyo3(signature = (on, fix = "", *, angle = None, direction = None, since = None, until = None))]
    #[allow(clippy::too_many_arguments)] // keywords
    fn support(
        &mut self,
        py: Python<'_>,
        on: &str,
        fix: &str,
        angle: Option<f64>,
        direction: Option<Vec<f64>>,
        since: Option<f64>,
        until: Option<[f64; 2]>,
    ) -> PyResult<()> {
        let fix = fix.chars().map(|c| match c {
            'x' => Ok(Direction::X),
            'y' => Ok(Direction::Y),
            'z' if self.dimension == 3 => Ok(Direction::Z),
            _ => Err(wrong(
                py,
                format!("{c:?} is no direction; give \"x\", \"y\", \"xy\" or the like"),
            )),
        });
        let direction = direction
            .map(|d| d.try_into().map_err(|why: String| wrong(py, why)))
            .transpose()?;
        let support = Support {
            on: on.to_string(),
            fix: fix.collect::<PyResult<_>>()?,
            angle,
            direction,
            since,
            until,
        };
        self.change(py, |b| {
            b.support(support);
            Ok(())
        })
    }

    /// Loads a surface or node set with one of force=(x, y), pressure=p, traction=(x, y) (of a
    /// solid three components), displacement={"y": -0.1}, plane_force={"direction": "y", "total":
    /// -1000}, kirsch={...}; name=..., history="proportional", "constant" or (n, 2).
    #[pyo3(signature = (on, **values))]
    fn load<'py>(
        &mut self,
        py: Python<'py>,
        on: &Bound<'py, PyAny>,
        values: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<()> {
        let load: Load = keywords(&with(values, &[("on", on)], py)?, "load")?;
        self.change(py, |b| {
            b.load(load);
            Ok(())
        })
    }

    /// Loads nodes with forces (n, 2), of a solid (n, 3), of their own, on the model itself (not
    /// the whole of a symmetric one).
    #[pyo3(signature = (name, nodes, forces, *, history = None))]
    fn nodal_load<'py>(
        &mut self,
        py: Python<'py>,
        name: &str,
        nodes: &Bound<'py, PyAny>,
        forces: &Bound<'py, PyAny>,
        history: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<()> {
        let what = format!("load `{name}`");
        let nodes = integers(nodes, &what)?;
        let forces = vectors(forces, self.dimension, &what)?;
        let history = match history {
            None => History::default(),
            Some(history) => {
                let on = name.into_pyobject(py)?.into_any();
                let entry = with(None, &[("history", history), ("on", &on)], py)?;
                keywords::<Load>(&entry, &what)?.history
            }
        };
        each_width!(py, nodes, |nodes| self.change(py, |b| {
            b.nodal_load(name, nodes, &forces, history).map(drop)
        }))
    }

    /// Adds a target of the load program, which leaves a state: one of load_factor=...,
    /// half_width=..., displacement={"on", "direction", "value"}, first_yield=True, residual_depth=...
    /// (body=...), contact_force=..., contact_area=... or max_pressure=... (contact=...), approach=...,
    /// max_equivalent_plastic_strain=...; name=..., fields=False. A model without one has load factor 1 as its target.
    #[pyo3(signature = (*, first_yield = false, **values))]
    fn target(
        &mut self,
        py: Python<'_>,
        first_yield: bool,
        values: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let mut target: Target = keywords(&with(values, &[], py)?, "target")?;
        target.first_yield = first_yield;
        self.program.targets.push(target);
        Ok(())
    }

    /// How the load program is measured and stepped: unit="load" or "yield", stepping="events" or
    /// "steps", steps=..., gamma=...
    #[pyo3(signature = (**values))]
    fn program<'py>(
        &mut self,
        py: Python<'py>,
        values: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<()> {
        let none = pyo3::types::PyList::empty(py).into_any();
        let targets = std::mem::take(&mut self.program.targets);
        let program = keywords::<Program>(&with(values, &[("targets", &none)], py)?, "program");
        match program {
            Ok(program) => self.program = Program { targets, ..program },
            Err(error) => {
                self.program.targets = targets;
                return Err(error);
            }
        }
        Ok(())
    }

    /// How to compute: yield_load="exact" or "secant", plastic_iteration="newton", "anderson" or
    /// "plain", tolerance=..., max_iterations=...
    #[pyo3(signature = (**values))]
    fn settings(&mut self, py: Python<'_>, values: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        let settings: Settings = keywords(&with(values, &[], py)?, "settings")?;
        self.builder.settings(settings);
        Ok(())
    }

    /// Runs the load program. `callback` gets a dictionary after each increment and stops the run
    /// by returning something true; `threads` as in
    /// `brinell.run`. The model may be changed and run again.
    #[pyo3(signature = (*, solver = None, callback = None, threads = None))]
    fn run(
        slf: &Bound<'_, Self>,
        solver: Option<&str>,
        callback: Option<Py<PyAny>>,
        threads: Option<i64>,
    ) -> PyResult<Py<RunResult>> {
        let py = slf.py();
        let way = Way {
            backend: backend(py, solver)?,
            callback,
            estimate: Effort::None,
            threads: threads::number(py, threads)?,
            budget: None,
        };
        let model = {
            let mut own = slf.try_borrow_mut()?;
            let program = own.program.clone();
            let builder: &ModelBuilder = own.builder.program(program);
            py.detach(|| contained(|| builder.build())).raise(py)?
        };
        execute(py, Source::Model(Box::new(model)), way)
    }

    fn __repr__(&self) -> String {
        format!(
            "<brinell.Model: {} nodes, {} elements>",
            self.builder.n_nodes(),
            self.builder.n_elements()
        )
    }
}

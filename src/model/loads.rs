//! Loads of a scene as vectors on the free freedoms.

use super::given::Given;
use super::load_case::{LoadCase, Magnitude, name, on_freedoms};
use super::names::SceneEntry;
use super::on_mesh::OnMesh;
use super::openings::{Opening, opened};
use super::tractions::{NodeForces, Tractions, area, integrate};
use super::{ContactSurface, Freedoms, Pair, Slot, volume_loads};
use crate::analytical::KirschField;
use crate::error::{Error, Result};
use crate::mesh::{Mesh, Surface};
use crate::scene::{self, Displacement, Field, History, Kirsch, LoadAction, NodeAction, Scene};
use crate::space::{Space, Vector, along, dot, length, unit};
use std::collections::BTreeMap;

pub(super) fn resolve(
    scene: &Scene,
    mesh: &Mesh,
    given: &Given,
    (freedoms, contacts): (&Freedoms, &[ContactSurface]),
) -> Result<Vec<LoadCase>> {
    scene
        .load
        .iter()
        .enumerate()
        .map(|(index, load)| {
            let mut case = resolve_load(index, load, (scene, contacts), mesh)?;
            if let Some(forces) = given.forces.get(&index) {
                case.nodal.clone_from(forces);
            }
            let start = given.carried.as_ref().map_or(0.0, |carried| carried.at);
            if !load.span().holds_from(start) {
                case.magnitude = 0.0;
            }
            case.nodal = freedoms.basis.share_of(case.nodal);
            for (_, opening) in &mut case.opens {
                opening.restate(&freedoms.basis);
            }
            case.forces = on_freedoms(&case.nodal, freedoms);
            Ok(case)
        })
        .collect()
}

/// Number of the load by which results are reported: the first load that varies, or the first of
/// all if none varies. Loads that act in all legs of the program come before others.
pub(super) fn leading(scene: &Scene, loads: &[LoadCase]) -> Option<usize> {
    let own = || loads.iter().enumerate();
    let varies = |load: &LoadCase| !matches!(load.history, History::Constant);
    let is_whole = |index: usize| {
        let entry = scene.load.get(index);
        entry.is_none_or(|load| load.span().is_whole())
    };
    let whole = own().find(|(index, load)| varies(load) && is_whole(*index));
    let any = || own().find(|(_, load)| varies(load));
    let first = (!loads.is_empty()).then_some(0);
    whole.or_else(any).map(|(index, _)| index).or(first)
}

/// Converts the forces to a new numbering of the freedoms.
pub(super) fn renumber(mut loads: Vec<LoadCase>, freedoms: &Freedoms) -> Vec<LoadCase> {
    for load in &mut loads {
        load.forces = on_freedoms(&load.nodal, freedoms);
    }
    loads
}

/// Adds to the gaps of pairs what prescribed displacements `d_k` of their masters `k` open:
/// `n . sum_k w_k d_k`, with the normal `n` from the slave towards the masters.
pub(super) fn open_by_moved_masters(
    loads: &mut [LoadCase],
    freedoms: &Freedoms,
    (pairs, contacts): (&[Pair], &[ContactSurface]),
) {
    for (index, contact) in contacts.iter().enumerate() {
        let mut of_loads: BTreeMap<usize, BTreeMap<usize, f64>> = BTreeMap::new();
        for pair in &pairs[contact.range.clone()] {
            for &(node, weight) in &pair.masters {
                for (slot, axis) in freedoms.of_node(node).iter().zip(freedoms.local(node)) {
                    freedoms.each(*slot, |slot, c| {
                        if let Slot::Prescribed(p) = slot {
                            let prescribed = freedoms.prescribed[p as usize];
                            let moved = weight * c * prescribed.value * dot(pair.normal, axis);
                            let gaps = of_loads.entry(prescribed.load).or_default();
                            *gaps.entry(pair.slave).or_default() += moved / pair.unit_gap;
                        }
                    });
                }
            }
        }
        for (load, gaps) in of_loads {
            loads[load].opens.push((index, Opening::At(gaps)));
        }
    }
}

/// Body to which the first of the given nodes belongs.
fn body_of(mesh: &Mesh, nodes: &[usize]) -> u32 {
    let holds = |e: &usize| {
        let first = nodes.first();
        first.is_some_and(|first| mesh.nodes(*e).contains(&(*first as u32)))
    };
    let element = (0..mesh.n_elements()).find(holds);
    element.map_or(0, |e| mesh.element_body[e])
}

fn resolve_load(
    index: usize,
    load: &scene::Load,
    (scene, contacts): (&Scene, &[ContactSurface]),
    mesh: &Mesh,
) -> Result<LoadCase> {
    let entry = SceneEntry::of_list(scene, "load", index);
    let action = match load.action() {
        Some(LoadAction::OnVolume(action)) => {
            return volume_loads::resolve(action, (index, load), scene, mesh);
        }
        Some(LoadAction::OnNodes(action)) => action,
        None => {
            let of_load = entry.on(&load.on);
            let why = format!("{of_load}: no kind of load is given");
            return Err(entry.refused(Error::input(why)));
        }
    };
    let nodes = entry.nodes(mesh, &load.on)?;
    let mut case = LoadCase {
        name: name(index, load),
        nodal: Vec::new(),
        forces: Vec::new(),
        history: load.history.clone(),
        magnitude: 0.0,
        measures: Magnitude::Force,
        shares: shares(scene.kind, mesh, &load.on, &nodes),
        body: body_of(mesh, &nodes),
        nodes,
        direction: [0.0; 3],
        free_strain: Vec::new(),
        opens: Vec::new(),
    };
    let of_load = |error: Error| entry.refused(error.within(entry.on(&load.on)));
    let surface = |key: &str| {
        let surface = mesh.surfaces.get(&load.on);
        let why = format!("`{key}` needs a surface, this is a node set");
        surface.ok_or_else(|| of_load(Error::input(why)))
    };
    let tractions = Tractions::new(scene, mesh, &entry, load);
    match action {
        NodeAction::Gap(gap) => {
            case.opens =
                opened(load, (scene, contacts), mesh, gap).map_err(|e| entry.refused(e))?;
            case.measures = Magnitude::Gap;
            let sizes = case.opens.iter().map(|(_, opening)| opening.largest());
            case.magnitude = sizes.fold(0.0, f64::max);
        }
        NodeAction::Force(force) => case.push(force.vector(), load, scene, mesh),
        NodeAction::Displacement(given) => case.displace(given, scene, mesh).map_err(of_load)?,
        NodeAction::Relative(relative) => {
            let moved = unit(relative.direction.axis()).map(|e| e * relative.value);
            case.set_size(moved, Magnitude::Displacement);
        }
        NodeAction::PlaneForce(plane) => {
            let mut force = [0.0; 3];
            force[plane.direction.axis()] = plane.total;
            case.set_size(force, Magnitude::Force);
            // The nodes share one freedom: the whole force may act on any of them.
            case.nodal = vec![(case.nodes[0], force.map(|f| f / scene.symmetry as f64))];
        }
        NodeAction::Pressure(pressure) => {
            case.press(tractions.of_pressure(pressure, surface("pressure")?)?, None);
        }
        NodeAction::Traction(traction) => {
            let found = tractions.of_vector(traction, surface("traction")?)?;
            case.press(found, traction.uniform());
        }
        NodeAction::Kirsch(kirsch) => case.pull(kirsch, surface("kirsch")?, scene, mesh),
    }
    Ok(case)
}

impl LoadCase {
    /// Distributes a total force: over a surface like a uniform traction, over the nodes of a set
    /// in equal parts.
    fn push(&mut self, force: Vector, load: &scene::Load, scene: &Scene, mesh: &Mesh) {
        self.set_size(force, Magnitude::Force);
        let share = force.map(|f| f / scene.symmetry as f64);
        self.nodal = match mesh.surfaces.get(&load.on) {
            Some(surface) => {
                let area = area(scene.kind, mesh, surface);
                integrate(scene.kind, mesh, surface, |_| share.map(|f| f / area))
            }
            None => {
                let n = self.nodes.len() as f64;
                let nodes = self.nodes.iter();
                nodes.map(|&i| (i, share.map(|f| f / n))).collect()
            }
        };
    }

    /// Stores the nodal forces of a pressure or traction on a surface, and its largest magnitude.
    /// The load has the direction of the traction if this is uniform, otherwise the direction of
    /// the resultant.
    fn press(&mut self, (nodal, largest): (NodeForces, f64), uniform: Option<Vector>) {
        self.nodal = nodal;
        match uniform {
            Some(uniform) => self.set_size(uniform, Magnitude::Stress),
            None => {
                self.set_size(total(&self.nodal), Magnitude::Stress);
                self.magnitude = largest;
            }
        }
    }

    /// Integrates the tractions of a plate with a hole.
    fn pull(&mut self, kirsch: Kirsch, surface: &Surface, scene: &Scene, mesh: &Mesh) {
        let Kirsch {
            stress_x,
            stress_y,
            radius,
        } = kirsch;
        let field = KirschField {
            stress_x,
            stress_y,
            radius,
        };
        self.nodal = integrate(scene.kind, mesh, surface, |point| {
            let (x, n) = (point.position, point.normal);
            let [sxx, syy, sxy] = field.stress(x[0], x[1]);
            [sxx * n[0] + sxy * n[1], sxy * n[0] + syy * n[1], 0.0]
        });
        self.set_size([stress_x, stress_y, 0.0], Magnitude::Stress);
        if stress_y == 0.0 || stress_x == 0.0 {
            self.magnitude = (stress_x + stress_y).abs();
        }
    }

    /// Sets magnitude (the largest at any node) and direction (the mean) of a prescribed
    /// displacement.
    fn displace(&mut self, given: &Displacement, scene: &Scene, mesh: &Mesh) -> Result<()> {
        let mut fields = Vec::new();
        for (axis, field) in given.components().into_iter().enumerate() {
            if let Some(field) = field {
                fields.push((axis, OnMesh::new(field, "displacement", scene, mesh)?));
            }
        }
        let (mut mean, mut largest) = ([0.0; 3], 0.0f64);
        for (&node, &share) in self.nodes.iter().zip(&self.shares) {
            let mut vector = [0.0; 3];
            for (axis, field) in &fields {
                vector[*axis] = field.at_node(node)?;
            }
            mean = along(mean, share, vector);
            largest = largest.max(length(vector));
        }
        // A uniform displacement is set directly, without the round-off of a mean.
        let uniform = given
            .components()
            .map(|field| field.map_or(Some(0.0), Field::uniform));
        match uniform {
            [Some(x), Some(y), Some(z)] => self.set_size([x, y, z], Magnitude::Displacement),
            _ => {
                self.set_size(mean, Magnitude::Displacement);
                self.magnitude = largest;
            }
        }
        Ok(())
    }
}

/// Share of each node in the mean over a surface or node set.
fn shares(space: Space, mesh: &Mesh, name: &str, nodes: &[usize]) -> Vec<f64> {
    let equal = || vec![1.0 / nodes.len() as f64; nodes.len()];
    let Some(surface) = mesh
        .surfaces
        .get(name)
        .filter(|_| !mesh.node_sets.contains_key(name))
    else {
        return equal();
    };
    // Areas and nodes are in the same order, since both are sorted by node number.
    let areas = integrate(space, mesh, surface, |_| unit(0));
    let whole: f64 = areas.iter().map(|(_, a)| a[0]).sum();
    if areas.len() == nodes.len() && whole > 0.0 {
        areas.iter().map(|(_, a)| a[0] / whole).collect()
    } else {
        equal()
    }
}

fn total(nodal: &[(usize, Vector)]) -> Vector {
    let sum = |s: Vector, f: &Vector| std::array::from_fn(|d| s[d] + f[d]);
    nodal.iter().fold([0.0; 3], |s, (_, f)| sum(s, f))
}

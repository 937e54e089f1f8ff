//! Resolution of a scene on a mesh: names become indices, surfaces become pairs, and loads become
//! forces on freedoms.

use super::contact_basis::ContactBasis;
use super::followers::Followers;
use super::given::Given;
use super::load_program::LoadProgram;
use super::{
    ContactSurface, Continuum, Freedoms, LoadCase, Mirror, Model, Origin, Pair, alike, ends,
    equations, fitness, held, initial_strain, loads, pairs, plausible, yield_depth,
};
use crate::error::{Error, Result};
use crate::material::Material;
use crate::mesh::{self, Mesh};
use crate::scene::{Plastic, Scene};
use std::path::Path;

/// Makes or reads the mesh of a scene.
///
/// # Errors
/// The mesh cannot be made, read, refined or extruded; the message begins with the place of the
/// responsible key in the scene file, if it is known.
pub(super) fn build_mesh(scene: &Scene) -> Result<Mesh> {
    let folder = scene.file.as_deref().and_then(Path::parent);
    let made = mesh::generate::from_source(
        &scene.mesh,
        folder,
        |p| mesh::generate::contact_size::of(scene, p),
        |p| mesh::generate::ellipse_size::of(scene, p),
    );
    let mesh = made.map_err(|error| match scene.mesh.file {
        // Messages about a deck name its file and line themselves.
        Some(_) if scene.requests.is_of_deck() => error,
        Some(_) => scene.places.in_front("mesh.file", error),
        None => scene.places.in_front("mesh", error),
    })?;
    let places = mesh::last_place(&mesh);
    let mut mesh = refined(scene, mesh)?;
    mesh.places = places;
    Ok(mesh)
}

/// Lays the mesh of a scene on its declared curves, refines it and sweeps it into a solid.
///
/// # Errors
/// Errors of [`build_mesh`].
fn refined(scene: &Scene, mut mesh: Mesh) -> Result<Mesh> {
    let declared = mesh::declared(&scene.mesh);
    mesh.name_parts(declared.iter().map(|(_, on, _)| *on));
    for (key, on, curve) in declared {
        mesh::lay_on(&mut mesh, on, curve).map_err(|error| {
            let error = error.within(format!("{key} (`{on}`)"));
            scene.places.in_front(&key, error)
        })?;
    }
    // Only now can the parts `body.set` of a surface take over its exact shape.
    mesh.name_parts(scene.set_names());
    let times = scene.mesh.subdivisions;
    if times > 0 {
        // Errors in the file are reported with the file's own numbers.
        mesh::validate(&mesh)?;
        mesh = mesh::subdivided(mesh, times, &scene.contact)?;
        mesh::validate(&mesh).map_err(|e| {
            e.within(
                "the subdivided mesh (does a surface that is declared round sag by more than \
                      the depth of the elements along it?)",
            )
        })?;
    }
    if !scene.mesh.refine.is_empty() {
        mesh::validate(&mesh)?;
        let found = mesh::refined(mesh, &scene.mesh.refine, &scene.contact);
        mesh = found.map_err(|error| scene.places.in_front("mesh.refine", error))?;
    }
    let (key, solid) = match (&scene.mesh.extrude, &scene.mesh.revolve) {
        (Some(extrusion), _) => ("mesh.extrude", mesh::extruded(&mesh, extrusion)),
        (_, Some(revolution)) => ("mesh.revolve", mesh::revolved(&mesh, revolution)),
        _ => return Ok(mesh),
    };
    solid.map_err(|error| scene.places.in_front(key, error.within(key)))
}

/// Resolves a scene on a mesh for one leg of its program.
///
/// # Errors
/// Errors of [`Model::new`].
pub(super) fn model(scene: &Scene, mut mesh: Mesh, origin: Origin) -> Result<Model> {
    let none = Given::default();
    let given = match &origin {
        Origin::Scene => &none,
        Origin::Arrays(given) => given,
    };
    let kind = scene.kind;
    let rigid = fitness::prepare(scene, &mut mesh, origin.mesh_file(scene))?;
    let mut warnings = scene.warnings.clone();
    warnings.extend(std::mem::take(&mut mesh.notes));
    warnings.extend(plausible::of_temperatures(scene));
    let (materials, may_yield) = resolve_bodies(scene, &mesh)?;
    warnings.extend(plausible::of_materials(scene));
    fitness::warn_of_locking(scene, &mesh, &may_yield, &mut warnings);
    warnings.extend(mesh::warning_of_folds(&mesh));
    if kind.is_axisymmetric() {
        fitness::check_radii(&mesh)?;
    }
    let (mut pairs, mut contacts) = pairs::resolve(scene, &mesh, (given, &rigid), &mut warnings)?;
    let ties = pairs::ties::resolve(scene, &mesh, &contacts, &mut warnings)?;
    let basis = ContactBasis::of(&mesh, &pairs, &contacts, &ties)?;
    let equations = equations::resolve(scene, &mesh, given.carried.as_ref())?;
    let normals = pairs::mortar::master_normals(&mesh, &pairs, &contacts);
    let (mut freedoms, followers) = Freedoms::new(
        scene,
        &mesh,
        basis,
        &mut pairs,
        &normals,
        (&ties, &equations, &rigid),
        given.carried.as_ref(),
    )?;
    warnings.extend(settle(&mut mesh, &mut freedoms, &followers)?);
    freedoms.basis.restate(&mut pairs, &contacts);
    let stated = (&mut pairs[..], &contacts[..]);
    pairs::stated::at_control_points(scene, &mesh, &freedoms.basis, stated)?;
    let of_bodies = (&materials[..], &contacts[..]);
    let loads = load_cases(scene, &mesh, given, &freedoms, &pairs, of_bodies)?;
    let program = LoadProgram::resolve(scene, &mesh)?;
    let (floating, rows) = held::resolve(
        kind,
        &mesh,
        &mut freedoms,
        (&pairs, &contacts),
        &loads,
        &mut warnings,
    )?;
    let loads = loads::renumber(loads, &freedoms);
    ends::find(scene, &mesh, (&pairs, &ties), &mut contacts);
    let yield_by_depth = yield_depth::resolve(scene, &mesh, &materials, &contacts)?;
    if matches!(origin, Origin::Scene) {
        warnings.extend(mesh::generate::contact_size::warning(scene));
    }
    let model = Model {
        scene: scene.clone(),
        program,
        settings: scene.analysis.clone(),
        continuum: Continuum {
            kind,
            formulation: scene.mesh.formulation,
            mesh,
            materials,
            may_yield,
            yield_by_depth,
            point_values: scene.requests.point_values,
        },
        freedoms,
        pairs,
        rows,
        contacts,
        alike: alike::alike(&loads, loads::leading(scene, &loads)),
        loads,
        floating,
        symmetry: scene.symmetry as f64,
        warnings,
        start: None,
        origin,
    };
    Ok(completed(model))
}

/// Adds what is found on the whole model: the mirrors of its contacts, and warnings about its
/// program and its symmetry.
fn completed(mut model: Model) -> Model {
    let mirrors = Mirror::of_contacts(&model);
    for (contact, mirrors) in model.contacts.iter_mut().zip(mirrors) {
        contact.mirrors = mirrors;
    }
    let warnings = [
        plausible::of_program(&model),
        Vec::from_iter(plausible::of_symmetry(&model)),
    ];
    model.warnings.extend(warnings.into_iter().flatten());
    model
}

/// Load cases of the scene, of displacements carried over from an earlier leg, and of the initial
/// strains of bodies. Masters that loads move open or close their contacts.
fn load_cases(
    scene: &Scene,
    mesh: &Mesh,
    given: &Given,
    freedoms: &Freedoms,
    pairs: &[Pair],
    (materials, contacts): (&[Material], &[ContactSurface]),
) -> Result<Vec<LoadCase>> {
    let mut loads = loads::resolve(scene, mesh, given, (freedoms, contacts))?;
    if let Some(carried) = &given.carried {
        carried.add_cases(scene, (&mut loads, freedoms));
    }
    loads::open_by_moved_masters(&mut loads, freedoms, (pairs, contacts));
    let of_bodies = (materials, contacts);
    loads.extend(initial_strain::resolve(scene, mesh, of_bodies, freedoms)?);
    Ok(loads)
}

/// Material of each body of the mesh, and whether the body may yield.
fn resolve_bodies(scene: &Scene, mesh: &Mesh) -> Result<(Vec<Material>, Vec<bool>)> {
    for name in scene.bodies.keys() {
        if !mesh.bodies.contains(name) {
            let error = Error::input(format!(
                "bodies.{name}: the mesh has no body of this name; it has {}",
                mesh.bodies.join(", ")
            ));
            return Err(scene.places.in_front(&format!("bodies.{name}"), error));
        }
    }
    let mut materials: Vec<Material> = Vec::new();
    let mut may_yield = Vec::new();
    for name in &mesh.bodies {
        if scene.rigid.contains_key(name) {
            // A rigid surface is never strained, so any material will do. With similar moduli the
            // round-off is similar, too.
            materials.extend(materials.first().cloned());
            may_yield.push(false);
            continue;
        }
        let body = scene.bodies.get(name).ok_or_else(|| {
            let error = Error::input(format!(
                "body `{name}` of the mesh has no [bodies.{name}] entry with its material"
            ));
            scene.places.in_front("bodies", error)
        })?;
        let data = scene.material_of(name).ok_or_else(|| {
            let error = Error::input(format!(
                "bodies.{name}: there is no material `{}`",
                body.material
            ));
            scene.places.in_front(&format!("bodies.{name}"), error)
        })?;
        let material = Material::new(&body.material, &data, scene.kind);
        may_yield.push(body.plastic != Plastic::No && material.hardening.is_some());
        materials.push(material);
    }
    Ok((materials, may_yield))
}

/// Moves nodes that follow others to where they follow without strain. If this would damage the
/// mesh, they stay where they are, and a warning is returned.
///
/// # Errors
/// Ties and equations that form a circle.
fn settle(
    mesh: &mut Mesh,
    freedoms: &mut Freedoms,
    followers: &Followers,
) -> Result<Option<String>> {
    let before = mesh.coordinates.clone();
    if !followers.settle(freedoms, mesh)? {
        return Ok(None);
    }
    Ok(mesh::validate(mesh).err().map(|error| {
        mesh.coordinates = before;
        format!(
            "tied nodes stay where they are, and bodies that turn together strain a little: moved \
             onto what they follow, {}",
            error.message()
        )
    }))
}

//! Size of the contact of a generated cylinder or ball, to which the mesh is fitted. Hertz's theory
//! is used for this size only: it influences results through the mesh alone.

use super::cylinder::{PLANE_FAR_SIZE, ROUND_FAR_SIZE};
use super::{ContactSize, WIDEST};
use crate::analytical::{self, HertzLine, HertzPoint};
use crate::error::{Error, Result};
use crate::root;
use crate::scene::{
    CylinderOnHalfPlane, Direction, Displacement, DisplacementTarget, History, Load, Plastic,
    Scene, TargetFigure, Unit,
};
use std::f64::consts::PI;

/// Factor by which the mesh of an elastic contact is wider than Hertz's contact, so that results
/// can be evaluated beside its edge.
const ROOM: f64 = 1.15;
/// Ratio of the mean pressure under a ball to the yield stress when yielding is fully developed.
///
/// # Source
/// D. Tabor, The Hardness of Metals (1951), chapter 4.
pub(super) const FULLY_PLASTIC: f64 = 3.0;
/// Largest ratio of the squared contact radius to `2 R h`, with the depth `h`: the pile-up of a
/// material without hardening.
///
/// # Source
/// R. Hill, B. Storakers, A. B. Zdunek, A theoretical study of the Brinell hardness test, Proc. R.
/// Soc. A 423 (1989) 301, doi:10.1098/rspa.1989.0056.
pub(super) const PILE_UP: f64 = 1.45;

/// The size of the contact at first yield, and the largest size in the load program.
///
/// # Errors
/// `Input` if a body has no material, or if no body has a yield stress and the half width at first
/// yield is not given.
pub(crate) fn of(scene: &Scene, p: &CylinderOnHalfPlane) -> Result<ContactSize> {
    let half_width = match p.half_width {
        Some(given) => given,
        None => first_yield(scene, p)?
            .map(|first| first.half_width)
            .ok_or_else(|| {
                Error::input(
                    "mesh.cylinder_on_half_plane: no body has a yield stress, so the contact half \
                     width at yield is unknown; give `half_width`",
                )
            })?,
    };
    let reach = match p.contact_width {
        Some(width) => width * half_width,
        None => reach(scene, p, half_width).unwrap_or(0.0),
    };
    Ok(ContactSize {
        half_width,
        reach,
        far_size: far_size(scene, p),
    })
}

/// Size of each body, in half widths, as given or by default.
pub(crate) fn far_size(scene: &Scene, p: &CylinderOnHalfPlane) -> f64 {
    let round = scene.mesh.section(scene.kind).is_axisymmetric();
    p.far_size.unwrap_or(match round {
        true => ROUND_FAR_SIZE,
        false => PLANE_FAR_SIZE,
    })
}

/// Hertz's solution for a line contact or a point contact.
enum Hertz {
    Line(HertzLine),
    Point(HertzPoint),
}

impl Hertz {
    fn of(scene: &Scene, p: &CylinderOnHalfPlane) -> Result<Self> {
        let of = |body: &str| {
            scene.material_of(body).ok_or_else(|| {
                Error::input(format!(
                    "the generator cylinder_on_half_plane needs a body `{body}` with a material"
                ))
            })
        };
        let (a, b) = (of(&p.names[0])?, of(&p.names[1])?);
        let modulus = analytical::contact_modulus(
            a.youngs_modulus,
            a.poissons_ratio,
            b.youngs_modulus,
            b.poissons_ratio,
        );
        Ok(if scene.mesh.section(scene.kind).is_axisymmetric() {
            Hertz::Point(HertzPoint::new(p.radius, modulus)?)
        } else {
            Hertz::Line(HertzLine::new(p.radius, modulus)?)
        })
    }

    fn half_width(&self, load: f64) -> f64 {
        match self {
            Hertz::Line(line) => line.half_width(load),
            Hertz::Point(point) => point.contact_radius(load),
        }
    }

    fn at_yield(&self, nu: f64, yield_stress: f64) -> YieldInContact {
        let y = yield_stress;
        let (half_width, load) = match self {
            Hertz::Line(line) => (line.yield_half_width(nu, y), line.yield_load(nu, y)),
            Hertz::Point(point) => (point.yield_contact_radius(nu, y), point.yield_load(nu, y)),
        };
        YieldInContact {
            half_width,
            load,
            yield_stress,
            poissons_ratio: nu,
        }
    }

    /// Expected half width of the contact under a load. For a ball of radius `R` it follows from
    /// equating the load to the contact area times the smallest of three mean pressures: the
    /// elastic one (Hertz), the pressure with a plastic core in an elastic body, and the pressure
    /// of fully developed yielding. The second, divided by the yield stress `Y`, is
    ///
    /// ```text
    /// 2/3 (2 + ln((E* a/(R Y) + 4 (1 - 2 nu))/(6 (1 - nu)))).
    /// ```
    ///
    /// # Source
    /// K. Johnson, Contact Mechanics (1985), eq. (6.36).
    fn expected(&self, load: f64, first: Option<YieldInContact>) -> f64 {
        let (Hertz::Point(_), Some(first)) = (self, first.filter(|first| load > first.load)) else {
            return self.widest(load, first);
        };
        // Hertz's mean pressure is proportional to the contact radius.
        let at_yield = first.load / (PI * first.half_width.powi(2));
        let force = |a: f64| {
            let hertz = at_yield * a / first.half_width;
            let nu = first.poissons_ratio;
            // E* a/R equals 3 pi/4 times Hertz's mean pressure.
            let strain = 0.75 * PI * hertz / first.yield_stress;
            let core = (strain + 4.0 * (1.0 - 2.0 * nu)) / (6.0 * (1.0 - nu));
            let plastic = (2.0 / 3.0 * (2.0 + core.ln())).min(FULLY_PLASTIC);
            PI * a * a * hertz.min(plastic * first.yield_stress)
        };
        ROOM * root::of(
            |a| force(a) - load,
            first.half_width,
            self.widest(load, Some(first)),
        )
    }

    /// The widest possible contact under a load if the weaker body yields at `first`. The mean
    /// pressure only rises with the load (from 1.1 to 3 times the yield stress under a ball), so
    /// the area grows no faster than the load.
    fn widest(&self, load: f64, first: Option<YieldInContact>) -> f64 {
        let elastic = ROOM * self.half_width(load);
        let Some(first) = first.filter(|first| load > first.load) else {
            return elastic;
        };
        let area = load / first.load;
        elastic.max(match self {
            Hertz::Line(_) => first.half_width * area,
            Hertz::Point(_) => first.half_width * area.sqrt(),
        })
    }
}

/// Values at first yield of a body in contact.
#[derive(Clone, Copy)]
struct YieldInContact {
    half_width: f64,
    load: f64,
    yield_stress: f64,
    poissons_ratio: f64,
}

/// First yield of the weaker of the two bodies; `None` if neither has a yield stress. A body
/// declared elastic counts too, because the mesh is fitted to its yield stress.
fn first_yield(scene: &Scene, p: &CylinderOnHalfPlane) -> Result<Option<YieldInContact>> {
    weaker(scene, p, |_| true)
}

fn weaker(
    scene: &Scene,
    p: &CylinderOnHalfPlane,
    counts: impl Fn(Plastic) -> bool,
) -> Result<Option<YieldInContact>> {
    let hertz = Hertz::of(scene, p)?;
    let of = |name: &String| {
        let body = scene.bodies.get(name).filter(|b| counts(b.plastic))?;
        let material = scene.material_of(name)?;
        let yield_stress = body.largest_yield_stress(&material)?;
        Some(hertz.at_yield(material.poissons_ratio, yield_stress))
    };
    let bodies = p.names.iter().filter_map(of);
    Ok(bodies.reduce(|a, b| if b.half_width < a.half_width { b } else { a }))
}

/// The widest contact of the load program; `None` if it cannot be determined from the loads.
fn reach(scene: &Scene, p: &CylinderOnHalfPlane, half_width: f64) -> Option<f64> {
    let most = Largest::of(scene, p, half_width)?;
    let by_load = most
        .hertz
        .widest(most.force, most.first)
        .max(ROOM * most.asked);
    let by_depth = (2.0 * PILE_UP * p.radius * most.depth).sqrt();
    Some(by_load.max(by_depth).max(most.dented(p.radius)))
}

/// A warning, given before the run, if the contact may become wider than its candidates. Prescribed
/// displacements are not considered: how much of them deforms the rest of the bodies is not known
/// in advance.
pub(crate) fn warning(scene: &Scene) -> Option<String> {
    let p = scene.mesh.cylinder_on_half_plane.as_ref()?;
    let ContactSize {
        half_width, reach, ..
    } = of(scene, p).ok()?;
    let most = Largest::of(scene, p, half_width)?;
    let wanted = most
        .hertz
        .expected(most.force, most.first)
        .max(ROOM * most.asked);
    let given = p.contact_width.unwrap_or(0.0).max(p.fine_width) * half_width;
    let candidates = reach.max(given).min(WIDEST * p.radius);
    if wanted <= candidates {
        return None;
    }
    let remedy = if wanted > WIDEST * p.radius {
        format!(
            "that is more than {WIDEST} of the radius {}, far beyond small displacements: check \
             load, radius and units",
            p.radius
        )
    } else {
        format!(
            "give mesh.cylinder_on_half_plane.contact_width = {:.2}, or leave it out",
            wanted / half_width
        )
    };
    Some(format!(
        "under the largest load of the program the half width of contact may reach {wanted:.4}; \
         its candidates end at {candidates:.4}, and a contact that reaches their end stops the \
         run: {remedy}"
    ))
}

/// The largest values that a load program demands of a contact.
struct Largest {
    hertz: Hertz,
    /// First yield of the weaker of the bodies that are allowed to yield.
    first: Option<YieldInContact>,
    /// Largest contact force of the program.
    force: f64,
    /// Largest half width that a target prescribes.
    asked: f64,
    /// Largest displacement of the bodies towards each other.
    depth: f64,
    /// Largest dent that a target prescribes.
    dent: f64,
}

impl Largest {
    /// Evaluates the load program; `None` if Hertz's contact or first yield cannot be computed.
    fn of(scene: &Scene, p: &CylinderOnHalfPlane, half_width: f64) -> Option<Self> {
        let hertz = Hertz::of(scene, p).ok()?;
        let first = weaker(scene, p, |plastic| plastic != Plastic::No).ok()?;
        let program = &scene.program;
        let targets = || program.targets.iter();
        let figures = |figure| targets().filter_map(move |t| t.value_of(figure));
        let largest =
            |values: &mut dyn Iterator<Item = f64>| values.fold(0.0f64, |m, v| m.max(v.abs()));
        let factor = largest(&mut targets().filter_map(|t| t.load_factor));
        let size = far_size(scene, p) * half_width;
        let mut depth = largest(&mut targets().map(|t| asked_for(t.displacement.as_ref())));
        depth = depth.max(largest(&mut figures(TargetFigure::Approach)));
        let mut force = 0.0;
        for load in &scene.load {
            let times = match &load.history {
                History::Proportional if program.unit == Unit::Yield => {
                    // Load factors are multiples of the yield load, whatever the size of the load
                    // itself.
                    force = first.map_or(force, |first| factor * first.load);
                    continue;
                }
                History::Proportional => factor,
                History::Constant => 1.0,
                History::Table(rows) => largest(&mut rows.iter().map(|row| row[1])),
            };
            force += times * normal_force(scene, p, load, size);
            depth += times * prescribed(load.displacement.as_ref());
        }
        depth += largest(
            &mut scene
                .contact
                .iter()
                .filter_map(|c| c.interference.uniform()),
        );
        let at_yield = first.map_or(half_width, |first| first.half_width);
        let asked = largest(&mut targets().filter_map(|t| t.half_width)) * at_yield;
        let area = largest(&mut figures(TargetFigure::ContactArea));
        let by_area = match hertz {
            Hertz::Line(_) => 0.5 * area,
            Hertz::Point(_) => (area / PI).sqrt(),
        };
        Some(Largest {
            hertz,
            first,
            force: force.max(largest(&mut figures(TargetFigure::ContactForce))),
            asked: asked.max(by_area),
            depth,
            dent: largest(&mut figures(TargetFigure::ResidualDepth)),
        })
    }

    /// Upper bound of the contact radius when the prescribed dent has been made. With the depth `d`
    /// of the dent and the elastic sinking `P/(2 a E*)` of a fully plastic contact of radius `a`
    /// and load `P = 3 Y pi a^2`, the square of the radius is at most `2 R (d + P/(2 a E*))` times
    /// the pile-up. `Y/E*` is bounded by means of the mean pressure at first yield,
    /// `4 E* a_1/(3 pi R)` under a ball, which is no less than the yield stress.
    ///
    /// # Source
    /// I. Sneddon, Int. J. Engng Sci. 3 (1965) 47: a flat punch sinks by `P/(2 a E*)`.
    fn dented(&self, radius: f64) -> f64 {
        let Some(first) = self.first.filter(|_| self.dent > 0.0) else {
            return 0.0;
        };
        let yield_strain = 4.0 * first.half_width / (3.0 * PI * radius);
        let elastic = 0.5 * FULLY_PLASTIC * PI * yield_strain;
        // a^2 = c (d + e a)
        let c = 2.0 * PILE_UP * radius;
        0.5 * (c * elastic + ((c * elastic).powi(2) + 4.0 * c * self.dent).sqrt())
    }
}

/// Displacement along y that a target prescribes. Not inlined, for the reason given at
/// [`prescribed`].
#[inline(never)]
fn asked_for(displacement: Option<&DisplacementTarget>) -> f64 {
    displacement.map_or(0.0, |d| match d.direction {
        Direction::Y => d.value,
        _ => 0.0,
    })
}

/// Size of a prescribed displacement along y, if it is a number. Not inlined: otherwise the tag of
/// `y` would be read before the tag of the displacement, which memory checkers report in programs
/// written in C.
#[inline(never)]
fn prescribed(displacement: Option<&Displacement>) -> f64 {
    let along_y = displacement.and_then(|d| d.y.as_ref()?.uniform());
    along_y.map_or(0.0, f64::abs)
}

/// Total force along y of a load on the whole cylinder or ball, as far as the kind and place of the
/// load determine it. The mesh is half a cylinder or a sector of a ball; a total force in the scene
/// acts on `symmetry` such models together.
fn normal_force(scene: &Scene, p: &CylinderOnHalfPlane, load: &Load, size: f64) -> f64 {
    // Number of such models that make up the ball, or a unit length of the cylinder.
    let (models, area) = match (&scene.mesh.extrude, &scene.mesh.revolve) {
        (Some(extrude), _) => (2.0 / extrude.depth, size * extrude.depth),
        (_, Some(revolve)) => {
            let share = revolve.angle / 360.0;
            (1.0 / share, PI * size * size * share)
        }
        _ if scene.kind.is_axisymmetric() => (1.0, PI * size * size),
        _ => (2.0, size),
    };
    let [above, below] = &p.names;
    let on_cut = [format!("{above}.top"), format!("{below}.bottom")].contains(&load.on);
    let on_area = |stress: f64| if on_cut { stress * area } else { 0.0 };
    let of_model = |total: f64| total / scene.symmetry as f64;
    models * load.pushes_along(Direction::Y, of_model, on_area)
}

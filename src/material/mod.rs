//! Linear elasticity and von Mises plasticity at a point.
//!
//! Stress and strain are vectors `[xx, yy, zz, xy | yz, zx]` (axisymmetric: `[rr, zz, tt, rz]`) of
//! S = 4 components in the plane, 6 in space; shear strains are engineering strains `gamma`. The
//! elastic law is `sigma = D (eps - eps_p)`, isotropic ([`Lame`]); plastic flow is associated with
//! isotropic ([`Hardening`]) and kinematic hardening ([`BackStresses`]), integrated by the implicit
//! (closest point) rule.

mod back_stresses;
mod hardening;
mod lame;
mod plane_stress;
mod radial_return;
mod strain_path;

pub use back_stresses::BackStresses;
pub use hardening::Hardening;
pub use lame::{Lame, Softening};
pub use strain_path::Memory;

use crate::root::{self, RootTolerance};
use crate::scene;
use crate::space::Space;
use serde::{Deserialize, Serialize};

/// A material: linear elastic, and plastic if it has a hardening curve.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Material {
    /// Name of the material in the scene.
    pub name: String,
    /// Young's modulus E.
    pub youngs_modulus: f64,
    /// Poisson's ratio nu.
    pub poissons_ratio: f64,
    /// Yield stress against equivalent plastic strain; `None` for an elastic material.
    pub hardening: Option<Hardening>,
    /// Kinematic hardening: the back stresses that move the yield surface.
    pub back_stresses: BackStresses,
    /// Idealisation of space, which decides the elastic matrix and the return mapping.
    pub space: Space,
}

/// Plastic history at a Gauss point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound(
    serialize = "[f64; S]: Serialize",
    deserialize = "[f64; S]: Deserialize<'de>"
))]
pub struct PlasticState<const S: usize = 4> {
    /// Plastic strain, trace 0.
    pub strain: [f64; S],
    /// Equivalent plastic strain, the time integral of `sqrt(2/3 deps_p : deps_p)`.
    pub equivalent: f64,
}

impl<const S: usize> Default for PlasticState<S> {
    fn default() -> Self {
        PlasticState {
            strain: [0.0; S],
            equivalent: 0.0,
        }
    }
}

impl<const S: usize> PlasticState<S> {
    /// Converts to another number of components; components that are missing become zero.
    pub(crate) fn resized<const T: usize>(&self) -> PlasticState<T> {
        PlasticState {
            strain: resized(&self.strain),
            equivalent: self.equivalent,
        }
    }
}

/// Converts a tensor to another number of components; missing components become zero.
pub(crate) fn resized<const S: usize, const T: usize>(tensor: &[f64; S]) -> [f64; T] {
    std::array::from_fn(|i| tensor.get(i).copied().unwrap_or(0.0))
}

/// History of a point before an increment.
#[derive(Debug, Clone, Copy)]
pub struct Past<'a, const S: usize> {
    /// Plastic history of the point.
    pub state: &'a PlasticState<S>,
    /// Strains of the fading back stresses, in the order of the material's: engineering shear,
    /// trace 0.
    pub back: &'a [[f64; S]],
    /// Yield stress at the point minus that of the material.
    pub harder: f64,
}

impl<const S: usize> Past<'_, S> {
    /// Yield stress after an increment `d` of equivalent plastic strain.
    #[inline]
    fn yield_stress(&self, hardening: &Hardening, d: f64) -> f64 {
        hardening.yield_stress(self.state.equivalent + d) + self.harder
    }
}

/// Result of integrating the flow rule over an increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Update<const S: usize> {
    /// Plastic history at the end of the increment.
    pub state: PlasticState<S>,
    /// Reduction `D - D_ep` of the elastic stiffness by plastic flow; zero if elastic.
    pub softening: Softening<S>,
    /// Remaining part of `D - D_ep`, as the dyad of this stress and the softening's normal: the
    /// direction of flow turns as back stresses fade. Zero without fading back stresses.
    pub turn: [f64; S],
    /// Whether plastic flow took place.
    pub yields: bool,
}

impl Material {
    /// Converts the material of a scene.
    pub fn new(name: &str, data: &scene::Material, space: Space) -> Self {
        Material {
            name: name.to_string(),
            youngs_modulus: data.youngs_modulus,
            poissons_ratio: data.poissons_ratio,
            hardening: Hardening::from_scene(data),
            back_stresses: BackStresses::new(data.back_stresses()),
            space,
        }
    }

    /// Shear modulus `G = E / (2 (1 + nu))`.
    pub(crate) fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))
    }

    /// Work on plastic strains per volume, 0 for an elastic material: `int sigma_y deps_p` over the
    /// equivalent plastic strain, and the work that the back stresses store (`C/3 z:z`). Work that
    /// the back stresses have lost by fading is not included ([`BackStresses::carry`]).
    pub fn plastic_work<const S: usize>(&self, past: &Past<S>) -> f64 {
        let equivalent = past.state.equivalent;
        let worked = |h: &Hardening| h.work(equivalent) + past.harder * equivalent;
        let held = self.back_stresses.held(&past.state.strain, past.back);
        self.hardening.as_ref().map_or(0.0, worked) + held
    }

    /// Stress for a total strain minus the back stress, on which the yield condition is based.
    #[inline]
    fn relative_stress<const S: usize>(
        &self,
        law: &Lame,
        strain: &[f64; S],
        old: &Past<S>,
    ) -> [f64; S] {
        let mut out = law.stress(strain, &old.state.strain);
        if !self.back_stresses.is_none() {
            let plastic = &old.state.strain;
            self.back_stresses.take_off(&mut out, plastic, old.back);
        }
        out
    }

    /// Initial yield stress; infinite for an elastic material.
    pub fn yield_stress(&self) -> f64 {
        self.hardening
            .as_ref()
            .map_or(f64::INFINITY, |h| h.yield_stress(0.0))
    }

    /// Elastic law. In plane stress `lambda* = 2 lambda mu/(lambda + 2 mu)` replaces `lambda`, and
    /// `zz` takes no part.
    pub fn lame(&self) -> Lame {
        let (e, nu, mu) = (
            self.youngs_modulus,
            self.poissons_ratio,
            self.shear_modulus(),
        );
        match self.space {
            Space::PlaneStress => Lame {
                // This is 2 lambda mu/(lambda + 2 mu) without the pole at nu = 1/2.
                lambda: e * nu / (1.0 - nu * nu),
                mu,
                across: 0.0,
            },
            Space::PlaneStrain | Space::Axisymmetric | Space::Solid => Lame {
                lambda: e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
                mu,
                across: 1.0,
            },
        }
    }

    /// Trial stress of a total strain without further flow, minus the back stress, and the
    /// hardening; `None` if the trial stress lies within the yield surface. NaN counts as outside.
    #[inline]
    fn beyond_yield<const S: usize>(
        &self,
        law: &Lame,
        strain: &[f64; S],
        old: &Past<S>,
    ) -> Option<(&Hardening, [f64; S])> {
        let hardening = self.hardening.as_ref()?;
        let trial = self.relative_stress(law, strain, old);
        let within = von_mises(&trial) <= old.yield_stress(hardening, 0.0);
        (!within).then_some((hardening, trial))
    }

    /// Whether a total strain lies within the yield surface of a history, in which case
    /// [`Material::integrate`] changes nothing.
    #[inline]
    pub(crate) fn stays_elastic<const S: usize>(
        &self,
        law: &Lame,
        strain: &[f64; S],
        old: &Past<S>,
    ) -> bool {
        self.beyond_yield(law, strain, old).is_none()
    }

    /// Integrates the flow rule, given the total strain at the end of the increment and the history
    /// at its start. `law` is [`Material::lame`], passed in because the caller already has it.
    ///
    /// # Source
    /// J. C. Simo, T. J. R. Hughes, *Computational Inelasticity* (1998), boxes 3.1 to 3.3.
    pub(crate) fn integrate<const S: usize>(
        &self,
        law: &Lame,
        strain: &[f64; S],
        old: &Past<S>,
    ) -> Update<S> {
        let Some((hardening, trial)) = self.beyond_yield(law, strain, old) else {
            return Update {
                state: *old.state,
                softening: Softening::NONE,
                turn: [0.0; S],
                yields: false,
            };
        };
        match self.space {
            Space::PlaneStress => plane_stress::integrate(self, hardening, &trial, old),
            _ => radial_return::integrate(self, hardening, &trial, old),
        }
    }

    /// Integrates the flow rule like [`Material::integrate`], without the tangent; not in plane
    /// stress.
    fn flow<const S: usize>(
        &self,
        law: &Lame,
        strain: &[f64; S],
        old: &Past<S>,
    ) -> radial_return::PlasticFlow<S> {
        match self.beyond_yield(law, strain, old) {
            Some((hardening, trial)) => radial_return::flow(self, hardening, &trial, old),
            None => radial_return::PlasticFlow::none(*old.state),
        }
    }
}

/// Finds the increment of equivalent plastic strain at which the excess over the yield stress
/// vanishes. The excess is a stress of the size of `scale`, positive at zero; it falls by at least
/// `stiffness` per unit of the increment.
fn flow_to_root(excess: impl Fn(f64) -> f64, stiffness: f64, scale: f64) -> f64 {
    let first = excess(0.0);
    let end = first / stiffness;
    let accuracy = RootTolerance {
        value: 4.0 * f64::EPSILON * scale,
        place: f64::EPSILON,
    };
    root::between([(0.0, first), (end, excess(end))], accuracy, excess)
}

/// Returns `a x + b y`. A loop, because arrays made by closures are slow without inlining.
#[inline]
fn sum<const S: usize>(a: f64, x: &[f64; S], b: f64, y: &[f64; S]) -> [f64; S] {
    let mut out = [0.0; S];
    for k in 0..S {
        out[k] = a * x[k] + b * y[k];
    }
    out
}

/// Converts a strain with engineering shear to tensor components.
#[inline]
fn tensor_of<const S: usize>(strain: &[f64; S]) -> [f64; S] {
    std::array::from_fn(|k| if k < 3 { strain[k] } else { 0.5 * strain[k] })
}

/// Double contraction `a:b` of two tensors.
#[inline]
fn double_dot<const S: usize>(a: &[f64; S], b: &[f64; S]) -> f64 {
    let product = |k: usize| a[k] * b[k];
    let normal: f64 = (0..3).map(product).sum();
    let shear: f64 = (3..S).map(product).sum();
    normal + 2.0 * shear
}

/// Von Mises stress `sqrt(3/2 s:s)` of the deviator `s`.
#[inline]
pub fn von_mises<const S: usize>(stress: &[f64; S]) -> f64 {
    let (x, y, z) = (stress[0], stress[1], stress[2]);
    let shear: f64 = stress[3..].iter().map(|t| t * t).sum();
    (0.5 * ((x - y).powi(2) + (y - z).powi(2) + (z - x).powi(2)) + 3.0 * shear).sqrt()
}

/// Product `3/2 s:t` of the deviators of two stresses, which is the square of the von Mises stress
/// if they are equal.
#[inline]
fn von_mises_product<const S: usize>(a: &[f64; S], b: &[f64; S]) -> f64 {
    let difference = |i: usize, j: usize| (a[i] - a[j]) * (b[i] - b[j]);
    let shear: f64 = (3..S).map(|k| a[k] * b[k]).sum();
    0.5 * (difference(0, 1) + difference(1, 2) + difference(2, 0)) + 3.0 * shear
}

#[cfg(test)]
mod tests;

//! Models from arrays: materials, contact, supports.

use super::border::{SizePrefixed, shared, slice, take, text};
use super::model::{brinell_model, change, one_of};
use crate::error::{Error, Result};
use crate::model::NodePair;
use crate::scene::{Body, Contact, Direction, Material, Plastic, SlaveSide, Support};
use crate::space::Vector;
use std::ffi::c_char;

/// A material. What is zero (NULL) is not given.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct brinell_material {
    /// sizeof(brinell_material).
    pub size: usize,
    /// E > 0.
    pub youngs_modulus: f64,
    /// -1 < nu < 0.5.
    pub poissons_ratio: f64,
    /// Tensile yield stress; 0 for an elastic material.
    pub yield_stress: f64,
    /// Slope of the yield stress over the plastic strain; 0 for perfect plasticity.
    pub plastic_modulus: f64,
    /// n_table rows of (plastic strain, yield stress) in place of the modulus, the first one (0,
    /// yield_stress).
    pub hardening_table: *const f64,
    /// Rows of the table.
    pub n_table: usize,
}

// SAFETY: repr(C), begins with its size, numbers and a pointer.
unsafe impl SizePrefixed for brinell_material {
    const NAME: &'static str = "brinell_material";
}

/// How two surfaces touch. NULL stands for the defaults, which are all zeros: nodes that face each
/// other are paired, other surfaces are coupled by the integrals of their shape functions.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct brinell_contact {
    /// sizeof(brinell_contact).
    pub size: usize,
    /// Taken off every gap, gradually before the load program.
    pub interference: f64,
    /// Gap of all pairs in place of the geometric one; NULL if not given.
    pub gap: *const f64,
    /// Direction from the second body to the first of all pairs (2 values), for the pairing by
    /// geometry; NULL for the second surface's outward normals.
    pub normal: *const f64,
    /// Number of pairs that are given; 0: by geometry.
    pub n_pairs: usize,
    /// n_pairs nodes of the first surface.
    pub first_nodes: *const i64,
    /// n_pairs nodes of the second surface.
    pub second_nodes: *const i64,
    /// n_pairs x 2, of a solid x 3: direction from the second body to the first; NULL for the
    /// second surface's outward normals.
    pub normals: *const f64,
    /// n_pairs gaps >= 0; NULL for the geometric ones.
    pub gaps: *const f64,
    /// Which surface has the slaves, at whose nodes gaps and pressures are: 1 the first, 2 the
    /// second; 0: the finer one, the second where nodes face each other.
    pub slave: i32,
}

// SAFETY: repr(C), begins with its size, numbers and pointers.
unsafe impl SizePrefixed for brinell_contact {
    const NAME: &'static str = "brinell_contact";
}

/// Along x (r).
pub const BRINELL_X: i32 = 1;
/// Along y (z).
pub const BRINELL_Y: i32 = 2;
/// Along z, of a solid.
pub const BRINELL_Z: i32 = 4;

/// Takes a structure whose defaults are all zeros.
///
/// # Safety
/// As [`take`]; all zeros are a value of `T`.
pub(super) unsafe fn zero_or<T: SizePrefixed>(from: *const T) -> Result<T> {
    // SAFETY: numbers and pointers may be zero; as vouched for by the caller.
    unsafe { take(from, std::mem::zeroed()) }
}

/// Pairs of numbers.
///
/// # Safety
/// As [`slice`] for `2 n` values.
pub(super) unsafe fn rows(data: *const f64, n: usize, what: &str) -> Result<Vec<[f64; 2]>> {
    // SAFETY: as vouched for by the caller.
    let values = unsafe { slice(data, n.saturating_mul(2), what) }?;
    Ok(values.chunks_exact(2).map(|r| [r[0], r[1]]).collect())
}

impl brinell_model {
    /// `n` vectors, one after the other, of as many components as the model has coordinates.
    ///
    /// # Safety
    /// `values` is NULL or has so many values.
    pub(super) unsafe fn vectors(
        &self,
        values: *const f64,
        n: usize,
        what: &str,
    ) -> Result<Vec<Vector>> {
        let each = self.builder.dimension();
        // SAFETY: as vouched for by the caller.
        let values = unsafe { slice(values, n.saturating_mul(each), what) }?;
        let vector = |row: &[f64]| std::array::from_fn(|d| row.get(d).copied().unwrap_or(0.0));
        Ok(values.chunks_exact(each).map(vector).collect())
    }
}

pub(super) fn directions(mask: i32, what: &str) -> Result<Vec<Direction>> {
    if mask & !(BRINELL_X | BRINELL_Y | BRINELL_Z) != 0 || mask == 0 {
        return Err(Error::input(format!(
            "{what}: {mask} are no directions; give some of BRINELL_X, BRINELL_Y, BRINELL_Z, or-ed"
        )));
    }
    let all = [BRINELL_X, BRINELL_Y, BRINELL_Z]
        .into_iter()
        .zip(Direction::ALL);
    let among = all.filter(|(bit, _)| mask & bit != 0);
    Ok(among.map(|(_, direction)| direction).collect())
}

/// Names a material.
///
/// # Safety
/// `model` is a living handle, `name` a text that ends with a zero byte, `material` as long as it
/// says and so is its table.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_material(
    model: *mut brinell_model,
    name: *const c_char,
    material: *const brinell_material,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            shared(material, "the material")?;
            let given = zero_or(material)?;
            let nonzero = |value: f64| (value != 0.0).then_some(value);
            let table = rows(given.hardening_table, given.n_table, "hardening_table")?;
            let material = Material {
                youngs_modulus: given.youngs_modulus,
                poissons_ratio: given.poissons_ratio,
                yield_stress: nonzero(given.yield_stress),
                plastic_modulus: nonzero(given.plastic_modulus),
                hardening_table: (!table.is_empty()).then_some(table),
                ..Material::default()
            };
            m.builder.material(text(name, "the name")?, material)?;
            Ok(())
        })
    }
}

/// Says what a body is made of, and whether it may yield: if its material can (0), yes (1), no (2).
///
/// # Safety
/// `model` is a living handle, `body` and `material` are texts that end with a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_body(
    model: *mut brinell_model,
    body: *const c_char,
    material: *const c_char,
    yields: i32,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            let choices = [Plastic::Auto, Plastic::Yes, Plastic::No];
            let made_of = Body {
                material: text(material, "the material")?.to_string(),
                plastic: one_of(&choices, yields, "choice of yielding")?,
                ..Body::default()
            };
            m.builder.body(text(body, "the body")?, made_of)?;
            Ok(())
        })
    }
}

/// Lets two surfaces touch.
///
/// # Safety
/// `model` is a living handle, `first` and `second` are texts that end with a zero byte, `contact`
/// is NULL or as long as it says and so are its arrays.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_contact(
    model: *mut brinell_model,
    first: *const c_char,
    second: *const c_char,
    contact: *const brinell_contact,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            let given = zero_or(contact)?;
            let entry = Contact {
                first: text(first, "the first surface")?.to_string(),
                second: text(second, "the second surface")?.to_string(),
                normal: m
                    .vectors(given.normal, usize::from(!given.normal.is_null()), "normal")?
                    .first()
                    .map(|normal| m.builder.components(*normal)),
                gap: given.gap.as_ref().copied(),
                stiffness: None,
                interference: given.interference,
                slave: match given.slave {
                    0 => SlaveSide::Auto,
                    1 => SlaveSide::First,
                    2 => SlaveSide::Second,
                    other => {
                        return Err(Error::input(format!(
                            "slave is {other}; give 1 for the first surface, 2 for the second, 0 \
                             to have it chosen"
                        )));
                    }
                },
            };
            let n = given.n_pairs;
            if n == 0 {
                m.builder.contact(entry);
                return Ok(());
            }
            let first = slice(given.first_nodes, n, "first_nodes")?;
            let second = slice(given.second_nodes, n, "second_nodes")?;
            let unless_null = |is_null: bool| if is_null { 0 } else { n };
            let normals = m.vectors(given.normals, unless_null(given.normals.is_null()), "")?;
            let gaps = slice(given.gaps, unless_null(given.gaps.is_null()), "")?;
            let node =
                |k: usize, nodes: &[i64]| m.builder.node(|| format!("pair {k}: one"), nodes[k]);
            let pairs = (0..n).map(|k| {
                Ok(NodePair {
                    first: node(k, first)?,
                    second: node(k, second)?,
                    normal: normals.get(k).copied(),
                    gap: gaps.get(k).copied(),
                })
            });
            let pairs = pairs.collect::<Result<Vec<_>>>()?;
            m.builder.contact_pairs(entry, &pairs)?;
            Ok(())
        })
    }
}

/// Holds a node set or surface along BRINELL_X, BRINELL_Y, BRINELL_Z or several (or-ed), in axes
/// turned counter-clockwise by `angle` degrees, of a solid about the z axis.
///
/// # Safety
/// `model` is a living handle, `on` a text that ends with a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_support(
    model: *mut brinell_model,
    on: *const c_char,
    fix: i32,
    angle: f64,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            m.builder.support(Support {
                on: text(on, "the set")?.to_string(),
                fix: directions(fix, "support")?,
                angle: (angle != 0.0).then_some(angle),
                direction: None,
            });
            Ok(())
        })
    }
}

/// Holds a node set or surface along any one direction: two components, of a solid three.
///
/// # Safety
/// `model` is a living handle, `on` a text that ends with a zero byte, `direction` has as many
/// values as the model has directions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_support_along(
    model: *mut brinell_model,
    on: *const c_char,
    direction: *const f64,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            let along = m.vectors(direction, 1, "direction of the support")?;
            m.builder.support(Support {
                on: text(on, "the set")?.to_string(),
                direction: along.first().map(|along| m.builder.components(*along)),
                ..Support::default()
            });
            Ok(())
        })
    }
}

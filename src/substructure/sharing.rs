//! Factors that runs of one elastic structure share, one run after the other on one thread.
//!
//! A factor depends on the stiffness, on the positions of the contact freedoms and on which
//! freedoms were factored as zone; it does not depend on yield stresses, hardening or loads. Within
//! [`sharing_factors`] a factor that is no longer used is kept. The next run with the same matrix
//! takes it if its zone lies within the factored one. Otherwise the run makes a factor of both
//! zones, so that runs with different zones end up with one factor that serves all.

use crate::error::{Error, Result};
use crate::linalg::{Backend, Condensed, Partition, Symmetric};
use std::cell::RefCell;
use std::ops::Deref;
use std::sync::Arc;
use xxhash_rust::xxh3::Xxh3;

/// Largest number of kept factors: for a run and for the meshes that estimate its errors.
const MOST: usize = 4;

thread_local! {
    /// Factors kept on this thread, the last one used at the end; `None` outside of
    /// [`sharing_factors`].
    static KEPT: RefCell<Option<Vec<KeptFactor>>> = const { RefCell::new(None) };
}

/// A kept factor that no run uses at present.
struct KeptFactor {
    home: Home,
    condensed: Arc<dyn Condensed>,
}

/// Identity under which a factor is kept.
#[derive(Clone)]
struct Home {
    /// Hash of everything on which the factor depends apart from its zone.
    key: u128,
    /// Freedoms that were factored as zone.
    zone: Vec<usize>,
}

/// Runs `body`, in which runs of one structure share factors. Results are those of runs without
/// sharing, up to round-off; a run that factors nothing reports no factorisation
/// ([`crate::results::Counts::factorizations`]).
pub fn sharing_factors<T>(body: impl FnOnce() -> T) -> T {
    let before = KEPT.with(|kept| kept.replace(Some(Vec::new())));
    let out = body();
    KEPT.with(|kept| kept.replace(before));
    out
}

/// A factor, the freedoms that are its zone from now on, and whether the factor is new.
pub(super) struct Condensation {
    pub condensed: HeldFactor,
    pub zone: Vec<usize>,
    pub is_new: bool,
}

/// Factors and condenses a matrix, or takes over a kept factor of the matrix.
///
/// # Errors
/// Errors of [`Symmetric::condense`].
pub(super) fn condense(
    matrix: &Symmetric,
    backend: Backend,
    partition: &Partition,
    shift: &[f64],
) -> Result<Condensation> {
    let is_shared = KEPT.with_borrow(Option::is_some);
    let key = match is_shared {
        true => key(matrix, backend, partition, shift),
        false => None,
    };
    let Some(key) = key else {
        return Ok(Condensation {
            condensed: HeldFactor::alone(matrix.condense(backend, partition, shift)?),
            zone: partition.zone.clone(),
            is_new: true,
        });
    };
    let mut zone = partition.zone.clone();
    if let Some(mut held) = take(key) {
        if let Some(chosen) = held.choose_zone(&partition.zone)? {
            return Ok(Condensation {
                condensed: held,
                zone: chosen,
                is_new: false,
            });
        }
        zone = held.give_up(&zone);
    }
    let wider = Partition {
        zone,
        ..partition.clone()
    };
    let (condensed, zone) = match matrix.condense(backend, &wider, shift) {
        Ok(condensed) => (condensed, wider.zone),
        // Kept factors may take up the memory that is lacking, or the wider zone may need it.
        Err(_) => {
            clear();
            let condensed = matrix.condense(backend, partition, shift)?;
            (condensed, partition.zone.clone())
        }
    };
    let home = Some(Home { key, zone });
    let mut held = HeldFactor {
        condensed: Arc::from(condensed),
        home,
    };
    let chosen = held.choose_zone(&partition.zone)?;
    Ok(Condensation {
        zone: chosen.unwrap_or_else(|| partition.zone.clone()),
        condensed: held,
        is_new: true,
    })
}

fn clear() {
    KEPT.with_borrow_mut(|kept| {
        if let Some(kept) = kept {
            kept.clear();
        }
    });
}

fn take(key: u128) -> Option<HeldFactor> {
    KEPT.with_borrow_mut(|kept| {
        let kept = kept.as_mut()?;
        let place = kept.iter().position(|kept| kept.home.key == key)?;
        let KeptFactor { home, condensed } = kept.remove(place);
        Some(HeldFactor {
            condensed,
            home: Some(home),
        })
    })
}

/// Returns the ascending freedoms that are in either list.
fn union(a: &[usize], b: &[usize]) -> Vec<usize> {
    let mut both = [a, b].concat();
    both.sort_unstable();
    both.dedup();
    both
}

/// Hash of everything on which a factor depends apart from its zone; `None` for a matrix that is
/// distributed over several ranks.
fn key(matrix: &Symmetric, backend: Backend, partition: &Partition, shift: &[f64]) -> Option<u128> {
    let whole = match matrix {
        Symmetric::Whole(matrix) => Some(matrix),
        #[cfg(feature = "mumps")]
        Symmetric::Shared(_) => None,
    };
    let matrix = whole?;
    let mut hash = Xxh3::new();
    hash.update(backend.name().as_bytes());
    hash.update(&partition.contact.len().to_le_bytes());
    for k in &partition.contact {
        hash.update(&k.to_le_bytes());
    }
    for list in [matrix.indptr().raw_storage(), matrix.indices()] {
        hash.update(&list.len().to_le_bytes());
        list.iter().for_each(|k| hash.update(&k.to_le_bytes()));
    }
    for values in [matrix.data(), shift] {
        hash.update(&values.len().to_le_bytes());
        values
            .iter()
            .for_each(|v| hash.update(&v.to_bits().to_le_bytes()));
    }
    Some(hash.digest128())
}

/// A factor in use. If runs share factors, the factor is kept when it is no longer used.
pub(super) struct HeldFactor {
    condensed: Arc<dyn Condensed>,
    home: Option<Home>,
}

impl HeldFactor {
    /// Holds a factor that no other run takes over.
    pub(super) fn alone(condensed: Box<dyn Condensed>) -> Self {
        HeldFactor {
            condensed: Arc::from(condensed),
            home: None,
        }
    }

    /// Chooses a zone within the factored one ([`Condensed::choose_zone`]).
    ///
    /// # Errors
    /// Errors of [`Condensed::choose_zone`].
    pub(super) fn choose_zone(&mut self, wanted: &[usize]) -> Result<Option<Vec<usize>>> {
        match Arc::get_mut(&mut self.condensed) {
            Some(condensed) => condensed.choose_zone(wanted),
            None => Err(Error::internal("a factor is used twice")),
        }
    }

    /// Frees the factor and returns the union of its zone and another.
    fn give_up(mut self, zone: &[usize]) -> Vec<usize> {
        let own = self.home.take().map_or(Vec::new(), |home| home.zone);
        union(&own, zone)
    }
}

impl Deref for HeldFactor {
    type Target = dyn Condensed;

    fn deref(&self) -> &(dyn Condensed + 'static) {
        &*self.condensed
    }
}

impl Drop for HeldFactor {
    fn drop(&mut self) {
        let Some(home) = self.home.take() else { return };
        let condensed = Arc::clone(&self.condensed);
        // The thread-local value no longer exists when the thread ends.
        let _ = KEPT.try_with(|kept| {
            if let Ok(mut kept) = kept.try_borrow_mut()
                && let Some(kept) = kept.as_mut()
            {
                kept.push(KeptFactor { home, condensed });
                if kept.len() > MOST {
                    kept.remove(0);
                }
            }
        });
    }
}

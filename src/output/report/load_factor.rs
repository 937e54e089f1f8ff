//! Name and meaning of load factors, in words.

use crate::scene::Unit;

/// Returns the column heading for load factors.
pub(super) fn factor(unit: Unit) -> &'static str {
    match unit {
        Unit::Load => "load factor",
        Unit::Yield => "load / yield load",
    }
}

/// Says in words what a load factor of 1 means.
pub(super) fn factor_unit(unit: Unit) -> &'static str {
    match unit {
        Unit::Load => "a multiple of the scene's loads",
        Unit::Yield => "a multiple of the yield load",
    }
}

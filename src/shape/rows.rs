//! The table of reference elements: one row per element shape, in the order of
//! [`Shape::ALL`](super::Shape::ALL).

mod plane;
mod solid;

use super::ReferenceElement;
use plane::{QUAD4, QUAD8, TRI3, TRI6};
use solid::{HEX8, HEX20, PRISM6, PRISM15, TET4, TET10};

pub(super) static ROWS: [&ReferenceElement; 10] = [
    &TRI3, &TRI6, &QUAD4, &QUAD8, &TET4, &TET10, &HEX8, &HEX20, &PRISM6, &PRISM15,
];

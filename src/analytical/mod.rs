//! Closed forms.

mod bracketing;
mod contact_pair;
mod disc_in_plate;
mod domain;
mod hertz_line;
mod hertz_point;
mod kirsch;
mod plane;
mod quadrature;
mod von_mises;

pub use contact_pair::{contact_modulus, relative_radius};
pub use disc_in_plate::DiscInPlate;
pub use hertz_line::HertzLine;
pub use hertz_point::HertzPoint;
pub use kirsch::KirschField;
pub use plane::Plane;
pub use von_mises::von_mises;

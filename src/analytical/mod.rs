//! Closed forms.

mod bracketing;
mod contact_pair;
mod disc_in_plate;
mod domain;
mod elastoplastic_cylinder;
mod elastoplastic_sphere;
mod flat_punch;
mod hertz_line;
mod hertz_point;
mod kirsch;
mod pin_in_hole;
mod plane;
mod quadrature;
mod shrink_fit;
mod thick_cylinder;
mod thick_sphere;
mod von_mises;

pub use contact_pair::{contact_modulus, relative_radius};
pub use disc_in_plate::DiscInPlate;
pub use elastoplastic_cylinder::ElastoplasticCylinder;
pub use elastoplastic_sphere::{ElastoplasticSphere, SphereContact};
pub use flat_punch::{CircularPunch, FlatPunch};
pub use hertz_line::HertzLine;
pub use hertz_point::HertzPoint;
pub use kirsch::KirschField;
pub use pin_in_hole::PinInHole;
pub use plane::Plane;
pub use shrink_fit::ShrinkFit;
pub use thick_cylinder::ThickCylinder;
pub use thick_sphere::ThickSphere;
pub use von_mises::von_mises;

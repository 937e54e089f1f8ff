//! Closed forms of contact and plasticity, as documented types that tests, plots and reports share.
//!
//! Each file is one solution with its equations, validity, units and source. All methods take and
//! return consistent units of the caller's choice; stresses are positive in tension, pressures and
//! contact forces in compression. Constructors check that the parameters lie in the range of the
//! solution. A method that takes a load or an angle states its domain, and returns an error if the
//! closed form does not cover the whole of it. Nothing here depends on the rest of the crate except
//! its error type.
//!
//! | case | file | what it gives | source |
//! |---|---|---|---|
//! | cylinder on a half plane (the paper's 5.1) | `hertz_line.rs`: [`HertzLine`] | half width, pressure, stress everywhere, largest shears, first yield for any `nu`, compression of cylinder and half space | Hertz; McEwen 1949; Johnson pp. 99-103, 129-131 |
//! | ball on a half space | `hertz_point.rs`: [`HertzPoint`] | contact radius, approach, pressure, stress everywhere, first yield for any `nu` | Hertz; Huber 1904; Johnson pp. 60-63, 90-93 |
//! | bodies of any curvature | `hertz_ellipse.rs`: [`HertzEllipse`] | half axes, approach, pressure, stress below the middle, largest shears, first yield for any `nu` | Hertz; Johnson pp. 84-99; Lundberg and Palmgren 1947 |
//! | any of the three contacts above, from radii | `hertz_contact.rs`: [`HertzContact`] | circle, ellipse or line | as above |
//! | disc in a plate (the paper's 5.2) | `disc_in_plate.rs`: [`DiscInPlate`] | contact angle, pressure, gap, stress in both bodies, first yield | derived in the file from Muskhelishvili's potentials |
//! | pin in a hole | `pin_in_hole.rs`: [`PinInHole`] | contact angle, pressure, with clearance, neat or with interference | Persson 1964; Ciavarella and Decuzzi 2001 |
//! | hole in a plate | `kirsch.rs`: [`KirschField`] | stress, traction on a cut, displacement | Kirsch 1898; Timoshenko and Goodier par. 35 |
//! | thick cylinder, elastic | `thick_cylinder.rs`: [`ThickCylinder`] | stress, displacement, first yield, both planes | Lame; Timoshenko and Goodier par. 28 |
//! | thick cylinder, elastoplastic | `elastoplastic_cylinder.rs`: [`ElastoplasticCylinder`] | front, stress, displacement, residual stress, collapse | Hill ch. V |
//! | thick sphere, elastoplastic | `thick_sphere.rs`: [`ThickSphere`] | front, stress, displacement, residual stress, collapse, for any `nu` | Hill ch. V |
//! | shaft in a ring | `shrink_fit.rs`: [`ShrinkFit`] | pressure, stress, interference at first yield | Timoshenko |
//! | flat punches | `flat_punch.rs`: [`FlatPunch`], [`CircularPunch`] | elastic pressure, limit load | Prandtl 1920; Shield 1955 |
//! | evaluation of an indentation | `indentation.rs`: [`Indentation`] | Brinell and Meyer hardness, pile-up, modulus from the unloading stiffness | ISO 6506; Hill et al. 1989; Oliver and Pharr 1992 |
//! | constants of a pair of bodies | `contact_pair.rs`: [`contact_modulus`], [`relative_radius`], [`RelativeRadii`] | contact modulus, relative radii, also for principal planes at an angle | Johnson pp. 85-92 |
//!
//! The published figures that these closed forms reproduce are in `data/reference`; a test compares
//! them row by row.

mod contact_pair;
mod disc_in_plate;
mod domain;
mod elastoplastic_cylinder;
mod elliptic;
mod flat_punch;
mod hertz_contact;
mod hertz_ellipse;
mod hertz_line;
mod hertz_point;
mod indentation;
mod kirsch;
mod pin_in_hole;
mod plane;
mod plastic_wall;
mod quadrature;
mod shrink_fit;
mod thick_cylinder;
mod thick_sphere;
mod von_mises;

pub use contact_pair::{RelativeRadii, contact_modulus, relative_radius};
pub use disc_in_plate::DiscInPlate;
pub use elastoplastic_cylinder::ElastoplasticCylinder;
pub use elliptic::{elliptic_d, elliptic_e, elliptic_k};
pub use flat_punch::{CircularPunch, FlatPunch};
pub use hertz_contact::HertzContact;
pub use hertz_ellipse::HertzEllipse;
pub use hertz_line::HertzLine;
pub use hertz_point::HertzPoint;
pub use indentation::Indentation;
pub use kirsch::KirschField;
pub use pin_in_hole::PinInHole;
pub use plane::Plane;
pub use shrink_fit::ShrinkFit;
pub use thick_cylinder::ThickCylinder;
pub use thick_sphere::ThickSphere;
pub use von_mises::{Peak, von_mises};

#[cfg(test)]
mod tests;

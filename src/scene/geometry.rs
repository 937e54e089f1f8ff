//! Where the mesh comes from: a generator with its parameters, or a file.

use super::local_refinement::LocalRefinement;
use crate::shape::Shape;
use crate::space::Space;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The source of the mesh: exactly one generator, or `file`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshSource {
    /// Curved indenter on a block (paper, sec. 5.1): a cylinder on a half plane, or a ball on a
    /// half space in an axisymmetric model.
    pub cylinder_on_half_plane: Option<CylinderOnHalfPlane>,
    /// Quarter of a disc in the hole of a plate (paper, sec. 5.2).
    pub disc_in_plate: Option<DiscInPlate>,
    /// Two bodies of any curvature (solid), modelled as half spaces that are curved near the
    /// contact and flat elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curved_bodies: Option<CurvedBodies>,
    /// Blocks, rings, discs and bricks, each a body of its own.
    pub parts: Option<Vec<Part>>,
    /// A Gmsh file (.msh 2.2 or 4.1, text or binary), or the mesh of a deck of Abaqus or CalculiX
    /// (.inp), relative to the scene file. In a plane mesh physical surfaces are bodies, physical
    /// curves are surfaces, and physical points are node sets. In a solid mesh physical volumes are
    /// bodies, physical surfaces are surfaces, and physical curves and points are node sets.
    pub file: Option<PathBuf>,
    /// Surfaces of the mesh file that lie on circles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub circles: Vec<SurfaceCircle>,
    /// Number of times that each element of the file is divided: into four, in a solid into eight.
    /// New nodes on the surfaces listed in `circles`, `spheres`, `cylinders` and `tori` are placed
    /// on these shapes.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub subdivisions: usize,
    /// Places of a plane mesh around which elements are made smaller.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refine: Vec<LocalRefinement>,
    /// Surfaces of the mesh file that lie on spheres.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spheres: Vec<SurfaceSphere>,
    /// Surfaces of the mesh file that lie on circular cylinders.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cylinders: Vec<SurfaceCylinder>,
    /// Surfaces of the mesh file that lie on tori: grooves, raceways, fillets.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tori: Vec<SurfaceTorus>,
    /// Extrudes the plane mesh along z into a solid one (`kind = "solid"`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extrude: Option<Extrusion>,
    /// Revolves the plane mesh about the y axis into a solid one (`kind = "solid"`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub revolve: Option<Revolution>,
    /// Integration of the stiffness of linear quadrilaterals, hexahedra and prisms.
    #[serde(default, skip_serializing_if = "Formulation::is_mean")]
    pub formulation: Formulation,
}

/// The integration of the stiffness of linear quadrilaterals, hexahedra and prisms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Formulation {
    /// With the mean dilatation of the element (B-bar), which avoids volumetric locking.
    #[default]
    Mean,
    /// Full integration at all points, as CalculiX does for `C3D8`, `CPE4` and `CAX4`: for
    /// comparison with CalculiX. Locks where the volume is preserved, as it is in plastic flow.
    Full,
}

impl Formulation {
    /// Whether the formulation is the default one, with the mean dilatation.
    pub(crate) fn is_mean(&self) -> bool {
        *self == Formulation::Mean
    }
}

/// Extrusion of a plane mesh along z: `BODY.front` is the section at z = 0, `BODY.back` the section
/// at `depth`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Extrusion {
    /// Length along z.
    pub depth: f64,
    /// Number of elements along z.
    pub elements: usize,
}

/// Revolution of a plane mesh in coordinates (r, y) about the y axis, from the x axis towards z:
/// `BODY.front` is the section in the x-y plane, `BODY.back` the section at `angle`. A full turn is
/// closed and has neither. A surface on the axis becomes a node set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Revolution {
    /// Angle of the revolution in degrees, at most 360.
    #[serde(default = "super::defaults::quarter_turn")]
    pub angle: f64,
    /// Number of elements along the angle.
    pub elements: usize,
}

/// The sphere on which a surface of a mesh file lies: with it normals and gaps are exact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfaceSphere {
    /// Name of the surface.
    pub on: String,
    /// Centre of the sphere.
    #[serde(default)]
    pub center: [f64; 3],
    /// Radius of the sphere.
    pub radius: f64,
}

/// The circular cylinder on which a surface of a mesh file lies: with it normals and gaps are
/// exact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfaceCylinder {
    /// Name of the surface.
    pub on: String,
    /// A point of the axis.
    #[serde(default)]
    pub point: [f64; 3],
    /// Direction of the axis.
    pub axis: [f64; 3],
    /// Radius of the cylinder.
    pub radius: f64,
}

/// The torus on which a surface of a mesh file lies: all points at distance `radius` from a circle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfaceTorus {
    /// Name of the surface.
    pub on: String,
    /// Centre of the ring.
    #[serde(default)]
    pub center: [f64; 3],
    /// Direction of the axis of the ring.
    pub axis: [f64; 3],
    /// Radius of the ring.
    pub ring_radius: f64,
    /// Radius of the tube, which is the radius of the groove.
    pub radius: f64,
}

fn is_zero(n: &usize) -> bool {
    *n == 0
}

/// The circle on which a surface of a mesh file lies. A file holds nodes only. With the circle the
/// normals and gaps at the nodes are exact, and refinement converges to the true body, not to the
/// polygon of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfaceCircle {
    /// Name of the surface.
    pub on: String,
    /// Centre of the circle.
    #[serde(default)]
    pub center: [f64; 2],
    /// Radius of the circle.
    pub radius: f64,
}

/// The half model (x >= 0) of a cylinder (ball) pressed on a half plane (half space), with the
/// first contact at the origin. The bodies are called `cylinder` (above) and `half_plane` unless
/// `names` says otherwise.
///
/// | set | where |
/// |---|---|
/// | `cylinder.contact`, `half_plane.contact` | the contact candidates, out to `fine_width` or `contact_width`, whichever is more |
/// | `cylinder.outside`, `half_plane.outside` | the rest of the two surfaces |
/// | `cylinder.symmetry`, `half_plane.symmetry` | the line x = 0 |
/// | `cylinder.side`, `half_plane.side` | the outer ends, x = `far_size` half widths |
/// | `cylinder.top`, `half_plane.bottom` | the cuts, y = +-`far_size` half widths |
/// | `cylinder.pole`, `half_plane.pole` | node sets: the node at the origin |
///
/// The cylinder follows the circle over the contact candidates and levels off beyond them. The
/// model is therefore that of Hertz's theory: two half planes, flat but for the cylinder's curve
/// near the contact. See [`crate::mesh::generate::cylinder_on_half_plane`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CylinderOnHalfPlane {
    /// Names of the two bodies, which also begin the names of their sets: `["ball", "race"]` gives
    /// `ball.contact` and `race.contact`.
    #[serde(default = "super::defaults::cylinder_names")]
    pub names: [String; 2],
    /// Radius of the cylinder or ball.
    pub radius: f64,
    /// Number of elements over the contact half width (in an axisymmetric model the contact
    /// radius), at first yield; a larger contact has at least this number.
    pub resolution: usize,
    /// Contact half width at first yield; by default computed from the materials (Hertz).
    pub half_width: Option<f64>,
    /// Width of the evenly meshed region, in half widths.
    #[serde(default = "super::defaults::fine_width")]
    pub fine_width: f64,
    /// Width that the contact may reach, in half widths. By default it follows from the largest
    /// load, displacement or half width of the program. Between `fine_width` and this width,
    /// elements grow by a factor of `1 + 1/resolution`.
    pub contact_width: Option<f64>,
    /// Depth of the evenly meshed region, in half widths.
    #[serde(default = "super::defaults::fine_depth")]
    pub fine_depth: f64,
    /// Size of each body, in half widths; by default 20,000, and 2,000 for a ball. The bodies stand
    /// for infinite ones. Under a cylinder, a finite size W changes the stress at a contact of half
    /// width b by order b/W. Under a ball, it changes the stress by order (b/W)^2 and the approach
    /// by order b/W. Elements that grow with the distance make a large size cheap.
    pub far_size: Option<f64>,
    /// Ratio of neighbouring element sizes outside the evenly meshed region.
    #[serde(default = "super::defaults::growth")]
    pub growth: f64,
    /// Ratio of neighbouring element sizes at the far end; by default equal to `growth`. Away from
    /// the contact, the logarithm of the ratio rises from that of `growth` to that of this value,
    /// with a power of the distance. Distant elements matter less to the contact, so they may grow
    /// ever faster.
    pub far_growth: Option<f64>,
    /// Shape of the elements.
    #[serde(default = "super::defaults::shape")]
    pub element: Shape,
}

/// Two bodies whose surfaces have principal radii along x and y, pressed together along z: a ball
/// in a groove, crossed cylinders, a crowned roller on a plate. The bodies are called `upper` and
/// `lower` unless `names` says otherwise. The first contact is at the origin.
///
/// | set | where |
/// |---|---|
/// | `upper.contact`, `lower.contact` | the contact candidates |
/// | `upper.outside`, `lower.outside` | the rest of the two surfaces |
/// | `*.symmetry_x`, `*.symmetry_y` | the planes x = 0 and y = 0, where these bound the model; else `*.left`, `*.front` |
/// | `*.right`, `*.back` | the outer ends, x and y = `far_size` larger half axes |
/// | `upper.top`, `lower.bottom` | the cuts, z = +-`far_size` larger half axes |
/// | `upper.pole`, `lower.pole` | node sets: the node at the origin |
///
/// See [`crate::mesh::generate::curved_bodies`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CurvedBodies {
    /// Names of the two bodies, which also begin the names of their sets: `["ball", "race"]` gives
    /// `ball.contact` and `race.contact`.
    #[serde(default = "super::defaults::curved_names")]
    pub names: [String; 2],
    /// Principal radii of the upper body along x and y: positive if convex, negative if hollow, 0
    /// or infinite if flat.
    pub upper: [f64; 2],
    /// Principal radii of the lower body along x and y: positive if convex, negative if hollow, 0
    /// or infinite if flat.
    pub lower: [f64; 2],
    /// Number of elements over the smaller half axis of the contact at first yield; a larger
    /// contact has at least this number.
    pub resolution: usize,
    /// Half axes of the contact along x and y at first yield; by default computed from the
    /// materials (Hertz).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub semi_axes: Option<[f64; 2]>,
    /// Part of the bodies that is meshed: `quarter` (x, y >= 0), `half` (x >= 0) or `full`. The
    /// scene's `symmetry` must then be 4, 2 or 1.
    #[serde(default)]
    pub model: Meshed,
    /// Width of the evenly meshed region along x and y, in half axes of the contact.
    #[serde(default = "super::defaults::solid_fine_width")]
    pub fine_width: f64,
    /// Width that the contact may reach along x and y, in half axes at first yield. By default it
    /// follows from the largest load of the program. Between `fine_width` and this width, elements
    /// grow by a factor of `1 + 1/resolution`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_width: Option<f64>,
    /// Depth of the evenly meshed region, as a multiple of the smaller half axis of the contact.
    #[serde(default = "super::defaults::solid_fine_depth")]
    pub fine_depth: f64,
    /// Size of each body, as a multiple of the larger half axis of the contact. The bodies stand
    /// for infinite ones.
    #[serde(default = "super::defaults::solid_far_size")]
    pub far_size: f64,
    /// Ratio of neighbouring element sizes outside the evenly meshed region.
    #[serde(default = "super::defaults::solid_growth")]
    pub growth: f64,
    /// Shape of the elements: hex8 or hex20.
    #[serde(default = "super::defaults::solid_shape")]
    pub element: Shape,
}

/// The part of a symmetric model that is meshed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Meshed {
    /// The quarter in which neither x nor y is negative.
    #[default]
    Quarter,
    /// The half in which x is not negative.
    Half,
    /// The whole model.
    Full,
}

impl MeshSource {
    /// The generator of two bodies, by its key, and the names it gives the bodies; `None` for parts
    /// and files.
    pub(crate) fn named_pair(&self) -> Option<(&'static str, &[String; 2])> {
        if let Some(p) = &self.cylinder_on_half_plane {
            Some(("cylinder_on_half_plane", &p.names))
        } else if let Some(p) = &self.disc_in_plate {
            Some(("disc_in_plate", &p.names))
        } else {
            let p = self.curved_bodies.as_ref()?;
            Some(("curved_bodies", &p.names))
        }
    }

    /// The key that widens the contact of the generated bodies; `None` if there is none.
    pub(crate) fn key_of_contact_width(&self) -> Option<&'static str> {
        if self.cylinder_on_half_plane.is_some() {
            Some("mesh.cylinder_on_half_plane.contact_width")
        } else {
            self.curved_bodies.as_ref()?;
            Some("mesh.curved_bodies.contact_width")
        }
    }

    /// The kind of the plane model of which the mesh is a section, if the mesh is swept into a
    /// solid: plane strain for an extrusion, axisymmetric for a revolution. Otherwise `kind`.
    pub fn section(&self, kind: Space) -> Space {
        match (&self.extrude, &self.revolve) {
            (Some(_), _) => Space::PlaneStrain,
            (_, Some(_)) => Space::Axisymmetric,
            _ => kind,
        }
    }
}

impl CurvedBodies {
    /// Whether the planes x = 0 and y = 0 bound the model.
    pub(crate) fn halved(&self) -> [bool; 2] {
        match self.model {
            Meshed::Quarter => [true, true],
            Meshed::Half => [true, false],
            Meshed::Full => [false, false],
        }
    }

    /// Number of copies of the model in the whole.
    pub fn copies(&self) -> usize {
        1 << self.halved().iter().filter(|halved| **halved).count()
    }
}

/// Quarter model (x, y >= 0) of a disc that fills the hole of a plate under tension along x. The
/// bodies are called `disc` and `plate` unless `names` says otherwise. Surfaces are `disc.contact`,
/// `plate.contact` (the hole), `plate.far`, `disc.symmetry_x` and `plate.symmetry_x` (on x = 0),
/// `disc.symmetry_y` and `plate.symmetry_y` (on y = 0). Node sets are `disc.pole` and `plate.pole`
/// (on the y axis, where the contact stays closed) and `disc.center`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DiscInPlate {
    /// Names of the two bodies, which also begin the names of their sets: `["pin", "lug"]` gives
    /// `pin.contact` and `lug.contact`.
    #[serde(default = "super::defaults::disc_names")]
    pub names: [String; 2],
    /// Radius of the hole and the disc.
    pub radius: f64,
    /// Disc radius minus hole radius: positive for an interference, negative for a clearance.
    #[serde(default)]
    pub interference: f64,
    /// Number of elements over the quarter circle (even).
    pub resolution: usize,
    /// Outer radius of the plate, in hole radii.
    #[serde(default = "super::defaults::far_radius")]
    pub far_radius: f64,
    /// Ratio of neighbouring radial element sizes in the plate.
    #[serde(default = "super::defaults::disc_growth")]
    pub growth: f64,
    /// Ratio of neighbouring element sizes at the far end; by default equal to `growth`. Away from
    /// the contact, the logarithm of the ratio rises from that of `growth` to that of this value,
    /// with a power of the distance. Distant elements matter less to the contact, so they may grow
    /// ever faster.
    pub far_growth: Option<f64>,
    /// Shape of the elements.
    #[serde(default = "super::defaults::shape")]
    pub element: Shape,
}

/// A block, brick, ring sector or disc sector that is one body. The surfaces of a block are
/// `BODY.left`, `.right`, `.bottom`, `.top`; those of a ring sector `.inner`, `.outer`, `.start`,
/// `.end`; those of a disc sector `.outer`, `.start`, `.end`. A closed ring or a full disc has no
/// `.start` and `.end`. The corners of a block are node sets `BODY.bottom_left`,
/// `BODY.bottom_right`, `BODY.top_left`, `BODY.top_right`; the centre of a disc is the node set
/// `BODY.center`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Name of the body.
    pub body: String,
    /// A rectangle of a plane model.
    pub block: Option<Block>,
    /// A box of a solid model, with surfaces `BODY.left`, `.right` (x), `.front`, `.back` (y),
    /// `.bottom`, `.top` (z).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub brick: Option<BrickPart>,
    /// A sector of a ring, or a closed ring.
    pub ring: Option<Ring>,
    /// A quarter, half or full disc.
    pub disc: Option<Disc>,
    /// Shape of the elements; for a brick hex8 or hex20.
    #[serde(default = "super::defaults::shape")]
    pub element: Shape,
}

/// A rectangle `[x0, x1] x [y0, y1]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Start and end along x.
    pub x: [f64; 2],
    /// Start and end along y.
    pub y: [f64; 2],
    /// Number of elements along x and y.
    pub elements: [usize; 2],
    /// Size of the last element divided by the size of the first, along x and y.
    #[serde(default = "super::defaults::no_bias")]
    pub bias: [f64; 2],
    /// Named pieces of the sides: the surface `BODY.NAME` consists of the facets of `side` both of
    /// whose ends lie in `from..to`.
    #[serde(default)]
    pub pieces: Vec<Piece>,
}

/// A box `[x0, x1] x [y0, y1] x [z0, z1]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BrickPart {
    /// Start and end along x.
    pub x: [f64; 2],
    /// Start and end along y.
    pub y: [f64; 2],
    /// Start and end along z.
    pub z: [f64; 2],
    /// Number of elements along x, y and z.
    pub elements: [usize; 3],
    /// Size of the last element divided by the size of the first, along x, y and z.
    #[serde(default = "super::defaults::no_solid_bias")]
    pub bias: [f64; 3],
}

/// A named piece of a block's side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Piece {
    /// Name of the piece; the surface is called `BODY.NAME`.
    pub name: String,
    /// Side of the block: `left`, `right`, `bottom` or `top`.
    pub side: String,
    /// Coordinate along the side where the piece begins.
    pub from: f64,
    /// Coordinate along the side where the piece ends.
    pub to: f64,
}

/// A sector of a ring, or a closed ring.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ring {
    /// Centre of the ring.
    #[serde(default)]
    pub center: [f64; 2],
    /// Inner and outer radius.
    pub radius: [f64; 2],
    /// Start and end angle in degrees, counter-clockwise from x. A full circle is a closed ring.
    #[serde(default = "super::defaults::quarter")]
    pub angle: [f64; 2],
    /// Number of elements along the radius and along the angle.
    pub elements: [usize; 2],
    /// Size of the outermost element divided by the size of the innermost.
    #[serde(default = "super::defaults::one")]
    pub bias: f64,
}

/// A full disc, or a sector of 90 or 180 degrees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Centre of the disc.
    #[serde(default)]
    pub center: [f64; 2],
    /// Radius of the disc.
    pub radius: f64,
    /// Start and end angle in degrees, which must be 90, 180 or 360 apart.
    #[serde(default = "super::defaults::quarter")]
    pub angle: [f64; 2],
    /// Number of elements over a quarter circle (even).
    pub elements: usize,
}

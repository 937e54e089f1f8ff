//! Contact pairs: a node of one surface, the slave, with the nodes it faces on the other (paper,
//! sec. 2.1).
//!
//! If nodes face each other, a slave has one master; otherwise it has several masters with weights
//! ([`mortar`]). The gap of a pair is `g = delta - (u_slave - sum_k w_k u_k) . n >= 0` with `delta`
//! the initial distance along `n`, the unit vector from the slave's body to the other, less the
//! interference.

mod contact_input;
mod covered;
mod found;
mod held;
mod matching;
pub(super) mod mortar;
mod only;
mod pointwise;
mod repeated;
pub(super) mod resolved_tie;
mod resolver;
mod rigid;
mod sides;
pub(super) mod stated;
pub(super) mod ties;

use super::mirror::Mirror;
use crate::mesh::Mesh;
use crate::space::Vector;
pub(super) use resolver::resolve;
use std::collections::BTreeMap;

/// Relative error of a coordinate of a mesh: it was rounded several times by rotations and files of
/// sixteen digits, and once more in the integrals over a facet.
const ROUND_OFF: f64 = 256.0 * f64::EPSILON;
/// Overlap that counts as touching, in units of the facet length.
const TOUCHING: f64 = 1e-9;

/// A slave node with the masters that it may touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// Index of the scene's contact entry.
    pub contact: usize,
    /// Slave node, which lies on the surface with the number [`ContactSurface::slave`].
    pub slave: usize,
    /// Nodes of the other surface with their weights: a single node of weight 1 if it faces the
    /// slave.
    pub masters: Vec<(usize, f64)>,
    /// Unit vector from the slave's body to the other.
    pub normal: Vector,
    /// Initial gap before the interference is subtracted; with the interference subtracted it is
    /// the gap `delta`.
    pub gap: f64,
    /// Interference: the overlap that contact has to push apart.
    pub interference: f64,
    /// Gap of this pair if the surfaces are everywhere 1 apart along the local normal; gaps and
    /// interferences of the scene are multiplied by this factor. The factor is 1, except at control
    /// points of quadratic faces: there it is the component along `normal` of a combination of the
    /// surrounding normals.
    pub unit_gap: f64,
    /// Area that belongs to the pair: integral of the slave's shape function over the part of its
    /// surface that faces the other surface.
    pub area: f64,
    /// Distance along the slave's surface from its start; 0 in a solid model.
    pub arc: f64,
}

impl Pair {
    /// The only node of the other surface, if a single node faces the slave.
    pub(crate) fn faced(&self) -> Option<usize> {
        match self.masters[..] {
            [(node, 1.0)] => Some(node),
            _ => None,
        }
    }

    /// Sets a gap to zero if it is no more than the round-off of the nodes' coordinates, or than
    /// decimal places with the spacing `rounding` explain. Otherwise the pairs of matching surfaces
    /// would close one after the other. Returns a gap that decimal places explain.
    fn take_off_round_off(&mut self, mesh: &Mesh, rounding: f64) -> Option<f64> {
        let places = self.nodes().flat_map(|node| mesh.point(node));
        let size = places.fold(0.0f64, |most, x| most.max(x.abs()));
        let round_off = self.gap_by_places(ROUND_OFF * size);
        let gap = self.gap;
        if gap.abs() > round_off.max(self.gap_by_places(rounding)) {
            return None;
        }
        self.gap = 0.0;
        Some(gap).filter(|gap| gap.abs() > round_off)
    }

    /// Whether the surfaces overlap in the mesh by more than round-off and the decimal places of
    /// the coordinates explain.
    fn overlaps(&self, facet_length: f64, rounding: f64) -> bool {
        -self.gap > (TOUCHING * facet_length).max(self.gap_by_places(rounding))
    }

    /// Largest gap that can appear between surfaces that really touch if each node is misplaced by
    /// up to `off`.
    fn gap_by_places(&self, off: f64) -> f64 {
        let weights: f64 = self.masters.iter().map(|(_, weight)| weight.abs()).sum();
        (1.0 + weights) * off
    }

    /// Converts an overlap in the mesh to an interference and returns it; 0 if there is none.
    fn overlap_interferes(&mut self) -> f64 {
        let overlap = (-self.gap).max(0.0);
        self.gap += overlap;
        self.interference += overlap;
        overlap
    }

    /// Nodes of the pair on both surfaces.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        let masters = self.masters.iter().map(|&(node, _)| node);
        masters.chain([self.slave])
    }
}

/// A contact of the scene with its pairs.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSurface {
    /// Names of the first and the second surface.
    pub names: [String; 2],
    /// Number of the surface with the slaves: 0 or 1.
    pub slave: usize,
    /// Whether the other surface is rigid, that is, has no mesh of its own and moves as a rigid
    /// body.
    pub is_rigid: bool,
    /// Pairs of the contact: `pairs[range]`.
    pub range: std::ops::Range<usize>,
    /// Centre and radius of the surface, if it is known to be a circle.
    pub circle: Option<([f64; 2], f64)>,
    /// Stiffness of soft contact, as pressure over overlap; `None` for hard contact.
    pub stiffness: Option<f64>,
    /// Length of the longest facet, which limits the resolution of positions.
    pub facet_length: f64,
    /// The pair on the axis of revolution, if the axis carries no force.
    pub axis: Option<AxisPoint>,
    /// Pairs at which the contact surface ends although both bodies go on there: material beyond
    /// could touch too.
    pub goes_on: Vec<usize>,
    /// Whether only chosen nodes of the slave surface may touch, so that the contact may end
    /// anywhere.
    pub(crate) is_partial: bool,
    /// Pairs at the corners of each piece of a face of the slave surface, in order; in a solid
    /// model only.
    pub faces: Vec<Vec<usize>>,
    /// Polygons that the other surface covers on each piece that it covers only partly, by the
    /// number of the piece.
    pub covered: BTreeMap<usize, Vec<Vec<Vector>>>,
    /// Pieces with nodes that face too little to be pairs: the nearest pairs in the face, and the
    /// polygons that the other surface covers.
    pub slivers: Vec<(Vec<usize>, Vec<Vec<Vector>>)>,
    /// Arc lengths along the slave surface of a plane model between which the other surface covers
    /// it, if the pairs do not show them.
    pub extent: Option<[f64; 2]>,
    /// Length of the slave surface of a plane model, if the surface is closed and all its nodes
    /// have pairs.
    pub turn: Option<f64>,
    /// Slave nodes that supports hold, and the nodes that they face.
    pub(super) held: Vec<usize>,
    /// Planes of symmetry on which the contact ends.
    pub(crate) mirrors: Vec<Mirror>,
}

impl ContactSurface {
    /// Planes of symmetry on which the contact ends at a point.
    pub(crate) fn mirrors_at(&self, x: Vector) -> impl Iterator<Item = &Mirror> {
        let is_on = move |mirror: &&Mirror| mirror.holds(x, self.facet_length);
        self.mirrors.iter().filter(is_on)
    }
}

/// A pair on the axis of revolution whose slave belongs to a quadratic element. Its consistent
/// force is zero whatever the pressure, so the condition that slave and master stay apart has no
/// weight there. The pair is left out of the model's pairs, and the pressure on the axis is
/// extrapolated smoothly from its neighbours.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisPoint {
    /// The pair left out, with its slave, masters and gap.
    pub pair: Pair,
    /// Whether the surface starts on the axis (otherwise it ends there).
    pub begins: bool,
}

/// Fraction of its neighbour's area below which a node on the axis carries no force. The fraction
/// is 0 for quadratic elements apart from curvature, and 1/6 for linear ones.
const NO_AREA: f64 = 0.02;

/// Lists the numbers of some nodes in words.
fn list(mesh: &Mesh, nodes: &[usize]) -> String {
    let mut out: Vec<String> = nodes
        .iter()
        .take(6)
        .map(|&n| mesh.node_label(n).to_string())
        .collect();
    if nodes.len() > 6 {
        out.push(format!("and {} more", nodes.len() - 6));
    }
    let nodes = if nodes.len() == 1 { "node" } else { "nodes" };
    format!("{nodes} {}", out.join(", "))
}

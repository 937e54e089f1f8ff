//! What a load does: the one of its kinds that the scene gives.

use super::{
    Direction, Displacement, Field, Kirsch, Load, PlaneForce, Relative, Rotation, VectorField,
};
use crate::space::Components;

/// What a load does. With a `match` on this enum, the compiler reports each place that does not
/// handle a new kind of load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LoadAction<'l> {
    /// On the nodes of a surface or a node set.
    OnNodes(NodeAction<'l>),
    /// On the volume of a body.
    OnVolume(VolumeAction<'l>),
}

/// What a load does to the nodes of a surface or a node set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NodeAction<'l> {
    /// A total force.
    Force(Components),
    /// A pressure, positive into the body.
    Pressure(&'l Field),
    /// A traction.
    Traction(&'l VectorField),
    /// The traction of a plate with a hole.
    Kirsch(Kirsch),
    /// A prescribed displacement.
    Displacement(&'l Displacement),
    /// A prescribed difference of displacements.
    Relative(&'l Relative),
    /// A total force on a surface that stays plane.
    PlaneForce(PlaneForce),
    /// A change of the gap.
    Gap(&'l Field),
}

/// What a load does to the volume of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VolumeAction<'l> {
    /// A force per mass.
    Acceleration(Components),
    /// The centrifugal force of a rotation.
    Rotation(Rotation),
    /// A change of temperature.
    Temperature(&'l Field),
}

impl Load {
    /// The keys of all kinds of load, each with what the load does if the key is given.
    pub(super) fn actions(&self) -> impl Iterator<Item = (&'static str, Option<LoadAction<'_>>)> {
        use NodeAction as Node;
        use VolumeAction as Volume;
        let displacement = self.displacement.as_ref().map(Node::Displacement);
        let on_nodes = [
            ("force", self.force.map(Node::Force)),
            ("pressure", self.pressure.as_ref().map(Node::Pressure)),
            ("traction", self.traction.as_ref().map(Node::Traction)),
            ("kirsch", self.kirsch.map(Node::Kirsch)),
            ("displacement", displacement),
            ("relative", self.relative.as_ref().map(Node::Relative)),
            ("plane_force", self.plane_force.map(Node::PlaneForce)),
            ("gap", self.gap.as_ref().map(Node::Gap)),
        ];
        let temperature = self.temperature.as_ref().map(Volume::Temperature);
        let on_volume = [
            ("acceleration", self.acceleration.map(Volume::Acceleration)),
            ("rotation", self.rotation.map(Volume::Rotation)),
            ("temperature", temperature),
        ];
        let on_nodes = on_nodes.map(|(key, action)| (key, action.map(LoadAction::OnNodes)));
        let on_volume = on_volume.map(|(key, action)| (key, action.map(LoadAction::OnVolume)));
        on_nodes.into_iter().chain(on_volume)
    }

    /// What the load does: exactly one action in a scene that was checked, `None` if no kind of
    /// load is given.
    pub fn action(&self) -> Option<LoadAction<'_>> {
        self.actions().find_map(|(_, action)| action)
    }

    /// Size of the load's force along an axis: `of_total` of a total force, `of_stress` of a
    /// uniform pressure or traction. Zero for a load that is no force, or that is given by a
    /// formula or by values at nodes.
    pub(crate) fn pushes_along(
        &self,
        along: Direction,
        of_total: impl Fn(f64) -> f64,
        of_stress: impl Fn(f64) -> f64,
    ) -> f64 {
        let Some(LoadAction::OnNodes(action)) = self.action() else {
            return 0.0;
        };
        let axis = along.axis();
        let force = match action {
            NodeAction::Force(force) => of_total(force.vector()[axis]),
            NodeAction::PlaneForce(plane) if plane.direction == along => of_total(plane.total),
            NodeAction::Pressure(pressure) => pressure.uniform().map_or(0.0, of_stress),
            NodeAction::Traction(traction) => {
                let uniform = traction.uniform();
                uniform.map_or(0.0, |traction| of_stress(traction[axis]))
            }
            NodeAction::PlaneForce(_) | NodeAction::Kirsch(_) => 0.0,
            NodeAction::Displacement(_) | NodeAction::Relative(_) | NodeAction::Gap(_) => 0.0,
        };
        force.abs()
    }
}

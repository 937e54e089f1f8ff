//! Cases on which contact codes were seen to fail silently (`data/peers`).

use super::cases::{CaseFamily, Cases, difference, results, scene};
use crate::analytical::{DiscInPlate, HertzLine, HertzPoint, contact_modulus};
use crate::error::Result;
use crate::results::State;
use crate::scene::{Scene, Stepping};

pub(super) const FAMILIES: &[CaseFamily] = &[CaseFamily {
    name: "where peers fail silently",
    figure: "pole pressure: one node touching, a node on the axis, a conforming disc; a load in \
             one step against the path",
    bound: 0.02,
    source: "Hertz, Ciavarella and Hills; 4 to 30 elements over the contact, of order h^2",
    cases: beside_peers,
}];

/// Compares the pole pressure of a scene's states with its closed form.
fn against(cases: &mut Cases, text: &str, exact: impl Fn(&State) -> Result<f64>) -> Result<()> {
    let run = results(&scene(text)?)?;
    for s in run
        .states
        .iter()
        .filter(|s| s.contact_force > 0.0 && s.plastic_points == 0)
    {
        cases.add(s.pole_pressure / exact(s)? - 1.0);
        // If a neighbouring pair carries the load of the pole, the largest pressure exceeds the
        // pole pressure.
        cases.add(s.max_pressure / exact(s)? - 1.0);
    }
    Ok(())
}

fn beside_peers(cases: &mut Cases) -> Result<()> {
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    against(
        cases,
        include_str!("../../data/peers/single_node.toml"),
        |s| Ok(HertzLine::new(10.0, modulus)?.max_pressure(s.contact_force)),
    )?;
    against(
        cases,
        include_str!("../../data/peers/axis_node.toml"),
        |s| Ok(HertzPoint::new(10.0, modulus)?.max_pressure(s.contact_force)),
    )?;
    against(
        cases,
        include_str!("../../data/peers/conforming_disc.toml"),
        |_| Ok(DiscInPlate::new(10.0)?.pressure(0.0, 100.0)),
    )?;
    let at_once: Scene = scene(include_str!("../../data/scenes/hard/one_step.toml"))?;
    let mut by_events = at_once.clone();
    by_events.program.stepping = Stepping::Events;
    let (step, path) = (results(&at_once)?, results(&by_events)?);
    for (a, b) in path.states.iter().zip(&step.states) {
        cases.add(difference(a, b, |p| p.force));
    }
    Ok(())
}

//! Undefined numbers in sets and surfaces, which are left out with a remark, as in CalculiX.

use super::Deck;
use super::data::{EntitySelection, Member, SurfacePart};
use super::sets::{Lookup, What};
use super::source::LinePlace;
use crate::error::Result;

/// A remark on a set or surface: the line, the keyword and the text.
type AbsentRemark = (LinePlace, &'static str, String);

/// The remark that the first of `n` absent numbers is left out.
fn left_out(name: &str, thing: &str, shown: &str, n: usize) -> String {
    let more = match n {
        1 => String::new(),
        n => format!(", nor {} more", n - 1),
    };
    format!("{name}: there is no {thing} {shown}{more}: left out")
}

/// Leaves undefined numbers out of the sets and surfaces of a deck.
///
/// # Errors
/// `Input` if nothing of a set or surface is left.
pub(super) fn leave_out_absent(deck: &mut Deck) -> Result<()> {
    let mut remarks = absent_of_sets(deck.lookup())?;
    leave_out_of_surfaces(deck, &mut remarks)?;
    deck.lookup().refuse_empty_circles()?;
    for (place, key, text) in remarks {
        deck.account.take(&deck.files, place, key, &text);
    }
    Ok(())
}

/// Remarks on numbers in sets for which the deck has no node or element.
fn absent_of_sets(lookup: Lookup) -> Result<Vec<AbsentRemark>> {
    let mut remarks = Vec::new();
    for what in [What::Nodes, What::Elements] {
        let [thing, key] = what.words();
        for (name, members) in lookup.sets_of(what).iter() {
            let absent = members.iter().filter_map(|(member, place)| match member {
                Member::Of(EntitySelection::Label(label)) if !lookup.has(what, *label) => {
                    Some((*label, *place))
                }
                _ => None,
            });
            let absent: Vec<(u64, LinePlace)> = absent.collect();
            let Some(&(label, place)) = absent.first() else {
                continue;
            };
            if absent.len() == members.len() {
                return Err(lookup.undefined(what, label, (place, key)));
            }
            let shown = lookup.mesh.instances.shown(label);
            remarks.push((place, key, left_out(name, thing, &shown, absent.len())));
        }
    }
    Ok(remarks)
}

/// Takes undefined numbers out of surfaces, with a remark for each surface.
fn leave_out_of_surfaces(deck: &mut Deck, remarks: &mut Vec<AbsentRemark>) -> Result<()> {
    let mut surfaces = std::mem::take(&mut deck.sets.surfaces);
    let lookup = deck.lookup();
    let mut wrong = None;
    surfaces.for_each_named(|name, parts| {
        let n = parts.len();
        let mut first = None;
        parts.retain(|(part, place)| {
            let (what, on) = match part {
                SurfacePart::Face(on, _) | SurfacePart::Free(on) => (What::Elements, on),
                SurfacePart::OfNodes(on) => (What::Nodes, on),
            };
            let EntitySelection::Label(label) = on else {
                return true;
            };
            let is_there = lookup.has(what, *label);
            if !is_there && first.is_none() {
                first = Some((*place, what, *label));
            }
            is_there
        });
        let Some((place, what, label)) = first else {
            return;
        };
        if parts.is_empty() {
            wrong.get_or_insert_with(|| lookup.undefined(what, label, (place, "SURFACE")));
        }
        let (thing, shown) = (what.words()[0], lookup.mesh.instances.shown(label));
        let text = left_out(name, thing, &shown, n - parts.len());
        remarks.push((place, "SURFACE", text));
    });
    deck.sets.surfaces = surfaces;
    wrong.map_or(Ok(()), Err)
}

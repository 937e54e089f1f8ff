//! Problems in the scene of a deck, reported in the terms of the deck.

use crate::error::Error;
use crate::scene::Scene;

/// Advice in messages about a scene, each with the corresponding advice for a deck.
const ADVICE: [(&str, &str); 12] = [
    ("load: there is no load", "*STEP: there is no load"),
    (
        "add a [[load]]",
        "give a step a *CLOAD, *DLOAD, *DSLOAD, *TEMPERATURE, or a *BOUNDARY with a value",
    ),
    (
        "add a support or a contact",
        "add a *BOUNDARY or a *CONTACT PAIR",
    ),
    (
        "give the body `integration = \"full\"`",
        "give it elements without the R behind their type",
    ),
    (" (`slave = \"first\"`)", ": name it first"),
    (" (`slave = \"second\"`)", ": name it first"),
    (" (`slave`)", ": name it first"),
    (", or give `normal`", ""),
    ("give `distance`", "give POSITION TOLERANCE"),
    ("put another term first", "write another term first"),
    ("the scene's", "the deck's"),
    ("in the scene", "in the deck"),
];

/// Keys of a material, each with the keyword of the deck that gives it.
const OF_MATERIALS: [(&str, &str); 8] = [
    (".youngs_modulus", "*ELASTIC of {}: Young's modulus"),
    (".poissons_ratio", "*ELASTIC of {}: Poisson's ratio"),
    (".density", "*DENSITY of {}"),
    (".thermal_expansion", "*EXPANSION of {}"),
    (".yield_stress", "*PLASTIC of {}: yield stress"),
    (".hardening_table", "*PLASTIC of {}"),
    (".kinematic_modulus", "*PLASTIC of {}: slope"),
    (".over_temperature", "*ELASTIC or *PLASTIC of {}"),
];

/// Lists of a scene, each with the keyword from which the entries come.
const LISTS: [(&str, &str); 5] = [
    ("contact.", "*CONTACT PAIR"),
    ("load.", "*DLOAD"),
    ("tie.", "*TIE"),
    ("equation.", "*EQUATION"),
    ("support.", "*BOUNDARY"),
];

/// Keys of a load, each with the keyword of the deck that gives it.
const OF_LOADS: [(&str, &str); 5] = [
    (".relative", "*BOUNDARY"),
    (".acceleration", "*DLOAD: GRAV"),
    (".rotation", "*DLOAD: CENTRIF"),
    (".force", "*CLOAD"),
    (".temperature", "*TEMPERATURE"),
];

/// Rewords an error about the scene of a deck as one about the deck; errors of other scenes are
/// returned unchanged.
pub(crate) fn of_deck(scene: &Scene, error: Error) -> Error {
    match scene.requests.is_of_deck() {
        true => error.reworded(|text| text_of_deck(scene, text)),
        false => error,
    }
}

/// Rewords a text about the scene of a deck as one about the deck; texts about other scenes are
/// returned unchanged.
pub(crate) fn text_of_deck(scene: &Scene, text: &str) -> String {
    if !scene.requests.is_of_deck() {
        return text.to_string();
    }
    let mut text = reworded(text);
    let lists = [
        ("contact", scene.contact.len()),
        ("tie", scene.tie.len()),
        ("equation", scene.equation.len()),
        ("support", scene.support.len()),
        ("load", scene.load.len()),
    ];
    for (list, keyword) in LISTS {
        let list = list.trim_end_matches('.');
        let n = lists
            .iter()
            .find(|(name, _)| *name == list)
            .map_or(0, |(_, n)| *n);
        for number in 0..n {
            if let Some(place) = scene.places.of(&format!("{list}.{number}")) {
                let thing = if list == "load" { list } else { keyword };
                // The place may stand in front of the text already.
                let shown = match text.contains(place) {
                    true => thing.to_string(),
                    false => format!("the {thing} of {place}"),
                };
                text = numbered(&text, &format!("{list} {}", number + 1), &shown);
            }
        }
    }
    for (number, load) in scene.load.iter().enumerate() {
        if let Some(place) = scene.places.of(&format!("load.{number}")) {
            let name = format!("load `{}`", load.name);
            text = text.replace(&name, &format!("the load of {place}"));
        }
    }
    text
}

/// Replaces an entry given by its number, such as `contact 1` in front of its surfaces, a colon or
/// `on`, by its place.
fn numbered(text: &str, entry: &str, shown: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once(entry) {
        out.push_str(before);
        let is_word = before.ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let is_entry = [" (`", ":", " on `"]
            .iter()
            .any(|end| after.starts_with(end));
        out.push_str(if is_entry && !is_word { shown } else { entry });
        rest = after;
    }
    out + rest
}

/// Rewords a message so that it contains no keys of a scene.
pub(super) fn reworded(text: &str) -> String {
    let mut text = materials(text);
    for (key, keyword) in LISTS {
        text = entries(&text, key, keyword);
    }
    for (scene, deck) in ADVICE {
        text = text.replace(scene, deck);
    }
    text
}

/// Replaces `materials.NAME.KEY`, with any index after it (`.3`), by a keyword of the material.
fn materials(text: &str) -> String {
    const START: &str = "materials.";
    let Some((before, rest)) = text.split_once(START) else {
        return text.to_string();
    };
    let keys = OF_MATERIALS.iter();
    let first = keys.filter_map(|(key, words)| Some((rest.find(key)?, key.len(), words)));
    let Some((at, length, words)) = first.min_by_key(|found| found.0) else {
        return format!("{before}*MATERIAL {}", materials(rest));
    };
    let after = rest[at + length..].trim_start_matches(|c: char| c == '.' || c.is_ascii_digit());
    let words = words.replace("{}", &rest[..at]);
    format!("{before}{words}{}", materials(after))
}

/// Replaces a path such as `contact.3.first` by a keyword.
fn entries(text: &str, key: &str, keyword: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once(key) {
        out.push_str(before);
        let is_word = before.ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '.');
        if is_word || !after.starts_with(|c: char| c.is_ascii_digit()) {
            out.push_str(key);
            rest = after;
            continue;
        }
        let is_path = |c: char| c.is_ascii_alphanumeric() || c == '.' || c == '_';
        rest = after.trim_start_matches(is_path);
        let path = &after[..after.len() - rest.len()];
        let own = OF_LOADS.iter().find(|(end, _)| path.contains(end));
        out.push_str(own.filter(|_| key == "load.").map_or(keyword, |own| own.1));
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_of_a_scene_become_keywords() {
        for (scene, deck) in [
            (
                "a.inp, line 3: materials.My steel.poissons_ratio: 0.5 must",
                "a.inp, line 3: *ELASTIC of My steel: Poisson's ratio: 0.5 must",
            ),
            (
                "materials.S.hardening_table.1: softening",
                "*PLASTIC of S: softening",
            ),
            (
                "contact.0.second: \"SL\" cannot touch itself",
                "*CONTACT PAIR: \"SL\" cannot touch itself",
            ),
            ("give materials.S.density", "give *DENSITY of S"),
            ("in contact. 3 of them", "in contact. 3 of them"),
            (
                "load.1.acceleration: has a radial",
                "*DLOAD: GRAV: has a radial",
            ),
        ] {
            assert_eq!(reworded(scene), deck);
        }
    }
}

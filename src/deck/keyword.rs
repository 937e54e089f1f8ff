//! A keyword with its parameters, and the treatment of every known keyword.

use super::fields::{Where, comma};
use super::source::{DeckLines, Files, Line, LinePlace};
use crate::error::{Error, Result};
use crate::scene::closest;

/// Largest number of bytes of a line that is read as a keyword.
const LONGEST: usize = 1 << 16;

/// The treatment of a keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Use {
    /// The keyword is read.
    Read,
    /// The keyword is skipped because it has no effect here, for the given reason.
    Ignored(&'static str),
    /// The keyword asks for an effect that brinell does not have, as the text says.
    Refused(&'static str),
}

const OUTPUT: Use = Use::Ignored(
    "output: displacements, stresses and contact of every step are written for all nodes",
);
const NO_TEMPERATURE: Use = Use::Ignored("temperatures are prescribed: no heat flows");
const CONTROL: Use =
    Use::Ignored("increments end at changes of contact; there is no iteration to control");
const SHELLS: Use = Use::Refused("bodies are continua: there are no shells, beams or membranes");
const POINTS: Use = Use::Refused("there are no springs, masses or dashpots");
const CONSTRAINTS: Use =
    Use::Refused("nodes are tied by the elements they share, by *TIE, and by *EQUATION");
const INERTIA: Use = Use::Refused("loads are applied slowly: there is no inertia and no time");
const HEAT: Use = Use::Refused("there is no heat transfer");
const LAWS: Use = Use::Refused(
    "materials are isotropic and linear elastic, with von Mises plasticity and isotropic hardening",
);

/// All known keywords, as written in manuals.
const KEYWORDS: &[(&str, Use)] = &[
    ("AMPLITUDE", Use::Read),
    ("ASSEMBLY", Use::Read),
    ("BOUNDARY", Use::Read),
    ("CLEARANCE", Use::Read),
    ("CLOAD", Use::Read),
    ("CONTACT PAIR", Use::Read),
    ("DENSITY", Use::Read),
    ("DLOAD", Use::Read),
    ("DSLOAD", Use::Read),
    ("ELASTIC", Use::Read),
    ("ELEMENT", Use::Read),
    ("ELSET", Use::Read),
    ("END ASSEMBLY", Use::Read),
    ("END INSTANCE", Use::Read),
    ("END PART", Use::Read),
    ("END STEP", Use::Read),
    ("EQUATION", Use::Read),
    ("EXPANSION", Use::Read),
    ("FRICTION", Use::Read),
    ("HEADING", Use::Read),
    ("INCLUDE", Use::Read),
    ("INSTANCE", Use::Read),
    ("MATERIAL", Use::Read),
    ("MODEL CHANGE", Use::Read),
    ("NODE", Use::Read),
    ("NSET", Use::Read),
    ("PART", Use::Read),
    ("PLASTIC", Use::Read),
    ("SOLID SECTION", Use::Read),
    ("STATIC", Use::Read),
    ("STEP", Use::Read),
    ("SURFACE", Use::Read),
    ("SURFACE BEHAVIOR", Use::Read),
    ("SURFACE INTERACTION", Use::Read),
    ("TEMPERATURE", Use::Read),
    ("TIE", Use::Read),
    ("TRANSFORM", Use::Read),
    ("CONTACT FILE", Use::Read),
    ("CONTACT INTERFERENCE", Use::Read),
    ("CONTACT OUTPUT", Use::Read),
    ("CONTACT PRINT", Use::Read),
    ("EL FILE", Use::Read),
    ("EL PRINT", Use::Read),
    ("ELEMENT OUTPUT", Use::Read),
    ("DIAGNOSTICS", OUTPUT),
    ("ELEMENT MATRIX OUTPUT", OUTPUT),
    ("ENERGY OUTPUT", OUTPUT),
    ("ENERGY PRINT", OUTPUT),
    ("FACE PRINT", OUTPUT),
    ("FILE FORMAT", OUTPUT),
    ("FILE OUTPUT", OUTPUT),
    ("FILTER", OUTPUT),
    ("INCREMENTATION OUTPUT", OUTPUT),
    ("INTEGRATED OUTPUT", OUTPUT),
    ("MONITOR", OUTPUT),
    ("NODE FILE", Use::Read),
    ("NODE OUTPUT", Use::Read),
    ("NODE PRINT", Use::Read),
    ("OUTPUT", Use::Read),
    ("PREPRINT", OUTPUT),
    ("PRINT", OUTPUT),
    ("RESTART", OUTPUT),
    ("SECTION PRINT", Use::Read),
    ("TIME POINTS", Use::Read),
    ("CONTACT CONTROLS", CONTROL),
    ("CONTROLS", CONTROL),
    ("CONDUCTIVITY", NO_TEMPERATURE),
    ("INITIAL CONDITIONS", Use::Read),
    ("PHYSICAL CONSTANTS", NO_TEMPERATURE),
    ("SPECIFIC HEAT", NO_TEMPERATURE),
    (
        "SECTION CONTROLS",
        Use::Ignored("elements have no hourglass modes to hold"),
    ),
    (
        "DAMPING",
        Use::Ignored("loads are applied slowly: damping has no effect"),
    ),
    (
        "USER ELEMENT",
        Use::Refused("there are no elements of the user's"),
    ),
    (
        "CHANGE SURFACE BEHAVIOR",
        Use::Refused("contact is the same in all steps"),
    ),
    ("MPC", CONSTRAINTS),
    ("COUPLING", Use::Read),
    ("KINEMATIC", Use::Read),
    ("DISTRIBUTING", CONSTRAINTS),
    ("DISTRIBUTING COUPLING", CONSTRAINTS),
    ("KINEMATIC COUPLING", CONSTRAINTS),
    ("EMBEDDED ELEMENT", CONSTRAINTS),
    ("RIGID BODY", Use::Read),
    (
        "RIGID SURFACE",
        Use::Refused("bodies deform: mesh it, with a stiff elastic material"),
    ),
    ("PRE-TENSION SECTION", CONSTRAINTS),
    ("SHELL SECTION", SHELLS),
    ("SHELL GENERAL SECTION", SHELLS),
    ("BEAM SECTION", SHELLS),
    ("BEAM GENERAL SECTION", SHELLS),
    ("MEMBRANE SECTION", SHELLS),
    ("FLUID SECTION", SHELLS),
    ("SPRING", POINTS),
    ("MASS", POINTS),
    ("DASHPOT", POINTS),
    ("GAP", POINTS),
    ("CYCLIC SYMMETRY MODEL", CONSTRAINTS),
    (
        "ORIENTATION",
        Use::Ignored("materials are isotropic: axes of their own change nothing"),
    ),
    ("CREEP", LAWS),
    ("CYCLIC HARDENING", LAWS),
    ("DEFORMATION PLASTICITY", LAWS),
    ("DRUCKER PRAGER", LAWS),
    ("HYPERELASTIC", LAWS),
    ("HYPERFOAM", LAWS),
    ("MOHR COULOMB", LAWS),
    ("POTENTIAL", LAWS),
    ("RATE DEPENDENT", LAWS),
    ("USER MATERIAL", LAWS),
    ("DEPVAR", LAWS),
    ("VISCOELASTIC", LAWS),
    ("DYNAMIC", INERTIA),
    ("MODAL DYNAMIC", INERTIA),
    ("STEADY STATE DYNAMICS", INERTIA),
    ("COMPLEX FREQUENCY", INERTIA),
    ("FREQUENCY", INERTIA),
    (
        "VISCO",
        Use::Refused("plastic flow does not depend on time: make it *STATIC"),
    ),
    (
        "BUCKLE",
        Use::Refused("strains and displacements are small: nothing buckles"),
    ),
    ("GREEN", INERTIA),
    (
        "SENSITIVITY",
        Use::Refused("there is no sensitivity analysis"),
    ),
    ("HEAT TRANSFER", HEAT),
    ("COUPLED TEMPERATURE-DISPLACEMENT", HEAT),
    ("UNCOUPLED TEMPERATURE-DISPLACEMENT", HEAT),
    ("CFLUX", HEAT),
    ("DFLUX", HEAT),
    ("FILM", HEAT),
    ("RADIATE", HEAT),
    ("GAP CONDUCTANCE", HEAT),
    ("SUBMODEL", Use::Refused("there are no submodels")),
    ("SUPERELEMENT", Use::Refused("there are no substructures")),
    (
        "CONTACT",
        Use::Refused("general contact names no surfaces: give a *CONTACT PAIR for each"),
    ),
    (
        "CONTACT INCLUSIONS",
        Use::Refused("general contact names no surfaces: give *CONTACT PAIR"),
    ),
    ("BASE MOTION", INERTIA),
    (
        "IMPERFECTION",
        Use::Refused("nodes stay where they are given"),
    ),
    (
        "NGEN",
        Use::Refused("nodes are not generated: write them out"),
    ),
    (
        "NFILL",
        Use::Refused("nodes are not generated: write them out"),
    ),
    (
        "NCOPY",
        Use::Refused("nodes are not generated: write them out"),
    ),
    (
        "ELGEN",
        Use::Refused("elements are not generated: write them out"),
    ),
    (
        "ELCOPY",
        Use::Refused("elements are not generated: write them out"),
    ),
    (
        "SYSTEM",
        Use::Refused("coordinates are global: give them in x, y, z"),
    ),
];

/// A keyword line of a deck.
#[derive(Debug, Clone)]
pub(super) struct Keyword {
    /// Name as written in [`KEYWORDS`], or in the deck if it is not a known keyword.
    pub(super) name: String,
    /// Names in capitals without blanks, and values as written.
    parameters: Vec<(String, Option<String>)>,
    pub(super) place: LinePlace,
}

/// A message that a name does not exist, with the name that may be meant, or else with advice.
pub(super) fn no_such<'n>(
    what: &str,
    name: &str,
    known: impl Iterator<Item = &'n str>,
    otherwise: &str,
) -> String {
    let known: Vec<String> = known.map(str::to_lowercase).collect();
    let words: Vec<&str> = known.iter().map(String::as_str).collect();
    match closest(name, &words) {
        Some(meant) => {
            let meant = meant.to_uppercase();
            format!("there is no {what} {name}, did you mean {meant}?")
        }
        None => format!("there is no {what} {name}; {otherwise}"),
    }
}

/// A word in capitals without blanks, because neither case nor blanks are significant.
pub(super) fn plain(word: &str) -> String {
    let letters = word.chars().filter(|c| !c.is_whitespace());
    letters.map(|c| c.to_ascii_uppercase()).collect()
}

impl Keyword {
    /// Reads a keyword line with its continuations: a line that ends with a comma continues in the
    /// next.
    ///
    /// # Errors
    /// The errors of [`DeckLines::next`].
    pub(super) fn read(source: &mut DeckLines, line: Line) -> Result<Keyword> {
        let mut text = String::from_utf8_lossy(source.bytes(line)).into_owned();
        while text.ends_with(',') && text.len() < LONGEST {
            let Some(next) = source.next_data()? else {
                break;
            };
            text.push_str(&String::from_utf8_lossy(source.bytes(next)));
        }
        Ok(Keyword::parse(&text, line.place))
    }

    /// Parses a keyword line that begins with an asterisk, with its continuations joined.
    fn parse(text: &str, place: LinePlace) -> Keyword {
        let mut rest = Some(text.trim_start_matches('*'));
        let mut parts = std::iter::from_fn(|| {
            let text = rest?;
            let length = comma(text.as_bytes());
            rest = length.map(|length| &text[length + 1..]);
            Some(&text[..length.unwrap_or(text.len())])
        });
        let written = parts.next().unwrap_or_default().trim().to_ascii_uppercase();
        let known = find(&plain(&written)).map(|(name, _)| name.to_string());
        let parameters = parts.map(str::trim).filter(|part| !part.is_empty());
        let parameters = parameters.map(|part| match part.split_once('=') {
            Some((key, value)) => (plain(key), Some(value.trim().replace('"', ""))),
            None => (plain(part), None),
        });
        Keyword {
            name: known.unwrap_or(written),
            parameters: parameters.collect(),
            place,
        }
    }

    /// The treatment of the keyword.
    ///
    /// # Errors
    /// A message for an unknown keyword, with the keyword that may be meant.
    pub(super) fn what_for(&self) -> std::result::Result<Use, String> {
        if let Some((_, what)) = find(&plain(&self.name)) {
            return Ok(what);
        }
        let known: Vec<String> = KEYWORDS.iter().map(|(k, _)| k.to_lowercase()).collect();
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        Err(match closest(&self.name, &known) {
            Some(meant) => format!(
                "unknown keyword, did you mean *{}?",
                meant.to_ascii_uppercase()
            ),
            None => "unknown keyword; take it out, with the lines that belong to it".to_string(),
        })
    }

    /// Names of the parameters in capitals without blanks, and their values.
    pub(super) fn parameters(&self) -> impl Iterator<Item = (&str, Option<&str>)> {
        let all = self.parameters.iter();
        all.map(|(name, value)| (name.as_str(), value.as_deref()))
    }

    /// An error at the keyword's line.
    pub(super) fn error(&self, files: &Files, message: impl std::fmt::Display) -> Error {
        let (place, name) = (files.show(self.place), &self.name);
        Error::input(format!("{place}: *{name}: {message}"))
    }

    /// The place of one of the keyword's data lines, for messages.
    pub(super) fn at<'t>(&'t self, file: &'t str, place: LinePlace) -> Where<'t> {
        Where {
            file,
            line: place.line(),
            keyword: &self.name,
        }
    }

    /// Whether a parameter is given, with or without a value.
    pub(super) fn has(&self, key: &str) -> bool {
        self.parameters.iter().any(|(name, _)| name == key)
    }

    /// The value of a parameter; `None` if it is not given or has no value.
    pub(super) fn get(&self, key: &str) -> Option<&str> {
        let mut found = self.parameters.iter().filter(|(name, _)| name == key);
        found.next().and_then(|(_, value)| value.as_deref())
    }

    /// The value of a required parameter.
    ///
    /// # Errors
    /// `Input` if the parameter or its value is missing.
    pub(super) fn require(&self, files: &Files, key: &str) -> Result<&str> {
        self.get(key)
            .filter(|value| !value.is_empty())
            .ok_or_else(|| {
                let message = format!("the parameter {key} is missing; write {key}=...");
                self.error(files, message)
            })
    }

    /// The value of an optional parameter that must be a number.
    ///
    /// # Errors
    /// `Input` if the value is not a number.
    pub(super) fn number(&self, files: &Files, key: &str) -> Result<Option<f64>> {
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        let number = value.parse::<f64>().ok().filter(|value| value.is_finite());
        let wrong = || self.error(files, format!("{key}={value} is not a number; give one"));
        number.ok_or_else(wrong).map(Some)
    }

    /// The value of a parameter, which must be one of the given words; the first word if the
    /// parameter is not given.
    ///
    /// # Errors
    /// `Input` with the value and the possible words.
    pub(super) fn choice(
        &self,
        files: &Files,
        key: &str,
        words: &[&'static str],
    ) -> Result<&'static str> {
        if !self.has(key) {
            return Ok(words[0]);
        }
        let value = self.get(key).unwrap_or_default();
        let found = words.iter().find(|word| plain(word) == plain(value));
        found.copied().ok_or_else(|| {
            let can_be = words.join(", ");
            self.error(
                files,
                format!("{key}={value} is not known here; it can be {can_be}"),
            )
        })
    }

    /// Checks that the keyword has no parameters other than the given ones.
    ///
    /// # Errors
    /// `Input`, naming the first other parameter.
    pub(super) fn allow(&self, files: &Files, known: &[&str]) -> Result<()> {
        let other = self
            .parameters
            .iter()
            .find(|(name, _)| !known.contains(&name.as_str()));
        let Some((name, _)) = other else {
            return Ok(());
        };
        let lower: Vec<String> = known.iter().map(|k| k.to_lowercase()).collect();
        let lower: Vec<&str> = lower.iter().map(String::as_str).collect();
        let meant = closest(name, &lower).map_or(String::new(), |meant| {
            format!(", did you mean {}?", meant.to_ascii_uppercase())
        });
        let known = match known {
            [] => "it takes none".to_string(),
            _ => format!("known here: {}", known.join(", ")),
        };
        Err(self.error(files, format!("unknown parameter {name}{meant} ({known})")))
    }
}

fn find(plain_name: &str) -> Option<(&'static str, Use)> {
    let mut all = KEYWORDS.iter();
    all.find(|(name, _)| plain(name) == plain_name).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn case_and_blanks_mean_nothing() {
        let line = "*solidsection , ELSET = \"My set\", m a t e rial=Steel";
        let keyword = Keyword::parse(line, LinePlace::default());
        assert_eq!(keyword.name, "SOLID SECTION");
        assert_eq!(keyword.get("ELSET"), Some("My set"));
        assert_eq!(keyword.get("MATERIAL"), Some("Steel"));
        let unknown = Keyword::parse("*NODES", LinePlace::default());
        let message = unknown.what_for().unwrap_err();
        assert!(message.contains("did you mean *NODE?"), "{message}");
    }
}

//! The key `accuracy`, such as `accuracy = "1 %"`: how wrong the results may be, either all of them
//! or only the quantities that are named.

use crate::results::{QUANTITIES, Quantity};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Quantities whose accuracy can be demanded: their keys in `summary.json`, and short names.
fn demanded() -> impl Iterator<Item = (&'static str, &'static str)> {
    let short = |quantity: &'static Quantity| Some((quantity.key, quantity.estimated?.short));
    QUANTITIES.iter().filter_map(short)
}

/// A demanded relative accuracy of every quantity (`"1 %"` or `0.01`), or of the quantities that
/// are named (`"load = 0.5 %, dent = 2 %"` or a table). A name is a key of `summary.json`, the
/// key's short name or a whole path such as `states.pressed.load`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "String")]
pub struct AccuracyDemand {
    /// Demand on quantities that are not named; `None` if some quantities are named.
    all: Option<f64>,
    /// Demands by key or path.
    named: BTreeMap<String, f64>,
}

impl AccuracyDemand {
    /// Upper bound of an accuracy that can be demanded; the bound itself is excluded.
    pub const LARGEST: f64 = 1.0;

    /// Demands one relative accuracy of every quantity.
    ///
    /// # Errors
    /// A message in words unless `0 < accuracy < 1`.
    pub fn new(accuracy: f64) -> Result<Self, String> {
        Ok(AccuracyDemand {
            all: Some(checked(accuracy)?),
            named: BTreeMap::new(),
        })
    }

    /// The demand on a named quantity, looked up by its path (`yield.KEY`, `states.NAME.KEY`), then
    /// by its key.
    pub fn named(&self, path: &str) -> Option<f64> {
        let key = path.rsplit('.').next().unwrap_or(path);
        self.named
            .get(path)
            .or_else(|| self.named.get(key))
            .copied()
    }

    /// The demand on quantities that are not named.
    pub fn all(&self) -> Option<f64> {
        self.all
    }

    /// The smallest of all demanded accuracies.
    pub fn tightest(&self) -> f64 {
        let named = self.named.values().copied();
        named.chain(self.all).fold(Self::LARGEST, f64::min)
    }

    fn with(mut self, name: &str, accuracy: f64) -> Result<Self, String> {
        let name = key(name)?;
        match self.named.insert(name.clone(), checked(accuracy)?) {
            None => Ok(self),
            Some(_) => Err(format!("the accuracy of `{name}` is demanded twice")),
        }
    }

    fn of_nothing() -> Self {
        AccuracyDemand {
            all: None,
            named: BTreeMap::new(),
        }
    }
}

/// Returns a relative accuracy that lies within its bounds, or the error otherwise.
fn checked(accuracy: f64) -> Result<f64, String> {
    if accuracy > 0.0 && accuracy < AccuracyDemand::LARGEST {
        Ok(accuracy)
    } else {
        Err(format!(
            "an accuracy of {accuracy:?} makes no sense; give one above 0 and below 100 %, such \
             as \"1 %\""
        ))
    }
}

/// The key of a quantity from its name (key or short name), or a whole path that ends with such a
/// key.
fn key(name: &str) -> Result<String, String> {
    let name = name.trim();
    let (prefix, last) = match name.rsplit_once('.') {
        Some((prefix, last)) => (Some(prefix), last),
        None => (None, name),
    };
    let is_place = prefix.is_none_or(|p| p == "yield" || p.starts_with("states."));
    let known = demanded().find(|(key, short)| last == *key || last == *short);
    match (known, prefix) {
        (Some((key, _)), Some(prefix)) if is_place => Ok(format!("{prefix}.{key}")),
        (Some((key, _)), None) => Ok((*key).to_string()),
        _ => {
            let all = demanded().map(|(key, short)| match key == short {
                true => key.to_string(),
                false => format!("{key} (or {short})"),
            });
            let all: Vec<String> = all.collect();
            Err(format!(
                "`{name}` is no quantity whose accuracy can be demanded; there are {}, also of one \
                 state as yield.load or states.NAME.load",
                all.join(", ")
            ))
        }
    }
}

impl JsonSchema for AccuracyDemand {
    fn schema_name() -> Cow<'static, str> {
        "AccuracyDemand".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let one = json_schema!({
            "type": ["string", "number"],
            "exclusiveMinimum": 0,
            "exclusiveMaximum": Self::LARGEST,
        });
        json_schema!({
            "description": "Largest stated error of each quantity relative to its size, above 0 \
                            and below 100 %: \"1 %\" or 0.01 for all; \"load = 0.5 %, dent = 2 %\" \
                            or a table for those that are named.",
            "type": ["string", "number", "object"],
            "exclusiveMinimum": 0,
            "exclusiveMaximum": Self::LARGEST,
            "additionalProperties": one,
        })
    }
}

/// The demand in the form in which a scene writes it.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "an accuracy such as \"1 %\" or \"load = 0.5 %, dent = 2 %\""
)]
enum Written {
    Text(String),
    Number(f64),
    Table(BTreeMap<String, WrittenShare>),
}

/// The accuracy of one quantity in a table of demands.
#[derive(Deserialize)]
#[serde(untagged, expecting = "an accuracy such as \"1 %\"")]
enum WrittenShare {
    Text(String),
    Number(f64),
}

impl TryFrom<Written> for AccuracyDemand {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        match written {
            Written::Text(text) => Self::try_from(text),
            Written::Number(value) => Self::new(value),
            Written::Table(table) => {
                let of = |demand: Self, (name, share): (String, WrittenShare)| match share {
                    WrittenShare::Text(text) => demand.with(&name, share_of(&text)?),
                    WrittenShare::Number(value) => demand.with(&name, value),
                };
                if table.is_empty() {
                    return Err("no quantity is named".to_string());
                }
                table.into_iter().try_fold(Self::of_nothing(), of)
            }
        }
    }
}

/// Reads a share from text: `1 %` or `0.01`.
fn share_of(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.trim().strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text.trim(), 1.0),
    };
    let value: f64 = number
        .trim()
        .parse()
        .map_err(|_| format!("\"{text}\" is no accuracy; give one such as \"1 %\""))?;
    Ok(value * unit)
}

impl TryFrom<String> for AccuracyDemand {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        if !text.contains('=') {
            return Self::new(share_of(&text)?);
        }
        text.split(',').try_fold(Self::of_nothing(), |demand, one| {
            let (name, share) = one.split_once('=').ok_or_else(|| {
                format!("\"{one}\" names no quantity; give one such as \"load = 1 %\"")
            })?;
            demand.with(name, share_of(share)?)
        })
    }
}

impl From<AccuracyDemand> for String {
    fn from(demand: AccuracyDemand) -> String {
        let share = |share: f64| format!("{} %", 100.0 * share);
        let named = demand
            .named
            .iter()
            .map(|(name, of)| format!("{name} = {}", share(*of)));
        let all: Vec<String> = demand.all.map(share).into_iter().chain(named).collect();
        all.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<AccuracyDemand, String> {
        AccuracyDemand::try_from(text.to_string())
    }

    #[test]
    fn per_cent_and_shares_are_read() {
        for (text, value) in [
            ("1 %", 0.01),
            ("0.3%", 0.003),
            ("0.1", 0.1),
            (" 10 % ", 0.1),
            ("99 %", 0.99),
        ] {
            let read = read(text).unwrap();
            assert!((read.tightest() - value).abs() < 1e-15, "{text}");
            assert_eq!(read.all(), Some(read.tightest()));
        }
        for wrong in ["", "%", "0 %", "-1 %", "100 %", "a few %", "nan"] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn only_what_is_named_is_demanded() {
        let demand = read("load=0.5%, dent = 2 %, states.hot.load = 1%").unwrap();
        assert_eq!(demand.named("yield.load"), Some(0.005));
        assert_eq!(demand.named("states.hot.load"), Some(0.01));
        assert_eq!(demand.named("states.off.residual_depth"), Some(0.02));
        assert_eq!(
            (demand.named("yield.half_width"), demand.all()),
            (None, None)
        );
        assert_eq!(demand.tightest(), 0.005);
        let written = String::from(demand.clone());
        assert_eq!(read(&written).unwrap(), demand, "{written}");
        for (wrong, says) in [
            ("load=1%, presure=1%", "`presure` is no quantity"),
            ("states.load=1%", "`states.load` is no quantity"),
            ("load=1%, load=2%", "demanded twice"),
            ("load=1%, 2%", "names no quantity"),
            ("dent=0", "above 0"),
        ] {
            let error = read(wrong).unwrap_err();
            assert!(error.contains(says), "{wrong}: {error}");
        }
    }

    #[test]
    fn a_number_is_a_share_and_a_table_names_quantities() {
        let read = |text: &str| toml::from_str::<BTreeMap<String, AccuracyDemand>>(text);
        let shares = read("accuracy = 0.01").unwrap();
        assert_eq!(shares["accuracy"].tightest(), 0.01);
        assert_eq!(read("accuracy = \"1 %\"").unwrap(), shares);
        let table = read("accuracy = { load = 0.005, dent = \"2 %\" }").unwrap();
        assert_eq!(
            table,
            read("accuracy = \"load = 0.5 %, dent = 2 %\"").unwrap()
        );
        for (wrong, says) in [
            ("0", "such as \"1 %\""),
            ("1", "below 100 %"),
            ("true", "an accuracy such as"),
            ("{}", "no quantity is named"),
        ] {
            let error = read(&format!("accuracy = {wrong}")).unwrap_err();
            assert!(error.to_string().contains(says), "{error}");
        }
    }
}

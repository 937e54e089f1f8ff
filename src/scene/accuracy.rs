//! `accuracy = "1 %"`: how wrong the results may be.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A demanded relative accuracy, read from `"1 %"` or `0.01`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "String")]
pub struct AccuracyDemand(f64);

impl AccuracyDemand {
    /// Largest accuracy that can be demanded.
    pub const LARGEST: f64 = 0.5;

    /// A relative accuracy.
    ///
    /// # Errors
    /// Unless `0 < accuracy <= 0.5`, in words.
    pub fn new(accuracy: f64) -> Result<Self, String> {
        if accuracy > 0.0 && accuracy <= Self::LARGEST {
            Ok(AccuracyDemand(accuracy))
        } else {
            Err(format!(
                "an accuracy of {accuracy} makes no sense; give one above 0 and up to 50 %, such as \"1 %\""
            ))
        }
    }

    /// The largest stated error relative to the size of a quantity.
    pub fn relative(self) -> f64 {
        self.0
    }
}

impl JsonSchema for AccuracyDemand {
    fn schema_name() -> Cow<'static, str> {
        "AccuracyDemand".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Largest error of each quantity relative to its size, above 0 and up to 50 %: \"1 %\" or 0.01.",
            "type": ["string", "number"],
            "exclusiveMinimum": 0,
            "maximum": Self::LARGEST,
            "pattern": "^\\s*[0-9.eE+-]+\\s*%?\\s*$",
        })
    }
}

/// As it stands in a scene.
#[derive(Deserialize)]
#[serde(untagged, expecting = "an accuracy such as \"1 %\"")]
enum Written {
    Text(String),
    Number(f64),
}

impl TryFrom<Written> for AccuracyDemand {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        match written {
            Written::Text(text) => Self::try_from(text),
            Written::Number(value) => Self::new(value),
        }
    }
}

impl TryFrom<String> for AccuracyDemand {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let (number, unit) = match text.trim().strip_suffix('%') {
            Some(number) => (number, 0.01),
            None => (text.trim(), 1.0),
        };
        let value: f64 = number
            .trim()
            .parse()
            .map_err(|_| format!("\"{text}\" is no accuracy; give one such as \"1 %\""))?;
        Self::new(value * unit)
    }
}

impl From<AccuracyDemand> for String {
    fn from(demand: AccuracyDemand) -> String {
        format!("{} %", 100.0 * demand.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn per_cent_and_shares_are_read() {
        for (text, value) in [
            ("1 %", 0.01),
            ("0.3%", 0.003),
            ("0.1", 0.1),
            (" 10 % ", 0.1),
        ] {
            let read = AccuracyDemand::try_from(text.to_string()).unwrap();
            assert!((read.relative() - value).abs() < 1e-15, "{text}");
        }
        for wrong in ["", "%", "0 %", "-1 %", "60 %", "a few %", "nan"] {
            assert!(
                AccuracyDemand::try_from(wrong.to_string()).is_err(),
                "{wrong}"
            );
        }
    }

    #[test]
    fn a_number_is_a_share() {
        let read =
            |text: &str| toml::from_str::<std::collections::BTreeMap<String, AccuracyDemand>>(text);
        let shares = read("accuracy = 0.01").unwrap();
        assert_eq!(shares["accuracy"].relative(), 0.01);
        assert_eq!(read("accuracy = \"1 %\"").unwrap(), shares);
        for (wrong, says) in [
            ("0", "such as \"1 %\""),
            ("1", "up to 50 %"),
            ("true", "an accuracy such as"),
        ] {
            let error = read(&format!("accuracy = {wrong}")).unwrap_err();
            assert!(error.to_string().contains(says), "{error}");
        }
    }
}

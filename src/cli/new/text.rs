//! Texts and figures that new scenes have in common.

use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::number::significant;

pub(super) const HEAD: &str = "# Made by `brinell new`; every value may be changed.
# Check it with `brinell check`, run it with `brinell run`.
# Units N, mm, MPa: brinell converts nothing, any consistent ones will do.
";
pub(super) const UNITS: &str =
    "units = { length = \"mm\", force = \"N\", stress = \"MPa\" }   # names for the report";

/// A new scene, and its mesh if no generator makes it.
pub(in crate::cli) struct Started {
    pub text: String,
    pub mesh: Option<Mesh>,
    /// Text to print in addition to the path of the scene.
    pub note: String,
}

impl From<String> for Started {
    fn from(text: String) -> Self {
        Started {
            text,
            mesh: None,
            note: String::new(),
        }
    }
}

/// Rounds a load up to two digits, which are enough for a load that nobody gave.
pub(super) fn rounded_up(load: f64) -> f64 {
    let digits = 10f64.powf(load.log10().floor() - 1.0);
    (load / digits).ceil() * digits
}

/// Formats a number as in TOML: with a point or an exponent.
pub(super) fn toml(value: f64) -> String {
    let text = format!("{value:?}");
    match text.parse::<f64>() {
        Ok(_) => text,
        // Rust's spelling of infinity is not valid in TOML; reading the scene refuses nan and
        // infinity alike.
        Err(_) => "nan".to_string(),
    }
}

/// Returns the largest load: as given, else three times the load at first yield.
pub(super) fn largest(load: Option<f64>, yield_load: Option<f64>) -> Result<f64> {
    let by_default = yield_load.map(|load| rounded_up(3.0 * load));
    load.or(by_default).ok_or_else(|| {
        Error::input(
            "nothing yields, so that no load suggests itself: give the largest one (--load)",
        )
    })
}

/// Returns the comment on the loads for the head of a scene, and the target at first yield if yield
/// is reached.
pub(super) fn about_loads(
    load: f64,
    yield_load: Option<f64>,
    unit: &str,
) -> (String, &'static str) {
    let Some(first) = yield_load else {
        return ("# Nothing can yield.\n".to_string(), "");
    };
    let (yields, times) = (significant(first, 4), significant(load / first, 3));
    let text = format!(
        "# By Hertz the material first yields at a load of {yields} {unit};\n# the largest load is \
         {times} times that.\n"
    );
    let target = match load > first {
        true => "    { yield = true },                    # first yield\n",
        false => "",
    };
    (text, target)
}

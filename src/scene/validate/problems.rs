//! What is wrong with a scene, value by value.

use crate::number::exact;
use std::fmt;

/// Bound of sizes, stresses and slopes: values beyond it, or below its inverse, overflow or vanish
/// when multiplied together.
pub(super) const LARGEST: f64 = 1e100;

/// Something wrong with the value at a key path.
pub(in crate::scene) struct Problem {
    /// Key path of the value, such as `contact.0.gap`.
    pub(in crate::scene) key: String,
    message: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.key.is_empty() {
            f.write_str(&self.message)
        } else {
            write!(f, "{}: {}", self.key, self.message)
        }
    }
}

/// The problems of a scene that were found so far.
#[derive(Default)]
pub(super) struct Problems(Vec<Problem>);

impl Problems {
    pub(super) fn number(&self) -> usize {
        self.0.len()
    }

    pub(super) fn into_vec(self) -> Vec<Problem> {
        self.0
    }

    pub(super) fn problem(&mut self, key: impl Into<String>, message: impl Into<String>) {
        self.0.push(Problem {
            key: key.into(),
            message: message.into(),
        });
    }

    /// Reports `message` at `key` unless `holds`.
    pub(super) fn require(
        &mut self,
        holds: bool,
        key: impl Into<String>,
        message: impl Into<String>,
    ) {
        if !holds {
            self.problem(key, message);
        }
    }

    pub(super) fn positive(&mut self, key: impl Into<String>, value: f64) {
        self.must(value > 0.0, key, value, "be greater than zero");
    }

    /// Requires a stress or a modulus to be positive, and of a size whose products do not overflow.
    pub(super) fn stress(&mut self, key: impl Into<String>, value: f64) {
        let range = 1.0 / LARGEST..=LARGEST;
        self.require(
            range.contains(&value),
            key,
            if value > 0.0 {
                let value = exact(value);
                format!(
                    "{value} must lie between {:e} and {LARGEST:e}",
                    1.0 / LARGEST
                )
            } else {
                format!("{} must be greater than zero", exact(value))
            },
        );
    }

    /// Requires a slope that was computed from values of `key` to be small enough not to overflow.
    pub(super) fn slope(&mut self, key: impl Into<String>, what: &str, slope: f64) {
        self.require(
            slope.abs() <= LARGEST,
            key,
            format!(
                "{what} is {}, beyond {LARGEST:e}: it would overflow",
                exact(slope)
            ),
        );
    }

    /// Requires the slope to a point of a curve from the point before to be small enough.
    pub(super) fn slope_between(&mut self, key: &str, [before, after]: [[f64; 2]; 2]) {
        if after[0] > before[0] {
            let slope = (after[1] - before[1]) / (after[0] - before[0]);
            self.slope(key, "the slope from the row before", slope);
        }
    }

    /// Reports that a value must follow a rule, unless it `holds`.
    pub(super) fn must(&mut self, holds: bool, key: impl Into<String>, value: f64, rule: &str) {
        self.require(holds, key, format!("{} must {rule}", exact(value)));
    }

    /// Reports that two numbers, which are given together, must follow a rule, unless it `holds`.
    pub(super) fn pair_must(
        &mut self,
        holds: bool,
        key: impl Into<String>,
        [first, second]: [f64; 2],
        rule: &str,
    ) {
        let pair = format!("[{}, {}]", exact(first), exact(second));
        self.require(holds, key, format!("{pair} must {rule}"));
    }

    /// Requires a value in a row to be greater than the one in the row before. `what` names the
    /// value in the message.
    pub(super) fn grows(&mut self, key: &str, what: &str, [before, value]: [f64; 2]) {
        let rule = format!("must be greater than {} of the row before", exact(before));
        self.require(
            value > before,
            key,
            format!("{what}{} {rule}", exact(value)),
        );
    }

    pub(super) fn at_least(&mut self, key: impl Into<String>, value: f64, least: f64) {
        self.require(
            value >= least,
            key,
            format!("{} must be at least {}", exact(value), exact(least)),
        );
    }

    pub(super) fn count(&mut self, key: impl Into<String>, value: usize, least: usize) {
        self.require(
            value >= least,
            key,
            format!("{value} must be at least {least}"),
        );
    }

    pub(super) fn at_most(&mut self, key: impl Into<String>, value: usize, most: usize) {
        self.require(
            value <= most,
            key,
            format!("{value} is too many: at most {most}"),
        );
    }

    /// Reports a problem unless exactly one of `choices` (name, given) is given.
    pub(super) fn exactly_one(
        &mut self,
        key: impl Into<String>,
        what: &str,
        choices: &[(&str, bool)],
    ) {
        let names = |given_only: bool| -> String {
            let names: Vec<&str> = choices
                .iter()
                .filter(|(_, given)| *given || !given_only)
                .map(|(name, _)| *name)
                .collect();
            names.join(", ")
        };
        match choices.iter().filter(|(_, given)| *given).count() {
            1 => {}
            0 => self.problem(
                key,
                format!("no {what}; give exactly one of {}", names(false)),
            ),
            n => self.problem(
                key,
                format!("{n} of {what} given ({}); keep exactly one", names(true)),
            ),
        }
    }
}

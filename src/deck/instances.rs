//! Instances of parts: their names, and the numbering of their nodes and elements.
//!
//! Numbers are repeated between instances. In the whole deck, the number of the instance is put in
//! front of the number within the part: node 16 of the second instance is 216.

/// The instances of a deck, in the deck's order; empty for a deck without parts.
#[derive(Debug, Clone, Default)]
pub(super) struct Instances {
    names: Vec<String>,
    /// A power of ten that is greater than all numbers in the deck.
    unit: u64,
}

impl Instances {
    /// Instances with the given names and with numbers up to `largest`; `None` if the resulting
    /// numbers would have too many digits.
    pub(super) fn new(names: Vec<String>, largest: u64) -> Option<Instances> {
        const MOST: u64 = 10u64.pow(18);
        let mut unit = 10u64;
        while unit <= largest {
            unit = unit.checked_mul(10)?;
        }
        let end = unit.checked_mul(names.len() as u64 + 1)?;
        (end <= MOST).then_some(Instances { names, unit })
    }

    /// The instance of the given name, without regard to case.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        let name = name.to_uppercase();
        self.names.iter().position(|of| of.to_uppercase() == name)
    }

    /// Names of the instances.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// The number that is added to all numbers of an instance.
    pub(super) fn offset(&self, instance: usize) -> u64 {
        (instance as u64 + 1) * self.unit
    }

    /// The largest number that a node or element can have within its part.
    pub(super) fn most(&self) -> u64 {
        self.unit.saturating_sub(1)
    }

    /// The instance to which a number of the whole deck belongs.
    pub(super) fn of(&self, label: u64) -> Option<usize> {
        let number = label.checked_div(self.unit)?.checked_sub(1)?;
        usize::try_from(number)
            .ok()
            .filter(|number| *number < self.names.len())
    }

    /// Shows a number of the whole deck as the number within its part, with the instance.
    pub(super) fn shown(&self, label: u64) -> String {
        match self.of(label) {
            Some(instance) => {
                let own = label - self.offset(instance);
                format!("{own} of instance {}", self.names[instance])
            }
            None => label.to_string(),
        }
    }

    /// Advice for a number that is not defined.
    pub(super) fn hint(&self, label: u64) -> &'static str {
        match self.names.is_empty() || self.of(label).is_some() {
            true => "",
            false => " outside of instances; those of an instance are INSTANCE.NUMBER",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_tell_their_instance() {
        let names = vec!["Lower-1".to_string(), "Upper-1".to_string()];
        let instances = Instances::new(names, 100).unwrap();
        assert_eq!(instances.find("UPPER-1"), Some(1));
        assert_eq!(instances.offset(1) + 16, 2016);
        assert_eq!(instances.shown(2016), "16 of instance Upper-1");
        assert_eq!(instances.shown(3016), "3016");
        assert_eq!(instances.shown(7), "7");
        assert_eq!(Instances::default().shown(7), "7");
        assert!(Instances::new(vec![String::new()], u64::MAX).is_none());
    }
}

//! The load factors between which a support or a prescribed displacement holds its nodes.
//!
//! The load factors at which such a support or displacement begins or ends divide the program into
//! legs. Within a leg the same displacements are held.

use super::{History, Load, Support};

/// The load factors between which a support or a prescribed displacement holds its nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    /// Load factor from which on the nodes are held; `None` for the start of the program.
    pub(crate) since: Option<f64>,
    /// Load factor up to which the nodes are held, and load factor at which their support forces
    /// have been reduced to zero; `None` if the nodes are held to the end.
    pub(crate) until: Option<[f64; 2]>,
}

impl Span {
    /// The span of a support or prescribed displacement that holds its nodes throughout the
    /// program.
    pub(crate) const WHOLE: Span = Span {
        since: None,
        until: None,
    };

    /// Whether the nodes are held throughout the program.
    pub(crate) fn is_whole(self) -> bool {
        self.since.is_none() && self.until.is_none()
    }

    /// Whether the nodes are held in the leg that begins at a load factor.
    pub(crate) fn holds_from(self, start: f64) -> bool {
        let begun = self.since.is_none_or(|since| since <= start);
        begun && self.until.is_none_or(|until| start < until[0])
    }

    /// The load factors at which the span begins and ends, if they lie within the program.
    pub(crate) fn changes(self) -> impl Iterator<Item = f64> {
        self.since
            .into_iter()
            .chain(self.until.map(|until| until[0]))
    }
}

impl Support {
    /// A support of a set over a span, without any held direction yet.
    pub(crate) fn over(on: String, span: Span) -> Support {
        Support {
            on,
            since: span.since,
            until: span.until,
            ..Support::default()
        }
    }

    pub(crate) fn span(&self) -> Span {
        Span {
            since: self.since,
            until: self.until,
        }
    }
}

impl Load {
    pub(crate) fn span(&self) -> Span {
        Span {
            since: self.since,
            until: self.until,
        }
    }

    /// Whether the nodes stay at the position that they have when the load begins to prescribe
    /// their displacement.
    pub(crate) fn stays(&self) -> bool {
        self.since.is_some() && self.history == History::Constant
    }

    /// The load factor at which nodes whose displacement is prescribed from `since` on reach the
    /// values of the history: the first row of its table after `since`.
    pub(crate) fn arrives(&self) -> Option<f64> {
        let History::Table(rows) = &self.history else {
            return None;
        };
        let later = rows.iter().map(|row| row[0]);
        self.since
            .and_then(|since| later.into_iter().find(|at| *at > since))
    }
}

//! The ending of a run, in the words of the command line, C and Python.

use crate::error::{Error, ErrorKind, Result};
use crate::number::percent;
use crate::results::{Demand, Ending, Results};

/// Checks that a run achieved what was asked of it: the program ran to its end, the quality of
/// every state is within its tolerance, and a demanded accuracy was reached.
///
/// # Errors
/// The error of [`Ending::kind`]: if the run ended before its program did, the reason; `Inaccurate`
/// with every figure that falls short. The results exist in each case.
pub fn ending(results: &Results) -> Result<()> {
    match results.ending() {
        Ending::Complete => Ok(()),
        Ending::Incomplete(incomplete) => {
            Err((incomplete.to_error()).within("the run ended before its program did"))
        }
        Ending::Inaccurate { states, demand } => {
            let short: Vec<String> = states.iter().cloned().chain(demand.map(in_words)).collect();
            Err(Error::new(ErrorKind::Inaccurate, short.join("\n")))
        }
    }
}

/// Describes a demanded accuracy in a sentence.
pub(crate) fn in_words(demand: &Demand) -> String {
    let stated = if demand.stated.is_finite() {
        format!("the stated error is {}", percent(demand.stated))
    } else {
        "no error was stated".to_string()
    };
    let worst = demand
        .worst
        .as_ref()
        .map_or(String::new(), |worst| format!(" ({worst})"));
    let unknown = match demand.unknown.as_slice() {
        [] => String::new(),
        unknown => format!("; no error is known of {}", unknown.join(", ")),
    };
    let became = match (demand.reached, &demand.reason) {
        (true, _) => "reached".to_string(),
        (false, None) => "NOT reached".to_string(),
        (false, Some(why)) => format!("NOT reached: {why}"),
    };
    format!(
        "Demanded accuracy {}: {became}; {stated}{worst}{unknown}",
        demand.demanded
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Accuracy, Demand, Incomplete};

    #[test]
    fn everything_that_falls_short_is_said() {
        let mut results = Results::default();
        assert!(ending(&results).is_ok());
        let demand = |reached| Demand {
            accuracy: 0.01,
            demanded: "1 %".to_string(),
            reached,
            reason: (!reached).then(|| "time".to_string()),
            unknown: Vec::new(),
            stated: 0.02,
            worst: Some("yield.load".to_string()),
            choices: Vec::new(),
            work: 0.0,
        };
        results.accuracy = Some(Accuracy {
            demand: Some(demand(true)),
            ..Accuracy::default()
        });
        assert!(ending(&results).is_ok());
        results.accuracy.as_mut().unwrap().demand = Some(demand(false));
        results.inaccurate.push("state `pressed`".to_string());
        let error = ending(&results).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Inaccurate);
        assert_eq!(
            error.message(),
            "state `pressed`\nDemanded accuracy 1 %: NOT reached: time; the stated error is 2.0 % \
             (yield.load)"
        );
        results.incomplete = Some(Incomplete {
            kind: ErrorKind::Stopped,
            why: "stopped".to_string(),
        });
        let error = ending(&results).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Stopped);
        assert!(error.message().ends_with("did: stopped"), "{error}");
    }
}

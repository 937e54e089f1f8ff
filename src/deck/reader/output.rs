//! Reading of requests for results: `*NODE FILE`, `*EL PRINT` and similar keywords.

use super::block::BlockReader;
use super::history::StepReader;
use crate::deck::data::{Account, Group, Named, OutputRequest, Schedule, TimePoints};
use crate::deck::keyword::{Keyword, plain};
use crate::deck::source::Files;
use crate::error::Result;
use crate::scene::{ContactForce, ResultItem, Totals};

/// Largest number of times that one `*TIME POINTS` may give.
const MOST_TIMES: usize = 10_000;

/// Reads requests for results.
#[derive(Default)]
pub(super) struct RequestReader {
    /// Whether the requests of the current step are for histories (`*OUTPUT, HISTORY`).
    pub(super) is_history: bool,
    /// Requests at time points, with the name of the points.
    at_points: Vec<(Keyword, String)>,
}

impl RequestReader {
    /// Reads `*OUTPUT`: the frequency of results and, in Abaqus, whether the following requests are
    /// for the field file or for histories.
    pub(super) fn output(&mut self, block: &mut BlockReader, steps: &mut StepReader) -> Result<()> {
        self.is_history = block.keyword.has("HISTORY");
        self.schedule(block.keyword, steps);
        block.skip()
    }

    /// Reads the schedule of results: the last one in a step applies to all requests.
    fn schedule(&mut self, keyword: &Keyword, steps: &mut StepReader) {
        let every = || keyword.get("FREQUENCY")?.parse().ok().map(Schedule::Every);
        let points = keyword.get("TIMEPOINTS");
        let wanted = points.map(|name| (keyword.clone(), name.to_string()));
        self.at_points.extend(wanted);
        let named = points.map(|name| Schedule::At(name.to_string()));
        if let Some((step, schedule)) = steps.current().zip(named.or_else(every)) {
            step.schedule = Some(schedule);
        }
    }

    /// Adds a remark for each name of time points that the deck does not define.
    pub(super) fn check_time_points(
        &self,
        known: &Named<TimePoints>,
        files: &Files,
        account: &mut Account,
    ) {
        for (keyword, name) in &self.at_points {
            if known.get(name).is_none() {
                let how = format!(
                    "there is no *TIME POINTS, NAME={name}: results are those of the ends of steps"
                );
                account.take(files, keyword.place, &keyword.name, &how);
            }
        }
    }

    /// Reads a request for results. Results that brinell does not write cause a remark.
    pub(super) fn request(
        &mut self,
        block: &mut BlockReader,
        steps: &mut StepReader,
    ) -> Result<()> {
        let keyword = block.keyword;
        let group = match keyword.name.as_bytes() {
            [b'N', ..] => Group::Node,
            [b'E', ..] => Group::Element,
            [b'S', ..] => Group::Section,
            _ => Group::Contact,
        };
        let is_print = keyword.name.ends_with("PRINT");
        let totals = match keyword.get("TOTALS").map(str::to_uppercase).as_deref() {
            Some("YES") => Totals::Yes,
            Some("ONLY") => Totals::Only,
            _ => Totals::No,
        };
        let key = match (group, is_print) {
            (Group::Element, true) => "ELSET",
            (Group::Section, _) => "SURFACE",
            _ => "NSET",
        };
        if group == Group::Section {
            block.require(key)?;
        }
        let mut request = OutputRequest {
            group,
            is_print,
            items: Vec::new(),
            set: keyword.get(key).map(str::to_string),
            contact: (keyword.get("SLAVE").zip(keyword.get("MASTER")))
                .map(|(slave, master)| [slave, master].map(str::to_string)),
            totals,
            // Without `GLOBAL`, files are in global axes, tables in the axes of the nodes.
            is_global: match keyword.get("GLOBAL").map(plain).as_deref() {
                Some("YES") => true,
                Some("NO") => false,
                _ => !is_print,
            },
            place: keyword.place,
        };
        let is_3d = |value: &str| value.eq_ignore_ascii_case("3D");
        if keyword.get("OUTPUT").is_some_and(is_3d) {
            let why = "OUTPUT=3D: elements of the plane are written as they are";
            block.ignore(why);
        }
        result_items(block, &mut request)?;
        self.schedule(block.keyword, steps);
        match steps.current() {
            _ if self.is_history && keyword.name.ends_with("OUTPUT") => {
                let why = "histories: tables of whole sets are written (--dat)";
                block.ignore(why);
            }
            None => block.ignore("it stands in no *STEP"),
            Some(step) => step.outputs.push(request),
        }
        Ok(())
    }
}

/// Reads times at which results are requested; with `GENERATE` as first time, last time and
/// step.
pub(super) fn time_points(block: &mut BlockReader, all: &mut Named<TimePoints>) -> Result<()> {
    let keyword = block.keyword;
    let name = block.require("NAME")?.to_string();
    let is_total = keyword.get("TIME").is_some_and(|t| plain(t) == "TOTALTIME");
    let mut times = Vec::new();
    while let Some((_, mut row)) = block.row()? {
        let mut values = Vec::new();
        while !row.is_at_end() {
            values.push(row.number("the time")?);
        }
        match values[..] {
            [from, to, by] if keyword.has("GENERATE") && by > 0.0 => {
                let most = MOST_TIMES as f64;
                let n = ((to - from) / by + 1e-9).floor().clamp(-1.0, most);
                times.extend((0..=n as i64).map(|k| from + by * k as f64));
            }
            _ => times.extend(values),
        }
        if times.len() > MOST_TIMES {
            let message = format!("more than {MOST_TIMES} times; give fewer");
            return Err(row.place.error(message));
        }
    }
    times.sort_by(f64::total_cmp);
    *all.entry(&name) = TimePoints { times, is_total };
    Ok(())
}

fn result_items(block: &mut BlockReader, request: &mut OutputRequest) -> Result<()> {
    let (mut others, mut has_jump) = (Vec::new(), true);
    while let Some((_, mut row)) = block.row()? {
        while !row.is_at_end() {
            let word = String::from_utf8_lossy(row.word()).to_uppercase();
            match (word.as_str(), item(&word)) {
                ("", _) => {}
                ("NOE", _) => has_jump = false,
                (_, Some(item)) => request.items.push(item),
                _ => others.push(word),
            }
        }
    }
    // The error of the stress is written together with the stress.
    if has_jump && !request.is_print && request.items.contains(&ResultItem::Stress) {
        request.items.push(ResultItem::StressJump);
    }
    if !others.is_empty() {
        let why = format!(
            "{}: not among the results that are written",
            others.join(", ")
        );
        block.ignore(&why);
    }
    Ok(())
}

/// The result that CalculiX or Abaqus denotes by this name.
fn item(word: &str) -> Option<ResultItem> {
    Some(match word {
        "U" => ResultItem::Displacement,
        "RF" => ResultItem::Force,
        "S" => ResultItem::Stress,
        "E" => ResultItem::TotalStrain,
        "PEEQ" => ResultItem::PlasticStrain,
        "CDIS" | "CSTR" | "CDISP" | "CSTRESS" => ResultItem::Contact,
        "ZZS" => ResultItem::RecoveredStress,
        "ERR" => ResultItem::StressJump,
        "CF" => ResultItem::ContactForce(ContactForce::Total),
        "CFN" => ResultItem::ContactForce(ContactForce::Normal),
        "CFS" => ResultItem::ContactForce(ContactForce::Shear),
        "EVOL" => ResultItem::Volume,
        "SOF" | "SOM" | "SOAREA" => ResultItem::Section,
        _ => return None,
    })
}

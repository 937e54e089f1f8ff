//! Reading of requests for results: `*NODE FILE`, `*EL PRINT` and similar keywords.

use super::{Reader, fields};
use crate::deck::data::{Group, OutputRequest, Schedule, TimePoints};
use crate::deck::keyword::{Keyword, plain};
use crate::error::Result;
use crate::scene::{ContactForce, ResultItem, Totals};

/// Largest number of times of a keyword.
const MOST_TIMES: usize = 10_000;

impl Reader<'_> {
    /// Reads `*OUTPUT`: the frequency of results and, in Abaqus, whether the following requests are
    /// for the field file or for histories.
    pub(super) fn output(&mut self, keyword: &Keyword) -> Result<()> {
        self.is_history = keyword.has("HISTORY");
        self.schedule(keyword);
        self.skip()
    }

    /// Reads the schedule of results: the last one in a step holds for all requests.
    fn schedule(&mut self, keyword: &Keyword) {
        let every = || keyword.get("FREQUENCY")?.parse().ok().map(Schedule::Every);
        let points = keyword.get("TIMEPOINTS");
        let wanted = points.map(|name| (keyword.clone(), name.to_string()));
        self.time_points_wanted.extend(wanted);
        let named = points.map(|name| Schedule::At(name.to_string()));
        if let Some((step, schedule)) = self.current_step().zip(named.or_else(every)) {
            self.deck.program.steps[step].schedule = Some(schedule);
        }
    }

    /// Adds a remark for each name of time points that the deck does not define.
    pub(super) fn check_time_points(&mut self) {
        for (keyword, name) in std::mem::take(&mut self.time_points_wanted) {
            if self.deck.program.time_points.get(&name).is_none() {
                let how = format!(
                    "there is no *TIME POINTS, NAME={name}: results are those of the ends of steps"
                );
                self.take(&keyword, keyword.place, &how);
            }
        }
    }

    /// Reads times at which results are requested; with `GENERATE` as first time, last time and
    /// step.
    pub(super) fn time_points(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        let name = keyword.require(files, "NAME")?.to_string();
        let is_total = keyword.get("TIME").is_some_and(|t| plain(t) == "TOTALTIME");
        let mut times = Vec::new();
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
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
        *self.deck.program.time_points.entry(&name) = TimePoints { times, is_total };
        Ok(())
    }

    /// Reads a request for results. Results that brinell does not write cause a remark.
    pub(super) fn request(&mut self, keyword: &Keyword) -> Result<()> {
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
            keyword.require(&self.source.files, key)?;
        }
        let mut request = OutputRequest {
            group,
            is_print,
            items: Vec::new(),
            set: keyword.get(key).map(str::to_string),
            contact: (keyword.get("SLAVE").zip(keyword.get("MASTER")))
                .map(|(slave, master)| [slave, master].map(str::to_string)),
            totals,
            // Files are in global axes unless they say otherwise, tables in those of the nodes.
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
            self.ignore(keyword, keyword.place, why);
        }
        self.result_items(keyword, &mut request)?;
        self.schedule(keyword);
        match self.current_step() {
            _ if self.is_history && !is_print => {
                let why = "histories: tables of whole sets are written (--dat)";
                self.ignore(keyword, keyword.place, why);
            }
            None => self.ignore(keyword, keyword.place, "it stands in no *STEP"),
            Some(step) => self.deck.program.steps[step].outputs.push(request),
        }
        Ok(())
    }

    fn result_items(&mut self, keyword: &Keyword, request: &mut OutputRequest) -> Result<()> {
        let (mut others, mut has_jump) = (Vec::new(), true);
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
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
            self.ignore(keyword, keyword.place, &why);
        }
        Ok(())
    }
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

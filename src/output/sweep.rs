//! A sweep: the same scene with other values of some keys, and a result directory for each point.
//!
//! ```text
//! DIR/sweep.json        points with their values, folders and how they ended
//!     sweep-1-of-8.json the same of a share of the points
//!     sweep.csv         a row per point: values, all figures of first yield and of the states
//!     sweep_PATH.svg    charts of the main figures
//!     NAME/             the result directory of a point
//! ```

use super::labels::{Labels, in_line, labelled};
use super::{atomic, report, rows};
use crate::error::{Error, Result};
use crate::files;
use crate::results::{Effect, LOADS_FOUND, QUANTITIES, Quantity, Results, State, value};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use std::path::Path;

/// The file that records the progress of a sweep.
const RECORD_FILE: &str = "sweep.json";
/// Beginning of the file name of a share's record.
const SHARE_PREFIX: &str = "sweep-";
const TABLE_FILE: &str = "sweep.csv";
/// Longest name of a point's folder.
const NAME_LENGTH: usize = 80;

/// The points of a sweep.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Sweep {
    /// Version of brinell.
    brinell: String,
    /// The keys that vary.
    pub keys: Vec<String>,
    /// The points, in the order of their values.
    pub points: Vec<SweepPoint>,
    /// File in which the sweep is recorded: a share of the points has its own file.
    #[serde(skip)]
    file: String,
}

/// A point of the sweep and how its run ended.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct SweepPoint {
    /// A value for each key, as it was given.
    pub values: Vec<String>,
    /// Folder of the point, relative to the folder of the sweep.
    pub folder: String,
    /// Text that represents everything that the results of the point depend on.
    pub identity: String,
    /// Largest load over yield stress. The point with the largest value yields furthest and is run
    /// first, so that its factor serves the others.
    #[serde(skip)]
    pub demand: f64,
    /// Exit code of the point's run; `None` if it has not ended.
    pub exit_code: Option<i32>,
    /// The reason, if the run did not end well.
    pub message: String,
}

impl SweepPoint {
    /// Whether another run of this point would end in the same way: complete, a limit load, an
    /// inaccurate result, or the end of the contact candidates.
    pub(crate) fn is_finished(&self) -> bool {
        matches!(self.exit_code, Some(0 | 6 | 7 | 8))
    }
}

impl Sweep {
    /// Creates a sweep of these points: all points, or the share `i` of `n` if `shard` is `[i, n]`.
    /// Points that an earlier sweep in `dir` has finished, in whatever shares, are taken over.
    ///
    /// # Errors
    /// `Input` if `dir` holds something else, `Io` if it cannot be read.
    pub(crate) fn new(
        dir: &Path,
        keys: Vec<String>,
        points: Vec<SweepPoint>,
        shard: Option<[usize; 2]>,
    ) -> Result<Self> {
        let mut sweep = Sweep {
            brinell: env!("CARGO_PKG_VERSION").to_string(),
            keys,
            points,
            file: match shard {
                None => RECORD_FILE.to_string(),
                Some([i, n]) => format!("{SHARE_PREFIX}{i}-of-{n}.json"),
            },
        };
        let before = Sweep::read(dir)?;
        for point in &mut sweep.points {
            let same =
                |old: &&SweepPoint| old.identity == point.identity && old.folder == point.folder;
            let ended = before.iter().filter(same).filter(|old| old.is_finished());
            let has_results = |old: &&SweepPoint| {
                let folder = dir.join(&old.folder);
                folder.join(super::names::SUMMARY_FILE).exists() && super::stale(&folder).is_none()
            };
            if let Some(old) = ended.into_iter().find(has_results) {
                let demand = point.demand;
                *point = SweepPoint {
                    demand,
                    ..old.clone()
                };
            }
        }
        Ok(sweep)
    }

    /// Reads the points of all records in a directory; none if there is nothing yet.
    fn read(dir: &Path) -> Result<Vec<SweepPoint>> {
        let entries = std::fs::read_dir(dir).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        // A name that begins with a dot belongs to a file that is still being written.
        let names: Vec<String> = names.filter(|name| !name.starts_with('.')).collect();
        let is_record = |name: &&String| {
            let is_share = name.starts_with(SHARE_PREFIX) && name.ends_with(".json");
            *name == RECORD_FILE || is_share
        };
        let records: Vec<&String> = names.iter().filter(is_record).collect();
        if records.is_empty() && (!names.is_empty() || dir.is_file()) {
            return Err(Error::input(format!(
                "{} exists and is no sweep of brinell: choose another --out",
                dir.display()
            )));
        }
        let mut points = Vec::new();
        for name in records {
            let path = dir.join(name);
            let text = files::read_text("read the sweep", &path, None)?;
            let sweep: Sweep = serde_json::from_str(&text).map_err(|cause| {
                let what = format!(
                    "{}: no record of a sweep; choose another --out",
                    path.display()
                );
                Error::input(what).because(cause)
            })?;
            points.extend(sweep.points);
        }
        Ok(points)
    }

    /// Writes the points with their state so far, so that an interrupted sweep can go on.
    ///
    /// # Errors
    /// `Io` naming the file.
    pub(crate) fn record(&self, dir: &Path) -> Result<()> {
        let text = serde_json::to_string_pretty(self)
            .map_err(|cause| Error::internal("a sweep is not plain data").because(cause))?;
        atomic::replace(&dir.join(&self.file), (text + "\n").as_bytes())
    }

    /// Reads the results of all points that have results.
    ///
    /// # Errors
    /// Errors of a summary that cannot be read.
    pub(crate) fn outcome(&self, dir: &Path) -> Result<SweepOutcome<'_>> {
        let mut labels = Labels::default();
        let results = self.points.iter().map(|point| {
            let path = dir.join(&point.folder).join(super::names::SUMMARY_FILE);
            let has_results = point.exit_code.is_some() && path.exists();
            if !has_results || super::stale(&dir.join(&point.folder)).is_some() {
                return Ok(None);
            }
            let summary = rows::summary(&path)?;
            labels = summary.labels();
            Ok(Some(summary.results(&[])))
        });
        let results = results.collect::<Result<Vec<_>>>()?;
        Ok(SweepOutcome {
            sweep: self,
            results,
            labels,
        })
    }
}

/// Returns a name for the folder of a point, made of the last parts of its keys and of its values.
pub(crate) fn folder(keys: &[String], values: &[String]) -> String {
    let part = |(key, value): (&String, &String)| {
        let last = key.rsplit('.').next().unwrap_or(key);
        format!("{last}_{value}")
    };
    let name: Vec<String> = keys.iter().zip(values).map(part).collect();
    let safe = |c: char| match c {
        'a'..='z' | 'A'..='Z' | '0'..='9' | '.' | '-' | '_' | '+' => c,
        _ => '_',
    };
    name.join("-").chars().take(NAME_LENGTH).map(safe).collect()
}

/// The outcome of a sweep.
pub(crate) struct SweepOutcome<'s> {
    sweep: &'s Sweep,
    results: Vec<Option<Results>>,
    labels: Labels,
}

impl SweepOutcome<'_> {
    /// Returns the paths of all figures that any point has, `yield.KEY` or `states.NAME.KEY`.
    fn paths(&self) -> Vec<String> {
        let mut paths: Vec<String> = Vec::new();
        for results in self.results.iter().flatten() {
            let of_yield = QUANTITIES.iter().filter(|q| q.at_yield.is_some());
            let at_yield = of_yield.map(|q| format!("yield.{}", q.key));
            let in_states = results.states.iter().flat_map(|state| {
                let of_state = |q: &Quantity| format!("states.{}.{}", state.name, q.key);
                QUANTITIES.iter().map(of_state)
            });
            for path in at_yield.chain(in_states) {
                if !paths.contains(&path) {
                    paths.push(path);
                }
            }
        }
        paths
    }

    /// Returns the figures that tables and charts show if none are asked for: the loads found for
    /// targets that are given by a figure; the yield load; pressure, half width, approach and
    /// plastic strain in the state with the largest load; the residual depth in the last state.
    /// Figures that are 0 in all points are left out.
    pub(crate) fn main_paths(&self) -> Vec<String> {
        let by_load = |a: &&State, b: &&State| a.load.total_cmp(&b.load);
        let with_states = |r: &&Results| !r.states.is_empty();
        let Some(results) = self.results.iter().flatten().find(with_states) else {
            let any = self.results.iter().flatten().next();
            return any.map_or(Vec::new(), |_| vec!["yield.load".to_string()]);
        };
        let largest = results
            .states
            .iter()
            .max_by(by_load)
            .map_or("", |s| &s.name);
        let last = results.states.last().map_or("", |s| &s.name);
        let pressed = [
            "max_pressure",
            "half_width",
            "approach",
            "max_equivalent_plastic_strain",
        ];
        let is_found = |e: &Effect| e.on && e.name == LOADS_FOUND;
        let finds_loads = results.effects.iter().any(is_found);
        // A load that is the same in all points is given by the scene.
        let differs = |path: &String| {
            let mut loads = (0..self.results.len()).filter_map(|k| self.figure(k, path));
            let first = loads.next();
            loads.any(|load| Some(load) != first)
        };
        let loads = results.states.iter().filter(|_| finds_loads);
        let loads = loads.map(|state| format!("states.{}.load", state.name));
        let paths = (loads.filter(differs))
            .chain(["yield.load".to_string()])
            .chain(pressed.map(|key| format!("states.{largest}.{key}")))
            .chain([format!("states.{last}.residual_depth")]);
        paths
            .filter(|path| {
                (0..self.results.len()).any(|k| self.figure(k, path).is_some_and(|v| v != 0.0))
            })
            .collect()
    }

    /// Returns a figure of a point.
    pub(crate) fn figure(&self, point: usize, path: &str) -> Option<f64> {
        let found = value(self.results.get(point)?.as_ref()?, path);
        found.filter(|value| value.is_finite())
    }

    /// Returns the number of factorisations in the run of a point (0 if the run took over another
    /// point's factor); `None` if the point has no results.
    pub(crate) fn factorizations(&self, point: usize) -> Option<usize> {
        Some(self.results.get(point)?.as_ref()?.counts.factorizations)
    }

    /// Returns the heading of a figure, in lines, with the unit in the last.
    pub(crate) fn heading(&self, path: &str) -> String {
        let (place, key) = path.rsplit_once('.').unwrap_or(("", path));
        let place = place.strip_prefix("states.").unwrap_or(place);
        let Some(quantity) = Quantity::of(key) else {
            return path.to_string();
        };
        let name = match self.labels.heading(quantity) {
            "" => quantity.key,
            heading => heading,
        };
        let unit = self.labels.unit(quantity.unit);
        let unit = if unit.is_empty() {
            unit
        } else {
            format!("\n[{unit}]")
        };
        format!("{place}\n{name}{unit}")
    }

    /// Returns the whole outcome as one JSON object.
    pub(crate) fn json(&self) -> Value {
        let paths = self.paths();
        let points = self.sweep.points.iter().enumerate().map(|(index, point)| {
            let values: Map<String, Value> = (self.sweep.keys.iter().cloned())
                .zip(point.values.iter().map(|v| json!(v)))
                .collect();
            let figures: Map<String, Value> = paths
                .iter()
                .filter_map(|path| Some((path.clone(), json!(self.figure(index, path)?))))
                .collect();
            json!({
                "values": values, "folder": point.folder, "exit_code": point.exit_code,
                "message": point.message, "factorizations": self.factorizations(index),
                "figures": figures,
            })
        });
        json!({ "keys": self.sweep.keys, "points": points.collect::<Vec<_>>() })
    }

    /// Writes the table and the charts of some figures; returns the names of the files.
    ///
    /// # Errors
    /// `Io` naming the file, `Internal` if a chart cannot be drawn.
    pub(crate) fn write(&self, dir: &Path, shown: &[String]) -> Result<Vec<String>> {
        atomic::replace(&dir.join(TABLE_FILE), &self.table()?)?;
        let mut names = vec![TABLE_FILE.to_string()];
        for path in shown {
            if let Some(svg) = self.chart(path)? {
                let safe = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
                let name: String = path.chars().map(safe).collect();
                let name = format!("sweep_{name}.svg");
                atomic::replace(&dir.join(&name), svg.as_bytes())?;
                names.push(name);
            }
        }
        Ok(names)
    }

    fn table(&self) -> Result<Vec<u8>> {
        let paths = self.paths();
        let mut csv = csv::Writer::from_writer(Vec::new());
        let failed = |cause| Error::internal("a sweep is not plain data").because(cause);
        let keys = self.sweep.keys.iter().map(String::as_str);
        let head = keys.chain(["exit_code", "message", "factorizations"]);
        csv.write_record(head.chain(paths.iter().map(String::as_str)))
            .map_err(failed)?;
        for (index, point) in self.sweep.points.iter().enumerate() {
            let code = point
                .exit_code
                .map_or(String::new(), |code| code.to_string());
            let figures = paths.iter().map(|path| {
                self.figure(index, path)
                    .map_or(String::new(), |v| json!(v).to_string())
            });
            let made = self.factorizations(index);
            let made = made.map_or(String::new(), |made| made.to_string());
            let ended = [code, point.message.replace('\n', " "), made];
            let cells = point.values.iter().cloned().chain(ended).chain(figures);
            csv.write_record(cells).map_err(failed)?;
        }
        csv.into_inner()
            .map_err(|cause| Error::internal("a sweep is not plain data").because(cause))
    }

    /// Draws a figure over the first key, with a curve for each combination of the other keys.
    /// Returns `None` if the values of the first key are not numbers, or if there are fewer than
    /// two.
    fn chart(&self, path: &str) -> Result<Option<String>> {
        let mut curves: Vec<(String, Vec<[f64; 2]>)> = Vec::new();
        for (index, point) in self.sweep.points.iter().enumerate() {
            let Some((first, others)) = point.values.split_first() else {
                return Ok(None);
            };
            let (Ok(x), Some(y)) = (first.trim().parse::<f64>(), self.figure(index, path)) else {
                continue;
            };
            let named = self.sweep.keys.iter().skip(1).zip(others);
            let named = named
                .map(|(key, value)| format!("{} = {value}", key.rsplit('.').next().unwrap_or(key)));
            let label = named.collect::<Vec<_>>().join(", ");
            match curves.iter_mut().find(|(known, _)| *known == label) {
                Some((_, points)) => points.push([x, y]),
                None => curves.push((label, vec![[x, y]])),
            }
        }
        for (_, points) in &mut curves {
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        }
        if curves.iter().all(|(_, points)| points.len() < 2) {
            return Ok(None);
        }
        let key = self.sweep.keys.first().map_or("", String::as_str);
        let (place, name) = path.rsplit_once('.').unwrap_or(("", path));
        let place = place.strip_prefix("states.").unwrap_or(place);
        let label = match Quantity::of(name) {
            Some(quantity) if !quantity.heading.is_empty() => labelled(
                &format!("{}, {place}", in_line(self.labels.heading(quantity))),
                &self.labels.unit(quantity.unit),
            ),
            _ => path.to_string(),
        };
        report::line_chart([key.to_string(), label], curves).map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_have_names_that_say_the_point() {
        let texts = |list: &[&str]| list.iter().map(|s| s.to_string()).collect::<Vec<_>>();
        let keys = texts(&[
            "materials.steel.yield_stress",
            "load.press.plane_force.total",
        ]);
        let name = folder(&keys, &texts(&["400", "-1e3"]));
        assert_eq!(name, "yield_stress_400-total_-1e3");
        assert_eq!(
            folder(&keys[..1], &texts(&["../x y"])),
            "yield_stress_.._x_y"
        );
    }

    #[test]
    fn only_ends_that_would_come_again_are_finished() {
        let ended = |exit_code| SweepPoint {
            exit_code,
            ..SweepPoint::default()
        };
        assert!(
            [0, 6, 7, 8]
                .iter()
                .all(|&code| ended(Some(code)).is_finished())
        );
        assert!(
            [2, 3, 5, 70, 130]
                .iter()
                .all(|&code| !ended(Some(code)).is_finished())
        );
        assert!(!ended(None).is_finished());
    }
}

//! The points of a sweep: combinations of values, values taken together, rows of a table.

use crate::error::{Error, Result};
use crate::files;
use std::path::Path;
use std::str::FromStr;

/// A key and its values.
#[derive(Debug, Clone)]
pub(in crate::cli) struct Varied {
    pub(super) key: String,
    pub(super) values: Vec<String>,
}

/// Reads `KEY=A,B,...`; commas within brackets, braces and quotes do not separate values.
pub(super) fn varied(text: &str) -> std::result::Result<Varied, String> {
    let wanted = "give KEY=A,B,... such as materials.steel.yield_stress=400,500";
    let (key, list) = text.split_once('=').ok_or(wanted)?;
    let (mut depth, mut is_quoted) = (0i32, false);
    let mut values = vec![String::new()];
    for c in list.chars() {
        match c {
            '"' => is_quoted = !is_quoted,
            '[' | '{' if !is_quoted => depth += 1,
            ']' | '}' if !is_quoted => depth -= 1,
            _ => {}
        }
        let last = values.len() - 1;
        match c {
            ',' if depth == 0 && !is_quoted => values.push(String::new()),
            c => values[last].push(c),
        }
    }
    let values: Vec<String> = values
        .iter()
        .map(|value| value.trim().to_string())
        .collect();
    let is_twice = (1..values.len()).any(|k| values[..k].contains(&values[k]));
    match key.trim().is_empty() || values.iter().any(String::is_empty) {
        true => Err(wanted.to_string()),
        false if is_twice => Err("a value is given twice".to_string()),
        false => Ok(Varied {
            key: key.trim().to_string(),
            values,
        }),
    }
}

/// Returns all combinations of the values, with the last key varying fastest.
fn combinations(vary: &[Varied]) -> Vec<Vec<String>> {
    vary.iter().fold(vec![Vec::new()], |points, varied| {
        let with = |point: &Vec<String>, value: &String| {
            let mut point = point.clone();
            point.push(value.clone());
            point
        };
        let of_point = |point: Vec<String>| -> Vec<Vec<String>> {
            varied
                .values
                .iter()
                .map(|value| with(&point, value))
                .collect()
        };
        points.into_iter().flat_map(of_point).collect()
    })
}

/// Takes the values of all keys together: the first of each, the second of each, and so on.
///
/// # Errors
/// `Input` if one key has more values than another.
fn together(vary: &[Varied]) -> Result<Vec<Vec<String>>> {
    let n = vary.first().map_or(0, |varied| varied.values.len());
    if let Some(other) = vary.iter().find(|varied| varied.values.len() != n) {
        return Err(Error::input(format!(
            "--zip takes the values of all keys together, and {} has {} of them where {} has {n}",
            other.key,
            other.values.len(),
            vary[0].key
        )));
    }
    let point = |k: usize| vary.iter().map(|varied| varied.values[k].clone()).collect();
    Ok((0..n).map(point).collect())
}

/// Keys, and for each point one value per key.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Points {
    pub keys: Vec<String>,
    pub values: Vec<Vec<String>>,
}

impl Points {
    /// Combines each row of a table with all values that vary; without a table returns only the
    /// values that vary.
    ///
    /// # Errors
    /// `Input` for the table, for values that cannot be taken together, and for a key that is given
    /// twice; `Io` if the table cannot be read.
    pub fn new(table: Option<&Path>, vary: &[Varied], zip: bool) -> Result<Self> {
        let varied = match zip {
            true => together(vary)?,
            false => combinations(vary),
        };
        let rows = table.map(rows).transpose()?;
        let of_table = rows.unwrap_or_else(|| Points {
            keys: Vec::new(),
            values: vec![Vec::new()],
        });
        let mut keys = of_table.keys;
        keys.extend(vary.iter().map(|varied| varied.key.clone()));
        for (k, key) in keys.iter().enumerate() {
            if keys[..k].contains(key) {
                return Err(Error::input(format!("{key} is varied twice")));
            }
        }
        let with_all = |row: &Vec<String>| -> Vec<Vec<String>> {
            let more = varied.iter().map(|more| [&row[..], &more[..]].concat());
            more.collect()
        };
        Ok(Points {
            keys,
            values: of_table.values.iter().flat_map(with_all).collect(),
        })
    }
}

/// Reads the rows of a CSV file whose first line has the keys.
fn rows(path: &Path) -> Result<Points> {
    let text = files::read_text("read the points", path, Some(files::LARGEST_SCENE))?;
    read_rows(&text).map_err(|error| error.within(path.display()))
}

/// Returns the line of a record; the reported position may be that of empty lines and comments
/// before it.
fn line_of(text: &str, position: &csv::Position) -> u64 {
    let from = usize::try_from(position.byte()).unwrap_or(usize::MAX);
    let rest = text.get(from..).unwrap_or_default().lines();
    let passed = rest.take_while(|line| line.trim().is_empty() || line.starts_with('#'));
    position.line() + passed.count() as u64
}

fn read_rows(text: &str) -> Result<Points> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut lines: Vec<(u64, Vec<String>)> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|cause| Error::input("is no table").because(cause))?;
        let line = record.position().map_or(0, |at| line_of(text, at));
        lines.push((line, record.iter().map(str::to_string).collect()));
    }
    let Some(((first, keys), rows)) = lines.split_first() else {
        return Err(Error::input(
            "is empty; its first line has keys of the scene",
        ));
    };
    if keys.iter().any(String::is_empty) {
        return Err(Error::input(format!(
            "line {first}: a column has no key of the scene at its head"
        )));
    }
    for (k, (line, row)) in rows.iter().enumerate() {
        if row.len() != keys.len() {
            return Err(Error::input(format!(
                "line {line}: {} values for {} keys",
                row.len(),
                keys.len()
            )));
        }
        if let Some(column) = row.iter().position(String::is_empty) {
            return Err(Error::input(format!(
                "line {line}: no value of {}",
                keys[column]
            )));
        }
        if let Some((before, _)) = rows[..k].iter().find(|(_, other)| other == row) {
            return Err(Error::input(format!("line {line} is line {before} again")));
        }
    }
    if rows.is_empty() {
        return Err(Error::input("has keys and no line of values"));
    }
    Ok(Points {
        keys: keys.clone(),
        values: rows.iter().map(|(_, row)| row.clone()).collect(),
    })
}

/// A share of the points: every N-th point, from the I-th on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) struct Shard {
    index: usize,
    of: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let numbers = text.split_once('/');
        let numbers = numbers.and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((index, of)) if (1..=of).contains(&index) => Ok(Shard { index, of }),
            Some((index, of)) => Err(format!(
                "share {index} of {of} is none: shares are numbered from 1 on, as 1/{}",
                of.max(1)
            )),
            None => Err("give I/N, the I-th of N shares, as 1/8".to_string()),
        }
    }
}

impl Shard {
    /// Whether a point belongs to this share.
    pub fn has(self, point: usize) -> bool {
        point % self.of == self.index - 1
    }

    /// Returns the index of the share and the number of shares.
    pub fn numbers(self) -> [usize; 2] {
        [self.index, self.of]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(list: &[&str]) -> Vec<String> {
        list.iter().map(|s| s.to_string()).collect()
    }

    #[test]
    fn commas_within_brackets_and_quotes_separate_nothing() {
        let values = |text: &str| varied(text).map(|v| (v.key, v.values));
        assert_eq!(
            values("a.b=1, 2,3"),
            Ok(("a.b".to_string(), texts(&["1", "2", "3"])))
        );
        let force = values("load.0.force=[0.0, -1.0],[0.0, -2.0]").unwrap().1;
        assert_eq!(force, ["[0.0, -1.0]", "[0.0, -2.0]"]);
        assert_eq!(values("title=\"a,b\",c").unwrap().1, ["\"a,b\"", "c"]);
        for wrong in ["", "a", "=1,2", "a=", "a=1,,2", "a=1,1"] {
            assert!(values(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn all_combinations_are_run() {
        let vary = ["a=1,2", "b=x,y,z"].map(|text| varied(text).unwrap());
        let points: Vec<String> = combinations(&vary).iter().map(|p| p.concat()).collect();
        assert_eq!(points, ["1x", "1y", "1z", "2x", "2y", "2z"]);
    }

    #[test]
    fn values_taken_together_are_as_many() {
        let of = |list: [&str; 2]| {
            let vary = list.map(|text| varied(text).unwrap());
            Points::new(None, &vary, true)
        };
        let points = of(["a=1,2,3", "b=x,y,z"]).unwrap();
        assert_eq!(points.keys, ["a", "b"]);
        let joined: Vec<String> = points.values.iter().map(|p| p.concat()).collect();
        assert_eq!(joined, ["1x", "2y", "3z"]);
        let error = of(["a=1,2,3", "b=x,y"]).unwrap_err();
        assert!(
            error.message().contains("b has 2 of them where a has 3"),
            "{error}"
        );
        let error = of(["a=1,2", "a=3,4"]).unwrap_err();
        assert!(error.message().contains("a is varied twice"), "{error}");
    }

    #[test]
    fn rows_of_a_table_are_points() {
        let points = read_rows("# measured\na.b, c\n1,\"[1.0, 2.0]\"\n2,3\n").unwrap();
        assert_eq!(points.keys, ["a.b", "c"]);
        assert_eq!(
            points.values,
            [texts(&["1", "[1.0, 2.0]"]), texts(&["2", "3"])]
        );
        for (text, part) in [
            ("", "is empty"),
            ("a,b\n", "no line of values"),
            ("a,\n1,2\n", "line 1: a column has no key"),
            ("a,b\n1\n", "line 2: 1 values for 2 keys"),
            ("a,b\n1,2\n\n3,\n", "line 4: no value of b"),
            ("a\n1\n# two\n2\n1\n", "line 5 is line 2 again"),
        ] {
            let error = read_rows(text).unwrap_err();
            assert!(error.message().contains(part), "{text:?}: {error}");
        }
    }

    #[test]
    fn shares_are_all_points_once() {
        let shards = [1, 2, 3].map(|i| format!("{i}/3").parse::<Shard>().unwrap());
        for point in 0..10 {
            assert_eq!(shards.iter().filter(|shard| shard.has(point)).count(), 1);
        }
        for wrong in ["0/3", "4/3", "1/0", "3", "a/b", "-1/2"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }
}

//! Results of CalculiX read from its `.frd` file. Plane models come out as a layer of solid
//! elements: nodes are told by their place. Those of solid models keep their numbers.

use std::collections::BTreeMap;

/// Values of an increment.
#[derive(Debug, Clone, Default)]
pub struct Increment {
    /// Total time: 1 at the end of the first leg, 2 at the end of the second.
    pub time: f64,
    /// Displacements by number.
    pub displacement: BTreeMap<u64, [f64; 3]>,
    /// Contact pressures by number: nodes of the slave surface.
    pub pressure: BTreeMap<u64, f64>,
}

/// A file.
#[derive(Debug, Clone, Default)]
pub struct Frd {
    /// Places of the nodes.
    pub points: BTreeMap<u64, [f64; 3]>,
    /// Increments, in order.
    pub increments: Vec<Increment>,
}

impl Frd {
    /// Reads the text of a file; lines that are not understood are left out.
    pub fn parse(text: &str) -> Frd {
        let mut frd = Frd::default();
        let mut block = String::new();
        for line in text.lines() {
            if line.starts_with("    2C") {
                block = "points".into();
            } else if line.starts_with("  100C") {
                let time = line
                    .get(12..24)
                    .and_then(|t| t.trim().parse().ok())
                    .unwrap_or(f64::NAN);
                // Every quantity has such a line of its own.
                if frd.increments.last().is_none_or(|i| i.time != time) {
                    frd.increments.push(Increment {
                        time,
                        ..Increment::default()
                    });
                }
                block.clear();
            } else if let Some(rest) = line.strip_prefix(" -4") {
                block = rest
                    .split_whitespace()
                    .next()
                    .unwrap_or_default()
                    .to_string();
            } else if line.starts_with(" -3") {
                block.clear();
            } else if line.starts_with(" -1") {
                frd.row(&block, line);
            }
        }
        frd
    }

    fn row(&mut self, block: &str, line: &str) {
        let Some(node) = line.get(3..13).and_then(|n| n.trim().parse().ok()) else {
            return;
        };
        let value = |k: usize| -> f64 {
            let at = 13 + 12 * k;
            line.get(at..at + 12)
                .and_then(|v| v.trim().parse().ok())
                .unwrap_or(f64::NAN)
        };
        match (block, self.increments.last_mut()) {
            ("points", _) => {
                self.points.insert(node, [0, 1, 2].map(value));
            }
            ("DISP", Some(increment)) => {
                increment.displacement.insert(node, [0, 1, 2].map(value));
            }
            // Opening, two slips, pressure.
            ("CONTACT", Some(increment)) => {
                increment.pressure.insert(node, value(3));
            }
            _ => {}
        }
    }

    /// The increment at a total time.
    pub fn at(&self, time: f64) -> Option<&Increment> {
        self.increments
            .iter()
            .find(|i| (i.time - time).abs() < 1e-6)
    }

    /// Pressures along x, one for each place.
    pub fn pressures(&self, increment: &Increment) -> Vec<[f64; 2]> {
        let mut out: Vec<[f64; 2]> = increment
            .pressure
            .iter()
            .filter_map(|(node, p)| Some([self.points.get(node)?[0], *p]))
            .collect();
        out.sort_by(|a, b| a[0].total_cmp(&b[0]).then(b[1].total_cmp(&a[1])));
        out.dedup_by(|a, b| (a[0] - b[0]).abs() < 1e-9);
        out
    }
}

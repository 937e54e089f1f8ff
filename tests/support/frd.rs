//! Files of results in the format `.frd`, read by their columns.

use std::collections::BTreeMap;

/// A block of values at nodes.
#[derive(Debug, Clone)]
pub struct Block {
    /// `DISP`, `STRESS`, ...
    pub name: String,
    pub time: f64,
    pub step: usize,
    pub increment: usize,
    pub values: BTreeMap<u64, Vec<f64>>,
}

/// What stands in a file.
#[derive(Debug, Clone, Default)]
pub struct Frd {
    pub nodes: BTreeMap<u64, Vec<f64>>,
    /// Type and nodes by number.
    pub elements: BTreeMap<u64, (usize, Vec<u64>)>,
    pub blocks: Vec<Block>,
    /// All lines, with crosses for values, coordinates, and what tells date and program.
    pub lines: Vec<String>,
}

fn number<T: std::str::FromStr>(text: &str) -> T {
    let trimmed = text.trim();
    let number = trimmed.parse().ok();
    number.unwrap_or_else(|| panic!("`{trimmed}` is no number"))
}

/// The columns behind the first `from` of a line, each so wide; none may be cut off.
fn columns<T: std::str::FromStr>(line: &str, from: usize, width: usize) -> Vec<T> {
    let rest = line.as_bytes()[from..].chunks(width);
    rest.map(|column| {
        assert_eq!(column.len(), width, "{line}");
        number(std::str::from_utf8(column).unwrap())
    })
    .collect()
}

fn crossed(line: &str, from: usize) -> String {
    format!("{}{}", &line[..from], "x".repeat(line.len() - from))
}

impl Frd {
    /// Reads the text of a file.
    pub fn parse(text: &str) -> Frd {
        const CHANGING: [&str; 5] = ["DATE", "TIME", "PGM", "VERSION", "COMPILETIME"];
        let mut out = Frd::default();
        let (mut section, mut step, mut last) = ("", (0, 0), 0);
        for line in text.lines() {
            let mut shown = line.to_string();
            match &line[..line.len().min(6)] {
                "    1U" => {
                    let key = line[6..].split(' ').next().unwrap();
                    if CHANGING.contains(&key) {
                        shown = crossed(line, 24).trim_end_matches('x').to_string();
                    }
                }
                "    1P" => {
                    // Number of the block, increment, step.
                    step = (number(&line[48..60]), number(&line[36..48]));
                }
                "    2C" => section = "nodes",
                "    3C" => section = "elements",
                "  100C" => {
                    out.blocks.push(Block {
                        name: String::new(),
                        time: number(&line[12..24]),
                        step: step.0,
                        increment: step.1,
                        values: BTreeMap::new(),
                    });
                    section = "values";
                }
                _ => {
                    let mark = &line[..3.min(line.len())];
                    match (section, mark) {
                        ("nodes", " -1") => {
                            out.nodes
                                .insert(number(&line[3..13]), columns(line, 13, 12));
                            shown = crossed(line, 13);
                        }
                        ("elements", " -1") => {
                            last = number(&line[3..13]);
                            let of = (number(&line[13..18]), Vec::new());
                            out.elements.insert(last, of);
                        }
                        ("elements", " -2") => {
                            let nodes = &mut out.elements.get_mut(&last).unwrap().1;
                            nodes.extend(columns::<u64>(line, 3, 10));
                        }
                        ("values", " -4") => {
                            let name = line[5..13].trim().to_string();
                            out.blocks.last_mut().unwrap().name = name;
                        }
                        ("values", " -1") => {
                            let values = &mut out.blocks.last_mut().unwrap().values;
                            values.insert(number(&line[3..13]), columns(line, 13, 12));
                            shown = crossed(line, 13);
                        }
                        _ => {}
                    }
                }
            }
            out.lines.push(shown);
        }
        out
    }

    /// The last block of a name.
    pub fn last(&self, name: &str) -> &Block {
        let mut named = self.blocks.iter().rev().filter(|block| block.name == name);
        named.next().unwrap_or_else(|| panic!("no block {name}"))
    }
}

/// The largest value of the blocks of a name, by size.
pub fn largest(frd: &Frd, name: &str) -> f64 {
    let blocks = frd.blocks.iter().filter(|block| block.name == name);
    let values = blocks.flat_map(|block| block.values.values().flatten());
    values.fold(0.0, |m: f64, v| m.max(v.abs()))
}

/// The largest difference of the values at the nodes.
pub fn difference(a: &BTreeMap<u64, Vec<f64>>, b: &BTreeMap<u64, Vec<f64>>) -> f64 {
    assert!(a.keys().eq(b.keys()), "other nodes");
    let pairs = a.values().flatten().zip(b.values().flatten());
    pairs.fold(0.0f64, |m, (a, b)| m.max((a - b).abs()))
}

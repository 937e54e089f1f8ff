//! The table of the paper's equations in `data/guide/theory.md`.

use super::root;
use std::collections::BTreeMap;

/// A row: its equations, the file below `src` and the function; none of both where the equation is
/// not needed, with the reason.
struct Row {
    equations: Vec<String>,
    place: Option<(String, String)>,
    text: String,
}

fn rows(page: &str) -> Vec<Row> {
    let from = page.split("## Equations of the paper").nth(1);
    let section = from.expect("the page has the section");
    let section = section.split("\n## ").next().unwrap();
    let table = section
        .lines()
        .filter(|line| line.starts_with("| "))
        .skip(1);
    let row = |line: &str| {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [equations, text, file, function] = cells[..] else {
            panic!("a row of four cells: {line}");
        };
        let quoted = |cell: &str| cell.trim_matches('`').to_string();
        Row {
            equations: equations.split(", ").map(String::from).collect(),
            place: (!file.is_empty()).then(|| (quoted(file), quoted(function))),
            text: text.to_string(),
        }
    };
    table.map(row).collect()
}

/// Every equation of chapters 3 and 4 has a function, or the reason why there is none.
#[test]
fn every_equation_of_the_paper_has_its_function() {
    let page = std::fs::read_to_string(root().join("data/guide/theory.md")).unwrap();
    let mut times: BTreeMap<String, usize> = BTreeMap::new();
    for row in rows(&page) {
        for equation in &row.equations {
            *times.entry(equation.clone()).or_default() += 1;
        }
        let Some((file, function)) = row.place else {
            let reason = row.text.split("not needed: ").nth(1).unwrap_or("");
            assert!(reason.len() > 20, "{:?} has no reason", row.equations);
            continue;
        };
        let code = std::fs::read_to_string(root().join("src").join(&file));
        let code = code.unwrap_or_else(|error| panic!("{:?}: src/{file}: {error}", row.equations));
        let is_defined = ["(", "<"]
            .iter()
            .any(|end| code.contains(&format!("fn {function}{end}")));
        assert!(
            is_defined,
            "{:?}: src/{file} has no `fn {function}`",
            row.equations
        );
    }
    let chapters = [(3, 14), (4, 23)].into_iter();
    for equation in chapters.flat_map(|(c, n)| (1..=n).map(move |i| format!("{c}.{i}"))) {
        assert!(
            times.remove(&equation).is_some(),
            "{equation} is not in the table"
        );
    }
    assert!(times.is_empty(), "not in the paper: {times:?}");
}

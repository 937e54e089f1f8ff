//! Tables of text: aligned columns, no wider than a page, long text wrapped.

use crate::text::shown_in_line;

/// No line of a report is longer.
pub(super) const WIDTH: usize = 110;
const INDENT: usize = 2;
const GAP: usize = 2;
/// A text column is not squeezed below this.
const LEAST: usize = 10;

/// How a column is set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Column {
    /// Flush left; wrapped where the page is too narrow.
    Text,
    /// Flush right.
    Number,
}

/// A table with a heading per column; a heading may have line breaks.
pub(super) struct Table {
    columns: Vec<(Column, &'static str)>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub fn new(columns: &[(Column, &'static str)]) -> Self {
        Table {
            columns: columns.to_vec(),
            rows: Vec::new(),
        }
    }

    /// Adds a row, a line of text to a cell; missing cells are empty, cells beyond the last column
    /// are dropped.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        let in_line = |cell: String| shown_in_line(&cell).into_owned();
        let mut cells: Vec<String> = cells.into_iter().map(in_line).collect();
        cells.resize(self.columns.len(), String::new());
        self.rows.push(cells);
    }

    /// The lines, each ended by a line break.
    pub fn render(&self) -> String {
        let widths = self.widths();
        let mut text = String::new();
        let heading: Vec<String> = self.columns.iter().map(|(_, h)| h.to_string()).collect();
        // Headings of one line stand next to the values, not above the others.
        let height = heading.iter().map(|h| h.lines().count()).max().unwrap_or(0);
        let heading: Vec<String> = heading
            .iter()
            .map(|h| "\n".repeat(height.saturating_sub(h.lines().count().max(1))) + h)
            .collect();
        self.set(&heading, &widths, &mut text);
        let length = widths.iter().sum::<usize>() + GAP * widths.len().saturating_sub(1);
        text.push_str(&format!("{}{}\n", " ".repeat(INDENT), "-".repeat(length)));
        for row in &self.rows {
            self.set(row, &widths, &mut text);
        }
        text
    }

    /// Natural widths; where they exceed the page, the widest text columns give way.
    fn widths(&self) -> Vec<usize> {
        let mut widths: Vec<usize> = (0..self.columns.len())
            .map(|c| {
                let heading = self.columns[c].1.lines();
                let cells = self.rows.iter().flat_map(|row| row[c].lines());
                heading.chain(cells).map(length).max().unwrap_or(0)
            })
            .collect();
        let page = WIDTH.saturating_sub(INDENT + GAP * widths.len().saturating_sub(1));
        while widths.iter().sum::<usize>() > page {
            let widest = (0..widths.len())
                .filter(|&c| self.columns[c].0 == Column::Text && widths[c] > LEAST)
                .max_by_key(|&c| widths[c]);
            let Some(widest) = widest else { break };
            widths[widest] -= 1;
        }
        widths
    }

    fn set(&self, cells: &[String], widths: &[usize], text: &mut String) {
        let cells: Vec<Vec<String>> = cells
            .iter()
            .zip(widths)
            .map(|(cell, &width)| wrap(cell, width))
            .collect();
        let height = cells.iter().map(Vec::len).max().unwrap_or(0);
        for line in 0..height {
            let mut set = " ".repeat(INDENT);
            for (c, (cell, &width)) in cells.iter().zip(widths).enumerate() {
                let part = cell.get(line).map_or("", String::as_str);
                let pad = " ".repeat(width.saturating_sub(length(part)));
                match self.columns[c].0 {
                    Column::Text => {
                        set.push_str(part);
                        set.push_str(&pad);
                    }
                    Column::Number => {
                        set.push_str(&pad);
                        set.push_str(part);
                    }
                }
                set.push_str(&" ".repeat(GAP));
            }
            text.push_str(set.trim_end());
            text.push('\n');
        }
    }
}

fn length(text: &str) -> usize {
    text.chars().count()
}

/// Lines of at most `width` characters, broken between words; a word longer than that is cut.
pub(super) fn wrap(text: &str, width: usize) -> Vec<String> {
    let width = width.max(1);
    let mut lines = Vec::new();
    for paragraph in text.split('\n') {
        let mut line = String::new();
        for mut word in paragraph.split_whitespace() {
            if !line.is_empty() && length(&line) + 1 + length(word) > width {
                lines.push(std::mem::take(&mut line));
            }
            while let Some((end, _)) = word.char_indices().nth(width) {
                lines.push(word[..end].to_string());
                word = &word[end..];
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned_by_kind() {
        let mut table = Table::new(&[(Column::Text, "name"), (Column::Number, "max\npressure")]);
        table.row(["yield".to_string(), "1.5".to_string()]);
        table.row(["β".to_string(), "10.25".to_string()]);
        assert_eq!(
            table.render(),
            "\
\x20             max
\x20 name   pressure
\x20 ---------------
\x20 yield       1.5
\x20 β         10.25
"
        );
    }

    #[test]
    fn text_gives_way_until_the_page_is_wide_enough() {
        let mut table = Table::new(&[
            (Column::Text, "effect"),
            (Column::Text, "why"),
            (Column::Number, "seconds"),
        ]);
        let why = "because of this ".repeat(20);
        table.row(["contact".to_string(), why.clone(), "1.5".to_string()]);
        let text = table.render();
        assert!(text.lines().all(|line| length(line) <= WIDTH), "{text}");
        let words = text.matches("because").count();
        assert_eq!(words, 20, "words lost:\n{text}");
        assert!(text.lines().count() > 4);
    }

    #[test]
    fn an_empty_heading_takes_no_line() {
        let mut table = Table::new(&[(Column::Text, "effect"), (Column::Text, "")]);
        table.row(["contact".to_string(), "on".to_string()]);
        assert_eq!(table.render(), "  effect\n  -----------\n  contact  on\n");
    }

    #[test]
    fn a_word_without_spaces_is_cut() {
        assert_eq!(wrap("abcdefgh ij", 3), ["abc", "def", "gh", "ij"]);
        assert_eq!(wrap("", 3), [""]);
        assert_eq!(wrap("a b\nc", 9), ["a b", "c"]);
    }

    #[test]
    fn short_rows_are_filled_up() {
        let mut table = Table::new(&[(Column::Text, "a"), (Column::Number, "b")]);
        table.row(["x".to_string()]);
        assert_eq!(table.render(), "  a  b\n  ----\n  x\n");
    }
}

//! Tables of text: aligned columns, no wider than a page, with long text wrapped. If there are more
//! columns than a page holds, the table is split into blocks, one below the other.

use crate::text::shown_in_line;
use std::io;
use terminal_size::{Width, terminal_size_of};

/// Width of a page in columns if there is no terminal.
const WIDTH: usize = 110;
/// Smallest and largest width of a page: longer lines are hard to read.
const WIDTHS: [usize; 2] = [40, 160];
const INDENT: usize = 2;
const GAP: usize = 2;
/// Smallest width to which a text column is squeezed.
const LEAST: usize = 10;

/// Alignment of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ColumnAlignment {
    /// Aligned to the left; wrapped if the page is too narrow.
    Text,
    /// Aligned to the right, for numbers.
    Number,
}

/// Returns the width of a page, which is that of the terminal to which standard output goes.
pub(super) fn page_width() -> usize {
    let columns = terminal_size_of(io::stdout()).map(|(Width(columns), _)| usize::from(columns));
    columns.map_or(WIDTH, |columns| columns.clamp(WIDTHS[0], WIDTHS[1]))
}

/// A table with a heading per column; a heading may have line breaks.
pub(super) struct Table {
    columns: Vec<(ColumnAlignment, String)>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub fn new<Heading: ToString>(columns: &[(ColumnAlignment, Heading)]) -> Self {
        let named = columns.iter().map(|(kind, name)| (*kind, name.to_string()));
        Table {
            columns: named.collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row. A cell is one line of text; missing cells are empty, cells beyond the last
    /// column are dropped.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        let in_line = |cell: String| shown_in_line(&cell).into_owned();
        let mut cells: Vec<String> = cells.into_iter().map(in_line).collect();
        cells.resize(self.columns.len(), String::new());
        self.rows.push(cells);
    }

    /// Returns the table as text, each line ended by a line break and no longer than a page, unless
    /// one column is wider.
    pub fn render(&self, page: usize) -> String {
        let widths = self.widths(page);
        let blocks = blocks(&widths, page);
        let rendered: Vec<String> = blocks.iter().map(|b| self.block(b, &widths)).collect();
        rendered.join("\n")
    }

    /// Returns the text of some of the columns.
    fn block(&self, columns: &[usize], widths: &[usize]) -> String {
        let mut text = String::new();
        let heading: Vec<String> = self.columns.iter().map(|(_, h)| h.to_string()).collect();
        // Headings of one line stand directly above the values, level with the last lines of other
        // headings.
        let lines = |h: &String| h.lines().count().max(1);
        let height = columns.iter().map(|&c| lines(&heading[c])).max();
        let low = |h: &String| "\n".repeat(height.unwrap_or(1).saturating_sub(lines(h))) + h;
        let heading: Vec<String> = heading.iter().map(low).collect();
        self.set(&heading, columns, widths, &mut text);
        let widths_of_block = columns.iter().map(|&c| widths[c]);
        let length = widths_of_block.sum::<usize>() + GAP * columns.len().saturating_sub(1);
        text.push_str(&format!("{}{}\n", " ".repeat(INDENT), "-".repeat(length)));
        for row in &self.rows {
            self.set(row, columns, widths, &mut text);
        }
        text
    }

    /// Returns the widths of the columns: natural widths; if they exceed the page, the widest text
    /// columns are narrowed.
    fn widths(&self, page: usize) -> Vec<usize> {
        let mut widths: Vec<usize> = (0..self.columns.len())
            .map(|c| {
                let heading = self.columns[c].1.lines();
                let cells = self.rows.iter().flat_map(|row| row[c].lines());
                heading.chain(cells).map(length).max().unwrap_or(0)
            })
            .collect();
        let page = page.saturating_sub(INDENT + GAP * widths.len().saturating_sub(1));
        while widths.iter().sum::<usize>() > page {
            let widest = (0..widths.len())
                .filter(|&c| self.columns[c].0 == ColumnAlignment::Text && widths[c] > LEAST)
                .max_by_key(|&c| widths[c]);
            let Some(widest) = widest else { break };
            widths[widest] -= 1;
        }
        widths
    }

    fn set(&self, cells: &[String], columns: &[usize], widths: &[usize], text: &mut String) {
        let cells: Vec<Vec<String>> = columns
            .iter()
            .map(|&column| wrap(&cells[column], widths[column]))
            .collect();
        let height = cells.iter().map(Vec::len).max().unwrap_or(0);
        for line in 0..height {
            let mut set = " ".repeat(INDENT);
            for (&column, cell) in columns.iter().zip(&cells) {
                let part = cell.get(line).map_or("", String::as_str);
                let pad = " ".repeat(widths[column].saturating_sub(length(part)));
                match self.columns[column].0 {
                    ColumnAlignment::Text => {
                        set.push_str(part);
                        set.push_str(&pad);
                    }
                    ColumnAlignment::Number => {
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

/// Splits the columns into blocks that fit a page, with the first column in each block.
fn blocks(widths: &[usize], page: usize) -> Vec<Vec<usize>> {
    let Some(first) = widths.first() else {
        return Vec::new();
    };
    let (mut blocks, mut used) = (vec![vec![0]], INDENT + first);
    for (column, width) in widths.iter().enumerate().skip(1) {
        let block = &blocks[blocks.len() - 1];
        if block.len() > 1 && used + GAP + width > page {
            blocks.push(vec![0]);
            used = INDENT + first;
        }
        used += GAP + width;
        let last = blocks.len() - 1;
        blocks[last].push(column);
    }
    blocks
}

fn length(text: &str) -> usize {
    text.chars().count()
}

/// Wraps text to lines of at most `width` characters, broken between words; a longer word is cut.
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
        let mut table = Table::new(&[
            (ColumnAlignment::Text, "name"),
            (ColumnAlignment::Number, "max\npressure"),
        ]);
        table.row(["yield".to_string(), "1.5".to_string()]);
        table.row(["β".to_string(), "10.25".to_string()]);
        assert_eq!(
            table.render(WIDTH),
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
            (ColumnAlignment::Text, "effect"),
            (ColumnAlignment::Text, "why"),
            (ColumnAlignment::Number, "seconds"),
        ]);
        let why = "because of this ".repeat(20);
        table.row(["contact".to_string(), why.clone(), "1.5".to_string()]);
        let text = table.render(WIDTH);
        assert!(text.lines().all(|line| length(line) <= WIDTH), "{text}");
        let words = text.matches("because").count();
        assert_eq!(words, 20, "words lost:\n{text}");
        assert!(text.lines().count() > 4);
    }

    #[test]
    fn numbers_that_do_not_fit_are_a_second_table() {
        let mut table = Table::new(&[
            (ColumnAlignment::Text, "state"),
            (ColumnAlignment::Number, "pressure\n[MPa]"),
            (ColumnAlignment::Number, "width\n[mm]"),
        ]);
        table.row(["pressed", "1234.5", "0.5"].map(String::from));
        let first =
            "           pressure\n  state       [MPa]\n  -----------------\n  pressed    1234.5\n";
        let second = "           width\n  state     [mm]\n  --------------\n  pressed    0.5\n";
        assert_eq!(table.render(22), format!("{first}\n{second}"));
        assert!(!table.render(WIDTH).contains("\n\n"));
    }

    #[test]
    fn an_empty_heading_takes_no_line() {
        let mut table = Table::new(&[
            (ColumnAlignment::Text, "effect"),
            (ColumnAlignment::Text, ""),
        ]);
        table.row(["contact".to_string(), "on".to_string()]);
        assert_eq!(
            table.render(WIDTH),
            "  effect\n  -----------\n  contact  on\n"
        );
    }

    #[test]
    fn a_word_without_spaces_is_cut() {
        assert_eq!(wrap("abcdefgh ij", 3), ["abc", "def", "gh", "ij"]);
        assert_eq!(wrap("", 3), [""]);
        assert_eq!(wrap("a b\nc", 9), ["a b", "c"]);
    }

    #[test]
    fn short_rows_are_filled_up() {
        let mut table = Table::new(&[(ColumnAlignment::Text, "a"), (ColumnAlignment::Number, "b")]);
        table.row(["x".to_string()]);
        assert_eq!(table.render(WIDTH), "  a  b\n  ----\n  x\n");
    }
}

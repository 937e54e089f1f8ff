//! The lines of a deck and of the files that it includes, in reading order, each with its place.

use crate::error::{Error, Result};
use crate::files;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// Largest number of files that one deck may include: more must be a mistake, or an attack.
const MOST_FILES: usize = 1000;

/// The place of a line in one of the deck's files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) struct LinePlace {
    file: u32,
    line: u32,
}

/// Names of the files of a deck, for messages.
#[derive(Debug, Clone, Default)]
pub(super) struct Files(Vec<String>);

impl Files {
    /// The place in words: `FILE, line N`.
    pub(super) fn show(&self, place: LinePlace) -> String {
        format!("{}, line {}", self.name(place), place.line)
    }

    /// An error at a line, for a keyword.
    pub(super) fn error(
        &self,
        place: LinePlace,
        keyword: &str,
        message: impl std::fmt::Display,
    ) -> Error {
        let place = self.show(place);
        Error::input(format!("{place}: *{keyword}: {message}"))
    }

    /// The name of the deck's own file.
    pub(super) fn first(&self) -> &str {
        self.0.first().map_or("", String::as_str)
    }

    fn name(&self, place: LinePlace) -> &str {
        self.0.get(place.file as usize).map_or("", String::as_str)
    }
}

impl LinePlace {
    /// The number of the line, for lists that concern one file.
    pub(super) fn line(self) -> u32 {
        self.line
    }
}

/// A line that is neither blank nor a comment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) place: LinePlace,
    /// Index of the text that holds the bytes of the line.
    text: u32,
    start: usize,
    end: usize,
}

/// Lines that are written anew from the lines of a deck.
#[derive(Debug, Default)]
pub(super) struct Anew {
    text: Vec<u8>,
    /// The place in the deck of each line, and the end of the line in `text`.
    ends: Vec<(LinePlace, usize)>,
}

impl Anew {
    /// The text to which the current line is written.
    pub(super) fn text(&mut self) -> &mut Vec<u8> {
        &mut self.text
    }

    /// Ends the current line, which corresponds to the given place in the deck.
    pub(super) fn end_line(&mut self, place: LinePlace) {
        self.ends.push((place, self.text.len()));
    }
}

/// A file that is being read.
struct Open {
    file: u32,
    at: usize,
    line: u32,
}

impl Open {
    /// The beginning of a file, after the byte order mark that Windows puts before UTF-8.
    fn new(file: u32, text: &[u8]) -> Self {
        const MARK: &[u8] = b"\xef\xbb\xbf";
        let at = if text.starts_with(MARK) {
            MARK.len()
        } else {
            0
        };
        Open { file, at, line: 0 }
    }
}

/// The text with line feeds, if its lines end with carriage returns alone, as those of old
/// Macintosh computers do.
fn with_line_feeds(text: Cow<[u8]>) -> Cow<[u8]> {
    if !text.contains(&b'\r') || text.contains(&b'\n') {
        return text;
    }
    let mut text = text.into_owned();
    let ends = text.iter_mut().filter(|byte| **byte == b'\r');
    ends.for_each(|byte| *byte = b'\n');
    Cow::Owned(text)
}

/// The lines of a deck. `*INCLUDE` is resolved here, so that readers never see it.
pub(super) struct DeckLines<'t> {
    texts: Vec<Cow<'t, [u8]>>,
    pub(super) files: Files,
    /// The directory to which relative paths refer.
    folder: Option<PathBuf>,
    open: Vec<Open>,
    ahead: Option<Line>,
    /// Lines that were written anew; if present, they are all that remains to be read.
    anew: Option<std::vec::IntoIter<Line>>,
}

impl<'t> DeckLines<'t> {
    pub(super) fn new(text: Cow<'t, [u8]>, name: &str, folder: Option<&Path>) -> Self {
        let text = with_line_feeds(text);
        DeckLines {
            open: vec![Open::new(0, &text)],
            texts: vec![text],
            files: Files(vec![name.to_string()]),
            folder: folder.map(Path::to_path_buf),
            ahead: None,
            anew: None,
        }
    }

    /// The bytes of a line, without leading and trailing blanks.
    pub(super) fn bytes(&self, line: Line) -> &[u8] {
        &self.texts[line.text as usize][line.start..line.end]
    }

    /// The name of the file that contains a line.
    pub(super) fn file(&self, line: Line) -> &str {
        self.files.name(line.place)
    }

    /// The place up to which the deck has been read.
    pub(super) fn here(&self) -> LinePlace {
        self.open
            .last()
            .map_or(LinePlace::default(), |open| LinePlace {
                file: open.file,
                line: open.line,
            })
    }

    /// Reads the next line; `None` at the end of the deck.
    ///
    /// # Errors
    /// The errors of [`DeckLines::include`].
    pub(super) fn next(&mut self) -> Result<Option<Line>> {
        if let Some(line) = self.ahead.take() {
            return Ok(Some(line));
        }
        if let Some(anew) = &mut self.anew {
            return Ok(anew.next());
        }
        while let Some(line) = self.written() {
            match self.bytes(line) {
                [b'*', ..] if is_include(self.bytes(line)) => self.include(line)?,
                _ => return Ok(Some(line)),
            }
        }
        Ok(None)
    }

    /// Reads the next line of the files that is neither blank nor a comment; `None` at the end of
    /// the deck.
    fn written(&mut self) -> Option<Line> {
        while let Some(open) = self.open.last_mut() {
            let text = &self.texts[open.file as usize];
            let rest = &text[open.at..];
            if rest.is_empty() {
                if self.open.len() == 1 {
                    return None;
                }
                self.open.pop();
                continue;
            }
            let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
            let whole = &rest[..length];
            let left = whole.len() - whole.trim_ascii_start().len();
            let trimmed = whole.trim_ascii();
            let line = Line {
                place: LinePlace {
                    file: open.file,
                    line: open.line + 1,
                },
                text: open.file,
                start: open.at + left,
                end: open.at + left + trimmed.len(),
            };
            open.at += (length + 1).min(rest.len());
            open.line += 1;
            if !matches!(trimmed, [] | [b'*', b'*', ..]) {
                return Some(line);
            }
        }
        None
    }

    /// Reads the next data line; `None` if a keyword or the end of the deck comes next.
    ///
    /// # Errors
    /// The errors of [`DeckLines::next`].
    pub(super) fn next_data(&mut self) -> Result<Option<Line>> {
        match self.next()? {
            Some(line) if self.bytes(line).first() == Some(&b'*') => {
                self.ahead = Some(line);
                Ok(None)
            }
            other => Ok(other),
        }
    }

    /// Continues with lines that were written anew, once all lines of the files have been read. The
    /// texts of the files are dropped.
    pub(super) fn go_on_with(&mut self, anew: Anew) {
        let text = self.texts.len() as u32;
        self.texts
            .iter_mut()
            .for_each(|old| *old = Cow::Borrowed(&[]));
        self.texts.push(Cow::Owned(anew.text));
        let mut start = 0;
        let lines = anew.ends.into_iter().map(|(place, end)| {
            let line = Line {
                place,
                text,
                start,
                end,
            };
            start = end;
            line
        });
        self.anew = Some(lines.collect::<Vec<_>>().into_iter());
    }

    /// Continues with the file that an `*INCLUDE` names.
    ///
    /// # Errors
    /// `Input` if no file is named, if the file is already being read, or if too many files are
    /// included; also the errors of reading the file.
    fn include(&mut self, line: Line) -> Result<()> {
        let place = self.files.show(line.place);
        let refused = |why: String| Err(Error::input(format!("{place}: *INCLUDE: {why}")));
        let mut text = String::from_utf8_lossy(self.bytes(line)).into_owned();
        if text.ends_with(',')
            && let Some(next) = self.written()
        {
            text.push_str(&String::from_utf8_lossy(self.bytes(next)));
        }
        let names = names_of_included(&text);
        let Some(&given) = names.first() else {
            return refused("no file is named; write *INCLUDE, INPUT=FILE".to_string());
        };
        let beside = |given: &str| match &self.folder {
            Some(folder) => folder.join(given),
            None => PathBuf::from(given),
        };
        // Paths may use the separator of Windows.
        let mut paths = names.iter().flat_map(|name| {
            let slashes = name.contains('\\').then(|| name.replace('\\', "/"));
            [Some(beside(name)), slashes.map(|name| beside(&name))]
        });
        let there = paths.by_ref().flatten().find(|path| path.exists());
        let path = there.unwrap_or_else(|| beside(given));
        let name = path.display().to_string();
        let is_open = |open: &Open| self.files.0[open.file as usize] == name;
        if self.open.iter().any(is_open) {
            return refused(format!("{name} includes itself; take the line out"));
        }
        if self.texts.len() > MOST_FILES {
            return refused(format!("more than {MOST_FILES} files are included"));
        }
        let text = files::read("read the included file", &path, None)
            .map_err(|error| error.within(format!("{place}: *INCLUDE")))?;
        self.open.push(Open::new(self.texts.len() as u32, &text));
        self.texts.push(with_line_feeds(Cow::Owned(text)));
        self.files.0.push(name);
        Ok(())
    }
}

/// File names that an `*INCLUDE` may mean, the most likely first. Text in quotes after `INPUT=` is
/// the only candidate. Otherwise the first candidate is the text up to the first comma, and the
/// second the whole text: a name may contain commas, since no parameter follows it.
fn names_of_included(line: &str) -> Vec<&str> {
    let behind = |(at, _): (usize, char)| {
        let (key, value) = line[at + 1..].split_once('=')?;
        key.trim().eq_ignore_ascii_case("input").then_some(value)
    };
    let Some(value) = line
        .char_indices()
        .filter(|(_, c)| *c == ',')
        .find_map(behind)
    else {
        return Vec::new();
    };
    let value = value.trim();
    let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''));
    let mut names = match quote {
        Some(quote) => vec![value[1..].split(quote).next().unwrap_or_default()],
        None => vec![value.split(',').next().unwrap_or_default().trim(), value],
    };
    names.retain(|name| !name.is_empty());
    names
}

/// Whether a line that begins with an asterisk is an `*INCLUDE`.
fn is_include(line: &[u8]) -> bool {
    let word = line.split(|&b| b == b',').next().unwrap_or_default();
    word[1..].trim_ascii().eq_ignore_ascii_case(b"include")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_included_files_may_have_quotes_blanks_and_commas() {
        for (line, expected) in [
            ("*INCLUDE, INPUT=a.inp", &["a.inp", "a.inp"][..]),
            ("*include,input = \"a, b.inp\"", &["a, b.inp"]),
            ("*INCLUDE, INPUT='it is.inp' , x", &["it is.inp"]),
            ("*INCLUDE,INPUT=a,b.inp", &["a", "a,b.inp"]),
            ("*INCLUDE, X=1, Input=c.inp", &["c.inp", "c.inp"]),
            ("*INCLUDE, INPUT=", &[]),
            ("*INCLUDE, INPUT=\"", &[]),
            ("*INCLUDE", &[]),
        ] {
            assert_eq!(names_of_included(line), expected, "{line}");
        }
    }
}

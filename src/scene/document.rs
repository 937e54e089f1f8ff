//! A TOML document in which every key and value has a number, so that an error found later (by
//! serde or by validation) is traced back to its key path and its place in the file or override.
//!
//! serde knows places as byte spans. Before the document is handed to serde, each span is replaced
//! by the number of its node. The span of an error then names the node exactly, even for values
//! that came from an override and stand in no file.

use super::KeyPlaces;
use crate::error::{Error, Result};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The text of a scene and the overrides applied to it: places refer to both.
pub(super) struct SceneSource<'t> {
    /// File name for messages.
    pub name: &'t str,
    /// The file's text.
    pub text: &'t str,
    /// Overrides as given, each `key=value`.
    pub overrides: &'t [String],
    /// Byte offsets at which the lines of the text begin.
    lines: Vec<usize>,
    /// Number of characters before each block of [`BLOCK`] bytes of the text.
    characters: Vec<usize>,
}

/// Bytes of a block of text whose characters are counted in advance.
const BLOCK: usize = 1024;

/// Number of characters that begin within these bytes of UTF-8.
fn count(bytes: &[u8]) -> usize {
    bytes.iter().filter(|&&byte| byte & 0xc0 != 0x80).count()
}

impl<'t> SceneSource<'t> {
    pub fn new(name: &'t str, text: &'t str, overrides: &'t [String]) -> Self {
        let ends = text.match_indices('\n').map(|(at, _)| at + 1);
        let mut before = 0;
        let characters = text.as_bytes().chunks(BLOCK).map(|block| {
            before += count(block);
            before
        });
        SceneSource {
            name,
            text,
            overrides,
            lines: std::iter::once(0).chain(ends).collect(),
            characters: std::iter::once(0).chain(characters).collect(),
        }
    }

    /// Describes a place as `FILE:LINE:COLUMN`, or as `--set KEY=VALUE` if it is in an override.
    fn describe(&self, place: usize) -> String {
        if let Some(number) = place.checked_sub(self.override_place(0))
            && let Some(text) = self.overrides.get(number)
        {
            return format!("--set {text}");
        }
        let mut end = place.min(self.text.len());
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        let line = self.lines.partition_point(|&begin| begin <= end);
        let column = self.characters(end) - self.characters(self.lines[line - 1]) + 1;
        format!("{}:{line}:{column}", self.name)
    }

    /// Number of characters before a byte offset. Only characters within one block are counted,
    /// however long the line is.
    fn characters(&self, end: usize) -> usize {
        let block = end / BLOCK;
        self.characters[block] + count(&self.text.as_bytes()[block * BLOCK..end])
    }

    /// The place that stands for override `number`: an offset beyond the end of the text.
    pub fn override_place(&self, number: usize) -> usize {
        self.text.len() + 1 + number
    }

    /// The error for a text that is not valid TOML.
    pub fn syntax_error(&self, error: &toml::de::Error) -> Error {
        let place = error.span().map_or(self.text.len(), |span| span.start);
        Error::input(format!(
            "{}: not valid TOML: {}",
            self.describe(place),
            error.message()
        ))
    }
}

/// A key or a value of the document.
struct DocumentNode {
    /// Key path in the form that overrides use, such as `contact.0.gap`.
    path: String,
    /// Place of the node in words, such as `FILE:LINE:COLUMN`.
    place: String,
}

/// Places of all keys and values of a document.
pub(super) struct KeyPositions {
    nodes: Vec<DocumentNode>,
}

impl KeyPositions {
    /// Numbers all nodes of `root`. The returned document carries these numbers in place of byte
    /// spans.
    ///
    /// # Errors
    /// `Input` with key and place for a number that is not finite or an integer beyond 64 bits.
    pub fn number<'i>(
        source: &SceneSource<'_>,
        root: DeTable<'i>,
    ) -> Result<(KeyPositions, Spanned<DeTable<'i>>)> {
        let mut places = KeyPositions { nodes: Vec::new() };
        let id = places.add("", source.describe(0));
        let root = places.table(root, "", source)?;
        Ok((places, Spanned::new(id..id, root)))
    }

    /// Place and key path of the node that an error of serde points at.
    pub fn of_error(&self, error: &toml::de::Error) -> (&str, &str) {
        let id = error.span().map_or(0, |span| span.start);
        let node = &self.nodes[id.min(self.nodes.len() - 1)];
        (&node.place, &node.path)
    }

    /// The place of each key path: the place of the key itself, or of the value if the path has no
    /// key (list entries).
    pub fn by_key(self) -> KeyPlaces {
        // A key comes before its value. In reverse order the key comes last, and of equal paths the
        // last one is kept.
        let nodes = self.nodes.into_iter().rev();
        KeyPlaces::new(nodes.map(|node| (node.path, node.place)).collect())
    }

    fn add(&mut self, path: &str, place: String) -> usize {
        self.nodes.push(DocumentNode {
            path: path.to_string(),
            place,
        });
        self.nodes.len() - 1
    }

    fn table<'i>(
        &mut self,
        table: DeTable<'i>,
        path: &str,
        source: &SceneSource<'_>,
    ) -> Result<DeTable<'i>> {
        let mut numbered = DeTable::new();
        for (key, value) in table {
            let path = join(path, key.get_ref());
            let id = self.add(&path, source.describe(key.span().start));
            let value = self.value(value, &path, source)?;
            numbered.insert(Spanned::new(id..id, key.into_inner()), value);
        }
        Ok(numbered)
    }

    fn value<'i>(
        &mut self,
        value: Spanned<DeValue<'i>>,
        path: &str,
        source: &SceneSource<'_>,
    ) -> Result<Spanned<DeValue<'i>>> {
        let place = value.span().start;
        let id = self.add(path, source.describe(place));
        let numbered = match value.into_inner() {
            DeValue::Table(table) => DeValue::Table(self.table(table, path, source)?),
            DeValue::Array(array) => {
                let mut items = toml::de::DeArray::new();
                for (index, item) in array.into_iter().enumerate() {
                    items.push(self.value(item, &join(path, &index.to_string()), source)?);
                }
                DeValue::Array(items)
            }
            DeValue::Float(number) => {
                if !number.as_str().parse().is_ok_and(f64::is_finite) {
                    return Err(Error::input(format!(
                        "{}: {path}: {} is not a finite number; give a finite one",
                        source.describe(place),
                        number.as_str()
                    )));
                }
                DeValue::Float(number)
            }
            // The range of integers in TOML; a larger number could not be written back.
            DeValue::Integer(number)
                if i64::from_str_radix(number.as_str(), number.radix()).is_err() =>
            {
                return Err(Error::input(format!(
                    "{}: {path}: {} is out of the range of integers; give a smaller one",
                    source.describe(place),
                    number.as_str()
                )));
            }
            other => other,
        };
        Ok(Spanned::new(id..id, numbered))
    }
}

/// Joins `path.key`, quoting a key that contains a dot.
pub(super) fn join(path: &str, key: &str) -> String {
    let key = if key.contains('.') {
        format!("\"{key}\"")
    } else {
        key.to_string()
    };
    if path.is_empty() {
        key
    } else {
        format!("{path}.{key}")
    }
}

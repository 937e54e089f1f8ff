//! Values at nodes: the section `$NodeData`, which is the same in both versions of the format.

use super::cursor::Cursor;
use super::read_format;
use crate::error::Result;
use crate::files;
#[cfg(feature = "cli")]
use std::io::Write;
use std::path::Path;

/// Reads the values of the only section `$NodeData` of a file, by node number.
///
/// # Errors
/// An I/O error if the file cannot be read, and the errors of [`parse`].
pub(crate) fn read(path: &Path) -> Result<Vec<(u64, f64)>> {
    let text = files::read("read the values of nodes", path, None)?;
    parse(&text, &path.display().to_string())
}

/// Reads nodal values from the bytes of a file; `name` is the file's name for messages.
///
/// # Errors
/// `Input` with file name and line number: no section or several, values that are not scalars, a
/// file that ends early.
fn parse(text: &[u8], name: &str) -> Result<Vec<(u64, f64)>> {
    let mut cursor = Cursor::new(text, name);
    let mut found = None;
    loop {
        cursor.section = "the file";
        cursor.skip_lines();
        let at = cursor.at();
        match cursor.section_start()? {
            None => break,
            Some(b"$MeshFormat") => {
                cursor.section = "$MeshFormat";
                read_format(&mut cursor)?;
                cursor.section_end("$EndMeshFormat")?;
            }
            Some(b"$NodeData") if found.is_some() => {
                let message = "a second section $NodeData: which one is meant is not known; give a \
                               file for each";
                return Err(cursor.error_at(at, message));
            }
            Some(b"$NodeData") => {
                cursor.section = "$NodeData";
                found = Some(section(&mut cursor)?);
                cursor.section_end("$EndNodeData")?;
            }
            Some(other) => cursor.skip_section(other)?,
        }
    }
    found.ok_or_else(|| cursor.error("the file has no section $NodeData with values of nodes"))
}

/// Writes values by node as a section `$NodeData`, one line for each node.
///
/// # Errors
/// The errors of `out`.
#[cfg(feature = "cli")]
pub(crate) fn write(name: &str, values: &[(u64, f64)], out: &mut dyn Write) -> std::io::Result<()> {
    let mut out = std::io::BufWriter::with_capacity(1 << 16, out);
    let n = values.len();
    writeln!(out, "$NodeData\n1\n\"{name}\"\n1\n0.0\n3\n0\n1\n{n}")?;
    for (node, value) in values {
        writeln!(out, "{node} {value:?}")?;
    }
    writeln!(out, "$EndNodeData")?;
    out.flush()
}

/// Reads a section: tags of three kinds, which are text even in a binary file, then a node and its
/// value per line.
fn section(cursor: &mut Cursor) -> Result<Vec<(u64, f64)>> {
    let n = cursor.in_text(read_tags)?;
    let mut out = Vec::new();
    for _ in 0..n {
        if !cursor.is_binary() {
            cursor.skip_lines();
        }
        out.push((cursor.small("a node")?, cursor.float("a value")?));
        cursor.end_line()?;
    }
    Ok(out)
}

/// Reads the tags and returns the number of values.
fn read_tags(cursor: &mut Cursor) -> Result<u64> {
    for _ in 0..count(cursor, "the number of string tags")? {
        cursor.skip_lines();
        cursor.quoted("a string tag")?;
    }
    for _ in 0..count(cursor, "the number of real tags")? {
        cursor.skip_lines();
        cursor.float("a real tag")?;
    }
    let mut tags = Vec::new();
    for _ in 0..count(cursor, "the number of integer tags")? {
        cursor.skip_lines();
        tags.push(cursor.unsigned("an integer tag")?);
    }
    let &[_, components, n, ..] = &tags[..] else {
        return Err(cursor.error(
            "the integer tags should be the time step, the number of components and that of nodes",
        ));
    };
    if components != 1 {
        let message = format!("the values have {components} components; they should have 1");
        return Err(cursor.error(message));
    }
    cursor.end_line()?;
    Ok(n)
}

fn count(cursor: &mut Cursor, what: &str) -> Result<usize> {
    cursor.skip_lines();
    cursor.count(what)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DATA: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$NodeData\n1\n\"heat\"\n1\n0.0\n\
                        3\n0\n1\n2\n7 20.5\n9 -3e1\n$EndNodeData\n";

    #[test]
    fn values_are_read_by_node() {
        let read = parse(DATA.as_bytes(), "t.msh").unwrap();
        assert_eq!(read, [(7, 20.5), (9, -30.0)]);
    }

    #[test]
    fn what_is_wrong_is_told_by_line() {
        for (old, new, expected) in [
            ("$NodeData\n1", "$ElementData\n1", "no section $NodeData"),
            ("3\n0\n1\n2", "3\n0\n3\n2", "3 components"),
            ("9 -3e1\n", "", "line 14"),
            ("20.5", "warm", "line 13"),
            ("3\n0\n1\n2", "1\n0", "the integer tags should be"),
        ] {
            let text = DATA.replace(old, new).replace(
                "$EndNodeData",
                match old {
                    "$NodeData\n1" => "$EndElementData",
                    _ => "$EndNodeData",
                },
            );
            let error = parse(text.as_bytes(), "t.msh").unwrap_err();
            assert!(error.message().contains(expected), "{error}");
        }
        let twice = format!("{DATA}{}", &DATA[DATA.find("$NodeData").unwrap()..]);
        let error = parse(twice.as_bytes(), "t.msh").unwrap_err();
        assert!(error.message().contains("a second section"), "{error}");
    }
}

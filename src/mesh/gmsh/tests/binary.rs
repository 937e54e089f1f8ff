//! Binary files of both versions and both byte orders give the same mesh as the corresponding text
//! files.

use super::*;

/// Bytes as this machine, or one with the reverse byte order, writes them.
struct Bytes {
    out: Vec<u8>,
    swapped: bool,
    /// Whether numbers of nodes and elements have eight bytes.
    wide: bool,
}

impl Bytes {
    fn put(&mut self, mut bytes: Vec<u8>) {
        if self.swapped {
            bytes.reverse();
        }
        self.out.extend(bytes);
    }

    fn small(&mut self, words: &mut Words) -> i64 {
        let value: i32 = words.next().unwrap().parse().unwrap();
        self.put(value.to_ne_bytes().to_vec());
        value.into()
    }

    fn smalls(&mut self, words: &mut Words, n: i64) {
        (0..n).for_each(|_| {
            self.small(words);
        });
    }

    fn number(&mut self, words: &mut Words) -> i64 {
        if !self.wide {
            return self.small(words);
        }
        let value: i64 = words.next().unwrap().parse().unwrap();
        self.put(value.to_ne_bytes().to_vec());
        value
    }

    fn floats(&mut self, words: &mut Words, n: usize) {
        for _ in 0..n {
            let value: f64 = words.next().unwrap().parse().unwrap();
            self.put(value.to_ne_bytes().to_vec());
        }
    }

    fn line(&mut self, text: impl std::fmt::Display) {
        self.out.extend(format!("{text}\n").bytes());
    }

    /// Writes the bounding entities too, which these texts may have for all entities except points.
    fn entities(&mut self, lines: &mut dyn Iterator<Item = &str>, partitioned: bool) {
        if partitioned {
            self.number(&mut lines.next().unwrap().split_whitespace());
            for _ in 0..self.number(&mut lines.next().unwrap().split_whitespace()) {
                let mut words = lines.next().unwrap().split_whitespace();
                self.smalls(&mut words, 2);
            }
        }
        let mut counts = lines.next().unwrap().split_whitespace();
        let counts = [0; 4].map(|_| self.number(&mut counts));
        for (dimension, n) in counts.into_iter().enumerate() {
            for _ in 0..n {
                let mut words = lines.next().unwrap().split_whitespace();
                self.small(&mut words);
                if partitioned {
                    self.smalls(&mut words, 2);
                    let n = self.number(&mut words);
                    self.smalls(&mut words, n);
                }
                self.floats(&mut words, if dimension == 0 { 3 } else { 6 });
                for _ in 0..if dimension == 0 { 1 } else { 2 } {
                    let n = self.number(&mut words);
                    self.smalls(&mut words, n);
                }
            }
        }
    }

    fn nodes(&mut self, lines: &mut dyn Iterator<Item = &str>) {
        let mut words = lines.next().unwrap().split_whitespace();
        if !self.wide {
            self.line(words.next().unwrap());
            for line in lines {
                let mut words = line.split_whitespace();
                self.small(&mut words);
                self.floats(&mut words, 3);
            }
            return;
        }
        let [blocks, ..] = [0; 4].map(|_| self.number(&mut words));
        for _ in 0..blocks {
            let mut words = lines.next().unwrap().split_whitespace();
            let [dimension, _, parametric] = [0; 3].map(|_| self.small(&mut words));
            let n = self.number(&mut words);
            for _ in 0..n {
                self.number(&mut lines.next().unwrap().split_whitespace());
            }
            for _ in 0..n {
                let more = if parametric == 1 { dimension } else { 0 };
                let mut words = lines.next().unwrap().split_whitespace();
                self.floats(&mut words, 3 + more as usize);
            }
        }
    }

    fn elements(&mut self, lines: &mut dyn Iterator<Item = &str>) {
        let mut words = lines.next().unwrap().split_whitespace();
        if !self.wide {
            self.line(words.next().unwrap());
            for line in lines {
                // Each element is written as a block of its own, which Gmsh may do.
                let words: Vec<&str> = line.split_whitespace().collect();
                let header = format!("{} 1 {}", words[1], words[2]);
                let mut header = header.split_whitespace();
                (0..3).for_each(|_| {
                    self.small(&mut header);
                });
                let rest = [&words[..1], &words[3..]].concat().join(" ");
                let mut rest = rest.split_whitespace();
                (3..=words.len() - 1).for_each(|_| {
                    self.small(&mut rest);
                });
                self.small(&mut rest);
            }
            return;
        }
        let [blocks, ..] = [0; 4].map(|_| self.number(&mut words));
        for _ in 0..blocks {
            let mut words = lines.next().unwrap().split_whitespace();
            (0..3).for_each(|_| {
                self.small(&mut words);
            });
            for _ in 0..self.number(&mut words) {
                let line = lines.next().unwrap();
                let mut words = line.split_whitespace();
                for _ in 0..line.split_whitespace().count() {
                    self.number(&mut words);
                }
            }
        }
    }
}

type Words<'a> = std::str::SplitWhitespace<'a>;

/// Converts a text file into a binary one.
pub(super) fn binary(text: &str, swapped: bool) -> Vec<u8> {
    let wide = text.contains("\n4.1 0 8");
    let mut bytes = Bytes {
        out: Vec::new(),
        swapped,
        wide,
    };
    let mut rest = text;
    while let Some((head, after)) = rest.split_once('\n') {
        let end = format!("$End{}", head.trim_start_matches('$'));
        let (body, after) = after.split_once(&end).unwrap();
        rest = after.trim_start();
        bytes.line(head);
        let mut lines = body.lines();
        match head {
            "$MeshFormat" => {
                bytes.line(body.trim().replace(" 0 8", " 1 8"));
                bytes.put(1i32.to_ne_bytes().to_vec());
                bytes.line("");
            }
            "$Entities" => bytes.entities(&mut lines, false),
            "$PartitionedEntities" => bytes.entities(&mut lines, true),
            "$Nodes" => bytes.nodes(&mut lines),
            "$Elements" => bytes.elements(&mut lines),
            _ => bytes.out.extend(body.bytes()),
        }
        bytes.line("");
        bytes.line(end);
    }
    bytes.out
}

fn samples() -> Vec<String> {
    let partitioned = partitions::row(true, &partitions::ALL);
    let mut out = vec![
        V2.replace("900000000000", "900000000"),
        V4.to_string(),
        partitioned,
    ];
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/data/meshes");
    for file in std::fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_some_and(|e| e == "msh") {
            out.push(std::fs::read_to_string(path).unwrap());
        }
    }
    out
}

#[test]
fn a_binary_file_is_the_text() {
    let samples = samples();
    assert!(samples.len() > 5);
    for text in samples {
        let expected = parse(text.as_bytes(), "text.msh").unwrap();
        for swapped in [false, true] {
            let found = parse(&binary(&text, swapped), "binary.msh").unwrap();
            assert_eq!(format!("{found:?}"), format!("{expected:?}"));
        }
    }
}

#[test]
fn what_is_cut_off_or_changed_is_refused_by_its_byte() {
    for text in [V2.replace("900000000000", "900000000"), V4.to_string()] {
        let whole = binary(&text, false);
        let place = |name: &[u8]| whole.windows(name.len()).position(|bytes| bytes == name);
        let elements = place(b"$Elements").unwrap();
        for length in 0..place(b"$EndElements").unwrap() {
            let error = parse(&whole[..length], "cut.msh").unwrap_err();
            let place = ["cut.msh, byte ", "cut.msh, line "];
            assert!(
                place.iter().any(|p| error.message().starts_with(p)),
                "{error}"
            );
            // The number of elements is text in version 2.2, and is compared with the bytes left.
            if length > elements + 20 {
                assert!(error.message().starts_with(place[0]), "{error}");
            }
        }
        // With every byte inverted in turn, the file is read as something else or refused, but
        // never takes more memory than its bytes can account for.
        for k in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[k] ^= 0xff;
            let _ = parse(&damaged, "damaged.msh");
        }
        let one = whole.iter().position(|b| *b == 1).unwrap();
        let mut damaged = whole.clone();
        damaged[one] = 7;
        let error = parse(&damaged, "damaged.msh").unwrap_err();
        assert!(error.message().contains("order of bytes"), "{error}");
    }
}

/// A file that another program saved as text, so that each line feed became two bytes, and files
/// with unsupported sizes or types.
#[test]
fn other_sizes_and_types_are_named() {
    for (format, expected) in [
        ("4.1 1 4", "binary numbers of 4 bytes"),
        ("4.1 2 8", "file type is 2"),
    ] {
        let text = format!("$MeshFormat\n{format}\n\u{1}\0\0\0\n$EndMeshFormat\n");
        let error = parse(text.as_bytes(), "t.msh").unwrap_err();
        assert!(error.message().contains(expected), "{error}");
    }
}

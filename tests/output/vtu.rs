//! A reader of `.vtu` files with appended raw data, written against the format's description and
//! not against the writer.

use std::collections::BTreeMap;
use std::path::Path;

/// An array as it is in the file.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    pub kind: String,
    pub components: usize,
    pub component_names: Vec<String>,
    pub bytes: Vec<u8>,
}

impl Array {
    pub fn f64s(&self) -> Vec<f64> {
        assert_eq!(self.kind, "Float64");
        let chunks = self.bytes.as_chunks::<8>();
        assert!(chunks.1.is_empty());
        chunks.0.iter().map(|&b| f64::from_le_bytes(b)).collect()
    }

    pub fn i64s(&self) -> Vec<i64> {
        assert_eq!(self.kind, "Int64");
        let chunks = self.bytes.as_chunks::<8>();
        assert!(chunks.1.is_empty());
        chunks.0.iter().map(|&b| i64::from_le_bytes(b)).collect()
    }

    pub fn i32s(&self) -> Vec<i32> {
        assert_eq!(self.kind, "Int32");
        let chunks = self.bytes.as_chunks::<4>();
        assert!(chunks.1.is_empty());
        chunks.0.iter().map(|&b| i32::from_le_bytes(b)).collect()
    }

    pub fn u8s(&self) -> Vec<u8> {
        assert_eq!(self.kind, "UInt8");
        self.bytes.clone()
    }
}

/// An unstructured grid of one piece: arrays by `SECTION/NAME`.
pub struct Grid {
    pub n_points: usize,
    pub n_cells: usize,
    pub arrays: BTreeMap<String, Array>,
}

impl Grid {
    pub fn array(&self, path: &str) -> &Array {
        &self.arrays[path]
    }
}

pub fn read(path: &Path) -> Grid {
    let file = std::fs::read(path).unwrap();
    let opening = b"<AppendedData encoding=\"raw\">";
    let start = find(&file, opening).expect("no appended section") + opening.len();
    let underscore = start + find(&file[start..], b"_").unwrap();
    assert!(file[start..underscore].iter().all(u8::is_ascii_whitespace));
    let data = &file[underscore + 1..];

    let head = String::from_utf8(file[..start].to_vec()).unwrap() + "</AppendedData></VTKFile>";
    let document = roxmltree::Document::parse(&head).unwrap();
    let root = document.root_element();
    assert_eq!(root.tag_name().name(), "VTKFile");
    assert_eq!(root.attribute("type"), Some("UnstructuredGrid"));
    assert_eq!(root.attribute("version"), Some("1.0"));
    assert_eq!(root.attribute("byte_order"), Some("LittleEndian"));
    assert_eq!(root.attribute("header_type"), Some("UInt64"));

    let piece = root
        .descendants()
        .find(|node| node.has_tag_name("Piece"))
        .unwrap();
    let number = |key: &str| piece.attribute(key).unwrap().parse::<usize>().unwrap();
    let mut arrays = BTreeMap::new();
    let mut end = 0;
    for node in piece.descendants().filter(|n| n.has_tag_name("DataArray")) {
        let attribute = |key: &str| node.attribute(key).unwrap();
        assert_eq!(attribute("format"), "appended");
        let offset: usize = attribute("offset").parse().unwrap();
        assert_eq!(offset, end, "blocks follow each other");
        let length = u64::from_le_bytes(data[offset..offset + 8].try_into().unwrap()) as usize;
        end = offset + 8 + length;
        let components: usize = attribute("NumberOfComponents").parse().unwrap();
        let section = node.parent().unwrap().tag_name().name();
        let names = (0..components).filter_map(|i| {
            let name = node.attribute(format!("ComponentName{i}").as_str())?;
            Some(name.to_owned())
        });
        let array = Array {
            kind: attribute("type").to_owned(),
            components,
            component_names: names.collect(),
            bytes: data[offset + 8..end].to_vec(),
        };
        let path = format!("{section}/{}", attribute("Name"));
        assert!(arrays.insert(path, array).is_none(), "an array twice");
    }
    let tail: String = String::from_utf8(data[end..].to_vec()).unwrap();
    let tail: String = tail.split_whitespace().collect();
    assert_eq!(tail, "</AppendedData></VTKFile>");
    Grid {
        n_points: number("NumberOfPoints"),
        n_cells: number("NumberOfCells"),
        arrays,
    }
}

fn find(text: &[u8], pattern: &[u8]) -> Option<usize> {
    text.windows(pattern.len()).position(|w| w == pattern)
}

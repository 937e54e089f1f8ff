//! Code metrics: how long files and functions are, how far types are spread, which files use each
//! other, which doc comments do not stand alone. CONTRIBUTING.md has them.

use super::imports::{Modules, circles, within};
use super::{files, is_test, module, root};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Longest function, in lines with its signature.
const LONGEST: usize = 80;
/// Most files with methods of one type.
const MOST_FILES: usize = 3;
/// Most methods of a type that is not counted as large.
const MOST_METHODS: usize = 25;
/// Types that are large: a number that only falls.
const MOST_LARGE: usize = 7;
/// Shortest doc comment that says something, in characters.
const SHORTEST: usize = 15;
/// What a doc comment that does not stand alone opens with.
const OPENERS: [&str; 5] = ["Those", "That of", "Its", "Their", "The same"];
/// Doc comments shorter than [`SHORTEST`] that are left, most of them lines of `brinell help`.
const MOST_SHORT: usize = 6;
/// Names that more than one type has: a number that only falls.
const MOST_SHARED: usize = 9;

/// A file with its name below the root of its tree.
struct Text {
    name: String,
    text: String,
}

fn texts(base: &Path, folder: &str) -> Vec<Text> {
    let paths = files(&base.join(folder).to_string_lossy(), "rs").into_iter();
    let text = |path: PathBuf| Text {
        name: path.strip_prefix(base).unwrap().display().to_string(),
        text: std::fs::read_to_string(&path).unwrap(),
    };
    paths.map(text).collect()
}

/// Without the tests at the end of a file.
fn of_library(text: &str) -> &str {
    text.split("#[cfg(test)]\nmod tests {").next().unwrap_or("")
}

/// Lines that are neither blank nor comments.
fn lines_of_code(text: &str) -> usize {
    let lines = text.lines().map(str::trim);
    lines
        .filter(|l| !l.is_empty() && !l.starts_with("//"))
        .count()
}

/// Functions with their lines, as rustfmt lays them out: from the signature to the brace below it.
fn functions(text: &str) -> Vec<(String, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut out = Vec::new();
    for (first, line) in lines.iter().enumerate() {
        let code = line.trim_start();
        let indent = &line[..line.len() - code.len()];
        let ahead = code.split("fn ").next().unwrap_or("");
        let words = ["pub", "const", "async", "unsafe", "extern", "\"C\""];
        let is_head = |word: &str| words.contains(&word) || word.starts_with("pub(");
        let is_signature = code.contains("fn ")
            && ahead
                .replace("(in ", "(in_")
                .split_whitespace()
                .all(is_head);
        if !is_signature || code.ends_with('}') || code.ends_with(';') {
            continue;
        }
        let end = format!("{indent}}}");
        // A declaration without a body ends with its parameters.
        let declared = format!("{indent})");
        let is_declared = |l: &&str| l.starts_with(&declared) && l.ends_with(';');
        let mut below = lines[first..].iter();
        if let Some(n) = below.position(|l| **l == end || is_declared(l))
            && !is_declared(&lines[first + n])
        {
            let name = code.split("fn ").nth(1).unwrap_or("");
            let name: String = name
                .chars()
                .take_while(|c| *c != '(' && *c != '<')
                .collect();
            out.push((name, n + 1));
        }
    }
    out
}

/// The type that an inherent implementation is of.
pub(super) fn implemented(line: &str) -> Option<&str> {
    let mut rest = line.strip_prefix("impl")?;
    if rest.starts_with('<') {
        let mut depth = 0;
        let end = rest.char_indices().find(|(_, c)| {
            depth += i32::from(*c == '<') - i32::from(*c == '>');
            depth == 0
        });
        rest = &rest[end?.0 + 1..];
    }
    let rest = rest.trim_start();
    let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_'))?;
    (end > 0 && !rest.contains(" for ")).then(|| &rest[..end])
}

/// The type, trait or alias that a line at the left margin declares.
fn declared_type(line: &str) -> Option<&str> {
    let mut words = line.split_whitespace();
    let is_ahead = |word: &str| word == "unsafe" || word.starts_with("pub") || word.ends_with(')');
    let kind = words.find(|word| !is_ahead(word))?;
    let is_type = ["struct", "enum", "union", "trait", "type"].contains(&kind);
    let name = words.next().filter(|_| is_type && !line.starts_with(' '))?;
    name.split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .next()
}

/// Names that more than one type of a library has, with their number.
fn shared_names(library: &[Text]) -> Vec<String> {
    let mut declared: BTreeMap<&str, usize> = BTreeMap::new();
    for t in library.iter().filter(|t| !is_test(&t.name)) {
        for name in of_library(&t.text).lines().filter_map(declared_type) {
            *declared.entry(name).or_default() += 1;
        }
    }
    let shared = declared.into_iter().filter(|(_, n)| *n > 1);
    shared.map(|(name, n)| format!("{name}: {n}")).collect()
}

/// Whole doc comments.
fn doc_comments(text: &str) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    let mut is_open = false;
    for line in text.lines().map(str::trim) {
        match line.strip_prefix("///") {
            Some(part) if is_open => *out.last_mut().unwrap() += part,
            Some(part) => out.push(part.to_string()),
            None => {}
        }
        is_open = line.starts_with("///");
    }
    out.iter().map(|doc| doc.trim().to_string()).collect()
}

/// Whether a doc comment is too short to say what an item is.
fn is_short(doc: &str) -> bool {
    doc.chars().count() < SHORTEST
}

/// Whether a doc comment opens with a pronoun, and so needs its neighbour to be understood.
fn leans(doc: &str) -> bool {
    let open = |opener: &&str| {
        let rest = doc.strip_prefix(*opener);
        rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric()))
    };
    OPENERS.iter().any(open)
}

/// Types whose methods stand in more than [`MOST_FILES`] files, by folder.
fn spread_types(library: &[Text]) -> Vec<String> {
    let mut types: BTreeMap<(String, &str), BTreeSet<&str>> = BTreeMap::new();
    for t in library {
        let folder = t.name.split('/').nth(1).unwrap_or("").to_string();
        for name in of_library(&t.text).lines().filter_map(implemented) {
            types
                .entry((folder.clone(), name))
                .or_default()
                .insert(&t.name);
        }
    }
    let spread = types.iter().filter(|(_, files)| files.len() > MOST_FILES);
    let spread = spread.map(|((folder, name), files)| format!("{folder} {name}: {}", files.len()));
    spread.collect()
}

/// Types with more than [`MOST_METHODS`] methods, by folder, without those of traits.
fn large_types(library: &[Text]) -> Vec<String> {
    let mut types: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    for t in library.iter().filter(|t| !is_test(&t.name)) {
        let folder = t.name.split('/').nth(1).unwrap_or("");
        let mut of = None;
        for line in of_library(&t.text).lines() {
            of = match line {
                "}" => None,
                _ => implemented(line).or(of),
            };
            let code = line.strip_prefix("    ").unwrap_or("");
            let is_method = !code.starts_with([' ', '/']) && code.contains("fn ");
            if let Some(of) = of.filter(|_| is_method) {
                *types.entry((folder, of)).or_default() += 1;
            }
        }
    }
    let large = types.iter().filter(|(_, n)| **n > MOST_METHODS);
    let large = large.map(|((folder, name), n)| format!("{folder} {name}: {n}"));
    large.collect()
}

/// What is counted of a tree, with the places.
fn counts(base: &Path) -> Vec<(&'static str, usize, Vec<String>)> {
    let library = texts(base, "src");
    // Older trees have benches and examples among the tests.
    let beside = ["tests", "benches", "examples"].into_iter();
    let there = beside.filter(|folder| base.join(folder).is_dir());
    let tests: Vec<Text> = there.flat_map(|folder| texts(base, folder)).collect();
    let all = || library.iter().chain(&tests);
    let total = |texts: &[Text], is_code: fn(&Text) -> bool| -> usize {
        let texts = texts.iter().filter(|t| is_code(t));
        texts.map(|t| lines_of_code(of_library(&t.text))).sum()
    };
    let long_files = all().filter(|t| t.text.lines().count() > 500);
    let long_files: Vec<String> = long_files.map(|t| t.name.clone()).collect();
    let long = |texts: &[Text]| -> Vec<String> {
        let of = |t: &Text| {
            let long = functions(&t.text).into_iter().filter(|(_, n)| *n > LONGEST);
            long.map(|(name, n)| format!("{}: {name}, {n}", t.name))
                .collect::<Vec<_>>()
        };
        texts.iter().flat_map(of).collect()
    };
    let (spread, large) = (spread_types(&library), large_types(&library));
    let modules = Modules::read(base);
    let edges = modules.edges();
    let folders: BTreeSet<&str> = edges.keys().filter_map(|f| f.split('/').nth(1)).collect();
    let circles = folders
        .iter()
        .flat_map(|folder| circles(&within(&edges, folder)).into_iter().flatten());
    let circles: Vec<String> = circles.map(String::from).collect();
    let docs = || library.iter().flat_map(|t| doc_comments(&t.text));
    let short: Vec<String> = docs().filter(|doc| is_short(doc)).collect();
    let leaning: Vec<String> = docs().filter(|doc| leans(doc)).collect();
    let (long_here, long_tests) = (long(&library), long(&tests));
    let shared = shared_names(&library);
    vec![
        (
            "lines of code in src",
            total(&library, |t| !is_test(&t.name)),
            Vec::new(),
        ),
        (
            "lines of code in tests, benches, examples",
            total(&tests, |_| true),
            Vec::new(),
        ),
        ("files of more than 500 lines", long_files.len(), long_files),
        (
            "functions of more than 80 lines in src",
            long_here.len(),
            long_here,
        ),
        (
            "functions of more than 80 lines beside src",
            long_tests.len(),
            long_tests,
        ),
        (
            "types with methods in more than three files",
            spread.len(),
            spread,
        ),
        ("types with more than 25 methods", large.len(), large),
        (
            "files of src in import circles of their folder",
            circles.len(),
            circles,
        ),
        ("type names that mean several things", shared.len(), shared),
        (
            "doc comments of less than 15 characters",
            short.len(),
            short,
        ),
        (
            "doc comments that open with a pronoun",
            leaning.len(),
            leaning,
        ),
    ]
}

/// The figures of CONTRIBUTING.md: `cargo test --test all drift::house -- --nocapture` prints them,
/// of another tree with `HOUSE_OF=PATH`, and `HOUSE_PLACES=1` adds the places.
#[test]
fn figures_of_the_house_are_in_contributing() {
    let base = std::env::var_os("HOUSE_OF").map_or_else(root, PathBuf::from);
    let found = counts(&base);
    for (what, count, places) in &found {
        println!("{what}: {count}");
        if std::env::var_os("HOUSE_PLACES").is_some() {
            places.iter().for_each(|place| println!("    {place}"));
        }
    }
    let page = std::fs::read_to_string(root().join("CONTRIBUTING.md")).unwrap();
    for (what, ..) in &found {
        let head = format!("| {what} |");
        let row = page.lines().find_map(|line| line.strip_prefix(&head));
        let row = row.unwrap_or_else(|| panic!("CONTRIBUTING.md has no row `{what}`"));
        let cells = row.trim_end_matches([' ', '|']).split('|');
        let told = cells.map(|cell| cell.replace(',', "").trim().parse::<usize>());
        let told: Vec<usize> = told
            .collect::<Result<_, _>>()
            .unwrap_or_else(|error| panic!("{what}: {row}: {error}"));
        assert_eq!(told.len(), 2, "{what}: before and now, not {row}");
    }
}

/// In rustdoc a reader sees one doc comment without its neighbours.
#[test]
fn doc_comments_stand_alone() {
    let library = texts(&root(), "src");
    let of = |is_meant: fn(&str) -> bool| -> Vec<String> {
        let of_file = |t: &Text| {
            let docs = doc_comments(&t.text).into_iter();
            let docs = docs.filter(|doc| is_meant(doc));
            docs.map(|doc| format!("{}: {doc}", t.name))
                .collect::<Vec<_>>()
        };
        library.iter().flat_map(of_file).collect()
    };
    let (leaning, short) = (of(leans), of(is_short));
    assert!(
        leaning.is_empty(),
        "name the thing instead of pointing at it with one of {OPENERS:?}: {leaning:#?}"
    );
    assert!(
        short.len() <= MOST_SHORT,
        "say what the item is in {SHORTEST} characters or more: {short:#?}"
    );
}

/// A name that two types have is looked up twice by whoever reads it.
#[test]
fn names_mean_no_more_types_than_they_did() {
    let shared = shared_names(&texts(&root(), "src"));
    assert!(
        shared.len() <= MOST_SHARED,
        "give the new type a name of its own: {shared:#?}"
    );
}

/// Whoever looks for a method of a type has few files to look through.
#[test]
fn methods_of_a_type_stand_in_few_files() {
    let spread = spread_types(&texts(&root(), "src"));
    assert!(
        spread.is_empty(),
        "give what several files add to a type objects of their own: {spread:#?}"
    );
    let large = large_types(&texts(&root(), "src"));
    assert!(
        large.len() <= MOST_LARGE,
        "give a part of these methods to a type of their own: {large:#?}"
    );
}

/// A file can be read after those that it uses.
#[test]
fn files_of_a_folder_use_each_other_in_no_circle() {
    let modules = Modules::read(&root());
    let edges = modules.edges();
    let folders: BTreeSet<&str> = edges.keys().map(|file| module(file)).collect();
    let of_folder = |folder: &&str| circles(&within(&edges, folder));
    let found: Vec<_> = folders.iter().flat_map(of_folder).collect();
    assert!(
        found.is_empty(),
        "move what several files need below them, or what needs them above: {found:#?}"
    );
}

/// The model resolves the load program and the settings once: modules after it read these, and not
/// the entries of the scene.
#[test]
fn the_analysis_reads_the_resolved_program() {
    let folders = ["analysis", "constrained", "output", "substructure"];
    let texts = folders.map(|folder| texts(&root(), &format!("src/{folder}")));
    let mut n_models = 0;
    for file in texts.iter().flatten().filter(|file| !is_test(&file.name)) {
        let code: String = of_library(&file.text).split_whitespace().collect();
        n_models += code.matches("model.program.").count();
        for entry in ["scene.program", "scene.analysis", "scene.stepping()"] {
            assert!(!code.contains(entry), "{}: {entry}", file.name);
        }
    }
    assert!(n_models > 0);
}

#[test]
fn functions_types_and_comments_are_counted() {
    let text = "\
impl<'a, T: Into<B>> Long<'a> {
    /// Its
    /// length.
    pub(in crate::a) fn first(
        x: usize,
    ) -> bool {
        x > 1
    }

    fn short() {}
}
impl From<A> for B {
}
pub trait T {
    fn declared(
        x: usize,
    ) -> bool;

    /// Two.
    fn second() {
        let f = 1;
    }
}
";
    let found = functions(text);
    assert_eq!(found, [("first".to_string(), 5), ("second".to_string(), 3)]);
    let types: Vec<&str> = text.lines().filter_map(implemented).collect();
    assert_eq!(types, ["Long"]);
    assert_eq!(doc_comments(text), ["Its length.", "Two."]);
    assert!(leans("Its length.") && leans("The same, larger.") && leans("Those"));
    assert!(!leans("Itself a length.") && !leans("Length of those."));
    assert!(is_short("Two.") && !is_short("Number of pairs."));
    let declared = [
        "pub(in crate::a) struct One<T>(T);",
        "unsafe trait Two {",
        "type Three = u8;",
    ];
    let declared: Vec<_> = declared.into_iter().filter_map(declared_type).collect();
    assert_eq!(declared, ["One", "Two", "Three"]);
    assert!(declared_type("    type Item = u8;").is_none() && declared_type("}").is_none());
    assert_eq!(lines_of_code("a\n\n// b\n    c // d\n"), 2);
}

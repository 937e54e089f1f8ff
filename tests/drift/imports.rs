//! Which file of `src` uses which: paths of Rust, followed through re-exports to the file that
//! defines what they name.

use super::house::implemented;
use super::{code, files, is_test, module, root};
use std::collections::{BTreeMap, BTreeSet};

/// The path of a module below the crate.
type Path = Vec<String>;

/// A file of the library with what decides where its paths lead.
struct Source {
    file: String,
    /// Without comments, tests and `use`.
    code: String,
    uses: Vec<Use>,
}

/// A name that `use` binds.
struct Use {
    path: Path,
    bound: String,
    is_public: bool,
}

/// The modules of the library.
pub(super) struct Modules(BTreeMap<Path, Source>);

impl Modules {
    /// The modules below `src`, tests left out: these look at whatever they test.
    pub(super) fn read(base: &std::path::Path) -> Self {
        let mut modules = BTreeMap::new();
        for path in files(&base.join("src").to_string_lossy(), "rs") {
            let name = path.strip_prefix(base).unwrap();
            let name = name.to_string_lossy().replace('\\', "/");
            if !is_test(&name) && name != "src/main.rs" {
                let text = code(&path);
                // Tests stand at the end, whatever they are compiled for.
                let text = text.split("\nmod tests {").next();
                modules.insert(module_path(&name), Source::of(&name, text.unwrap_or("")));
            }
        }
        Modules(modules)
    }

    /// Modules of the given names and texts.
    fn of(texts: &[(&str, &str)]) -> Self {
        let sources = texts.iter();
        Modules(
            sources
                .map(|(file, text)| (module_path(file), Source::of(file, text)))
                .collect(),
        )
    }

    /// The files that each file uses, itself left out.
    pub(super) fn edges(&self) -> BTreeMap<&str, BTreeSet<&str>> {
        let of = |(path, source): (&Path, &'_ Source)| {
            let targets = self.named_in(path, source);
            let others = targets.into_iter().filter(|target| *target != path);
            let files = others.filter_map(|target| self.0.get(target));
            let files: BTreeSet<&str> = files.map(|source| source.file.as_str()).collect();
            files
        };
        let modules = self.0.iter();
        modules
            .map(|(path, source)| (source.file.as_str(), of((path, source))))
            .collect()
    }

    /// The modules that a file names. A re-export is a use only where the file itself makes use of
    /// what it binds.
    fn named_in<'a>(&'a self, path: &Path, source: &Source) -> Vec<&'a Path> {
        let words: BTreeSet<&str> = words(&source.code).collect();
        let used = source.uses.iter();
        let used = used.filter(|found| !found.is_public || words.contains(found.bound.as_str()));
        let mut found: Vec<&Path> = used
            .filter_map(|found| self.resolve(path, &found.path, 0))
            .collect();
        for inline in inline_paths(&source.code) {
            let is_child = self.0.contains_key(&joined(path, &inline[..1]));
            let anchored = ["crate", "super", "self"].contains(&inline[0].as_str());
            if is_child || anchored {
                found.extend(self.resolve(path, &inline, 0));
            }
        }
        found
    }

    /// The module that defines what a path names, seen from the module `from`; `None` where that is
    /// another crate's.
    fn resolve(&self, from: &[String], path: &[String], depth: usize) -> Option<&Path> {
        let (mut at, mut rest) = match path.first()?.as_str() {
            "crate" => (Vec::new(), &path[1..]),
            "self" => (from.to_vec(), &path[1..]),
            "super" => (from[..from.len().checked_sub(1)?].to_vec(), &path[1..]),
            first => {
                let bound = self.0.get(from)?.uses.iter().any(|u| u.bound == first);
                let known = bound || self.0.contains_key(&joined(from, &path[..1]));
                (from.to_vec(), known.then_some(path)?)
            }
        };
        while rest.first().is_some_and(|segment| segment == "super") {
            at.pop()?;
            rest = &rest[1..];
        }
        while let Some(segment) = rest.first() {
            let below = joined(&at, &rest[..1]);
            if self.0.contains_key(&below) {
                (at, rest) = (below, &rest[1..]);
                continue;
            }
            let source = self.0.get(&at)?;
            let bound = source.uses.iter().find(|found| found.bound == *segment);
            if let Some(bound) = bound.filter(|_| depth < 9) {
                let through = joined(&bound.path, &rest[1..]);
                if let Some(found) = self.resolve(&at, &through, depth + 1) {
                    return Some(found);
                }
            }
            break;
        }
        self.0.get_key_value(&at).map(|(path, _)| path)
    }
}

impl Source {
    fn of(file: &str, text: &str) -> Self {
        // Who may see an item is no use of a module.
        let text = text.replace("pub(in crate::", "pub(in_");
        let text = text.as_str();
        let mut uses = Vec::new();
        let mut code = String::new();
        let mut rest = text;
        while let Some((before, is_public, tree, after)) = next_use(rest) {
            code.push_str(before);
            expand(&[], tree, is_public, &mut uses);
            rest = after;
        }
        code.push_str(rest);
        // The declaration of a module does not use it.
        let is_used = |line: &&str| !(line.contains("mod ") && line.ends_with(';'));
        let code = code.lines().filter(is_used).collect::<Vec<_>>().join("\n");
        Source {
            file: file.to_string(),
            code,
            uses,
        }
    }
}

/// The module of a file: `src/mesh/gmsh/mod.rs` to `[mesh, gmsh]`.
fn module_path(file: &str) -> Path {
    let below = file.trim_start_matches("src/").trim_end_matches(".rs");
    let parts = below
        .split('/')
        .filter(|part| !["mod", "lib"].contains(part));
    parts.map(String::from).collect()
}

fn joined(path: &[String], rest: &[String]) -> Path {
    path.iter().chain(rest).cloned().collect()
}

fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c: char| !(c.is_alphanumeric() || c == '_'))
}

/// What stands before the next `use` of a text, whether that is a re-export, its tree, and what
/// follows.
fn next_use(text: &str) -> Option<(&str, bool, &str, &str)> {
    let mut from = 0;
    loop {
        let at = from + text[from..].find("use ")?;
        let line = text[..at].rfind('\n').map_or(0, |end| end + 1);
        let ahead = text[line..at].trim();
        from = at + "use ".len();
        if ahead.is_empty() || ahead.starts_with("pub") {
            let end = from + text[from..].find(';')?;
            return Some((
                &text[..line],
                !ahead.is_empty(),
                &text[from..end],
                &text[end + 1..],
            ));
        }
    }
}

/// The names that a tree of `use` binds.
fn expand(prefix: &[String], tree: &str, is_public: bool, out: &mut Vec<Use>) {
    let tree = tree.trim();
    // Nothing follows the last comma of a list.
    if tree.is_empty() {
        return;
    }
    if let Some(open) = tree.find('{') {
        let ahead = tree[..open].split("::").map(str::trim);
        let ahead: Path = ahead
            .filter(|part| !part.is_empty())
            .map(String::from)
            .collect();
        let inner = tree[open + 1..].trim_end().trim_end_matches('}');
        let inner = &tree[open + 1..open + 1 + inner.len()];
        let mut depth = 0usize;
        let mut start = 0;
        for (at, c) in inner.char_indices().chain([(inner.len(), ',')]) {
            match c {
                '{' => depth += 1,
                '}' => depth = depth.saturating_sub(1),
                ',' if depth == 0 || at == inner.len() => {
                    expand(&joined(prefix, &ahead), &inner[start..at], is_public, out);
                    start = at + 1;
                }
                _ => {}
            }
        }
        return;
    }
    let (tree, name) = tree.split_once(" as ").unwrap_or((tree, ""));
    let parts = tree
        .split("::")
        .map(str::trim)
        .filter(|part| !part.is_empty());
    let mut path = joined(prefix, &parts.map(String::from).collect::<Vec<_>>());
    if path
        .last()
        .is_some_and(|last| last == "self" || last == "*")
    {
        path.pop();
    }
    let Some(last) = path.last().cloned() else {
        return;
    };
    let bound = if name.is_empty() {
        last
    } else {
        name.trim().to_string()
    };
    out.push(Use {
        path,
        bound,
        is_public,
    });
}

/// Paths of more than one segment in code.
fn inline_paths(code: &str) -> Vec<Path> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut out = Vec::new();
    let mut rest = code;
    while let Some(at) = rest.find("::") {
        let start = rest[..at]
            .rfind(|c| !is_word(c))
            .map_or(0, |before| before + 1);
        let mut path = vec![rest[start..at].to_string()];
        let mut after = &rest[at..];
        while let Some(next) = after.strip_prefix("::") {
            let end = next.find(|c| !is_word(c)).unwrap_or(next.len());
            if end == 0 {
                after = next;
                break;
            }
            path.push(next[..end].to_string());
            after = &next[end..];
        }
        if path.len() > 1 && !path[0].is_empty() {
            out.push(path);
        }
        rest = after;
    }
    out
}

/// Groups of files that use each other, directly or through others of the group.
pub(super) fn circles<'a>(edges: &BTreeMap<&'a str, BTreeSet<&'a str>>) -> Vec<Vec<&'a str>> {
    let reach = |from: &'a str| {
        let mut seen = BTreeSet::new();
        let mut ahead = vec![from];
        while let Some(file) = ahead.pop() {
            let next = edges.get(file).into_iter().flatten();
            ahead.extend(next.filter(|file| seen.insert(**file)));
        }
        seen
    };
    let reached: BTreeMap<&str, BTreeSet<&str>> = edges.keys().map(|f| (*f, reach(f))).collect();
    let mut out: Vec<Vec<&str>> = Vec::new();
    for (file, seen) in &reached {
        let known = out.iter().any(|circle| circle.contains(file));
        if seen.contains(file) && !known {
            let back = seen.iter().filter(|other| reached[**other].contains(file));
            out.push(back.copied().collect());
        }
    }
    out
}

/// The files of a folder of `src` and what they use of each other.
pub(super) fn within<'a>(
    edges: &BTreeMap<&'a str, BTreeSet<&'a str>>,
    folder: &str,
) -> BTreeMap<&'a str, BTreeSet<&'a str>> {
    let of_folder = |file: &&str| **file != *"src/lib.rs" && module(file) == folder;
    let kept = edges.iter().filter(|(file, _)| of_folder(file));
    kept.map(|(file, used)| {
        (
            *file,
            used.iter().copied().filter(|f| of_folder(f)).collect(),
        )
    })
    .collect()
}

/// Paths lead to the file that defines what they name, whichever way they are written.
#[test]
fn paths_are_followed_to_the_file_that_defines() {
    let modules = Modules::of(&[
        ("src/lib.rs", "pub mod a; mod b; pub use a::one::Deep;"),
        (
            "src/a/mod.rs",
            "mod one;\nmod two;\npub use one::{Deep, Other as Another};\npub use two::two;",
        ),
        (
            "src/a/one.rs",
            "use super::two::{\n    self, Item,\n};\nfn f() { two::g() }",
        ),
        (
            "src/a/two.rs",
            "fn g() { let x = super::Another::new(); crate::b::h() }",
        ),
        (
            "src/b.rs",
            "use crate::{a::{Deep}};\nuse std::fmt;\npub fn h() {}",
        ),
    ]);
    let edges = modules.edges();
    let used = |file: &str| edges[file].iter().copied().collect::<Vec<_>>();
    assert_eq!(used("src/a/mod.rs"), [""; 0], "a re-export alone is no use");
    assert_eq!(used("src/a/one.rs"), ["src/a/two.rs"]);
    assert_eq!(used("src/a/two.rs"), ["src/a/one.rs", "src/b.rs"]);
    assert_eq!(used("src/b.rs"), ["src/a/one.rs"]);
    let all = circles(&edges);
    assert_eq!(all, [["src/a/one.rs", "src/a/two.rs", "src/b.rs"]]);
    let of_a = circles(&within(&edges, "a"));
    assert_eq!(of_a, [["src/a/one.rs", "src/a/two.rs"]]);
}

/// The rooms of `analysis`, from the bottom.
fn rooms() -> Vec<String> {
    let text = code(&root().join("src/analysis/mod.rs"));
    let declared = text
        .lines()
        .filter_map(|line| line.strip_prefix("mod ")?.strip_suffix(';'));
    declared.map(String::from).collect()
}

fn room_of(rooms: &[String], file: &str) -> Option<usize> {
    let room = file.strip_prefix("src/analysis/")?.split('/').next()?;
    rooms.iter().position(|other| other == room)
}

/// Inside `analysis` a room imports only from itself and from rooms declared above it in its
/// `mod.rs`, and no two files use each other.
#[test]
fn rooms_of_analysis_import_from_above_only() {
    let rooms = rooms();
    assert_eq!(rooms.len(), 8, "{rooms:?}");
    let place = |file: &str| room_of(&rooms, file);
    let modules = Modules::read(&root());
    let edges = modules.edges();
    let mut wrong = Vec::new();
    for (file, used) in &edges {
        let Some(own) = place(file) else { continue };
        let below = used.iter().filter(|other| {
            // What `analysis` itself defines stands below all rooms.
            **other == "src/analysis/mod.rs" || place(other).is_some_and(|room| room > own)
        });
        wrong.extend(below.map(|other| format!("{file} uses {other}, which stands below")));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    let circles = circles(&within(&edges, "analysis"));
    assert!(
        circles.is_empty(),
        "files that use each other: {circles:#?}"
    );
    // The files are seen at all.
    let inner = within(&edges, "analysis");
    assert!(inner.values().map(BTreeSet::len).sum::<usize>() > 200);
}

/// What a room adds to a type of another room is not called by those above it: a method is no way
/// round the order. Names that several types have are left out.
#[test]
fn methods_that_a_room_adds_are_not_called_from_above() {
    let modules = Modules::read(&root());
    let in_analysis = |source: &&Source| source.file.starts_with("src/analysis/");
    let sources: Vec<&Source> = modules.0.values().filter(in_analysis).collect();
    let rooms = rooms();
    let mut homes = BTreeMap::new();
    let mut methods: BTreeMap<&str, Vec<(&str, usize)>> = BTreeMap::new();
    for source in &sources {
        let Some(room) = room_of(&rooms, &source.file) else {
            continue;
        };
        let mut of = None;
        for line in source.code.lines() {
            let item = line
                .split_once("struct ")
                .or_else(|| line.split_once("enum "));
            if let Some((_, item)) = item.filter(|_| !line.starts_with(' ')) {
                homes.insert(words(item).next().unwrap_or(""), room);
            }
            if !line.starts_with(' ') {
                of = implemented(line).or(of.filter(|_| line != "}"));
            }
            let method = line
                .strip_prefix("    ")
                .filter(|rest| !rest.starts_with(' '));
            let method = method.and_then(|rest| rest.split_once("fn "));
            if let (Some(of), Some((_, rest))) = (of, method) {
                let name = words(rest).next().unwrap_or("");
                methods.entry(name).or_default().push((of, room));
            }
        }
    }
    let mut added = 0;
    let mut wrong = Vec::new();
    for (name, of) in &methods {
        let [(of, room)] = of[..] else { continue };
        if homes.get(of).is_none_or(|home| *home >= room) {
            continue;
        }
        added += 1;
        let calls = [format!(".{name}("), format!("::{name}(")];
        for source in &sources {
            let is_above = room_of(&rooms, &source.file).is_some_and(|other| other < room);
            if is_above && calls.iter().any(|call| source.code.contains(call)) {
                wrong.push(format!(
                    "{} calls {of}::{name} of a room below",
                    source.file
                ));
            }
        }
    }
    assert!(added > 0, "no method is found");
    assert!(wrong.is_empty(), "{wrong:#?}");
}

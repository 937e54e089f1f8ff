//! Scenes with random damage: whatever it is, the program ends with a documented exit code.

use super::{brinell, scene_path, stderr};
use std::time::{Duration, Instant};

/// Small and quick scenes to damage.
const SCENES: [&str; 4] = [
    "contact_patch",
    "gmsh_blocks",
    "shrink_fit",
    "thick_cylinder",
];
const MUTATIONS: usize = 300;
const TIME: Duration = Duration::from_secs(20);

/// SplitMix64 (Steele, Lea and Flood 2014, doi:10.1145/2714064.2660195).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }

    fn pick<'a>(&mut self, from: &[&'a str]) -> &'a str {
        from[self.below(from.len())]
    }
}

/// One damage: a line lost, doubled or moved, a value replaced, characters changed.
fn damage(text: &str, random: &mut Random) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_string).collect();
    let at = random.below(lines.len());
    match random.below(6) {
        0 => {
            lines.remove(at);
        }
        1 => lines.insert(at, lines[at].clone()),
        2 => {
            let other = random.below(lines.len());
            lines.swap(at, other);
        }
        3 | 4 => {
            let value = random.pick(&[
                "0",
                "-1",
                "1",
                "2",
                "1e-300",
                "1e300",
                "-1e30",
                "nan",
                "inf",
                "true",
                "\"x\"",
                "[]",
                "{}",
                "[1.0, 2.0]",
                "9223372036854775807",
                "\"\"",
                "0.5",
                "1e-12",
                "[0, 0]",
                "\"upper.top\"",
                "\"constant\"",
            ]);
            let assigned: Vec<usize> = (0..lines.len())
                .filter(|&i| lines[i].contains(" = "))
                .collect();
            let at = assigned[random.below(assigned.len())];
            // The last value of the line: often the inner one of a table or list.
            let places: Vec<usize> = lines[at].match_indices(" = ").map(|(i, _)| i).collect();
            let place = places[random.below(places.len())];
            let rest = lines[at][place + 3..].to_string();
            let end = rest.find([',', '}', '#']).unwrap_or(rest.len());
            lines[at] = format!("{} = {value} {}", &lines[at][..place], &rest[end..]);
        }
        _ => {
            let mut bytes = lines[at].clone().into_bytes();
            if !bytes.is_empty() {
                let k = random.below(bytes.len());
                bytes[k] = b" !\"#.0129=[]{}azEe-+_\\\t"[random.below(23)];
            }
            lines[at] = String::from_utf8_lossy(&bytes).into_owned();
        }
    }
    lines.join("\n")
}

#[test]
fn damaged_scenes_end_with_documented_exit_codes() {
    let begin = Instant::now();
    let mut random = Random(20);
    let folder = tempfile::tempdir().unwrap();
    let (path, out) = (folder.path().join("scene.toml"), folder.path().join("out"));
    let (path, out) = (path.to_str().unwrap(), out.to_str().unwrap());
    std::fs::create_dir(folder.path().join("meshes")).unwrap();
    let meshes = concat!(env!("CARGO_MANIFEST_DIR"), "/data/meshes/two_blocks.msh");
    std::fs::copy(meshes, folder.path().join("meshes/two_blocks.msh")).unwrap();
    let mut codes = std::collections::BTreeMap::new();
    for number in 0..MUTATIONS {
        if begin.elapsed() > TIME {
            break;
        }
        let name = SCENES[number % SCENES.len()];
        let mut text = std::fs::read_to_string(scene_path(name)).unwrap();
        text = text
            .replace("../meshes", "meshes")
            .replace("[16, 16]", "[3, 3]");
        text = text.replace(
            "    { load_factor = 180.0 },\n    { load_factor = 190.0 },\n",
            "",
        );
        for _ in 0..1 + random.below(2) {
            text = damage(&text, &mut random);
        }
        std::fs::write(path, &text).unwrap();
        // Elastic and plastic runs alike; the plastic ones are bounded by few increments.
        let output = brinell(&[
            "run",
            path,
            "--quiet",
            "--threads",
            "1",
            "--solver",
            "dense",
            "--out",
            out,
        ]);
        let stderr = stderr(&output);
        let code = output.status.code().unwrap_or(-1);
        assert!(
            [0, 2, 3, 4, 5, 6].contains(&code),
            "exit code {code} in damage {number} of {name}: {stderr}\n{text}"
        );
        assert_eq!(code == 0, stderr.is_empty(), "{code} {stderr}");
        assert!(!stderr.contains("internal"), "{stderr}\n{text}");
        *codes.entry(code).or_insert(0) += 1;
        if code == 0 || code >= 5 {
            let _ = std::fs::remove_dir_all(out);
        }
        assert!(
            !std::path::Path::new(out).exists(),
            "exit code {code} left results behind"
        );
    }
    // The damage is neither always fatal nor never.
    assert!(
        codes.contains_key(&0) && codes.contains_key(&2),
        "{codes:?}"
    );
}

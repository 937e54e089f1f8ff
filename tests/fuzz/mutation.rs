//! Random damage to texts, the same for the same seed.

/// SplitMix64 (Steele, Lea and Flood 2014, doi:10.1145/2714064.2660195).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

/// Values that break programs: ends of number ranges, no numbers, other types, names that stand
/// elsewhere.
const VALUES: [&str; 44] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "3",
    "255",
    "65536",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "9223372036854775808",
    "-9223372036854775808",
    "18446744073709551615",
    "18446744073709551616",
    "1e-300",
    "5e-324",
    "1e300",
    "1e309",
    "-1e30",
    "1e-12",
    "0.5",
    "nan",
    "-inf",
    "inf",
    "true",
    "false",
    "\"x\"",
    "\"\"",
    "[]",
    "{}",
    "[[]]",
    "[1.0, 2.0]",
    "[0, 0]",
    "[1e9, 1e9]",
    "{ x = 1 }",
    "\"upper.top\"",
    "\"constant\"",
    "\"1 %\"",
    "1979-05-27",
    "0x7fffffff",
    "1_000",
];
/// Characters with a meaning.
const SIGNS: &[u8] = b" !\"#.0129=[]{}azEe-+_\\\t\n$";
/// What is repeated thousands of times.
const REPEATED: [&str; 8] = ["[", "{ a = ", "9", "a.", "(", "\"", "\n", "[[a]]\n"];

/// One to four damages, mostly one. `others` are texts to take pieces from.
pub fn damaged(text: &[u8], others: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    let mut out = text.to_vec();
    for _ in 0..1 + random.below(4) * random.below(2) {
        out = damage(out, others, random);
    }
    out
}

fn damage(mut text: Vec<u8>, others: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    if text.is_empty() {
        return vec![random.next() as u8];
    }
    let at = random.below(text.len());
    match random.below(24) {
        0 => {
            let end = (at + 1 + random.below(20)).min(text.len());
            text.drain(at..end);
        }
        1 => text[at] = random.next() as u8,
        2 => text[at] = SIGNS[random.below(SIGNS.len())],
        3 => {
            let bytes: Vec<u8> = (0..1 + random.below(12))
                .map(|_| random.next() as u8)
                .collect();
            text.splice(at..at, bytes);
        }
        4 => text.truncate(at),
        // Seldom: long texts are slow.
        5 if random.below(8) == 0 => {
            let times = 10usize.pow(1 + random.below(4) as u32);
            let piece = REPEATED[random.below(REPEATED.len())].repeat(times);
            text.splice(at..at, piece.into_bytes());
        }
        5..=9 => return lines(&text, others, random),
        10..=19 => replace_word(&mut text, random),
        _ => replace_value(&mut text, random),
    }
    text
}

/// Lines lost, doubled, moved, or those of another text.
fn lines(text: &[u8], others: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    let mut lines: Vec<&[u8]> = text.split_inclusive(|b| *b == b'\n').collect();
    let (a, b) = (random.below(lines.len()), random.below(lines.len()));
    match random.below(5) {
        0 => {
            lines.remove(a);
        }
        1 => lines.insert(b, lines[a]),
        2 => lines.swap(a, b),
        3 => {
            lines.drain(a.min(b)..a.max(b));
        }
        _ => {
            let other = &others[random.below(others.len())];
            let other: Vec<&[u8]> = other.split_inclusive(|b| *b == b'\n').collect();
            let from = random.below(other.len());
            let to = (from + 1 + random.below(8)).min(other.len());
            lines.splice(a..a, other[from..to].iter().copied());
        }
    }
    lines.concat()
}

/// A number or word between blanks and punctuation becomes something else.
fn replace_word(text: &mut Vec<u8>, random: &mut Random) {
    let is_inside = |b: &u8| b.is_ascii_alphanumeric() || b"._+-".contains(b);
    let at = random.below(text.len());
    let Some(begin) = (at..text.len()).find(|&i| is_inside(&text[i])) else {
        return;
    };
    let begin = (0..begin)
        .rev()
        .take_while(|&i| is_inside(&text[i]))
        .last()
        .unwrap_or(begin);
    let end = (begin..text.len())
        .find(|&i| !is_inside(&text[i]))
        .unwrap_or(text.len());
    let value: Vec<u8> = match random.below(3) {
        // Another word of the same text.
        0 => {
            let other = random.below(text.len());
            text[other..]
                .iter()
                .copied()
                .take_while(|b| is_inside(b))
                .collect()
        }
        _ => VALUES[random.below(VALUES.len())].into(),
    };
    text.splice(begin..end, value);
}

/// What stands behind an equals sign becomes something else, to the end of the line or the next
/// comma.
fn replace_value(text: &mut Vec<u8>, random: &mut Random) {
    let at = random.below(text.len());
    let Some(equals) = (at..text.len()).find(|&i| text[i] == b'=') else {
        return;
    };
    let end = (equals..text.len())
        .find(|&i| b",}\n#".contains(&text[i]))
        .unwrap_or(text.len());
    let value = format!(" {} ", VALUES[random.below(VALUES.len())]);
    text.splice(equals + 1..end, value.into_bytes());
}

//! The word that was meant, where a misspelt one was given.

/// The known word closest to `word`, provided that at most a third of its letters differ.
pub(crate) fn closest<'k>(word: &str, known: &[&'k str]) -> Option<&'k str> {
    let lower = word.to_lowercase();
    let distance = |k: &str| {
        let [a, b] = [word, &lower].map(|word| strsim::damerau_levenshtein(word, k));
        a.min(b)
    };
    known
        .iter()
        .map(|k| (distance(k), *k))
        .filter(|(distance, k)| 3 * distance <= k.chars().count().max(3))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, k)| k)
}

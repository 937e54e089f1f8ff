//! Meaning of MUMPS's error numbers, with a remedy.
//!
//! # Source
//! MUMPS 5.5 users' guide, section 8.

/// Describes INFOG(1) and INFOG(2), and the rank that reports them.
pub(super) fn meaning(code: i32, more: i32, rank: Option<usize>) -> String {
    // Negative sizes are in millions.
    let size = match more {
        more if more < 0 => format!("{} million", -i64::from(more)),
        more => more.to_string(),
    };
    let (what, remedy) = match code {
        -6 => (
            "the matrix is singular in structure",
            "a part of the model is not held",
        ),
        -5 | -7 | -13 => (
            "a rank has no memory for its work",
            "use more ranks, more memory for each, or a coarser mesh",
        ),
        -8 | -9 | -11 | -14 | -17 | -20 => (
            "the workspace that was estimated is too small",
            "use more ranks or another number of them",
        ),
        -10 | -40 => (
            "a pivot is zero",
            "a part of the model is hardly held: check supports and contacts",
        ),
        -19 => (
            "the memory that a rank may take is too small",
            "use more ranks or a coarser mesh",
        ),
        -90 => (
            "files for the factor cannot be written",
            "see the system's messages",
        ),
        _ => (
            "the factorisation failed",
            "please report it with the scene that caused it",
        ),
    };
    let on = rank.map_or(String::new(), |rank| format!("rank {rank}, "));
    format!("MUMPS: {what} ({on}INFOG(1) = {code}, INFOG(2) = {size}): {remedy}")
}

#[cfg(test)]
mod tests {
    use super::meaning;

    #[test]
    fn numbers_have_words_and_a_remedy() {
        let text = meaning(-13, -250, Some(2));
        assert!(
            text.contains("no memory") && text.contains("rank 2") && text.contains("250 million"),
            "{text}"
        );
        assert!(text.contains("more ranks"), "{text}");
        assert!(meaning(-10, 7, None).contains("hardly held"));
        assert!(meaning(-3, 0, None).contains("please report"));
    }
}

//! Programs of others that tests run where they are installed.

/// Whether a program is on the path. One that `BRINELL_TOOLS` lists (words apart by blanks) must
/// be: its absence fails the test, which else would pass without having tested anything.
#[track_caller]
pub fn has(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let is_there = std::env::split_paths(&path).any(|folder| folder.join(program).is_file());
    let expected = std::env::var("BRINELL_TOOLS").unwrap_or_default();
    assert!(
        is_there || !expected.split_whitespace().any(|word| word == program),
        "`{program}` is listed in BRINELL_TOOLS and is not on the path"
    );
    if !is_there {
        println!("skipped: there is no {program} on this machine");
    }
    is_there
}

/// The name by which a program is there, of those that it goes by.
#[track_caller]
pub fn first_of(names: &[&'static str]) -> Option<&'static str> {
    names.iter().copied().find(|name| has(name))
}

/// Lets a program compute with the kernels of this process: bits depend on them.
pub fn with_these_kernels(command: &mut std::process::Command) -> &mut std::process::Command {
    if let Some(kernels) = brinell::linalg::Backend::default().kernels() {
        command.env("OPENBLAS_CORETYPE", kernels);
    }
    command
}

#[test]
fn a_program_on_the_path_is_found_and_another_is_not() {
    assert!(has("cargo") && !has("no such program"));
    assert_eq!(first_of(&["no such program", "cargo"]), Some("cargo"));
}

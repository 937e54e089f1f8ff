//! The directory appears whole or not at all, and nobody else's files are touched.

use crate::output::fixture;
use brinell::output::{Claim, check_directory, mark_stale, stale, write};
use brinell::results::Results;
use brinell::{Error, ErrorKind};
use std::error::Error as _;
use std::fs;
use std::path::Path;

/// Names in a directory, sorted.
fn names(dir: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(dir)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn write_fixture(dir: &Path) -> Result<(), Error> {
    let mesh = fixture::mesh();
    write(dir, &fixture::header(), &mesh, &fixture::results(&mesh))
}

fn write_minimal(dir: &Path) -> Result<(), Error> {
    let (header, mesh) = (fixture::header(), fixture::mesh());
    write(dir, &header, &mesh, &Results::default())
}

const MINIMAL: [&str; 3] = ["contact.csv", "history.csv", "summary.json"];

const ALL: [&str; 7] = [
    "contact.csv",
    "fields.pvd",
    "history.csv",
    "path.csv",
    "state_01_b___1.5_b_.vtu",
    "state_03_released.vtu",
    "summary.json",
];

#[test]
fn a_new_directory_holds_every_file_and_nothing_is_left_beside_it() {
    let root = tempfile::tempdir().unwrap();
    write_fixture(&root.path().join("run.out")).unwrap();
    assert_eq!(names(root.path()), ["run.out"]);
    assert_eq!(names(&root.path().join("run.out")), ALL);
}

#[cfg(unix)]
#[test]
fn a_new_directory_has_the_permissions_of_any_other() {
    use std::os::unix::fs::PermissionsExt;
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    let other = root.path().join("other");
    write_fixture(&dir).unwrap();
    fs::create_dir(&other).unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&dir), mode(&other));
}

#[test]
fn missing_parents_are_made() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("a/b/run.out");
    write_fixture(&dir).unwrap();
    assert_eq!(names(&dir), ALL);
}

#[test]
fn an_empty_directory_is_used() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    fs::create_dir(&dir).unwrap();
    write_fixture(&dir).unwrap();
    assert_eq!(names(root.path()), ["run.out"]);
    assert_eq!(names(&dir), ALL);
}

#[test]
fn an_earlier_result_is_replaced_but_the_users_own_files_stay() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    write_fixture(&dir).unwrap();
    fs::write(dir.join("notes.txt"), "mine").unwrap();
    fs::create_dir(dir.join("plots")).unwrap();
    fs::write(dir.join("plots/pressure.svg"), "mine too").unwrap();

    write_minimal(&dir).unwrap();
    assert_eq!(names(root.path()), ["run.out"]);
    let mut expected = MINIMAL.to_vec();
    expected.extend(["notes.txt", "plots"]);
    expected.sort_unstable();
    assert_eq!(names(&dir), expected);
    assert_eq!(fs::read_to_string(dir.join("notes.txt")).unwrap(), "mine");
    let plot = fs::read_to_string(dir.join("plots/pressure.svg")).unwrap();
    assert_eq!(plot, "mine too");
    let summary = fs::read_to_string(dir.join("summary.json")).unwrap();
    assert!(summary.contains("\"states\": []"));
}

#[cfg(unix)]
#[test]
fn what_a_link_points_to_is_replaced_and_the_link_stays() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("disk");
    let link = root.path().join("run.out");
    write_fixture(&dir).unwrap();
    std::os::unix::fs::symlink(&dir, &link).unwrap();
    write_minimal(&link).unwrap();
    assert!(link.is_symlink());
    assert_eq!(names(&dir), MINIMAL);

    fs::remove_dir_all(&dir).unwrap();
    let error = write_minimal(&link).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Input);
    assert!(error.message().contains("symbolic link"));
    assert_eq!(names(root.path()), ["run.out"]);
}

#[test]
fn a_directory_that_is_not_ours_is_refused_and_left_alone() {
    let summaries = [None, Some("{\"febio\": 4}"), Some("not JSON"), Some("[]")];
    for summary in summaries {
        let root = tempfile::tempdir().unwrap();
        let dir = root.path().join("thesis");
        fs::create_dir(&dir).unwrap();
        fs::write(dir.join("chapter1.tex"), "years of work").unwrap();
        if let Some(text) = summary {
            fs::write(dir.join("summary.json"), text).unwrap();
        }
        let before = names(&dir);
        for error in [
            write_fixture(&dir).unwrap_err(),
            check_directory(&dir).unwrap_err(),
        ] {
            assert_eq!(error.kind(), ErrorKind::Input);
            assert!(error.message().contains("thesis"), "{error}");
            assert!(error.message().contains("brinell"), "{error}");
        }
        assert_eq!(names(root.path()), ["thesis"]);
        assert_eq!(names(&dir), before);
        let chapter = fs::read_to_string(dir.join("chapter1.tex")).unwrap();
        assert_eq!(chapter, "years of work");
    }
}

#[test]
fn a_file_or_no_name_in_place_of_the_directory_is_refused() {
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("run.out");
    fs::write(&file, "a file").unwrap();
    for dir in [file.as_path(), Path::new("")] {
        let error = write_fixture(dir).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Input);
    }
    assert_eq!(fs::read_to_string(&file).unwrap(), "a file");
}

#[test]
fn a_path_below_a_file_is_an_io_error_that_names_it() {
    let root = tempfile::tempdir().unwrap();
    fs::write(root.path().join("file"), "a file").unwrap();
    for below in ["file/run.out", "file/deep/er/run.out"] {
        let dir = root.path().join(below);
        for error in [
            write_fixture(&dir).unwrap_err(),
            check_directory(&dir).unwrap_err(),
        ] {
            assert_eq!(error.kind(), ErrorKind::Io);
            assert!(error.message().contains(dir.to_str().unwrap()), "{error}");
            assert!(error.source().is_some(), "the system's reason");
        }
    }
    assert_eq!(names(root.path()), ["file"]);
}

/// The name is too long for the system only once the parents are made and the temporary directory's
/// own, longer name is asked for: the parents go again.
#[test]
fn parents_made_for_a_failed_run_are_removed() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("a/b").join("x".repeat(255));
    let error = write_fixture(&dir).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Io);
    assert_eq!(names(root.path()), Vec::<String>::new());
}

/// The second state's fields do not fit the mesh: by then tables and the first state have been
/// written.
#[test]
fn an_error_in_the_middle_leaves_nothing() {
    let mesh = fixture::mesh();
    let mut results = fixture::results(&mesh);
    let fields = results.states[2].fields.as_mut().unwrap();
    fields.stress.pop();

    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("new/run.out");
    let error = write(&dir, &fixture::header(), &mesh, &results).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Internal);
    for part in ["released", "stress", "15 values", "16"] {
        assert!(error.message().contains(part), "{part} is not in: {error}");
    }
    assert_eq!(names(root.path()), Vec::<String>::new());
}

#[test]
fn an_error_in_the_middle_leaves_the_earlier_result() {
    let mesh = fixture::mesh();
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    write_minimal(&dir).unwrap();
    let before = fs::read(dir.join("summary.json")).unwrap();

    let mut results = fixture::results(&mesh);
    results.states[0].fields.as_mut().unwrap().yielded.push(1);
    write(&dir, &fixture::header(), &mesh, &results).unwrap_err();
    assert_eq!(names(root.path()), ["run.out"]);
    assert_eq!(names(&dir), MINIMAL);
    assert_eq!(fs::read(dir.join("summary.json")).unwrap(), before);
}

#[test]
fn checking_a_directory_leaves_nothing_behind() {
    let root = tempfile::tempdir().unwrap();
    check_directory(&root.path().join("a/b/run.out")).unwrap();
    assert_eq!(names(root.path()), Vec::<String>::new());
    let dir = root.path().join("run.out");
    write_minimal(&dir).unwrap();
    check_directory(&dir).unwrap();
    assert_eq!(names(root.path()), ["run.out"]);
    assert_eq!(names(&dir), MINIMAL);
}

/// While one has it nobody else writes there; what was there before is marked until it is replaced.
#[cfg(unix)]
#[test]
fn a_directory_belongs_to_one_run_at_a_time() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    write_minimal(&dir).unwrap();
    let claim = Claim::new(&dir).unwrap();
    let why = stale(&dir).unwrap();
    assert!(why.contains("has not ended yet"), "{why}");
    for error in [
        Claim::new(&dir).err().unwrap(),
        write_minimal(&dir).unwrap_err(),
    ] {
        assert_eq!(error.kind(), ErrorKind::Input);
        assert!(
            error.message().contains("another run is writing"),
            "{error}"
        );
    }
    drop(claim);
    assert_eq!(names(root.path()), ["run.out"]);
    assert!(mark_stale(&dir, &Error::analysis("no memory")));
    let why = stale(&dir).unwrap();
    assert!(why.contains("(exit code 5): no memory"), "{why}");
    // What a killed process left has no lock: it is used again, and what is in it goes.
    let left = root.path().join(".run.out.partial");
    fs::create_dir_all(left.join("deep")).unwrap();
    fs::write(left.join("history.csv"), "half a").unwrap();
    write_minimal(&dir).unwrap();
    assert_eq!(names(root.path()), ["run.out"]);
    assert_eq!(names(&dir), MINIMAL);
    assert_eq!(stale(&dir), None);
    assert!(!mark_stale(root.path(), &Error::analysis("no memory")));
}

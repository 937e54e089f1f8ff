//! Names of the files that a run and a study leave.

/// The file of the summary: its `brinell` key marks a directory as a result.
pub(super) const SUMMARY_FILE: &str = "summary.json";

/// The file of a study: marks a directory like the summary.
pub(super) const STUDY_FILE: &str = "accuracy.json";

/// The table of increments.
pub(super) const HISTORY_FILE: &str = "history.csv";

/// File of the points between increments, written if there are any.
pub(super) const PATH_FILE: &str = "path.csv";

/// The table of contact pairs.
pub(super) const CONTACT_FILE: &str = "contact.csv";

/// The file that lists the states with fields.
pub(super) const COLLECTION_FILE: &str = "fields.pvd";

/// The report of a run.
pub(super) const REPORT_FILE: &str = "report.html";

/// Beginning of the file names of the report's figures.
pub(super) const FIGURE_PREFIX: &str = "report_";

/// End of the file names of the report's figures.
pub(super) const FIGURE_SUFFIX: &str = ".svg";

/// The file that marks results as those of an earlier run.
pub(super) const STALE_FILE: &str = "stale.txt";

/// Whether a file of this name is a figure of a report.
pub(super) fn is_figure(name: &str) -> bool {
    name.starts_with(FIGURE_PREFIX) && name.ends_with(FIGURE_SUFFIX)
}

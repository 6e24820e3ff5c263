use crate::source::Finding;

/// What became of a class, for the summary at the end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    pub submissions: usize,
    /// Submissions of which nothing had changed since an earlier run.
    pub kept: usize,
    /// The run was stopped before the end; nothing else here is of the whole class then.
    pub stopped: bool,
    pub unreadable: usize,
    /// Students of the roster who handed nothing in.
    pub missing: usize,
    /// Submissions that came too late.
    pub late: usize,
    /// Answer files that do not count, since others of the same owners do.
    pub superseded: usize,
    /// Other files that are not marked.
    pub aside: usize,
    /// Submissions of which a person has to say first whose they are, or whether they count.
    pub held: usize,
    /// Submissions that polemark itself failed on.
    pub failed: usize,
    /// Submissions with something a person should look at.
    pub to_review: usize,
    /// Submissions with a decision of a person about an answer that has changed since.
    pub answers_changed: usize,
    /// Something waits for a person: a mark, a row, a box, or whose a file is.
    pub waiting: bool,
    /// Of the submissions that count on the class page; `None` where there are none.
    pub mean_earned: Option<f64>,
    pub possible: f64,
    /// Ids in the marks file that nobody in the class has.
    pub marks_without_submission: Vec<String>,
    /// Decisions of the marks file about groups of like answers that no answer is in.
    /// Each with the number of the marks file it is in.
    pub decisions_without_answers: Vec<(usize, Finding)>,
    /// (id, files) of student ids that more than one file gives.
    pub ids_given_twice: Vec<(String, Vec<String>)>,
    /// Reports that polemark had written of answers that are not there any more.
    pub removed_reports: usize,
    /// Other reports of an earlier run that still lie in the folder.
    pub older_reports: usize,
}

//! What the templates place. Every number is already text; fields ending in `_html` are markup made by this module.

use super::marked_equation::MarkedEquation;
use super::quotes::Quote;
use crate::grading::{Tally, Verdict};
use crate::lab::Points;
use serde::Serialize;
use std::borrow::Cow;

/// A drawn figure.
#[derive(Clone, Debug, Serialize)]
pub struct FigureView {
    /// The same picture stands in many reports: copies share it.
    pub svg_html: minijinja::Value,
    pub caption: String,
}

/// A bar in percent of its length: certain, and waiting for a person.
#[derive(Clone, Debug, Serialize)]
pub struct BarView {
    pub earned: String,
    pub provisional: String,
}

impl BarView {
    pub fn new(earned: Points, provisional: Points, possible: Points) -> Self {
        let share = |p: Points| {
            let whole = possible.0.max(1) as f64;
            format!("{:.0}", (100.0 * p.0 as f64 / whole).clamp(0.0, 100.0))
        };
        Self { earned: share(earned - provisional), provisional: share(provisional) }
    }
}

/// Points earned and possible, and how many of them are provisional, in words.
#[derive(Clone, Debug, Serialize)]
pub struct TallyView {
    pub earned: String,
    pub possible: String,
    /// Empty when none are.
    pub provisional: String,
    pub bar: BarView,
}

impl TallyView {
    pub fn new(tally: &Tally) -> Self {
        Self {
            earned: tally.earned.to_string(),
            possible: tally.possible.to_string(),
            provisional: provisional_words(tally.provisional),
            bar: BarView::new(tally.earned, tally.provisional, tally.possible),
        }
    }
}

/// `1.5 to be confirmed`, or nothing.
pub fn provisional_words(points: Points) -> String {
    if points == Points::ZERO { String::new() } else { format!("{points} to be confirmed") }
}

/// A verdict as symbol and word, never colour alone.
#[derive(Clone, Debug, Serialize)]
pub struct VerdictView {
    pub class: &'static str,
    pub symbol: &'static str,
    pub word: Cow<'static, str>,
    pub meaning: &'static str,
}

impl VerdictView {
    pub fn of(verdict: Verdict) -> Self {
        let (class, symbol, word, meaning) = match verdict {
            Verdict::Right => ("right", "✓", "right", "full points"),
            Verdict::Partly => ("partly", "◐", "partly", "some of the points"),
            Verdict::Wrong => ("wrong", "✗", "wrong", "no points"),
            Verdict::Blank => ("blank", "○", "blank", "nothing was written"),
            Verdict::Unreadable => ("unreadable", "?", "unreadable", "written, but cannot be read"),
            Verdict::Unmarked => ("unmarked", "…", "unmarked", "a person has to mark it"),
        };
        Self { class, symbol, word: word.into(), meaning }
    }

    /// Full points for what is right for an earlier answer only, `why` in words.
    pub fn follows(why: String) -> Self {
        Self { class: "right", symbol: "↪", word: why.into(), meaning: "" }
    }

    /// All of them, for the legend.
    pub fn legend() -> Vec<Self> {
        use Verdict::{Blank, Partly, Right, Unmarked, Unreadable, Wrong};
        [Right, Partly, Wrong, Blank, Unreadable, Unmarked].map(Self::of).to_vec()
    }
}

/// A box of the cover sheet.
#[derive(Clone, Debug, Serialize)]
pub struct BoxView {
    pub title: String,
    /// `None` while it waits.
    pub earned: Option<String>,
    pub possible: String,
    /// What it waits for.
    pub waiting: &'static str,
}

/// A link to a place on the same page.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinkView {
    pub anchor: String,
    pub words: String,
}

/// One field of a question: what was asked, written, and right.
#[derive(Clone, Debug, Serialize)]
pub struct AnswerView {
    pub prompt: String,
    pub yours_html: String,
    pub reference_heading: &'static str,
    pub reference_html: String,
    /// Words of the answer that do not go with something else.
    pub conflicts: Vec<ConflictView>,
    pub conflicts_title: &'static str,
}

/// Marked words of the answer, under their number.
#[derive(Clone, Debug, Serialize)]
pub struct ConflictView {
    pub number: usize,
    pub words: String,
    /// What they claim; empty when the words say just that.
    pub claim: String,
    pub against: Vec<AgainstView>,
}

/// What says otherwise.
#[derive(Clone, Debug, Serialize)]
pub struct AgainstView {
    /// It is the student's own answer.
    pub own: bool,
    /// `Your own answer`, `Reference`.
    pub who: &'static str,
    pub words_html: String,
}

/// A criterion, or several in a row that were left blank.
#[derive(Clone, Debug, Serialize)]
pub struct ItemGroup {
    pub item: Option<ItemView>,
    pub blanks: Vec<BlankView>,
}

/// A criterion for which nothing was written.
#[derive(Clone, Debug, Serialize)]
pub struct BlankView {
    pub anchor: String,
    pub title: String,
    pub earned: String,
    pub possible: String,
}

/// How an answer stands to an earlier one of the same student.
#[derive(Clone, Debug, Serialize)]
pub struct FollowView {
    /// `your own transfer function not followed`; empty when the verdict says it.
    pub words: String,
    /// Where that one lost its points.
    pub root: Option<LinkView>,
}

#[derive(Clone, Debug, Serialize)]
pub struct ItemView {
    pub anchor: String,
    pub title: String,
    pub verdict: VerdictView,
    pub earned: String,
    pub possible: String,
    pub expected: String,
    pub found: String,
    pub reason_html: String,
    pub quotes: Vec<Quote>,
    /// What each quotation was taken for is said beside it.
    pub labelled: bool,
    pub follow: Option<FollowView>,
    pub provisional: bool,
    pub override_reason: Option<String>,
    /// `line 12, column 3`
    pub place: Option<String>,
}

/// What may explain a wrong transfer function.
#[derive(Serialize)]
pub struct DiagnosisView {
    pub lead: String,
    pub explanations: Vec<ExplanationView>,
}

#[derive(Serialize)]
pub struct ExplanationView {
    pub words_html: String,
    pub equations: Vec<MarkedEquation>,
}

#[derive(Clone, Debug, Serialize)]
pub struct FindingView {
    pub severity: &'static str,
    pub message_html: String,
    pub place: Option<String>,
    pub line_number: String,
    /// The line it is about, cut to what is near; `None` without a place.
    pub line: Option<String>,
    /// Spaces and carets under the line.
    pub caret: String,
    pub help_html: Option<String>,
}

/// A level of an observed row.
#[derive(Clone, Debug, Serialize)]
pub struct LevelView {
    pub band: String,
    pub text: String,
    pub reached: bool,
}

#[derive(Clone, Debug, Serialize)]
pub struct ObservedView {
    pub title: String,
    pub outcomes: String,
    pub levels: Vec<LevelView>,
    pub earned: Option<String>,
    pub waiting: &'static str,
    pub possible: String,
}

#[derive(Clone, Debug, Serialize)]
pub struct OutcomeView {
    pub id: String,
    pub text: String,
}

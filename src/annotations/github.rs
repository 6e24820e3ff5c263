use super::{Annotations, Case, with_slashes};
use crate::source::Severity;

/// Annotations of each level that GitHub shows of one step; what comes after is lost without a word.
///
/// Source: <https://github.com/actions/toolkit/blob/main/docs/problem-matchers.md#limitations>
const SHOWN: usize = 10;
/// Characters of a message: a page of log is no annotation.
const LONGEST: usize = 2_000;

/// Workflow commands, a line each, that GitHub Actions shows beside the lines of the files, the worst first.
///
/// Of each level the first nine are given and, if there are more, how many. Text of students can inject no command: what ends
/// a line or a property is escaped, and the older form of commands is broken up.
///
/// Source: <https://docs.github.com/actions/reference/workflows-and-actions/workflow-commands>
pub fn github(annotations: &Annotations) -> String {
    let mut text = String::new();
    for severity in [Severity::Error, Severity::Warning, Severity::Note] {
        let all: Vec<(&str, &Case)> = annotations
            .files
            .iter()
            .flat_map(|file| file.cases.iter().map(|case| (file.file.as_str(), case)))
            .filter(|(_, case)| case.severity == Some(severity))
            .collect();
        let room = if all.len() > SHOWN { SHOWN - 1 } else { SHOWN };
        for (file, case) in all.iter().take(room) {
            text.push_str(&command(severity, file, case));
        }
        if let Some(more) = all.len().checked_sub(room).filter(|more| *more > 0) {
            text.push_str(&format!(
                "::{}::{more} more of this kind: see the output of `{}`\n",
                word(severity),
                annotations.verb
            ));
        }
    }
    text
}

fn command(severity: Severity, file: &str, case: &Case) -> String {
    let mut properties = vec![format!("file={}", property(&with_slashes(file)))];
    if let Some(place) = case.place {
        properties.push(format!("line={}", place.line));
        properties.push(format!("endLine={}", place.end_line));
        // GitHub takes columns only where the lines are the same.
        if place.line == place.end_line {
            properties.push(format!("col={}", place.column));
            properties.push(format!("endColumn={}", place.end_column));
        }
    }
    properties.push(format!("title={}", property(&format!("{} ({})", case.name, case.code))));
    let told: String = case.told().chars().take(LONGEST).collect();
    format!("::{} {}::{}\n", word(severity), properties.join(","), data(&told))
}

fn word(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "notice",
    }
}

fn data(text: &str) -> String {
    let escaped = text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A");
    escaped.replace("##[", "## [")
}

fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::super::tests::hostile;
    use super::*;
    use crate::annotations::FileAnnotations;

    #[test]
    fn a_line_each_and_nothing_breaks_out() {
        let text = github(&hostile());
        assert_eq!(
            text,
            "::warning file=a b/ü%2C%3A%25.yaml,line=2,endLine=2,col=4,endColumn=7,title=b  %3A%3Anotice%3A%3A \
             (poles.unreadable)::` ::error::x ## [set-env]y \u{fffd}[31m<b> & \"q\" ]]> %250A \u{fffe}` was found, 50%25 of \
             it. Write `-1`.\n"
        );
    }

    #[test]
    fn what_github_would_drop_is_counted() {
        let mut many = hostile();
        let case = many.files[0].cases[1].clone();
        many.files[0].cases = vec![case; 25];
        let text = github(&many);
        assert_eq!(text.lines().count(), 10);
        assert!(
            text.ends_with("::warning::16 more of this kind: see the output of `polemark check`\n"),
            "{text}"
        );
        many.files[0].cases.truncate(10);
        assert_eq!(github(&many).matches("poles.unreadable").count(), 10);
        assert_eq!(github(&Annotations { verb: "v", files: Vec::<FileAnnotations>::new() }), "");
    }
}

//! What Moodle and Canvas say in the names of folders and files that they hand out.
//!
//! Sources: Moodle, `mod/assign/classes/downloader.php` (4.x) and `assign::download_submissions` in `locallib.php` (before);
//! Canvas, `lib/content_zipper.rb`, which says what it takes out of names.

use serde::{Deserialize, Serialize};

/// Who handed a file in, as the learning management system spells it in the name of the file or of its folder.
///
/// All of it is somebody's own text: hostile until escaped.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct HandedIn {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lms: Option<Lms>,
    /// `Jane Doe` (Moodle), `doejane` (Canvas: family name first, letters and digits only), the name of a group, or nobody.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub owner: Option<String>,
    /// Moodle's participant number (of a group: the group's), Canvas' user id, or the word it gives an anonymous student.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lms_id: Option<String>,
    /// Grows with each file handed in: Canvas' attachment number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attempt: Option<u64>,
    /// Canvas says so in the name; Moodle never does.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub late: bool,
    /// The group whose work it is, where the roster has a group of this name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<String>,
    /// Names are hidden: whose it is stands in the file alone.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub anonymous: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Lms {
    Moodle,
    Canvas,
}

impl Lms {
    pub fn name(self) -> &'static str {
        match self {
            Self::Moodle => "Moodle",
            Self::Canvas => "Canvas",
        }
    }
}

impl HandedIn {
    /// Tells owners apart; `None` when nothing is said of one.
    pub fn owner_key(&self) -> Option<(Lms, &str, &str)> {
        let lms = self.lms?;
        let (owner, id) =
            (self.owner.as_deref().unwrap_or_default(), self.lms_id.as_deref().unwrap_or_default());
        Some((lms, owner, id))
    }
}

/// What a name says, and the name that the student gave the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LmsName<'a> {
    pub handed_in: HandedIn,
    /// Empty for a folder.
    pub file: &'a str,
    /// Typed into a text box rather than handed in as a file.
    pub is_online_text: bool,
}

/// `Jane Doe_1234_assignsubmission_file` (a folder) or `Jane Doe_1234_assignsubmission_file_lab1.yaml` (all in one folder).
///
/// Moodle writes `<name>_<number>`, with `_` in names turned into spaces and `& < > " ` | ' : \ /` taken out; for hidden names
/// `Participant`, in the site's language; for groups the group's name and number, `Default group` without a number; before
/// 4.1 `<group>-<name>`. Behind it stands the kind of submission: `file`, `onlinetext`.
pub fn moodle(name: &str) -> Option<LmsName<'_>> {
    const MARK: &str = "_assignsubmission_";
    let (prefix, rest) = name.split_once(MARK)?;
    let end = rest.find('_').unwrap_or(rest.len());
    let (kind, file) = (&rest[..end], rest[end..].trim_start_matches('_'));
    if prefix.is_empty()
        || kind.is_empty()
        || !kind.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
    {
        return None;
    }
    let (owner, number) = match prefix.rsplit_once('_') {
        Some((owner, number)) if is_number(number) => (owner, Some(number.to_owned())),
        _ => (prefix, None),
    };
    let anonymous = number.is_some() && PARTICIPANT.contains(&owner.to_lowercase().as_str());
    let handed_in = HandedIn {
        lms: Some(Lms::Moodle),
        owner: (!anonymous && !owner.is_empty()).then(|| owner.to_owned()),
        lms_id: number,
        anonymous,
        ..HandedIn::default()
    };
    Some(LmsName { handed_in, file, is_online_text: kind == "onlinetext" })
}

/// `participant` of Moodle's language packs. Where another word stands, all owners have the same name: see
/// [`anonymous_owners`](super::find_answer_files).
const PARTICIPANT: &[&str] =
    &["participant", "participante", "teilnehmer", "teilnehmerin", "partecipante", "deelnemer"];

/// `doejane_1234_56789_lab1.yaml`, `doejane_LATE_1234_56789_lab1.yaml`, `anon_x7Gh2_56789_lab1.yaml`,
/// `LATE_anon_x7Gh2_56789_lab1.yaml`; `doejane_1234_text.html` and `doejane_1234_link.html` for what was typed.
///
/// Canvas writes the sortable name in small letters (`doe, jane`, for groups the group's name), `LATE`, and the user's number,
/// and takes out all but letters, digits and `_`; then the attachment's number and the file's own name. It sees to it that the
/// first `_<digits>_<digits>_` are the numbers.
pub fn canvas(name: &str) -> Option<LmsName<'_>> {
    anonymous_canvas(name).or_else(|| named_canvas(name))
}

fn named_canvas(name: &str) -> Option<LmsName<'_>> {
    let said = |owner: &str, id: &str, attempt, file, is_online_text| {
        let (owner, late) = without_late(owner);
        let handed_in = HandedIn {
            lms: Some(Lms::Canvas),
            owner: Some(owner.to_owned()),
            lms_id: Some(id.to_owned()),
            attempt,
            late,
            ..HandedIn::default()
        };
        (!owner.is_empty()).then_some(LmsName { handed_in, file, is_online_text })
    };
    for (at, _) in name.match_indices('_') {
        let (owner, rest) = (&name[..at], &name[at + 1..]);
        let Some((id, rest)) = rest.split_once('_').filter(|(id, _)| is_number(id)) else { continue };
        if matches!(rest, "text.html" | "link.html") {
            return said(owner, id, None, rest, true);
        }
        if let Some((attachment, file)) = rest.split_once('_')
            && is_number(attachment)
            && !file.is_empty()
        {
            return said(owner, id, attachment.parse().ok(), file, false);
        }
    }
    None
}

fn anonymous_canvas(name: &str) -> Option<LmsName<'_>> {
    let (late, rest) = match name.strip_prefix("LATE_") {
        Some(rest) => (true, rest),
        None => (false, name),
    };
    let (id, rest) = rest.strip_prefix("anon_")?.split_once('_')?;
    if id.is_empty() || !id.chars().all(|c| c.is_ascii_alphanumeric()) {
        return None;
    }
    let (late, rest) = match rest.strip_prefix("LATE_") {
        Some(rest) => (true, rest),
        None => (late, rest),
    };
    let handed_in = |attempt| HandedIn {
        lms: Some(Lms::Canvas),
        lms_id: Some(id.to_owned()),
        attempt,
        late,
        anonymous: true,
        ..HandedIn::default()
    };
    if matches!(rest, "text.html" | "link.html") {
        return Some(LmsName { handed_in: handed_in(None), file: rest, is_online_text: true });
    }
    let (attachment, file) =
        rest.split_once('_').filter(|(number, file)| is_number(number) && !file.is_empty())?;
    Some(LmsName { handed_in: handed_in(attachment.parse().ok()), file, is_online_text: false })
}

fn without_late(owner: &str) -> (&str, bool) {
    match owner.strip_suffix("_LATE").or_else(|| owner.strip_suffix("_late")) {
        Some(owner) => (owner, true),
        None => (owner, false),
    }
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.len() <= 20 && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// A file's name without the `-2` that Canvas puts before the ending when a file of that name was handed in before, and
/// that number.
pub fn without_resubmission(file: &str) -> (String, u64) {
    let (stem, ending) = match file.find('.') {
        Some(at) if at > 0 => file.split_at(at),
        _ => (file, ""),
    };
    match stem.rsplit_once('-') {
        Some((stem, number))
            if is_number(number) && number.len() <= 3 && !stem.is_empty() && number != "0" =>
        {
            (format!("{stem}{ending}"), number.parse().unwrap_or(0))
        }
        _ => (file.to_owned(), 0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `owner|number|attempt|file|flags`, flags of `late`, `anonymous`, `text`.
    fn said(name: Option<LmsName<'_>>) -> String {
        let Some(LmsName { handed_in, file, is_online_text }) = name else { return "nothing".to_owned() };
        let flags = [(handed_in.late, "late"), (handed_in.anonymous, "anonymous"), (is_online_text, "text")];
        let flags: Vec<&str> = flags.iter().filter(|(is, _)| *is).map(|(_, word)| *word).collect();
        let attempt = handed_in.attempt.map_or(String::new(), |number| number.to_string());
        let (owner, number) = (handed_in.owner.unwrap_or_default(), handed_in.lms_id.unwrap_or_default());
        format!("{owner}|{number}|{attempt}|{file}|{}", flags.join(" "))
    }

    #[test]
    fn moodle_says_who_it_is_from() {
        for (name, what) in [
            // One folder each, the default since 3.1.
            ("Jane Doe_1234_assignsubmission_file", "Jane Doe|1234|||"),
            ("Jane Doe_1234_assignsubmission_file_", "Jane Doe|1234|||"),
            ("Jane Doe_1234_assignsubmission_onlinetext", "Jane Doe|1234|||text"),
            // All files in one folder.
            ("Jane Doe_1234_assignsubmission_file_lab1.yaml", "Jane Doe|1234||lab1.yaml|"),
            ("Jane Doe_1234_assignsubmission_file_my_lab_1.yaml", "Jane Doe|1234||my_lab_1.yaml|"),
            (
                "Jane Doe_1234_assignsubmission_onlinetext_onlinetext.html",
                "Jane Doe|1234||onlinetext.html|text",
            ),
            // Names: `_` becomes a space and apostrophes go when Moodle writes them; the rest stays.
            ("José María Núñez-Ångström_7_assignsubmission_file", "José María Núñez-Ångström|7|||"),
            ("Sinéad OBrien_88_assignsubmission_file_a.yaml", "Sinéad OBrien|88||a.yaml|"),
            ("Sinéad O'Brien_88_assignsubmission_file_a.yaml", "Sinéad O'Brien|88||a.yaml|"),
            ("محمد علي_99_assignsubmission_file", "محمد علي|99|||"),
            ("李 雷_5_assignsubmission_file_作业.yaml", "李 雷|5||作业.yaml|"),
            ("R2 D2_2_3_assignsubmission_file", "R2 D2_2|3|||"),
            // Hidden names, and groups.
            ("Participant_4711_assignsubmission_file", "|4711|||anonymous"),
            ("Participant_4711_assignsubmission_file_lab1.yaml", "|4711||lab1.yaml|anonymous"),
            ("Teilnehmer_4711_assignsubmission_file", "|4711|||anonymous"),
            ("Group A_42_assignsubmission_file", "Group A|42|||"),
            ("Group A-Jane Doe_42_assignsubmission_file", "Group A-Jane Doe|42|||"),
            ("Default group_assignsubmission_file", "Default group||||"),
            // A file's own name may have the mark in it.
            (
                "Jane_1_assignsubmission_file_x_assignsubmission_file_y.yaml",
                "Jane|1||x_assignsubmission_file_y.yaml|",
            ),
            ("_assignsubmission_file", "nothing"),
            ("Jane_1_assignsubmission_", "nothing"),
            ("Jane_1_assignsubmission_FILE", "nothing"),
            ("lab1.yaml", "nothing"),
        ] {
            assert_eq!(said(moodle(name)), what, "{name}");
        }
    }

    #[test]
    fn canvas_says_who_it_is_from() {
        for (name, what) in [
            ("doejane_1234_56789_lab1.yaml", "doejane|1234|56789|lab1.yaml|"),
            ("doejane_LATE_1234_56789_lab1.yaml", "doejane|1234|56789|lab1.yaml|late"),
            ("doejane_late_1234_56789_lab1.yaml", "doejane|1234|56789|lab1.yaml|late"),
            ("doejane_1234_56789_lab1-1.yaml", "doejane|1234|56789|lab1-1.yaml|"),
            ("doejane_1234_56789_my_lab_1_2_3.yaml", "doejane|1234|56789|my_lab_1_2_3.yaml|"),
            ("doe_jane_1234_56789_lab1.yaml", "doe_jane|1234|56789|lab1.yaml|"),
            ("group7_1234_56789_lab1.yaml", "group7|1234|56789|lab1.yaml|"),
            ("team_3_a_1234_56789_lab1.yaml", "team_3_a|1234|56789|lab1.yaml|"),
            ("1234_56_789_lab1.yaml", "1234|56|789|lab1.yaml|"),
            ("núñezjosé_12_345_práctica 1.yaml", "núñezjosé|12|345|práctica 1.yaml|"),
            ("obriensinéad_12_345_it's.yaml", "obriensinéad|12|345|it's.yaml|"),
            ("عليمحمد_12_345_lab.yaml", "عليمحمد|12|345|lab.yaml|"),
            ("latejane_LATE_12_345_lab.yaml", "latejane|12|345|lab.yaml|late"),
            ("doejane_1234_text.html", "doejane|1234||text.html|text"),
            ("doejane_LATE_1234_link.html", "doejane|1234||link.html|late text"),
            ("anon_x7Gh2_56789_lab1.yaml", "|x7Gh2|56789|lab1.yaml|anonymous"),
            ("LATE_anon_x7Gh2_56789_lab1.yaml", "|x7Gh2|56789|lab1.yaml|late anonymous"),
            ("anon_x7Gh2_LATE_56789_lab1.yaml", "|x7Gh2|56789|lab1.yaml|late anonymous"),
            ("anon_12345_56789_lab1.yaml", "|12345|56789|lab1.yaml|anonymous"),
            ("anon_x7Gh2_text.html", "|x7Gh2||text.html|anonymous text"),
            ("_1234_56789_lab1.yaml", "nothing"),
            ("doejane_1234_56789_", "nothing"),
            ("doejane_1234.yaml", "nothing"),
            ("doejane_1234_lab1.yaml", "nothing"),
            ("lab1.yaml", "nothing"),
        ] {
            assert_eq!(said(canvas(name)), what, "{name}");
        }
    }

    #[test]
    fn canvas_numbers_what_is_handed_in_again() {
        for (name, without, number) in [
            ("lab1.yaml", "lab1.yaml", 0),
            ("lab1-1.yaml", "lab1.yaml", 1),
            ("lab1-12.yaml.txt", "lab1.yaml.txt", 12),
            ("lab-a.yaml", "lab-a.yaml", 0),
            ("lab-2024.yaml", "lab-2024.yaml", 0),
            ("-1.yaml", "-1.yaml", 0),
            ("lab-1", "lab", 1),
        ] {
            assert_eq!(without_resubmission(name), (without.to_owned(), number), "{name}");
        }
    }
}

use super::aside::{Aside, WhyAside};
use super::lms_names::{HandedIn, Lms, LmsName, canvas, moodle};
use super::place::{Beside, OwnFile};
use super::{AnswerFile, Intake, Place, UniqueNames, answer_stem};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A file, before it is known what it is.
#[derive(Clone, Debug)]
pub struct Found {
    pub place: Place,
    /// Relative to what was given, with `/`.
    pub name: String,
    /// By the caller, rather than found in a folder.
    pub named: bool,
    /// Which of the given paths it is from.
    pub source: usize,
    /// When an archive says it was last changed.
    pub changed: Option<u64>,
    /// Not given, but beside a file that is: its owner's answers may name it.
    pub beside_given: bool,
}

impl Found {
    fn is_answer(&self) -> bool {
        !self.beside_given && (self.named || answer_stem(&self.name).is_some())
    }

    fn folder(&self) -> &str {
        self.name.rsplit_once('/').map_or("", |(folder, _)| folder)
    }

    fn file_name(&self) -> &str {
        self.name.rsplit_once('/').map_or(self.name.as_str(), |(_, name)| name)
    }
}

/// Whether an LMS has put the files of a whole class beside this one, each under its owner's name.
pub fn is_among_a_class(file: &Found) -> bool {
    lms_name(file, &BTreeSet::new()).is_some_and(|said| said.flat_name.is_some())
}

/// Whether a folder is one that Moodle has made for a student.
pub fn is_folder_of_moodle(name: &str) -> bool {
    moodle(name).is_some_and(|name| name.file.is_empty())
}

/// Whether there is something to mark, or somebody who handed something in.
pub fn has_answers(files: &[Found]) -> bool {
    let of_canvas = canvas_folders(files);
    files.iter().any(|file| file.is_answer() || lms_name(file, &of_canvas).is_some())
}

/// Whose files they are: answer files to mark, and what is set aside.
pub fn sorted_out(files: Vec<Found>) -> Intake {
    let of_canvas = canvas_folders(&files);
    let mut said: Vec<Option<Said>> = files.iter().map(|file| lms_name(file, &of_canvas)).collect();
    hide_names(&mut said);
    let mut owned: BTreeMap<Key, Owned> = BTreeMap::new();
    for (at, said) in said.iter().enumerate() {
        if let Some(key) = said.as_ref().and_then(key) {
            let owned = owned.entry(key).or_default();
            owned.has_answers |= files[at].is_answer();
            owned.places.push(at);
        }
    }
    let mut beside: BTreeMap<&Key, Arc<Vec<OwnFile>>> = BTreeMap::new();
    for (key, owned) in owned.iter().filter(|(_, owned)| owned.has_answers) {
        let own = owned.places.iter().take(MOST_OWN_FILES).filter_map(|at| {
            let (file, said) = (&files[*at], said[*at].as_ref()?);
            let name = said.flat_name.clone()?;
            Some(OwnFile { name, attempt: said.handed_in.attempt.unwrap_or(0), place: file.place.clone() })
        });
        beside.insert(key, Arc::new(own.collect()));
    }

    let mut ids = UniqueNames::default();
    let mut intake = Intake::default();
    for (at, file) in files.iter().enumerate() {
        let said = said[at].as_ref();
        let key = said.and_then(key);
        if file.beside_given {
            continue;
        }
        let owned = key.as_ref().and_then(|key| owned.get(key));
        let has_answers = owned.is_none_or(|owned| owned.has_answers);
        let stands_for_owner = !has_answers && owned.is_some_and(|owned| owned.places.first() == Some(&at));
        if !file.is_answer() && !stands_for_owner {
            let is_online_text = said.is_some_and(|said| said.is_online_text);
            // Who handed in nothing else has an entry that names them all.
            if has_answers && let Some(why) = WhyAside::of(&file.name, is_online_text) {
                intake.aside.push(Aside { name: file.name.clone(), why });
            }
            continue;
        }
        let only_others = match owned {
            Some(owned) if stands_for_owner => {
                owned.places.iter().map(|at| files[*at].name.clone()).collect()
            }
            _ => Vec::new(),
        };
        let own_files =
            said.and_then(|said| said.flat_name.as_ref()).and(key.as_ref()).and_then(|key| beside.get(key));
        let handed_in = said.map_or_else(HandedIn::default, |said| said.handed_in.clone());
        intake.files.push(AnswerFile {
            id: ids.claim(&stem(file, &handed_in)),
            place: file.place.clone(),
            name: file.name.clone(),
            followed: file.named,
            changed: file.changed,
            beside: match own_files {
                Some(files) => {
                    Beside::Own { files: Arc::clone(files), attempt: handed_in.attempt.unwrap_or(0) }
                }
                None => Beside::Folder,
            },
            own_name: said
                .and_then(|said| said.flat_name.clone())
                .unwrap_or_else(|| file.file_name().to_owned()),
            handed_in,
            only_others,
            beside_others: Vec::new(),
        });
    }
    intake
}

/// Files of one owner that answers may name.
const MOST_OWN_FILES: usize = 1000;

/// The files of one owner.
#[derive(Default)]
struct Owned {
    places: Vec<usize>,
    has_answers: bool,
}

/// One owner, in however many downloads: (LMS, name, number).
type Key = (Lms, String, String);

fn key(said: &Said) -> Option<Key> {
    let (lms, owner, id) = said.handed_in.owner_key()?;
    Some((lms, owner.to_owned(), id.to_owned()))
}

/// What an LMS says of a file.
struct Said {
    handed_in: HandedIn,
    /// The student's own name for it, where the LMS put all files of the class into one folder.
    flat_name: Option<String>,
    is_online_text: bool,
}

fn lms_name(file: &Found, of_canvas: &BTreeSet<(usize, String)>) -> Option<Said> {
    let said = |name: LmsName<'_>, flat: bool| Said {
        flat_name: flat.then(|| name.file.to_owned()),
        is_online_text: name.is_online_text,
        handed_in: name.handed_in,
    };
    let own = file.file_name();
    if let Some(folder) = file.folder().split('/').rev().find_map(moodle).filter(|name| name.file.is_empty())
    {
        return Some(said(folder, false));
    }
    if let Some(name) = moodle(own).filter(|name| !name.file.is_empty()) {
        return Some(said(name, true));
    }
    let is_canvas = match file.named || file.beside_given {
        true => canvas(own).is_some_and(|name| has_long_numbers(&name)),
        false => of_canvas.contains(&(file.source, file.folder().to_owned())),
    };
    if is_canvas { canvas(own).map(|name| said(name, true)) } else { None }
}

/// Folders whose answer files are all called as Canvas does it: a single `lab_1_2_final.yaml` is somebody's own name.
fn canvas_folders(files: &[Found]) -> BTreeSet<(usize, String)> {
    let mut folders: BTreeMap<(usize, String), (bool, usize, bool)> = BTreeMap::new();
    for file in files.iter().filter(|file| !file.named && !file.beside_given) {
        let folder = folders.entry((file.source, file.folder().to_owned())).or_insert((true, 0, false));
        match canvas(file.file_name()) {
            Some(name) => {
                folder.1 += 1;
                folder.2 |= has_long_numbers(&name);
            }
            None if file.is_answer() => folder.0 = false,
            None => {}
        }
    }
    let of_canvas = folders.into_iter().filter(|(_, (all, count, long))| *all && *count > 0 && *long);
    of_canvas.map(|(folder, _)| folder).collect()
}

/// Canvas counts the files of a whole school.
fn has_long_numbers(name: &LmsName<'_>) -> bool {
    name.handed_in.anonymous
        || name.is_online_text
        || name.handed_in.attempt.is_some_and(|number| number >= 100)
}

/// Moodle's word for a hidden name in any language: most owners have it, each with another number.
fn hide_names(said: &mut [Option<Said>]) {
    let mut owners: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let mut all = BTreeSet::new();
    for one in said.iter().flatten().filter(|one| one.handed_in.lms == Some(Lms::Moodle)) {
        if let (Some(owner), Some(id)) = (&one.handed_in.owner, &one.handed_in.lms_id) {
            owners.entry(owner.clone()).or_default().insert(id.clone());
            all.insert(id.clone());
        }
    }
    let hidden = owners.into_iter().find(|(_, numbers)| numbers.len() >= 3 && numbers.len() * 2 > all.len());
    let Some((word, _)) = hidden else { return };
    for one in said.iter_mut().flatten().filter(|one| one.handed_in.owner.as_ref() == Some(&word)) {
        one.handed_in.owner = None;
        one.handed_in.anonymous = true;
    }
}

/// The owner where one is known, and the file's own name otherwise.
fn stem(file: &Found, handed_in: &HandedIn) -> String {
    let number = handed_in.lms_id.as_deref();
    match (&handed_in.owner, number) {
        (Some(owner), Some(number)) => format!("{owner}_{number}"),
        (Some(owner), None) => owner.clone(),
        (None, Some(number)) if handed_in.lms == Some(Lms::Moodle) => format!("Participant_{number}"),
        (None, Some(number)) => format!("anon_{number}"),
        (None, None) => answer_stem(file.file_name()).unwrap_or(file.file_name()).to_owned(),
    }
}

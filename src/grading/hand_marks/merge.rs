use super::{AlikeMarks, HandMarks, HandMarksFile, Override, Said, quoted};
use crate::lab::Points;
use crate::source::Span;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Something that two marks files say differently.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contradiction {
    /// `viva of `EE-001` is 30 and 20`: a sentence but for its places and the full stop.
    pub what: String,
    /// Where it is said first, and where again.
    pub places: [Said; 2],
}

impl HandMarksFile {
    /// Puts marks files together, each read by [`Self::parse`], and finds what they say differently. Of decisions for different answers
    /// each counts for its own; an adjustment that several files have, with the same reason, counts once.
    pub fn merged(files: Vec<Self>) -> (Self, Vec<Contradiction>) {
        let mut whole = Self::default();
        let mut found = Vec::new();
        for (number, file) in files.into_iter().enumerate() {
            whole.take(file.numbered(number), &mut found);
        }
        whole.share();
        (whole, found)
    }

    /// Said in the marks file of this number.
    fn numbered(mut self, file: usize) -> Self {
        let places = self.groups.values_mut().chain(self.said.values_mut());
        let places = places.chain(self.files.values_mut().map(|(_, said)| said));
        places.chain(self.counts.values_mut().map(|(_, said)| said)).for_each(|said| said.file = file);
        self
    }

    fn take(&mut self, other: Self, found: &mut Vec<Contradiction>) {
        let Self { students, others, groups, files, counts, said } = other;
        let mut clash = |what: String, places: [Option<&Said>; 2]| {
            // One is never passed over, even if nobody noted where it stands.
            let places = places.map(|place| place.copied().unwrap_or(Said::from(Span::default())));
            found.push(Contradiction { what, places });
        };
        for (who, (id, marks)) in students {
            let HandMarks { cover, observed, items, alike: _, adjustments, late_rule: _, late } = marks;
            let places = |item: &str| {
                let what = (who.clone(), item.to_owned());
                [self.said.get(&what), said.get(&what)]
            };
            let (_, mine) =
                self.students.entry(who.clone()).or_insert_with(|| (id.clone(), HandMarks::default()));
            for (item, points) in cover {
                if let Some(before) = differs(&mut mine.cover, item.clone(), points) {
                    clash(
                        format!("{} of {} is {before} and {points}", quoted(&item), quoted(&id)),
                        places(&item),
                    );
                }
            }
            for (row, points) in observed {
                if let Some(before) = differs(&mut mine.observed, row.clone(), points) {
                    let item = format!("observed.{row}");
                    clash(
                        format!("{} of {} is {before} and {points}", quoted(&item), quoted(&id)),
                        places(&item),
                    );
                }
            }
            for (item, decisions) in items {
                if let Some((before, now)) = joined(mine.items.entry(item.clone()).or_default(), decisions) {
                    clash(
                        format!("{} of {} is {before} and {now}", quoted(&item), quoted(&id)),
                        places(&item),
                    );
                }
            }
            match (mine.late, late) {
                (Some(before), Some(now)) if before != now => {
                    clash(format!("{} is late and not late", quoted(&id)), places("late"));
                }
                _ => mine.late = mine.late.or(late),
            }
            // As often as the file says it that says it most often.
            let mut mine_left = mine.adjustments.clone();
            for one in adjustments {
                match mine_left.iter().position(|other| *other == one) {
                    Some(place) => drop(mine_left.remove(place)),
                    None => mine.adjustments.push(one),
                }
            }
        }
        let late = (String::new(), "late".to_owned());
        match (&self.others.late_rule, others.late_rule) {
            (Some(before), Some(now)) if *before != now => {
                clash(
                    "What it costs to hand in late differs".to_owned(),
                    [self.said.get(&late), said.get(&late)],
                );
            }
            (None, Some(now)) => self.others.late_rule = Some(now),
            _ => {}
        }
        let mut alike: AlikeMarks = (*self.others.alike).clone();
        for (criterion, decided) in others.alike.iter() {
            for (group, decisions) in decided {
                let mine = alike.entry(criterion.clone()).or_default().entry(group.clone()).or_default();
                if let Some((before, now)) = joined(mine, decisions.clone()) {
                    let key = (criterion.clone(), group.clone());
                    let what = format!(
                        "The group {} of {} is given {before} and {now}",
                        quoted(group),
                        quoted(criterion)
                    );
                    clash(what, [self.groups.get(&key), groups.get(&key)]);
                }
            }
        }
        self.others.alike = Arc::new(alike);
        for (name, (students, place)) in files {
            match self.files.get(&name) {
                Some((before, first)) if *before != students => {
                    let what = format!(
                        "{} is of {} and of {}",
                        quoted(&name),
                        quoted(&before.join(", ")),
                        quoted(&students.join(", "))
                    );
                    clash(what, [Some(first), Some(&place)]);
                }
                Some(_) => {}
                None => drop(self.files.insert(name, (students, place))),
            }
        }
        for (who, (name, place)) in counts {
            match self.counts.get(&who) {
                Some((before, first)) if *before != name => {
                    let what = format!(
                        "Of the files of one student {} counts and {}",
                        quoted(before),
                        quoted(&name)
                    );
                    clash(what, [Some(first), Some(&place)]);
                }
                Some(_) => {}
                None => drop(self.counts.insert(who, (name, place))),
            }
        }
        for (group, place) in groups {
            self.groups.entry(group).or_insert(place);
        }
        for (what, place) in said {
            self.said.entry(what).or_insert(place);
        }
    }
}

/// Enters points; what was there when that is something else.
fn differs(marks: &mut BTreeMap<String, Points>, item: String, points: Points) -> Option<Points> {
    let before = *marks.entry(item).or_insert(points);
    (before != points).then_some(before)
}

/// Adds decisions to those of another file. Two for the same answers, or of which one is for any, have to be the same; else what they
/// are is given back.
fn joined(mine: &mut Vec<Override>, decisions: Vec<Override>) -> Option<(String, String)> {
    let shown = |one: &Override| format!("{} ({})", one.points, crate::source::sanitize(&one.reason));
    let before = mine.len();
    for one in decisions {
        let meets = |other: &&Override| {
            other.answers.is_empty() || one.answers.is_empty() || is_same_set(&other.answers, &one.answers)
        };
        match mine[..before].iter().find(meets) {
            Some(other) if (other.points, &other.reason) != (one.points, &one.reason) => {
                return Some((shown(other), shown(&one)));
            }
            Some(other) if other.answers == one.answers => {}
            _ => mine.push(one),
        }
    }
    None
}

fn is_same_set(one: &[String], other: &[String]) -> bool {
    one.iter().all(|hash| other.contains(hash)) && other.iter().all(|hash| one.contains(hash))
}

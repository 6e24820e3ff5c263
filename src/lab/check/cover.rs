use super::{Checker, Names, span};
use crate::lab::file::{CoverFile, ObservedFile};
use crate::lab::{Cover, CoverRow, CoverSource, Level, ObservedRow, Points, defaults};

pub(in crate::lab) const SOURCES: &[(&str, CoverSource)] = &[
    ("questions_and_observed", CoverSource::QuestionsAndObserved),
    ("questions", CoverSource::Questions),
    ("observed", CoverSource::Observed),
    ("by_hand", CoverSource::ByHand),
];

impl Checker<'_> {
    pub(super) fn observed(&mut self, file: &ObservedFile, names: &Names<'_>) -> Option<Vec<ObservedRow>> {
        let levels: Vec<Option<(Points, Points)>> = file
            .levels
            .iter()
            .map(|level| {
                let (from, to) = (self.points(&level.from)?, self.points(&level.to)?);
                if from > to {
                    let message = format!("the level `{}` goes from {from} down to {to}", level.title.trim());
                    self.error("lab.points", span(&level.from), message, Some("swap them".to_owned()));
                }
                Some((from, to))
            })
            .collect();
        let ranges = levels.into_iter().collect::<Option<Vec<_>>>();
        for (pair, level) in ranges.iter().flat_map(|r| r.windows(2)).zip(file.levels.iter().skip(1)) {
            if pair[1].1 >= pair[0].0 {
                let message = format!("the level `{}` is not below the one before it", level.title.trim());
                self.error(
                    "lab.points",
                    span(&level.to),
                    message,
                    Some("give the best level first".to_owned()),
                );
            }
        }
        let rows = file.rows.0.iter().map(|(id, row)| {
            self.id(id, "row id");
            self.outcomes(&row.outcomes, names);
            let points = self.points(&row.points);
            let best = ranges.as_ref().and_then(|r| r.first()).map(|(_, to)| *to);
            if let (Some(points), Some(best)) = (points, best)
                && points != best
            {
                let message = format!(
                    "the row `{}` is worth {points} points, but the best level ends at {best}",
                    id.value
                );
                self.error("lab.points", span(&row.points), message, None);
            }
            let texts = &row.texts.value;
            if texts.len() != file.levels.len() {
                let message = format!(
                    "the row `{}` has {} texts for {} levels",
                    id.value,
                    texts.len(),
                    file.levels.len()
                );
                self.error(
                    "lab.observed",
                    span(&row.texts),
                    message,
                    Some("give one text a level".to_owned()),
                );
            }
            let levels =
                file.levels.iter().zip(ranges.as_ref()?).zip(texts).map(|((level, range), text)| Level {
                    title: level.title.trim().to_owned(),
                    from: range.0,
                    to: range.1,
                    text: text.trim().to_owned(),
                });
            Some(ObservedRow {
                id: id.value.clone(),
                title: row.title.trim().to_owned(),
                outcomes: row.outcomes.iter().map(|o| o.value.clone()).collect(),
                points: points?,
                levels: levels.collect(),
            })
        });
        let rows: Vec<_> = rows.collect();
        rows.into_iter().collect()
    }

    /// What the parts make up; `questions` and `observed` are what they are worth.
    pub(super) fn cover(
        &mut self,
        file: Option<&CoverFile>,
        questions: Option<Points>,
        observed: Option<Points>,
    ) -> Option<Cover> {
        match file {
            Some(file) => self.stated_cover(file, observed != Some(Points::ZERO)),
            None => Some(defaults::cover(questions?, observed?)),
        }
    }

    fn stated_cover(&mut self, file: &CoverFile, observed: bool) -> Option<Cover> {
        let known: Vec<&str> = SOURCES.iter().map(|(name, _)| *name).collect();
        let rows = file.rows.0.iter().map(|(id, row)| {
            self.id(id, "row id");
            let points = self.points(&row.points);
            let from = self.one_of(&row.from, "source of points", &known).map(|i| SOURCES[i].1);
            if !observed && matches!(from, Some(CoverSource::Observed | CoverSource::QuestionsAndObserved)) {
                let message = format!("`{}` needs observed rows, but the lab has none", row.from.value);
                self.error(
                    "lab.cover",
                    span(&row.from),
                    message,
                    Some("write `questions` or `by_hand`".to_owned()),
                );
            }
            Some(CoverRow {
                id: id.value.clone(),
                title: row.title.trim().to_owned(),
                points: points?,
                from: from?,
            })
        });
        let rows: Vec<_> = rows.collect();
        let total = file.total.as_ref().map(|text| (text, self.points(text)));
        let rows = rows.into_iter().collect::<Option<Vec<_>>>()?;
        let sum: Points = rows.iter().map(|row| row.points).sum();
        let Some((text, total)) = total else { return Some(Cover { rows, total: sum }) };
        let total = total?;
        if sum != total {
            let message =
                format!("the rows of the cover sheet add up to {sum} points, but its `total` is {total}");
            let help = format!("change `total` to {sum}, or the points of a row");
            self.error("lab.points", span(text), message, Some(help));
        }
        Some(Cover { rows, total })
    }
}

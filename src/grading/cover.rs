use super::mark::share;
use super::{HandMarks, Tally};
use crate::algebra::Rational;
use crate::lab::{Cover, CoverSource, ObservedRow, Points};

/// What a person gave for each observed row; `None` until then.
pub(super) fn observed(rows: &[ObservedRow], hand: Option<&HandMarks>) -> Vec<(String, Option<Points>)> {
    let given = |row: &ObservedRow| hand.and_then(|hand| hand.observed.get(&row.id)).copied();
    rows.iter().map(|row| (row.id.clone(), given(row))).collect()
}

/// The parts a box of the cover sheet is made of, `None` while one waits for a person.
pub(super) struct Parts {
    /// Earned and possible.
    pub questions: Option<(Points, Points)>,
    pub observed: Option<(Points, Points)>,
}

impl Parts {
    /// `unmarked`: a criterion is left to a person. Provisional marks count as they stand.
    pub fn new(
        total: Tally,
        unmarked: bool,
        rows: &[ObservedRow],
        observed: &[(String, Option<Points>)],
    ) -> Self {
        let earned: Option<Points> = observed.iter().map(|(_, points)| *points).sum();
        let possible = rows.iter().map(|row| row.points).sum();
        Self {
            questions: (!unmarked).then_some((total.earned, total.possible)),
            observed: earned.map(|earned| (earned, possible)),
        }
    }
}

/// (row id, possible, earned) of each box.
pub(super) fn boxes(
    cover: &Cover,
    parts: &Parts,
    hand: Option<&HandMarks>,
) -> Vec<(String, Points, Option<Points>)> {
    cover
        .rows
        .iter()
        .map(|row| {
            let earned = match row.from {
                CoverSource::Questions => parts.questions.and_then(|part| of(row.points, part)),
                CoverSource::Observed => parts.observed.and_then(|part| of(row.points, part)),
                CoverSource::QuestionsAndObserved => parts
                    .questions
                    .zip(parts.observed)
                    .and_then(|(one, other)| of(row.points, (one.0 + other.0, one.1 + other.1))),
                CoverSource::ByHand => hand.and_then(|hand| hand.cover.get(&row.id)).copied(),
            };
            (row.id.clone(), row.points, earned)
        })
        .collect()
}

/// points · earned / possible, rounded to hundredths; `None` of nothing.
fn of(points: Points, (earned, possible): (Points, Points)) -> Option<Points> {
    if possible <= Points::ZERO {
        return None;
    }
    Some(share(points, &(Rational::from(earned.0) / Rational::from(possible.0))))
}

/// What the boxes add up to so far: everything that waits for a person counts for nothing.
pub(super) fn so_far(
    cover: &Cover,
    total: Tally,
    rows: &[ObservedRow],
    observed: &[(String, Option<Points>)],
    hand: Option<&HandMarks>,
) -> Points {
    let given: Vec<_> =
        observed.iter().map(|(id, points)| (id.clone(), Some(points.unwrap_or(Points::ZERO)))).collect();
    let boxes = boxes(cover, &Parts::new(total, false, rows, &given), hand);
    boxes.iter().filter_map(|(_, _, earned)| *earned).sum()
}

/// The sum of the boxes, `None` while one is empty.
pub(super) fn total(boxes: &[(String, Points, Option<Points>)]) -> Option<Points> {
    boxes.iter().map(|(_, _, earned)| *earned).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::CoverRow;

    fn cover(from: &[(&str, i64, CoverSource)]) -> Cover {
        let row = |(id, points, from): &(&str, i64, CoverSource)| CoverRow {
            id: (*id).to_owned(),
            title: String::new(),
            points: Points(*points),
            from: *from,
        };
        Cover {
            rows: from.iter().map(row).collect(),
            total: from.iter().map(|(_, points, _)| Points(*points)).sum(),
        }
    }

    #[track_caller]
    fn check(
        questions: Option<(i64, i64)>,
        observed: Option<(i64, i64)>,
        viva: Option<i64>,
        want: [Option<i64>; 5],
    ) {
        let cover = cover(&[
            ("lab", 6500, CoverSource::QuestionsAndObserved),
            ("viva", 3500, CoverSource::ByHand),
            ("questions", 1000, CoverSource::Questions),
            ("observed", 1000, CoverSource::Observed),
        ]);
        let points =
            |part: Option<(i64, i64)>| part.map(|(earned, possible)| (Points(earned), Points(possible)));
        let parts = Parts { questions: points(questions), observed: points(observed) };
        let hand = HandMarks {
            cover: viva.map(|viva| ("viva".to_owned(), Points(viva))).into_iter().collect(),
            ..HandMarks::default()
        };
        let boxes = boxes(&cover, &parts, Some(&hand));
        let mut found: Vec<_> = boxes.iter().map(|(_, _, earned)| earned.map(|points| points.0)).collect();
        found.push(total(&boxes).map(|points| points.0));
        assert_eq!(found, want);
    }

    #[test]
    fn boxes_wait_for_their_parts() {
        // 65 · (36 + 28) / 80 = 52
        check(
            Some((3600, 4500)),
            Some((2800, 3500)),
            Some(3000),
            [Some(5200), Some(3000), Some(800), Some(800), Some(9800)],
        );
        // 65 · (21.5 + 35) / 80 = 45.90625
        check(Some((2150, 4500)), Some((3500, 3500)), None, [Some(4591), None, Some(478), Some(1000), None]);
        check(Some((3600, 4500)), None, Some(0), [None, Some(0), Some(800), None, None]);
        check(None, Some((2800, 3500)), Some(0), [None, Some(0), None, Some(800), None]);
        check(Some((0, 0)), Some((0, 0)), Some(0), [None, Some(0), None, None, None]);
    }
}

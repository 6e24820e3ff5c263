use super::figures::OwnCurves;
use super::view::FigureView;
use crate::lti::TransferFunction;
use crate::memo::Memo;
use crate::submission::Series;

/// Curves and figures of a lab's students, kept for those who hand in the same: most of a class has one of a few transfer
/// functions.
#[derive(Debug)]
pub struct Drawn {
    /// By the place on the page, and the student's own function.
    pub curves: Memo<(String, TransferFunction), Result<OwnCurves, String>>,
    pub figures: Memo<Shown, Vec<FigureView>>,
}

/// What a student adds to the figures at one place of the page.
#[derive(Debug, PartialEq, Eq, Hash)]
pub struct Shown {
    /// The place.
    pub id: String,
    pub function: Option<TransferFunction>,
    pub poles: Vec<[Bits; 2]>,
    pub data: Option<(Vec<String>, Vec<Bits>)>,
}

/// A number, by its bits.
type Bits = u64;

impl Drawn {
    /// Keeps up to `most` bytes.
    pub fn new(most: usize) -> Self {
        let curves = |_: &_, one: &Result<OwnCurves, String>| one.as_ref().map_or(1000, OwnCurves::size);
        let figures = |shown: &Shown, all: &Vec<FigureView>| {
            let data = shown.data.as_ref().map_or(0, |(_, numbers)| 8 * numbers.len());
            data + all.iter().map(|one| one.svg_html.len().unwrap_or(0) + 1000).sum::<usize>()
        };
        Self {
            curves: Memo::of_bytes(most / 2, most / 2 / 10_000, curves),
            figures: Memo::of_bytes(most / 2, most / 2 / 10_000, figures),
        }
    }
}

impl Shown {
    pub fn new(id: &str, function: Option<&TransferFunction>) -> Self {
        Self { id: id.to_owned(), function: function.cloned(), poles: Vec::new(), data: None }
    }

    pub fn with_poles(self, poles: &[(f64, f64)]) -> Self {
        Self { poles: poles.iter().map(|(re, im)| [re.to_bits(), im.to_bits()]).collect(), ..self }
    }

    pub fn with_data(self, data: Option<&Series>) -> Self {
        let numbers = |series: &Series| series.rows.iter().flatten().map(|number| number.to_bits()).collect();
        Self { data: data.map(|series| (series.headers.clone(), numbers(series))), ..self }
    }
}

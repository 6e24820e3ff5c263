use super::{Answer, AnswerValue, Decimal, FinalValue, TypedComplex, nonlinearity_name, shape_name};

/// Figures that show a decimal as it was typed.
const FIGURES: usize = 12;

impl Answer {
    /// The answer in words as it was understood: `-0.06s / (0.0132s^3 + …)`, `unstable`, `a PNG of 640 × 480 pixels`.
    ///
    /// The student's own text where the answer is prose or cannot be read: hostile until escaped.
    pub fn read_as(&self) -> String {
        match &self.value {
            Ok(value) => value.read_as(),
            Err(_) => self.text.trim().to_owned(),
        }
    }
}

impl AnswerValue {
    /// See [`Answer::read_as`].
    pub fn read_as(&self) -> String {
        match self {
            Self::TransferFunction { transfer_function, .. } => transfer_function.to_text(FIGURES),
            Self::Poles(poles) => {
                let shown: Vec<String> = poles.iter().map(TypedComplex::read_as).collect();
                if shown.is_empty() { "no poles".to_owned() } else { shown.join(", ") }
            }
            Self::Value(value) => value.read_as(),
            Self::Stability(stability) => stability.words().to_owned(),
            Self::Shape(shape) => shape_name(*shape).to_owned(),
            Self::Nonlinearity(kind) => nonlinearity_name(*kind).to_owned(),
            Self::Formula(formula) => match &formula.left {
                Some(left) => format!("{left} = {}", formula.right),
                None => formula.right.to_string(),
            },
            Self::Prose(text) => text.trim().to_owned(),
            Self::Figure(figure) => {
                let kind = if figure.media_type == "image/png" { "PNG" } else { "JPEG" };
                format!("a {kind} of {} × {} pixels", figure.width, figure.height)
            }
            Self::Data(series) => {
                let times = (series.rows.first(), series.rows.last());
                let ends = match times {
                    (Some(first), Some(last)) => {
                        let show =
                            |row: &[f64]| crate::algebra::significant(row.first().copied().unwrap_or(0.0), 6);
                        format!(" from {} s to {} s", show(first), show(last))
                    }
                    _ => String::new(),
                };
                let rows = series.rows.len();
                format!("{rows} {}{ends}", if rows == 1 { "point" } else { "points" })
            }
        }
    }
}

impl FinalValue {
    /// `0`, `0.889 Hz`, `unbounded`, `+∞`, `-∞`.
    pub fn read_as(&self) -> String {
        match self {
            Self::Number(number, Some(unit)) => format!("{} {}", number.text, unit.symbol()),
            Self::Number(number, None) => number.text.clone(),
            Self::Unbounded => "unbounded".to_owned(),
            Self::PlusInfinity => "+∞".to_owned(),
            Self::MinusInfinity => "-∞".to_owned(),
        }
    }
}

impl TypedComplex {
    /// `-0.143`, `-0.0195 + 5.59j`, `-2j`.
    pub fn read_as(&self) -> String {
        let imaginary = |im: &Decimal| format!("{}j", im.text);
        match (self.re.is_zero(), self.im.is_zero()) {
            (_, true) => self.re.text.clone(),
            (true, false) => imaginary(&self.im),
            (false, false) => match self.im.text.strip_prefix('-') {
                Some(size) => format!("{} - {size}j", self.re.text),
                None => format!("{} + {}", self.re.text, imaginary(&self.im)),
            },
        }
    }
}

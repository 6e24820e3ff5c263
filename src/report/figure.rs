//! A figure is data before it is SVG: what is drawn can be read, compared and tested without drawing.

/// A plot: curves, markers and bars over two axes, and what they say in words.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
    pub markers: Vec<Markers>,
    pub bars: Vec<Bar>,
    /// Draw the lines x = 0 and y = 0 where they cross the picture.
    pub zero_lines: bool,
    /// Below the picture, for everyone: what is seen, and what is out of sight.
    pub caption: String,
    /// For those who do not see the picture: the same in words and numbers.
    pub summary: String,
}

/// One axis: what it measures, its unit (may be empty), and the part of it that is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    pub label: String,
    pub unit: String,
    pub from: f64,
    pub to: f64,
}

/// A curve; points where it leaves the axes are clipped at the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// For the legend; empty keeps it out of the legend.
    pub name: String,
    pub look: Look,
    pub points: Vec<(f64, f64)>,
}

/// Single points of one kind: the poles of one system, say.
#[derive(Clone, Debug, PartialEq)]
pub struct Markers {
    pub name: String,
    pub look: Look,
    pub shape: MarkerShape,
    /// (x, y, words beside it).
    pub points: Vec<(f64, f64, String)>,
}

/// A bar of a histogram, standing on 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    pub from: f64,
    pub to: f64,
    pub height: f64,
}

/// Who a curve belongs to. Colour, dash pattern and width follow from it in the style sheet, never in the drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Look {
    /// What is right.
    Reference,
    /// What follows from the student's own answer.
    Student,
    /// Numbers the student handed in.
    Given,
    /// A fourth curve.
    Other,
    /// In the background: a driving signal, an ideal line.
    Faint,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MarkerShape {
    /// × – a pole.
    Cross,
    /// ○ – a zero.
    Circle,
    /// + – a pole of the student's.
    Plus,
    /// ◇ – a zero of the student's.
    Diamond,
    /// △ – a pole the student listed.
    Triangle,
}

/// Why a figure cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FigureError {
    #[error(
        "the {axis} axis of `{title}` goes from {from} to {to}: both must be finite and the first the smaller"
    )]
    Range { title: String, axis: &'static str, from: f64, to: f64 },
    #[error("`{series}` in `{title}` has a value that is not a number at point {index}")]
    NotFinite { title: String, series: String, index: usize },
    #[error("`{title}` cannot be drawn: {reason}")]
    Drawing { title: String, reason: String },
}

impl Axis {
    pub fn new(label: impl Into<String>, unit: impl Into<String>, from: f64, to: f64) -> Self {
        Self { label: label.into(), unit: unit.into(), from, to }
    }

    /// `time (s)`; the unit is left out where there is none.
    pub fn caption(&self) -> String {
        if self.unit.is_empty() { self.label.clone() } else { format!("{} ({})", self.label, self.unit) }
    }

    fn is_drawable(&self) -> bool {
        let width = self.to - self.from;
        let size = self.from.abs().max(self.to.abs());
        self.from.is_finite() && self.to.is_finite() && width.is_finite() && width > size * 1e-12
    }
}

impl Figure {
    /// A figure without curves yet.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            x,
            y,
            series: Vec::new(),
            markers: Vec::new(),
            bars: Vec::new(),
            zero_lines: false,
            caption: String::new(),
            summary: String::new(),
        }
    }

    /// Refuses what would hang or confuse the drawing: empty or infinite ranges, points that are not numbers.
    pub fn check(&self) -> Result<(), FigureError> {
        for (name, axis) in [("x", &self.x), ("y", &self.y)] {
            if !axis.is_drawable() {
                let title = self.title.clone();
                return Err(FigureError::Range { title, axis: name, from: axis.from, to: axis.to });
            }
        }
        let finite = |x: &f64, y: &f64| x.is_finite() && y.is_finite();
        let not_finite = |series: &str, index| {
            Err(FigureError::NotFinite { title: self.title.clone(), series: series.to_owned(), index })
        };
        for series in &self.series {
            if let Some(index) = series.points.iter().position(|(x, y)| !finite(x, y)) {
                return not_finite(&series.name, index);
            }
        }
        for markers in &self.markers {
            if let Some(index) = markers.points.iter().position(|(x, y, _)| !finite(x, y)) {
                return not_finite(&markers.name, index);
            }
        }
        match self.bars.iter().position(|b| !finite(&b.from, &b.to) || !b.height.is_finite()) {
            Some(index) => not_finite("bars", index),
            None => Ok(()),
        }
    }
}

/// The range `from`..=`to` with `share` of its width added on both sides; never empty.
pub fn padded(from: f64, to: f64, share: f64) -> (f64, f64) {
    let size = from.abs().max(to.abs());
    let width = to - from;
    let pad = if width > size * 1e-9 && width > 0.0 {
        share * width
    } else if size > 0.0 {
        0.5 * size
    } else {
        1.0
    };
    (from - pad, to + pad)
}

/// Smallest and largest of `values`; `None` when there are none or one is not finite.
pub fn extent(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let mut range: Option<(f64, f64)> = None;
    for v in values {
        if !v.is_finite() {
            return None;
        }
        range = Some(range.map_or((v, v), |(lo, hi)| (lo.min(v), hi.max(v))));
    }
    range
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(x: (f64, f64), y: (f64, f64), points: &[(f64, f64)]) -> Figure {
        let mut f = Figure::new("t", Axis::new("time", "s", x.0, x.1), Axis::new("y", "", y.0, y.1));
        f.series.push(Series { name: "c".into(), look: Look::Reference, points: points.to_vec() });
        f
    }

    #[track_caller]
    fn check(rows: &[(&str, Figure, bool)]) {
        for (what, figure, drawable) in rows {
            assert_eq!(figure.check().is_ok(), *drawable, "{what}: {:?}", figure.check());
        }
    }

    #[test]
    fn what_would_hang_or_mislead_is_refused() {
        let unit = (0.0, 1.0);
        check(&[
            ("ordinary", figure(unit, unit, &[(0.0, 0.0), (1.0, 1.0)]), true),
            ("no points", figure(unit, unit, &[]), true),
            ("infinite range", figure((0.0, f64::INFINITY), unit, &[]), false),
            ("not a number in the range", figure((f64::NAN, 1.0), unit, &[]), false),
            ("empty range", figure(unit, (2.0, 2.0), &[]), false),
            ("reversed range", figure((1.0, 0.0), unit, &[]), false),
            ("range below rounding", figure((1.0, 1.0 + 1e-15), unit, &[]), false),
            ("width overflows", figure((-f64::MAX, f64::MAX), unit, &[]), false),
            ("not a number in a curve", figure(unit, unit, &[(0.0, f64::NAN)]), false),
            ("infinity in a curve", figure(unit, unit, &[(f64::INFINITY, 0.0)]), false),
        ]);
    }

    #[test]
    fn padding_never_leaves_an_empty_range() {
        for (from, to) in [(0.0, 0.0), (3.0, 3.0), (-1.0, 2.0), (1e-30, 1e-30), (5.0, 5.0 + 1e-12)] {
            let (a, b) = padded(from, to, 0.1);
            assert!(a < from && to < b, "{from}..{to} became {a}..{b}");
        }
    }
}

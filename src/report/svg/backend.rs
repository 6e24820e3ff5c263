use super::simplify::simplify;
use super::text_width::text_width;
use crate::report::escape::escape;
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
};
use std::convert::Infallible;
use std::fmt::Write as _;

/// What an element is; the style sheet gives it its look. Travels through plotters as a colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Class(u8);

macro_rules! classes {
    ($($constant:ident = $index:literal $name:literal),+ $(,)?) => {
        impl Class {
            $(pub const $constant: Self = Self($index);)+

            fn name(self) -> &'static str {
                match self.0 { $($index => $name,)+ _ => "ink" }
            }
        }
    };
}

classes! {
    INK = 0 "ink", GRID = 1 "grid", ZERO = 2 "zero", TICK = 3 "tick", LABEL = 4 "label", TITLE = 5 "title",
    REFERENCE = 6 "s0", STUDENT = 7 "s1", GIVEN = 8 "s2", OTHER = 9 "s3", FAINT = 10 "faint",
    REFERENCE_MARK = 11 "m0", STUDENT_MARK = 12 "m1", GIVEN_MARK = 13 "m2", OTHER_MARK = 14 "m3",
    BAR = 15 "bar",
}

impl Class {
    pub fn colour(self) -> plotters::style::RGBColor {
        plotters::style::RGBColor(self.0, 0, 0)
    }

    fn of(colour: BackendColor) -> Self {
        Self(colour.rgb.0)
    }
}

/// Collects SVG elements. Coordinates are tenths of a pixel, written as the integers they are under a ten-times `viewBox`.
pub struct Paper<'a> {
    size: (u32, u32),
    out: &'a mut String,
    /// Path data of the run being merged, and its class.
    run: Option<(Class, String)>,
}

/// How far, in tenths of a pixel, a drawn curve may stand from the true one.
const TOLERANCE: f64 = 1.5;

impl<'a> Paper<'a> {
    /// Writes to the end of `out`; everything is there once `present` has been called.
    pub fn new(out: &'a mut String, size: (u32, u32)) -> Self {
        Self { size, out, run: None }
    }

    fn flush(&mut self) {
        if let Some((class, path)) = self.run.take() {
            let _ = write!(self.out, "<path class=\"{}\" d=\"{path}\"/>", class.name());
        }
    }

    /// Lines of one class that follow each other share one path.
    fn run_of(&mut self, class: Class) -> &mut String {
        if self.run.as_ref().is_none_or(|(c, _)| *c != class) {
            self.flush();
        }
        &mut self.run.get_or_insert_with(|| (class, String::new())).1
    }

    fn polyline(&mut self, class: Class, points: &[BackendCoord], closed: bool) {
        let points = simplify(points, TOLERANCE);
        let Some((&first, rest)) = points.split_first() else { return };
        let path = self.run_of(class);
        let _ = write!(path, "M{} {}", first.0, first.1);
        let mut last = first;
        let mut command = ' ';
        for &p in rest {
            let (dx, dy) = (p.0 - last.0, p.1 - last.1);
            let wanted = if dy == 0 {
                'h'
            } else if dx == 0 {
                'v'
            } else {
                'l'
            };
            if wanted != command {
                path.push(wanted);
            }
            // A minus sign separates two numbers as well as a space does.
            let number = |path: &mut String, v: i32, after_number: bool| {
                let _ = if after_number && v >= 0 { write!(path, " {v}") } else { write!(path, "{v}") };
            };
            match wanted {
                'h' => number(path, dx, wanted == command),
                'v' => number(path, dy, wanted == command),
                _ => {
                    number(path, dx, wanted == command);
                    number(path, dy, true);
                }
            }
            command = wanted;
            last = p;
        }
        if closed {
            path.push('z');
        }
    }
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

impl DrawingBackend for Paper<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        self.flush();
        Ok(())
    }

    fn draw_pixel(&mut self, point: BackendCoord, colour: BackendColor) -> Drawn {
        self.polyline(Class::of(colour), &[point, (point.0 + 1, point.1)], false);
        Ok(())
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Drawn {
        self.polyline(Class::of(style.color()), &[from, to], false);
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        let points: Vec<_> = path.into_iter().collect();
        self.polyline(Class::of(style.color()), &points, false);
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        let points: Vec<_> = path.into_iter().collect();
        self.polyline(Class::of(style.color()), &points, true);
        Ok(())
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
        _: bool,
    ) -> Drawn {
        let corners = [from, (to.0, from.1), to, (from.0, to.1)];
        self.polyline(Class::of(style.color()), &corners, true);
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        centre: BackendCoord,
        radius: u32,
        style: &S,
        _: bool,
    ) -> Drawn {
        let path = self.run_of(Class::of(style.color()));
        let d = 2 * radius;
        let _ = write!(
            path,
            "M{} {}a{radius} {radius} 0 1 0 {d} 0a{radius} {radius} 0 1 0-{d} 0",
            centre.0 - radius as i32,
            centre.1
        );
        Ok(())
    }

    fn draw_text<T: BackendTextStyle>(&mut self, text: &str, style: &T, at: BackendCoord) -> Drawn {
        // Ticks and their labels take turns: all of an axis stays one path.
        if self.run.as_ref().is_some_and(|(class, _)| *class != Class::INK) {
            self.flush();
        }
        // The style sheet knows what these stand for.
        let anchor = match style.anchor().h_pos {
            HPos::Left => "",
            HPos::Right => " e",
            HPos::Center => " m",
        };
        // From the given corner to the baseline, in em of a common sans-serif face.
        let drop = match style.anchor().v_pos {
            VPos::Top => 0.76,
            VPos::Center => 0.34,
            VPos::Bottom => -0.22,
        };
        let y = at.1 + (drop * style.size()).round() as i32;
        let class = Class::of(style.color()).name();
        let _ = write!(self.out, "<text class=\"{class}{anchor}\" x=\"{}\" y=\"{y}\">", at.0);
        escape(self.out, text);
        self.out.push_str("</text>");
        Ok(())
    }

    fn estimate_text_size<T: BackendTextStyle>(
        &self,
        text: &str,
        style: &T,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        Ok(((text_width(text) * style.size()).ceil() as u32, style.size().ceil() as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_relative_and_runs_are_merged() {
        let mut out = String::new();
        let mut paper = Paper::new(&mut out, (1000, 1000));
        let ink = |class: Class| BackendColor { alpha: 1.0, rgb: (class.0, 0, 0) };
        paper.draw_line((0, 0), (100, 0), &ink(Class::GRID)).unwrap();
        paper.draw_line((0, 50), (100, 50), &ink(Class::GRID)).unwrap();
        paper.draw_path([(0, 0), (50, 80), (100, 20)], &ink(Class::REFERENCE)).unwrap();
        paper.present().unwrap();
        assert_eq!(
            out,
            r#"<path class="grid" d="M0 0h100M0 50h100"/><path class="s0" d="M0 0l50 80 50-60"/>"#
        );
    }
}

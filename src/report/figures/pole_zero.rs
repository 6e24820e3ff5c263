use crate::lti::Pole;
use crate::report::figure::{Axis, Figure, Look, MarkerShape, Markers, extent, padded};
use crate::report::numbers::{complex, counted};

/// The student's side of a pole–zero map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StudentRoots {
    /// Of the student's own transfer function.
    pub poles: Vec<Pole>,
    pub zeros: Vec<Pole>,
    /// (re, im) as the student listed them.
    pub listed: Vec<(f64, f64)>,
}

/// Poles and zeros in the complex plane, the student's over the reference's.
pub fn pole_zero(title: &str, poles: &[Pole], zeros: &[Pole], student: Option<&StudentRoots>) -> Figure {
    let place = |p: &Pole| (p.re, p.im);
    let reference: Vec<_> = poles.iter().chain(zeros).map(place).collect();
    let mut figure =
        Figure::new(title, Axis::new("real part", "rad/s", 0.0, 0.0), Axis::new("", "", 0.0, 0.0));
    let mut add = |name: &str, look, shape, points: Vec<(f64, f64, String)>| {
        if !points.is_empty() {
            figure.markers.push(Markers { name: name.to_owned(), look, shape, points });
        }
    };
    add("poles", Look::Reference, MarkerShape::Cross, poles.iter().map(marked).collect());
    add("zeros", Look::Reference, MarkerShape::Circle, zeros.iter().map(marked).collect());
    let mut own = Vec::new();
    if let Some(student) = student {
        own.extend(student.poles.iter().chain(&student.zeros).map(place));
        own.extend(&student.listed);
        let plain = |p: &Pole| (p.re, p.im, String::new());
        add("your poles", Look::Student, MarkerShape::Plus, student.poles.iter().map(plain).collect());
        add("your zeros", Look::Student, MarkerShape::Diamond, student.zeros.iter().map(plain).collect());
        let listed = student.listed.iter().map(|(re, im)| (*re, *im, String::new())).collect();
        add("poles you listed", Look::Given, MarkerShape::Triangle, listed);
    }

    let reach = |points: &[(f64, f64)], part: fn(&(f64, f64)) -> f64| {
        points.iter().map(|p| part(p).abs()).filter(|v| v.is_finite()).fold(0.0, f64::max)
    };
    let size = reach(&reference, |p| p.0).max(reach(&reference, |p| p.1)).max(1e-9);
    let limit = (4.0 * size).max(if reference.is_empty() { f64::MAX.sqrt() } else { 0.0 });
    let seen: Vec<_> = own.iter().copied().filter(|p| p.0.abs() <= limit && p.1.abs() <= limit).collect();
    let shown: Vec<_> = reference.iter().chain(&seen).copied().collect();
    let (left, right) = extent(shown.iter().map(|p| p.0).chain([0.0])).unwrap_or((-1.0, 1.0));
    let (left, right) = padded(left, right, 0.15);
    let tall = match shown.iter().map(|p| p.1.abs()).fold(0.0, f64::max) {
        0.0 => 0.5 * (right - left),
        tall => 1.2 * tall,
    };
    figure.x = Axis::new("real part", "rad/s", left, right);
    figure.y = Axis::new("imaginary part", "rad/s", -tall, tall);
    figure.zero_lines = true;
    figure.markers.iter_mut().for_each(|m| m.points.retain(|p| p.0.is_finite() && p.1.is_finite()));

    let outside = own.len() - seen.len();
    figure.caption = match outside {
        0 => String::new(),
        1 => "One of your points lies far outside the picture.".to_owned(),
        n => format!("{n} of your points lie far outside the picture."),
    };
    figure.summary = format!("Reference: {}; {}.", named("pole", poles), named("zero", zeros));
    if let Some(student) = student.filter(|s| !s.poles.is_empty() || !s.zeros.is_empty()) {
        figure.summary += &format!(
            " Your transfer function: {}; {}.",
            named("pole", &student.poles),
            named("zero", &student.zeros)
        );
    }
    if let Some(student) = student.filter(|s| !s.listed.is_empty()) {
        figure.summary += &format!(" You listed {}.", counted(student.listed.len(), "pole"));
    }
    figure
}

/// `−0.143, −0.0195 ± 5.59j (double)`: conjugate pairs once.
pub fn root_words(roots: &[Pole], figures: usize) -> String {
    let upper = roots.iter().filter(|p| p.im >= 0.0);
    let words: Vec<_> = upper
        .map(|p| {
            let value = complex(p.re, p.im, p.im != 0.0, figures);
            match multiplicity(p.multiplicity) {
                None => value,
                Some(words) => format!("{value} ({words})"),
            }
        })
        .collect();
    words.join(", ")
}

fn named(what: &str, roots: &[Pole]) -> String {
    match roots.len() {
        0 => format!("no {what}s"),
        1 => format!("{what} at {}", root_words(roots, 4)),
        _ => format!("{what}s at {}", root_words(roots, 4)),
    }
}

fn marked(p: &Pole) -> (f64, f64, String) {
    (p.re, p.im, multiplicity(p.multiplicity).unwrap_or_default())
}

fn multiplicity(times: usize) -> Option<String> {
    match times {
        0 | 1 => None,
        2 => Some("double".to_owned()),
        3 => Some("triple".to_owned()),
        n => Some(format!("{n}-fold")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pole(re: f64, im: f64, multiplicity: usize) -> Pole {
        Pole { re, im, multiplicity, error_bound: 0.0 }
    }

    #[test]
    fn every_root_is_in_the_picture() {
        let poles = [pole(-0.143, 0.0, 1), pole(-0.0195, 5.59, 1), pole(-0.0195, -5.59, 1)];
        let figure = pole_zero("t", &poles, &[pole(0.0, 0.0, 2)], None);
        assert!(figure.check().is_ok());
        assert!(figure.x.from < -0.143 && figure.x.to > 0.0 && figure.y.to > 5.59);
        assert_eq!(figure.markers[1].points, [(0.0, 0.0, "double".to_owned())]);
        assert_eq!(figure.summary, "Reference: poles at −0.143, −0.0195 ± 5.59j; zero at 0 (double).");
    }

    #[test]
    fn far_or_broken_student_roots_do_not_squash_the_map() {
        let student = StudentRoots {
            poles: vec![pole(-1.0, 0.0, 1)],
            zeros: vec![],
            listed: vec![(1e12, 0.0), (f64::INFINITY, f64::NAN)],
        };
        let figure = pole_zero("t", &[pole(-2.0, 0.0, 1)], &[], Some(&student));
        assert!(figure.check().is_ok(), "{:?}", figure.check());
        assert!(figure.x.to < 10.0);
        assert_eq!(figure.caption, "2 of your points lie far outside the picture.");
    }

    #[test]
    fn a_map_of_nothing_still_has_axes() {
        assert!(pole_zero("t", &[], &[], None).check().is_ok());
    }
}

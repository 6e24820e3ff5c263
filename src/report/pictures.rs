//! Which figures stand at a question: drawn once for the lab, and again only where a student has something to add.

use super::anchor::anchor;
use super::answers::find;
use super::drawn::{Drawn, Shown};
use super::figure::{Figure, FigureError};
use super::figures::{
    PreparedResponse, PreparedSimulation, StudentCurves, StudentRoots, characteristic_figure,
    comparison_figure, pole_zero, tangent_figure,
};
use super::numbers::counted;
use super::svg;
use super::view::FigureView;
use crate::algebra::to_f64;
use crate::lab::{Check, Curve, LabDefinition, Question, SystemRef};
use crate::lti::{InputKind, Pole, Response, ResponseError, TransferFunction};
use crate::reference::Reference;
use crate::submission::{AnswerValue, Series, Submission};

/// A place for figures on the page.
pub enum Picture {
    PoleZero(Box<PoleZeroPicture>),
    Response(Box<ResponsePicture>),
    Simulation(Box<SimulationPicture>),
    /// The same for everyone.
    Fixed(FigureView),
}

pub struct PoleZeroPicture {
    id: String,
    title: String,
    poles: Vec<Pole>,
    zeros: Vec<Pole>,
    transfer_function_field: Option<String>,
    poles_field: Option<String>,
    shared: FigureView,
}

pub struct ResponsePicture {
    id: String,
    kind: InputKind,
    prepared: PreparedResponse,
    transfer_function_field: Option<String>,
    data_field: Option<String>,
    shared: Vec<FigureView>,
}

pub struct SimulationPicture {
    id: String,
    prepared: PreparedSimulation,
    data_field: Option<String>,
    shared: FigureView,
}

/// Draws `figure` under `id`.
pub fn draw(figure: &Figure, id: &str) -> Result<FigureView, FigureError> {
    Ok(FigureView { svg_html: svg::render(figure, id)?.into(), caption: figure.caption.clone() })
}

/// The places for figures at a question, from what its criteria ask about.
pub fn of_question(
    lab: &LabDefinition,
    reference: &Reference,
    question: &Question,
) -> Result<Vec<Picture>, FigureError> {
    let mut pictures = Vec::new();
    let mut number = 0;
    let mut next_id = || {
        number += 1;
        anchor("figure", &format!("{}-{number}", question.id))
    };
    for system in systems(question) {
        let Some(point) = find(reference, &system) else { continue };
        if let Some(tangent) = &point.tangent {
            pictures.push(Picture::Fixed(draw(&tangent_figure(point, tangent), &next_id())?));
            continue;
        }
        let main = point.main();
        let transfer_function_field = transfer_function_field(lab, &system);
        let (id, title) = (next_id(), format!("{}: poles and zeros", point.title));
        let shared = draw(&pole_zero(&title, &main.poles, &main.zeros, None), &id)?;
        pictures.push(Picture::PoleZero(Box::new(PoleZeroPicture {
            id,
            title,
            poles: main.poles.clone(),
            zeros: main.zeros.clone(),
            transfer_function_field: transfer_function_field.clone(),
            poles_field: field_where(question, |c| matches!(c, Check::Poles { of, .. } if *of == system)),
            shared,
        })));
        for kind in kinds(question, &system) {
            let Some(known) = main.response(kind) else { continue };
            let prepared = PreparedResponse::new(point, known);
            let id = next_id();
            let shared = views(&prepared.figures(StudentCurves::default()), &id)?;
            pictures.push(Picture::Response(Box::new(ResponsePicture {
                id,
                kind,
                prepared,
                transfer_function_field: transfer_function_field.clone(),
                data_field: data_field(
                    question,
                    |curve| matches!(curve, Curve::Response { of, response } if *of == system && *response == kind),
                ),
                shared,
            })));
        }
        for (push, samples) in point.comparison.iter().flat_map(|comparison| &comparison.runs) {
            pictures.push(Picture::Fixed(draw(&comparison_figure(point, *push, samples), &next_id())?));
        }
    }
    for definition in lab.simulations.iter().filter(|s| s.shown_in == question.id) {
        let Some(simulated) = reference.simulations.iter().find(|s| s.id == definition.id) else { continue };
        let prepared = PreparedSimulation::new(definition, simulated);
        let id = next_id();
        let shared = draw(&prepared.figure(None), &id)?;
        let data_field =
            data_field(question, |curve| matches!(curve, Curve::Simulation { id } if *id == definition.id));
        pictures.push(Picture::Simulation(Box::new(SimulationPicture { id, prepared, data_field, shared })));
        pictures.push(Picture::Fixed(draw(&characteristic_figure(definition, simulated), &next_id())?));
    }
    Ok(pictures)
}

impl Picture {
    /// The figures as this student sees them. What cannot be drawn falls back on the reference alone, and says why.
    pub fn for_student(&self, submission: &Submission, drawn: &Drawn) -> Vec<FigureView> {
        match self {
            Self::Fixed(view) => vec![view.clone()],
            Self::PoleZero(picture) => picture.for_student(submission, drawn),
            Self::Response(picture) => picture.for_student(submission, drawn),
            Self::Simulation(picture) => picture.for_student(submission, drawn),
        }
    }
}

impl PoleZeroPicture {
    fn for_student(&self, submission: &Submission, drawn: &Drawn) -> Vec<FigureView> {
        let own = own_transfer_function(submission, self.transfer_function_field.as_deref());
        let listed: Vec<(f64, f64)> = match value(submission, self.poles_field.as_deref()) {
            Some(AnswerValue::Poles(listed)) => {
                listed.iter().map(|p| (to_f64(&p.re.value), to_f64(&p.im.value))).collect()
            }
            _ => Vec::new(),
        };
        if own.is_none() && listed.is_empty() {
            return vec![self.shared.clone()];
        }
        let shown = Shown::new(&self.id, own).with_poles(&listed);
        drawn.figures.get(shown, |_| vec![self.draw(own, listed)]).to_vec()
    }

    fn draw(&self, own: Option<&TransferFunction>, listed: Vec<(f64, f64)>) -> FigureView {
        let mut student = StudentRoots { listed, ..StudentRoots::default() };
        if let Some(g) = own
            && let (Ok(poles), Ok(zeros)) = (g.poles(), g.zeros())
        {
            (student.poles, student.zeros) = (poles, zeros);
        }
        if student == StudentRoots::default() {
            return self.shared.clone();
        }
        let figure = pole_zero(&self.title, &self.poles, &self.zeros, Some(&student));
        draw(&figure, &self.id).unwrap_or_else(|_| self.shared.clone())
    }
}

impl ResponsePicture {
    fn for_student(&self, submission: &Submission, drawn: &Drawn) -> Vec<FigureView> {
        let own = own_transfer_function(submission, self.transfer_function_field.as_deref());
        let data = series(submission, self.data_field.as_deref());
        if own.is_none() && data.is_none() {
            return self.shared.clone();
        }
        let shown = Shown::new(&self.id, own).with_data(data);
        drawn.figures.get(shown, |_| self.draw(own, data, drawn)).to_vec()
    }

    fn draw(&self, own: Option<&TransferFunction>, data: Option<&Series>, drawn: &Drawn) -> Vec<FigureView> {
        let curves = own.map(|g| {
            drawn.curves.get((self.id.clone(), g.clone()), |(_, g)| {
                let response = Response::new(g, self.kind).map_err(|error| why(&error))?;
                Ok(self.prepared.own_curves(&response))
            })
        });
        let curves = curves.as_deref();
        let own = curves.and_then(|curves| curves.as_ref().ok());
        let figures = self.prepared.figures(StudentCurves { own, data });
        let mut views = views(&figures, &self.id).unwrap_or_else(|_| self.shared.clone());
        if let (Some(first), Some(Err(why))) = (views.first_mut(), curves) {
            let trouble = format!("The response of your transfer function cannot be drawn: {why}.");
            first.caption = format!("{trouble} {}", first.caption).trim().to_owned();
        }
        let alone = own.and_then(|own| own.alone.as_ref());
        views.extend(alone.and_then(|figure| draw(figure, &format!("{}-own", self.id)).ok()));
        views
    }
}

impl SimulationPicture {
    fn for_student(&self, submission: &Submission, drawn: &Drawn) -> Vec<FigureView> {
        let Some(data) = series(submission, self.data_field.as_deref()) else {
            return vec![self.shared.clone()];
        };
        let shown = Shown::new(&self.id, None).with_data(Some(data));
        let figure =
            || draw(&self.prepared.figure(Some(data)), &self.id).unwrap_or_else(|_| self.shared.clone());
        drawn.figures.get(shown, |_| vec![figure()]).to_vec()
    }
}

fn why(error: &ResponseError) -> String {
    match error {
        ResponseError::Improper { num, den } => format!(
            "its numerator is of degree {num} and its denominator of degree {den}, {} too many",
            counted(num.saturating_sub(*den), "power")
        ),
        other => other.to_string(),
    }
}

fn views(figures: &[Figure], id: &str) -> Result<Vec<FigureView>, FigureError> {
    let suffix = |i: usize| if i == 0 { id.to_owned() } else { format!("{id}-{i}") };
    figures.iter().enumerate().map(|(i, figure)| draw(figure, &suffix(i))).collect()
}

/// Systems whose response a question asks about, in the order of its criteria.
pub fn systems(question: &Question) -> Vec<SystemRef> {
    let mut out: Vec<SystemRef> = Vec::new();
    for criterion in &question.criteria {
        let of = match &criterion.check {
            Check::Poles { of, .. }
            | Check::Stability { of }
            | Check::Feature { of, .. }
            | Check::Shape { of, .. }
            | Check::Plot { curve: Curve::Response { of, .. }, .. } => of,
            _ => continue,
        };
        if !out.contains(of) {
            out.push(of.clone());
        }
    }
    out
}

/// Which responses of `system` the question asks about; the impulse response if it names none.
fn kinds(question: &Question, system: &SystemRef) -> Vec<InputKind> {
    let mut out = Vec::new();
    for criterion in &question.criteria {
        let kind = match &criterion.check {
            Check::Feature { of, response, .. }
            | Check::Shape { of, response }
            | Check::Plot { curve: Curve::Response { of, response }, .. }
                if of == system =>
            {
                *response
            }
            _ => continue,
        };
        if !out.contains(&kind) {
            out.push(kind);
        }
    }
    if out.is_empty() { vec![InputKind::Impulse] } else { out }
}

/// The field of the whole lab that holds the student's transfer function of `system`.
fn transfer_function_field(lab: &LabDefinition, system: &SystemRef) -> Option<String> {
    lab.questions.iter().find_map(|q| {
        field_where(q, |check| {
            matches!(check, Check::Structure { of } | Check::Numerator { of, .. } | Check::Denominator { of, .. } if of == system)
        })
    })
}

fn field_where(question: &Question, wanted: impl Fn(&Check) -> bool) -> Option<String> {
    question.criteria.iter().find(|c| wanted(&c.check)).map(|c| c.field.clone())
}

fn data_field(question: &Question, wanted: impl Fn(&Curve) -> bool) -> Option<String> {
    question.criteria.iter().find_map(|c| match &c.check {
        Check::Plot { data: Some(field), curve, .. } if wanted(curve) => Some(field.clone()),
        _ => None,
    })
}

fn value<'a>(submission: &'a Submission, field: Option<&str>) -> Option<&'a AnswerValue> {
    submission.answers.get(field?)?.value.as_ref().ok()
}

fn own_transfer_function<'a>(
    submission: &'a Submission,
    field: Option<&str>,
) -> Option<&'a TransferFunction> {
    match value(submission, field)? {
        AnswerValue::TransferFunction { transfer_function, .. } => Some(transfer_function),
        _ => None,
    }
}

fn series<'a>(submission: &'a Submission, field: Option<&str>) -> Option<&'a Series> {
    match value(submission, field)? {
        AnswerValue::Data(series) if !series.rows.is_empty() => Some(series),
        _ => None,
    }
}

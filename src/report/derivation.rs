//! The derivation in letters as a view: every step of it as MathML.

use super::math::{block, inline};
use crate::algebra::{Expression, NodeKind, Rational, symbol_mathml};
use crate::model::{LetterDerivation, LetterEquation, LetterTerm, LettersError, Signal};
use serde::Serialize;

#[derive(Serialize)]
pub struct DerivationView {
    /// Why there is none; empty when there is one.
    missing: String,
    /// `θ = π`, `h = h₀`.
    rest_html: Vec<String>,
    /// The equations at rest that say something.
    balance_html: Vec<String>,
    /// Whether the transfer function has letters at all.
    has_letters: bool,
    /// Whether some letter has an index 0, or a δ.
    has_letters_at_rest: bool,
    has_deviations: bool,
    linear_html: Vec<String>,
    transformed_html: Vec<String>,
    cleared_html: Vec<String>,
    /// Empty for a single equation.
    matrix_html: String,
    /// As determinants; empty for a single equation.
    cramer_html: String,
    /// Multiplied out, nothing cancelled.
    eliminated_html: String,
    cancelled_html: String,
    /// Empty when nothing is cancelled and the step before says the same.
    transfer_html: String,
}

impl DerivationView {
    /// `printed`: whether the equations are the lab's own, and steps from them are worth showing.
    pub fn of(letters: &Result<LetterDerivation, LettersError>, printed: bool) -> Self {
        match letters {
            Ok(derivation) if printed => shown(derivation),
            Ok(derivation) => Self {
                linear_html: Vec::new(),
                transformed_html: Vec::new(),
                cleared_html: Vec::new(),
                matrix_html: String::new(),
                cramer_html: String::new(),
                ..shown(derivation)
            },
            Err(error) => Self {
                missing: error.to_string(),
                rest_html: Vec::new(),
                balance_html: Vec::new(),
                has_letters: false,
                has_letters_at_rest: false,
                has_deviations: false,
                linear_html: Vec::new(),
                transformed_html: Vec::new(),
                cleared_html: Vec::new(),
                matrix_html: String::new(),
                cramer_html: String::new(),
                eliminated_html: String::new(),
                cancelled_html: String::new(),
                transfer_html: String::new(),
            },
        }
    }
}

fn shown(d: &LetterDerivation) -> DerivationView {
    let all = |equations: &[LetterEquation]| -> Vec<String> { equations.iter().map(equation).collect() };
    let output = &d.unknowns[d.output];
    let name = format!("<mfrac>{}{}</mfrac>", output.to_mathml(), d.input.to_mathml());
    let several = d.unknowns.len() > 1;
    let signals = d.linear.iter().flat_map(|e| e.left.iter().chain(&e.right)).map(|term| &term.signal);
    let transfer = fraction(&d.num, &d.den);
    let eliminated = fraction(&d.numerator, &d.denominator);
    DerivationView {
        missing: String::new(),
        rest_html: d
            .rest
            .iter()
            .map(|at| inline(&format!("{}<mo>=</mo>{}", symbol_mathml(&at.name, 0), at.is.to_mathml())))
            .collect(),
        balance_html: d
            .rest_equations
            .iter()
            .map(|(left, right)| block(&format!("{}<mo>=</mo>{}", left.to_mathml(), right.to_mathml())))
            .collect(),
        has_letters: d.has_letters(),
        has_letters_at_rest: d.rest.iter().any(|at| matches!(at.is.kind, NodeKind::Symbol { .. })),
        has_deviations: signals.into_iter().any(|signal| signal.deviates),
        linear_html: all(&d.linear),
        transformed_html: all(&d.transformed),
        cleared_html: d.without_fractions.as_deref().map(all).unwrap_or_default(),
        matrix_html: if several { system(d) } else { String::new() },
        cramer_html: if several { cramer(d, &name) } else { String::new() },
        cancelled_html: d.cancelled.as_ref().map(|factor| inline(&factor.to_mathml())).unwrap_or_default(),
        transfer_html: if transfer == eliminated {
            String::new()
        } else {
            block(&format!("{name}<mo>=</mo>{transfer}"))
        },
        eliminated_html: block(&format!("{name}<mo>=</mo>{eliminated}")),
    }
}

fn fraction(num: &Expression, den: &Expression) -> String {
    if matches!(&den.kind, NodeKind::Number(one) if *one == Rational::ONE) {
        return num.to_mathml();
    }
    format!("<mfrac>{}{}</mfrac>", num.to_mathml(), den.to_mathml())
}

/// P(s) q(s) = r(s) u(s), written out.
fn system(d: &LetterDerivation) -> String {
    let unknowns: Vec<String> = d.unknowns.iter().map(Signal::to_mathml).collect();
    let forcing: Vec<String> = d.forcing.iter().map(Expression::to_mathml).collect();
    block(&format!(
        "{}{}<mo>=</mo>{}{}",
        table("matrix", &cells(d, None)),
        table("matrix", &unknowns.into_iter().map(|u| vec![u]).collect::<Vec<_>>()),
        table("matrix", &forcing.into_iter().map(|f| vec![f]).collect::<Vec<_>>()),
        d.input.to_mathml()
    ))
}

/// Cramer's rule with the determinants written out.
fn cramer(d: &LetterDerivation, name: &str) -> String {
    let (above, below) = (cells(d, Some(d.output)), cells(d, None));
    block(&format!(
        "{name}<mo>=</mo><mfrac>{}{}</mfrac>",
        table("determinant", &above),
        table("determinant", &below)
    ))
}

/// The matrix, with the forcing in place of one column.
fn cells(d: &LetterDerivation, replaced: Option<usize>) -> Vec<Vec<String>> {
    let rows = d.matrix.iter().zip(&d.forcing);
    rows.map(|(row, forcing)| {
        let cell =
            |(j, entry): (usize, &Expression)| if Some(j) == replaced { forcing } else { entry }.to_mathml();
        row.iter().enumerate().map(cell).collect()
    })
    .collect()
}

fn table(class: &str, rows: &[Vec<String>]) -> String {
    let row = |row: &Vec<String>| {
        let cells: String = row.iter().map(|cell| format!("<mtd>{cell}</mtd>")).collect();
        format!("<mtr>{cells}</mtr>")
    };
    format!("<mtable class=\"{class}\">{}</mtable>", rows.iter().map(row).collect::<String>())
}

fn equation(equation: &LetterEquation) -> String {
    block(&format!("{}<mo>=</mo>{}", side(&equation.left), side(&equation.right)))
}

fn side(terms: &[LetterTerm]) -> String {
    let mut row = String::new();
    for term in terms {
        row.push_str(match (row.is_empty(), term.negative) {
            (true, false) => "",
            (false, false) => "<mo>+</mo>",
            (_, true) => "<mo>−</mo>",
        });
        let coefficient = match &term.coefficient.kind {
            NodeKind::Number(one) if *one == Rational::ONE => String::new(),
            NodeKind::Add(..) | NodeKind::Subtract(..) => {
                format!("<mrow><mo>(</mo>{}<mo>)</mo></mrow>", term.coefficient.to_mathml())
            }
            _ => term.coefficient.to_mathml(),
        };
        row.push_str(&format!("<mrow>{coefficient}<mo>\u{2062}</mo>{}</mrow>", term.signal.to_mathml()));
    }
    if row.is_empty() { "<mn>0</mn>".to_owned() } else { row }
}

use super::sheet::{AnswerSheet, AnsweredIn, LineNames};
use super::{Answer, AnswerValue, LinePlace, Submission, TypedFormula};
use crate::algebra::{Expression, Rational};
use crate::model::is_light;
use crate::source::Finding;
use std::collections::BTreeMap;

/// Formulas that can be read, and that marking will have to leave to a person. Needs no right answer to tell.
pub(super) fn unworkable(submission: &Submission, sheet: &AnswerSheet) -> Vec<Finding> {
    let one = |answer: &Answer| {
        let letters = sheet.letters.get(&answer.path)?;
        let finding = match answer.value.as_ref().ok()? {
            AnswerValue::Formula(typed) => no_line(typed, letters.line.as_ref()?, &sheet.symbols),
            AnswerValue::TransferFunction { formula: Some(formula), .. }
                if letters.answered_in == AnsweredIn::Letters =>
            {
                too_much(formula)
            }
            _ => None,
        };
        Some(finding?.at(answer.span))
    };
    submission.answers.values().filter_map(one).collect()
}

/// Why the equation of a tangent cannot be worked out.
fn no_line(typed: &TypedFormula, names: &LineNames, symbols: &BTreeMap<String, Rational>) -> Option<Finding> {
    // Which names there are decides, and not what is right: any numbers will do that are nothing special.
    let some = |n: usize| Rational::from(7 * n + 3) / Rational::from(11);
    let mut values: BTreeMap<String, Rational> =
        names.at_rest.iter().enumerate().map(|(n, name)| (name.clone(), some(n))).collect();
    values.extend(symbols.clone());
    let place = LinePlace {
        output: &names.output,
        input: &names.input,
        x0: some(names.at_rest.len()),
        y0: some(names.at_rest.len() + 1),
        values: &values,
        at_rest: names.at_rest.iter().map(String::as_str).collect(),
    };
    let why = typed.lines(&place).err()?;
    let (x, y) = (&names.input, &names.output);
    let mut known = vec![format!("`{y}`"), format!("`{x}`"), format!("`{y}_0`"), format!("`{x}_0`")];
    known.extend(symbols.keys().map(|name| format!("`{name}`")));
    Some(
        Finding::warning("formula.not_worked_out", format!("{why}; a person will mark it."))
            .with_help(format!("Use numbers, and the names {}.", known.join(", "))),
    )
}

/// A formula in letters of which it will not be decided whether it is right for all their values.
fn too_much(formula: &Expression) -> Option<Finding> {
    (!is_light(formula)).then(|| {
        let message = "This formula is too large to be multiplied out: whether it is right for all values of the letters may be \
                       left to a person.";
        Finding::warning("transfer_function.too_large", message)
            .with_help("Cancel what can be cancelled, and collect the powers of `s`.")
    })
}

#[cfg(test)]
mod tests {
    use super::super::{Field, FieldKind, FieldLetters, NoFiles, read, self_check};
    use super::*;

    #[track_caller]
    fn check(kind: FieldKind, letters: FieldLetters, typed: &str, code: Option<&str>, says: &str) {
        let field = Field {
            path: "f".into(),
            kind,
            question: "f".into(),
            prompt: String::new(),
            about: None,
            response: None,
            unit: None,
            required: true,
        };
        let sheet = AnswerSheet {
            fields: vec![field],
            symbols: ["k", "b", "c", "d"].map(|name| (name.to_owned(), Rational::from(2))).into(),
            letters: [("f".to_owned(), letters)].into(),
            ..AnswerSheet::default()
        };
        let text = format!("answers:\n  f: {typed}\n");
        let submission = read("x", "x.yaml", text.as_bytes(), &sheet, &NoFiles);
        assert!(submission.answers["f"].value.is_ok(), "{typed}");
        let found = self_check(&submission, &sheet);
        let codes: Vec<&str> = found.iter().map(|one| one.code).collect();
        assert_eq!(codes, Vec::from_iter(code), "{typed}: {found:?}");
        assert!(
            found.iter().all(|one| one.message.contains(says) && one.help.is_some()),
            "{typed}: {found:?}"
        );
    }

    #[test]
    fn what_a_person_will_have_to_read_is_told_before() {
        let line = |typed: &str, code, says| {
            let names =
                LineNames { output: "y".into(), input: "x".into(), at_rest: vec!["y".into(), "x".into()] };
            let letters = FieldLetters { line: Some(names), ..FieldLetters::default() };
            check(FieldKind::Formula, letters, typed, code, says);
        };
        for typed in ["y = k*x + 1", "dy = 3 dx", "y = y_0 + k*(x - x0)", "y = 3x", "y = x^2", "f(x) = 2"] {
            line(typed, None, "");
        }
        for (typed, says) in [
            ("y = q*x + 1", "`q` is not a name we know; a person will mark it."),
            ("y = 3x + C", "`C`"),
            ("dy = K dx", "`K`"),
            ("y = sin(x)", "cannot be worked out"),
        ] {
            line(typed, Some("formula.not_worked_out"), says);
        }
        let letters = |typed: &str, code| {
            let letters = FieldLetters { answered_in: AnsweredIn::Letters, ..FieldLetters::default() };
            check(FieldKind::TransferFunction, letters, typed, code, "too large");
        };
        for typed in ["k/(s + b)", "k*s/((c*s + b)*(d*s^2 + b*s + k) + c*d/(s + b) - k^2)", "k/s*(b + c)^10"]
        {
            letters(typed, None);
        }
        for typed in ["k/(s + b)*(k + b + c + d)^25/(k + b + c + d)^25", "k/(s + (k + b + c + d)^30)"] {
            letters(typed, Some("transfer_function.too_large"));
        }
    }
}

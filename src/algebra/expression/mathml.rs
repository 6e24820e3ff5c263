use super::super::number_text::number_mathml;
use super::super::{Rational, symbol_mathml};
use super::text::{Level, number_text};
use super::{Expression, Function, NodeKind};
use std::borrow::Cow;

impl Expression {
    /// As a textbook prints it, in MathML without the `<math>` around it.
    ///
    /// Quotients are fractions, products stand side by side, primes are dots, names of Greek letters are letters.
    /// Each term of a sum is one `<mrow>`.
    pub fn to_mathml(&self) -> String {
        sum(self)
    }
}

/// A sum as a row of terms; anything else as one term.
fn sum(node: &Expression) -> String {
    let mut terms = Vec::new();
    collect_terms(node, false, &mut terms);
    let mut row = String::from("<mrow>");
    for (i, (negative, term)) in terms.iter().enumerate() {
        match (i, negative) {
            (0, false) => {}
            (_, false) => row.push_str("<mo>+</mo>"),
            (_, true) => row.push_str("<mo>−</mo>"),
        }
        row.push_str("<mrow>");
        row.push_str(&product(term, Position::Last));
        row.push_str("</mrow>");
    }
    row.push_str("</mrow>");
    row
}

/// The terms of a sum with their signs, left to right. What parentheses hold together on the right of a minus stays one term.
fn collect_terms<'a>(node: &'a Expression, negative: bool, terms: &mut Vec<(bool, Cow<'a, Expression>)>) {
    match &node.kind {
        NodeKind::Add(a, b) if !negative => {
            collect_terms(a, false, terms);
            collect_terms(b, false, terms);
        }
        NodeKind::Subtract(a, b) if !negative => {
            collect_terms(a, false, terms);
            terms.push((true, Cow::Borrowed(b)));
        }
        _ if !negative && terms.is_empty() => match without_leading_sign(node) {
            Some(rest) => terms.push((true, Cow::Owned(rest))),
            None => terms.push((false, Cow::Borrowed(node))),
        },
        _ => terms.push((negative, Cow::Borrowed(node))),
    }
}

/// (−a)·b as a·b, for the sign that is then written before it.
fn without_leading_sign(node: &Expression) -> Option<Expression> {
    match &node.kind {
        NodeKind::Negate(a) => Some((**a).clone()),
        NodeKind::Multiply(a, b) => {
            let kind = NodeKind::Multiply(Box::new(without_leading_sign(a)?), b.clone());
            Some(Expression { kind, ..*node })
        }
        _ => None,
    }
}

/// Whether something follows in the same product: `sin θ x` would read as sin(θx).
#[derive(Clone, Copy, PartialEq)]
enum Position {
    Followed,
    Last,
}

fn product(node: &Expression, position: Position) -> String {
    match &node.kind {
        NodeKind::Multiply(a, b) => {
            let left = product(a, Position::Followed);
            let right = match b.kind {
                // a·(b·c) was grouped by hand: keep the group visible only where it changes the reading.
                NodeKind::Multiply(..) => product(b, position),
                _ => factor(b, position),
            };
            format!("{left}{}{right}", between(a, b))
        }
        _ => factor(node, position),
    }
}

/// What stands between two factors.
fn between(a: &Expression, b: &Expression) -> &'static str {
    if starts_with_digit(b) {
        return "<mo>·</mo>";
    }
    if is_word(last_factor(a)) || is_word(first_factor(b)) {
        return "<mspace width=\"0.2em\"/>";
    }
    match first_factor(b).kind {
        NodeKind::Call(..) => "<mspace width=\"0.17em\"/>",
        _ => "<mo>\u{2062}</mo>",
    }
}

fn first_factor(node: &Expression) -> &Expression {
    match &node.kind {
        NodeKind::Multiply(a, _) => first_factor(a),
        _ => node,
    }
}

fn last_factor(node: &Expression) -> &Expression {
    match &node.kind {
        NodeKind::Multiply(_, b) => last_factor(b),
        _ => node,
    }
}

fn starts_with_digit(node: &Expression) -> bool {
    match &node.kind {
        NodeKind::Number(_) => true,
        NodeKind::Multiply(a, _) | NodeKind::Power(a, _) => starts_with_digit(a),
        _ => false,
    }
}

/// A name of several letters that is not one glyph: `mass`.
fn is_word(node: &Expression) -> bool {
    match &node.kind {
        NodeKind::Symbol { name, .. } => {
            let base = name.split('_').next().unwrap_or(name);
            let base = base.trim_end_matches(|c: char| c.is_ascii_digit());
            base.chars().count() > 1 && super::super::greek::letter(base).is_none()
        }
        NodeKind::Power(base, _) => is_word(base),
        _ => false,
    }
}

fn factor(node: &Expression, position: Position) -> String {
    match &node.kind {
        NodeKind::Number(value) => number(value),
        NodeKind::Pi => "<mi>π</mi>".to_owned(),
        NodeKind::Symbol { name, primes } => symbol_mathml(name, *primes),
        NodeKind::Divide(a, b) => format!("<mfrac>{}{}</mfrac>", sum(a), sum(b)),
        NodeKind::Power(a, b) => raised(a, b, position),
        NodeKind::Call(function, a) => call(*function, None, a, position),
        NodeKind::Negate(_) | NodeKind::Add(..) | NodeKind::Subtract(..) | NodeKind::Multiply(..) => {
            parenthesized(node)
        }
    }
}

fn parenthesized(node: &Expression) -> String {
    format!("<mrow><mo>(</mo>{}<mo>)</mo></mrow>", sum(node))
}

fn raised(base: &Expression, exponent: &Expression, position: Position) -> String {
    if let (NodeKind::Call(function, a), NodeKind::Number(n)) = (&base.kind, &exponent.kind)
        && *n > Rational::ONE
        && n.is_int()
        && !matches!(function, Function::Exp | Function::Sqrt | Function::Abs)
    {
        return call(*function, Some(n), a, position);
    }
    let bare = Level::of(base) == Level::Atom
        && !matches!(base.kind, NodeKind::Call(function, _) if function != Function::Abs);
    let base = if bare { factor(base, Position::Last) } else { parenthesized(base) };
    format!("<msup>{base}{}</msup>", sum(exponent))
}

/// A function's name upright, its argument in parentheses unless a single name ends the product.
fn call(function: Function, power: Option<&Rational>, argument: &Expression, position: Position) -> String {
    match function {
        Function::Sqrt => return format!("<msqrt>{}</msqrt>", sum(argument)),
        Function::Abs => return format!("<mrow><mo>|</mo>{}<mo>|</mo></mrow>", sum(argument)),
        Function::Exp => return format!("<msup><mi mathvariant=\"normal\">e</mi>{}</msup>", sum(argument)),
        _ => {}
    }
    let name = match function {
        Function::Asin => "arcsin",
        Function::Acos => "arccos",
        Function::Atan => "arctan",
        Function::Sign => "sgn",
        other => other.name(),
    };
    let name = match power {
        None => format!("<mi>{name}</mi>"),
        Some(power) => format!("<msup><mi>{name}</mi>{}</msup>", number(power)),
    };
    let bare = position == Position::Last && matches!(argument.kind, NodeKind::Symbol { .. } | NodeKind::Pi);
    let argument = if bare {
        format!("<mspace width=\"0.17em\"/>{}", factor(argument, position))
    } else {
        parenthesized(argument)
    };
    format!("<mrow>{name}<mo>\u{2061}</mo>{argument}</mrow>")
}

fn number(value: &Rational) -> String {
    let text = number_text(value);
    match text.split_once('/') {
        None => number_mathml(&text),
        Some((top, bottom)) => {
            let (sign, top) = top.strip_prefix('-').map_or(("", top), |top| ("<mo>−</mo>", top));
            format!("<mrow>{sign}<mfrac><mn>{top}</mn><mn>{bottom}</mn></mfrac></mrow>")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// MathML as one reads it aloud: tags that only group left out.
    fn plain(mathml: &str) -> String {
        let mut text = mathml.to_owned();
        for (from, to) in [
            ("<mrow>", ""),
            ("</mrow>", ""),
            ("<mo>\u{2062}</mo>", ""),
            ("<mo>\u{2061}</mo>", ""),
            ("<mspace width=\"0.17em\"/>", " "),
            ("<mspace width=\"0.2em\"/>", " "),
        ] {
            text = text.replace(from, to);
        }
        for tag in ["mi", "mn", "mo"] {
            text = text.replace(&format!("<{tag}>"), "").replace(&format!("</{tag}>"), "");
        }
        text
    }

    #[track_caller]
    fn check(rows: &[(&str, &str)]) {
        for (text, expected) in rows {
            assert_eq!(plain(&Expression::parse(text).unwrap().to_mathml()), *expected, "{text}");
        }
    }

    #[test]
    fn looks_like_a_textbook() {
        check(&[
            ("m*l*theta''*cos(theta)", "ml<mover>θ¨</mover> cos θ"),
            ("(M + m)*x''", "(M+m)<mover>x¨</mover>"),
            ("theta'^2*sin(theta)", "<msup><mover>θ˙</mover>2</msup> sin θ"),
            ("sin(theta)*x", "sin(θ)x"),
            ("sin(x)^2 + cos(2*x)", "<msup>sin2</msup> x+cos(2x)"),
            ("a/(b + c)", "<mfrac>ab+c</mfrac>"),
            ("(a/b)^2", "<msup>(<mfrac>ab</mfrac>)2</msup>"),
            ("-a - b", "−a−b"),
            ("-m*l*s/d", "<mfrac>−mlsd</mfrac>"),
            ("a + (-b)*c", "a+(−b)c"),
            ("a - (b - c)", "a−(b−c)"),
            ("a + -b", "a+(−b)"),
            ("2*3", "2·3"),
            ("2*x", "2x"),
            ("x*2", "x·2"),
            ("mass*g", "mass g"),
            ("I + m*l^2", "I+m<msup>l2</msup>"),
            ("k*sqrt(h)", "k <msqrt>h</msqrt>"),
            ("e^-x", "<msup>e−x</msup>"),
            ("2*pi", "2π"),
            ("1e-9", "<msup>10−9</msup>"),
            ("2.5e-9*x", "2.5·<msup>10−9</msup>x"),
        ]);
    }

    #[test]
    fn every_term_is_a_row_of_its_own() {
        assert_eq!(
            Expression::parse("a - b").unwrap().to_mathml(),
            "<mrow><mrow><mi>a</mi></mrow><mo>−</mo><mrow><mi>b</mi></mrow></mrow>"
        );
    }
}

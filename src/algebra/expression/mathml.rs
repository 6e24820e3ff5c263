use super::super::number_text::number_mathml;
use super::super::{Rational, symbol_mathml};
use super::text::{Level, number_text};
use super::{Expression, Function, NodeKind};
use std::borrow::Cow;
use std::ops::Range;

impl Expression {
    /// As a textbook prints it, in MathML without the `<math>` around it.
    ///
    /// Quotients are fractions, products stand side by side, primes are dots, names of Greek letters are letters.
    /// Each term of a sum is one `<mrow>`.
    pub fn to_mathml(&self) -> String {
        Printer { marked: Vec::new(), wrap: &str::to_owned }.sum(self)
    }

    /// As [`Self::to_mathml`], with the parts at `places` (bytes of the parsed text) put through `wrap`, each once.
    ///
    /// A part is the largest node within a place; several stand side by side where the place is not one node. Where it
    /// is less than a node, the smallest node about it is marked. Places that are no part of the tree change nothing.
    pub fn to_mathml_marked(&self, places: &[Range<usize>], wrap: &dyn Fn(&str) -> String) -> String {
        let mut marked = Vec::new();
        for place in places.iter().filter(|place| !place.is_empty()) {
            parts_within(self, place, &mut marked);
        }
        marked.sort_unstable();
        marked.dedup();
        Printer { marked, wrap }.sum(self)
    }
}

/// Adds the bytes of the nodes that make up `place`; `false` when it lies elsewhere.
fn parts_within(node: &Expression, place: &Range<usize>, found: &mut Vec<(usize, usize)>) -> bool {
    if node.end <= place.start || place.end <= node.start {
        return false;
    }
    if place.start <= node.start && node.end <= place.end {
        found.push((node.start, node.end));
        return true;
    }
    let mut any = false;
    for child in node.children() {
        any |= parts_within(child, place, found);
    }
    if !any && node.start <= place.start && place.end <= node.end {
        found.push((node.start, node.end));
        any = true;
    }
    any
}

/// What is marked, by the bytes of its nodes, and how.
struct Printer<'a> {
    marked: Vec<(usize, usize)>,
    wrap: &'a dyn Fn(&str) -> String,
}

/// A term of a sum.
struct Term<'a> {
    negative: bool,
    node: Cow<'a, Expression>,
    /// The sign that was taken out of it belongs to what is marked.
    marked: bool,
}

impl<'a> Term<'a> {
    fn new(negative: bool, node: &'a Expression) -> Self {
        Self { negative, node: Cow::Borrowed(node), marked: false }
    }
}

impl Printer<'_> {
    fn is_marked(&self, node: &Expression) -> bool {
        self.marked.binary_search(&(node.start, node.end)).is_ok()
    }

    fn marked(&self, node: &Expression, mathml: String) -> String {
        if self.is_marked(node) { (self.wrap)(&mathml) } else { mathml }
    }

    /// A sum as a row of terms; anything else as one term.
    fn sum(&self, node: &Expression) -> String {
        let row = self.row(node);
        // A single term carries its mark itself.
        match node.kind {
            NodeKind::Add(..) | NodeKind::Subtract(..) => self.marked(node, row),
            _ => row,
        }
    }

    fn row(&self, node: &Expression) -> String {
        let mut terms = Vec::new();
        self.collect_terms(node, true, false, &mut terms);
        let mut row = String::from("<mrow>");
        for (i, term) in terms.iter().enumerate() {
            let sign = match (i, term.negative) {
                (0, false) => "",
                (_, false) => "<mo>+</mo>",
                (_, true) => "<mo>−</mo>",
            };
            let inner = match term.node.kind {
                // A sum within the sum, kept together only to be marked.
                NodeKind::Add(..) | NodeKind::Subtract(..) if !term.negative => self.sum(&term.node),
                _ => format!("<mrow>{}</mrow>", self.product(&term.node, Position::Last)),
            };
            if term.marked {
                row.push_str(&(self.wrap)(&format!("<mrow>{sign}{inner}</mrow>")));
            } else {
                row.push_str(sign);
                row.push_str(&inner);
            }
        }
        row.push_str("</mrow>");
        row
    }

    /// The terms of a sum with their signs, left to right. What parentheses hold together on the right of a minus stays one term.
    fn collect_terms<'a>(
        &self,
        node: &'a Expression,
        whole: bool,
        negative: bool,
        terms: &mut Vec<Term<'a>>,
    ) {
        match &node.kind {
            NodeKind::Add(..) | NodeKind::Subtract(..) if !whole && !negative && self.is_marked(node) => {
                terms.push(Term::new(false, node));
            }
            NodeKind::Add(a, b) if !negative => {
                self.collect_terms(a, false, false, terms);
                self.collect_terms(b, false, false, terms);
            }
            NodeKind::Subtract(a, b) if !negative => {
                self.collect_terms(a, false, false, terms);
                self.collect_terms(b, false, true, terms);
            }
            _ if !negative && terms.is_empty() => match without_leading_sign(node) {
                Some(rest) => {
                    let marked = self.is_marked(node);
                    // Its own bytes are spent: the mark stands about the sign as well.
                    let rest = if marked { Expression { start: 0, end: 0, ..rest } } else { rest };
                    terms.push(Term { negative: true, node: Cow::Owned(rest), marked });
                }
                None => terms.push(Term::new(false, node)),
            },
            _ => terms.push(Term::new(negative, node)),
        }
    }

    fn product(&self, node: &Expression, position: Position) -> String {
        match &node.kind {
            NodeKind::Multiply(a, b) => {
                let left = self.product(a, Position::Followed);
                let right = match b.kind {
                    // a·(b·c) was grouped by hand: keep the group visible only where it changes the reading.
                    NodeKind::Multiply(..) => self.product(b, position),
                    _ => self.factor(b, position),
                };
                let whole = format!("{left}{}{right}", between(a, b));
                if self.is_marked(node) { (self.wrap)(&format!("<mrow>{whole}</mrow>")) } else { whole }
            }
            _ => self.factor(node, position),
        }
    }

    fn factor(&self, node: &Expression, position: Position) -> String {
        let mathml = match &node.kind {
            NodeKind::Number(value) => number(value),
            NodeKind::Pi => "<mi>π</mi>".to_owned(),
            NodeKind::Symbol { name, primes } => symbol_mathml(name, *primes),
            NodeKind::Divide(a, b) => format!("<mfrac>{}{}</mfrac>", self.sum(a), self.sum(b)),
            NodeKind::Power(a, b) => self.raised(a, b, position),
            NodeKind::Call(function, a) => self.call(*function, None, a, position),
            NodeKind::Negate(_) | NodeKind::Add(..) | NodeKind::Subtract(..) | NodeKind::Multiply(..) => {
                self.parenthesized(node)
            }
        };
        self.marked(node, mathml)
    }

    /// A group of its own: marked with its parentheses.
    fn parenthesized(&self, node: &Expression) -> String {
        let marked = self.marked.iter().copied().filter(|bytes| *bytes != (node.start, node.end)).collect();
        Printer { marked, wrap: self.wrap }.enclosed(node)
    }

    /// In the parentheses of a function or a power: marked within them.
    fn enclosed(&self, node: &Expression) -> String {
        format!("<mrow><mo>(</mo>{}<mo>)</mo></mrow>", self.sum(node))
    }

    fn raised(&self, base: &Expression, exponent: &Expression, position: Position) -> String {
        if let (NodeKind::Call(function, a), NodeKind::Number(n)) = (&base.kind, &exponent.kind)
            && *n > Rational::ONE
            && n.is_int()
            && !matches!(function, Function::Exp | Function::Sqrt | Function::Abs)
            && !self.is_marked(base)
            && !self.is_marked(exponent)
        {
            return self.call(*function, Some(n), a, position);
        }
        let bare = Level::of(base) == Level::Atom
            && !matches!(base.kind, NodeKind::Call(function, _) if function != Function::Abs);
        let base = if bare { self.factor(base, Position::Last) } else { self.enclosed(base) };
        format!("<msup>{base}{}</msup>", self.sum(exponent))
    }

    /// A function's name upright, its argument in parentheses unless a single name ends the product.
    fn call(
        &self,
        function: Function,
        power: Option<&Rational>,
        argument: &Expression,
        position: Position,
    ) -> String {
        match function {
            Function::Sqrt => return format!("<msqrt>{}</msqrt>", self.sum(argument)),
            Function::Abs => return format!("<mrow><mo>|</mo>{}<mo>|</mo></mrow>", self.sum(argument)),
            Function::Exp => {
                return format!("<msup><mi mathvariant=\"normal\">e</mi>{}</msup>", self.sum(argument));
            }
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
        let bare =
            position == Position::Last && matches!(argument.kind, NodeKind::Symbol { .. } | NodeKind::Pi);
        let argument = if bare {
            format!("<mspace width=\"0.17em\"/>{}", self.factor(argument, position))
        } else {
            self.enclosed(argument)
        };
        format!("<mrow>{name}<mo>\u{2061}</mo>{argument}</mrow>")
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

    /// A formula, the part of it that is marked, and what is read aloud, the mark in square brackets.
    #[track_caller]
    fn check_marked(rows: &[(&str, &str, &str)]) {
        for (text, part, expected) in rows {
            let tree = Expression::parse(text).unwrap();
            let start = text.find(part).unwrap();
            let place = start..start + part.len();
            let marked = tree.to_mathml_marked(&[place.clone(), place], &|inner| format!("[{inner}]"));
            assert_eq!(plain(&marked), *expected, "{part} of {text}");
            let unmarked = marked.replace(['[', ']'], "");
            assert_eq!(plain(&unmarked), plain(&tree.to_mathml()), "{part} of {text}: nothing else changes");
        }
    }

    #[test]
    fn a_part_is_marked_where_it_stands() {
        check_marked(&[
            ("a + m*g*l*sin(x) - b", "m*g*l*sin(x)", "a+[mgl sin x]−b"),
            ("a + b*x' - c", "a + b*x'", "[a+b<mover>x˙</mover>]−c"),
            ("a + b*x' - c", "- c", "a+b<mover>x˙</mover>−[c]"),
            ("a - b", "a - b", "[a−b]"),
            ("(I + m*l^2)*x", "m*l^2", "(I+[m<msup>l2</msup>])x"),
            ("(I + m*l^2)*x", "(I + m*l^2)", "[(I+m<msup>l2</msup>)]x"),
            ("(I + m*l^2)*x", "I + m*l^2", "([I]+[m<msup>l2</msup>])x"),
            ("m*l^2", "l", "m<msup>[l]2</msup>"),
            ("m*l^2", "l^2", "m[<msup>l2</msup>]"),
            ("m*l^2", "2", "m<msup>l[2]</msup>"),
            ("m*g*l", "g*l", "m[g][l]"),
            ("-a + b", "-a", "[−a]+b"),
            ("-a*b", "-a*b", "[−ab]"),
            ("-a*b", "a", "−[a]b"),
            ("a*(-b)", "(-b)", "a[(−b)]"),
            ("a - (b - c)", "(b - c)", "a−[(b−c)]"),
            ("a + (b + c)", "(b + c)", "a+[b+c]"),
            ("cos(x)*y", "x", "cos([x])y"),
            ("cos(x + y)", "y", "cos(x+[y])"),
            ("(a/b)^2", "a/b", "<msup>(<mfrac>[a][b]</mfrac>)2</msup>"),
            ("sqrt(h)/2", "h", "<mfrac><msqrt>[h]</msqrt>2</mfrac>"),
        ]);
    }

    /// cos² x has no place of its own for cos x.
    #[test]
    fn a_marked_base_leaves_its_power() {
        let tree = Expression::parse("cos(x)^2").unwrap();
        let marked = |place| plain(&tree.to_mathml_marked(&[place], &|inner| format!("[{inner}]")));
        assert_eq!(marked(0..6), "<msup>([cos x])2</msup>");
        assert_eq!(marked(0..8), "[<msup>cos2</msup> x]");
    }

    #[test]
    fn a_place_outside_changes_nothing() {
        let tree = Expression::parse("a + b").unwrap();
        for place in [0..0, 5..9, 90..99, usize::MAX - 1..usize::MAX] {
            assert_eq!(tree.to_mathml_marked(&[place], &|_| String::new()), tree.to_mathml());
        }
    }

    #[test]
    fn every_term_is_a_row_of_its_own() {
        assert_eq!(
            Expression::parse("a - b").unwrap().to_mathml(),
            "<mrow><mrow><mi>a</mi></mrow><mo>−</mo><mrow><mi>b</mi></mrow></mrow>"
        );
    }
}

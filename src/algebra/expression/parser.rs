use super::super::clip::clip;
use super::lexer::{Token, TokenKind, tokens};
use super::{Expression, ExpressionError, Function, NodeKind};

impl Expression {
    /// Reads a formula with every operator written: `m*l*theta''*cos(theta)`.
    ///
    /// `^` (or `**`) binds tightest and to the right, then the sign, then `*` and `/`, then `+` and `-`:
    /// `-x^2` is −(x²), `2^3^2` is 512, `-2^-2` is −1/4. All brackets mean the same.
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        Parser::new(text, false)?.formula()
    }

    /// Reads a formula as students type it: `0.06s/((s + 1)(s² + 2s + 5))`.
    ///
    /// Side by side means multiplied, except after `/` without parentheses, where it is refused as ambiguous.
    pub fn parse_typed(text: &str) -> Result<Self, ExpressionError> {
        Parser::new(text, true)?.formula()
    }

    /// Reads `left = right`.
    pub fn parse_equation(text: &str) -> Result<(Self, Self), ExpressionError> {
        let mut parser = Parser::new(text, false)?;
        let left = parser.expression(0)?;
        match parser.next() {
            Some(token) if token.kind == TokenKind::Equals => {}
            Some(token) => return Err(parser.stray(&token)),
            None => {
                return Err(parser
                    .error_at_end("there is no `=` in this equation")
                    .helped("write `left = right`"));
            }
        }
        let right = parser.expression(0)?;
        match parser.next() {
            None => Ok((left.node, right.node)),
            Some(token) => Err(parser.stray(&token)),
        }
    }
}

/// Brackets, signs and powers inside one another, at most.
const MOST_NESTED: usize = 100;
/// The height of the tree, at most; a sum of n terms is n high.
const MOST_HIGH: usize = 200;

const SUM: u8 = 10;
const PRODUCT: u8 = 20;
const SIGN: u8 = 25;
const POWER: u8 = 30;

struct Parser {
    tokens: Vec<Token>,
    at: usize,
    /// Where the text ends.
    end: usize,
    /// Side by side means multiplied.
    typed: bool,
    nested: usize,
}

/// A node and the height of its tree.
struct Parsed {
    node: Expression,
    height: usize,
}

impl Parser {
    fn new(text: &str, typed: bool) -> Result<Self, ExpressionError> {
        Ok(Self { tokens: tokens(text)?, at: 0, end: text.len(), typed, nested: 0 })
    }

    fn formula(&mut self) -> Result<Expression, ExpressionError> {
        if self.tokens.is_empty() {
            return Err(error(0, self.end, "there is no formula here".to_owned()));
        }
        let parsed = self.expression(0)?;
        match self.next() {
            None => Ok(parsed.node),
            Some(token) => Err(self.stray(&token)),
        }
    }

    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.at)
    }

    fn next(&mut self) -> Option<Token> {
        let token = self.tokens.get(self.at).cloned();
        self.at += 1;
        token
    }

    /// Pratt's loop: operators that bind tighter than `least` are taken.
    fn expression(&mut self, least: u8) -> Result<Parsed, ExpressionError> {
        self.nested += 1;
        if self.nested > MOST_NESTED {
            let (start, end) = self.peek().map_or((self.end, self.end), |t| (t.start, t.end));
            return Err(error(
                start,
                end,
                format!("this formula is nested deeper than {MOST_NESTED} levels"),
            ));
        }
        let mut left = self.operand()?;
        let mut after_division = false;
        while let Some(token) = self.peek().cloned() {
            let (binds, right_side): (u8, u8) = match token.kind {
                TokenKind::Plus | TokenKind::Minus => (SUM, SUM),
                TokenKind::Times | TokenKind::Over => (PRODUCT, PRODUCT),
                TokenKind::Power => (POWER, POWER - 1),
                TokenKind::Superscript(_) | TokenKind::Degrees => (POWER + 1, POWER + 1),
                TokenKind::Equals | TokenKind::Close => break,
                _ => (PRODUCT, PRODUCT),
            };
            if binds <= least {
                break;
            }
            match token.kind {
                TokenKind::Superscript(value) => {
                    self.at += 1;
                    let exponent = leaf(NodeKind::Number(value), token.start, token.end);
                    left = self.join(NodeKind::Power, left, exponent)?;
                    continue;
                }
                TokenKind::Degrees => {
                    self.at += 1;
                    left = self.in_degrees(left, &token)?;
                    continue;
                }
                TokenKind::Plus
                | TokenKind::Minus
                | TokenKind::Times
                | TokenKind::Over
                | TokenKind::Power => self.at += 1,
                _ => self.side_by_side(&left.node, &token, after_division)?,
            }
            let right = self.expression(right_side)?;
            let make = match token.kind {
                TokenKind::Plus => NodeKind::Add,
                TokenKind::Minus => NodeKind::Subtract,
                TokenKind::Over => NodeKind::Divide,
                TokenKind::Power => NodeKind::Power,
                _ => NodeKind::Multiply,
            };
            after_division = token.kind == TokenKind::Over;
            left = self.join(make, left, right)?;
        }
        self.nested -= 1;
        Ok(left)
    }

    /// Whether `left` and the operand beginning with `next` may stand side by side.
    fn side_by_side(
        &self,
        left: &Expression,
        next: &Token,
        after_division: bool,
    ) -> Result<(), ExpressionError> {
        if !self.typed {
            let last = last_name(left);
            if let NodeKind::Symbol { name, primes: 0 } = &last.kind
                && next.kind == TokenKind::Open
            {
                let unknown =
                    error(last.start, last.end, format!("`{}` is not a function we know", clip(name)));
                let known = Function::ALL.map(Function::name);
                return Err(match crate::names::nearest(name, known) {
                    Some(near) => unknown.helped(format!("did you mean `{near}`?")),
                    None => unknown.helped(format!("write `{}*(` to multiply", clip(name))),
                });
            }
            return Err(error(left.end, next.end, "an operator is missing here".to_owned())
                .helped("write `*` to multiply"));
        }
        if let NodeKind::Number(_) = operand_end(left).kind
            && matches!(next.kind, TokenKind::Number(_))
        {
            return Err(error(left.start, next.end, "two numbers stand side by side".to_owned())
                .helped("write the operator between them"));
        }
        if matches!(next.kind, TokenKind::Number(_)) {
            return Err(error(left.start, next.end, "a number stands right after a factor".to_owned())
                .helped("write `^` before it for a power, `*` for a product"));
        }
        if after_division {
            return Err(error(
                left.start,
                next.end,
                "a division followed by a product can be read in two ways".to_owned(),
            )
            .helped("put parentheses around the denominator, or write `*` after it"));
        }
        Ok(())
    }

    fn operand(&mut self) -> Result<Parsed, ExpressionError> {
        let Some(token) = self.next() else {
            let after = match self.tokens.last() {
                Some(last) => format!("the formula breaks off after {}", describe(&last.kind)),
                None => "there is no formula here".to_owned(),
            };
            return Err(self.error_at_end(&after));
        };
        let (start, end) = (token.start, token.end);
        match token.kind {
            TokenKind::Number(value) => Ok(leaf(NodeKind::Number(value), start, end)),
            TokenKind::Pi => Ok(leaf(NodeKind::Pi, start, end)),
            TokenKind::Symbol { name, primes } => Ok(leaf(NodeKind::Symbol { name, primes }, start, end)),
            TokenKind::Open => self.group(start),
            TokenKind::Minus => {
                let inner = self.expression(SIGN)?;
                let end = inner.node.end;
                self.wrap(NodeKind::Negate(Box::new(inner.node)), start, end, inner.height)
            }
            TokenKind::Plus => self.expression(SIGN),
            TokenKind::Root => self.root(start, end),
            TokenKind::Function(function) => self.call(function, start, end),
            TokenKind::Fraction => {
                let top = self.braces(end)?;
                let bottom = self.braces(top.node.end)?;
                let (height, end) = (top.height.max(bottom.height), bottom.node.end);
                let kind = NodeKind::Divide(Box::new(top.node), Box::new(bottom.node));
                self.wrap(kind, start, end, height)
            }
            other => {
                let before = self.at.checked_sub(2).and_then(|i| self.tokens.get(i));
                let message = match before {
                    Some(before) => format!(
                        "a number, a name or `(` is missing between {} and {}",
                        describe(&before.kind),
                        describe(&other)
                    ),
                    None => format!("a formula cannot begin with {}", describe(&other)),
                };
                Err(error(start, end, message))
            }
        }
    }

    /// `√` from `start` to `end`, and what it is the root of.
    fn root(&mut self, start: usize, end: usize) -> Result<Parsed, ExpressionError> {
        let Some(inner) = self.bare_argument() else {
            let message = "what `√` is the root of is not clear".to_owned();
            return Err(error(start, end, message).helped("write `sqrt(…)`"));
        };
        let inner = inner?;
        let end = inner.node.end;
        self.wrap(NodeKind::Call(Function::Sqrt, Box::new(inner.node)), start, end, inner.height)
    }

    /// A function whose name is at `start..end`, and its argument.
    fn call(&mut self, function: Function, start: usize, end: usize) -> Result<Parsed, ExpressionError> {
        let is_open = matches!(self.peek(), Some(Token { kind: TokenKind::Open, .. }));
        let bare = if self.typed && !is_open { self.bare_argument() } else { None };
        let inner = match bare {
            Some(inner) => inner?,
            None => self.bracketed(function, start, end)?,
        };
        let end = inner.node.end;
        self.wrap(NodeKind::Call(function, Box::new(inner.node)), start, end, inner.height)
    }

    fn bracketed(&mut self, function: Function, start: usize, end: usize) -> Result<Parsed, ExpressionError> {
        let name = function.name();
        match self.next() {
            Some(open) if open.kind == TokenKind::Open => self.group(open.start),
            Some(other) if matches!(other.kind, TokenKind::Power | TokenKind::Superscript(_)) => {
                Err(error(start, other.end, format!("`{name}` has a power before its argument"))
                    .helped(format!("write `{name}(x)^2`")))
            }
            _ => Err(error(start, end, format!("`{name}` has no argument in parentheses"))
                .helped(format!("write `{name}(x)`"))),
        }
    }

    /// What a function or a root stands before without brackets, when nothing that follows can belong to it as well: `cos θ`,
    /// `\cos\frac{π}{6}`, `cos 30°`, `√3/2`, but neither `sin 2x` nor `√2g`.
    fn bare_argument(&mut self) -> Option<Result<Parsed, ExpressionError>> {
        let first = self.peek()?.clone();
        let mut after = self.at + 1;
        match first.kind {
            TokenKind::Open | TokenKind::Fraction => return Some(self.operand()),
            TokenKind::Number(_) | TokenKind::Pi | TokenKind::Symbol { .. } => {}
            _ => return None,
        }
        let degrees = self.tokens.get(after).filter(|token| token.kind == TokenKind::Degrees).cloned();
        after += usize::from(degrees.is_some());
        let is_name = !matches!(first.kind, TokenKind::Number(_));
        let ends = match self.tokens.get(after).map(|token| &token.kind) {
            None => true,
            Some(TokenKind::Plus | TokenKind::Minus | TokenKind::Times | TokenKind::Over) => true,
            Some(TokenKind::Close | TokenKind::Equals) => true,
            // cos θ s
            Some(TokenKind::Symbol { .. }) => self.typed && (is_name || degrees.is_some()),
            Some(_) => false,
        };
        if !ends {
            return None;
        }
        let operand = self.operand();
        let Some(degrees) = degrees else { return Some(operand) };
        self.at += 1;
        Some(operand.and_then(|operand| self.in_degrees(operand, &degrees)))
    }

    fn in_degrees(&self, number: Parsed, sign: &Token) -> Result<Parsed, ExpressionError> {
        let pi = leaf(NodeKind::Pi, sign.start, sign.end);
        let half_turn = leaf(NodeKind::Number(180.into()), sign.start, sign.end);
        let degree = self.join(NodeKind::Divide, pi, half_turn)?;
        self.join(NodeKind::Multiply, number, degree)
    }

    /// The rest of a bracket opened at `start`.
    fn group(&mut self, start: usize) -> Result<Parsed, ExpressionError> {
        let mut inner = self.expression(0)?;
        match self.next() {
            Some(token) if token.kind == TokenKind::Close => {
                inner.node.start = start;
                inner.node.end = token.end;
                Ok(inner)
            }
            // What stands behind an equals sign is another formula.
            Some(token) if token.kind != TokenKind::Equals => Err(self.stray(&token)),
            _ => Err(error(start, start + 1, "this bracket is never closed".to_owned())),
        }
    }

    fn braces(&mut self, after: usize) -> Result<Parsed, ExpressionError> {
        match self.next() {
            Some(token) if token.kind == TokenKind::Open => self.group(token.start),
            _ => Err(error(after, after, "`\\frac` wants two groups in braces".to_owned())
                .helped("write `\\frac{…}{…}` or `(…)/(…)`")),
        }
    }

    fn join(
        &self,
        make: fn(Box<Expression>, Box<Expression>) -> NodeKind,
        left: Parsed,
        right: Parsed,
    ) -> Result<Parsed, ExpressionError> {
        let (start, end) = (left.node.start, right.node.end);
        let height = left.height.max(right.height);
        self.wrap(make(Box::new(left.node), Box::new(right.node)), start, end, height)
    }

    /// A node over operands of `height`.
    fn wrap(
        &self,
        kind: NodeKind,
        start: usize,
        end: usize,
        height: usize,
    ) -> Result<Parsed, ExpressionError> {
        if height >= MOST_HIGH {
            return Err(error(
                start,
                end,
                format!("this formula has more than {MOST_HIGH} operations in a row"),
            ));
        }
        Ok(Parsed { node: Expression::new(kind, start, end), height: height + 1 })
    }

    fn stray(&self, token: &Token) -> ExpressionError {
        let message = match token.kind {
            TokenKind::Close => "this bracket closes nothing".to_owned(),
            TokenKind::Equals => "`=` stands where a formula should go on".to_owned(),
            ref other => format!("an operator is missing before {}", describe(other)),
        };
        error(token.start, token.end, message)
    }

    fn error_at_end(&self, message: &str) -> ExpressionError {
        error(self.end, self.end, message.to_owned())
    }
}

impl ExpressionError {
    fn helped(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

fn error(start: usize, end: usize, message: String) -> ExpressionError {
    ExpressionError { start, end, message, help: None }
}

fn leaf(kind: NodeKind, start: usize, end: usize) -> Parsed {
    Parsed { node: Expression::new(kind, start, end), height: 1 }
}

/// What stands last in a formula, unless it is in brackets: `cso` of `m*cso`.
fn last_name(node: &Expression) -> &Expression {
    let mut last = node;
    while let Some(child) = last.children().last().filter(|child| child.end == last.end) {
        last = child;
    }
    last
}

/// The last factor of a product.
fn operand_end(node: &Expression) -> &Expression {
    match &node.kind {
        NodeKind::Multiply(_, right) => right,
        _ => node,
    }
}

fn describe(kind: &TokenKind) -> String {
    match kind {
        TokenKind::Number(_) | TokenKind::Superscript(_) => "a number".to_owned(),
        TokenKind::Pi => "`pi`".to_owned(),
        TokenKind::Symbol { name, .. } => format!("`{}`", clip(name)),
        TokenKind::Function(f) => format!("`{}`", f.name()),
        TokenKind::Plus => "`+`".to_owned(),
        TokenKind::Minus => "`-`".to_owned(),
        TokenKind::Times => "`*`".to_owned(),
        TokenKind::Over => "`/`".to_owned(),
        TokenKind::Power => "`^`".to_owned(),
        TokenKind::Equals => "`=`".to_owned(),
        TokenKind::Open => "`(`".to_owned(),
        TokenKind::Close => "`)`".to_owned(),
        TokenKind::Fraction => "`\\frac`".to_owned(),
        TokenKind::Root => "`√`".to_owned(),
        TokenKind::Degrees => "`°`".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check_values(rows: &[(&str, f64)]) {
        for (text, expected) in rows {
            let value = Expression::parse(text).unwrap().eval_f64(&|_: &str, _| Some(3.0));
            assert_eq!(value, Ok(*expected), "{text}");
        }
    }

    #[test]
    fn precedence() {
        check_values(&[
            ("-x^2", -9.0),
            ("(-x)^2", 9.0),
            ("2^3^2", 512.0),
            ("2**3", 8.0),
            ("12/2/3", 2.0),
            ("12/2*3", 18.0),
            ("10-2-3", 5.0),
            ("-2^-2", -0.25),
            ("2*-x", -6.0),
            ("-x*2", -6.0),
            ("+x", 3.0),
            ("2^-x", 0.125),
            ("x²", 9.0),
            ("-x²", -9.0),
            ("2x".replace('x', "*x").as_str(), 6.0),
            ("sqrt(x*3)^2", 9.0),
            ("[2+{3}]*(1)", 5.0),
        ]);
    }

    #[test]
    fn typography_is_read() {
        for (pasted, plain) in [
            ("ẍ + θ̈ − ẋ", "x'' + theta'' - x'"),
            ("x″ + x′ + x’", "x'' + x' + x'"),
            ("ω·θ", "omega*theta"),
            ("𝑚×𝑙", "m*l"),
            ("ω₀*x₁", "omega0*x1"),
            ("\\theta + \\sin\\left(x\\right)", "theta + sin(x)"),
            ("(M + m)\u{a0}*\u{200b}x", "(M + m)*x"),
        ] {
            assert_eq!(Expression::parse(pasted).unwrap().to_string(), plain, "{pasted}");
        }
    }

    #[test]
    fn roots_degrees_and_small_digits_are_read() {
        for (typed, plain) in [
            ("√3/2", "sqrt(3)/2"),
            ("√(3)/2", "sqrt(3)/2"),
            ("2√h_0", "2*sqrt(h_0)"),
            ("cos(30°)", "cos(30*(pi/180))"),
            ("cos 30°", "cos(30*(pi/180))"),
            ("cos(30^\\circ)", "cos(30*(pi/180))"),
            ("\\cos{30^{\\circ}}", "cos(30*(pi/180))"),
            ("m cos 30° s", "m*cos(30*(pi/180))*s"),
            ("\\cos\\frac{\\pi}{6}", "cos(pi/6)"),
            ("g\\cos\\theta_0 s", "g*cos(theta_0)*s"),
            ("\\sqrt{3} s", "sqrt(3)*s"),
            ("cos θ₀", "cos(theta0)"),
            ("J₁J₂s³", "J1*J2*s^3"),
            ("k₁₂x", "k12*x"),
            ("Jₘs", "Jm*s"),
            ("J_1J_2", "J_1J_2"),
        ] {
            assert_eq!(
                Expression::parse_typed(typed).map(|e| e.to_string()),
                Ok(plain.to_owned()),
                "{typed}"
            );
        }
        for typed in ["√2g", "√", "sin 2x", "sin x^2", "°", "cos", "√-1", "sin²x"] {
            assert!(Expression::parse_typed(typed).is_err(), "{typed}");
        }
    }

    #[test]
    fn strict_formulas_want_every_operator() {
        for (text, help) in [
            ("2x", Some("write `*` to multiply")),
            ("sine(x)", Some("did you mean `sin`?")),
            ("m(x)", Some("write `m*(` to multiply")),
        ] {
            assert_eq!(Expression::parse(text).unwrap_err().help.as_deref(), help, "{text}");
        }
    }

    #[test]
    fn places_point_into_the_text() {
        let text = "a*(b + c) - sin(d)";
        let tree = Expression::parse(text).unwrap();
        let NodeKind::Subtract(product, sine) = &tree.kind else { panic!("{tree:?}") };
        assert_eq!(&text[tree.start..tree.end], text);
        assert_eq!(&text[product.start..product.end], "a*(b + c)");
        assert_eq!(&text[sine.start..sine.end], "sin(d)");
    }

    #[test]
    fn an_unknown_function_is_told_wherever_it_stands() {
        for (text, start, end, help) in [
            ("cso(x)", 0, 3, "did you mean `cos`?"),
            ("m*cso(x)", 2, 5, "did you mean `cos`?"),
            ("1 + m*l/snh(x)", 8, 11, "did you mean `sinh`?"),
            ("-2*sqr(x)^2", 3, 6, "did you mean `sqrt`?"),
            ("m*l^foo(x)", 4, 7, "write `foo*(` to multiply"),
        ] {
            let error = Expression::parse(text).unwrap_err();
            assert_eq!((error.start, error.end), (start, end), "{text}: {error}");
            assert!(error.message.ends_with("is not a function we know"), "{text}: {error}");
            assert_eq!(error.help.as_deref(), Some(help), "{text}");
        }
        // Behind a bracket no name can be a function.
        assert_eq!(Expression::parse("(m + x)(l)").unwrap_err().message, "an operator is missing here");
    }

    #[test]
    fn equations_have_two_sides() {
        let (left, right) = Expression::parse_equation("A*h' = q - k*sqrt(h)").unwrap();
        assert_eq!((left.to_string(), right.to_string()), ("A*h'".into(), "q - k*sqrt(h)".into()));
        for (text, message) in [
            ("A*h'", "there is no `=` in this equation"),
            ("a = b = c", "`=` stands where a formula should go on"),
            ("a =", "the formula breaks off after `=`"),
            ("= a", "a formula cannot begin with `=`"),
            ("", "there is no formula here"),
        ] {
            assert_eq!(Expression::parse_equation(text).unwrap_err().message, message, "{text}");
        }
    }
}

use crate::algebra::{Rational, parse_decimal};
use std::sync::LazyLock;

/// A unit of measurement as typed: its symbol, what it measures, and how much of the SI unit it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unit {
    symbol: String,
    /// `None` for a lab's own unit (`counts`), of which only the name is known.
    scale: Option<Box<Scale>>,
}

/// How much one unit is of another: `factor` · π^`pi`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitRatio {
    pub factor: Rational,
    pub pi: i32,
}

/// Exponents of m, kg, s, A, K.
type Dimension = [i32; 5];

#[derive(Clone, Debug, PartialEq, Eq)]
struct Scale {
    dimension: Dimension,
    /// Exponent of the angle, and its size: `turn` · π^`pi` radians.
    angle: i32,
    turn: Rational,
    pi: i32,
    /// In SI units, the angle left out.
    factor: Rational,
}

/// Longer texts are no units.
const LONGEST: usize = 60;
/// Units multiplied in one, and the largest exponent.
const MOST_PARTS: usize = 12;
const LARGEST_EXPONENT: i32 = 9;
/// Parentheses in parentheses.
const DEEPEST: usize = 3;

impl Unit {
    /// A unit in its usual spellings: `rad/s`, `rad s⁻¹`, `deg per second`, `°`, `rpm`, `mV`, `N·m`, `kg m^2 / s^2`, `%`.
    ///
    /// Capitals count where they tell units apart (`mHz`, `MHz`) and are else overlooked. `None` for anything else.
    pub fn parse(text: &str) -> Option<Self> {
        let text = bare(text);
        if text.is_empty() || text.len() > LONGEST {
            return None;
        }
        let mut reader = Reader { rest: text, parts: Vec::new() };
        reader.product(1, 0)?;
        (reader.rest.is_empty() && !reader.parts.is_empty()).then_some(())?;
        let mut scale = Scale::default();
        for (known, prefix, exponent) in &reader.parts {
            scale = scale.times(&known.scale(prefix), *exponent)?;
        }
        Some(Self { symbol: symbol(&reader.parts), scale: Some(Box::new(scale)) })
    }

    /// The first word of a unit that is not known here: `kgg` of `kgg m/s`.
    pub fn unknown_word(text: &str) -> Option<&str> {
        let letters = |c: char| c.is_alphabetic() || matches!(c, '%' | '°' | 'º');
        let mut words = text.split(|c| !letters(c)).filter(|word| !word.is_empty() && *word != "per");
        words.find(|word| look_up(word).is_none())
    }

    /// The unit that was likely meant by a word which is none.
    pub fn nearest(word: &str) -> Option<&'static str> {
        let single = IN_USE.iter().filter(|unit| unit.chars().all(|c| c.is_alphabetic()));
        crate::names::nearest(word, KNOWN.iter().flat_map(|known| known.names).chain(single).copied())
    }

    /// The unit of a pure number.
    pub fn one() -> Self {
        Self { symbol: String::new(), scale: Some(Box::default()) }
    }

    /// A unit of which only the name is known, such as `counts`.
    pub fn named(name: &str) -> Self {
        Self { symbol: bare(name).split_whitespace().collect::<Vec<_>>().join(" "), scale: None }
    }

    /// In its usual spelling: `rad/s`, `deg`, `N·m`; empty for a pure number.
    pub fn symbol(&self) -> &str {
        &self.symbol
    }

    /// Whether it is a unit known here, and not only a name.
    pub fn is_known(&self) -> bool {
        self.scale.is_some()
    }

    /// How much of SI it is, where it is known.
    pub fn in_si(&self) -> Option<UnitRatio> {
        let scale = self.scale.as_ref()?;
        Some(UnitRatio { factor: &scale.factor * &scale.turn, pi: scale.pi })
    }

    /// How much one of it is of `other`; `None` when they do not measure the same, or it is not known.
    ///
    /// Angles in a compound unit may be left unsaid: `1/s` is taken for `rad/s` beside `rad/s`, and for `Hz` beside `Hz`.
    pub fn in_unit(&self, other: &Self) -> Option<UnitRatio> {
        let (Some(own), Some(their)) = (&self.scale, &other.scale) else {
            let same = self.symbol.to_lowercase() == other.symbol.to_lowercase();
            return same.then(|| UnitRatio { factor: Rational::ONE, pi: 0 });
        };
        if own.dimension != their.dimension {
            return None;
        }
        let factor = &own.factor / &their.factor;
        if own.angle == their.angle {
            return Some(UnitRatio { factor: factor * &own.turn / &their.turn, pi: own.pi - their.pi });
        }
        let unsaid = (own.angle == 0 || their.angle == 0) && own.dimension != Dimension::default();
        unsaid.then_some(UnitRatio { factor, pi: 0 })
    }

    /// `self` divided by `other`, where both are known.
    pub fn over(&self, other: &Self) -> Option<Self> {
        let scale = self.scale.as_ref()?.times(other.scale.as_ref()?, -1)?;
        let symbol = match (self.symbol.as_str(), other.symbol.as_str()) {
            (own, "") => own.to_owned(),
            ("", their) => format!("1/{}", in_parentheses(their)),
            (own, their) => format!("{own}/{}", in_parentheses(their)),
        };
        Some(Self { symbol, scale: Some(Box::new(scale)) })
    }

    /// The same with the angle of `native`, when it leaves its own unsaid: `1/s` for `rad/s`.
    pub fn understood_as(self, native: &Self) -> Self {
        match (&self.scale, &native.scale) {
            (Some(own), Some(their))
                if own.angle == 0 && their.angle != 0 && own.dimension == their.dimension =>
            {
                let angle = Scale { factor: own.factor.clone(), ..(**their).clone() };
                Self { scale: Some(Box::new(angle)), ..self }
            }
            _ => self,
        }
    }

    /// What it measures, to stand in a sentence: `a time`, `an angle`.
    pub fn quantity(&self) -> &'static str {
        let Some(scale) = &self.scale else { return "another quantity" };
        let known = QUANTITIES.iter().find(|(dimension, angle, _)| {
            *dimension == scale.dimension && angle.is_none_or(|angle| angle == scale.angle)
        });
        known.map_or("another quantity", |(_, _, name)| name)
    }

    /// Units in use that measure the same in another size: of `rad/s` deg/s, Hz and rpm.
    pub fn others(&self) -> Vec<Self> {
        let differs = |other: &Self| {
            let ratio = self.in_unit(other);
            self.is_known() && ratio.is_some_and(|ratio| ratio.factor != Rational::ONE || ratio.pi != 0)
        };
        static UNITS: LazyLock<Vec<Unit>> = LazyLock::new(|| {
            IN_USE.iter().filter_map(|text| Unit::parse(text)).chain([Unit::one()]).collect()
        });
        UNITS.iter().filter(|unit| differs(unit)).cloned().collect()
    }
}

impl UnitRatio {
    pub fn one() -> Self {
        Self { factor: Rational::ONE, pi: 0 }
    }

    /// The other way round: 1/2 where this is 2.
    pub fn inverse(&self) -> Self {
        Self { factor: self.factor.clone().pow(-1), pi: -self.pi }
    }

    /// The value, and what it may be off by: 0 without π.
    pub fn value(&self) -> (Rational, Rational) {
        if self.pi == 0 {
            return (self.factor.clone(), Rational::ZERO);
        }
        // Rounded in the 38th digit, which leaves π^9 right to a part of 1e-36.
        let pi = parse_decimal("3.1415926535897932384626433832795028842").unwrap_or(Rational::from(3));
        let value = &self.factor * pi.pow(self.pi as isize);
        let bound = if value < Rational::ZERO { -value.clone() } else { value.clone() };
        (value, bound * Rational::from(10).pow(-36))
    }
}

impl Default for Scale {
    /// Of a pure number.
    fn default() -> Self {
        Self { dimension: Dimension::default(), angle: 0, turn: Rational::ONE, pi: 0, factor: Rational::ONE }
    }
}

impl Scale {
    fn times(&self, other: &Self, exponent: i32) -> Option<Self> {
        let mut dimension = self.dimension;
        for (own, their) in dimension.iter_mut().zip(other.dimension) {
            *own += their * exponent;
        }
        let most = 4 * LARGEST_EXPONENT;
        let product = Self {
            dimension,
            angle: self.angle + other.angle * exponent,
            turn: &self.turn * other.turn.clone().pow(exponent as isize),
            pi: self.pi + other.pi * exponent,
            factor: &self.factor * other.factor.clone().pow(exponent as isize),
        };
        (dimension.iter().all(|e| e.abs() <= most) && product.pi.abs() <= LARGEST_EXPONENT).then_some(product)
    }
}

/// A unit of the table.
struct Known {
    /// The symbol first; words that are read for it after it.
    names: &'static [&'static str],
    dimension: Dimension,
    angle: i32,
    /// Numerator and denominator of the size in SI, π left out, and the power of π.
    size: (i64, i64, i32),
    /// Letters that may stand before the symbol.
    prefixes: &'static str,
}

impl Known {
    fn scale(&self, prefix: &Option<char>) -> Scale {
        let size = Rational::from(self.size.0) / Rational::from(self.size.1);
        let power = prefix.and_then(|letter| PREFIXES.iter().find(|(known, _, _)| *known == letter));
        let prefix = Rational::from(10).pow(power.map_or(0, |(_, _, power)| *power));
        // The angle's size is kept apart: of `rpm` 2π, and 1/60 beside it.
        let (turn, factor) = if self.angle != 0 && self.size.2 != 0 && self.dimension != Dimension::default()
        {
            (Rational::from(2), size / Rational::from(2) * prefix)
        } else if self.angle != 0 {
            (size * prefix, Rational::ONE)
        } else {
            (Rational::ONE, size * prefix)
        };
        Scale { dimension: self.dimension, angle: self.angle, turn, pi: self.size.2, factor }
    }
}

const PREFIXES: &[(char, &str, isize)] = &[
    ('M', "mega", 6),
    ('k', "kilo", 3),
    ('d', "deci", -1),
    ('c', "centi", -2),
    ('m', "milli", -3),
    ('µ', "micro", -6),
    ('n', "nano", -9),
    ('p', "pico", -12),
];

const fn known(
    names: &'static [&'static str],
    dimension: Dimension,
    size: (i64, i64, i32),
    prefixes: &'static str,
) -> Known {
    Known { names, dimension, angle: 0, size, prefixes }
}

const fn angular(
    names: &'static [&'static str],
    dimension: Dimension,
    size: (i64, i64, i32),
    prefixes: &'static str,
) -> Known {
    Known { names, dimension, angle: 1, size, prefixes }
}

const NONE: Dimension = [0; 5];
const PER_SECOND: Dimension = [0, 0, -1, 0, 0];

const KNOWN: &[Known] = &[
    known(&["%", "percent", "pct"], NONE, (1, 100, 0), ""),
    angular(&["rad", "rads", "radian", "radians"], NONE, (1, 1, 0), "mµ"),
    angular(&["deg", "degs", "degree", "degrees", "°", "º"], NONE, (1, 180, 1), ""),
    angular(
        &["rev", "revs", "revolution", "revolutions", "turn", "turns", "cycle", "cycles"],
        NONE,
        (2, 1, 1),
        "",
    ),
    angular(&["Hz", "hertz", "cps"], PER_SECOND, (2, 1, 1), "kMm"),
    angular(&["rpm"], PER_SECOND, (1, 30, 1), ""),
    known(&["s", "sec", "secs", "second", "seconds"], [0, 0, 1, 0, 0], (1, 1, 0), "mµn"),
    known(&["min", "mins", "minute", "minutes"], [0, 0, 1, 0, 0], (60, 1, 0), ""),
    known(&["h", "hr", "hrs", "hour", "hours"], [0, 0, 1, 0, 0], (3600, 1, 0), ""),
    known(&["m", "metre", "metres", "meter", "meters"], [1, 0, 0, 0, 0], (1, 1, 0), "kdcmµn"),
    known(&["L", "litre", "litres", "liter", "liters"], [3, 0, 0, 0, 0], (1, 1000, 0), "cm"),
    known(&["g", "gram", "grams"], [0, 1, 0, 0, 0], (1, 1000, 0), "km"),
    known(&["A", "amp", "amps", "ampere", "amperes"], [0, 0, 0, 1, 0], (1, 1, 0), "kmµ"),
    known(&["V", "volt", "volts"], [2, 1, -3, -1, 0], (1, 1, 0), "mkµM"),
    known(&["N", "newton", "newtons"], [1, 1, -2, 0, 0], (1, 1, 0), "km"),
    known(&["Nm"], [2, 1, -2, 0, 0], (1, 1, 0), "m"),
    known(&["J", "joule", "joules"], [2, 1, -2, 0, 0], (1, 1, 0), "kmM"),
    known(&["W", "watt", "watts"], [2, 1, -3, 0, 0], (1, 1, 0), "kmM"),
    known(&["Pa", "pascal", "pascals"], [-1, 1, -2, 0, 0], (1, 1, 0), "kM"),
    known(&["bar", "bars"], [-1, 1, -2, 0, 0], (100_000, 1, 0), "m"),
    known(&["Ω", "Ω", "ohm", "ohms"], [2, 1, -3, -2, 0], (1, 1, 0), "kmM"),
    known(&["F", "farad", "farads"], [-2, -1, 4, 2, 0], (1, 1, 0), "mµnp"),
    known(&["H", "henry", "henries"], [2, 1, -2, -2, 0], (1, 1, 0), "mµ"),
    known(&["C", "coulomb", "coulombs"], [0, 0, 1, 1, 0], (1, 1, 0), "mµ"),
    known(&["K", "kelvin", "kelvins"], [0, 0, 0, 0, 1], (1, 1, 0), "m"),
    // Of a difference of temperatures.
    known(&["°C", "ºC", "degC"], [0, 0, 0, 0, 1], (1, 1, 0), ""),
];

/// What dimensions measure; the angle says nothing where it is `None`.
const QUANTITIES: &[(Dimension, Option<i32>, &str)] = &[
    (NONE, Some(0), "a ratio"),
    (NONE, Some(1), "an angle"),
    (PER_SECOND, None, "a frequency"),
    ([0, 0, -2, 0, 0], Some(1), "an angular acceleration"),
    ([0, 0, 1, 0, 0], Some(0), "a time"),
    ([1, 0, 0, 0, 0], Some(0), "a length"),
    ([2, 0, 0, 0, 0], Some(0), "an area"),
    ([3, 0, 0, 0, 0], Some(0), "a volume"),
    ([1, 0, -1, 0, 0], Some(0), "a velocity"),
    ([1, 0, -2, 0, 0], Some(0), "an acceleration"),
    ([3, 0, -1, 0, 0], Some(0), "a flow"),
    ([0, 1, 0, 0, 0], Some(0), "a mass"),
    ([0, 0, 0, 1, 0], Some(0), "a current"),
    ([2, 1, -3, -1, 0], Some(0), "a voltage"),
    ([1, 1, -2, 0, 0], Some(0), "a force"),
    ([2, 1, -2, 0, 0], None, "a torque or an energy"),
    ([2, 1, -3, 0, 0], None, "a power"),
    ([-1, 1, -2, 0, 0], Some(0), "a pressure"),
    ([2, 1, -3, -2, 0], Some(0), "a resistance"),
    ([0, 0, 0, 0, 1], Some(0), "a temperature"),
];

/// Units one may have meant where a number fits none asked for. The likelier first.
const IN_USE: &[&str] = &[
    "rad", "deg", "rad/s", "Hz", "rpm", "deg/s", "s", "ms", "min", "m", "cm", "mm", "m/s", "cm/s", "mm/s",
    "km/h", "V", "mV", "A", "mA", "N", "kN", "kg", "g", "m^3", "L", "Pa", "kPa", "bar", "%",
];

/// Without white space, a full stop behind it, brackets around it and `in` before it.
fn bare(text: &str) -> &str {
    let mut text = text.trim();
    if text.ends_with('.') {
        text = text[..text.len() - 1].trim_end();
    }
    for (open, close) in [('[', ']'), ('(', ')')] {
        let inner = text.strip_prefix(open).and_then(|rest| rest.strip_suffix(close));
        if let Some(inner) = inner.filter(|inner| !inner.contains([open, close])) {
            text = inner.trim();
        }
    }
    text.strip_prefix("in ").map_or(text, str::trim_start)
}

/// Reads `product := factor ((· | / | per) factor)*`, `factor := 1 | name exponent | (product)`.
struct Reader<'a> {
    rest: &'a str,
    parts: Vec<(&'static Known, Option<char>, i32)>,
}

impl Reader<'_> {
    fn product(&mut self, sign: i32, depth: usize) -> Option<()> {
        self.factor(sign, depth)?;
        loop {
            let before = self.rest;
            let spaced = self.rest.trim_start();
            self.rest = spaced;
            if spaced.is_empty() || spaced.starts_with(')') {
                return Some(());
            }
            let per = spaced.strip_prefix('/').or_else(|| {
                let word = spaced.get(..3).is_some_and(|word| word.eq_ignore_ascii_case("per"));
                spaced[word.then_some(3)?..].strip_prefix(' ')
            });
            if let Some(after) = per {
                self.rest = after;
                self.factor(-sign, depth)?;
                continue;
            }
            let times = spaced.strip_prefix(['·', '⋅', '*', '×', '.']);
            match times {
                Some(after) => self.rest = after,
                // A name may follow white space, or a parenthesis.
                None if before.len() > spaced.len() || spaced.starts_with('(') => {}
                None => return None,
            }
            self.factor(sign, depth)?;
        }
    }

    fn factor(&mut self, sign: i32, depth: usize) -> Option<()> {
        self.rest = self.rest.trim_start();
        if let Some(inner) = self.rest.strip_prefix('(') {
            (depth < DEEPEST).then_some(())?;
            self.rest = inner;
            self.product(sign, depth + 1)?;
            self.rest = self.rest.trim_start().strip_prefix(')')?;
            return Some(());
        }
        if let Some(after) = self.rest.strip_prefix('1') {
            self.rest = after;
            return after.trim_start().starts_with(['/', '·']).then_some(());
        }
        let letters = |c: char| c.is_alphabetic() || matches!(c, '%' | '°' | 'º');
        let end = self.rest.find(|c| !letters(c)).unwrap_or(self.rest.len());
        let (name, after) = self.rest.split_at(end);
        let (known, prefix) = look_up(name)?;
        self.rest = after;
        let exponent = self.exponent()?;
        (self.parts.len() < MOST_PARTS).then(|| self.parts.push((known, prefix, sign * exponent)))
    }

    /// `^2`, `^-1`, `^{-1}`, `**2`, `⁻¹`, `2` behind a name; 1 when there is none.
    fn exponent(&mut self) -> Option<i32> {
        const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
        let raised = self.rest.starts_with('⁻') || self.rest.starts_with(RAISED);
        let marked = self.rest.strip_prefix("**").or_else(|| self.rest.strip_prefix('^'));
        if marked.is_none() && !raised && !self.rest.starts_with(|c: char| c.is_ascii_digit()) {
            return Some(1);
        }
        let mut rest = marked.unwrap_or(self.rest);
        let close = ['{', '('].iter().zip(['}', ')']).find_map(|(open, close)| {
            rest = marked.and(rest.strip_prefix(*open))?;
            Some(close)
        });
        let mut digits = String::new();
        for c in rest.chars() {
            match RAISED.iter().position(|digit| *digit == c) {
                Some(digit) if raised => digits.push_str(&digit.to_string()),
                None if raised && c == '⁻' && digits.is_empty() => digits.push('-'),
                None if !raised && c.is_ascii_digit() => digits.push(c),
                None if marked.is_some() && matches!(c, '-' | '−') && digits.is_empty() => digits.push('-'),
                _ => break,
            }
            rest = &rest[c.len_utf8()..];
        }
        if let Some(close) = close {
            rest = rest.strip_prefix(close)?;
        }
        self.rest = rest;
        digits.parse().ok().filter(|exponent: &i32| *exponent != 0 && exponent.abs() <= LARGEST_EXPONENT)
    }
}

/// A unit by its name, and the prefix before it.
fn look_up(name: &str) -> Option<(&'static Known, Option<char>)> {
    let lower = name.to_lowercase();
    let plain = |known: &&Known, same: &dyn Fn(&str) -> bool| known.names.iter().any(|own| same(own));
    let find = |same: &dyn Fn(&str) -> bool| KNOWN.iter().find(|known| plain(known, same));
    if let Some(known) = find(&|own| own == name) {
        return Some((known, None));
    }
    let prefixed = |exact: bool| {
        KNOWN.iter().find_map(|known| {
            let symbol = known.names[0];
            let prefix = known.prefixes.chars().find(|prefix| {
                // µ is two letters of Unicode, and often written u.
                let spelled: &[char] = if *prefix == 'µ' { &['µ', 'μ', 'u'] } else { &[*prefix] };
                spelled.iter().any(|letter| {
                    let whole = format!("{letter}{symbol}");
                    if exact { whole == name } else { whole.to_lowercase() == lower }
                })
            })?;
            Some((known, Some(prefix)))
        })
    };
    prefixed(true)
        .or_else(|| find(&|own| own.to_lowercase() == lower).map(|known| (known, None)))
        .or_else(|| prefixed(false))
        .or_else(|| {
            PREFIXES.iter().find_map(|(prefix, word, _)| {
                let rest = lower.strip_prefix(word)?;
                let long = |own: &&&str| own.chars().count() > 2 && **own == rest;
                let known = KNOWN.iter().find(|known| known.names[1..].iter().any(|own| long(&own)))?;
                known.prefixes.contains(*prefix).then_some((known, Some(*prefix)))
            })
        })
}

/// `rad/s`, `N·m`, `1/s`, `rad/(N·s)`.
fn symbol(parts: &[(&'static Known, Option<char>, i32)]) -> String {
    let list = |above: bool| -> Vec<String> {
        parts
            .iter()
            .filter(|(_, _, exponent)| (*exponent > 0) == above)
            .map(|(known, prefix, exponent)| {
                let prefix = prefix.map_or(String::new(), String::from);
                let power = if exponent.abs() == 1 { String::new() } else { format!("^{}", exponent.abs()) };
                format!("{prefix}{}{power}", known.names[0])
            })
            .collect()
    };
    let (above, below) = (list(true).join("·"), list(false).join("·"));
    match (above.as_str(), below.as_str()) {
        (above, "") => above.to_owned(),
        ("", below) => format!("1/{}", in_parentheses(below)),
        (above, below) => format!("{above}/{}", in_parentheses(below)),
    }
}

fn in_parentheses(symbol: &str) -> String {
    if symbol.contains(['·', '/']) { format!("({symbol})") } else { symbol.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(text: &str) -> Unit {
        Unit::parse(text).unwrap_or_else(|| panic!("{text:?} is a unit"))
    }

    #[test]
    fn spellings() {
        for (symbol, spellings) in [
            (
                "rad/s",
                &[
                    "rad/s",
                    "rad/sec",
                    "rad s^-1",
                    "rad·s⁻¹",
                    "rad s⁻¹",
                    "radians/second",
                    "Rad/S",
                    "radians per second",
                    "(rad/s)",
                    "[rad/s]",
                    "in rad/s",
                    "rad/s.",
                    "rad*s^{-1}",
                    "rad/(s)",
                    "rad / s",
                    "rad s**-1",
                ][..],
            ),
            ("deg", &["°", "º", "degrees", "Degree", "deg"]),
            ("deg/s", &["°/s", "deg/s", "degrees per second"]),
            ("Hz", &["Hz", "hz", "HZ", "hertz"]),
            ("kHz", &["kHz", "khz", "kilohertz"]),
            ("rpm", &["rpm", "RPM"]),
            ("rev/min", &["rev/min", "revolutions per minute"]),
            ("1/s", &["1/s", "s^-1", "s⁻¹"]),
            ("ms", &["ms", "MS", "milliseconds"]),
            ("µs", &["µs", "μs", "us", "microseconds"]),
            ("m/s^2", &["m/s^2", "m/s²", "m s^-2", "m/s2", "m/s/s"]),
            ("mV", &["mV", "mv", "millivolts"]),
            ("cm", &["cm", "CM", "centimetres", "centimeters"]),
            ("%", &["%", "percent", "Percent"]),
            ("N·m", &["N m", "N·m", "newton metres"]),
            ("rad/(N·s)", &["rad/(N s)", "rad/(N·s)", "rad N^-1 s^-1"]),
            ("kg·m^2/s^2", &["kg m^2/s^2", "kg·m²/s²"]),
            ("V/°C", &["V/°C", "V/ºC", "V per degC"]),
            ("°C/kW", &["°C/kW", "degC/kW"]),
        ] {
            for spelling in spellings {
                let read = unit(spelling);
                let same = if *spelling == "m/s/s" { "m/(s·s)" } else { symbol };
                assert_eq!(read.symbol(), same, "{spelling:?}");
            }
        }
        for text in [
            "",
            "apples",
            "1",
            "rad/",
            "/s",
            "rad^",
            "s^0",
            "s^99",
            "m^2.5/s",
            "rad s)",
            "(rad",
            "((((s))))",
            "5",
            "s5s",
            "not s",
            "rad or deg",
            "<b>",
            "\u{1b}[31m",
            "zero",
            "s s s s s s s s s s s s s",
            "at rest",
            "unstable",
        ] {
            assert_eq!(Unit::parse(text), None, "{text:?}");
        }
        assert_eq!(Unit::parse(&"s/".repeat(100_000)), None);
    }

    /// Factor and power of π.
    type Want = Option<(&'static str, i32)>;

    /// 1 of the first is so many of the second.
    #[track_caller]
    fn check(rows: &[(&str, &str, Want)]) {
        for (from, to, want) in rows {
            let want = want.map(|(factor, pi)| {
                let (above, below) = factor.split_once('/').unwrap_or((factor, "1"));
                UnitRatio { factor: parse_decimal(above).unwrap() / parse_decimal(below).unwrap(), pi }
            });
            let of = |text: &str| if text.is_empty() { Unit::one() } else { unit(text) };
            assert_eq!(of(from).in_unit(&of(to)), want, "{from} in {to}");
        }
    }

    #[test]
    fn conversions_are_exact() {
        check(&[
            ("rad/s", "rad/s", Some(("1", 0))),
            ("Hz", "rad/s", Some(("2", 1))),
            ("rad/s", "Hz", Some(("1/2", -1))),
            ("rpm", "rad/s", Some(("1/30", 1))),
            ("rev/min", "rpm", Some(("1", 0))),
            ("rpm", "Hz", Some(("1/60", 0))),
            ("deg", "rad", Some(("1/180", 1))),
            ("deg/s", "Hz", Some(("1/360", 0))),
            ("mrad", "rad", Some(("0.001", 0))),
            ("ms", "s", Some(("0.001", 0))),
            ("min", "s", Some(("60", 0))),
            ("cm", "mm", Some(("10", 0))),
            ("km/h", "m/s", Some(("1000/3600", 0))),
            ("L/min", "m^3/s", Some(("1/60000", 0))),
            ("mV", "V", Some(("0.001", 0))),
            ("kg", "g", Some(("1000", 0))),
            ("N m", "J", Some(("1", 0))),
            ("W", "V A", Some(("1", 0))),
            ("%", "", Some(("0.01", 0))),
            ("", "%", Some(("100", 0))),
            // Angles left unsaid
            ("1/s", "rad/s", Some(("1", 0))),
            ("1/s", "Hz", Some(("1", 0))),
            ("1/min", "rpm", Some(("1", 0))),
            ("N m/rad", "N m", Some(("1", 0))),
            // Other quantities
            ("rad", "", None),
            ("%", "rad", None),
            ("s", "rad", None),
            ("m", "s", None),
            ("Hz", "s", None),
            ("rad/s^2", "rad/s", None),
        ]);
        assert_eq!(Unit::named("counts").in_unit(&Unit::named("Counts")).map(|ratio| ratio.pi), Some(0));
        assert_eq!(Unit::named("counts").in_unit(&unit("m")), None);
    }

    #[test]
    fn what_units_measure() {
        for (text, quantity) in [
            ("rad", "an angle"),
            ("rpm", "a frequency"),
            ("1/s", "a frequency"),
            ("ms", "a time"),
            ("cm", "a length"),
            ("%", "a ratio"),
            ("mV", "a voltage"),
            ("N m", "a torque or an energy"),
            ("kg^3", "another quantity"),
        ] {
            assert_eq!(unit(text).quantity(), quantity, "{text}");
        }
        let others = |text: &str| -> Vec<String> {
            unit(text).others().iter().map(|unit| unit.symbol().to_owned()).collect()
        };
        assert_eq!(others("rad/s"), ["Hz", "rpm", "deg/s"]);
        assert_eq!(others("s"), ["ms", "min"]);
        assert_eq!(others("%"), [""]);
        assert!(Unit::named("counts").others().is_empty());
        assert_eq!(unit("rad").over(&unit("N s")).unwrap().symbol(), "rad/(N·s)");
        assert_eq!(
            unit("1/s").understood_as(&unit("rad/s")).in_unit(&unit("Hz")),
            unit("rad/s").in_unit(&unit("Hz"))
        );
    }
}

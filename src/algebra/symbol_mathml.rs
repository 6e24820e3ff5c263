use super::greek;

/// A name as a textbook prints it: `theta` → θ, `x''` → ẍ, `omega_n` → ωₙ, `J1` → J₁.
///
/// MathML; anything in the name that is markup is made harmless.
pub fn symbol_mathml(name: &str, primes: u8) -> String {
    let (base, index) = split_index(name);
    // h1_0 is the letter h, number 1, at rest.
    let (base, number) = match (index, split_index(base)) {
        (Some(_), (letter, Some(number))) => (letter, Some(number)),
        _ => (base, None),
    };
    // A name of several letters is upright by itself; a single letter is italic.
    let base = format!("<mi>{}</mi>", glyph(base));
    let dots = match primes {
        0 => None,
        1 => Some("˙".to_owned()),
        2 => Some("¨".to_owned()),
        n => Some(format!("({n})")),
    };
    let marked = match dots {
        None => base,
        Some(dots) if primes > 2 => format!("<msup>{base}<mi>{dots}</mi></msup>"),
        // Not `accent`: without a mathematical font Chromium prints an accent into the letter.
        Some(dots) => format!("<mover>{base}<mo>{dots}</mo></mover>"),
    };
    match index {
        None => marked,
        Some(index) if number.is_some() => {
            let (number, index) = (number.unwrap_or_default(), glyph(index));
            let index = if index.bytes().all(|b| b.is_ascii_digit()) {
                format!("<mn>{index}</mn>")
            } else {
                format!("<mi>{index}</mi>")
            };
            format!("<msub>{marked}<mrow><mn>{number}</mn><mo>,</mo>{index}</mrow></msub>")
        }
        Some(index) if index.bytes().all(|b| b.is_ascii_digit()) => {
            format!("<msub>{marked}<mn>{index}</mn></msub>")
        }
        Some(index) => {
            format!("<msub>{marked}<mi>{}</mi></msub>", glyph(index))
        }
    }
}

/// `omega_n` → (`omega`, `n`); `x12` → (`x`, `12`); `x` → (`x`, nothing).
fn split_index(name: &str) -> (&str, Option<&str>) {
    if let Some((base, index)) = name.split_once('_')
        && !base.is_empty()
        && !index.is_empty()
    {
        return (base, Some(index));
    }
    let base = name.trim_end_matches(|c: char| c.is_ascii_digit());
    match &name[base.len()..] {
        "" => (name, None),
        _ if base.is_empty() => (name, None),
        index => (base, Some(index)),
    }
}

/// The Greek letter of a name, or the name itself, safe in markup.
fn glyph(name: &str) -> String {
    greek::letter(name).map_or_else(|| escape(name), String::from)
}

fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            '"' => escaped.push_str("&quot;"),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::symbol_mathml;

    #[track_caller]
    fn check(rows: &[(&str, u8, &str)]) {
        for (name, primes, expected) in rows {
            assert_eq!(symbol_mathml(name, *primes), *expected, "{name}");
        }
    }

    #[test]
    fn names_look_like_a_textbook() {
        check(&[
            ("x", 0, "<mi>x</mi>"),
            ("x", 2, "<mover><mi>x</mi><mo>¨</mo></mover>"),
            ("theta", 1, "<mover><mi>θ</mi><mo>˙</mo></mover>"),
            ("omega_n", 0, "<msub><mi>ω</mi><mi>n</mi></msub>"),
            ("J1", 0, "<msub><mi>J</mi><mn>1</mn></msub>"),
            ("h1_0", 0, "<msub><mi>h</mi><mrow><mn>1</mn><mo>,</mo><mn>0</mn></mrow></msub>"),
            ("x1", 1, "<msub><mover><mi>x</mi><mo>˙</mo></mover><mn>1</mn></msub>"),
            ("mass", 0, "<mi>mass</mi>"),
            ("_a", 0, "<mi>_a</mi>"),
            ("<b>", 0, "<mi>&lt;b&gt;</mi>"),
            ("x", 3, "<msup><mi>x</mi><mi>(3)</mi></msup>"),
        ]);
    }
}

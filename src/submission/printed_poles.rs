//! Poles as programs print them: what stands around the numbers, and a scale in front of them.

use std::borrow::Cow;

/// A printed list without what is no number in it, byte for byte as long as it was, and the power of ten it is scaled by.
///
/// ```text
/// >> pole(G)
/// ans =
///
///    1.0e+02 *
///
///   -0.2398 + 0.3519i
/// ```
///
/// Also `p =` on a line of its own and Python's `array([…])`. Of a text with two scales nothing is taken away.
pub(super) fn printed(text: &str) -> (Cow<'_, str>, i32) {
    let mut plain = String::with_capacity(text.len());
    let mut scale = None;
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    for (i, line) in lines.iter().enumerate() {
        let body = line.trim();
        let more = lines[i + 1..].iter().any(|line| !line.trim().is_empty());
        let power = power_of_ten(body).filter(|_| more);
        if power.is_some() && scale.replace(power).is_some() {
            return (Cow::Borrowed(text), 0);
        }
        if power.is_some() || (more && (body.starts_with(">>") || is_name(body))) {
            plain.extend(
                line.chars().map(|c| if c == '\n' { "\n".to_owned() } else { " ".repeat(c.len_utf8()) }),
            );
        } else {
            plain.push_str(line);
        }
    }
    let plain = without_array(&plain);
    let power = scale.flatten().unwrap_or(0);
    if plain == text { (Cow::Borrowed(text), power) } else { (Cow::Owned(plain), power) }
}

/// `1.0e+02 *`: 2.
fn power_of_ten(line: &str) -> Option<i32> {
    let number = line.strip_suffix('*')?.trim_end();
    let (mantissa, power) = number.split_once(['e', 'E'])?;
    let one = matches!(mantissa, "1" | "1." | "1.0" | "1.00" | "1.000" | "1.0000");
    power.parse().ok().filter(|power: &i32| one && power.abs() <= 99)
}

/// `ans =`, `poles =`, `p1 =`, `pole(G) =`
fn is_name(line: &str) -> bool {
    let Some(name) = line.strip_suffix('=').map(str::trim_end) else { return false };
    let (head, argument) = name.split_once('(').unwrap_or((name, ")"));
    head.starts_with(char::is_alphabetic)
        && head.chars().all(|c| c.is_alphanumeric() || c == '_')
        && argument.ends_with(')')
        && argument.len() <= 20
}

/// With spaces for `array(`, `np.array(` and their end `)`, `, dtype=complex128)`.
fn without_array(text: &str) -> String {
    let body = text.trim();
    let heads = ["np.array(", "numpy.array(", "array("];
    let head = heads.into_iter().find(|head| body.starts_with(head));
    let Some((head, inner)) = head.and_then(|head| Some((head, body.strip_suffix(')')?))) else {
        return text.to_owned();
    };
    let from = text.len() - text.trim_start().len();
    let inner = &inner[head.len()..];
    let end =
        inner.find("dtype").map_or(inner.len(), |at| inner[..at].trim_end().trim_end_matches(',').len());
    let start = from + head.len();
    let (before, after) = (" ".repeat(start), " ".repeat(text.len() - start - end));
    format!("{before}{}{after}", &inner[..end])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_becomes_spaces() {
        for (text, plain, scale) in [
            ("ans =\n\n -1\n -2", "     \n\n -1\n -2", 0),
            ("p =\n  1.0e+02 *\n -1", "   \n           \n -1", 2),
            (">> pole(G)\nans =\n-1", "          \n     \n-1", 0),
            ("array([-1., -2.])", "      [-1., -2.] ", 0),
            ("np.array([-1], dtype=complex128)", "         [-1]                   ", 0),
            ("1.0e+02 *", "1.0e+02 *", 0),
            ("1.0e+02 *\n-1\n1.0e+02 *\n-1", "1.0e+02 *\n-1\n1.0e+02 *\n-1", 0),
            ("p =", "p =", 0),
            ("p = -1", "p = -1", 0),
        ] {
            let (found, power) = printed(text);
            assert_eq!((found.as_ref(), power), (plain, scale), "{text:?}");
            assert_eq!(found.len(), text.len(), "{text:?}");
        }
    }
}

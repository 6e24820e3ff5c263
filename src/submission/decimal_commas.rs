use super::decimal::is_minus;
use super::problem::quote;
use crate::source::{Finding, Node, Span};

/// Numbers in a YAML list that a decimal comma has cut in two: `[-0,143, 2]` is −0, 143 and 2 to YAML.
///
/// Seen by a comma without a space between two whole numbers, where the list has other separators too, the first is
/// `-0`, or the second has a leading zero; `[1,2,5]` is left alone. `poles`: also where the first is 0.
pub(super) fn decimal_comma_between(items: &[Node], source: &str, poles: bool) -> Option<Finding> {
    let loose = items.windows(2).any(|pair| !tight(&pair[0], &pair[1], source));
    items.windows(2).find_map(|pair| {
        let (first, second) = (plain(&pair[0], source)?, plain(&pair[1], source)?);
        let whole = first.trim_start_matches(is_minus);
        let rest = second.trim_start_matches(|c: char| c.is_ascii_digit());
        let digits = &second[..second.len() - rest.len()];
        let cut = tight(&pair[0], &pair[1], source) && is_digits(last_number(whole)) && is_digits(digits);
        let likely = loose
            || (whole == "0" && first != "0")
            || (digits.len() > 1 && digits.starts_with('0'))
            || (poles && (whole == "0" || !is_digits(whole) || !rest.is_empty()));
        if !cut || !likely {
            return None;
        }
        let start = pair[0].span.start + first.len() - last_number(first).len();
        let minus = source.get(..start).is_some_and(|before| before.ends_with(is_minus));
        let start =
            if minus { source[..start].char_indices().next_back().map_or(start, |(i, _)| i) } else { start };
        let end = pair[1].span.start + digits.len();
        let written = source.get(start..end)?;
        Some(
            Finding::error(
                "number.decimal_comma",
                format!(
                    "A comma separates the entries of a list, so {} is read as two numbers.",
                    quote(written)
                ),
            )
            .with_help(format!(
                "Write {}; if two numbers are meant, put a space after the comma.",
                quote(&written.replacen(',', ".", 1))
            ))
            .at(Span { start, end }),
        )
    })
}

/// The text of a scalar that stands in the file just as it is, without quotes.
fn plain<'a>(node: &'a Node, source: &str) -> Option<&'a str> {
    node.as_scalar().filter(|text| source.get(node.span.start..node.span.end) == Some(*text))
}

/// The digits a text ends with, a point in them included.
fn last_number(text: &str) -> &str {
    let kept = text.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
    &text[kept.len()..]
}

fn is_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit())
}

/// Nothing but a comma stands between the two.
fn tight(first: &Node, second: &Node, source: &str) -> bool {
    source.get(first.span.end..second.span.start) == Some(",")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::parse;

    #[track_caller]
    fn check(list: &str, poles: bool, expected: Option<(&str, &str)>) {
        let tree = parse(list).unwrap();
        let found = decimal_comma_between(tree.as_sequence().unwrap(), list, poles);
        let seen = found
            .as_ref()
            .map(|f| (&list[f.span.unwrap().start..f.span.unwrap().end], f.help.as_deref().unwrap()));
        match (seen, expected) {
            (None, None) => {}
            (Some((marked, help)), Some((text, written))) => {
                assert_eq!(marked, text, "{list}");
                assert!(help.contains(&format!("`{written}`")), "{list}: {help}");
            }
            _ => panic!("{list}: {found:?}"),
        }
    }

    #[test]
    fn decimal_commas_in_lists_are_suspected() {
        check("[-0,143, -0.0195 ± 5.59j]", true, Some(("-0,143", "-0.143")));
        check("[5,568, -5,607, -0,1428]", true, Some(("5,568", "5.568")));
        check("[-0,0195 ± 5,59j]", true, Some(("-0,0195", "-0.0195")));
        check("[-2 ± 5,59j]", true, Some(("5,59", "5.59")));
        check("[-0,143]", true, Some(("-0,143", "-0.143")));
        check("[0,143]", true, Some(("0,143", "0.143")));
        check("[0,0132, 0,0024]", false, Some(("0,0132", "0.0132")));
        check("[-0,06,0]", false, Some(("-0,06", "-0.06")));
        check("[1,2,5]", false, None);
        check("[1,0,5]", false, None);
        check("[0,1]", false, None);
        check("[-1,-2,-3]", true, None);
        check("[1, 2, 5]", true, None);
        check("[0.5,1,2]", false, None);
        check("[-1,2]", true, None);
        check("['−84',1, 2]", true, None);
        check("[]", true, None);
    }
}

use super::comma_to_point::only_decimal_in_poles;
use super::decimal::is_minus;
use super::problem::quote;
use crate::source::{Finding, Node, Span, Value};

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

/// The poles of a YAML list that decimal commas have cut in two, put together again; `None` when in doubt.
///
/// `[5,568, -5,607, -0,1428]` is three: commas with a space after them separate, the others stand between two digits each,
/// and one of these, as a separator, would leave `-0` or `05` behind. Nobody writes a list of whole numbers so.
pub(super) fn rejoined_poles(items: &[Node], source: &str) -> Option<Vec<Node>> {
    let mut whole: Vec<Node> = Vec::new();
    for item in items {
        plain(item, source)?;
        let Some(last) = whole.last_mut() else {
            whole.push(item.clone());
            continue;
        };
        if tight(last, item, source) {
            last.span.end = item.span.end;
            last.value = Value::Scalar(source.get(last.span.start..last.span.end)?.to_owned());
        } else {
            let between = source.get(last.span.end..item.span.start)?.strip_prefix(',')?;
            (!between.is_empty() && between.trim().is_empty()).then_some(())?;
            whole.push(item.clone());
        }
    }
    let together = source.get(items.first()?.span.start..items.last()?.span.end)?;
    (whole.len() < items.len() && only_decimal_in_poles(&on_one_line(together), false)).then_some(whole)
}

fn on_one_line(text: &str) -> String {
    text.replace(['\n', '\r'], " ")
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
    fn poles_cut_in_two_are_put_together_only_when_nothing_else_can_be_meant() {
        for (list, whole) in [
            ("[5,568, -5,607, -0,1428]", Some("5,568 | -5,607 | -0,1428")),
            ("[5,568,\n   -5,607,\n   -0,1428]", Some("5,568 | -5,607 | -0,1428")),
            ("[-0,1429, -0,0195 ± 5,586j]", Some("-0,1429 | -0,0195 ± 5,586j")),
            ("[-2 ± 5,59j]", Some("-2 ± 5,59j")),
            ("[-0,143]", Some("-0,143")),
            ("[-1, 5,05]", Some("-1 | 5,05")),
            // May be four whole numbers, or thousands.
            ("[5,568, -5,607]", None),
            ("[1,2, 3,4]", None),
            ("[0,5, -1,3]", None),
            ("[-1,2]", None),
            ("[0,143]", None),
            // Commas that mean two things, or may.
            ("[-0,1,-2,5]", None),
            ("[-0,143,-2]", None),
            ("[-0,143 , -2]", None),
            ("[-0,143, -2.5]", None),
            ("[-0,143, '2']", None),
            ("[-0,143, {re: 1}]", None),
            ("[-1, -2, -3]", None),
            ("[-0, 143]", None),
            ("[]", None),
        ] {
            let tree = parse(list).unwrap();
            let found = rejoined_poles(tree.as_sequence().unwrap(), list);
            let found =
                found.map(|nodes| nodes.iter().filter_map(Node::as_scalar).collect::<Vec<_>>().join(" | "));
            assert_eq!(found.as_deref(), whole, "{list}");
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

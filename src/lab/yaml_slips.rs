//! What is most often wrong with the indentation of a YAML file, in words that say what to do.

use crate::source::Span;

/// The likeliest slip on the line of byte `at`, or on the one before it: its place, what is wrong, and what to do.
pub(super) fn slip(text: &str, at: usize) -> Option<(Span, String, String)> {
    let mut start = 0;
    let lines: Vec<(usize, &str)> = text
        .split_inclusive('\n')
        .map(|line| {
            start += line.len();
            (start - line.len(), line.trim_end())
        })
        .filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'))
        .collect();
    let here = lines.iter().rposition(|(start, _)| *start <= at)?;
    let (start, line) = lines[here];
    let before = here.checked_sub(1).map(|place| lines[place]);
    let indent = |line: &str| line.len() - line.trim_start().len();
    if let Some(tab) = line[..indent(line)].find('\t') {
        let place = Span { start: start + tab, end: start + tab + 1 };
        return Some((place, "a tab stands where the line is indented".into(), "indent with spaces".into()));
    }
    let glued = [Some((start, line)), before]
        .into_iter()
        .flatten()
        .find_map(|(start, line)| Some((start, glued(line)?)));
    if let Some((start, (key, colon))) = glued {
        let place = Span { start: start + colon, end: start + colon + 1 };
        let help = format!("write a space behind it: `{key}: …`");
        return Some((place, "a colon without a space behind it parts nothing".into(), help));
    }
    let (_, above) = before?;
    let place = Span { start: start + indent(line), end: start + line.len() };
    if indent(line) > indent(above) && !above.ends_with([':', '|', '>', ',', '[', '{']) {
        let message = "this line is indented further than the one above, which has its value already";
        let help = format!("begin it in the same column, {}", indent(above) + 1);
        return Some((place, message.into(), help));
    }
    let columns: Vec<usize> = lines[..here].iter().map(|(_, line)| indent(line)).collect();
    if !columns.contains(&indent(line)) {
        let near = columns.iter().rev().find(|column| column.abs_diff(indent(line)) <= 2)?;
        let message = format!("this line begins in column {}, and none above does", indent(line) + 1);
        return Some((
            place,
            message,
            format!("begin it where the keys beside it do, perhaps in column {}", near + 1),
        ));
    }
    None
}

/// `points:4`, `m:{value: 2}`: the key at the beginning of a line, and where its colon stands.
fn glued(line: &str) -> Option<(&str, usize)> {
    let first = line.len() - line.trim_start().len();
    let key = line[first..].find(|c: char| !c.is_alphanumeric() && !matches!(c, '_' | '-' | '.'))?;
    let colon = first + key;
    let rest = line[colon..].strip_prefix(':')?;
    // `http://…` and times are no keys.
    (key > 0 && rest.starts_with(|c: char| !c.is_whitespace() && c != '/'))
        .then(|| (&line[first..colon], colon))
}

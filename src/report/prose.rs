//! Markdown as students write it → HTML that is safe to stand in a page.
//!
//! Two walls: raw HTML, odd links and pictures are taken out of the Markdown events, and what is written from them is cleaned
//! against a list of allowed elements. Footnotes are not read, since their anchors would be the student's own ids.

use super::escape::{escape, is_harmless};
use super::numbers::typeset;
use ammonia::{Builder, UrlRelative};
use pulldown_cmark::{Event, LinkType, Options, Parser, Tag, TagEnd};
use pulldown_latex::config::{DisplayMode, RenderConfig};
use std::ops::Range;
use std::sync::LazyLock;

const LONGEST_TEXT: usize = 20_000;
const DEEPEST: usize = 32;
const MOST_EVENTS: usize = 6_000;
const LONGEST_FORMULA: usize = 2_000;
const MOST_BRACES: usize = 50;

/// `markdown` as safe HTML. What is too long is cut, what nests too deep is shown as it was typed.
pub fn to_html(markdown: &str) -> String {
    to_html_marked(markdown, &[])
}

/// Words to be marked, and what is set behind them: `1`.
#[derive(Clone, Debug, PartialEq)]
pub struct Highlight {
    /// Bytes of the Markdown.
    pub bytes: Range<usize>,
    /// Letters and digits, commas and spaces.
    pub label: String,
}

/// As [`to_html`], with words marked. Marks outside the text, or in what is shown as it was typed, are left out.
pub fn to_html_marked(markdown: &str, marks: &[Highlight]) -> String {
    let (text, left_out) = cut(markdown);
    let clean: String = text.chars().filter(|c| is_harmless(*c)).collect();
    let marks = without_dropped(text, marks);
    let mut html = match events(&clean) {
        Some(events) => {
            let mut out = String::with_capacity(2 * clean.len());
            pulldown_cmark::html::push_html(&mut out, highlighted(&clean, events, &marks).into_iter());
            CLEANER.clean(&out).to_string()
        }
        None => as_typed(&clean),
    };
    if left_out > 0 {
        html.push_str(&format!("<p>… {left_out} more bytes are not shown.</p>"));
    }
    html
}

/// Where the marks stand once the characters that are not harmless are gone.
fn without_dropped(text: &str, marks: &[Highlight]) -> Vec<Highlight> {
    let dropped: Vec<(usize, usize)> =
        text.char_indices().filter(|(_, c)| !is_harmless(*c)).map(|(at, c)| (at, c.len_utf8())).collect();
    let moved = |at: usize| {
        at - dropped
            .iter()
            .take_while(|(place, _)| *place < at)
            .map(|(_, length)| length)
            .sum::<usize>()
            .min(at)
    };
    marks
        .iter()
        .filter(|mark| text.get(mark.bytes.clone()).is_some())
        .map(|mark| Highlight {
            bytes: moved(mark.bytes.start)..moved(mark.bytes.end),
            label: mark.label.clone(),
        })
        .filter(|mark| !mark.bytes.is_empty())
        .collect()
}

/// An event and the bytes it comes from.
type Placed<'a> = (Event<'a>, Range<usize>);

/// The events with `<mark>` about what is marked, the label behind the last of it. Marks must not overlap.
fn highlighted<'a>(text: &'a str, events: Vec<Placed<'a>>, marks: &[Highlight]) -> Vec<Event<'a>> {
    let can_be_marked = |event: &Event<'_>| {
        matches!(event, Event::Text(_) | Event::Code(_) | Event::InlineHtml(_) | Event::SoftBreak)
    };
    let meet = |a: &Range<usize>, b: &Range<usize>| a.start < b.end && b.start < a.end;
    let lasts: Vec<Option<usize>> = marks
        .iter()
        .map(|mark| {
            events.iter().rposition(|(event, bytes)| can_be_marked(event) && meet(bytes, &mark.bytes))
        })
        .collect();
    let mut out = Vec::with_capacity(events.len() + 4 * marks.len());
    for (i, (event, bytes)) in events.into_iter().enumerate() {
        let here: Vec<usize> = match can_be_marked(&event) {
            true => (0..marks.len()).filter(|&m| meet(&bytes, &marks[m].bytes)).collect(),
            false => Vec::new(),
        };
        // Text that stands in the page as it stands in the file can be marked in part.
        let literal = matches!(&event, Event::Text(shown) if text.get(bytes.clone()) == Some(shown.as_ref()));
        let mut at = bytes.start;
        for &m in &here {
            let part = if literal {
                let (start, end) = (marks[m].bytes.start.max(at), marks[m].bytes.end.min(bytes.end));
                if at < start {
                    out.push(Event::Text(text[at..start].into()));
                }
                at = end;
                Event::Text(text[start..end].into())
            } else {
                event.clone()
            };
            out.push(Event::InlineHtml("<mark class=\"conflict\">".into()));
            out.push(part);
            let label =
                if lasts[m] == Some(i) { format!("<sup>{}</sup>", marks[m].label) } else { String::new() };
            out.push(Event::InlineHtml(format!("</mark>{label}").into()));
            if !literal {
                break;
            }
        }
        match (here.is_empty(), literal) {
            (true, _) => out.push(event),
            (false, true) if at < bytes.end => out.push(Event::Text(text[at..bytes.end].into())),
            _ => {}
        }
    }
    out
}

/// Sentences of ours as HTML: `what stands in backticks` as code, the mathematics of the rest as print has it.
pub fn sentences(text: &str) -> String {
    let mut html = String::with_capacity(text.len() + 16);
    let parts: Vec<&str> = text.split('`').collect();
    for (i, part) in parts.iter().enumerate() {
        if i % 2 == 1 && i + 1 < parts.len() {
            html.push_str("<code>");
            escape(&mut html, part);
            html.push_str("</code>");
        } else {
            html.push_str(if i % 2 == 1 { "`" } else { "" });
            escape(&mut html, &typeset(part));
        }
    }
    html
}

/// Text as it was typed, line breaks kept.
pub fn as_typed(text: &str) -> String {
    let mut out = String::from("<pre class=\"typed\">");
    escape(&mut out, text);
    out.push_str("</pre>");
    out
}

/// The start of `text` that is shown, and how many bytes are not.
fn cut(text: &str) -> (&str, usize) {
    let end = floor(text, LONGEST_TEXT.min(text.len()));
    (&text[..end], text.len() - end)
}

/// The last character boundary at or before `index`.
fn floor(text: &str, mut index: usize) -> usize {
    while !text.is_char_boundary(index) {
        index -= 1;
    }
    index
}

/// Harmless events; `None` when there are too many or they nest too deep.
fn events(text: &str) -> Option<Vec<Placed<'_>>> {
    let options = Options::ENABLE_TABLES | Options::ENABLE_MATH | Options::ENABLE_STRIKETHROUGH;
    let mut out = Vec::new();
    let mut depth = 0;
    // For each open link, whether it is kept.
    let mut links = Vec::new();
    for (event, bytes) in Parser::new_ext(text, options).into_offset_iter() {
        match &event {
            Event::Start(_) => depth += 1,
            Event::End(_) => depth -= 1,
            _ => {}
        }
        if depth > DEEPEST || out.len() > MOST_EVENTS {
            return None;
        }
        let harmless = match event {
            Event::Html(html) | Event::InlineHtml(html) => Event::Text(html),
            Event::Start(Tag::HtmlBlock) => Event::Start(Tag::Paragraph),
            Event::End(TagEnd::HtmlBlock) => Event::End(TagEnd::Paragraph),
            // The page has its own headings.
            Event::Start(Tag::Heading { .. }) => {
                out.push((Event::Start(Tag::Paragraph), bytes.clone()));
                Event::Start(Tag::Strong)
            }
            Event::End(TagEnd::Heading(_)) => {
                out.push((Event::End(TagEnd::Strong), bytes.clone()));
                Event::End(TagEnd::Paragraph)
            }
            Event::Start(Tag::Link { link_type, dest_url, .. }) => {
                let kept = matches!(link_type, LinkType::Email) || is_open_link(&dest_url);
                links.push(kept);
                if !kept {
                    continue;
                }
                let (title, id) = ("".into(), "".into());
                Event::Start(Tag::Link { link_type, dest_url, title, id })
            }
            Event::End(TagEnd::Link) => {
                if links.pop() != Some(true) {
                    continue;
                }
                Event::End(TagEnd::Link)
            }
            // A picture's description stays; the picture would need the network.
            Event::Start(Tag::Image { .. }) | Event::End(TagEnd::Image) => continue,
            Event::InlineMath(source) => formula(&source, DisplayMode::Inline),
            Event::DisplayMath(source) => formula(&source, DisplayMode::Block),
            other => other,
        };
        out.push((harmless, bytes));
    }
    Some(out)
}

fn is_open_link(url: &str) -> bool {
    let lower = url.trim_start().to_ascii_lowercase();
    ["http://", "https://", "mailto:"].iter().any(|scheme| lower.starts_with(scheme))
}

/// A formula as MathML, or as typed when it is not one we can set.
fn formula<'a>(source: &str, display_mode: DisplayMode) -> Event<'a> {
    match mathml(source, display_mode) {
        Some(math) => Event::InlineHtml(math.into()),
        None => Event::Code(source.to_owned().into()),
    }
}

fn mathml(source: &str, display_mode: DisplayMode) -> Option<String> {
    let braces = source.matches('{').count();
    // `\operatorname` writes its argument as it is.
    let raw = source.contains("operatorname") && source.contains(['<', '>', '&', '"']);
    if source.len() > LONGEST_FORMULA || braces > MOST_BRACES || raw {
        return None;
    }
    let storage = pulldown_latex::Storage::new();
    let events: Vec<_> = pulldown_latex::Parser::new(source, &storage).collect::<Result<_, _>>().ok()?;
    let config = RenderConfig { display_mode, ..RenderConfig::default() };
    let events = events.into_iter().map(Ok::<_, pulldown_latex::ParserError>);
    let mut out = String::new();
    pulldown_latex::push_mathml(&mut out, events, config).ok()?;
    Some(out)
}

/// What may stand in a student's prose.
static CLEANER: LazyLock<Builder<'static>> = LazyLock::new(|| {
    let text = [
        "p",
        "br",
        "hr",
        "strong",
        "em",
        "del",
        "code",
        "pre",
        "blockquote",
        "ul",
        "ol",
        "li",
        "table",
        "thead",
        "tbody",
        "tr",
        "th",
        "td",
        "a",
        // Ours: a student's own are text by now.
        "mark",
        "sup",
    ];
    let math = [
        "math",
        "mrow",
        "mi",
        "mn",
        "mo",
        "ms",
        "mtext",
        "mspace",
        "mfrac",
        "msqrt",
        "mroot",
        "msup",
        "msub",
        "msubsup",
        "munder",
        "mover",
        "munderover",
        "mmultiscripts",
        "mprescripts",
        "mtable",
        "mtr",
        "mtd",
        "mpadded",
        "mphantom",
        "mstyle",
    ];
    let math_attributes = [
        "display",
        "displaystyle",
        "scriptlevel",
        "mathvariant",
        "stretchy",
        "symmetric",
        "fence",
        "separator",
        "lspace",
        "rspace",
        "minsize",
        "maxsize",
        "movablelimits",
        "largeop",
        "form",
        "accent",
        "accentunder",
        "linethickness",
        "width",
        "height",
        "depth",
        "columnspan",
        "rowspan",
    ];
    let table_classes = [
        "menv-alignlike",
        "menv-arraylike",
        "menv-cases",
        "menv-cells-left",
        "menv-cells-right",
        "cell-left",
        "cell-right",
        "menv-align",
    ];
    let of_math = math.map(|tag| (tag, math_attributes.into_iter().collect()));
    let of_text = [("a", ["href"]), ("ol", ["start"])].map(|(tag, list)| (tag, list.into_iter().collect()));
    let tables = ["mtable", "mtr", "mtd"].map(|tag| (tag, table_classes.into_iter().collect()));
    let classes = tables.into_iter().chain([("mark", ["conflict"].into())]);
    let mut cleaner = Builder::empty();
    cleaner
        .tags(text.into_iter().chain(math).collect())
        .tag_attributes(of_math.into_iter().chain(of_text).collect())
        .generic_attributes([].into())
        .url_schemes(["http", "https", "mailto"].into())
        .url_relative(UrlRelative::Deny)
        .link_rel(Some("noopener noreferrer nofollow"))
        .clean_content_tags(["script", "style"].into())
        .allowed_classes(classes.collect());
    cleaner
});

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(rows: &[(&str, &str, &[&str], &[&str])]) {
        for (what, markdown, has, has_not) in rows {
            let html = to_html(markdown);
            for part in *has {
                assert!(html.contains(part), "{what}: no {part} in {html}");
            }
            for part in *has_not {
                assert!(!html.to_lowercase().contains(part), "{what}: {part} in {html}");
            }
        }
    }

    #[test]
    fn ordinary_prose() {
        check(&[
            ("paragraphs", "one\n\ntwo *three*", &["<p>one</p>", "<em>three</em>"], &[]),
            (
                "a formula",
                "so $G(s) = \\frac{0.06s}{s^2+1}$",
                &["<math", "<mfrac>", "0.06"],
                &["merror", "$"],
            ),
            (
                "a matrix",
                "$$\\begin{pmatrix}1&2\\\\3&4\\end{pmatrix}$$",
                &["<mtable", "display=\"block\""],
                &[],
            ),
            ("money", "$5 and $10", &["$5 and $10"], &["<math"]),
            ("a bad formula", "$\\nonsense x$", &["<code>", "nonsense"], &["merror", "<math"]),
            ("a link", "[x](https://example.org/a)", &["href=\"https://example.org/a\"", "noopener"], &[]),
            ("a short formula", "($\\theta = 0$)", &["<math", "θ"], &[]),
            ("a table", "|a|b|\n|-|-|\n|1|2|", &["<table>", "<td>1</td>"], &[]),
            ("a heading", "# Title\ntext", &["<strong>Title</strong>"], &["<h1"]),
            ("a comparison", "a < b && c > d", &["a &lt; b &amp;&amp; c &gt; d"], &[]),
        ]);
    }

    #[test]
    fn hostile_prose_is_harmless() {
        check(&[
            ("script", "<script>alert(1)</script>", &["&lt;script&gt;"], &["<script"]),
            ("style end", "</style><style>*{display:none}", &["&lt;/style&gt;"], &["</style", "<style"]),
            ("event handler", "<img src=x onerror=alert(1)>", &["&lt;img"], &["<img"]),
            ("open comment", "<!-- and the rest", &["&lt;!--"], &["<!--"]),
            ("open math", "<math><table><p>x", &["&lt;math&gt;"], &["<math", "<table"]),
            ("script link", "[x](javascript:alert(1))", &["x"], &["href", "javascript"]),
            ("script link, disguised", "[x](JaVaScRiPt&#58;alert(1))", &["x"], &["href"]),
            ("data link", "[x](data:text/html,<b>)", &["x"], &["href"]),
            ("relative link", "[x](../other.html)", &["x"], &["href"]),
            ("autolink", "<javascript:alert(1)>", &[], &["href"]),
            ("picture", "![a cat](https://example.org/c.png)", &["a cat"], &["<img", "example.org"]),
            ("raw operator", "$\\operatorname{<img src=x onerror=alert(1)>}$", &["<code>"], &["<img"]),
            ("raw text", "$\\text{</math><script>alert(1)</script>}$", &[], &["<script"]),
            ("link in math", "$\\href{javascript:alert(1)}{x}$", &[], &["href="]),
            ("close the page", "</p></div></main></body></html>", &[], &["</div", "</main", "</body"]),
            ("footnote", "a[^1]\n\n[^1]: b", &[], &["id="]),
            ("title with quotes", "[x](https://e.org \"a' onload=\\\"b\")", &["x"], &["onload"]),
        ]);
    }

    #[test]
    fn huge_and_deep_texts_cost_little() {
        for text in ["> ".repeat(10_000), "[".repeat(20_000), "- ".repeat(9_000), "*a ".repeat(30_000)] {
            let html = to_html(&text);
            assert!(html.len() < 200_000, "{} bytes", html.len());
        }
        let deep = format!("${}x{}$", "{".repeat(900), "}".repeat(900));
        assert!(to_html(&deep).contains("<code>"));
        let wide = format!("|{}\n|{}\n{}", "a|".repeat(1_000), "-|".repeat(1_000), "|b\n".repeat(1_000));
        assert!(to_html(&wide).contains("class=\"typed\""));
    }

    #[test]
    fn backticks_are_code() {
        assert_eq!(sentences("`-1,5` is not -1.5 s^2"), "<code>-1,5</code> is not −1.5 s²");
        assert_eq!(sentences("a ` alone <b>"), "a ` alone &lt;b&gt;");
        assert_eq!(sentences("`<b>` and `"), "<code>&lt;b&gt;</code> and `");
    }
}

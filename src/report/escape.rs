/// Whether a character may stand in a page: no control characters but line ends and tabs, none that turn the direction of what
/// follows, none that XML forbids.
pub fn is_harmless(c: char) -> bool {
    match c {
        '\n' | '\r' | '\t' => true,
        '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{fffe}' | '\u{ffff}' => false,
        c => !c.is_control(),
    }
}

/// Writes `text` as HTML or XML character data, fit for quoted attributes too: markup escaped, what is not harmless dropped.
pub fn escape(out: &mut String, text: &str) {
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c if is_harmless(c) => out.push(c),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped() {
        let mut out = String::new();
        escape(&mut out, "</text><script>a&b\u{1b}[31m\"'");
        assert_eq!(out, "&lt;/text&gt;&lt;script&gt;a&amp;b[31m&quot;&#39;");
    }
}

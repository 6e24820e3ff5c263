/// Writes `text` as HTML or XML character data, fit for quoted attributes too: markup escaped, control characters (but line
/// ends and tabs) dropped.
pub fn escape(out: &mut String, text: &str) {
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(c),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => {}
            c => out.push(c),
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

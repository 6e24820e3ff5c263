/// Width of `text` in em of a common sans-serif face, within about a tenth.
///
/// Source: advance widths of Arial and DejaVu Sans, averaged by group.
pub fn text_width(text: &str) -> f64 {
    text.chars().map(char_width).sum()
}

fn char_width(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | '\'' | '|' | '.' | ',' | ':' | ';' | '!' => 0.27,
        'f' | 't' | 'r' | 'I' | ' ' | '(' | ')' | '[' | ']' | '/' | '·' | '-' => 0.34,
        'm' | 'M' | 'W' | '—' => 0.88,
        'w' | 'G' | 'O' | 'Q' | 'D' | 'H' | 'N' | 'U' => 0.75,
        '0'..='9' | '−' | '+' | '=' | '×' | '±' => 0.58,
        'A'..='Z' => 0.67,
        '\u{300}'..='\u{36f}' => 0.0,
        '\u{1100}'..='\u{11ff}' | '\u{2e80}'..='\u{ffdc}' | '\u{1f000}'.. => 1.0,
        _ => 0.57,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_count_not_bytes() {
        assert!(text_width("iiiii") < 0.5 * text_width("MMMMM"));
        assert_eq!(text_width("φφφ"), text_width("aaa"));
        assert_eq!(text_width("e\u{301}"), text_width("e"));
    }
}

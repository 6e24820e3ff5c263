/// The `id` of a criterion on a student's page: link to `report.html#…` with it.
pub fn item_anchor(item: &str) -> String {
    anchor("item", item)
}

/// The `id` of a question on a page.
pub fn question_anchor(question: &str) -> String {
    anchor("q", question)
}

/// An `id` that needs no escaping anywhere: letters, digits, `-`, `_` and `.` only.
pub fn anchor(kind: &str, path: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.') { c } else { '-' };
    format!("{kind}-{}", path.chars().map(plain).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn anchors_need_no_escaping() {
        assert_eq!(item_anchor("hanging.response.plot"), "item-hanging.response.plot");
        assert_eq!(question_anchor("a\"><b é"), "q-a---b--");
    }
}

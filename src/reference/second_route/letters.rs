use super::Agreement;
use crate::model::LetterAgreement;
use crate::reference::OperatingPointReference;

/// The transfer function derived in letters, the lab's numbers put in at the end, beside the one computed from numbers;
/// nothing where there is none in letters.
pub(super) fn letters_route(name: &str, point: &OperatingPointReference) -> Option<Agreement> {
    let derivation = point.letters.as_ref().ok()?;
    let what = format!("{name} transfer function in letters");
    let routes = "elimination in letters, numbers put in after it, against elimination in numbers";
    Some(match derivation.agreement(&point.main().linearization.transfer_function) {
        LetterAgreement::Exact => Agreement::exact(what, routes, true),
        LetterAgreement::Differs => Agreement::exact(what, routes, false),
        LetterAgreement::Within(off) => {
            let digits = -off.max(f64::EPSILON).log10();
            Agreement { what, routes, digits, wanted: 9.0, note: String::new() }
        }
    })
}

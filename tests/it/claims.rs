//! What the labs' phrases hear in sentences that were not written for them: the tables `claims.txt` and `shelf_claims.txt`.

use polemark::grading::{self, Catalogue};
use polemark::lab::{self, Points};
use polemark::reference::Reference;
use polemark::submission::{self, NoFiles};

struct Claim {
    lab: String,
    criterion: String,
    sentence: String,
    /// What a careful teacher hears.
    claimed: bool,
    /// The program is known to hear it otherwise.
    known: bool,
}

/// The sentences of a table; `[lab criterion]`, or the criterion alone of the default lab, stands above them.
fn claims(table: &str) -> Vec<Claim> {
    let mut asked = (lab::DEFAULT, "");
    let mut claims: Vec<Claim> = Vec::new();
    for line in table.lines() {
        match (line.split_at_checked(2), claims.last_mut()) {
            (Some((sign @ ("+ " | "- "), sentence)), _) => claims.push(Claim {
                lab: asked.0.to_owned(),
                criterion: asked.1.to_owned(),
                sentence: sentence.to_owned(),
                claimed: sign == "+ ",
                known: false,
            }),
            (Some(("  ", "known")), Some(last)) => last.known = true,
            _ if line.starts_with('[') => {
                let inner = line.trim_matches(['[', ']']);
                asked = inner.split_once(' ').unwrap_or((lab::DEFAULT, inner));
            }
            _ => assert!(line.is_empty() || line.starts_with('#'), "no sentence: `{line}`"),
        }
    }
    claims
}

/// Those of one lab's claims that are not heard as the table says.
fn misheard(name: &str, claims: &[Claim]) -> Vec<String> {
    let lab = lab::load(name).expect("a lab of the shelf is right");
    let reference = Reference::compute(&lab).expect("a lab of the shelf has a reference");
    let mut wrong = Vec::new();
    for Claim { criterion, sentence, claimed, known, .. } in claims.iter().filter(|claim| claim.lab == name) {
        let asked = lab.questions.iter().flat_map(|question| &question.criteria).find(|c| c.id == *criterion);
        let field = &asked.unwrap_or_else(|| panic!("{name}: no criterion `{criterion}`")).field;
        let file = format!("answers:\n  {field}: |\n    {sentence}\n");
        let submission = submission::read("claim", "claim.yaml", file.as_bytes(), &lab.sheet, &NoFiles);
        let scorecard = grading::grade(&lab, &reference, &Catalogue::default(), &submission, None);
        let item =
            scorecard.questions.iter().flat_map(|question| &question.items).find(|i| i.id == *criterion);
        let heard = item.expect("every criterion is marked").earned > Points::ZERO;
        if (heard == *claimed) == *known {
            let teacher = if *claimed { "+" } else { "-" };
            let but = if *known { "is known to be misheard, and is not" } else { "is misheard" };
            wrong.push(format!("{criterion}: `{teacher} {sentence}` {but}"));
        }
    }
    wrong
}

#[track_caller]
fn check(table: &str) {
    let claims = claims(table);
    let labs: std::collections::BTreeSet<&str> = claims.iter().map(|claim| claim.lab.as_str()).collect();
    let wrong: Vec<String> = labs.into_iter().flat_map(|lab| misheard(lab, &claims)).collect();
    assert!(wrong.is_empty(), "{} of the sentences\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn the_phrases_hear_what_a_teacher_hears() {
    check(include_str!("claims.txt"));
}

#[test]
fn so_do_those_of_the_shelf() {
    check(include_str!("shelf_claims.txt"));
}
